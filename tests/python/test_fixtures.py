"""The fixtures of format-spec/: the engine, reader.py and checker.py give the codes and answers that
they state, and the engine and checker.py say the same of changed fixtures."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tarfile
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import planetree

SOURCE = pathlib.Path(os.environ["PLANETREE_SOURCE_DIR"]) / "format-spec"
FOLDER = SOURCE / "fixtures"
COMMAND = os.environ["PLANETREE_COMMAND"]
SIDES = {"inside": 1, "on the surface": 1, "outside": 0, "unknown": 255}
# The first concerns the system and not the file, the second several files.
NO_FIXTURE = {"PAGE_READ", "SET"}


sys.path[:0] = [str(SOURCE), str(FOLDER)]
import checker  # noqa: E402
import mutate  # noqa: E402
import reader  # noqa: E402
from parts import in_order  # noqa: E402


def engine_codes(path):
    run = subprocess.run(
        [COMMAND, "verify", "--full", "--json", "--quiet", path],
        capture_output=True,
        text=True,
    )
    return in_order(json.loads(run.stdout)["issues"])


class Fixtures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        with tarfile.open(FOLDER / "invalid.tar.xz") as archive:
            archive.extractall(cls.folder)
        fixtures = json.loads((FOLDER / "fixtures.json").read_text(encoding="utf-8"))
        cls.valid = {FOLDER / x["file"]: x for x in fixtures if "answers" in x}
        cls.invalid = {cls.folder / x["file"]: x for x in fixtures if "codes" in x}
        assert len(cls.valid) + len(cls.invalid) == len(fixtures)

    def test_lists_every_file(self):
        self.assertEqual(set(self.valid), set((FOLDER / "valid").iterdir()))
        self.assertEqual(set(self.invalid), set((self.folder / "invalid").iterdir()))

    def test_shows_every_code(self):
        text = (SOURCE / "ISSUES.md").read_text(encoding="utf-8")
        codes = set(re.findall(r"^\| `([A-Z_]+)` \|", text, re.MULTILINE))
        shown = {code for x in self.invalid.values() for code in x["codes"]}
        self.assertEqual(codes - shown, NO_FIXTURE)
        self.assertEqual(shown - codes, set())

    def test_has_the_codes_of_the_engine(self):
        paths = [*self.valid, *self.invalid]
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for path, codes in zip(paths, pool.map(engine_codes, paths)):
                with self.subTest(path.name):
                    expected = self.invalid[path]["codes"] if path in self.invalid else []
                    self.assertEqual(codes, expected)

    def test_has_the_codes_of_the_checker(self):
        with np.errstate(all="ignore"):
            for path in [*self.valid, *self.invalid]:
                with self.subTest(path.name):
                    expected = self.invalid[path]["codes"] if path in self.invalid else []
                    self.assertEqual(in_order(checker.verify(str(path), True)), expected)

    def test_changed_files_have_the_same_first_code_by_engine_and_checker(self):
        valid = invalid = 0
        with np.errstate(all="ignore"):
            for what, codes, own in mutate.compare(COMMAND, 300, 20):
                self.assertEqual(codes[:1], own[:1], f"{what}: {codes}, {own}")
                valid, invalid = valid + (not codes), invalid + bool(codes)
        self.assertGreater(valid, 20)
        self.assertGreater(invalid, 200)

    def test_has_the_answers_of_the_reader(self):
        for path, fixture in self.valid.items():
            file, answers = reader.File(str(path)), fixture["answers"]
            with self.subTest(path.name):
                self.assertEqual(file.metadata(), answers["metadata"])
                for x in answers["nearest"]:
                    found = file.nearest(x["point"])["distance"]
                    self.assertAlmostEqual(found, x["distance"], delta=1e-12 * (1 + found))
                for x in answers["side"]:
                    self.assertEqual(file.side(x["point"]), x["side"], x["point"])
                for x in answers["triangles"]:
                    found = json.loads(json.dumps(file.triangle(x["index"])))
                    self.assertEqual(found, x)

    def test_has_the_answers_of_the_engine(self):
        for path, fixture in self.valid.items():
            answers, header = fixture["answers"], reader.File(str(path)).header
            with self.subTest(path.name), planetree.open(path) as model:
                self.assertEqual(model.metadata, answers["metadata"])
                for x in answers["nearest"]:
                    found = float(model.closest_points(x["point"]).distance)
                    self.assertAlmostEqual(found, x["distance"], delta=1e-9 * (1 + found))
                if not header.without_sides:  # an engine need not know sides there (1.3)
                    for x in answers["side"]:
                        self.assertEqual(int(model.contains(x["point"])), SIDES[x["side"]])
                for x in answers["triangles"] if header.attributes else []:
                    if x["corners"] is None:  # the engine tells nothing of skipped records
                        with self.assertRaises(planetree.Error):
                            model.triangles(np.array([x["index"]]))
                        continue
                    found = model.triangles(np.array([x["index"]]))
                    np.testing.assert_array_equal(found.corners[0], x["corners"])
                    if "colours" in x:
                        np.testing.assert_array_equal(np.ravel(found.colors[0]), x["colours"])
                    if "uvs" in x:
                        np.testing.assert_array_equal(np.ravel(found.uvs[0]), x["uvs"])
                    if "value" in x:
                        self.assertEqual(found.values[0], x["value"])

    @unittest.skipUnless("PLANETREE_MAKE_FIXTURES" in os.environ, "takes a minute")
    def test_can_be_made_again(self):
        again = self.folder / "again"
        subprocess.run([sys.executable, "-B", FOLDER / "make.py", COMMAND, again], check=True)
        for path in self.valid:
            self.assertEqual(path.read_bytes(), (again / "valid" / path.name).read_bytes(), path)
        with tarfile.open(again / "invalid.tar.xz") as archive:
            archive.extractall(again)
        for path in self.invalid:
            made = again / "invalid" / path.name
            self.assertEqual(path.read_bytes(), made.read_bytes(), path)
        text = (again / "fixtures.json").read_text(encoding="utf-8")
        self.assertEqual((FOLDER / "fixtures.json").read_text(encoding="utf-8"), text)


if __name__ == "__main__":
    unittest.main()
