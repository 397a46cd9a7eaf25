"""The Python module: values equal the program's, arrays are checked, and nothing leaks.

    PYTHONPATH=build/python /usr/bin/python3 tests/python/test_alcove.py build/alcove docs/python.md
"""
import doctest
import gc
import os
import resource
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
        n = 1000
        x, y = np.meshgrid(np.arange(n, dtype=float), np.arange(n, dtype=float))
        vertices = np.stack([x.ravel(), y.ravel(), np.zeros(n * n)], 1)
        i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
        faces = np.concatenate([np.stack([i, i + 1, i + n + 1], 1), np.stack([i, i + n + 1, i + n], 1)]).astype(np.uint32)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        mesh = alcove.Mesh(vertices, faces)
        grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024
        self.assertEqual(mesh.vertices.shape, (n * n, 3))
        # Positions, corners as 64 bits on the way, and offsets.
        self.assertLess(grown, vertices.nbytes + 3 * faces.nbytes + 4 * len(faces) + 2e7)

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
        for calls, work in ((10000, call), (50, lambda: alcove.bake((vertices, faces), attributes=["ao", "bent_normal"]))):
            for _ in range(calls // 5):
                work()
            before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            for _ in range(calls):
                work()
            self.assertEqual((sys.getrefcount(vertices), sys.getrefcount(faces)), counts)
            self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 8192)  # kB


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
