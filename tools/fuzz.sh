#!/usr/bin/env bash
# Fuzzes the readers and voxelization: builds the targets of fuzz/ in build-fuzz, with clang, libFuzzer and the address
# and undefined-behaviour sanitizers, and runs them one after another.
#
#     tools/fuzz.sh [SECONDS=60] [ply|obj|off|stl|glb|toml|vdb|voxelize...]
#
# An input that crashes, violates an invariant, takes more than two seconds or allocates more than 512 MB ends the run
# of its target and is saved in build-fuzz/failures. After the fix, move it to fuzz/regressions. Other new inputs are
# kept in build-fuzz/corpus for the next run.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=60
if [[ ${1:-} =~ ^[0-9]+$ ]]; then
    seconds=$1
    shift
fi
[ $# -gt 0 ] || set -- ply obj off stl glb toml vdb voxelize

tools/setup.sh clang libclang-rt-14-dev
cmake --preset fuzz -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build build-fuzz --target "${@/#/fuzz_}"

# Resident memory includes the shadow memory of the sanitizer, its quarantine of freed blocks and the state of
# libFuzzer, about 200 MB: its limit is twice that of an allocation.
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
    grep -E 'SUMMARY|invariant violated|Test unit written|number_of_executed_units|slowest_unit|peak_rss' \
        "build-fuzz/$target.log" || true
done
[ ${#failed[@]} -eq 0 ] || {
    echo "failed: ${failed[*]}; see build-fuzz/failures and build-fuzz/*.log" >&2
    exit 1
}
