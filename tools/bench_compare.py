#!/usr/bin/env python3
"""Compares the measurements of bench_compare.sh: the files SIDE.PROGRAM.* of Google Benchmark in a folder, where SIDE
is base or head.

Prints a table of the medians. Writes the program and a filter for each benchmark that is slower to a file.
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
        # The file is empty if no benchmark of the program matches.
        for run in json.loads(file.read_text() or '{"benchmarks": []}')["benchmarks"]:
            if run["run_type"] == "iteration" and not run.get("error_occurred"):
                times[program, run["name"]].append(run["cpu_time"] * MILLISECONDS[run["time_unit"]])
    return {key: statistics.median(of_key) for key, of_key in sorted(times.items())}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bound", type=float, help="largest allowed ratio of the CPU time of head to that of base")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("slower", type=pathlib.Path, help="file to write the slower benchmarks to")
    arguments = parser.parse_args()
    base, head = (medians(arguments.folder, side) for side in ("base", "head"))
    common = [key for key in base if key in head]
    if not common:
        print("bench_compare.py: base and head have no benchmark in common", file=sys.stderr)
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
            remark = "same code in both: the measurement is too noisy" if noisy else "peer"
        elif ratio > arguments.bound:
            remark = "slower"
            slower.append(f"{program} ^{re.escape(name)}$\n")
        print(f"{name:{width}} | {before:10.3f} | {after:10.3f} | {ratio:5.3f} {remark}".rstrip())
    arguments.slower.write_text("".join(slower))
    return 0


if __name__ == "__main__":
    sys.exit(main())
