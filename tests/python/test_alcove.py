"""The Python module: values equal the program's, arrays are checked, and nothing leaks.

    PYTHONPATH=build/python /usr/bin/python3 tests/python/test_alcove.py build/alcove docs/python.md
"""
import contextlib
import ctypes
import doctest
import gc
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import alcove

PROGRAM, TUTORIAL = sys.argv[1:3]


def cube(n=1):
    """A box of n x n x n, with triangles."""
    points, index, faces = [], {}, []

    def vertex(*p):
        if p not in index:
            index[p] = len(points)
            points.append(p)
        return index[p]

    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, n):
            for i in range(n):
                for j in range(n):
                    corners = []
                    for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        p = [0, 0, 0]
                        p[axis], p[u], p[v] = side, i + a, j + b
                        corners.append(vertex(*p))
                    if side == 0:
                        corners.reverse()
                    faces += [corners[:3], [corners[0], corners[2], corners[3]]]
    return np.array(points, float), np.array(faces, np.uint32)


def grid(n):
    """A flat sheet of n x n vertices, with triangles."""
    x, y = np.meshgrid(np.arange(n, dtype=float), np.arange(n, dtype=float))
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + 1, i + n + 1], 1), np.stack([i, i + n + 1, i + n], 1)])
    return np.stack([x.ravel(), y.ravel(), np.zeros(n * n)], 1), faces.astype(np.uint32)


def memory(name):
    """The memory of this process in bytes: VmRSS is the current amount, VmHWM the peak."""
    with open("/proc/self/status") as status:
        return next(1024 * int(line.split()[1]) for line in status if line.startswith(name))


def peak_growth(work):
    """The bytes that work() needs at its peak, in addition to those in use."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)  # else it may reuse memory that was freed before
    with open("/proc/self/clear_refs", "w") as reset:
        reset.write("5")
    before = memory("VmRSS")
    work()
    return memory("VmHWM") - before


class Alarm(Exception):
    pass


def raise_alarm(*_):
    raise Alarm


@contextlib.contextmanager
def alarm(seconds, handler=raise_alarm):
    """A signal after some seconds, as Ctrl-C would send it."""
    old = signal.signal(signal.SIGALRM, handler)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, old)


class Arrays(unittest.TestCase):
    def test_mesh_keeps_what_it_gets(self):
        vertices, faces = cube(3)
        mesh = alcove.Mesh(vertices, faces)
        np.testing.assert_array_equal(mesh.vertices, vertices)
        np.testing.assert_array_equal(mesh.faces, faces)
        self.assertIsNone(mesh.normals)
        self.assertFalse(mesh.vertices.flags.writeable)
        self.assertIs(mesh.vertices.base is not None, True)

    def test_polygons(self):
        corners, offsets = [0, 1, 2, 3, 0, 1, 2], [0, 4, 7]
        mesh = alcove.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], (corners, offsets))
        self.assertIsNone(mesh.faces)
        np.testing.assert_array_equal(mesh.corners, corners)
        np.testing.assert_array_equal(mesh.offsets, offsets)

    def test_other_layouts_and_types_are_converted(self):
        vertices, faces = cube(2)
        expected = alcove.bake((vertices, faces)).ao
        for v in (np.asfortranarray(vertices), vertices.astype(np.float32), vertices[::-1][::-1], vertices.tolist(),
                  vertices.astype(int)):
            np.testing.assert_array_equal(alcove.bake((v, faces)).ao, expected)
        read_only = vertices.copy()
        read_only.flags.writeable = False
        np.testing.assert_array_equal(alcove.bake((read_only, faces.astype(np.int64))).ao, expected)

    def refusal(self, kind, call, *parts):
        with self.assertRaises(kind) as caught:
            call()
        for part in parts:
            self.assertIn(part, str(caught.exception))

    def test_wrong_arrays_are_named(self):
        vertices, faces = cube()
        self.refusal(ValueError, lambda: alcove.Mesh(vertices[:, :2], faces), "vertices", "(n, 3)", "(8, 2)")
        self.refusal(TypeError, lambda: alcove.Mesh(vertices.astype(str), faces), "vertices", "numbers")
        self.refusal(TypeError, lambda: alcove.Mesh(vertices.astype(complex), faces), "vertices")
        self.refusal(TypeError, lambda: alcove.Mesh(vertices, faces.astype(float)), "faces", "whole numbers")
        self.refusal(ValueError, lambda: alcove.Mesh(vertices, faces + 7), "faces", "not from 0 to 7")
        self.refusal(ValueError, lambda: alcove.Mesh(vertices, faces.astype(int) - 1), "faces", "is -1")
        self.refusal(ValueError, lambda: alcove.Mesh(vertices, faces.ravel()), "faces", "(m, 3)")
        self.refusal(ValueError, lambda: alcove.Mesh(vertices, faces, normals=vertices[:3]), "normals", "3 rows for 8")
        self.refusal(TypeError, lambda: alcove.bake("cube"), "mesh", "vertices, faces")
        self.refusal(TypeError, lambda: alcove.bake((vertices, faces), radius=[1]), "radius")
        self.refusal(alcove.InputError, lambda: alcove.bake((vertices, faces), radius="x"), "radius")
        self.refusal(alcove.InputError, lambda: alcove.bake((vertices, faces), quality="best"), "quality", "draft, good, fine")
        self.refusal(alcove.InputError, lambda: alcove.bake((vertices, faces), attributes=["height"]), "attributes", "convexity")
        self.refusal(alcove.InputError, lambda: alcove.bake((vertices, faces), method="guess"), "guess")
        self.refusal(TypeError, lambda: alcove.bake((vertices, faces), method="exact", parameters={"rays": "many"}), "parameters")
        self.refusal(ValueError, lambda: alcove.bake((vertices, faces), radius=float("nan")), "radius")
        self.refusal(ValueError, lambda: alcove.Mesh(vertices, faces).set_attribute("a b", vertices), "a b")
        self.refusal(ValueError, lambda: alcove.Mesh(vertices, faces).set_attribute("x", vertices[:, 0]), "x")
        self.refusal(ValueError, lambda: alcove.Mesh(vertices, faces).set_attribute("empty", np.zeros((8, 0))), "empty")
        self.refusal(ValueError, lambda: alcove.Field.box((0, 0, 0), (1, 1, 1)).dense((2 ** 32, 2 ** 32, 2)), "shape")
        self.refusal(ValueError, lambda: alcove.Field.sphere((0, 0, 0), -1), "radius")
        self.refusal(alcove.InputError, lambda: alcove.read("missing.ply"), "missing.ply")
        self.refusal(alcove.IoError, lambda: alcove.write(alcove.Mesh(vertices, faces), "/proc/none/a.ply"), "/proc/none")
        self.assertTrue(issubclass(alcove.InputError, ValueError) and issubclass(alcove.IoError, OSError))

    def test_values_that_are_not_finite_are_left_out(self):
        vertices, faces = cube(2)
        vertices[0] = np.nan
        ao = alcove.bake((vertices, faces)).ao
        self.assertTrue(np.isfinite(ao).all())
        self.assertEqual(ao[0], 1.0)


class Bakes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def test_values_equal_those_of_the_program(self):
        vertices, faces = cube(12)
        vertices += np.sin(3 * vertices[:, ::-1])
        mesh = alcove.Mesh(vertices.astype(np.float32), faces)
        alcove.write(mesh, self.path("in.ply"))
        attributes = ["ao", "convexity", "bent_normal", "thickness"]
        subprocess.run([PROGRAM, "bake", self.path("in.ply"), "-o", self.path("program.ply"), "--attributes",
                        ",".join(attributes), "--radius", "20%", "--quiet"], check=True)
        read = alcove.read(self.path("in.ply"))
        baked = alcove.bake(read, radius="20%", attributes=attributes)
        alcove.add(read, baked)
        alcove.write(read, self.path("module.ply"))
        with open(self.path("program.ply"), "rb") as a, open(self.path("module.ply"), "rb") as b:
            self.assertEqual(a.read(), b.read())
        self.assertEqual(baked.bent_normal.shape, (len(vertices), 3))
        np.testing.assert_array_equal(read.attribute("ao"), baked.ao)
        np.testing.assert_array_equal(alcove.bake(mesh, radius="20%").ao, alcove.bake((mesh.vertices, faces), radius="20%").ao)

    def test_result_says_how_it_was_made(self):
        baked = alcove.bake(cube(4), radius=1.5, quality="draft")
        self.assertAlmostEqual(baked.radius, 1.5, places=6)
        self.assertLess(baked.rmse, 0.05)
        self.assertTrue(baked.method)
        self.assertEqual(set(baked.seconds), {"grid", "pilot", "occlusion"})
        self.assertIsNone(baked.thickness)
        self.assertIsNone(alcove.bake(cube(), method="classic", error=None, attributes=["convexity"]).ao)

    def test_occluders_ground_and_points(self):
        floor = (np.array([[0, 0, 0], [0, 0, 9], [9, 0, 9], [9, 0, 0]], float), np.array([[0, 1, 2], [0, 2, 3]]))
        points = (np.array([[4.5, 0, 4.5]]), np.array([[0, 1, 0]]))
        lid = (floor[0] + [0, 1, 0], floor[1])
        open_floor = alcove.bake(floor, points=points, radius="inf", method="exact").ao
        covered = alcove.bake(floor, points=points, radius="inf", method="exact", occluders=[lid], parameters={"rays": 256}).ao
        self.assertEqual(open_floor[0], 1.0)
        self.assertLess(covered[0], 0.1)
        self.assertLess(alcove.bake(cube(2), ground=True, radius=1.0, method="exact").ao.min(), 0.6)

    def test_maps(self):
        vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
        mesh = alcove.Mesh(vertices, [[0, 1, 2, 3]], uvs=0.1 + 0.8 * vertices[:, :2])
        lid = (vertices + [0, 0, 0.5], [[0, 1, 2, 3]])
        maps = alcove.bake_maps(mesh, size=(64, 32), radius="inf", occluders=[lid], margin=0)
        self.assertEqual(maps.ao.shape, (32, 64))
        center, corner = maps.ao[16, 32], maps.ao[28, 8]
        self.assertLess(center, corner)
        expected = alcove.bake(mesh, points=([[0.5, 0.5, 0]], [[0, 0, 1]]), radius="inf", occluders=[lid], method="exact",
                               parameters={"rays": 1024}).ao[0]
        self.assertAlmostEqual(center, expected, delta=0.05)
        self.assertEqual(maps.coverage[0, 0], 0)
        self.assertEqual(maps.texels, (maps.coverage == 1).sum())
        with self.assertRaises(TypeError):
            alcove.bake_maps(mesh, colour=1)
        with self.assertRaises(alcove.InputError):
            alcove.bake_maps(cube())

    def test_progress_and_its_exceptions(self):
        calls = []
        alcove.bake(cube(20), progress=lambda work, done: calls.append((work, done)))
        self.assertTrue(calls and all(0.0 <= done <= 1.0 for _, done in calls))

        class Stop(Exception):
            pass

        def stop(work, done):
            raise Stop

        with self.assertRaises(Stop):
            alcove.bake(cube(20), progress=stop)

    def test_a_signal_ends_a_bake(self):
        shares = []
        many = {"rays": 1 << 20}  # a minute of work, without progress before its end
        with alarm(0.3), self.assertRaises(Alarm):
            alcove.bake(cube(4), method="exact", parameters=many, progress=lambda work, done: shares.append(done))
        self.assertNotIn(1.0, shares)
        with alarm(0.3, signal.default_int_handler), self.assertRaises(KeyboardInterrupt):
            alcove.bake_maps(alcove.Mesh(*cube(4), uvs=cube(4)[0][:, :2] / 4), size=64, method="exact", parameters=many)
        field = alcove.Field(cube(4))
        points = np.zeros((20000, 3)) + (2, 2, 4)
        with alarm(0.3), self.assertRaises(Alarm):
            field.ao(points, points * (0, 0, 1), parameters={"rays": 1 << 16})

    def test_a_handler_that_does_not_raise_lets_a_bake_go_on(self):
        handled = []
        rays = {"rays": 20000}
        expected = alcove.bake(cube(10), method="exact", parameters=rays).ao
        with alarm(0.05, lambda *_: handled.append(1)):
            ao = alcove.bake(cube(10), method="exact", parameters=rays).ao
        self.assertTrue(handled)
        np.testing.assert_array_equal(ao, expected)

    def test_a_signal_ends_reading_and_writing(self):
        mesh = alcove.Mesh(*grid(700))
        alcove.write(mesh, self.path("large.obj"))
        with open(self.path("old.obj"), "w") as old:
            old.write("v 0 0 0\n")
        with alarm(0.05), self.assertRaises(Alarm):
            alcove.write(mesh, self.path("old.obj"))
        with open(self.path("old.obj")) as old:
            self.assertEqual(old.read(), "v 0 0 0\n")
        with alarm(0.05), self.assertRaises(Alarm):
            alcove.read(self.path("large.obj"))
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["large.obj", "old.obj"])

    def test_a_bake_that_exceeds_its_time_limit_is_refused(self):
        mesh = alcove.Mesh(*cube(20), uvs=cube(20)[0][:, :2] / 20)
        slow = {"method": "exact", "parameters": {"rays": 1 << 16}, "time_limit": 0.01}
        for call in (lambda: alcove.bake(mesh, **slow), lambda: alcove.bake_maps(mesh, size=512, **slow)):
            with self.assertRaises(alcove.TimeLimitError) as caught:
                call()
            self.assertRegex(str(caught.exception), "raise time_limit by")
        self.assertIsNotNone(alcove.bake(mesh, time_limit=1000.0).ao)
        with self.assertRaises(alcove.InputError):
            alcove.bake(mesh, time_limit=0)

    def test_messages_name_arguments(self):
        mesh = alcove.Mesh(*cube(4))
        with self.assertRaises(alcove.InputError) as caught:
            alcove.bake(mesh, normals="file")
        self.assertIn('use normals="angle"', str(caught.exception))
        with self.assertRaises(alcove.InputError) as caught:
            alcove.bake(mesh, method="exact", error=0.1, parameters={"rays": 8})
        self.assertEqual(str(caught.exception), 'parameters["rays"] cannot be combined with error or quality, which determine it')
        with self.assertRaises(alcove.InputError) as caught:
            alcove.bake((np.eye(3), None), self_only=True, weld="1%")
        self.assertIn("self_only and weld are for meshes", str(caught.exception))
        with self.assertRaises(alcove.InputError) as caught:
            alcove.bake_maps(cube())
        self.assertIn("the program's --tessellate auto", str(caught.exception))
        warnings = alcove.bake(mesh, radius="1%", voxel="2%", method="classic").warnings
        self.assertTrue(any(re.search('use voxel="[0-9.]+%" or less', warning) for warning in warnings), warnings)
        vertices, faces = cube(8)
        vertices = (vertices - 4) / np.linalg.norm(vertices - 4, axis=1, keepdims=True)
        unwelded = vertices[faces.ravel()], np.arange(faces.size).reshape(-1, 3)
        (warning,) = alcove.bake(unwelded, method="exact").warnings
        self.assertIn('add weld="0.0001%"', warning)
        welded = alcove.bake(unwelded, method="exact", weld="0.0001%")
        self.assertEqual(welded.warnings, [])
        np.testing.assert_array_equal(welded.ao, alcove.bake((vertices, faces), method="exact").ao[faces.ravel()])

    def test_limits_of_memory_and_reading(self):
        mesh = alcove.Mesh(*cube(30))
        alcove.write(mesh, self.path("a.ply"))
        run = lambda code: subprocess.run([sys.executable, "-c", "import alcove\n" + code, self.path("a.ply")], text=True,
                                          stderr=subprocess.PIPE).stderr
        self.assertRegex(run("import sys\nalcove.limit_reading(1000)\nalcove.read(sys.argv[1])"),
                         r"LimitError.*raise limit_reading\(\)")
        self.assertRegex(run("import sys\nalcove.limit_memory(2e6)\nalcove.Field(alcove.read(sys.argv[1]), voxel='0.1%')"),
                         r"LimitError.*raise limit_memory\(\)")

    def test_two_threads_bake_at_once(self):
        meshes = [cube(10), cube(16)]
        expected = [alcove.bake(mesh).ao for mesh in meshes]
        results = [None, None]

        def work(i):
            results[i] = alcove.bake(meshes[i]).ao

        threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for i in range(2):
            np.testing.assert_array_equal(results[i], expected[i])

    def test_an_attribute_survives_its_replacement(self):
        mesh = alcove.Mesh(*cube())
        mesh.set_attribute("a", np.arange(8))
        a = mesh.attribute("a")
        mesh.set_attribute("a", np.zeros((8, 3)))
        np.testing.assert_array_equal(a, np.arange(8))

    def test_a_result_outlives_its_mesh_and_views_keep_it(self):
        ao = alcove.bake(cube(3)).ao
        vertices = alcove.Mesh(*cube(3)).vertices
        gc.collect()
        self.assertTrue(np.isfinite(ao).all() and np.isfinite(vertices).all())

    def test_a_million_vertices_are_copied_once(self):
        vertices, faces = grid(1000)
        for indices in (faces, faces.astype(np.int32), faces.astype(np.int64)):
            made = []
            grown = peak_growth(lambda: made.append(alcove.Mesh(vertices, indices)))
            copies = vertices.nbytes + faces.nbytes + 4 * (len(faces) + 1)
            self.assertLess(grown, 1.05 * copies)
            self.assertGreater(grown, 0.9 * copies)  # else the peak was not measured
        mesh = made[0]
        arrays = []
        self.assertLess(peak_growth(lambda: arrays.extend((mesh.vertices, mesh.faces))), 1e6)
        np.testing.assert_array_equal(arrays[0], vertices)
        np.testing.assert_array_equal(arrays[1], faces)
        baked = alcove.bake(mesh, method="classic")
        self.assertLess(peak_growth(lambda: arrays.append(baked.ao)), 1e6)
        self.assertTrue(np.shares_memory(baked.ao, arrays[2]))

    def test_nothing_leaks(self):
        vertices, faces = cube()
        field = alcove.Field.box((0, 0, 0), (1, 1, 1))

        def call():
            mesh = alcove.Mesh(vertices, faces)
            mesh.vertices.sum()
            field.map(vertices).sum()
            field.ao(vertices, vertices, method="classic").sum()
            try:
                alcove.Mesh(vertices[:, :2], faces)
            except ValueError:
                pass

        call()
        counts = sys.getrefcount(vertices), sys.getrefcount(faces)

        def bake():
            alcove.bake((vertices, faces), method="exact", parameters={"rays": 4}, attributes=["ao", "bent_normal"],
                        progress=lambda work, done: None)

        for calls, work in ((10000, call), (1000, bake)):
            for _ in range(calls // 5):
                work()
            before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            for _ in range(calls):
                work()
            self.assertEqual((sys.getrefcount(vertices), sys.getrefcount(faces)), counts)
            self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 2048)  # kB


class Fields(unittest.TestCase):
    def test_a_sphere_is_exact(self):
        field = alcove.Field.sphere((1, 2, 3), 2)
        points = np.array([[1, 2, 3], [4, 2, 3], [1, 2, 9]], float)
        np.testing.assert_allclose(field.map(points), [-2, 1, 4], atol=1e-5)
        np.testing.assert_allclose(field.gradient(points[1:]), [[1, 0, 0], [0, 0, 1]], atol=1e-3)
        np.testing.assert_allclose(field.trace(points[1:], [[-1, 0, 0], [0, 1, 0]]), [1, np.inf], atol=1e-3)

    def test_a_mesh(self):
        field = alcove.Field((cube(4)), radius="50%")
        centers = np.array([[2, 2, 4.5], [2, 2, 3.5], [2, 5, 2]])
        np.testing.assert_allclose(field.map(centers), [0.5, -0.5, 1.0], atol=0.05)
        values, origin, spacing = field.dense((16, 17, 18))
        self.assertEqual(values.shape, (16, 17, 18))
        i, j, k = 8, 8, 16
        np.testing.assert_allclose(values[i, j, k], field.map([np.array(origin) + np.array(spacing) * (i, j, k)])[0], atol=1e-4)

    def test_ao_in_front_of_a_wall(self):
        floor = alcove.Field.plane((0, 1, 0))
        values, origin, spacing = floor.dense((2, 3, 2), box=((0, -1, 0), (1, 1, 1)))
        np.testing.assert_allclose(values[0, :, 0], [-1, 0, 1])
        with self.assertRaises(alcove.InputError):
            floor.dense((2, 2, 2))
        self.assertEqual(floor.ao([[0, 0, 0]], [[0, 1, 0]], radius=1.0)[0], 1.0)
        with self.assertRaises(alcove.InputError):
            floor.ao([[0, 0, 0]], [[0, 1, 0]], method="exact")


class Tutorial(unittest.TestCase):
    def test_it_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            here = os.getcwd()
            os.chdir(folder)
            try:
                failures, count = doctest.testfile(TUTORIAL, module_relative=False, optionflags=doctest.ELLIPSIS)
            finally:
                os.chdir(here)
        self.assertGreater(count, 10)
        self.assertEqual(failures, 0)


if __name__ == "__main__":
    PROGRAM, TUTORIAL = os.path.abspath(PROGRAM), os.path.abspath(TUTORIAL)
    unittest.main(argv=sys.argv[:1])
