#!/usr/bin/env python3
"""Measures bakes without options: their true error, and their cost compared with that of other plans.

    bench/default_bakes.py [--alcove PROGRAM] [--out FILE.json] [--jobs N] [--repeat N] MESH...

Bakes each mesh with the default, with --via auto and with --via mesh (exact rays), at a radius of 10 % and on one
thread, and compares its ao with that of many exact rays. The costs are the CPU seconds of the whole program. Results
are written to FILE.json as they arrive; those already there for the same build and mesh are not measured again. The
truths (the ao of the exact rays) are kept beside FILE.json, in FILE.truths, and used for all builds: remove them if the
exact rays themselves change.
"""

import argparse
import collections
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import re
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
from array import array

PLANS = {"default": [], "auto": ["--via", "auto"], "exact": ["--via", "mesh"]}
TRUTH_SEED = 12345
MANY_VERTICES = 60000  # beyond this, the truth has fewer rays
LARGE_SCAN = 200000
RATIO, SECONDS = 1.5, 0.3  # the default costs too much if it exceeds exact by both this factor and this difference
PLY_TYPES = {"char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h", "ushort": "H",
             "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I", "float": "f", "float32": "f",
             "double": "d", "float64": "d"}


class Failure(Exception):
    """A run of alcove that failed."""


def run(command):
    """The standard output of a program and its CPU seconds."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=err)
        try:
            _, status, usage = os.wait4(child.pid, 0)
        except BaseException:
            child.kill()
            raise
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode:
            err.seek(0)
            lines = err.read().decode(errors="replace").strip().splitlines()
            raise Failure(f"exit code {child.returncode}: {lines[-1] if lines else 'no message'}")
        out.seek(0)
        return out.read().decode(), usage.ru_utime + usage.ru_stime


def bake(alcove, mesh, output, options, threads=1):
    """The result of a bake as alcove reports it, and its CPU seconds."""
    text, cpu = run([alcove, "bake", mesh, "-o", output, "--radius", "10%", "--threads", str(threads), "--json",
                     "--quiet", *options])
    return json.loads(text), cpu


def read_ao(file):
    """The ao of the vertices of a binary little-endian .ply, in which the vertices are the first element."""
    with open(file, "rb") as data:
        count, layout, ao = 0, "<", None
        element = None
        for line in iter(lambda: data.readline().split(), [b"end_header"]):
            words = [word.decode(errors="replace") for word in line]
            if words[:1] == ["format"] and words[1] != "binary_little_endian":
                raise Failure(f"{file} is {words[1]}")
            if words[:1] == ["element"]:
                if element is None and words[1] != "vertex":
                    raise Failure(f"{file} does not begin with its vertices")
                element = words[1]
                if element == "vertex":
                    count = int(words[2])
            if words[:1] == ["property"] and element == "vertex":
                if words[-1] == "ao":
                    ao = struct.calcsize(layout)
                layout += PLY_TYPES[words[1]]
        if ao is None:
            raise Failure(f"{file} has no ao")
        size = struct.calcsize(layout)
        rows = data.read(size * count)
    if len(rows) != size * count:
        raise Failure(f"{file} is cut off")
    return array("f", (struct.unpack_from("<f", rows, ao + size * i)[0] for i in range(count)))


def rmse(values, truth):
    if len(values) != len(truth):
        raise Failure(f"{len(values)} values, but {len(truth)} of the truth")
    return math.sqrt(sum((a - b) ** 2 for a, b in zip(values, truth)) / max(len(truth), 1))


def hash_of(*files):
    digest = hashlib.sha256()
    for file in files:
        digest.update(pathlib.Path(file).read_bytes())
    return digest.hexdigest()[:16]


def build_of(alcove):
    """Identifies the program and those of its libraries that are in its folder."""
    folder = pathlib.Path(alcove).resolve().parent
    lines = subprocess.run(["ldd", alcove], capture_output=True, text=True, check=True).stdout.splitlines()
    libraries = [pathlib.Path(line.split()[2]) for line in lines if "=> /" in line]
    return hash_of(alcove, *sorted(file for file in libraries if folder in file.resolve().parents))


class Measurement:
    """Measures meshes with one build."""

    def __init__(self, alcove, truths, repeat, truth_threads):
        self.alcove, self.truths, self.repeat, self.truth_threads = alcove, truths, repeat, truth_threads

    def truth(self, mesh, content, vertices, folder):
        rays = 256 if vertices > MANY_VERTICES else 1024
        kept = self.truths / f"{pathlib.Path(mesh).stem}-{content}-{rays}.f32"
        values = array("f")
        if kept.exists():
            values.frombytes(kept.read_bytes())
            return values
        output = os.path.join(folder, "truth.ply")
        options = ["--method", "exact", "--rays", str(rays), "--seed", str(TRUTH_SEED), "--no-pilot"]
        bake(self.alcove, mesh, output, options, self.truth_threads)
        values = read_ao(output)
        self.truths.mkdir(parents=True, exist_ok=True)
        partial = kept.with_suffix(f".{threading.get_ident()}")
        partial.write_bytes(values.tobytes())
        partial.replace(kept)
        return values

    def measure(self, mesh):
        """Measures one mesh. Returns a record, which says so if the measurement failed."""
        with tempfile.TemporaryDirectory() as folder:
            record = {"mesh": mesh, "content": hash_of(mesh)}
            try:
                plans = self.bakes(mesh, folder)
                record["vertices"] = plans["default"]["vertices"]
                truth = self.truth(mesh, record["content"], record["vertices"], folder)
                for name, plan in plans.items():
                    values = read_ao(plan.pop("output"))
                    plan["true_rmse"] = rmse(values, truth)
                    if not math.isfinite(plan["true_rmse"]):
                        raise Failure(f"{name}: ao is not finite")
                record["plans"] = plans
            except Failure as failure:
                record["failure"] = str(failure)
            return record

    def bakes(self, mesh, folder):
        """Bakes with all plans, in turn. Each round begins with a different plan."""
        plans, cpu = {}, collections.defaultdict(list)
        names = list(PLANS)
        for turn in range(self.repeat):
            first = turn % len(names)
            for name in names[first:] + names[:first]:
                output = os.path.join(folder, f"{name}.ply")
                try:
                    told, seconds = bake(self.alcove, mesh, output, PLANS[name])
                except Failure as failure:
                    raise Failure(f"{name}: {failure}") from None
                cpu[name].append(seconds)
                plans[name] = {key: told.get(key) for key in ("vertices", "method", "samples", "reason",
                                                              "estimated_rmse", "seconds", "warnings")}
                plans[name]["output"] = output
        for name, plan in plans.items():
            plan["cpu"], plan["cpu_runs"] = statistics.median(cpu[name]), cpu[name]
        return {name: plans[name] for name in names}


class Results:
    """Records by mesh, kept in a file that is never left half written."""

    def __init__(self, file, settings):
        self.file, self.settings, self.records = file, settings, {}
        if file and file.exists():
            kept = json.loads(file.read_text(encoding="utf-8"))
            if kept["settings"] == settings:
                self.records = {record["mesh"]: record for record in kept["meshes"] if self.is_current(record)}
            else:
                print(f"{file} is of another build or --repeat: it is replaced", file=sys.stderr)

    @staticmethod
    def is_current(record):
        mesh = record["mesh"]
        return "failure" not in record and os.path.exists(mesh) and hash_of(mesh) == record["content"]

    def add(self, record):
        self.records[record["mesh"]] = record
        if self.file:
            self.file.parent.mkdir(parents=True, exist_ok=True)
            partial = self.file.with_name(self.file.name + ".partial")
            partial.write_text(json.dumps({"settings": self.settings, "meshes": list(self.records.values())}, indent=1),
                               encoding="utf-8")
            partial.replace(self.file)


def name_of(record):
    return pathlib.Path(record["mesh"]).name


def number(value):
    return "-" if value is None else f"{value:.4f}"


def line_of(record):
    name = f"{name_of(record):28}"
    if "failure" in record:
        return f"{name} FAILED {record['failure']}"
    default, auto, exact = record["plans"].values()

    def method(plan):
        return plan["method"] + (f":{plan['samples']}" if plan["samples"] else "")
    cpu = " ".join(f"{plan['cpu']:7.2f}" for plan in (default, auto, exact))
    reason = f"  ({default['reason']})" if default["reason"] else ""
    return (f"{name} {record['vertices']:7}  {method(default):16} rmse {number(default['true_rmse'])} true "
            f"{number(default['estimated_rmse']):>6} estimated  auto {method(auto):14} {number(auto['true_rmse'])}"
            f"  {method(exact):10} {number(exact['true_rmse'])}  CPU s {cpu}"
            f"  ratio {default['cpu'] / exact['cpu']:5.2f}{reason}")


def share(count, total):
    return f"{count} of {total} ({100 * count / max(total, 1):.1f} %)"


def is_mismatch(plan):
    """Whether the estimate is off by more than 30 % of the truth, and either of the two is large enough to matter."""
    true, estimated = plan["true_rmse"], plan["estimated_rmse"]
    if estimated is None:
        return False
    return abs(estimated - true) > 0.3 * true and max(estimated, true) >= 0.005


def off_by(plan):
    """The ratio of the larger of the estimate and the truth to the smaller."""
    low, high = sorted((plan["true_rmse"], plan["estimated_rmse"]))
    return high / max(low, 1e-4)


def print_summary(records):
    failed = [record for record in records if "failure" in record]
    records = [record for record in records if "failure" not in record]
    total = len(records)
    print(f"\n{total} meshes measured, {len(failed)} failed")
    for record in failed:
        print(f"    {name_of(record)}: {record['failure']}")
    if not records:
        return
    defaults = [(record, record["plans"]["default"]) for record in records]
    for bound in (0.023, 0.03):
        held = sum(plan["true_rmse"] <= bound for _, plan in defaults)
        print(f"default's true RMSE at most {bound}: {share(held, total)}")

    def cost(name, of=records):
        return sum(record["plans"][name]["cpu"] for record in of)

    def costs(record):
        default, exact = (record["plans"][name]["cpu"] for name in ("default", "exact"))
        return f"{default:.2f} s, exact {exact:.2f} s"
    slow = [record for record in records
            if record["plans"]["default"]["cpu"] > max(RATIO * record["plans"]["exact"]["cpu"],
                                                       record["plans"]["exact"]["cpu"] + SECONDS)]
    print(f"default costs more than {RATIO} times exact and {SECONDS} s more: {share(len(slow), total)}")
    for record in slow:
        print(f"    {name_of(record)}: {costs(record)}")
    print(f"all meshes: default {cost('default'):.1f} s, auto {cost('auto'):.1f} s, exact {cost('exact'):.1f} s; "
          f"auto / exact {cost('auto') / cost('exact'):.3f}, default / exact {cost('default') / cost('exact'):.3f}")
    large = [record for record in records if record["vertices"] > LARGE_SCAN]
    print(f"more than {LARGE_SCAN} vertices: {share(len(large), total)}")
    for record in large:
        ratio = cost("default", [record]) / cost("exact", [record])
        print(f"    {name_of(record)}: {costs(record)}, ratio {ratio:.2f}")
    if large:
        print(f"    together: ratio {cost('default', large) / cost('exact', large):.2f}")

    fallbacks = [plan for _, plan in defaults if plan["method"] == "exact"]
    print(f"default fell back to exact: {share(len(fallbacks), total)}")
    reasons = collections.Counter(re.sub(r"\d[\d.e+-]*", "N", plan["reason"] or "no reason") for plan in fallbacks)
    for reason, count in reasons.most_common():
        print(f"    {count} x {reason}")

    print("largest true RMSE of the default:")
    for record, plan in sorted(defaults, key=lambda pair: -pair[1]["true_rmse"])[:5]:
        print(f"    {name_of(record)}: {number(plan['true_rmse'])}, estimated {number(plan['estimated_rmse'])}, "
              f"{plan['method']}")
    wrong = [pair for pair in defaults if is_mismatch(pair[1])]
    print(f"estimate off by more than 30 %: {share(len(wrong), total)}")
    for record, plan in sorted(wrong, key=lambda pair: -off_by(pair[1]))[:5]:
        print(f"    {name_of(record)}: {number(plan['true_rmse'])}, estimated {number(plan['estimated_rmse'])}, "
              f"{plan['method']}, {record['vertices']} vertices")
    missing = sum(plan["estimated_rmse"] is None for _, plan in defaults)
    if missing:
        print(f"without an estimate: {share(missing, total)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+", metavar="MESH")
    parser.add_argument("--alcove", default="build/alcove", help="program to measure (default: build/alcove)")
    parser.add_argument("--out", type=pathlib.Path, help="file for the results, from which a run continues")
    parser.add_argument("--jobs", type=int, default=1, help="meshes at once (default: 1)")
    parser.add_argument("--repeat", type=int, default=1, help="take the median CPU time of so many runs (default: 1)")
    arguments = parser.parse_args()
    if arguments.jobs < 1 or arguments.repeat < 1:
        parser.error("--jobs and --repeat take 1 or more")
    alcove = os.path.abspath(arguments.alcove)
    if not os.access(alcove, os.X_OK):
        parser.error(f"{alcove} is not a program")
    build = build_of(alcove)
    meshes = list(dict.fromkeys(os.path.abspath(mesh) for mesh in arguments.meshes))
    for mesh in meshes:
        if not os.path.isfile(mesh):
            parser.error(f"there is no {mesh}")
    results = Results(arguments.out, {"build": build, "repeat": arguments.repeat})

    with tempfile.TemporaryDirectory() as nowhere:
        truths = arguments.out.with_suffix(".truths") if arguments.out else pathlib.Path(nowhere)
        measurement = Measurement(alcove, truths, arguments.repeat, max(1, (os.cpu_count() or 1) // arguments.jobs))
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            pending = {pool.submit(measurement.measure, mesh) for mesh in meshes if mesh not in results.records}
            try:
                for record in (results.records[mesh] for mesh in meshes if mesh in results.records):
                    print(line_of(record))
                for done in concurrent.futures.as_completed(pending):
                    record = done.result()
                    if build_of(alcove) != build:
                        raise Failure(f"{alcove} was rebuilt meanwhile: start again")
                    results.add(record)
                    print(line_of(record), flush=True)
            except BaseException as stopped:
                pool.shutdown(wait=False, cancel_futures=True)
                if isinstance(stopped, Failure):
                    sys.exit(f"default_bakes.py: {stopped}")
                raise
    print_summary([results.records[mesh] for mesh in meshes])


if __name__ == "__main__":
    main()
