#!/usr/bin/env python3
"""Writes 40 hard-surface parts and 3 scan-like meshes, none of which is in the archive of the tests.

    bench/make_parts.py [--check] [--scans DIR] OUT_DIR

The parts are typical of CAD exports and game assets, and are written as .stl, .obj and .off in turn. The scans are
scans from the archive, subdivided and roughened, and are written as .ply. Everything is made from fixed seeds. --check
reads the files back and reports what is wrong with them.
"""

import argparse
import array
import collections
import itertools
import math
import pathlib
import random
import struct
import sys
import time

from solids import (TAU, blocks, box, circle, cross, cylinder, dot, icosphere, joined, lathe, loft, Mesh, minus, plus,
                    polar, prism, rectangle, rod, rounded_rectangle, sheet, slab, spaced, split, steps, subdivided,
                    sweep, tube, unit)

FORMATS = ("stl", "obj", "off")
PART_SIZES = range(100, 20001)
SCAN_SIZES = range(220000, 450001)


# Parts, in the order of their files. Most are in millimetres.

PARTS = []


def part(closed):
    """Registers a part. `closed`: each edge has one face on either side."""
    def register(function):
        PARTS.append((function, closed))
        return function
    return register


@part(closed=True)
def plate_with_holes():
    holes = [circle(14 + 19 * i, 12 + 19 * j, 6, 20) for i in range(8) for j in range(5)]
    return prism([rectangle(0, 0, 161, 100), *holes], 0, 8)


@part(closed=True)
def pocketed_box():
    """A block with pockets of two depths."""
    def is_filled(i, j, k):
        return k == 0 or i % 2 == 0 or j % 2 == 0 or k == 1 and (i + j) % 4 == 0
    return blocks(spaced(5, 22, 3), spaced(4, 16, 2), (0, 4, 15, 30), is_filled)


@part(closed=True)
def ribbed_box():
    """An open box with ribs of two heights and a slot in a wall."""
    xs, ys, zs = spaced(7, 14, 1.5), spaced(5, 14, 1.5), (0, 2, 18, 40)

    def is_filled(i, j, k):
        if i in (0, 14) or j in (0, 10):
            return k < 2 or i != 7
        return k == 0 or k == 1 and (i % 4 == 0 or j % 4 == 0)
    return blocks(xs, ys, zs, is_filled)


@part(closed=True)
def stepped_shaft():
    """A shaft with steps, chamfers and grooves, in quads as long as the steps."""
    profile, z = [(0, 0)], 0.0
    for radius, length in ((8, 30), (6.5, 3), (10, 60), (16, 6), (12, 80), (10.5, 2), (12, 25), (7, 40)):
        profile += [(radius - 0.5, z), (radius, z + 0.5), (radius, z + length - 0.5), (radius - 0.5, z + length)]
        z += length
    return lathe(profile + [(0, z)], 64)


@part(closed=True)
def flange():
    """A disc with bolt holes, and a neck that runs into it."""
    bolts = [circle(x, y, 5, 24) for x, y in circle(0, 0, 40, 8)]
    disc = prism([circle(0, 0, 52, 96), circle(0, 0, 18, 64), *bolts], 0, 10)
    neck = lathe([(28, 8), (27, 14), (22.2, 30), (22.2, 55), (20.2, 57), (18.5, 57), (18.5, 8)], 72, wraps=True)
    return joined(disc, neck)


@part(closed=True)
def spur_gear():
    outline = []
    for tooth in range(28):
        for share, radius in ((0, 25.5), (0.18, 25.5), (0.24, 27), (0.31, 29), (0.40, 31), (0.60, 31), (0.69, 29),
                              (0.76, 27), (0.82, 25.5)):
            outline.append(polar(radius, TAU * (tooth + share) / 28))
    bore = [p for p in circle(0, 0, 7, 60) if p[0] < 6.5] + [(6.5, -2), (9, -2), (9, 2), (6.5, 2)]
    bore.sort(key=lambda p: math.atan2(p[1], p[0]))
    windows = [circle(x, y, 4, 28) for x, y in circle(0, 0, 17, 5)]
    return prism([outline, bore, *windows], 0, 12)


@part(closed=True)
def rack():
    outline = [(0, 0), (40 * 6.28, 0)]
    for tooth in range(39, -1, -1):
        outline += [((tooth + share) * 6.28, y) for share, y in ((0.9, 10), (0.65, 14.5), (0.35, 14.5), (0.1, 10))]
    return prism([outline], 0, 15)


@part(closed=True)
def screw():
    """A threaded shank that ends inside a head with a hexagonal socket."""
    count, along = 48, 200

    def ring(i):
        z = 60 * i / along
        depth = min(1.0, z / 3) * min(1.0, (60 - z) / 10)
        heights = (1 - abs(2 * ((z / 1.5 - j / count) % 1) - 1) for j in range(count))
        return [(*polar(4.2 + 0.8 * depth * height, TAU * j / count), z) for j, height in enumerate(heights)]
    shank = loft([ring(i) for i in range(along + 1)], ends=((0, 0, -1), (0, 0, 60)))
    head = prism([circle(0, 0, 7.5, 60), circle(0, 0, 3.5, 6)], 62, 67)
    return joined(shank, cylinder(7.3, 59, 63, 60), head)


@part(closed=True)
def pipe_elbow():
    """A hollow bend with a collar at each end."""
    path = [(80 - 80 * math.cos(TAU / 4 * i / 40), 0, 80 * math.sin(TAU / 4 * i / 40)) for i in range(41)]

    def rings(radius):
        for i, centre in enumerate(path):
            angle = TAU / 4 * i / 40
            yield [plus(plus(centre, (math.cos(angle), 0, -math.sin(angle)), u), (0, 1, 0), v)
                   for u, v in circle(0, 0, radius, 40)]
    bend = loft(list(rings(20)) + list(rings(17))[::-1], wraps=True)
    collar = tube(28, 18.5, -6, 2, 56)
    return joined(bend, collar, collar.turned(1, -90).moved(80, 0, 80))


@part(closed=True)
def tubes():
    """A bundle of tubes with walls of half a millimetre to three millimetres."""
    result = Mesh()
    for i in range(7):
        x, y = polar(22 if i else 0, TAU * i / 6)
        result.add(tube(10, 9.5 - 0.4 * i, -4 * i, 120 + 5 * i, 32 + 4 * i).moved(x, y, 0))
    return result.scaled(1000)


@part(closed=True)
def u_channel():
    """A channel with slots in its base and notches in its sides."""
    xs, ys, zs = spaced(12, 18, 12), (0, 3, 18, 22, 37, 40), (0, 3, 20, 40)

    def is_filled(i, j, k):
        if j in (0, 4):
            return k < 2 or i % 4 != 1
        return k == 0 and not (j == 2 and i % 2)
    return blocks(xs, ys, zs, is_filled)


@part(closed=True)
def bracket_with_gussets():
    """Two plates with holes and two gussets, which overlap."""
    holes = [circle(x, y, 4.5, 32) for x in (20, 50, 80) for y in (30, 50)]
    plate = prism([rounded_rectangle(0, 0, 100, 64, 6, 8), *holes], 0, 5)
    gusset = prism([[(3, 3), (50, 3), (50, 8), (8, 50), (3, 50)]], 0, 4)
    return joined(plate, plate.turned(0, 90).moved(0, 4.5, -0.5),
                  *(gusset.cycled().moved(x, 1, 1) for x in (33, 63)))


@part(closed=True)
def heat_sink():
    """Fins in three rows on a base."""
    xs = spaced(24, 2.2, 1)
    return blocks(xs, (0, 22, 25, 47, 50, 72), (0, 4, 28), lambda i, j, k: k == 0 or i % 2 == 0 and j % 2 == 0)


@part(closed=True)
def staircase():
    """Solid steps with balusters and a handrail that run into each other."""
    count = 14
    stairs = blocks(steps(0, 28 * count, count), (0, 100), steps(0, 18 * count, count), lambda i, j, k: k <= i)
    for i in range(count):
        stairs.add(cylinder(1.5, 18 * i + 10, 18 * i + 105, 10).moved(28 * i + 14, 8, 0))
    return stairs.add(sweep([(0, 8, 100), (28 * count, 8, 100 + 18 * count)], rectangle(-3, -2, 3, 2), (0, 0, 1)))


@part(closed=True)
def table_set():
    """A table and chairs of boxes that overlap."""
    table = joined(box(-60, -40, 70, 60, 40, 74), *(box(x - 3, y - 3, 0, x + 3, y + 3, 72)
                                                   for x in (-52, 52) for y in (-32, 32)),
                   box(-52, -33, 62, 52, -31, 71), box(-52, 31, 62, 52, 33, 71))
    chair = joined(box(-20, -20, 42, 20, 20, 45), *(box(x - 2, -19, 0, x + 2, -15, 44) for x in (-17, 17)),
                   *(box(x - 2, 15, 0, x + 2, 19, 90) for x in (-17, 17)),
                   *(box(-18, 16, z, 18, 18, z + 6) for z in (55, 67, 79)))
    for i, (x, y) in enumerate(((-30, 55), (30, 62), (-30, -55), (30, -48), (82, 3), (-85, -2))):
        table.add(chair.turned(2, (0, 8, 180, 172, -90, 95)[i]).moved(x, y, 0))
    return table.scaled(0.01)


@part(closed=True)
def chain():
    """Links that pass through each other."""
    path = [(8 * math.copysign(1, math.cos(t)) + 10 * math.cos(t), 10 * math.sin(t), 0)
            for t in (TAU * (i + 0.5) / 48 for i in range(48))]
    link = sweep(path, circle(0, 0, 3.5, 16), (0, 0, 1), wraps=True)
    return joined(*(link.turned(0, 90 * (i % 2) + 4 * i).moved(27 * i, 0, 0) for i in range(20)))


@part(closed=True)
def coil_spring():
    turns, count = 9, 48
    pitch = [min(max(i / count - 1, 0), turns - 2) for i in range(turns * count + 1)]
    path = [(*polar(20, TAU * i / count), 9 * pitch[i] + 4.2 * i / count) for i in range(turns * count + 1)]
    return sweep(path, circle(0, 0, 2, 14), (0, 0, 1))


@part(closed=True)
def letters():
    """Words made of polygons, with coplanar backs."""
    shapes = {
        "E": [(0, 0), (6, 0), (6, 1.6), (2, 1.6), (2, 4.2), (5, 4.2), (5, 5.8), (2, 5.8), (2, 8.4), (6, 8.4), (6, 10),
              (0, 10)],
        "H": [(0, 0), (2, 0), (2, 4), (5, 4), (5, 0), (7, 0), (7, 10), (5, 10), (5, 6), (2, 6), (2, 10), (0, 10)],
        "T": [(3, 0), (5, 0), (5, 8), (8, 8), (8, 10), (0, 10), (0, 8), (3, 8)],
        "L": [(0, 0), (6, 0), (6, 2), (2, 2), (2, 10), (0, 10)]}
    result = box(-2, -28, -1, 42, 13, 0.25)
    for line, word in enumerate(("TELL", "THE", "LETHE")):
        for place, letter in enumerate(word):
            result.add(prism([shapes[letter]], 0, 2.5).moved(8.4 * place, -13 * line, 0))
    return result


@part(closed=True)
def house():
    """Walls with open windows around a room, under a roof."""
    def wall(length, openings):
        return prism([rectangle(0, 0, length, 28), *(rectangle(*o) for o in openings)], 0, 2).turned(0, 90)
    windows = [(8, 10, 18, 22), (42, 10, 52, 22)]
    result = joined(wall(60, windows + [(25, 1, 35, 21)]).moved(0, 2, 0), wall(60, windows).moved(0, 40, 0))
    for x in (2, 60):
        result.add(wall(40, [(6, 10, 15, 22), (25, 10, 34, 22)]).turned(2, 90).moved(x - 2, 0, 0))
    result.add(box(-1, -1, -2, 61, 41, 0.5), box(0.5, 0.5, 27, 59.5, 39.5, 28.5), box(20, 14, 0, 36, 24, 8))
    gable = prism([[(0, 27.5), (40, 27.5), (20, 43)]], 0, 2).turned(0, 90).turned(2, 90)
    result.add(gable.moved(0.2, 0, 0), gable.moved(57.8, 0, 0))
    for way in (-1, 1):
        roof = prism([[(0, 43), (24, 24.4), (24, 26.4), (0, 45)]], -3, 63).cycled()
        result.add(roof.mapped(lambda p, way=way: (p[0], 20 + way * (p[1] - 0.5), p[2])).outward())
    for x, y in ((13, -0.3), (47, -0.3), (13, 37.7), (47, 37.7)):
        result.add(box(x - 0.4, y, 9.5, x + 0.4, y + 1, 22.5), box(x - 5.5, y, 15.5, x + 5.5, y + 1, 16.5))
    return result.add(box(44, 24, 30, 50, 30, 50)).scaled(0.2)


@part(closed=False)
def crate():
    """Planks and braces. Each face has its own points and normals."""
    result = Mesh()
    for axis in range(3):
        for side, plank in itertools.product((0, 1), range(6)):
            board = box(1, 16.4 * plank + 1, 1, 99, 16.4 * plank + 16.4, 5).moved(-50, -50, -50 + 94 * side)
            result.add(split(board, normals=True).turned(0, 90 * (axis == 1)).turned(1, 90 * (axis == 2)))
        for u, v in itertools.product((-1, 1), repeat=2):
            beam = box(-52, -6, -6, 52, 6, 6).moved(0, 46 * u, 46 * v)
            result.add(split(beam, normals=True).turned(2, 90 * (axis == 1)).turned(1, -90 * (axis == 2)))
    for quarter in range(4):
        brace = box(-58, -5, 48, 58, 5, 51).turned(2, 45)
        result.add(split(brace, normals=True).turned(0, 90 * quarter))
    return result


@part(closed=False)
def voxel_blob():
    """Cubes whose faces are merged into rectangles, which leaves T-junctions."""
    noise = Noise(21)
    n = 18
    cells = {c for c in itertools.product(range(n), repeat=3)
             if math.dist(c, (8.5, 8.5, 8.5)) < 7.2 + 3 * noise(c[0] / 4.1, c[1] / 4.1, c[2] / 4.1)}
    mesh, known = Mesh(), {}
    for axis, way, layer in itertools.product(range(3), (0, 1), range(n)):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        open_faces = set()
        for c in cells:
            beyond = list(c)
            beyond[axis] += 1 if way else -1
            if c[axis] == layer and tuple(beyond) not in cells:
                open_faces.add((c[i], c[j]))
        while open_faces:
            u0, v0 = min(open_faces)
            u1 = u0 + 1
            while (u1, v0) in open_faces:
                u1 += 1
            v1 = v0 + 1
            while all((u, v1) in open_faces for u in range(u0, u1)):
                v1 += 1
            open_faces -= set(itertools.product(range(u0, u1), range(v0, v1)))
            face = []
            for u, v in ((u0, v0), (u1, v0), (u1, v1), (u0, v1)):
                at = [0, 0, 0]
                at[axis], at[i], at[j] = layer + way, u, v
                face.append(known.setdefault(tuple(at), len(known)))
            mesh.faces.append(tuple(face if way else face[::-1]))
    mesh.points = list(known)
    return mesh.scaled(25)


@part(closed=True)
def hex_nut():
    """A chamfered, threaded nut of a few millimetres, written in metres."""
    count, height = 48, 8.0

    def ring(radius, z):
        return [(x, y, z) for x, y in circle(0, 0, radius, count)]

    def hexagon(z):
        def radius(angle):
            return 8 / math.cos((angle + TAU / 12) % (TAU / 6) - TAU / 12)
        return [(*polar(radius(angle), angle), z) for angle in steps(0, TAU, count)[:-1]]

    def thread(z):
        radii = (4.5 + 0.5 * abs(2 * ((z / 1.25 - j / count) % 1) - 1) for j in range(count))
        return [(*polar(radius, TAU * j / count), z) for j, radius in enumerate(radii)]
    rings = [ring(7.7, 0), hexagon(0.9), hexagon(height - 0.9), ring(7.7, height), ring(5.5, height)]
    rings += [thread(z) for z in steps(height - 0.4, 0.4, 60)] + [ring(5.5, 0)]
    return loft(rings, wraps=True).scaled(0.001)


@part(closed=True)
def dice():
    """A rounded box with pips sunk into it."""
    grid = steps(-10, 10, 28)
    centre, diagonal = ((0, 0),), ((-4, -4), (4, 4))
    corners = (*diagonal, (-4, 4), (4, -4))
    pips = {(0, 1): centre, (1, 1): diagonal, (2, 1): centre + diagonal, (2, -1): corners, (1, -1): centre + corners,
            (0, -1): (*corners, (-4, 0), (4, 0))}

    def shaped(p):
        inner = tuple(min(max(c, -7.5), 7.5) for c in p)
        way = unit(minus(p, inner))
        shift = 2.5
        for (axis, side), places in pips.items():
            if p[axis] == 10 * side:
                for u, v in places:
                    r = math.hypot(p[(axis + 1) % 3] - u, p[(axis + 2) % 3] - v)
                    shift -= 1.1 * math.sqrt(max(0.0, 1 - (r / 1.7) ** 2))
        return plus(inner, way, shift)
    return blocks(grid, grid, grid, lambda i, j, k: True).mapped(shaped)


@part(closed=False)
def sphere_in_bowl():
    """A ball in a bowl that is a single sheet."""
    profile = [(10 * math.sin(angle), -10 * math.cos(angle)) for angle in steps(0, TAU / 4, 30)]
    bowl = lathe(profile, 72, ends=(None, None))
    return joined(bowl, icosphere(6.5, 4).moved(0.5, 0, -3.2))


@part(closed=True)
def bottle():
    """A thin wall with two sides, turned on a lathe."""
    outer = [(26 * t, 0.4 * (1 - t)) for t in steps(0, 1, 6)[1:]]
    outer += [(30 + 4 * math.sin(TAU / 4 * t - TAU / 4), 4 * t) for t in steps(0, 1, 6)[1:]]
    outer += [(30 + 0.6 * math.sin(z / 3.0), z) for z in steps(8, 110, 60)]
    outer += [(10 + 20 * (0.5 + 0.5 * math.cos(math.pi * t)), 112 + 40 * t) for t in steps(0, 1, 24)]
    outer += [(10, 155), (10, 170), (11.5, 171), (11.5, 175), (10.5, 176)]
    inner = [(max(r - 0.8, 0.5), z + (0.8 if z < 8 else 0)) for r, z in reversed(outer)]
    return lathe([(0, 0.4), *outer, *inner, (0, 1.2)], 64)


@part(closed=True)
def strut_lattice():
    """Struts between the corners and centres of cells, with balls where they meet."""
    corners = list(itertools.product(range(4), repeat=3))
    centres = [(i + 0.5, j + 0.5, k + 0.5) for i, j, k in itertools.product(range(3), repeat=3)]
    result = joined(*(icosphere(0.11, 1).moved(*p) for p in corners + centres))
    for centre, way in itertools.product(centres, itertools.product((-0.5, 0.5), repeat=3)):
        result.add(rod(plus(centre, way), centre, 0.06, 8))
    for p, axis in itertools.product(corners, range(3)):
        if p[axis] < 3:
            end = list(p)
            end[axis] += 1
            result.add(rod(p, tuple(end), 0.045, 7))
    return result


@part(closed=True)
def furnished_room():
    """A room that faces inwards, with furniture made of boxes."""
    def is_air(i, j, _):
        return i > 0 or not 4 <= j < 7  # there is a chimney breast
    room = blocks(steps(0, 5, 18), steps(0, 4, 15), steps(0, 2.6, 10), is_air).flipped()
    bed = (box(0.8, 0.2, 0.2, 2.8, 1.8, 0.5), box(0.7, 0.15, 0.02, 0.85, 1.85, 1.0),
           box(0.9, 0.4, 0.45, 1.3, 1.6, 0.65))
    shelf = [box(4.6, 1, z, 4.95, 2.4, z + 0.04) for z in (0.02, 0.5, 1.0, 1.5, 2.0)]
    shelf += [box(4.6, y, 0.01, 4.96, y + 0.04, 2.1) for y in (0.97, 1.7, 2.39)]
    desk = [box(2.0, 3.3, 0.7, 3.6, 3.95, 0.74)]
    desk += [box(x, y, 0.01, x + 0.06, y + 0.06, 0.72) for x in (2.02, 3.5) for y in (3.32, 3.87)]
    shade = lathe([(0.3, 1.7), (0.08, 1.95), (0.06, 1.95), (0.28, 1.7)], 24, wraps=True)
    lamp = joined(cylinder(0.02, 1.9, 2.59, 8), shade).moved(2.5, 2, 0)
    return joined(room, *bed, *shelf, *desk, lamp)


@part(closed=True)
def needle_cylinders():
    """Cylinders with 280 to 400 sides, some of them one inside another."""
    return joined(cylinder(30, 0, 6, 400), cylinder(22, 5, 90, 360), cylinder(27, 60, 63, 300),
                  lathe([(14, 85), (3, 140)], 380), tube(29.9, 28, 5, 25, 320)).moved(4e4, -2e4, 1e4)


@part(closed=False)
def cubes_on_floor():
    """Cubes of 24 vertices with normals, some of them sunk into a floor that is a single sheet."""
    chance = random.Random(29)
    result = sheet(lambda u, v: (100 * u, 100 * v, 0), 24, 24)
    result.normals = [(0, 0, 1)] * len(result.points)
    for _ in range(80):
        size = chance.uniform(2, 7)
        cube = split(box(-size, -size, -size, size, size, size), normals=True).turned(2, chance.uniform(0, 90))
        if chance.random() < 0.4:
            cube = cube.turned(0, chance.uniform(0, 360)).turned(1, chance.uniform(0, 360))
        result.add(cube.moved(chance.uniform(8, 92), chance.uniform(8, 92), size * chance.uniform(0.6, 1.0)))
    return result


@part(closed=False)
def brick_wall():
    """Bricks of 24 vertices without normals, some of which touch."""
    result = Mesh()
    for row, place in itertools.product(range(12), range(10)):
        gap = 0.0 if (row + place) % 3 else 0.6
        x = 24 * place + 12 * (row % 2)
        result.add(split(box(x, 0, 8 * row, x + 24 - gap, 11, 8 * row + 8 - gap), normals=False))
    return result


@part(closed=True)
def gearbox_housing():
    """Walls, floor, flange and bearing seats, in micrometres and far from the origin."""
    walls = prism([rounded_rectangle(0, 0, 120, 80, 12, 10), rounded_rectangle(5, 5, 115, 75, 8, 10)], 0, 60)
    floor = prism([rounded_rectangle(1, 1, 119, 79, 11, 10), circle(30, 40, 9, 40), circle(80, 40, 14, 48)], 1, 6)
    bolts = [circle(x, y, 2.6, 18) for x in (-5, 30, 60, 90, 125) for y in (-5, 85)]
    rim = prism([rounded_rectangle(-12, -12, 132, 92, 14, 10), rounded_rectangle(5.5, 5.5, 114.5, 74.5, 7, 10), *bolts],
                54, 61)
    seats = [tube(inner + 5, inner, -8, 4, 44).moved(x, 40, 0) for x, inner in ((30, 9.5), (80, 14.5))]
    ribs = [box(x, y, 3, x + 3, y + 10, 57) for x in (15, 58, 101) for y in (-8, 78)]
    return joined(walls, floor, rim, *seats, *ribs).scaled(1000).moved(3e7, 1e7, -5e6)


@part(closed=True)
def bookshelf():
    """Overlapping boards, and books, some of which lean."""
    chance = random.Random(32)
    result = joined(box(-2, 0, 0, 0, 30, 180), box(100, 0, 0, 102, 30, 180), box(-1, 29, 1, 101, 30.5, 179))
    for z in steps(3, 175, 5):
        result.add(box(-1, 0.5, z, 101, 29.5, z + 2))
        x = 1.0
        while z < 170 and x < 92:
            width, height, depth = chance.uniform(1.5, 6), chance.uniform(20, 29), chance.uniform(15, 24)
            lean = chance.choice((0, 0, 0, 0, 12))
            book = box(0, 28 - depth, 0.02, width, 28, height).turned(1, lean)
            result.add(book.moved(x, 0, z + 2 + (width * math.sin(math.radians(lean)))))
            x += width + 0.05 + (height * math.sin(math.radians(lean)) if lean else 0)
    return result.mapped(lambda p: (p[0], p[2], -p[1]))


@part(closed=True)
def impeller():
    """Thin curved blades on a hub."""
    hub = lathe([(0, 0), (40, 0), (40, 2), (25, 5), (14, 14), (10, 30), (4, 32), (0, 32)], 80)

    def blade(u, v, side):
        radius = 9 + 30 * u
        angle = 1.1 * u + 0.25 * v * (1 - u) + (side - 0.5) * 0.6 / radius
        z = 1 + 29 * (1 - u) ** 2 * v + (1 - v) * 2 * (1 - u) + 14 * u * v
        return (*polar(radius, angle), z)
    return joined(hub, *(slab(blade, 24, 10).turned(2, 360 * i / 14) for i in range(14)))


@part(closed=True)
def honeycomb_panel():
    """Hexagonal holes through a core, on a skin that overlaps it."""
    holes = [circle(10 + 11 * (i + 0.5 * (j % 2)), 10 + 9.6 * j, 5.4, 6, TAU / 12) for i in range(12) for j in range(9)]
    core = prism([rectangle(0, 0, 148, 97), *holes], 0, 20)
    return joined(core, box(-1, -1, -0.8, 149, 98, 0.4))


@part(closed=False)
def corridor():
    """A tunnel that is a single sheet, seen from the inside, with ribs, pipes and boxes."""
    section = [(-2, 0), (2, 0), (2.6, 1), (2.4, 2.4), (1.4, 3.2), (-1.4, 3.2), (-2.4, 2.4), (-2.6, 1)]
    tunnel = loft([[(x, y, z) for x, y in section] for z in steps(0, 24, 40)], ends=(None, None)).flipped()
    smaller = [(0.9 * x, 0.1 + 0.92 * y) for x, y in section]
    result = Mesh().add(tunnel)
    for z in steps(1.5, 22.5, 7):
        result.add(prism([[(1.02 * x, 1.02 * y - 0.02) for x, y in section], smaller], z, z + 0.3))
    for x, y, radius in ((-2.2, 2.6, 0.09), (-2.25, 2.3, 0.06), (2.2, 2.6, 0.12), (2.3, 0.7, 0.05)):
        result.add(cylinder(radius, 0.1, 23.9, 14).moved(x, y, 0))
    for x, z, size in ((-1.2, 5, 0.8), (1.1, 8, 0.6), (1.2, 9, 0.9), (-1.0, 16, 0.7), (-1.1, 17.2, 0.5)):
        result.add(box(x - size / 2, 0.01, z - size / 2, x + size / 2, size, z + size / 2))
    return result


@part(closed=False)
def perforated_sheet():
    """Holes through a bent sheet without thickness."""
    mesh, known = Mesh(), {}

    def index(x, y):
        key = (round(x, 6), round(y, 6))
        if key not in known:
            known[key] = len(mesh.points)
            mesh.points.append((*polar(12, x / 12), y))
        return known[key]
    count = 16
    for i, j in itertools.product(range(24), range(14)):
        hole = circle(i + 0.5, j + 0.5, 0.33, count, TAU / 16)
        rim = []
        for k in range(count):
            angle = TAU / 16 + TAU * k / count
            reach = 0.5 / max(abs(math.cos(angle)), abs(math.sin(angle)))
            rim.append((i + 0.5 + reach * math.cos(angle), j + 0.5 + reach * math.sin(angle)))
        for k in range(count):
            after = (k + 1) % count
            mesh.faces.append((index(*hole[k]), index(*rim[k]), index(*rim[after]), index(*hole[after])))
    return mesh


@part(closed=False)
def cracked_patches():
    """A body of revolution in patches. Each patch is sampled differently, so that there are gaps at the seams."""
    def radius(z):
        return 20 + 6 * math.sin(z / 9) + 2 * math.cos(z / 4)

    def patch(first, last, low, high, across, along):
        def at(u, v):
            angle, z = TAU * (first + (last - first) * u), low + (high - low) * v
            return (*polar(radius(z), angle), z)
        return sheet(at, across, along)
    result = Mesh()
    for low, high in ((0, 22), (22, 55), (55, 90)):
        for quarter, (across, along) in enumerate(((6, 30), (11, 9), (17, 21), (24, 4))):
            result.add(patch(quarter / 4, (quarter + 1) / 4, low, high, across + low // 20, along))
    for z, count in ((0, 41), (90, 150)):
        rim = [(x, y, z) for x, y in circle(0, 0, radius(z), count)]
        result.add(Mesh(rim, [tuple(range(count)) if z else tuple(range(count))[::-1]]))
    return result.add(tube(30, 18, 40, 44, 90)).moved(0, 25000, 0)


@part(closed=False)
def tree():
    """A trunk and branches, which are closed, with cards for leaves."""
    chance = random.Random(38)
    result = lathe([(0.55, 0), (0.35, 0.6), (0.3, 3), (0.18, 5.5), (0, 7)], 12)
    for i in range(26):
        start = (0, 0, 2.2 + 0.17 * i)
        angle, reach = chance.uniform(0, TAU), chance.uniform(1.2, 2.8) * (1 - i / 40)
        end = (*polar(reach, angle), start[2] + chance.uniform(0.3, 1.2))
        result.add(rod(start, end, 0.05, 6))
        for _ in range(22):
            t = chance.uniform(0.4, 1.05)
            at = plus(start, minus(end, start), t)
            leaf = Mesh([(-0.14, 0, 0), (0, -0.07, 0.03), (0.16, 0, 0), (0, 0.07, 0.03)], [(0, 1, 2, 3)])
            for axis, most in enumerate((60, 60, 180)):
                leaf = leaf.turned(axis, chance.uniform(-most, most))
            result.add(leaf.moved(*(c + chance.uniform(-0.2, 0.2) for c in at)))
    return result.mapped(lambda p: (p[0], p[2], -p[1]))


@part(closed=False)
def city_tile():
    """Ground that is a single sheet, with buildings that stand in it."""
    noise, chance = Noise(39), random.Random(39)

    def height(x, y):
        return 18 * noise(x / 170, y / 170, 0.5) + 5 * noise(x / 50, y / 50, 7.5)
    result = sheet(lambda u, v: (600 * u, 600 * v, height(600 * u, 600 * v)), 64, 64)
    for i, j in itertools.product(range(8), range(8)):
        x, y = 45 + 70 * i + chance.uniform(-6, 6), 45 + 70 * j + chance.uniform(-6, 6)
        w, d, h = chance.uniform(14, 27), chance.uniform(14, 27), chance.choice((12, 15, 25, 40, 90))
        ground = height(x, y)
        building = box(x - w, y - d, ground - 15, x + w, y + d, ground + h)
        if h < 20:
            roof = prism([[(-d - 2, 0), (d + 2, 0), (0, 9)]], -w - 2, w + 2)
            building.add(roof.cycled().moved(x, y, ground + h - 0.5))
        else:
            building.add(box(x - w / 2, y - d / 2, ground + h - 1, x, y, ground + h + 5))
        result.add(building)
    return result


@part(closed=True)
def engine_block():
    """A block with bores, fins, bolts and a shaft through it."""
    bores = [circle(35 + 55 * i, 40, 20, 48) for i in range(4)]
    block = prism([rounded_rectangle(0, 0, 235, 80, 8, 8), *bores], 0, 110)
    result = joined(block, prism([rectangle(-8, -6, 243, 86), *bores], 104, 112))
    for i, side in itertools.product(range(9), (0, 1)):
        y = -9 if side == 0 else 78
        result.add(box(10, y, 12 + 10 * i, 225, y + 11, 15.5 + 10 * i))
    for i, y in itertools.product(range(5), (4, 76)):
        result.add(lathe([(4, 100), (4, 112.5), (5.5, 112.5), (5.5, 117), (5, 118)], 18).moved(7.5 + 55 * i, y, 0))
    for i in range(4):
        result.add(cylinder(19.6, 40 + 15 * (i in (1, 2)), 75 + 15 * (i in (1, 2)), 64).moved(35 + 55 * i, 40, 0))
    shaft = lathe([(0, -25), (9, -25), (9, 0), (14, 1), (14, 234), (9, 235), (9, 262), (0, 262)], 56)
    return result.add(shaft.turned(1, 90).moved(0, 40, 14)).scaled(1000).moved(-2e6, 8e6, 4e6)


# Scans.


class Noise:
    """Value noise between -1 and 1 at unit wavelength, smooth in each cell of a lattice that repeats."""

    def __init__(self, seed):
        chance = random.Random(seed)
        order = list(range(256))
        chance.shuffle(order)
        self.order = order * 3
        self.values = [chance.uniform(-1, 1) for _ in range(256)] * 2

    def __call__(self, x, y, z):
        i, j, k = math.floor(x), math.floor(y), math.floor(z)
        x, y, z = x - i, y - j, z - k
        x, y, z = x * x * (3 - 2 * x), y * y * (3 - 2 * y), z * z * (3 - 2 * z)
        order, values = self.order, self.values
        i, j, k = i & 255, j & 255, k & 255
        a, b = order[i] + j, order[i + 1] + j
        aa, ab, ba, bb = order[a] + k, order[a + 1] + k, order[b] + k, order[b + 1] + k
        v, w = values[aa], values[aa + 1]
        near = v + z * (w - v)
        v, w = values[ab], values[ab + 1]
        near += y * (v + z * (w - v) - near)
        v, w = values[ba], values[ba + 1]
        far = v + z * (w - v)
        v, w = values[bb], values[bb + 1]
        far += y * (v + z * (w - v) - far)
        return near + x * (far - near)


def normals_of(mesh):
    """Area-weighted normals."""
    sums = [[0.0, 0.0, 0.0] for _ in mesh.points]
    points = mesh.points
    for face in mesh.faces:
        a, b, c = (points[v] for v in face)
        n = cross(minus(b, a), minus(c, a))
        for v in face:
            total = sums[v]
            total[0] += n[0]
            total[1] += n[1]
            total[2] += n[2]
    return [unit(n) for n in sums]


def diagonal_of(points):
    return math.dist([min(axis) for axis in zip(*points)], [max(axis) for axis in zip(*points)])


def refined(mesh, rounds):
    for _ in range(rounds):
        mesh = subdivided(mesh, lambda a, b, c: True, normals_of(mesh))
    return mesh


def roughened(mesh, seed, octaves=6, wavelength=0.06, amplitude=0.006, gain=0.5):
    """Displaces points along their normals by octaves of value noise.

    The first octave has the given wavelength and amplitude, as shares of the diagonal; each further one has half the
    wavelength and `gain` times the amplitude. A gain of 0.5 gives equally steep slopes at each scale, and a power
    spectral density that falls with the third power of the frequency.
    """
    size = diagonal_of(mesh.points)
    layers = [(Noise(seed + i), 2**i / (wavelength * size), amplitude * size * gain**i) for i in range(octaves)]
    points = []
    for p, n in zip(mesh.points, normals_of(mesh)):
        height = sum(h * noise(f * p[0], f * p[1], f * p[2]) for noise, f, h in layers)
        points.append(plus(p, n, height))
    return Mesh(points, mesh.faces)


def rough_armadillo(scans):
    """Even triangles."""
    return roughened(refined(read_off(scans / "armadillo.off"), 2), 101)


def uneven_bunny(scans):
    """Triangles subdivided only where noise is strong, once to four times."""
    mesh = read_off(scans / "bunny00.off")
    noise, frequency = Noise(201), 7 / diagonal_of(mesh.points)
    for threshold in (0.1, 0.4, 0.6, 0.75):
        def is_wanted(a, b, c, threshold=threshold):
            return noise(*(frequency * (u + v + w) / 3 for u, v, w in zip(a, b, c))) > threshold
        mesh = subdivided(mesh, is_wanted, normals_of(mesh))
    return roughened(mesh, 202, octaves=5)


def double_elephant(scans):
    """A surface and a thin offset of it, with patches missing from each."""
    outer = roughened(refined(read_off(scans / "elephant.off"), 3), 301, octaves=6, wavelength=0.05, amplitude=0.004)
    size = diagonal_of(outer.points)
    inner = Mesh([plus(p, n, -0.003 * size) for p, n in zip(outer.points, normals_of(outer))], outer.faces).flipped()
    result = Mesh()
    for seed, shell in ((311, outer), (312, inner)):
        noise, frequency = Noise(seed), 9 / size
        is_hole = [noise(*(frequency * c for c in p)) > 0.55 for p in shell.points]
        kept = [face for face in shell.faces if not any(is_hole[v] for v in face)]
        used = sorted(set(itertools.chain(*kept)))
        place = {v: i for i, v in enumerate(used)}
        result.add(Mesh([shell.points[v] for v in used], [tuple(place[v] for v in face) for face in kept]))
    return result


SCANS = ((rough_armadillo, True), (uneven_bunny, True), (double_elephant, False))


# Files.


def write(mesh, file):
    {".stl": write_stl, ".obj": write_obj, ".off": write_off, ".ply": write_ply}[file.suffix](mesh, file)


def write_stl(mesh, file):
    triangles = list(mesh.triangles())
    with open(file, "wb") as out:
        out.write(b"make_parts.py".ljust(80) + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            a, b, c = (mesh.points[v] for v in triangle)
            out.write(struct.pack("<12fH", *unit(cross(minus(b, a), minus(c, a))), *a, *b, *c, 0))


def write_obj(mesh, file):
    with open(file, "w", encoding="ascii") as out:
        out.writelines("v {:.9g} {:.9g} {:.9g}\n".format(*p) for p in mesh.points)
        out.writelines("vn {:.6g} {:.6g} {:.6g}\n".format(*n) for n in mesh.normals)
        corner = "{0}//{0}" if mesh.normals else "{0}"
        out.writelines("f " + " ".join(corner.format(v + 1) for v in face) + "\n" for face in mesh.faces)


def write_off(mesh, file):
    with open(file, "w", encoding="ascii") as out:
        out.write(f"OFF\n{len(mesh.points)} {len(mesh.faces)} 0\n")
        out.writelines("{:.9g} {:.9g} {:.9g}\n".format(*p) for p in mesh.points)
        out.writelines(f"{len(face)} {' '.join(map(str, face))}\n" for face in mesh.faces)


def write_ply(mesh, file):
    with open(file, "wb") as out:
        out.write(f"ply\nformat binary_{sys.byteorder}_endian 1.0\nelement vertex {len(mesh.points)}\n"
                  "property float x\nproperty float y\nproperty float z\n"
                  f"element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        array.array("f", itertools.chain.from_iterable(mesh.points)).tofile(out)
        pack = struct.Struct("=B3i").pack
        out.write(b"".join(pack(3, *face) for face in mesh.faces))


def read(file):
    """Reads a mesh that write() has written. Corners of an .stl at the same position are one point."""
    if file.suffix == ".off":
        return read_off(file)
    if file.suffix == ".obj":
        lines = [line.split() for line in file.read_text(encoding="ascii").splitlines()]
        return Mesh([tuple(map(float, line[1:])) for line in lines if line[0] == "v"],
                    [tuple(int(corner.split("/")[0]) - 1 for corner in line[1:]) for line in lines if line[0] == "f"])
    data = file.read_bytes()
    if file.suffix == ".stl":
        known = {}
        faces = [tuple(known.setdefault(t[i:i + 3], len(known)) for i in (3, 6, 9))
                 for t in struct.iter_unpack("<12fH", data[84:])]
        return Mesh(known, faces)
    header, data = data.split(b"end_header\n", 1)
    points = int(header.split(b"element vertex ")[1].split()[0])
    return Mesh(struct.iter_unpack("=3f", data[:12 * points]),
                (face[1:] for face in struct.iter_unpack("=B3i", data[12 * points:])))


def read_off(file):
    lines = (line.split("#")[0].split() for line in file.read_text(encoding="ascii").splitlines())
    lines = [line for line in lines if line]
    points, faces = map(int, lines[1][:2])
    return Mesh([tuple(map(float, line[:3])) for line in lines[2:2 + points]],
                [tuple(map(int, line[1:1 + int(line[0])])) for line in lines[2 + points:2 + points + faces]])


def faults(mesh, sizes, closed):
    """The defects of a mesh, as texts."""
    found = []
    if len(mesh.points) not in sizes:
        found.append(f"{len(mesh.points)} vertices, not {sizes[0]} to {sizes[-1]}")
    if not all(math.isfinite(c) for p in mesh.points for c in p):
        found.append("coordinates that are not finite")
    if not all(0 <= v < len(mesh.points) for face in mesh.faces for v in face):
        found.append("indices out of range")
    repeats = sum(len(set(face)) < len(face) for face in mesh.faces)
    if repeats:
        found.append(f"{repeats} faces with a vertex twice")
    if closed:
        edges = collections.Counter(edge for face in mesh.faces for edge in zip(face, face[1:] + face[:1]))
        wrong = sum(count != 1 or edges[b, a] != 1 for (a, b), count in edges.items())
        if wrong:
            found.append(f"{wrong} edges without exactly one face on either side")
    return found


def check(file, sizes, closed):
    """Prints a line about a file, and returns whether its mesh has no faults."""
    mesh = read(file)
    found = faults(mesh, sizes, closed)
    size = diagonal_of(mesh.points)
    centre = [(min(axis) + max(axis)) / 2 for axis in zip(*mesh.points)]
    thin = total = 0
    for triangle in mesh.triangles():
        a, b, c = (mesh.points[v] for v in triangle)
        longest = max(math.dist(a, b), math.dist(b, c), math.dist(c, a))
        normal = cross(minus(b, a), minus(c, a))
        thin += math.sqrt(dot(normal, normal)) < 0.1 * longest * longest
        total += 1
    print(f"{file.name:28} {len(mesh.points):7} vertices {len(mesh.faces):7} faces  diagonal {size:9.4g}"
          f"  from origin {math.hypot(*centre) / size:7.1f} diagonals  thin {100 * thin / total:3.0f} %"
          f"  {'closed' if closed else 'open'}  {'; '.join(found) or 'ok'}")
    return not found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path, metavar="OUT_DIR")
    parser.add_argument("--check", action="store_true", help="read the files back and check them")
    parser.add_argument("--scans", type=pathlib.Path, help="folder of the archive (default: build/meshes/meshes)",
                        default=pathlib.Path(__file__).resolve().parent.parent / "build/meshes/meshes")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    made = []
    for i, (function, closed) in enumerate(PARTS):
        file = arguments.out / f"{i + 1:02}_{function.__name__}.{FORMATS[i % 3]}"
        write(function(), file)
        made.append((file, PART_SIZES, closed))
    for i, (function, closed) in enumerate(SCANS, len(PARTS) + 1):
        file = arguments.out / f"{i:02}_{function.__name__}.ply"
        write(function(arguments.scans), file)
        made.append((file, SCAN_SIZES, closed))
    print(f"{len(made)} meshes in {arguments.out}, {time.monotonic() - begin:.0f} s")
    if arguments.check and not all([check(*mesh) for mesh in made]):
        sys.exit("make_parts.py: some meshes are not as they should be")


if __name__ == "__main__":
    main()
