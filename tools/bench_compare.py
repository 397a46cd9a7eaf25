#!/usr/bin/env python3
"""Compares what bench_compare.sh measured: SIDE.PROGRAM.* of Google Benchmark in a folder, for the sides base and head.

Prints a table of the medians, and writes the program and a filter of each benchmark that is slower to a file.
"""

import argparse
import collections
import json
import pathlib
import re
import statistics
import sys

PEER = re.compile("embree|nanovdb|openvdb|dense_array")
MILLISECONDS = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}


def medians(folder, side):
    times = collections.defaultdict(list)
    for file in folder.glob(f"{side}.*"):
        program = file.name.split(".")[1]
        # A program without a benchmark that matches leaves its file empty.
        for run in json.loads(file.read_text() or '{"benchmarks": []}')["benchmarks"]:
            if run["run_type"] == "iteration" and not run.get("error_occurred"):
                times[program, run["name"]].append(run["cpu_time"] * MILLISECONDS[run["time_unit"]])
    return {key: statistics.median(of_key) for key, of_key in sorted(times.items())}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bound", type=float, help="of CPU time of head, of that of base")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("slower", type=pathlib.Path, help="file to write")
    arguments = parser.parse_args()
    base, head = (medians(arguments.folder, side) for side in ("base", "head"))
    common = [key for key in base if key in head]
    if not common:
        print("bench_compare.py: no benchmark is in both", file=sys.stderr)
        return 2

    width = max(len(name) for _, name in common)
    print(f"{'CPU milliseconds':{width}} | {'base':>10} | {'head':>10} | ratio")
    slower = []
    for program, name in common:
        before, after = base[program, name], head[program, name]
        ratio = after / before
        remark = ""
        if PEER.match(name):
            noisy = not 1 / arguments.bound <= ratio <= arguments.bound
            remark = "too noisy: the same in both" if noisy else "peer"
        elif ratio > arguments.bound:
            remark = "slower"
            slower.append(f"{program} ^{re.escape(name)}$\n")
        print(f"{name:{width}} | {before:10.3f} | {after:10.3f} | {ratio:5.3f} {remark}".rstrip())
    arguments.slower.write_text("".join(slower))
    return 0


if __name__ == "__main__":
    sys.exit(main())
