"""Attributes of triangles: kept by builds, read by index and at answers."""

import unittest

import numpy as np

import planetree
from model_test_case import ModelTestCase
from planetree import Attributes, ErrorCode, Layers, ValueKind
from shapes import cube


class AttributesOfTriangles(ModelTestCase):
    def build(self, mesh, **options):
        path = self.folder / "kept.ptree"
        report = planetree.build(mesh, path, replace=True, **options)
        return planetree.open(path), report

    def setUp(self):
        self.vertices, self.faces = (np.asarray(part) for part in cube())
        count = len(self.vertices)
        self.colors = (np.arange(4 * count).reshape(count, 4) * 7 % 256).astype(np.uint8)
        self.uvs = np.arange(2 * count, dtype=np.float32).reshape(count, 2) / 8
        self.values = np.arange(len(self.faces), dtype=np.int64) * -(2**40)

    def test_are_those_of_the_arrays(self):
        model, report = self.build(
            (self.vertices, self.faces), colors=self.colors, uvs=self.uvs, values=self.values
        )
        with model:
            self.assertEqual(report.attributes, 15)
            self.assertEqual(model.info["attributes"], Attributes(15))
            self.assertEqual(model.info["value_kind"], ValueKind.SIGNED)
            self.assertIn(Layers.ATTRIBUTES, model.info["layers"])
            indices = np.array([[3, 0], [7, 7]])
            found = model.triangles(indices)
            np.testing.assert_array_equal(found.corners, self.vertices[self.faces[indices]])
            np.testing.assert_array_equal(found.colors, self.colors[self.faces[indices]])
            np.testing.assert_array_equal(found.uvs, self.uvs[self.faces[indices]])
            np.testing.assert_array_equal(found.values, self.values[indices])
            self.assertEqual(found.values.dtype, np.int64)

    def test_are_interpolated_at_answers(self):
        model, _ = self.build((self.vertices, self.faces), colors=self.colors, uvs=self.uvs)
        with model:
            answers = model.closest_points(self.vertices * 3 - 1)
            found = model.triangles(answers.triangles)
            np.testing.assert_array_equal(found.colors_at(answers.barycentric), self.colors)
            np.testing.assert_array_equal(found.uvs_at(answers.barycentric), self.uvs)
            points = np.random.default_rng(1).random((500, 3)) * 3 - 1
            answers = model.closest_points(points)
            found = model.triangles(answers.triangles)
            at = np.einsum("nk,nkc->nc", answers.barycentric, found.corners)
            np.testing.assert_allclose(at, answers.points, atol=1e-12)
            with self.assertRaisesRegex(ValueError, "barycentric"):
                found.colors_at(np.zeros((3, 3)))

    def test_exist_only_if_they_are_kept(self):
        model, report = self.build((self.vertices, self.faces), keep="triangles")
        with model:
            self.assertEqual(report.attributes, Attributes.TRIANGLES)
            found = model.triangles(11)
            self.assertEqual(found.fields, ("corners",))
            self.assertEqual(found.corners.shape, (3, 3))
            with self.assertRaises(AttributeError):
                found.colors
            self.assertEqual(model.triangles([]).corners.shape, (0, 3, 3))
        model, report = self.build((self.vertices, self.faces))
        with model, self.assertRaises(planetree.Error) as raised:
            self.assertEqual(report.attributes, 0)
            model.triangles(0)
        self.assertEqual(raised.exception.code, ErrorCode.UNSUPPORTED)

    def test_of_corners_and_of_floats(self):
        corner_uvs = np.random.default_rng(2).random((len(self.faces), 3, 2))
        colors = np.linspace(0, 1, 3 * len(self.vertices)).reshape(-1, 3)
        values = np.linspace(-1, 1, len(self.faces))
        model, _ = self.build(
            (self.vertices, self.faces), colors=colors, uvs=corner_uvs, values=values
        )
        with model:
            found = model.triangles(np.arange(len(self.faces)))
            np.testing.assert_array_equal(found.uvs, corner_uvs.astype(np.float32))
            np.testing.assert_array_equal(found.values, values)
            expected = np.floor(colors * 255 + 0.5).astype(np.uint8)
            np.testing.assert_array_equal(found.colors[..., :3], expected[self.faces])
            self.assertTrue((found.colors[..., 3] == 255).all())

    def test_of_a_file_are_named(self):
        mesh = self.folder / "painted.ply"
        corners = "".join(f"{x} {y} {z} {10 * x + y} 20 30\n" for x, y, z in self.vertices.astype(int))
        faces = "".join(f"3 {a} {b} {c} {i}.5\n" for i, (a, b, c) in enumerate(self.faces))
        mesh.write_text(
            "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
            "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
            f"element face {len(self.faces)}\nproperty list uchar int vertex_indices\n"
            "property float quality\nend_header\n" + corners + faces
        )
        model, _ = self.build(mesh, keep=["color", "value"], value="quality")
        with model:
            found = model.triangles(np.arange(len(self.faces)))
            np.testing.assert_array_equal(found.values, np.arange(len(self.faces)) + 0.5)
            expected = 10 * self.vertices[self.faces][..., 0] + self.vertices[self.faces][..., 1]
            np.testing.assert_array_equal(found.colors[..., 0], expected)
        with self.assertRaises(planetree.Error):
            self.build(mesh, keep="uv")
        with self.assertRaisesRegex(ValueError, "keep="):
            self.build(mesh, colors=self.colors)

    def test_refuse_what_is_wrong(self):
        mesh = (self.vertices, self.faces)
        for options in (
            {"keep": "colour"},
            {"colors": self.colors[:, :2]},
            {"colors": self.colors.astype(int) + 200},
            {"uvs": self.uvs[:, :1]},
            {"values": self.values[:, None]},
        ):
            with self.subTest(options), self.assertRaises(ValueError):
                self.build(mesh, **options)
        with self.assertRaises(planetree.Error):
            self.build(mesh, colors=self.colors[1:])
        model, _ = self.build(mesh, keep=Attributes.TRIANGLES)
        with model:
            with self.assertRaises(TypeError):
                model.triangles([0.5])
            for index in (len(self.faces), -1):
                with self.assertRaises(planetree.Error) as raised:
                    model.triangles(index)
                self.assertEqual(raised.exception.code, ErrorCode.BAD_ARGUMENT)


if __name__ == "__main__":
    unittest.main()
