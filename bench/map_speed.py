#!/usr/bin/env python3
"""Compares the CPU time of texture maps with that of exact rays at every texel, at the same error.

    bench/map_speed.py [--sizes 2048,4096] [--repeat 5] [--alcove PROGRAM] MESH.obj...

The rays are those of --method exact --no-pilot: Embree alone, in streams, without a grid. Their number is the
smallest for which the RMSE of a map of 512 x 512, against a map of 1,024 rays, is at most the error of the quality.
Runs whole programs on one thread, in turn, and prints medians of the CPU seconds. Meshes need UVs, such as those that
bench/unwrap.py writes.
"""
import argparse
import math
import os
import resource
import statistics
import subprocess
import tempfile

from map_errors import ALCOVE, bake

ERRORS = {'draft': 0.05, 'good': 0.02}


def rays_of_error(mesh, error):
    """The smallest number of exact rays that reaches this RMSE. The RMSE falls as the number grows."""
    _, truth = bake(mesh, 512, '--method', 'exact', '--rays', '1024', '--seed', '7', '--no-pilot')

    def is_enough(rays):
        made, values = bake(mesh, 512, '--method', 'exact', '--rays', str(rays), '--no-pilot')
        return math.sqrt(sum((a - b) ** 2 for a, b in zip(values, truth)) / made['texels']) <= error

    least, enough = 1, 256
    while least < enough:
        middle = (least + enough) // 2
        if is_enough(middle):
            enough = middle
        else:
            least = middle + 1
    return enough


def cpu_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--sizes', default='2048,4096')
    parser.add_argument('--repeat', type=int, default=5)
    parser.add_argument('--alcove', default=ALCOVE)
    parser.add_argument('meshes', nargs='+')
    arguments = parser.parse_args()
    print('%-24s %6s  %-7s %8s %5s %8s %6s' % ('mesh', 'size', 'quality', 's', 'rays', 's', 'ratio'))
    for mesh in arguments.meshes:
        for quality, error in ERRORS.items():
            rays = rays_of_error(mesh, error)
            for size in arguments.sizes.split(','):
                with tempfile.TemporaryDirectory() as folder:
                    common = [arguments.alcove, 'bake', mesh, '-o', os.path.join(folder, 'map.png'), '--size', size,
                              '--threads', '1', '--quiet']
                    ours, exact = [], []
                    for _ in range(arguments.repeat):
                        ours.append(cpu_seconds(common + ['--quality', quality]))
                        exact.append(cpu_seconds(common + ['--method', 'exact', '--rays', str(rays), '--no-pilot']))
                a, b = statistics.median(ours), statistics.median(exact)
                print('%-24s %6s  %-7s %8.2f %5d %8.2f %6.2f' % (
                    os.path.basename(mesh), size, quality, a, rays, b, b / a), flush=True)


if __name__ == '__main__':
    main()
