"""A test case with a model of a sphere."""

import contextlib
import pathlib
import signal
import tempfile
import unittest

import numpy as np

import planetree
from shapes import sphere


class Alarm(Exception):
    """What the signal of alarm_soon() raises."""


@contextlib.contextmanager
def alarm_soon(seconds):
    """Sends a signal to this process, whose handler raises Alarm, as that of Ctrl-C does."""

    def ring(*_):
        raise Alarm

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


class ModelTestCase(unittest.TestCase):
    """Builds a sphere once, and opens it for each test."""

    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._folder.name)
        cls.path = cls.folder / "sphere.ptree"
        cls.vertices, cls.faces = sphere()
        planetree.build((cls.vertices, cls.faces), cls.path)
        cls.addClassCleanup(cls._folder.cleanup)

    def setUp(self):
        self.model = planetree.open(self.path)
        self.addCleanup(self.model.close)
        self.random = np.random.default_rng(7)

    def points(self, *shape):
        """Random points around the sphere."""
        return self.random.uniform(-1.5, 1.5, (*shape, 3))
