"""Nearest points, sides and distances of arrays of points."""

import math
import tracemalloc
import unittest

import numpy as np

import planetree
from model_test_case import ModelTestCase
from planetree import Side, Status
from shapes import distances


class ClosestPoints(ModelTestCase):
    def test_agree_with_all_triangles(self):
        points = self.points(200)
        found = self.model.closest_points(points)
        truth = distances(points, self.vertices, self.faces)
        self.assertTrue((found.status == Status.EXACT).all())
        slack = 1e-14
        self.assertTrue((found.lower <= truth + slack).all())
        self.assertTrue((truth <= found.upper + slack).all())
        np.testing.assert_allclose(np.linalg.norm(found.points - points, axis=1), found.distance)
        corners = self.vertices[self.faces[found.triangles.astype(int)]]
        np.testing.assert_allclose(
            np.einsum("ij,ijk->ik", found.barycentric, corners), found.points, atol=1e-14
        )
        np.testing.assert_allclose(np.linalg.norm(found.normals, axis=1), 1)

    def test_signs_are_negative_inside(self):
        points = self.points(500)
        radius = np.linalg.norm(points, axis=1)
        clear = np.abs(radius - 1) > 0.02
        found = self.model.closest_points(points)
        np.testing.assert_array_equal(found.signed_distance[clear] < 0, radius[clear] < 1)
        np.testing.assert_array_equal(
            found.side[clear], np.where(radius[clear] < 1, Side.INSIDE, Side.OUTSIDE)
        )
        np.testing.assert_array_equal(np.abs(found.signed_distance), found.distance)
        np.testing.assert_array_equal(self.model.signed_distance(points), found.signed_distance)
        np.testing.assert_array_equal(self.model.distance(points), found.distance)
        np.testing.assert_array_equal(self.model.contains(points), found.side == Side.INSIDE)

    def test_any_leading_shape(self):
        points = self.points(2, 3, 4)
        flat = self.model.closest_points(points.reshape(-1, 3))
        found = self.model.closest_points(points)
        self.assertEqual(found.distance.shape, (2, 3, 4))
        self.assertEqual(found.points.shape, (2, 3, 4, 3))
        for name in found.fields:
            np.testing.assert_array_equal(
                found.as_dict()[name].reshape(flat.as_dict()[name].shape), flat.as_dict()[name]
            )
        self.assertEqual(self.model.distance(points[0, 0, 0]).shape, ())
        self.assertEqual(self.model.contains(points).shape, (2, 3, 4))
        self.assertEqual(self.model.distance(np.zeros((0, 3))).shape, (0,))

    def test_any_kind_of_numbers(self):
        points = np.round(self.points(50) * 8) / 8
        expected = self.model.distance(points)
        for given in (
            points.astype(np.float32),
            points.astype(">f8"),
            points.tolist(),
            np.asfortranarray(points),
            np.repeat(points, 2, axis=0)[::2],
        ):
            np.testing.assert_array_equal(self.model.distance(given), expected)
        np.testing.assert_array_equal(
            self.model.distance(points.astype(int)), self.model.distance(np.trunc(points))
        )

    def test_refuses_what_is_no_points(self):
        for bad in (np.zeros((3, 2)), np.zeros(()), 1.0):
            with self.assertRaisesRegex(ValueError, r"\(\.\.\., 3\)"):
                self.model.closest_points(bad)
        for bad in (np.zeros((1, 3), complex), np.array([["a", "b", "c"]])):
            with self.assertRaisesRegex(TypeError, "real numbers"):
                self.model.closest_points(bad)

    def test_makes_only_what_is_asked_for(self):
        points = self.points(10)
        found = self.model.closest_points(points, fields=("points", "lower"))
        self.assertEqual(found.fields, ("points", "lower"))
        with self.assertRaisesRegex(AttributeError, "'normals' was not asked for"):
            found.normals
        with self.assertRaisesRegex(AttributeError, "has no 'nonsense'"):
            found.nonsense
        with self.assertRaisesRegex(ValueError, "no field 'nonsense'"):
            self.model.closest_points(points, fields=("nonsense",))

    def test_writes_to_given_arrays(self):
        points = self.points(4, 5)
        expected = self.model.closest_points(points)
        out = {"distance": np.empty((4, 5)), "normals": np.empty((4, 5, 3))}
        found = self.model.closest_points(points, out=out)
        self.assertEqual(found.fields, ("distance", "normals"))
        self.assertIs(found.distance, out["distance"])
        np.testing.assert_array_equal(out["normals"], expected.normals)
        sides = np.empty((4, 5), np.uint8)
        self.assertIs(self.model.contains(points, out=sides), sides)

    def test_refuses_unsuitable_arrays(self):
        points = self.points(6)
        read_only = np.empty(6)
        read_only.flags.writeable = False
        for bad in (np.empty(5), np.empty(6, np.float32), np.empty(12)[::2], read_only, [0.0] * 6):
            with self.assertRaises(ValueError):
                self.model.closest_points(points, out={"distance": bad})

    def test_copies_no_array_of_doubles(self):
        points = self.points(200_000)
        tracemalloc.start()
        try:
            self.model.distance(points)
            peak = tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()
        self.assertGreaterEqual(peak, 8 * len(points))  # the distances
        self.assertLess(peak, 8 * len(points) + 100_000)

    def test_same_bits_in_pieces_and_on_threads(self):
        points = self.points(150_000)
        with planetree.open(self.path, threads=2, memory="32M") as threaded:
            first = self.model.closest_points(points)
            second = threaded.closest_points(points)
            for name, array in first.as_dict().items():
                self.assertEqual(array.tobytes(), second.as_dict()[name].tobytes(), name)
        piece = self.model.closest_points(points[1000:1010])
        self.assertEqual(piece.points.tobytes(), first.points[1000:1010].tobytes())

    def test_points_that_are_no_points_have_no_distance(self):
        found = self.model.closest_points([[math.nan, 0, 0], [0, math.inf, 0], [0, 0, 0]])
        np.testing.assert_array_equal(
            found.status, [Status.BAD_QUERY, Status.BAD_QUERY, Status.EXACT]
        )
        self.assertTrue(np.isinf(found.distance[:2]).all())
        np.testing.assert_array_equal(found.triangles[:2], [planetree.NO_TRIANGLE] * 2)
        np.testing.assert_array_equal(self.model.contains([[math.nan, 0, 0], [0, 0, 0]]), [255, 1])

    def test_options_limit_the_search(self):
        far = self.model.closest_points([[9, 0, 0]], max_distance=1.0)
        np.testing.assert_array_equal(far.status, [Status.BEYOND_MAX_DISTANCE])
        points = self.points(100)
        loose = self.model.closest_points(points, max_error=0.5)
        exact = self.model.distance(points)
        self.assertTrue((loose.upper - loose.lower <= 0.5).all())
        self.assertTrue(((loose.lower <= exact) & (exact <= loose.upper)).all())
        outward = self.model.closest_points(points, normal_rule=planetree.NormalRule.OUTWARD)
        toward = self.model.closest_points(points, normal_rule=planetree.NormalRule.TOWARD_QUERY)
        inside = outward.side == Side.INSIDE
        np.testing.assert_array_equal(toward.normals[inside], -outward.normals[inside])
        for bad in ({"max_error": -1}, {"max_distance": math.nan}, {"max_work": 0}):
            with self.assertRaises(ValueError):
                self.model.distance(points, **bad)

    def test_without_the_side_layer_sides_are_unknown(self):
        with planetree.open(self.path, layers=planetree.Layers.DISTANCE) as model:
            np.testing.assert_array_equal(model.contains([[0, 0, 0]]), [255])
            self.assertGreater(model.distance([0, 0, 0]), 0.9)


if __name__ == "__main__":
    unittest.main()
