#!/usr/bin/env bash
# Installs dependencies, builds, and runs all tests, and those of tools/interop.sh whose programs are installed.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh
cmake --preset release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build build
ctest --test-dir build --output-on-failure --parallel "$(nproc)"
tools/interop.sh --installed
