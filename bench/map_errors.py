#!/usr/bin/env python3
"""Prints the RMSE of texture maps against exact rays at the same texels, and the RMSE that the bake estimates.

    bench/map_errors.py [--size 512] [--rays 1024] MESH.obj...

Meshes need UVs, such as those that bench/unwrap.py writes. Uses build/alcove.
"""
import argparse
import array
import json
import math
import os
import struct
import subprocess
import tempfile
import zlib

ALCOVE = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'build', 'alcove')


def read_grey(path):
    """The values of a 16-bit grey PNG, in [0, 1]."""
    data = open(path, 'rb').read()
    at, packed = 8, b''
    while at < len(data):
        length, kind = struct.unpack('>I4s', data[at:at + 8])
        if kind == b'IHDR':
            width, height, depth, color = struct.unpack('>IIBB', data[at + 8:at + 18])
            assert (depth, color) == (16, 0)
        elif kind == b'IDAT':
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    rows, stride, before = zlib.decompress(packed), 2 * width, bytearray(2 * width)
    values = array.array('H')
    for y in range(height):
        filtered, row = rows[y * (stride + 1)], bytearray(rows[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left, up = (row[i - 2] if i >= 2 else 0), before[i]
            if filtered == 1:
                row[i] = (row[i] + left) & 255
            elif filtered == 2:
                row[i] = (row[i] + up) & 255
            elif filtered == 3:
                row[i] = (row[i] + (left + up) // 2) & 255
            elif filtered == 4:
                corner = before[i - 2] if i >= 2 else 0
                p = left + up - corner
                near = min((abs(p - left), 0, left), (abs(p - up), 1, up), (abs(p - corner), 2, corner))[2]
                row[i] = (row[i] + near) & 255
        values.frombytes(bytes(row))
        before = row
    values.byteswap()
    return [value / 65535 for value in values]


def bake(mesh, size, *options):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, 'map.png')
        done = subprocess.run([ALCOVE, 'bake', mesh, '-o', out, '--size', str(size), '--depth', '16', '--margin',
                               'none', '--json', *options], capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(done.stderr)
        return json.loads(done.stdout), read_grey(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--size', type=int, default=512)
    parser.add_argument('--rays', type=int, default=1024)
    parser.add_argument('--radius', default='10%')
    parser.add_argument('--high', help='a high-poly mesh to bake into the UVs')
    parser.add_argument('meshes', nargs='+')
    arguments = parser.parse_args()
    print('%-24s %9s  %-7s %-16s %9s %8s %9s' % ('mesh', 'texels', 'quality', 'method', 'evaluated', 'RMSE', 'estimate'))
    for mesh in arguments.meshes:
        radius = ['--radius', arguments.radius] + (['--high', arguments.high] if arguments.high else [])
        exact, truth = bake(mesh, arguments.size, '--method', 'exact', '--rays', str(arguments.rays), '--seed', '7',
                            '--no-pilot', *radius)
        for quality in 'draft', 'good', 'fine':
            made, values = bake(mesh, arguments.size, '--quality', quality, *radius)
            rmse = math.sqrt(sum((a - b) ** 2 for a, b in zip(values, truth)) / made['texels'])
            print('%-24s %9d  %-7s %-16s %8.1f%% %8.4f %9.4f' % (
                os.path.basename(mesh), made['texels'], quality, '%s:%s' % (made['method'], made['samples']),
                100 * made['evaluated'], rmse, made['estimated_rmse']), flush=True)


if __name__ == '__main__':
    main()
