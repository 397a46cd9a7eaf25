#!/usr/bin/env python3
"""Measures what partial grid levels gain on parts with thin walls and narrow gaps.

    bench/thin_parts.py [--alcove PROGRAM] [--keep DIR]

Makes 24 parts: a block with ribs, slits, a thin wall or a second block close by, in arbitrary orientations. These
features are 0.5 to 2 voxels thick or wide (a voxel is 1/256 of the diagonal) and cover less than a tenth of the
surface. Bakes each with traced:64, with the voxel fixed and with --voxel auto, which adds partial levels, and prints
the RMSE that the pilot measures and how much longer and larger the grid is.
"""

import argparse
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

from solids import blocks, steps

VOXEL = 1 / 256
THICKNESSES = (0.5, 0.7, 1.0, 1.3, 1.7, 2.0)


def lines(*pieces):
    """The positions of planes: each piece (first, last, count) is divided into steps; repeats are left out."""
    positions = sorted({round(x, 9) for first, last, count in pieces for x in steps(first, last, count)})
    return [x for i, x in enumerate(positions) if i == 0 or x - positions[i - 1] > 1e-7]


def solid(xs, ys, zs, is_filled):
    """The surface of the cells whose middle is filled."""
    middle = [[(a + b) / 2 for a, b in zip(planes, planes[1:])] for planes in (xs, ys, zs)]
    return blocks(xs, ys, zs, lambda i, j, k: is_filled(middle[0][i], middle[1][j], middle[2][k]))


def with_ribs(t):
    ribs = [(0.25, 0.25 + t), (0.5, 0.5 + t)]
    xs = lines((0, 0.25, 10), (0.25 + t, 0.5, 10), (0.5 + t, 1, 20))
    ys, zs = lines((0, 1, 40)), lines((0, 0.6, 24), (0.6, 0.7, 6))
    return solid(xs, ys, zs, lambda x, y, z: z < 0.6 or (0.3 < y < 0.6 and any(a < x < b for a, b in ribs)))


def with_slits(t):
    slits = [(0.3, 0.3 + t), (0.7, 0.7 + t)]
    xs = lines((0, 0.3, 12), (0.3 + t, 0.7, 16), (0.7 + t, 1, 12))
    ys, zs = lines((0, 1, 40)), lines((0, 0.5, 20), (0.5, 0.6, 6))
    return solid(xs, ys, zs, lambda x, y, z: z < 0.5 or not (0.3 < y < 0.6 and any(a < x < b for a, b in slits)))


def with_thin_wall(t):
    """A pocket beside an outer face."""
    xs = lines((0, t, 1), (t, 0.2, 8), (0.2, 1, 30))
    ys, zs = lines((0, 1, 40)), lines((0, 0.4, 16), (0.4, 0.6, 8))
    return solid(xs, ys, zs, lambda x, y, z: not (t < x < 0.2 and 0.3 < y < 0.6 and z > 0.4))


def with_neighbour(t):
    xs = lines((0, 0.7, 28), (0.7, 0.7 + t, 1), (0.7 + t, 1, 12))
    ys, zs = lines((0, 1, 40)), lines((0, 0.6, 24))
    return solid(xs, ys, zs, lambda x, y, z: x < 0.7 or (x > 0.7 + t and 0.35 < y < 0.65 and 0.1 < z < 0.4))


def turned(mesh, seed):
    """Rotates a mesh about its three axes, by random angles."""
    source = random.Random(seed)
    for a, b in ((0, 1), (1, 2), (0, 2)):
        angle = source.uniform(0, 2 * math.pi)
        c, s = math.cos(angle), math.sin(angle)
        for i, point in enumerate(mesh.points):
            p = list(point)
            p[a], p[b] = c * p[a] - s * p[b], s * p[a] + c * p[b]
            mesh.points[i] = tuple(p)
    return mesh


def diagonal(mesh):
    return math.dist([min(axis) for axis in zip(*mesh.points)], [max(axis) for axis in zip(*mesh.points)])


def make(function, thickness, seed, file):
    """Writes a part. The voxel is a share of the diagonal of the turned part, so two passes find the thickness."""
    t = thickness * VOXEL
    for _ in range(2):
        mesh = turned(function(t), seed)
        t = thickness * VOXEL * diagonal(mesh)
    with open(file, "w", encoding="ascii") as out:
        out.write(f"OFF\n{len(mesh.points)} {len(mesh.faces)} 0\n")
        out.writelines("{:.9g} {:.9g} {:.9g}\n".format(*p) for p in mesh.points)
        out.writelines(f"{len(face)} {' '.join(map(str, face))}\n" for face in mesh.faces)


def bake(alcove, file, out, *options):
    command = [alcove, "bake", file, "-o", out, "--method", "traced", "--rays", "64", "--threads", "1", "--json",
               *options]
    result = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    return result["estimated_rmse"], result["seconds"]["grid"], result["grid_bytes"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--alcove", default="build/alcove", help="the program (default: build/alcove)")
    parser.add_argument("--keep", type=pathlib.Path, metavar="DIR", help="keep the parts")
    arguments = parser.parse_args()
    errors, times, sizes = [], [], []
    with tempfile.TemporaryDirectory() as scratch:
        folder = arguments.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        for function in (with_ribs, with_slits, with_thin_wall, with_neighbour):
            for i, thickness in enumerate(THICKNESSES):
                file = folder / f"{function.__name__}_{thickness}.off"
                make(function, thickness, i, file)
                fixed = bake(arguments.alcove, file, f"{scratch}/a.ply", "--voxel", f"{100 * VOXEL}%")
                refined = bake(arguments.alcove, file, f"{scratch}/a.ply")
                errors.append(refined[0])
                times.append(refined[1] / fixed[1])
                sizes.append(refined[2] / fixed[2])
                print(f"{file.stem:24} RMSE {fixed[0]:.4f} -> {refined[0]:.4f}   grid time x {times[-1]:.2f}, "
                      f"bytes x {sizes[-1]:.2f}", flush=True)
    good = sum(error <= 0.03 for error in errors)
    print(f"RMSE at most 0.03 on {good} of {len(errors)}; grid time x {statistics.mean(times):.2f}, bytes x "
          f"{statistics.mean(sizes):.2f} on average, {max(sizes):.2f} at most")
    return 0


if __name__ == "__main__":
    sys.exit(main())
