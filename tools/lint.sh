#!/usr/bin/env bash
# Checks the format of all sources, runs clang-tidy on the library and the program, and checks the scripts.
# Needs the compile commands of a configured build: tools/lint.sh [build directory]
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build}

git ls-files -z '*.h' '*.cpp' | xargs -0 clang-format --dry-run -Werror
git ls-files -z '*.sh' .ci/run | xargs -0 shellcheck
tidy() {
    xargs -0 -n 1 -P "$(nproc)" clang-tidy --quiet -p "$build" "$@" 2> >(grep -v 'warnings generated' >&2)
}
# The analyzer takes most of the time, so it runs only on the readers of files that may be hostile. Its shallow mode
# follows paths through few calls, in a third of the time.
readers=('lib/alcove/mesh/formats/*.cpp' 'lib/alcove/vdb/*.cpp')
git ls-files -z "${readers[@]}" |
    tidy -extra-arg=-Xclang -extra-arg=-analyzer-config -extra-arg=-Xclang -extra-arg=mode=shallow
git ls-files -z 'lib/*.cpp' "${readers[@]/#/:!}" | tidy '--checks=-clang-analyzer-*'
# This check takes ten seconds in each file that includes CLI11.
git ls-files -z 'apps/*.cpp' | tidy '--checks=-clang-analyzer-*,-performance-unnecessary-value-param'
