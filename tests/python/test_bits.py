"""A million answers have the bits of the command, which calls the C++ library."""

import pathlib
import tempfile
import unittest

import numpy as np

import planetree
from planetree import Side
from shapes import run_command


class Bits(unittest.TestCase):
    def test_are_those_of_the_command(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        place = pathlib.Path(folder.name)
        run_command("generate", place / "statue.ply", "--triangles", 50_000)
        run_command("build", place / "statue.ply", "-o", place / "statue.ptree")
        with planetree.open(place / "statue.ptree", threads=2) as model:
            low, high = model.info["box"]
            points = np.random.default_rng(3).uniform(low, high, (1_000_000, 3))
            points.tofile(place / "points.f64")
            fields = ("distance", "lower", "upper", "side", "points", "normals", "triangles")
            found = model.closest_points(points, fields=fields)
        run_command("query", place / "statue.ptree", place / "points.f64", "--format", "f64",
                    "-o", place / "answers.f64")
        rows = np.fromfile(place / "answers.f64").reshape(-1, 14)
        sides = np.full(4, np.nan)
        sides[[Side.INSIDE, Side.OUTSIDE, Side.ON_SURFACE]] = -1, 1, 0
        ours = np.column_stack([
            points, found.distance, found.lower, found.upper, sides[found.side], found.points,
            found.normals, found.triangles.astype(np.float64),
        ])
        self.assertEqual(ours.tobytes(), rows.tobytes())


if __name__ == "__main__":
    unittest.main()
