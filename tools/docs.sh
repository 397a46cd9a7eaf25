#!/usr/bin/env bash
# Builds and runs the programs that write docs/methods.md, docs/rendering.md, docs/stability.md, docs/accuracy.md and
# docs/performance.md with their images. The first three take a few minutes, the others up to a quarter of an hour.
#
#     tools/docs.sh [methods] [rendering] [stability] [accuracy] [performance]
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- methods rendering stability accuracy performance
tools/setup.sh
cmake --preset release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
for page in "$@"; do
    cmake --build build --target "alcove_${page}_page"
    "build/alcove_${page}_page" build/meshes/meshes docs
done
