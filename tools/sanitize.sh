#!/usr/bin/env bash
# Runs all tests under the address and undefined-behaviour sanitizers. Takes a quarter of an hour, so it is not part of
# every check.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh
cmake --preset asan -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build --preset asan
ctest --preset asan --parallel "$(nproc)"
