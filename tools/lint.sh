#!/usr/bin/env bash
# Checks the format of all sources, runs clang-tidy on the library and the program, and checks the scripts.
# Needs the compile commands of a configured build: tools/lint.sh [build directory]
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build}

git ls-files -z '*.h' '*.cpp' | xargs -0 clang-format --dry-run -Werror
git ls-files -z '*.sh' .ci/run | xargs -0 shellcheck
# The shallow mode of the analyzer follows paths through few calls, in a third of the time.
shallow=(-extra-arg=-Xclang -extra-arg=-analyzer-config -extra-arg=-Xclang -extra-arg=mode=shallow)
git ls-files -z 'lib/*.cpp' 'apps/*.cpp' |
    xargs -0 -n 1 -P "$(nproc)" clang-tidy --quiet -p "$build" "${shallow[@]}" \
    2> >(grep -v 'warnings generated' >&2)
