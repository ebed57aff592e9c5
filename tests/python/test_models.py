"""Opening, closing, sharing and interrupting models; errors."""

import multiprocessing
import pathlib
import signal
import threading
import time
import unittest

import numpy as np

import planetree
from model_test_case import Alarm, ModelTestCase, alarm_soon
from planetree import ErrorCode, _planetree


def distance_in_child(model, pipe):
    try:
        pipe.send(float(model.distance([0, 0, 2])))
    except RuntimeError as error:
        pipe.send(str(error))


class Models(ModelTestCase):
    def test_tell_what_they_are(self):
        info = self.model.info
        self.assertEqual(info["triangles"], len(self.faces))
        self.assertTrue(info["watertight"])
        np.testing.assert_allclose(info["box"], [self.vertices.min(0), self.vertices.max(0)])
        self.assertIn("watertight", repr(self.model))
        self.model.distance(self.points(10))
        self.assertGreater(self.model.stats["pages_read"], 0)

    def test_say_what_the_file_says_of_them(self):
        path = self.folder / "told.ptree"
        planetree.build(
            (self.vertices, self.faces), path, metadata={"unit": "mm", "title": "K\u00f6nig"}
        )
        with planetree.open(path) as model:
            told = model.metadata
        self.assertEqual(told.pop("generator").split()[0], "planetree")
        self.assertEqual(told, {"unit": "mm", "title": "K\u00f6nig"})
        with self.assertRaises(planetree.Error):
            planetree.build((self.vertices, self.faces), path, metadata={"Unit": "mm"}, replace=True)

    def test_close(self):
        with planetree.open(self.path) as model:
            model.distance([0, 0, 0])
        with self.assertRaisesRegex(ValueError, "closed"):
            model.distance([0, 0, 0])
        model.close()
        self.assertIn("closed", repr(model))

    def test_outlive_their_closing_in_probes(self):
        model = planetree.open(self.path)
        probe = model.probe()
        model.close()
        self.assertGreater(probe.closest_point((0, 0, 2)).distance, 0.9)

    def test_errors_have_a_kind_and_name_the_file(self):
        with self.assertRaisesRegex(planetree.Error, "/no/such") as caught:
            planetree.open("/no/such.ptree")
        self.assertEqual(caught.exception.code, ErrorCode.NOT_FOUND)
        self.assertIsNone(caught.exception.page)
        text = self.folder / "text.ptree"
        text.write_text("no model\n" * 10_000)
        with self.assertRaises(planetree.Error) as caught:
            planetree.open(text)
        self.assertEqual(caught.exception.code, ErrorCode.NOT_PLANETREE)
        with self.assertRaises(planetree.Error) as caught:
            planetree.open(self.path, memory=1)
        self.assertEqual(caught.exception.code, ErrorCode.NO_MEMORY)

    def test_sizes(self):
        for size in ("64M", 64 << 20, "0.0625G", "65536k", "64 MiB"):
            with planetree.open(self.path, memory=size) as model:
                self.assertEqual(model.stats["budget_bytes"], 64 << 20)
        for size in ("many", "64X", -1, 1.5):
            with self.assertRaises(ValueError):
                planetree.open(self.path, memory=size)

    def test_enumerations_have_the_values_of_the_library(self):
        for name, values in _planetree.enum_values.items():
            ours = {member.name: int(member) for member in getattr(planetree, name)}
            ours.pop("ALL", None)
            self.assertEqual(ours, values, name)
        self.assertEqual(planetree.NO_TRIANGLE, _planetree.no_triangle)

    def test_queries_release_the_lock(self):
        """A Python thread runs in the middle of a query of another one."""
        points = self.points(400_000)
        times, stop = [], threading.Event()

        def note_times():
            while not stop.is_set():
                times.append(time.monotonic())
                time.sleep(0.001)

        thread = threading.Thread(target=note_times)
        thread.start()
        try:
            start = time.monotonic()
            self.model.closest_points(points)
            end = time.monotonic()
        finally:
            stop.set()
            thread.join()
        quarter = (end - start) / 4
        self.assertTrue([at for at in times if start + quarter < at < end - quarter])

    def test_more_calls_than_probes_wait_for_each_other(self):
        with planetree.open(self.path, max_probes=1) as model:
            points = self.points(3000)
            expected = self.model.distance(points)
            results = [None] * 4

            def ask(i):
                results[i] = model.distance(points)

            threads = [threading.Thread(target=ask, args=(i,)) for i in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            for result in results:
                np.testing.assert_array_equal(result, expected)

    def test_progress_is_told_and_may_stop_the_call(self):
        points = self.points(300_000)
        told = []
        self.model.distance(points, progress=lambda done, count: told.append((done, count)))
        self.assertEqual(told[-1], (300_000, 300_000))
        self.assertEqual(told, sorted(told))

        def stop(done, count):
            raise KeyError("enough")

        with self.assertRaisesRegex(KeyError, "enough"):
            self.model.distance(points, progress=stop)

    def test_control_c_interrupts_a_call(self):
        points = self.points(1_000_000)
        told = []

        def interrupt(done, count):
            told.append(done)
            signal.raise_signal(signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            self.model.distance(points, progress=interrupt)
        self.assertLess(told[-1], len(points))

    def test_signals_end_a_call_that_runs_no_python(self):
        points = self.points(3_000_000)
        out = {"distance": np.full(len(points), -1.0)}
        with self.assertRaises(Alarm), alarm_soon(0.1):
            self.model.closest_points(points, out=out)
        self.assertEqual(out["distance"][-1], -1)

    def test_a_forked_process_is_told_to_open_its_own(self):
        context = multiprocessing.get_context("fork")
        ours, theirs = context.Pipe()
        child = context.Process(target=distance_in_child, args=(self.model, theirs))
        child.start()
        self.assertIn("fork()", ours.recv())
        child.join()
        self.assertEqual(child.exitcode, 0)

    def test_calls_take_little_memory(self):
        """A call keeps to 64 MB beside the model and the arrays, however many points it has."""
        points = self.points(2_000_000)
        out = {"distance": np.empty(len(points))}
        self.model.closest_points(points[:1000], fields="distance")

        def peak_kib():
            status = pathlib.Path("/proc/self/status").read_text()
            return int(status.split("VmHWM:")[1].split()[0])

        pathlib.Path("/proc/self/clear_refs").write_text("5")  # the peak starts anew
        before = peak_kib()
        self.model.closest_points(points, out=out)
        out["distance"][:] = out["distance"]
        self.assertLess(peak_kib() - before, (64 << 20 >> 10) + out["distance"].nbytes // 1024)
        self.assertGreater(peak_kib() - before, out["distance"].nbytes // 1024)


if __name__ == "__main__":
    unittest.main()
