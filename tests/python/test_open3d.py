"""Meshes, tensors and answers of Open3D."""

import importlib.util
import unittest

import numpy as np

import planetree
from model_test_case import ModelTestCase

HAS_OPEN3D = importlib.util.find_spec("open3d") is not None


@unittest.skipUnless(HAS_OPEN3D, "python3-open3d is not installed")
class Open3D(ModelTestCase):
    def setUp(self):
        super().setUp()
        import open3d

        self.open3d = open3d
        self.mesh = open3d.geometry.TriangleMesh(
            open3d.utility.Vector3dVector(self.vertices),
            open3d.utility.Vector3iVector(self.faces.astype(np.int32)),
        )
        self.tensors = open3d.t.geometry.TriangleMesh.from_legacy(self.mesh)

    def test_meshes_build_the_same_file(self):
        path = self.folder / "open3d.ptree"
        planetree.build(self.mesh, path, replace=True)
        self.assertEqual(path.read_bytes(), self.path.read_bytes())
        planetree.build(self.tensors, path, replace=True)  # float32
        with planetree.open(path) as model:
            self.assertEqual(model.info["triangles"], len(self.faces))

    def test_deviations_of_meshes(self):
        self.assertLess(self.model.deviation(self.mesh).greatest[1], 1e-14)

    def test_scenes_answer_alike(self):
        theirs = self.open3d.t.geometry.RaycastingScene()
        theirs.add_triangles(self.tensors)
        ours = self.model.as_raycasting_scene()
        points = self.open3d.core.Tensor(self.points(300).astype(np.float32))
        rays = self.open3d.core.Tensor(
            np.concatenate([self.points(300), self.points(300)], axis=1).astype(np.float32)
        )
        # Not their signs and rays: in Debian's Open3D 0.16 no ray hits anything.
        np.testing.assert_allclose(
            ours.compute_distance(points), theirs.compute_distance(points).numpy(), atol=1e-5
        )
        inside = np.linalg.norm(points.numpy(), axis=1) < 0.97
        self.assertTrue((ours.compute_signed_distance(points)[inside] < 0).all())
        np.testing.assert_allclose(
            ours.compute_closest_points(points)["points"],
            theirs.compute_closest_points(points)["points"].numpy(),
            atol=1e-4,
        )
        hits = ours.cast_rays(rays)["t_hit"]
        start, way = rays.numpy()[:, :3], rays.numpy()[:, 3:]
        hit = np.isfinite(hits)
        radius = np.linalg.norm(start[hit] + hits[hit, None] * way[hit], axis=1)
        np.testing.assert_allclose(radius, 1, atol=0.02)
        self.assertGreater(hit.sum(), 50)


if __name__ == "__main__":
    unittest.main()
