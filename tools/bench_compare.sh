#!/usr/bin/env bash
# Finds slowdowns: builds the benchmarks of two revisions, runs them in turn, and fails if the median CPU time of a
# benchmark in HEAD is more than BOUND times that in BASE. Benchmarks that seem slower are measured again by themselves,
# twice, and count only if they are slower each time, because the load of the machine varies.
#
#     tools/bench_compare.sh [--bound=1.15] [--rounds=5] [--benchmark_filter=REGEX] [--benchmark_min_time=0.05]
#                            BASE [HEAD]
#
# HEAD defaults to the commit that is checked out; uncommitted changes are not measured. Both are built in worktrees
# under build/compare, which are removed at the end. Benchmarks of OpenVDB, NanoVDB and Embree run the same code in
# both: they are not judged, and their ratios show the noise. All benchmarks together take half an hour, so select those
# that the change affects. Exit codes: 0 not slower, 1 slower, 2 not compared.
set -euo pipefail
cd "$(dirname "$0")/.."

fail() {
    echo "bench_compare.sh: $1" >&2
    exit 2
}

rounds=5
bound=1.15
filter=.
passed_on=(--benchmark_min_time=0.05)
revisions=()
for argument; do
    case $argument in
    --rounds=*) rounds=${argument#*=} ;;
    --bound=*) bound=${argument#*=} ;;
    --benchmark_filter=*) filter=${argument#*=} ;;
    --benchmark_*) passed_on+=("$argument") ;;
    -*) fail "unknown option $argument" ;;
    *) revisions+=("$argument") ;;
    esac
done
case ${#revisions[@]} in 1 | 2) ;; *) fail "usage: bench_compare.sh [OPTION...] BASE [HEAD]" ;; esac
commit() { git rev-parse --verify --quiet "$1^{commit}" || fail "unknown revision $1"; }
base=$(commit "${revisions[0]}")
head=$(commit "${revisions[1]:-HEAD}")

tools/setup.sh
place=$PWD/build/compare
exec {lock}>build/compare.lock
flock --nonblock "$lock" || fail "another comparison is running here"
remove_trees() {
    for tree in "$place/base" "$place/head"; do
        git worktree remove --force "$tree" 2>/dev/null || true
    done
    rm -rf "$place"
}
remove_trees
trap remove_trees EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

# Sources that are the same in both trees are compiled once.
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD}
build() {
    local tree=$place/$1
    git worktree add --quiet --detach "$tree" "$2"
    mkdir "$tree/build"
    ln -s "$PWD/build/meshes" "$tree/build/meshes"
    (
        cd "$tree"
        targets=(bench/bench_*.cpp)
        targets=("${targets[@]#bench/}")
        cmake --preset release -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DALCOVE_TESTS=OFF -DALCOVE_FIT=OFF &&
            cmake --build build --target "${targets[@]%.cpp}"
    ) >"$place/$1.log" 2>&1 || {
        tail -n 30 "$place/$1.log" >&2
        fail "$2 does not build"
    }
}
mkdir -p "$place"
build base "$base"
build head "$head"

# Runs the benchmarks of a program that match a filter, in both trees, and writes the results to a folder. The trees
# take turns at running first.
run_both() {
    local folder=$1 round=$2 program=$3 filter=$4 sides=(base head) side
    ((round % 2)) || sides=(head base)
    for side in "${sides[@]}"; do
        "$place/$side/build/bench/$program" "${passed_on[@]}" --benchmark_filter="$filter" \
            --benchmark_out_format=json --benchmark_out="$(mktemp "$folder/$side.$program.XXXXXX")" \
            >/dev/null 2>"$place/run.log" || {
            cat "$place/run.log" >&2
            fail "$program of $side failed"
        }
    done
}

# Benchmarks to measure: one program and filter per line.
measured=$place/measured
for program in "$place"/head/build/bench/bench_*; do
    [ ! -x "$place/base/build/bench/${program##*/}" ] || echo "${program##*/} $filter"
done >"$measured"
for pass in first again finally; do
    mkdir "$place/$pass"
    for ((round = 1; round <= rounds; ++round)); do
        echo "measuring: $pass, round $round of $rounds" >&2
        while read -r program benchmarks; do
            run_both "$place/$pass" "$round" "$program" "$benchmarks"
        done <"$measured"
    done
    python3 tools/bench_compare.py "$bound" "$place/$pass" "$measured"
    [ -s "$measured" ] || exit 0
done
echo "Slower by more than a factor of $bound in every pass:"
cat "$measured"
exit 1
