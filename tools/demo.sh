#!/usr/bin/env bash
# Installs, builds, bakes a real scan and renders it; says where to look.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh
cmake --preset release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build build --target alcove_cli

mkdir -p build/demo
build/alcove bake build/meshes/meshes/armadillo.off -o build/demo/armadillo_ao.ply
echo
echo "The scan with ambient occlusion as vertex colours: $PWD/build/demo/armadillo_ao.ply (open it in MeshLab or Blender)"
