#!/usr/bin/env python3
"""Runs `render` or `info` on randomly mutated scene files and level sets, and reports the runs that fail.

    mutate.py PROGRAM SCENES.toml... [--count 2000] [--seed 1]

A run must end with exit code 0, 2 or 3 within ten seconds and 2 GB. The program makes the level set first. Inputs that
fail are kept in a folder whose name is printed at the end.
"""
import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import threading

SECONDS, BYTES = 10, 2e9
EXTREMES = ["0", "-1", "nan", "inf", "-inf", "1e308", "1e-308", "1e30", "-1e-30", "99999999999999999999", "true", '""',
            "[]", "{}", "[1, 2]", '"10%"', '"1e9%"', '"3vx"', "65536", "0.5"]


def damage_text(text, rng):
    lines = text.split("\n")
    for _ in range(rng.randint(1, 4)):
        kind, at = rng.randrange(8), rng.randrange(len(lines))
        if kind == 0:
            del lines[at:at + rng.randint(1, 3)]
        elif kind == 1:
            lines.insert(at, rng.choice(lines or [""]))
        elif kind == 2:
            numbers = list(re.finditer(r"-?\d+\.?\d*", lines[at]))
            if numbers:
                found = rng.choice(numbers)
                lines[at] = lines[at][:found.start()] + rng.choice(EXTREMES) + lines[at][found.end():]
        elif kind == 3 and "=" in lines[at]:
            lines[at] = lines[at].split("=")[0] + "= " + rng.choice(EXTREMES)
        elif kind == 4:
            word = list(re.finditer(r"[a-z_]+", lines[at]))
            if word:
                found = rng.choice(word)
                lines[at] = lines[at][:found.start()] + rng.choice(re.findall(r"[a-z_]+", text)) + lines[at][found.end():]
        elif kind == 5:
            other = rng.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        elif kind == 6 and lines[at]:
            place = rng.randrange(len(lines[at]))
            lines[at] = lines[at][:place] + chr(rng.randrange(1, 256)) + lines[at][place + 1:]
        elif kind == 7:
            lines = lines[:max(1, at)]
        lines = lines or [""]
    return "\n".join(lines).encode("utf-8", "replace")


def damage_bytes(data, rng):
    data = bytearray(data)
    for _ in range(rng.randint(1, 6)):
        kind = rng.randrange(5)
        # Mostly damage the front: the header and the grid descriptors.
        at = rng.randrange(min(len(data), 2000)) if rng.random() < 0.8 else rng.randrange(len(data))
        if kind == 0:
            data[at] ^= 1 << rng.randrange(8)
        elif kind == 1:
            data[at] = rng.randrange(256)
        elif kind == 2:
            data[at:at + 8] = rng.choice([b"\0" * 8, b"\xff" * 8, (1 << 40).to_bytes(8, "little")])
        elif kind == 3 and rng.random() < 0.3:
            del data[at:at + rng.randint(1, 64)]
        elif kind == 4 and rng.random() < 0.3:
            data = data[:max(1, at)]
    return bytes(data)


def run(arguments, folder):
    process = subprocess.Popen(arguments, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, start_new_session=True)
    timer = threading.Timer(SECONDS, process.kill)
    timer.start()
    err = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    late = not timer.is_alive()
    timer.cancel()
    code = os.waitstatus_to_exitcode(status)
    process.returncode = code
    if late:
        return "took more than %d s" % SECONDS
    if usage.ru_maxrss * 1024 > BYTES:
        return "took %.1f GB" % (usage.ru_maxrss * 1024 / 1e9)
    if code not in (0, 2, 3):
        return "ended with %d: %s" % (code, err.decode("utf-8", "replace").strip()[:200])
    errors = [line for line in err.decode("utf-8", "replace").split("\n") if line.startswith("alcove: ") and "warning" not in line]
    if code != 0 and len(errors) != 1:
        return "printed %d error lines instead of one" % len(errors)
    return None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    program = os.path.abspath(options.program)
    rng = random.Random(options.seed)
    folder = tempfile.mkdtemp(prefix="alcove_mutations_")
    with open(os.path.join(folder, "box.off"), "w") as mesh:
        mesh.write("OFF 8 6 0\n" + "\n".join("%d %d %d" % (i & 1, i >> 1 & 1, i >> 2) for i in range(8)) +
                   "\n4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n")
    subprocess.run([program, "voxelize", "box.off", "-o", "box.vdb", "--voxel", "3%", "--quiet"], cwd=folder, check=True)
    scenes = []
    for scene in options.scenes:
        with open(scene, encoding="utf-8") as text:
            # Use a small mesh in place of the meshes of the scenes.
            scenes.append(re.sub(r'file = ".*"', 'file = "box.off"', text.read()))
    scenes.append('[ground]\n[[object]]\nshape = "vdb"\nfile = "box.vdb"\nrotate = [10, 20, 30]\n')
    with open(os.path.join(folder, "box.vdb"), "rb") as grid:
        level_set = grid.read()
    render_options = ["-o", "out.png", "--size", "32x24", "--pixel-samples", "1", "--method", "traced", "--rays", "4", "--quiet"]
    failures = 0
    for i in range(options.count):
        if i % 2 == 0:
            name, data = "mutant.toml", damage_text(rng.choice(scenes), rng)
            arguments = [option for option in render_options if option not in ("--method", "traced", "--rays", "4")]
        else:
            name, data = "mutant.vdb", damage_bytes(level_set, rng)
            arguments = render_options
        verb = ["info", name] if name.endswith(".vdb") and rng.random() < 0.5 else ["render", name] + arguments
        with open(os.path.join(folder, name), "wb") as mutant:
            mutant.write(data)
        wrong = run([program] + verb, folder)
        if wrong:
            failures += 1
            kept = "failure_%d_%s" % (i, name)
            shutil.copy(os.path.join(folder, name), os.path.join(folder, kept))
            print("%s: %s" % (kept, wrong))
    print("%d mutations, seed %d: %d failures" % (options.count, options.seed, failures))
    if failures:
        print("kept in " + folder)
        return 1
    shutil.rmtree(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
