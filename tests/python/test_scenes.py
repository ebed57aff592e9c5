"""Grids, slices, deviations, and the methods of Open3D's scene."""

import math
import unittest

import numpy as np

import planetree
from model_test_case import ModelTestCase
from planetree import Side


class Samples(ModelTestCase):
    def test_grids_are_queries_of_their_points(self):
        grid = self.model.grid((7, 8, 9), fields=("signed_distance", "normals"))
        points = np.stack(np.meshgrid(*grid.axes, indexing="ij"), axis=-1)
        found = self.model.closest_points(points)
        np.testing.assert_array_equal(grid.signed_distance, found.signed_distance)
        np.testing.assert_array_equal(grid.normals, found.normals)
        low, high = self.model.info["core"]
        self.assertTrue(all(axis[0] < a and b < axis[-1] for axis, a, b in zip(grid.axes, low, high)))

    def test_large_grids_come_in_pieces(self):
        told = []
        grid = self.model.grid((70, 70, 70), fields="side", progress=lambda *of: told.append(of))
        self.assertEqual(told[-1], (343_000, 343_000))
        self.assertGreater(len(told), 1)
        spacing = np.prod([axis[1] - axis[0] for axis in grid.axes])
        volume = (grid.side == Side.INSIDE).sum() * spacing
        self.assertAlmostEqual(volume, 4 / 3 * math.pi, delta=0.1)

    def test_slices_have_rows_and_columns(self):
        for axis, along in (("x", (1, 2)), ("y", (0, 2)), (2, (0, 1))):
            low, high = [-1.0, -2.0, -3.0], [1.0, 2.0, 3.0]
            cut = self.model.slice(axis, 0.25, resolution=30, lower=low, upper=high)
            columns, rows = cut.axes
            self.assertEqual(cut.signed_distance.shape, (len(rows), len(columns)))
            self.assertEqual(max(len(rows), len(columns)), 30)
            self.assertEqual(
                cut.extent, (low[along[0]], high[along[0]], low[along[1]], high[along[1]])
            )
            point = np.full(3, 0.25)
            point[along[0]], point[along[1]] = columns[3], rows[5]
            self.assertEqual(cut.signed_distance[5, 3], self.model.signed_distance(point))
        for bad in ("w", 3):
            with self.assertRaisesRegex(ValueError, "no axis"):
                self.model.slice(bad, 0)

    def test_deviations_have_statistics(self):
        points = self.points(1000)
        deviation = self.model.deviation(points)
        truth = self.model.signed_distance(points)
        self.assertAlmostEqual(deviation.mean, truth.mean())
        self.assertAlmostEqual(deviation.rms, math.sqrt((truth**2).mean()))
        low, high = deviation.greatest
        self.assertTrue(low <= np.abs(truth).max() <= high)
        self.assertEqual(deviation.within(10), 1)
        np.testing.assert_allclose(deviation.percentiles(50), np.median(truth))
        self.assertEqual(deviation.histogram(7)[0].sum(), 1000)
        of_mesh = self.model.deviation((self.vertices, self.faces))
        self.assertEqual(of_mesh.distances.shape, (len(self.vertices),))
        self.assertLess(of_mesh.greatest[1], 1e-14)


class Scenes(ModelTestCase):
    def setUp(self):
        super().setUp()
        self.scene = self.model.as_raycasting_scene()

    def test_distances(self):
        points = self.points(100).astype(np.float32)
        signed = self.scene.compute_signed_distance(points)
        self.assertEqual(signed.dtype, np.float32)
        np.testing.assert_array_equal(np.abs(signed), self.scene.compute_distance(points))
        inside = np.linalg.norm(points, axis=1) < 0.97
        self.assertTrue((self.scene.compute_occupancy(points)[inside] == 1).all())
        closest = self.scene.compute_closest_points(points)
        np.testing.assert_allclose(
            np.linalg.norm(closest["points"] - points, axis=1), np.abs(signed), atol=1e-6
        )
        corners = self.vertices[self.faces[closest["primitive_ids"].astype(int)]]
        u, v = closest["primitive_uvs"].T.astype(float)
        weights = np.stack([1 - u - v, u, v], axis=-1)
        np.testing.assert_allclose(
            np.einsum("ij,ijk->ik", weights, corners), closest["points"], atol=1e-6
        )

    def test_rays(self):
        rays = np.array([[[3, 0.1, 0.2, -1, 0, 0], [3, 9, 0, -1, 0, 0]]], np.float32)
        hit = self.scene.cast_rays(rays)
        self.assertEqual(hit["t_hit"].shape, (1, 2))
        self.assertTrue(np.isinf(hit["t_hit"][0, 1]))
        self.assertEqual(hit["primitive_ids"][0, 1], self.scene.INVALID_ID)
        self.assertEqual(hit["geometry_ids"].tolist(), [[0, self.scene.INVALID_ID]])
        self.assertEqual(self.scene.test_occlusions(rays).tolist(), [[True, False]])
        self.assertEqual(self.scene.test_occlusions(rays, tfar=1).tolist(), [[False, False]])
        self.assertEqual(self.scene.count_intersections(rays).tolist(), [[2, 0]])
        all_of = self.scene.list_intersections(rays)
        self.assertEqual(all_of["ray_splits"].tolist(), [0, 2, 2])
        self.assertEqual(all_of["ray_ids"].tolist(), [0, 0])
        self.assertEqual(all_of["t_hit"][0], hit["t_hit"][0, 0])

    def test_many_intersections(self):
        vertices, faces = self.vertices, self.faces
        count = 30
        shells = np.concatenate([vertices * (1 + i) for i in range(count)])
        all_faces = np.concatenate([faces + i * len(vertices) for i in range(count)])
        path = self.folder / "shells.ptree"
        planetree.build((shells, all_faces), path, replace=True)
        with planetree.open(path) as model:
            scene = model.as_raycasting_scene()
            self.assertEqual(scene.count_intersections([[0.1, 0.2, 99, 0, 0, -1]]).tolist(), [60])


if __name__ == "__main__":
    unittest.main()
