#!/usr/bin/env bash
# Fuzzes the readers and voxelization: builds the targets of fuzz/ by clang with libFuzzer and the address and
# undefined-behaviour sanitizers in build-fuzz, and runs one after the other.
#
#     tools/fuzz.sh [SECONDS=60] [ply|obj|off|stl|toml|vdb|voxelize...]
#
# What crashes, breaks an invariant, or takes more than two seconds or an allocation of 512 MB ends its target's run and is
# kept in build-fuzz/failures: once mended, it belongs in fuzz/regressions. Other finds go on in build-fuzz/corpus.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=60
if [[ ${1:-} =~ ^[0-9]+$ ]]; then
    seconds=$1
    shift
fi
[ $# -gt 0 ] || set -- ply obj off stl toml vdb voxelize

tools/setup.sh clang libclang-rt-14-dev
cmake --preset fuzz -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build build-fuzz --target "${@/#/fuzz_}"

# Resident memory also holds the sanitizer's shadow, its quarantine of freed blocks and what libFuzzer knows, some 200 MB:
# the limit on it is twice that on an allocation.
limits=(-timeout=2 -malloc_limit_mb=512 -rss_limit_mb=1024 -max_len=65536)
export ASAN_OPTIONS=quarantine_size_mb=64
export LSAN_OPTIONS=suppressions=$PWD/tests/leaks.supp:print_suppressions=0
mkdir -p build-fuzz/failures
failed=()
for target; do
    corpus=build-fuzz/corpus/$target
    mkdir -p "$corpus"
    seeds=()
    for folder in fuzz/corpus/"$target" fuzz/regressions/"$target"; do
        [ ! -d "$folder" ] || seeds+=("$folder")
    done
    words=()
    [ ! -f "fuzz/dictionaries/$target.dict" ] || words=(-dict="fuzz/dictionaries/$target.dict")
    echo "$target:"
    build-fuzz/fuzz/fuzz_"$target" "${limits[@]}" "${words[@]}" -max_total_time="$seconds" -print_final_stats=1 \
        -artifact_prefix="build-fuzz/failures/$target-" "$corpus" "${seeds[@]}" >"build-fuzz/$target.log" 2>&1 ||
        failed+=("$target")
    grep -E 'SUMMARY|does not hold|Test unit written|number_of_executed_units|slowest_unit|peak_rss' \
        "build-fuzz/$target.log" || true
done
[ ${#failed[@]} -eq 0 ] || {
    echo "failed: ${failed[*]}; see build-fuzz/failures and build-fuzz/*.log" >&2
    exit 1
}
