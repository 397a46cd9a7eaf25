#!/usr/bin/env bash
# Tests the Debian packages: builds them and checks them with lintian, installs them on a fresh Debian in a folder, runs
# the recipe of the README, the Python module and a C++ project from them, and purges them. Needs root.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh debootstrap
tools/package.sh

scratch=$PWD/build/interop/packages
root=$scratch/root
rm -rf "$scratch"
mkdir -p "$scratch"
mirror=$(apt-get indextargets --format "\$(REPO_URI)" "Codename: bookworm" | head -1)
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$scratch/debootstrap.log" || {
    tail -n 5 "$scratch/debootstrap.log" >&2
    exit 1
}
mkdir -p "$root/scratch/build/meshes/meshes"
cp build-package/*.deb "$root/scratch"
cp build/meshes/meshes/armadillo.off "$root/scratch/build/meshes/meshes"

# Runs a script in the new system.
inside() {
    chroot "$root" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 HOME=/root bash -euc "cd /scratch; $1"
}
inside 'apt-get update -q >apt.log
    apt-get install -qy --no-install-recommends ./*.deb >>apt.log 2>&1 || { tail -n 20 apt.log; exit 1; }'
recipe=$(sed -n 's|^    build/alcove bake|alcove bake|p' README.md)
[ -n "$recipe" ]
inside "$recipe; alcove --version"
inside 'python3 -c "
import alcove
mesh = alcove.read(\"build/meshes/meshes/armadillo.off\")
alcove.add(mesh, alcove.bake(mesh))
alcove.write(mesh, \"by_module.ply\")"
    cmp armadillo_ao.ply by_module.ply
    test -s /usr/share/man/man1/alcove-bake.1.gz
    test -s /usr/share/bash-completion/completions/alcove
    test -s /usr/share/blender/scripts/addons/alcove_ao/__init__.py'
cmake -S tests/consumer -B "$scratch/consumer" -G Ninja -DCMAKE_PREFIX_PATH="$root/usr" >"$scratch/consumer.log"
cmake --build "$scratch/consumer" >>"$scratch/consumer.log"
(cd "$scratch" && consumer/consumer)

inside 'apt-get purge -qy alcove alcove-blender libalcove-dev libalcove0.2 python3-alcove >>apt.log 2>&1'
left=$(find "$root" -xdev -iname '*alcove*' -not -path "$root/scratch/*")
[ -z "$left" ] || {
    echo "test_packages.sh: left after the purge: $left" >&2
    exit 1
}
rm -rf "$root"
echo "packages: installed, used and purged"
