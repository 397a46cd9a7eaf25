#!/usr/bin/env bash
# Installs dependencies, builds, and runs all tests.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh
cmake --preset release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build build
ctest --test-dir build --output-on-failure --parallel "$(nproc)"
