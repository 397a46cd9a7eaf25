#!/usr/bin/env bash
# Tests Alcove together with other programs. glTF: Blender's exporter and gltfpack make the inputs, the Khronos
# validator checks the outputs, and three.js and Alcove show the same colours; the pictures are in build/interop.
# Blender: the add-on. Python: the module as pip installs it. Debian: the packages, see tools/test_packages.sh.
#
#     tools/interop.sh [--installed]    # with --installed: skips and names what is not installed or needs a build
set -euo pipefail
cd "$(dirname "$0")/.."
builds=true
[ "${1:-}" != --installed ] || builds=false
if $builds; then
    packages=(blender gltfpack chromium debootstrap dpkg-dev help2man lintian python3-pip python3-skbuild python3-venv)
    command -v npm >/dev/null || packages+=(nodejs npm)
    tools/setup.sh "${packages[@]}"
    cmake --preset release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
    cmake --build build --target alcove_cli alcove_python
fi

work=build/interop
rm -rf "$work/in" "$work/out"
mkdir -p "$work/in" "$work/out"
cp tests/interop/* tests/interop/.npmrc "$work"
if command -v npm >/dev/null && (cd "$work" && npm ci --silent --no-audit --no-fund >npm.log 2>&1); then
    validate() { node "$work/compare.mjs" "$@"; }
else
    echo "interop: skipped: the Khronos validator (npm is missing, or its registry cannot be reached)"
    validate() { :; }
fi
if command -v blender >/dev/null; then
    blender --background --python "$work/make_scenes.py" -- "$work/in" >"$work/blender.log" 2>&1 ||
        { cat "$work/blender.log"; exit 1; }
else
    echo "interop: skipped: scenes from Blender (blender is missing)"
fi
if [ -e "$work/in/instances.glb" ] && [ -d "$work/node_modules/three" ]; then
    for name in five_objects instances; do
        node "$work/draco.mjs" "$work/in/$name.glb" "$work/in/${name}_draco.glb"
    done
fi
if command -v gltfpack >/dev/null; then
    for file in "$work"/in/*.glb; do
        [ -e "$file" ] || break
        case $(basename "$file" .glb) in instances | smooth_monkey | textured | five_objects | many_materials) ;; *) continue ;; esac
        gltfpack -i "$file" -o "${file%.glb}_quantized.glb" >/dev/null
        gltfpack -i "$file" -o "${file%.glb}_meshopt.glb" -cc >/dev/null
        gltfpack -i "$file" -o "${file%.glb}_instanced.glb" -mi -noq >/dev/null
    done
else
    echo "interop: skipped: compressed scenes (gltfpack is missing)"
fi

failed=0 count=0
check() {
    count=$((count + 1))
    "$@" || { failed=$((failed + 1)); echo "interop: failed: $*"; }
}
for file in "$work"/in/*.gl*; do
    [ -e "$file" ] || break
    output=$work/out/$(basename "$file")
    check build/alcove bake "$file" -o "$output" --attributes ao,bent_normal --quiet
    check validate "$file" "$output"
    baked_again=${output%.*}_again.${output##*.}
    check build/alcove bake "$output" -o "$baked_again" --attributes convexity --quiet
    check validate "$output" "$baked_again"
done
if [ -d build/meshes/meshes ]; then
    for file in build/meshes/meshes/{elephant.off,cube_poly.off,mesh_with_colors.off,cactus.off}; do
        output=$work/out/$(basename "$file" .off).glb
        check build/alcove bake "$file" -o "$output" --quiet
        check validate "$file" "$output" --converted
    done
fi
if [ -e "$work/in/textured.glb" ]; then
    for name in textured two_uv_sets; do
        check build/alcove bake "$work/in/$name.glb" -o "$work/out/${name}_map.glb" --into texture --size 256 --quiet
        check validate "$work/in/$name.glb" "$work/out/${name}_map.glb"
    done
fi
if [ -e "$work/in/packed.glb" ]; then
    input=$work/in/packed.glb
    for output in "$work"/out/packed{,_again}.glb; do # the second replaces the image of the first
        check build/alcove bake "$input" -o "$output" --into texture --pack-orm --quiet
        check validate "$work/in/packed.glb" "$output" --packed
        input=$output
    done
fi
if command -v chromium >/dev/null && [ -d "$work/node_modules/playwright-core" ] && [ -e "$work/out/textured_map.glb" ]; then
    check node "$work/screenshots.mjs" "$work" build/alcove \
        out/{five_objects,five_objects_draco,five_objects_meshopt,five_objects_quantized,hierarchy,mirrored}.glb=colors \
        out/{instances,instances_draco,instances_meshopt}.glb=colors out/{textured_map,packed_again}.glb=texture
else
    echo "interop: skipped: three.js (chromium, npm or Blender is missing)"
fi
if command -v blender >/dev/null && [ -d build/python/alcove ]; then
    tools/addon.sh >/dev/null
    addon() {
        BLENDER_USER_RESOURCES="$PWD/$work/blender" blender --background --python "$work/test_addon.py" -- \
            build/alcove_blender.zip build/alcove "$work/addon" --module build/python >"$work/addon.log" 2>&1 ||
            { cat "$work/addon.log"; return 1; }
    }
    check addon
else
    echo "interop: skipped: the Blender add-on (blender or the Python module is missing)"
fi
if ! $builds; then
    echo "interop: skipped: the Python module by pip, and the Debian packages (both build everything again)"
else
    pip_module() {
        rm -rf "$work/venv" _skbuild
        /usr/bin/python3 -m venv --system-site-packages "$work/venv"
        CMAKE_CXX_COMPILER_LAUNCHER=ccache "$work/venv/bin/pip" install --no-build-isolation . >"$work/pip.log" 2>&1 ||
            { tail -n 30 "$work/pip.log"; return 1; }
        if ldd "$work"/venv/lib/python3*/site-packages/alcove/*.so | grep alcove; then
            echo "interop: the module of pip needs libraries of the build"
            return 1
        fi
        # From another folder, in which there is no module.
        (cd "$work/in" && env -u PYTHONPATH ../venv/bin/python ../../../tests/python/test_alcove.py ../../alcove \
            ../../../docs/python.md >../pip_test.log 2>&1) || { tail -n 30 "$work/pip_test.log"; return 1; }
        rm -rf "$work/venv" _skbuild python/alcove.egg-info
    }
    check pip_module
    if [ "$(id -u)" -eq 0 ]; then
        check tools/test_packages.sh
    else
        echo "interop: skipped: the Debian packages (their test needs root)"
    fi
fi
[ "$count" -gt 0 ] || echo "interop: nothing could be checked"
echo "interop: $count checks, $failed failed"
[ "$failed" -eq 0 ]
