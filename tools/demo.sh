#!/usr/bin/env bash
# Installs dependencies, builds, bakes a real scan, renders it, and lists the files to look at.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh
cmake --preset release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build build --target alcove_cli

scan=build/meshes/meshes/armadillo.off
mkdir -p build/demo
build/alcove bake "$scan" -o build/demo/armadillo_ao.ply --radius 50% --quality fine
view=(--radius 50% --size 720x720 --eye "110,110,-280" --look-at "2,28,0" --fov 35)
build/alcove render "$scan" -o build/demo/armadillo_without.png "${view[@]}" --method none
build/alcove render "$scan" -o build/demo/armadillo_with.png "${view[@]}"
build/alcove render "$scan" -o build/demo/armadillo_ao.png "${view[@]}" --pass ao
echo
echo "Look at:"
echo "  $PWD/build/demo/armadillo_without.png and armadillo_with.png: the scan without and with ambient occlusion"
echo "  $PWD/build/demo/armadillo_ao.png: the occlusion alone"
echo "  $PWD/build/demo/armadillo_ao.ply: the scan with occlusion as vertex colours, for MeshLab or Blender"
