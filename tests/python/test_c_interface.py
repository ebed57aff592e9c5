"""The shared library by ctypes, as other languages load it."""

import ctypes
import os
import unittest

from model_test_case import ModelTestCase

LIBRARY = os.environ.get("PLANETREE_SHARED_LIBRARY", "")


class ClosestPoint(ctypes.Structure):
    _fields_ = [
        ("distance", ctypes.c_double),
        ("lower", ctypes.c_double),
        ("upper", ctypes.c_double),
        ("side", ctypes.c_uint8),
        ("point", ctypes.c_double * 3),
        ("normal", ctypes.c_double * 3),
        ("triangle", ctypes.c_uint64),
        ("barycentric", ctypes.c_double * 3),
        ("feature", ctypes.c_uint8),
        ("status", ctypes.c_uint8),
    ]


class Error(ctypes.Structure):
    _fields_ = [
        ("code", ctypes.c_uint32),
        ("page", ctypes.c_uint64),
        ("offset", ctypes.c_uint64),
        ("text", ctypes.c_char * 192),
    ]


@unittest.skipUnless(LIBRARY, "the shared library is not built")
class CInterface(ModelTestCase):
    def test_answers_as_the_package_does(self):
        library = ctypes.CDLL(LIBRARY)
        library.planetree_find_closest_points.restype = None
        model, probe, error = ctypes.c_void_p(), ctypes.c_void_p(), Error()
        path = os.fspath(self.path).encode()
        self.assertEqual(
            library.planetree_open(path, None, ctypes.byref(model), ctypes.byref(error)), 0
        )
        self.assertEqual(
            library.planetree_create_probe(model, ctypes.byref(probe), ctypes.byref(error)), 0
        )
        points = self.points(100)
        answers = (ClosestPoint * len(points))()
        library.planetree_find_closest_points(
            probe,
            points.ctypes.data_as(ctypes.c_void_p),
            ctypes.c_size_t(len(points)),
            None,
            answers,
        )
        found = self.model.closest_points(points)
        for i, answer in enumerate(answers):
            self.assertEqual(answer.distance, found.distance[i])
            self.assertEqual(answer.triangle, found.triangles[i])
            self.assertEqual(answer.side, found.side[i])
            self.assertEqual(list(answer.point), found.points[i].tolist())
            self.assertEqual(list(answer.normal), found.normals[i].tolist())
        library.planetree_destroy_probe(probe)
        library.planetree_close(model)

    def test_tells_errors(self):
        library = ctypes.CDLL(LIBRARY)
        model, error = ctypes.c_void_p(), Error()
        code = library.planetree_open(b"/no/such", None, ctypes.byref(model), ctypes.byref(error))
        self.assertEqual((code, error.code, model.value), (2, 2, None))
        self.assertIn(b"No such file", error.text)


if __name__ == "__main__":
    unittest.main()
