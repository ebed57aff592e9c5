"""Building from arrays, files and meshes of other libraries."""

import json
import signal
import struct
import types
import unittest

import numpy as np

import planetree
from model_test_case import Alarm, ModelTestCase, alarm_soon
from planetree import ErrorCode
from shapes import cube, run_command


def open3d_mesh(vertices, faces):
    """What has the attributes of open3d.geometry.TriangleMesh."""
    return types.SimpleNamespace(vertices=vertices, triangles=faces)


def tensor(array):
    """What has the methods of a tensor of Open3D."""
    return types.SimpleNamespace(cpu=lambda: types.SimpleNamespace(numpy=lambda: array))


class Builds(ModelTestCase):
    def build(self, mesh, **options):
        path = self.folder / "built.ptree"
        report = planetree.build(mesh, path, replace=True, **options)
        return path, report

    def test_of_several_files_are_those_of_the_whole(self):
        corners = np.random.default_rng(5).uniform(-1, 1, (60, 3, 3)).astype("<f4")

        def write(name, some):
            path = self.folder / name
            rows = b"".join(b"\0" * 12 + c.tobytes() + b"\0\0" for c in some)
            path.write_bytes(b"\0" * 80 + struct.pack("<I", len(some)) + rows)
            return path

        whole = self.build(write("whole.stl", corners))[0].read_bytes()
        parts = [write("a.stl", corners[:20]), write("b.stl", corners[20:])]
        path, report = self.build(parts)
        self.assertEqual(report.triangles, 60)
        self.assertTrue(path.read_bytes() == whole)

    def test_of_arrays_are_those_of_files(self):
        mesh = self.folder / "statue.ply"
        run_command("generate", mesh, "--triangles", 5000, "--force")
        path, report = self.build(mesh)
        self.assertGreater(report.triangles, 4000)
        self.assertTrue(report.watertight)
        from_file = path.read_bytes()
        # The mesh as arrays, read here.
        content = mesh.read_bytes()
        head, body = content.split(b"end_header\n", 1)
        counts = [int(line.split()[2]) for line in head.split(b"\n") if line.startswith(b"element")]
        vertices = np.frombuffer(body, "<f4", 3 * counts[0]).reshape(-1, 3)
        rows = np.frombuffer(body[12 * counts[0] :], np.uint8).reshape(counts[1], 13)
        faces = np.ascontiguousarray(rows[:, 1:]).view("<u4").reshape(-1, 3)
        path, _ = self.build((vertices, faces))
        self.assertEqual(path.read_bytes(), from_file)

    def test_of_a_glb_are_those_of_its_arrays(self):
        vertices, faces = cube()
        arrays = [np.asarray(vertices, "<f4").tobytes(), np.asarray(faces, "<u2").tobytes()]
        views = [{"buffer": 0, "byteOffset": 0, "byteLength": len(arrays[0])}]
        views.append({"buffer": 0, "byteOffset": len(arrays[0]), "byteLength": len(arrays[1])})
        document = {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": sum(map(len, arrays))}],
            "bufferViews": views,
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": len(vertices), "type": "VEC3"},
                {"bufferView": 1, "componentType": 5123, "count": 3 * len(faces), "type": "SCALAR"},
            ],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        }
        chunks = [json.dumps(document).encode(), b"".join(arrays)]
        chunks = [chunk + b" " * (-len(chunk) % 4) for chunk in chunks]
        glb = struct.pack("<4sII", b"glTF", 2, 28 + sum(map(len, chunks)))
        for chunk, kind in zip(chunks, (b"JSON", b"BIN\0")):
            glb += struct.pack("<I4s", len(chunk), kind) + chunk
        mesh = self.folder / "cube.glb"
        mesh.write_bytes(glb)
        from_glb = self.build(mesh)[0].read_bytes()
        from_arrays = self.build((np.asarray(vertices, np.float32), faces))[0].read_bytes()
        self.assertEqual(from_glb, from_arrays)

    def test_take_any_kind_of_integers(self):
        vertices, faces = cube()
        expected = self.build((vertices, faces.astype(np.uint32)))[0].read_bytes()
        for kind in (np.int32, np.int64, np.uint8, np.uint64):
            self.assertEqual(self.build((vertices, faces.astype(kind)))[0].read_bytes(), expected)

    def test_skip_triangles_of_vertices_that_are_not_there(self):
        vertices, faces = cube()
        for kind, bad in ((np.int64, -1), (np.int64, 2**32), (np.int32, -1), (np.uint32, 8)):
            broken = np.concatenate([faces, [[0, 1, bad]]]).astype(kind)
            _, report = self.build((vertices, broken))
            self.assertEqual((report.triangles, report.skipped), (12, 1))
            with self.assertRaises(planetree.Error):
                self.build((vertices, broken), strict=True)

    def test_take_meshes_of_other_libraries(self):
        vertices, faces = cube()
        expected = self.build((vertices, faces))[0].read_bytes()
        trimesh = types.SimpleNamespace(
            vertices=vertices, faces=faces, triangles=vertices[faces], vertex_normals=vertices
        )
        tensors = types.SimpleNamespace(
            vertex=types.SimpleNamespace(positions=tensor(vertices)),
            triangle=types.SimpleNamespace(indices=tensor(faces)),
        )
        meshio = types.SimpleNamespace(points=vertices, cells_dict={"triangle": faces})
        for mesh in (open3d_mesh(vertices, faces), trimesh, tensors, meshio):
            self.assertEqual(self.build(mesh)[0].read_bytes(), expected)
        quads = types.SimpleNamespace(
            points=vertices,
            cells_dict={"quad": np.column_stack([faces[::2], faces[1::2, 2]])},
        )
        self.assertEqual(self.build(quads)[1].triangles, 12)
        with self.assertRaisesRegex(TypeError, "no mesh that is known"):
            self.build(17)
        with self.assertRaisesRegex(ValueError, "need"):
            self.build((vertices, faces[:, :2]))

    def test_of_bad_input_fail(self):
        with self.assertRaises(planetree.Error) as caught:
            self.build((np.zeros((3, 3)) * np.nan, np.array([[0, 1, 2]])))
        self.assertEqual(caught.exception.code, ErrorCode.BAD_INPUT)
        with self.assertRaisesRegex(planetree.Error, "no_mesh"):
            self.build(self.folder / "no_mesh.ply")
        path, _ = self.build(cube())
        with self.assertRaises(planetree.Error) as caught:
            planetree.build(cube(), path)
        self.assertEqual(caught.exception.code, ErrorCode.ALREADY_EXISTS)

    def test_keep_to_options(self):
        vertices, faces = cube()
        path, report = self.build((vertices, faces), layers=planetree.Layers.DISTANCE)
        self.assertEqual(report.layers, planetree.Layers.DISTANCE)
        _, report = self.build((vertices, faces), side=planetree.SideRule.SURFACE)
        self.assertEqual(report.side_rule, planetree.SideRule.SURFACE)
        path, report = self.build((vertices, faces), box=[(0, 0, 0.5), (1, 1, 1)])
        with planetree.open(path) as model:
            np.testing.assert_array_equal(model.info["region"], [(0, 0, 0.5), (1, 1, 1)])

    def test_tell_progress_and_stop_at_control_c(self):
        mesh = self.folder / "larger.ply"
        run_command("generate", mesh, "--triangles", 300_000, "--force")
        told = []

        def progress(phase, done, total):
            told.append(phase)
            if len(told) == 2:
                signal.raise_signal(signal.SIGINT)

        path = self.folder / "stopped.ptree"
        with self.assertRaises(KeyboardInterrupt):
            planetree.build(mesh, path, progress=progress)
        self.assertFalse(path.exists())
        self.assertIsInstance(told[0], str)
        with self.assertRaises(Alarm), alarm_soon(0.1):
            planetree.build(mesh, path)
        self.assertFalse(path.exists())


if __name__ == "__main__":
    unittest.main()
