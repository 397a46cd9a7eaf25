#!/usr/bin/env python3
"""Unwraps a mesh for tests of texture maps: projects charts of faces that face the same axis, and packs them.

    bench/unwrap.py INPUT.off|.obj OUTPUT.obj [--gap 0.002] [--cells N]

Writes an OBJ with one texture coordinate per vertex and chart, and no normals. Polygons stay polygons.
"""
import argparse
import math


def read(path):
    with open(path) as file:
        lines = [line.split('#')[0].split() for line in file]
    lines = [line for line in lines if line]
    if path.endswith('.obj'):
        points = [tuple(map(float, line[1:4])) for line in lines if line[0] == 'v']
        faces = [[int(corner.split('/')[0]) - 1 for corner in line[1:]] for line in lines if line[0] == 'f']
        return points, faces
    numbers = [number for line in lines for number in line]
    assert numbers[0] == 'OFF'
    count, face_count, at = int(numbers[1]), int(numbers[2]), 4
    points = [tuple(map(float, numbers[at + 3 * i:at + 3 * i + 3])) for i in range(count)]
    at += 3 * count
    faces = []
    for _ in range(face_count):
        corners = int(numbers[at])
        faces.append([int(number) for number in numbers[at + 1:at + 1 + corners]])
        at += 1 + corners
    return points, faces


def normal(points, face):
    sums = [0.0, 0.0, 0.0]
    for k, v in enumerate(face):
        a, b = points[v], points[face[(k + 1) % len(face)]]
        for axis in range(3):
            u, w = (axis + 1) % 3, (axis + 2) % 3
            sums[axis] += (a[u] - b[u]) * (a[w] + b[w])
    return sums


def clustered(points, faces, cells):
    """A coarser mesh, in which all vertices in a cell become one; `cells` cells fit along its longest side."""
    low = [min(p[k] for p in points) for k in range(3)]
    cell = max(max(p[k] for p in points) - low[k] for k in range(3)) / cells
    number, sums, vertex_of = {}, [], []
    for p in points:
        i = number.setdefault(tuple(int((p[k] - low[k]) / cell) for k in range(3)), len(number))
        if i == len(sums):
            sums.append([0.0, 0.0, 0.0, 0])
        sums[i] = [sums[i][k] + p[k] for k in range(3)] + [sums[i][3] + 1]
        vertex_of.append(i)
    kept, known = [], set()
    for face in faces:
        corners = [vertex_of[v] for v in face]
        key = tuple(sorted(corners))
        if len(set(corners)) == len(corners) and key not in known:
            known.add(key)
            kept.append(corners)
    return [tuple(s[k] / s[3] for k in range(3)) for s in sums], kept


def charts(points, faces):
    """The chart of each face: connected faces that point along the same axis."""
    sides = []
    for face in faces:
        n = normal(points, face)
        axis = max(range(3), key=lambda k: abs(n[k]))
        sides.append((axis, n[axis] > 0))
    chart = list(range(len(faces)))

    def root(f):
        while chart[f] != f:
            chart[f] = chart[chart[f]]
            f = chart[f]
        return f

    edges = {}
    for f, face in enumerate(faces):
        for k, v in enumerate(face):
            edge = tuple(sorted((v, face[(k + 1) % len(face)])))
            other = edges.setdefault((edge, sides[f]), f)
            chart[root(f)] = root(other)
    return [root(f) for f in range(len(faces))], sides


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('input')
    parser.add_argument('output')
    parser.add_argument('--gap', type=float, default=0.002, help='between charts, in UV')
    parser.add_argument('--cells', type=int, help='cluster the vertices first, with this many cells along the longest side')
    arguments = parser.parse_args()
    points, faces = read(arguments.input)
    if arguments.cells:
        points, faces = clustered(points, faces, arguments.cells)
    chart, sides = charts(points, faces)
    flat = {}  # (chart, vertex) -> position in the plane of the chart
    boxes = {}
    for f, face in enumerate(faces):
        axis, front = sides[f]
        u, v = ((axis + 1) % 3, (axis + 2) % 3) if front else ((axis + 2) % 3, (axis + 1) % 3)
        for vertex in face:
            p = (points[vertex][u], points[vertex][v])
            flat[chart[f], vertex] = p
            low, high = boxes.get(chart[f], (p, p))
            boxes[chart[f]] = ((min(low[0], p[0]), min(low[1], p[1])), (max(high[0], p[0]), max(high[1], p[1])))
    size = {c: (high[0] - low[0], high[1] - low[1]) for c, (low, high) in boxes.items()}
    order = sorted(size, key=lambda c: -size[c][1])
    side = math.sqrt(sum(w * h for w, h in size.values())) or 1.0
    while True:  # find the smallest square that holds all rows
        gap, place, x, y, row = arguments.gap * side, {}, 0.0, 0.0, 0.0
        for c in order:
            w, h = size[c]
            if x > 0.0 and x + w + gap > side:
                x, y, row = 0.0, y + row + gap, 0.0
            place[c] = (x, y)
            x, row = x + w + gap, max(row, h)
        if y + row + gap <= side:
            break
        side *= 1.02
    uvs = {}
    with open(arguments.output, 'w') as out:
        for p in points:
            out.write('v %.9g %.9g %.9g\n' % p)
        for (c, vertex), p in flat.items():
            uvs[c, vertex] = len(uvs) + 1
            out.write('vt %.9g %.9g\n' % tuple(
                (place[c][k] + p[k] - boxes[c][0][k] + 0.5 * gap) / side for k in range(2)))
        for f, face in enumerate(faces):
            out.write('f ' + ' '.join('%d/%d' % (v + 1, uvs[chart[f], v]) for v in face) + '\n')
    print('%d charts' % len(size))


if __name__ == '__main__':
    main()
