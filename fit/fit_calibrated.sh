#!/usr/bin/env bash
# Trains the networks of `calibrated`, and writes their coefficients and docs/calibrated.md. Takes half an hour on two
# cores, most of it to make examples. Other versions of PyTorch may arrive at other coefficients with the same error.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh python3-torch
cmake --preset release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build build --target alcove_fit_examples
build/fit/alcove_fit_examples build/fit/examples
/usr/bin/python3 fit/train_networks.py build/fit/examples lib/alcove/occlusion/methods
cmake --build build --target alcove_fit_report
python3 bench/make_parts.py build/fit/parts
build/fit/alcove_fit_report build/fit/parts/*.{stl,obj,off}
