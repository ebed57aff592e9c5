"""The programs of docs/python.md and python/examples run as they are written."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from shapes import run_command

SOURCES = pathlib.Path(os.environ["PLANETREE_SOURCE_DIR"])


class Documents(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        run_command("generate", cls.folder / "scan.ply", "--triangles", 20_000)

    def run_python(self, *arguments):
        done = subprocess.run(
            [sys.executable, *map(str, arguments)], cwd=self.folder, text=True, capture_output=True
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_1_quick_start(self):
        text = (SOURCES / "docs" / "python.md").read_text()
        programs = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        self.assertEqual(len(programs), 1)
        told = self.run_python("-c", programs[0])
        self.assertLess(float(told.split()[0]), 0)
        self.assertTrue((self.folder / "scan.ptree").exists())

    def test_2_examples(self):
        examples = SOURCES / "python" / "examples"
        model = self.folder / "scan.ptree"
        told = self.run_python(examples / "deviation.py", model)
        self.assertRegex(told, r"100,000 points\n.*\n.*certainly between")
        told = self.run_python(examples / "inside_grid.py", model, 32)
        self.assertRegex(told, r"[1-9][\d,]* of 32,768 cells are inside")
        self.assertIn("####", told)
        told = self.run_python(examples / "haptic_path.py", model, 300)
        self.assertRegex(told, r"\d+ of \d+ ticks exact")
        self.assertEqual(len(list(examples.glob("*.py"))), 3)


if __name__ == "__main__":
    unittest.main()
