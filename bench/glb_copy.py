#!/usr/bin/env python3
"""Compares reading and writing a .glb, without baking, with cp and fsync: wall-clock time, and peak memory.

    bench/glb_copy.py [--megabytes 100] [--repeat 15] [--program build/bench/alcove_copy_mesh] [FOLDER]

The mesh is dense and has normals. cp and alcove_copy_mesh read it from the page cache and write to FOLDER (default: .),
in turn; times are medians.
"""
import argparse
import array
import json
import math
import os
import statistics
import struct
import subprocess
import tempfile
import time


def glb(size):
    """Waves of n x n vertices, at 48 bytes each."""
    n = math.isqrt(size // 48)
    positions = (c for y in range(n) for x in range(n) for c in (x, y, 100 * math.sin(0.01 * x)))
    slopes = [math.cos(0.01 * x) for x in range(n)]
    normals = (c / math.hypot(slope, 1) for _ in range(n) for slope in slopes for c in (-slope, 0, 1))
    corners = (c for y in range(n - 1) for v in range(n * y, n * y + n - 1)
               for c in (v, v + 1, v + n + 1, v, v + n + 1, v + n))
    parts = [array.array('f', positions), array.array('f', normals), array.array('I', corners)]
    binary = b''.join(part.tobytes() for part in parts)
    text = json.dumps({
        'asset': {'version': '2.0'}, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
        'meshes': [{'primitives': [{'attributes': {'POSITION': 0, 'NORMAL': 1}, 'indices': 2}]}],
        'accessors': [{'bufferView': 0, 'componentType': 5126, 'type': 'VEC3', 'count': n * n},
                      {'bufferView': 1, 'componentType': 5126, 'type': 'VEC3', 'count': n * n},
                      {'bufferView': 2, 'componentType': 5125, 'type': 'SCALAR', 'count': len(parts[2])}],
        'bufferViews': [{'buffer': 0, 'byteOffset': 4 * sum(map(len, parts[:i])), 'byteLength': 4 * len(parts[i])}
                        for i in range(3)],
        'buffers': [{'byteLength': len(binary)}]}).encode()
    text += b' ' * (-len(text) % 4)
    return (struct.pack('<4s3I4s', b'glTF', 2, 28 + len(text) + len(binary), len(text), b'JSON') + text +
            struct.pack('<I4s', len(binary), b'BIN\0') + binary)


def timed(command, output):
    """The seconds until the output is on the disk, and what the command printed."""
    begin = time.perf_counter()
    printed = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    with open(output, 'rb') as file:
        os.fsync(file)
    seconds = time.perf_counter() - begin
    os.remove(output)
    return seconds, printed


parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument('--megabytes', type=float, default=100)
parser.add_argument('--repeat', type=int, default=15)
parser.add_argument('--program', default='build/bench/alcove_copy_mesh')
parser.add_argument('folder', nargs='?', default='.')
arguments = parser.parse_args()
with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
    source, output = os.path.join(folder, 'in.glb'), os.path.join(folder, 'out.glb')
    with open(source, 'wb') as file:
        size = file.write(glb(int(arguments.megabytes * 1e6)))
        os.fsync(file)
    runs = [(timed(['cp', source, output], output)[0], *timed([arguments.program, source, output], output))
            for _ in range(arguments.repeat)]
copied, written = (statistics.median(run[i] for run in runs) for i in (0, 1))
peak = max(int(run[2]) for run in runs)
print(f'{size / 1e6:.0f} MB: cp and fsync {copied:.3f} s, read and written {written:.3f} s: '
      f'{written / copied:.2f} x the time, {peak / size:.2f} x the size in memory')
