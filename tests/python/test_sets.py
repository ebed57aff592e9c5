"""Models as sets of files."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import planetree
from shapes import sphere

READER = pathlib.Path(os.environ["PLANETREE_SOURCE_DIR"]) / "format-spec/reader.py"


class Sets(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls._folder.cleanup)
        cls.folder = pathlib.Path(cls._folder.name)
        mesh = sphere(100)
        planetree.build(mesh, cls.folder / "one.ptree")
        planetree.build(mesh, cls.folder / "set.ptreeset", member_size="64K")
        cls.points = np.random.default_rng(3).uniform(-1.5, 1.5, (2000, 3))

    def members(self):
        return json.loads((self.folder / "set.ptreeset").read_text())["members"]

    def test_are_the_file_in_parts(self):
        self.assertGreater(len(self.members()), 4)
        joined = b"".join((self.folder / m["address"]).read_bytes() for m in self.members())
        self.assertTrue(joined == (self.folder / "one.ptree").read_bytes())

    def test_answer_as_the_file(self):
        with planetree.open(self.folder / "one.ptree") as one:
            with planetree.open(self.folder / "set.ptreeset") as several:
                self.assertTrue(
                    np.array_equal(several.signed_distance(self.points), one.signed_distance(self.points))
                )
                self.assertEqual(several.stats["http_requests"], 0)

    def test_may_lack_members_if_told_so(self):
        missing = self.folder / self.members()[3]["address"]
        kept = missing.read_bytes()
        missing.unlink()
        try:
            with self.assertRaisesRegex(planetree.Error, missing.name):
                planetree.open(self.folder / "set.ptreeset")
            with planetree.open(self.folder / "set.ptreeset", allow_missing_members=True) as model:
                status = model.closest_points(self.points).status
        finally:
            missing.write_bytes(kept)
        self.assertIn(int(planetree.Status.EXACT), status)
        self.assertIn(int(planetree.Status.DEGRADED), status)

    def test_are_read_by_the_reader_of_the_specification(self):
        points = self.folder / "points.json"
        points.write_text(json.dumps({"nearest": [[0.1, 0.2, 1.4]], "side": [[0.1, 0.2, 0.3]]}))
        told = []
        for name in ("one.ptree", "set.ptreeset"):
            run = subprocess.run(
                [sys.executable, READER, self.folder / name, "--answers", points],
                capture_output=True,
                text=True,
                check=True,
            )
            told.append(json.loads(run.stdout))
        self.assertEqual(told[0], told[1])
        self.assertEqual(told[0]["side"], ["inside"])


if __name__ == "__main__":
    unittest.main()
