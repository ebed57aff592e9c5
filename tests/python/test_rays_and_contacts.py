"""Rays, moving balls, contacts and sets of triangles."""

import math
import unittest

import numpy as np

import planetree
from model_test_case import ModelTestCase
from planetree import Status
from shapes import distance_to_triangles


class Rays(ModelTestCase):
    def test_hit_the_sphere_where_they_enter(self):
        starts = self.points(300)
        starts *= (3 / np.linalg.norm(starts, axis=1))[:, None]
        hits = self.model.first_hits(starts, -starts)
        self.assertTrue((hits.status == Status.EXACT).all())
        np.testing.assert_allclose(hits.t, 2 / 3, atol=0.01)
        self.assertTrue((hits.t_lower <= hits.t).all() and (hits.t <= hits.t_upper).all())
        np.testing.assert_allclose(hits.points, starts * (1 - hits.t)[:, None], atol=1e-14)
        self.assertTrue(hits.entering.all())
        both = self.model.first_hits(np.concatenate([starts, -starts], axis=1))
        self.assertEqual(both.t.tobytes(), hits.t.tobytes())

    def test_miss(self):
        hits = self.model.first_hits([[2, 0, 0], [2, 0, 0]], [[1, 0, 0], [0, 1, 0]])
        self.assertTrue(np.isinf(hits.t).all())
        np.testing.assert_array_equal(hits.triangles, [planetree.NO_TRIANGLE] * 2)

    def test_have_ranges(self):
        start, way = [[3, 0.1, 0.2]], [[-1, 0, 0]]
        first = self.model.first_hits(start, way).t[0]
        second = self.model.first_hits(start, way, t_min=first + 0.1).t[0]
        self.assertGreater(second, first + 1)
        self.assertTrue(math.isinf(self.model.first_hits(start, way, t_max=first - 0.1).t[0]))
        many = self.model.first_hits(np.repeat(start, 2, 0), np.repeat(way, 2, 0), t_min=[0, first + 0.1])
        np.testing.assert_array_equal(many.t, [first, second])

    def test_all_hits_come_in_order(self):
        rays = np.array([[3, 0.1, 0.2, -1, 0, 0], [3, 9, 0, -1, 0, 0]])
        hits = self.model.all_hits(rays, limit=4)
        np.testing.assert_array_equal(hits.counts, [2, 0])
        self.assertTrue(hits.complete.all())
        self.assertLess(hits.t[0, 0], hits.t[0, 1])
        self.assertTrue(np.isinf(hits.t[0, 2:]).all() and np.isinf(hits.t[1]).all())
        np.testing.assert_array_equal(hits.entering[0, :2], [1, 0])
        self.assertFalse(self.model.all_hits(rays, limit=1).complete[0])


class MovingBalls(ModelTestCase):
    def test_touch_the_sphere(self):
        starts = self.points(200)
        starts *= (3 / np.linalg.norm(starts, axis=1))[:, None]
        found = self.model.first_contacts(starts, -starts, 0.5)
        self.assertTrue((found.free == 0).all())
        np.testing.assert_allclose(found.t, 1.5 / 6, atol=0.01)
        self.assertTrue((found.t_lower <= found.t_upper).all())
        centres = starts * (1 - 2 * found.t)[:, None]
        np.testing.assert_allclose(np.linalg.norm(centres - found.points, axis=1), 0.5)
        away = self.model.first_contacts(starts, 2 * starts, [0.5] * 200)
        self.assertTrue(away.free.all())

    def test_radii_are_one_or_as_many_as_balls(self):
        with self.assertRaisesRegex(ValueError, "radius"):
            self.model.first_contacts(self.points(3), self.points(3), [0.1, 0.2])


class Sets(ModelTestCase):
    def test_nearest_triangles_are_those_of_all(self):
        points = self.points(40)
        found = self.model.nearest_triangles(points, 5)
        np.testing.assert_array_equal(found.counts, [5] * 40)
        for i, point in enumerate(points):
            truth = np.sort(distance_to_triangles(point, self.vertices, self.faces))[:5]
            np.testing.assert_allclose(found.distance[i], truth, atol=1e-14)

    def test_triangles_within_are_complete_or_marked(self):
        points = self.points(40)
        found = self.model.triangles_within(points, 0.4, limit=64)
        for i, point in enumerate(points):
            count = (distance_to_triangles(point, self.vertices, self.faces) <= 0.4).sum()
            self.assertEqual(bool(found.complete[i]), count <= 64)
            self.assertEqual(found.counts[i], min(count, 64))
            self.assertTrue(np.isinf(found.distance[i, int(found.counts[i]) :]).all())

    def test_contacts_are_the_nearest_points(self):
        points = self.points(40)
        found = self.model.contacts(points, 2.0, limit=8, fields=("distance", "triangles"))
        np.testing.assert_array_equal(found.distance[:, 0], self.model.distance(points))
        self.assertEqual(found.distance.shape, (40, 8))

    def test_limits_are_checked(self):
        for bad in (0, -1, 10**9):
            with self.assertRaises((ValueError, MemoryError)):
                self.model.contacts([[0, 0, 0]], 1.0, limit=bad)


class Probes(ModelTestCase):
    def test_answer_as_arrays_do(self):
        probe = self.model.probe()
        points = self.points(50)
        found = self.model.closest_points(points)
        for i, point in enumerate(points):
            one = probe.closest_point(point)
            self.assertEqual(one.distance, found.distance[i])
            self.assertEqual(one.signed_distance, found.signed_distance[i])
            self.assertEqual(one.side, found.side[i])
            np.testing.assert_array_equal(one.normal, found.normals[i])
            self.assertEqual(probe.contains(point)[0], found.side[i])
        self.assertGreater(probe.work_spent, 0)

    def test_do_not_wait_if_told_so(self):
        probe = self.model.probe()
        hasty = probe.options(wait=False)
        probe.motion((0, 0, 1.5), (0, 0, -1))
        first = probe.closest_point((0.3, 0.4, 1.5), hasty)
        self.assertLessEqual(first.lower, self.model.distance([0.3, 0.4, 1.5]))
        exact = probe.closest_point((0.3, 0.4, 1.5))
        self.assertEqual(exact.status, Status.EXACT)
        hit = probe.first_hit((0, 0, 3), (0, 0, -1))
        self.assertAlmostEqual(hit.t, 2, 2)
        touch = probe.first_contact((0, 0, 3), (0, 0, 0), 0.5)
        self.assertAlmostEqual(touch.t, 0.5, 2)
        self.assertAlmostEqual(touch.at.distance, 0.5, 9)
        contacts = probe.contacts((0.9, 0, 0), 0.2)
        self.assertTrue(contacts.complete)
        self.assertLess(contacts.found[0].distance, 0.2)


if __name__ == "__main__":
    unittest.main()
