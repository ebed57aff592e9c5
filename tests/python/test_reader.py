"""The reader of format-spec/, which is written from the specification alone, against the engine."""

import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import planetree

SOURCE = pathlib.Path(os.environ["PLANETREE_SOURCE_DIR"])
FOLDER = SOURCE / "format-spec"
SAMPLES = sorted((SOURCE / "format-spec" / "v1" / "samples").glob("*.ptree"))
SIDES = {"inside": 1, "on the surface": 1, "outside": 0, "unknown": 255}


sys.path.insert(0, str(FOLDER))
import checker  # noqa: E402
import reader  # noqa: E402


def engine_codes(path):
    run = subprocess.run(
        [os.environ["PLANETREE_COMMAND"], "verify", "--full", "--json", path],
        capture_output=True,
        text=True,
    )
    return {issue["code"] for issue in json.loads(run.stdout)["issues"]}


class Reader(unittest.TestCase):
    def test_is_short(self):
        for name, most in ("reader.py", 1000), ("checker.py", 600):
            self.assertLess(len((FOLDER / name).read_text().splitlines()), most)

    def test_finds_no_issue_in_the_samples(self):
        self.assertGreater(len(SAMPLES), 5)
        for path in SAMPLES:
            with self.subTest(path.name):
                self.assertEqual(checker.verify(str(path), True), [])

    def test_tells_what_the_engine_tells(self):
        for path in SAMPLES:
            told = reader.describe(reader.File(str(path)))
            with self.subTest(path.name), planetree.open(path) as model:
                self.assertEqual(told["metadata"], model.metadata)
                header, info = told["header"], model.info
                self.assertEqual(header["triangle_count"], info["triangles"])
                self.assertEqual(told["watertight"], info["watertight"])
                self.assertEqual(sum(told["pages"].values()), info["pages"])
                box = [header["box_lower"], header["box_upper"]]
                np.testing.assert_array_equal(box, info["box"])

    def test_finds_the_nearest_points_of_the_engine(self):
        exact = 0
        for path in SAMPLES:
            file = reader.File(str(path))
            with self.subTest(path.name), planetree.open(path) as model:
                for point in points_about(model, 12):
                    found, own = model.closest_points(point), file.nearest(tuple(point))
                    if found.status == planetree.Status.EXACT:  # not beyond a wall of a region
                        self.assertAlmostEqual(own["distance"], float(found.distance), places=9)
                        exact += 1
        self.assertGreater(exact, 60)

    def test_finds_the_sides_of_the_engine(self):
        for path in SAMPLES:
            file = reader.File(str(path))
            with self.subTest(path.name), planetree.open(path) as model:
                for point in points_about(model, 12):
                    own = file.side(tuple(point))
                    self.assertEqual(SIDES[own], int(model.contains(point)), point)

    def test_finds_the_damage_that_the_engine_finds(self):
        draw = random.Random(5)
        with tempfile.TemporaryDirectory() as folder:
            damaged = os.path.join(folder, "damaged.ptree")
            for path in SAMPLES:
                whole = path.read_bytes()
                # All parts of the file: headers, directory, extensions, pages, and the end.
                places = [12, 40, 130, 1020, 1024, 1030, len(whole) - 1030, len(whole) - 1]
                for place in places + [draw.randrange(1024, len(whole) - 1024) for _ in range(8)]:
                    changed = bytearray(whole)
                    changed[place] ^= 16
                    pathlib.Path(damaged).write_bytes(changed)
                    own = {issue.code for issue in checker.verify(damaged, True)}
                    self.assertEqual(own, engine_codes(damaged), (path.name, place))
                for length in (0, 100, 1024, 2000, len(whole) - 1):
                    pathlib.Path(damaged).write_bytes(whole[:length])
                    own = {issue.code for issue in checker.verify(damaged, True)}
                    self.assertTrue(own & engine_codes(damaged), (path.name, length))


def points_about(model, count):
    lower, upper = model.info["box"]
    reach = float(np.max(upper - lower))
    draw = np.random.default_rng(3)
    return draw.uniform(lower - 0.2 * reach, upper + 0.2 * reach, (count, 3))


if __name__ == "__main__":
    unittest.main()
