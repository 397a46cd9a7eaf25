#!/usr/bin/env python3
"""Prints how much a texture map differs between the two sides of its UV seams, compared with a map of exact rays.

    bench/seam_differences.py [--size 1024] MESH.obj...

Samples both maps bilinearly at points along each seam, on both sides, and prints the 95th percentile of the
differences in units of 1/255. Meshes need UVs, such as those that bench/unwrap.py writes. Uses build/alcove.
"""
import argparse
import importlib.util
import os
import subprocess
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
spec = importlib.util.spec_from_file_location('map_errors', os.path.join(HERE, 'map_errors.py'))
map_errors = importlib.util.module_from_spec(spec)
spec.loader.exec_module(map_errors)
STEPS = 5  # points along an edge


def seams(path):
    """Pairs of UV segments: the two sides of each edge at which its faces have different UVs."""
    uvs, sides, pairs = [], {}, []
    for line in open(path):
        words = line.split()
        if words[:1] == ['vt']:
            uvs.append((float(words[1]), float(words[2])))
        elif words[:1] == ['f']:
            corners = [tuple(int(n) for n in word.split('/')[:2]) for word in words[1:]]
            for (a, ua), (b, ub) in zip(corners, corners[1:] + corners[:1]):
                other = sides.pop((b, a), None)
                if other is None:
                    sides[a, b] = (ua, ub)
                elif other != (ub, ua):
                    pairs.append(((uvs[ua - 1], uvs[ub - 1]), (uvs[other[1] - 1], uvs[other[0] - 1])))
    return pairs


def sample(values, size, uv):
    x, y = uv[0] * size - 0.5, (1 - uv[1]) * size - 0.5
    i, j = min(max(int(x), 0), size - 2), min(max(int(y), 0), size - 2)
    s, t = min(max(x - i, 0), 1), min(max(y - j, 0), 1)
    row = j * size + i
    top = values[row] * (1 - s) + values[row + 1] * s
    bottom = values[row + size] * (1 - s) + values[row + size + 1] * s
    return top * (1 - t) + bottom * t


def percentile(path, size, pairs, *options):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, 'map.png')
        subprocess.run([map_errors.ALCOVE, 'bake', path, '-o', out, '--size', str(size), '--depth', '16', '--quiet', *options],
                       check=True, stderr=subprocess.DEVNULL)
        values = map_errors.read_grey(out)
    differences = []
    for (a, b), (c, d) in pairs:
        for step in range(STEPS):
            t = (step + 0.5) / STEPS
            differences.append(abs(sample(values, size, [p + t * (q - p) for p, q in zip(a, b)]) -
                                   sample(values, size, [p + t * (q - p) for p, q in zip(c, d)])))
    differences.sort()
    return 255 * differences[int(0.95 * (len(differences) - 1))]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('meshes', nargs='+')
    parser.add_argument('--size', type=int, default=1024)
    options = parser.parse_args()
    for path in options.meshes:
        pairs = seams(path)
        fine = percentile(path, options.size, pairs, '--quality', 'fine')
        exact = percentile(path, options.size, pairs, '--method', 'exact', '--rays', '1024', '--no-pilot')
        print('%s: %d seam edges; fine %.2f, exact %.2f' % (os.path.basename(path), len(pairs), fine, exact))


if __name__ == "__main__":
    main()
