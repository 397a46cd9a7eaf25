"""Solids and sheets of polygons, from which make_parts.py builds parts."""

import itertools
import math

TAU = 2 * math.pi


# Vectors.


def plus(a, b, scale=1.0):
    return (a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a)) or 1.0
    return (a[0] / length, a[1] / length, a[2] / length)


class Mesh:
    """Points and polygons, with a normal per point if the file is to contain normals."""

    def __init__(self, points=(), faces=(), normals=()):
        self.points, self.faces, self.normals = list(points), list(faces), list(normals)

    def add(self, *others):
        """Appends other meshes as separate shells."""
        for other in others:
            first = len(self.points)
            self.points += other.points
            self.normals += other.normals
            self.faces += [tuple(first + v for v in face) for face in other.faces]
        return self

    def mapped(self, function):
        """The mesh with the function applied to each point, without normals."""
        return Mesh([function(p) for p in self.points], self.faces)

    def moved(self, x, y, z):
        return Mesh([(p[0] + x, p[1] + y, p[2] + z) for p in self.points], self.faces, self.normals)

    def scaled(self, s):
        return Mesh([(s * p[0], s * p[1], s * p[2]) for p in self.points], self.faces, self.normals)

    def turned(self, axis, degrees):
        """A mesh turned about an axis: 0, 1 or 2."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        i, j = (axis + 1) % 3, (axis + 2) % 3

        def turn(p):
            turned = list(p)
            turned[i], turned[j] = c * p[i] - s * p[j], s * p[i] + c * p[j]
            return tuple(turned)

        return Mesh(map(turn, self.points), self.faces, map(turn, self.normals))

    def cycled(self):
        """The mesh rotated so that x becomes y, y becomes z, and z becomes x."""
        return self.mapped(lambda p: (p[2], p[0], p[1]))

    def flipped(self):
        return Mesh(self.points, [face[::-1] for face in self.faces], [plus((0, 0, 0), n, -1) for n in self.normals])

    def outward(self):
        """The mesh with its faces turned so that its volume is positive."""
        return self if self.volume() >= 0 else self.flipped()

    def volume(self):
        if not self.points:
            return 0.0
        base = self.points[0]
        total = 0.0
        for a, b, c in self.triangles():
            pa, pb, pc = (minus(self.points[v], base) for v in (a, b, c))
            total += dot(pa, cross(pb, pc)) / 6
        return total

    def triangles(self):
        """Faces as fans of triangles."""
        for face in self.faces:
            for i in range(1, len(face) - 1):
                yield face[0], face[i], face[i + 1]

    def triangulated(self):
        return Mesh(self.points, self.triangles(), self.normals)


def joined(*meshes):
    return Mesh().add(*meshes)


# Polygons in the plane.


def polar(radius, angle):
    return (radius * math.cos(angle), radius * math.sin(angle))


def circle(x, y, radius, count, start=0.0):
    around = (polar(radius, start + TAU * i / count) for i in range(count))
    return [(x + u, y + v) for u, v in around]


def rectangle(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def rounded_rectangle(x0, y0, x1, y1, radius, count):
    """A rectangle whose corners are arcs of `count` edges."""
    centres = ((x1 - radius, y1 - radius), (x0 + radius, y1 - radius), (x0 + radius, y0 + radius),
               (x1 - radius, y0 + radius))
    loop = []
    for corner, (x, y) in enumerate(centres):
        arc = (polar(radius, TAU / 4 * (corner + i / count)) for i in range(count + 1))
        loop += [(x + u, y + v) for u, v in arc]
    return loop


def signed_area(loop):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(loop, loop[1:] + loop[:1])) / 2


def side_of(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def crosses(a, b, c, d):
    """Whether two segments without a common end touch."""
    if a in (c, d) or b in (c, d):
        return False
    return side_of(a, b, c) * side_of(a, b, d) <= 0 and side_of(c, d, a) * side_of(c, d, b) <= 0


def bridged(loops, points):
    """One loop of indices that goes around the outline and, over bridges, around each hole."""
    loop, *holes = loops
    loop = list(loop)
    holes.sort(key=lambda hole: -max(points[v][0] for v in hole))
    for n, hole in enumerate(holes):
        right = max(range(len(hole)), key=lambda i: points[hole[i]][0])
        start = points[hole[right]]
        others = [loop, *holes[n:]]
        edges = [(points[a], points[b]) for other in others for a, b in zip(other, other[1:] + other[:1])]
        to_the_right = [i for i, v in enumerate(loop) if points[v][0] >= start[0]]
        to_the_right.sort(key=lambda i: math.dist(points[loop[i]], start))
        end = next(i for i in to_the_right if not any(crosses(start, points[loop[i]], a, b) for a, b in edges))
        loop[end:end + 1] = [loop[end], *hole[right:], *hole[:right + 1], loop[end]]
    return loop


def triangulate(loops):
    """Clips the ears of a polygon with holes, which leaves slivers as CAD programs do.

    `loops` are points: the outline counter-clockwise, the holes clockwise. The triangles are indices
    into the points of all loops, one loop after another.
    """
    points = list(itertools.chain(*loops))
    starts = itertools.accumulate((len(loop) for loop in loops), initial=0)
    loop = bridged([list(range(start, start + len(of))) for start, of in zip(starts, loops)], points)
    corner = [points[v] for v in loop]
    after = [(i + 1) % len(loop) for i in range(len(loop))]
    before = [i - 1 for i in range(len(loop))]
    before[0] = len(loop) - 1

    def turn(i):
        return side_of(corner[before[i]], corner[i], corner[after[i]])

    reflex = {i for i in range(len(loop)) if turn(i) <= 0}

    def is_ear(i):
        a, b, c = corner[before[i]], corner[i], corner[after[i]]
        if i in reflex:
            return False
        left, right = min(a[0], b[0], c[0]), max(a[0], b[0], c[0])
        for j in reflex:
            p = corner[j]
            if left <= p[0] <= right and p != a and p != b and p != c and side_of(a, b, p) >= 0 and \
                    side_of(b, c, p) >= 0 and side_of(c, a, p) >= 0:
                return False
        return True

    triangles, left, i, misses = [], len(loop), 0, 0
    while left > 3:
        if misses > left or is_ear(i):  # if rounding leaves no ear, any corner will do
            triangles.append((loop[before[i]], loop[i], loop[after[i]]))
            after[before[i]], before[after[i]] = after[i], before[i]
            reflex.discard(i)
            for neighbour in (before[i], after[i]):
                if turn(neighbour) > 0:
                    reflex.discard(neighbour)
                else:
                    reflex.add(neighbour)
            left, misses = left - 1, 0
        else:
            misses += 1
        i = after[i]
    triangles.append((loop[before[i]], loop[i], loop[after[i]]))
    return triangles


# Solids and sheets.


def prism(loops, z0, z1):
    """A prism between two heights. The first loop is its outline, and the others are holes."""
    loops = [loop if (signed_area(loop) > 0) == (i == 0) else loop[::-1] for i, loop in enumerate(loops)]
    flat = list(itertools.chain(*loops))
    n = len(flat)
    mesh = Mesh([(x, y, z) for z in (z0, z1) for x, y in flat])
    first = 0
    for loop in loops:
        for i in range(len(loop)):
            a, b = first + i, first + (i + 1) % len(loop)
            mesh.faces.append((a, b, n + b, n + a))
        first += len(loop)
    caps = triangulate(loops)
    mesh.faces += [(a, c, b) for a, b, c in caps] + [(n + a, n + b, n + c) for a, b, c in caps]
    return mesh.outward()


def loft(rings, wraps=False, ends=("polygon", "polygon")):
    """Joins closed rings with equal numbers of points. Each end is a polygon, a fan to a point, or open (None)."""
    n = len(rings[0])
    mesh = Mesh(itertools.chain(*rings))
    for i in range(len(rings) if wraps else len(rings) - 1):
        a, b = i * n, (i + 1) % len(rings) * n
        mesh.faces += [(a + j, a + (j + 1) % n, b + (j + 1) % n, b + j) for j in range(n)]
    for end, first in zip(ends, (0, (len(rings) - 1) * n)):
        if wraps or end is None:
            continue
        order = range(n) if first else range(n - 1, -1, -1)
        if end == "polygon":
            mesh.faces.append(tuple(first + j for j in order))
        else:
            mesh.points.append(end)
            mesh.faces += [(len(mesh.points) - 1, first + j, first + (j + 1 if first else j - 1) % n) for j in order]
    return mesh.outward()


def lathe(profile, count, wraps=False, ends=("polygon", "polygon")):
    """Turns a profile of (radius, height) about z. A radius of 0 at either end becomes a point."""
    ends = list(ends)
    profile = list(profile)
    for end in (0, -1):
        if not wraps and profile[end][0] == 0:
            ends[end] = (0, 0, profile.pop(end)[1])
    return loft([[(x, y, z) for x, y in circle(0, 0, radius, count)] for radius, z in profile], wraps, ends)


def tube(outer, inner, z0, z1, count):
    return lathe([(outer, z0), (outer, z1), (inner, z1), (inner, z0)], count, wraps=True)


def cylinder(radius, z0, z1, count):
    return lathe([(radius, z0), (radius, z1)], count)


def rod(start, end, radius, count):
    """A cylinder between two points."""
    along = unit(minus(end, start))
    return sweep([start, end], circle(0, 0, radius, count), (0, 0, 1) if abs(along[2]) < 0.9 else (1, 0, 0))


def sweep(path, section, up, wraps=False):
    """Moves a section along a path. `up` must not be parallel to any part of the path."""
    rings = []
    for i, here in enumerate(path):
        before = path[i - 1] if i or wraps else here
        after = path[(i + 1) % len(path)] if i + 1 < len(path) or wraps else here
        along = unit(minus(after, before))
        side = unit(cross(along, up))
        other = cross(side, along)
        rings.append([plus(plus(here, side, u), other, v) for u, v in section])
    return loft(rings, wraps)


def blocks(xs, ys, zs, is_filled):
    """The surface of the filled cells (i, j, k) between axis-aligned planes."""
    steps = (len(xs) - 1, len(ys) - 1, len(zs) - 1)
    cells = {cell for cell in itertools.product(*map(range, steps)) if is_filled(*cell)}
    mesh, known = Mesh(), {}
    for cell in sorted(cells):
        for axis, way in itertools.product(range(3), (0, 1)):
            beyond = list(cell)
            beyond[axis] += 1 if way else -1
            if tuple(beyond) in cells:
                continue
            face = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                at = list(cell)
                at[axis] += way
                at[(axis + 1) % 3] += u
                at[(axis + 2) % 3] += v
                at = tuple(at)
                if at not in known:
                    known[at] = len(mesh.points)
                    mesh.points.append((xs[at[0]], ys[at[1]], zs[at[2]]))
                face.append(known[at])
            mesh.faces.append(tuple(face if way else face[::-1]))
    return mesh


def box(x0, y0, z0, x1, y1, z1):
    return blocks((x0, x1), (y0, y1), (z0, z1), lambda i, j, k: True)


def steps(first, last, count):
    return [first + (last - first) * i / count for i in range(count + 1)]


def spaced(count, wide, narrow):
    """The planes of `count` wide cells, each between two narrow cells: cell 0 is narrow, 1 wide, 2 narrow, ..."""
    return list(itertools.accumulate([0.0] + [narrow, wide] * count + [narrow]))


def split(mesh, normals):
    """A mesh in which each face has its own points, with or without normals."""
    result = Mesh()
    for face in mesh.faces:
        first = len(result.points)
        corners = [mesh.points[v] for v in face]
        result.points += corners
        result.faces.append(tuple(range(first, first + len(face))))
        if normals:
            result.normals += [unit(cross(minus(corners[1], corners[0]), minus(corners[2], corners[0])))] * len(face)
    return result


def sheet(function, nu, nv):
    """An open grid of function(u, v), with u and v from 0 to 1."""
    row = nv + 1
    return Mesh([function(i / nu, j / nv) for i in range(nu + 1) for j in range(nv + 1)],
                [(i * row + j, (i + 1) * row + j, (i + 1) * row + j + 1, i * row + j + 1)
                 for i in range(nu) for j in range(nv)])


def slab(function, nu, nv):
    """A closed thin solid between function(u, v, 0) and function(u, v, 1)."""
    upper = sheet(lambda u, v: function(u, v, 1), nu, nv)
    mesh = joined(upper, sheet(lambda u, v: function(u, v, 0), nu, nv).flipped())
    n, row = len(upper.points), nv + 1
    rim = [i * row for i in range(nu)] + [nu * row + j for j in range(nv)] + \
          [i * row + nv for i in range(nu, 0, -1)] + list(range(nv, 0, -1))
    mesh.faces += [(n + a, n + b, b, a) for a, b in zip(rim, rim[1:] + rim[:1])]
    return mesh.outward()


def icosphere(radius, level):
    g = (1 + math.sqrt(5)) / 2
    mesh = Mesh([unit(p) for p in ((-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g),
                                   (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1))],
                [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
                 (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11),
                 (6, 2, 10), (8, 6, 7), (9, 8, 1)])
    for _ in range(level):
        mesh = subdivided(mesh, lambda a, b, c: True)
        mesh.points = [unit(p) for p in mesh.points]
    return mesh.scaled(radius)


def subdivided(mesh, is_wanted, normals=None):
    """Splits each wanted triangle into four, and splits the neighbours so that no gap opens.

    With normals, new points lie between an edge and the curve that the normals at its ends suggest.
    """
    points = list(mesh.points)
    middles = {}
    for a, b, c in mesh.faces:
        if is_wanted(points[a], points[b], points[c]):
            for edge in ((a, b), (b, c), (c, a)):
                key = edge if edge[0] < edge[1] else edge[::-1]
                if key in middles:
                    continue
                middles[key] = len(points)
                p, q = points[edge[0]], points[edge[1]]
                middle = ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2)
                if normals:
                    for end in edge:  # a part of the way to the tangent planes at both ends
                        middle = plus(middle, normals[end], -0.35 * dot(minus(middle, points[end]), normals[end]))
                points.append(middle)
    faces = []
    for a, b, c in mesh.faces:
        ab, bc, ca = (middles.get((u, v) if u < v else (v, u)) for u, v in ((a, b), (b, c), (c, a)))
        for _ in range(3):  # turn the triangle so that its split edges come first
            if (ab is None) or (ca is not None and bc is None):
                a, b, c, ab, bc, ca = b, c, a, bc, ca, ab
        if ca is not None:
            faces += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        elif bc is not None:
            faces += [(ab, b, bc), (a, ab, bc), (a, bc, c)]
        elif ab is not None:
            faces += [(a, ab, c), (ab, b, c)]
        else:
            faces.append((a, b, c))
    return Mesh(points, faces)
