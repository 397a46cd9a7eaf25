#!/usr/bin/env bash
# Builds what writes docs/methods.md and docs/accuracy.md with their pictures, and runs it: tools/docs.sh [methods] [accuracy]
# The first takes a minute, the second a quarter of an hour.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- methods accuracy
tools/setup.sh
cmake --preset release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
for page in "$@"; do
    cmake --build build --target "alcove_${page}_page"
    "build/alcove_${page}_page" build/meshes/meshes docs
done
