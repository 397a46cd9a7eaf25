"""Bakes arrays with the Python module `alcove`, or with the program if the module cannot be imported."""
import json
import os
import shutil
import subprocess
import tempfile
import threading

import numpy as np

try:
    import alcove
except ImportError:
    alcove = None


class Cancelled(Exception):
    pass


class Failed(Exception):
    """A message for the user."""


class Surface:
    """Polygons in world coordinates: vertices (n, 3), corners, offsets, and a normal and UV per corner."""

    def __init__(self, vertices, corners, offsets, normals=None, uvs=None):
        self.vertices = np.ascontiguousarray(vertices, np.float64)
        self.corners = np.ascontiguousarray(corners, np.uint32)
        self.offsets = np.ascontiguousarray(offsets, np.uint32)
        self.normals, self.uvs = normals, uvs

    @staticmethod
    def joined(surfaces):
        first_vertices = np.cumsum([0] + [len(s.vertices) for s in surfaces])
        first_corners = np.cumsum([0] + [len(s.corners) for s in surfaces])
        return Surface(
            np.concatenate([s.vertices for s in surfaces]),
            np.concatenate([s.corners + first for s, first in zip(surfaces, first_vertices)]),
            np.concatenate([s.offsets[:-1] + first for s, first in zip(surfaces, first_corners)] + [first_corners[-1:]]),
            None if surfaces[0].normals is None else np.concatenate([s.normals for s in surfaces]),
        )

    def faces_of_corners(self):
        return np.repeat(np.arange(len(self.offsets) - 1, dtype=np.uint32), np.diff(self.offsets))

    def corner_points(self):
        """A point per corner, slightly inside its face."""
        inward = 1e-3
        faces = self.faces_of_corners()
        places = self.vertices[self.corners]
        counts = np.maximum(np.diff(self.offsets), 1)[:, None]
        centers = np.add.reduceat(places, self.offsets[:-1].astype(np.int64)) / counts
        return places + inward * (centers[faces] - places)


def program_of(path):
    found = shutil.which(path)
    if found is None:
        raise Failed(
            "Alcove was not found: the Python module cannot be imported, and there is no program '%s'. Set its path in "
            "the preferences of the add-on" % path
        )
    return found


def description(path):
    if alcove is not None:
        return "Using the Python module alcove %s" % alcove.__version__
    return "Using the program %s" % (shutil.which(path) or "(not found)")


def write_ply(path, vertices, corners, offsets, normals=None):
    header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(vertices)
    names = ["x", "y", "z"] + ([] if normals is None else ["nx", "ny", "nz"])
    header += "".join("property double %s\n" % name for name in names)
    header += "element face %d\nproperty list int int vertex_indices\nend_header\n" % (len(offsets) - 1)
    counts = np.diff(offsets).astype("<i4")
    words = np.empty(len(corners) + len(counts), "<i4")
    starts = offsets[:-1].astype(np.int64) + np.arange(len(counts))
    is_count = np.zeros(len(words), bool)
    is_count[starts] = True
    words[starts] = counts
    words[~is_count] = corners
    table = vertices if normals is None else np.concatenate([vertices, normals], 1)
    with open(path, "wb") as out:
        out.write(header.encode())
        out.write(table.astype("<f8").tobytes())
        out.write(words.tobytes())


def read_ao(path, count):
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    size = {"double": 8, "float": 4, "int": 4, "uint": 4, "uchar": 1}
    stride = at = 0
    for line in data[:end].decode().split("\n"):
        words = line.split()
        if words[:2] == ["element", "face"]:
            break
        if words[:1] == ["property"]:
            if words[2] == "ao":
                at = stride
            stride += size[words[1]]
    rows = np.frombuffer(data, np.uint8, count * stride, end).reshape(count, stride)
    return rows[:, at : at + 4].copy().view("<f4")[:, 0]


def run(program, arguments, cancelled):
    process = subprocess.Popen(
        [program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True
    )
    output = []
    reader = threading.Thread(target=lambda: output.append(process.communicate()))
    reader.start()
    while reader.is_alive():
        if cancelled():
            process.terminate()
            reader.join()
            raise Cancelled
        reader.join(0.05)
    out, err = output[0]
    if process.returncode != 0:
        raise Failed((err.strip().split("\n") or ["the program failed"])[-1])
    return json.loads(out)


class Bake:
    """Settings of a bake; the methods return values in [0, 1], and set `summary` and `warnings`."""

    def __init__(self, radius, quality, ground, program, progress=lambda done: None, cancelled=lambda: False):
        self.radius = "10%" if radius <= 0.0 else radius
        self.quality, self.ground, self.program = quality, ground, program
        self.progress, self.cancelled = progress, cancelled
        self.summary, self.warnings = "", []

    def options(self):
        options = ["--radius", str(self.radius), "--quality", self.quality, "--json", "--quiet"]
        return options + (["--ground", "--up", "0,0,1"] if self.ground else [])

    def _step(self, work, done):
        if self.cancelled():
            raise Cancelled
        self.progress(done)

    def _module(self, call, *arguments, **more):
        try:
            return call(
                *arguments, radius=self.radius, quality=self.quality, ground=self.ground, up=(0, 0, 1), progress=self._step,
                **more
            )
        except (alcove.InputError, alcove.LimitError, alcove.MemoryError) as error:
            raise Failed(str(error)) from None

    def _keep(self, baked):
        self.summary = "by %s, radius %.4g, RMSE about %.2g" % (baked.method, baked.radius, baked.rmse or 0.0)
        self.warnings = baked.warnings

    def _keep_json(self, result):
        self.summary = "by %s, radius %.4g, RMSE about %.2g" % (
            result["method"], result["radius"], result["estimated_rmse"] or 0.0)
        self.warnings = result["warnings"]

    def vertices(self, surface):
        if alcove is not None:
            baked = self._module(alcove.bake, (surface.vertices, (surface.corners, surface.offsets)))
            self._keep(baked)
            return baked.ao
        return self._program(surface.vertices, surface.corners, surface.offsets, None)

    def corners(self, surface):
        if alcove is not None:
            points = (surface.corner_points(), surface.normals, surface.faces_of_corners())
            baked = self._module(alcove.bake, (surface.vertices, (surface.corners, surface.offsets)), points=points)
            self._keep(baked)
            return baked.ao
        # With a vertex per corner, each corner gets the value for its own face.
        corners = np.arange(len(surface.corners), dtype=np.uint32)
        return self._program(surface.vertices[surface.corners], corners, surface.offsets, surface.normals)

    def _program(self, vertices, corners, offsets, normals):
        program = program_of(self.program)
        with tempfile.TemporaryDirectory() as folder:
            source, target = os.path.join(folder, "in.ply"), os.path.join(folder, "out.ply")
            write_ply(source, vertices, corners, offsets, normals)
            self._keep_json(run(program, ["bake", source, "-o", target, "--color", "none", *self.options()], self.cancelled))
            return read_ao(target, len(vertices))

    def image(self, surface, others, width, height):
        """Bakes an image. Returns what pixels() takes: rows from the bottom, as in Blender, or the bytes of an .exr."""
        if alcove is not None:
            mesh = alcove.Mesh(surface.vertices, (surface.corners, surface.offsets), corner_normals=surface.normals,
                               corner_uvs=surface.uvs)
            maps = self._module(alcove.bake_maps, mesh, size=(width, height),
                                occluders=[(s.vertices, (s.corners, s.offsets)) for s in others])
            self._keep(maps.baked)
            return maps.ao[::-1]
        program = program_of(self.program)
        with tempfile.TemporaryDirectory() as folder:
            source, target = os.path.join(folder, "in.obj"), os.path.join(folder, "out.exr")
            with open(source, "w") as out:
                out.write("".join("v %r %r %r\n" % tuple(v) for v in surface.vertices.tolist()))
                out.write("".join("vt %r %r\n" % tuple(uv) for uv in surface.uvs.tolist()))
                out.write("".join("vn %r %r %r\n" % tuple(n) for n in surface.normals.tolist()))
                corners = ["%d/%d/%d" % (v + 1, c + 1, c + 1) for c, v in enumerate(surface.corners.tolist())]
                for first, last in zip(surface.offsets[:-1], surface.offsets[1:]):
                    out.write("f %s\n" % " ".join(corners[first:last]))
            arguments = ["bake", source, "-o", target, "--size", "%dx%d" % (width, height), "--depth", "float"]
            for i, other in enumerate(others):
                path = os.path.join(folder, "%d.ply" % i)
                write_ply(path, other.vertices, other.corners, other.offsets)
                arguments += ["--occluder", path]
            self._keep_json(run(program, arguments + self.options(), self.cancelled))
            with open(target, "rb") as file:
                return file.read()

    @staticmethod
    def pixels(values, width, height):
        """The texels of a result of image(). Call it only on the main thread, because it may use Blender's data."""
        if not isinstance(values, bytes):
            return np.asarray(values)
        import bpy

        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "map.exr")
            with open(path, "wb") as file:
                file.write(values)
            loaded = bpy.data.images.load(path)
            try:
                pixels = np.empty(4 * width * height, np.float32)
                loaded.pixels.foreach_get(pixels)
                return pixels.reshape(height, width, 4)[..., 0]
            finally:
                bpy.data.images.remove(loaded)
