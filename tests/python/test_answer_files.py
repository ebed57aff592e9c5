"""NumPy and an XML parser read the files that the command writes."""

import pathlib
import re
import tempfile
import unittest
import xml.etree.ElementTree

import numpy as np

import planetree
from planetree import Side, Status
from shapes import run_command

FIELDS = ("distance", "lower", "upper", "side", "points", "normals", "triangles")
TYPES = {"Float64": "<f8", "Int64": "<i8", "UInt8": "|u1"}


def read_vtp(path):
    """The arrays of a VTK file with raw appended data, by name."""
    head, data = path.read_bytes().split(b'<AppendedData encoding="raw">\n   _')
    tree = xml.etree.ElementTree.fromstring(head + b"</VTKFile>")
    arrays = {}
    for described in tree.iter("DataArray"):
        at = int(described.get("offset"))
        size = int(np.frombuffer(data, "<u8", 1, at)[0])
        kind = np.dtype(TYPES[described.get("type")])
        values = np.frombuffer(data, kind, size // kind.itemsize, at + 8)
        parts = int(described.get("NumberOfComponents", 1))
        arrays[described.get("Name")] = values.reshape(-1, parts) if parts > 1 else values
    piece = tree.find("PolyData/Piece")
    return arrays, {name: int(piece.get(name)) for name in piece.keys()}


class AnswerFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.place = pathlib.Path(folder.name)
        cls.tree = cls.place / "statue.ptree"
        run_command("generate", cls.place / "statue.ply", "--triangles", 5_000)
        run_command("build", cls.place / "statue.ply", "-o", cls.tree)
        with planetree.open(cls.tree) as model:
            low, high = model.info["box"]
            cls.points = np.random.default_rng(4).uniform(low, high, (100_000, 3))
            cls.found = model.closest_points(cls.points, fields=FIELDS)
        np.save(cls.place / "points.npy", cls.points)

    def query(self, name, *options):
        path = self.place / name
        run_command("query", self.tree, self.place / "points.npy", "-o", path, *options)
        return path

    def test_numpy_arrays_have_the_answers(self):
        path = self.query("answers.npy")
        rows = np.load(path, allow_pickle=False)
        self.assertEqual(rows.shape, (len(self.points),))
        self.assertEqual(rows.dtype["triangle"], np.int64)
        positions = np.stack([rows[name] for name in "xyz"], axis=-1)
        self.assertEqual(positions.tobytes(), self.points.tobytes())
        for name in ("distance", "lower", "upper"):
            np.testing.assert_array_equal(rows[name], getattr(self.found, name), name)
        np.testing.assert_array_equal(rows["side"], self.found.side)
        np.testing.assert_array_equal(rows["triangle"], self.found.triangles)
        self.assertTrue((rows["status"] == Status.EXACT).all())
        self.assertGreater((rows["side"] == Side.INSIDE).sum(), 0)
        mapped = np.load(path, mmap_mode="r")
        self.assertEqual(mapped.offset % 64, 0)
        self.assertEqual(mapped["nz"][-1], self.found.normals[-1, 2])

    def test_vtk_files_have_the_answers(self):
        arrays, counts = read_vtp(self.query("answers.vtp"))
        self.assertEqual(counts["NumberOfPoints"], len(self.points))
        self.assertEqual(counts["NumberOfVerts"], len(self.points))
        self.assertEqual(arrays["Points"].tobytes(), self.found.points.tobytes())
        self.assertEqual(arrays["query"].tobytes(), self.points.tobytes())
        self.assertEqual(arrays["normal"].tobytes(), self.found.normals.tobytes())
        np.testing.assert_array_equal(arrays["distance"], self.found.distance)
        np.testing.assert_array_equal(arrays["side"], self.found.side)
        np.testing.assert_array_equal(arrays["offsets"], np.arange(1, len(self.points) + 1))

    def test_deviations_are_arrays_and_vtk_files(self):
        for name in ("map.npy", "map.vtp", "map.ply"):
            run_command("compare", self.tree, self.place / "points.npy", "-o", self.place / name)
        rows = np.load(self.place / "map.npy", allow_pickle=False)
        self.assertEqual(rows.dtype.names, ("x", "y", "z", "distance", "red", "green", "blue"))
        np.testing.assert_array_equal(np.abs(rows["distance"]), self.found.distance)
        arrays, _ = read_vtp(self.place / "map.vtp")
        np.testing.assert_array_equal(arrays["distance"], rows["distance"])
        np.testing.assert_array_equal(arrays["colour"][:, 1], rows["green"])
        ply = (self.place / "map.ply").read_bytes()
        kind = np.dtype([("x", "<f8"), ("y", "<f8"), ("z", "<f8"), ("distance", "<f4"),
                         ("red", "u1"), ("green", "u1"), ("blue", "u1")])
        drawn = np.frombuffer(re.split(rb"end_header\n", ply, maxsplit=1)[1], kind)
        np.testing.assert_array_equal(drawn["blue"], rows["blue"])


if __name__ == "__main__":
    unittest.main()
