#!/usr/bin/env bash
# Builds what writes docs/methods.md and its pictures, and runs it.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh
cmake --preset release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build build --target alcove_methods_page
build/alcove_methods_page build/meshes/meshes docs
