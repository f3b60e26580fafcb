"""What the Python module promises. Run with `python -m unittest discover crates/python/tests` where `stribeck` is installed."""

import json
import os
import signal
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np

import stribeck

QUICK = {"mesh": {"size_mm": 4.0}, "contact.method": "collocated"}


class Runs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.told = []
        cls.run_ = stribeck.run(
            QUICK,
            duration_ms=0.3,
            out=Path(cls.folder.name) / "run",
            progress=lambda phase, share, time_s: cls.told.append((phase, share)),
        )

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_channels_are_those_of_the_file(self):
        table = np.load(self.run_.folder / "trace.npy")
        self.assertEqual(self.run_.channels, list(table.dtype.names))
        for name in self.run_.channels:
            np.testing.assert_array_equal(self.run_[name], table[name])
        self.assertEqual(self.run_.rate_hz, 100_000.0)

    def test_the_summary_is_that_of_the_report(self):
        page = self.run_.report()
        self.assertTrue(page.read_text().startswith("<!DOCTYPE html>"))
        written = json.loads((self.run_.folder / "summary.json").read_text())
        self.assertEqual(self.run_.summary["load"], written["load"])
        self.assertEqual(self.run_.info["status"], "complete")

    def test_a_run_goes_on_to_the_bytes_of_a_long_one(self):
        long = stribeck.run(QUICK, duration_ms=0.5, out=Path(self.folder.name) / "long")
        short = stribeck.run(QUICK, duration_ms=0.4, out=Path(self.folder.name) / "short").resume(0.5)
        self.assertEqual((long.folder / "trace.npy").read_bytes(), (short.folder / "trace.npy").read_bytes())

    def test_a_wrong_field_is_a_value_error_that_helps(self):
        with self.assertRaisesRegex(ValueError, "load_n"):
            stribeck.run({"operation": {"laod_n": 3}})
        with self.assertRaisesRegex(KeyError, "did you mean time_s"):
            self.run_["time"]
        with self.assertRaises(FileNotFoundError):
            stribeck.load(self.folder.name)

    def test_ctrl_c_keeps_what_was_computed(self):
        out = Path(self.folder.name) / "interrupted"
        main = threading.main_thread().ident
        pressed = []
        # A shell that starts this in the background has it ignore Ctrl-C.
        signal.signal(signal.SIGINT, signal.default_int_handler)

        def press(phase, share, time_s):
            if phase == "run" and time_s > 0 and not pressed:
                pressed.append(True)
                signal.pthread_kill(main, signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            stribeck.run(QUICK, duration_ms=2000.0, out=out, progress=press)
        run = stribeck.load(out)
        self.assertEqual(run.info["status"], "interrupted")
        self.assertGreater(len(run["time_s"]), 0)

    def test_a_progress_that_fails_ends_the_run_with_its_error(self):
        def fail(phase, share, time_s):
            raise ZeroDivisionError("on purpose")

        with self.assertRaisesRegex(ZeroDivisionError, "on purpose"):
            stribeck.run(QUICK, duration_ms=2000.0, out=Path(self.folder.name) / "failed", progress=fail)

    def test_a_frame_is_indexed_by_time(self):
        frame = self.run_.frame()
        np.testing.assert_array_equal(frame.index, self.run_["time_s"])
        self.assertEqual(len(frame.columns) + 1, len(self.run_.channels))

    def test_the_ledger_is_that_of_the_file(self):
        table = np.load(self.run_.folder / "energy.npy")
        self.assertEqual(list(self.run_.energy), list(table.dtype.names))
        self.assertGreater(self.run_.energy["strain_j"].max(), 0)
        np.testing.assert_array_equal(self.run_.energy["strain_j"], table["strain_j"])

    def test_a_run_is_exported(self):
        path = self.run_.export("npz", channels=["sensor."])
        with np.load(path) as written:
            self.assertTrue(any(name.startswith("sensor.side") for name in written.files), written.files)
        with self.assertRaisesRegex(RuntimeError, "ended with"):
            self.run_.export("docx")

    def test_a_campaign_is_its_tables(self):
        quick = Path(__file__).parents[3] / "fixtures" / "scenes" / "quick.ron"
        file = Path(self.folder.name) / "two.ron"
        file.write_text(
            f"""(name: "two", scene: {json.dumps(str(quick))}, set: ["mesh.size_mm=4.0", "mesh.roller_facets=40",
            "solver.start=sudden", "solver.duration_ms=0.3", "output.frames=None"],
            variants: grid([(field: "operation.load_n", values: [10000, 20000])]))"""
        )
        data = stribeck.campaign(file, out=Path(self.folder.name) / "two", threads=1)
        self.assertTrue((data.folder / "events.parquet").exists())
        try:
            import pandas, pyarrow  # noqa: F401
        except ImportError:
            return
        self.assertEqual(data.runs.load_n.tolist(), [10e3, 20e3])
        self.assertTrue(set(data.events.run) <= {1, 2})

    def test_commands_of_the_program(self):
        self.assertEqual(stribeck.command("report", self.run_.folder), 0)
        self.assertNotEqual(stribeck.command("simulate", "nowhere.ron"), 0)


class Scenes(unittest.TestCase):
    def test_scenes_are_written_out(self):
        self.assertIn("load_n: 30000", stribeck.scene({"operation.load_n": 30e3}))

    def test_fields_as_dicts_are_those_of_scene_files(self):
        for fields, overrides in [
            ({"operation": {"load_n": 30e3, "speed_rpm": -500}}, ["operation.load_n=30000.0", "operation.speed_rpm=-500"]),
            ({"output": {"sensors": [{"name": "side", "angle_deg": 0}]}}, ['output.sensors=[(name: "side", angle_deg: 0)]']),
            ({"model": {"reduced": {"modes_khz": 30}}}, ["model=reduced(modes_khz: 30)"]),
            ({"model": "full"}, ["model=full"]),
            (
                {"defects": [{"on": "outer", "form": {"spall": {"length_mm": 4, "depth_mm": 0.05}}}]},
                ["defects=[(on: outer, form: spall(length_mm: 4, depth_mm: 0.05))]"],
            ),
            (
                {"defects": [{"on": {"roller": 3}, "form": "missing"}]},
                ["defects=[(on: roller(3), form: missing)]"],
            ),
            (
                {"defects": [{"form": {"profile": {"points": [{"at_mm": -1, "depth_um": 0}, {"at_mm": 0, "depth_um": 5}, {"at_mm": 1, "depth_um": 0}]}}}]},
                ["defects=[(form: profile(points: [(at_mm: -1, depth_um: 0), (at_mm: 0, depth_um: 5), (at_mm: 1, depth_um: 0)]))]"],
            ),
            (
                {"operation": {"speed_profile": {"points": [(0, 500.0), [20.5, 100]]}}},
                ["operation.speed_profile=points([(0, 500.0), (20.5, 100)])"],
            ),
            ({"housing": {"springs": {"stiffness_n_um": 500}}}, ["housing=springs(stiffness_n_um: 500)"]),
            ({"cage": None, "mesh": {"outer_facets": np.int64(400)}}, ["cage=None", "mesh.outer_facets=400"]),
        ]:
            self.assertEqual(stribeck._ron.overrides(fields), overrides)
            stribeck.scene({"film": None, "defect": None, **fields})
        whole = stribeck.scene({"film": None, "defects": [{"on": "inner", "form": {"dent": {"depth_mm": 0.02}}}]})
        self.assertRegex(whole, r"on: inner,\s+angle_deg: 90.0,\s+form: dent\(")

    def test_what_no_scene_can_hold_is_said(self):
        with self.assertRaisesRegex(ValueError, "load_n is nan"):
            stribeck.scene({"operation": {"load_n": float("nan")}})
        with self.assertRaisesRegex(ValueError, "load_n is a set"):
            stribeck.scene({"operation": {"load_n": {1}}})
        with self.assertRaisesRegex(ValueError, "form"):
            stribeck.scene({"film": None, "defects": [{"form": {"spal": {}}}]})


class Signals(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(1)
        self.fs = 12_000.0
        self.x = random.normal(size=60_000)

    def test_welch_is_scipys(self):
        from scipy.signal import welch

        for options in ({}, {"nperseg": 1000, "scaling": "spectrum"}, {"nfft": 512, "average": "median"}):
            f, p = stribeck.dsp.welch(self.x, self.fs, **options)
            g, q = welch(self.x, self.fs, **options)
            np.testing.assert_allclose(f, g, rtol=1e-12)
            np.testing.assert_allclose(p, q, rtol=1e-10)

    def test_the_notch_is_scipys(self):
        from scipy.signal import filtfilt, iirnotch, lfilter

        b, a = iirnotch(4671.0 / 2, 15.0, self.fs)
        np.testing.assert_allclose(stribeck.dsp.notch(self.x, self.fs, 4671.0 / 2), lfilter(b, a, self.x), atol=1e-10)
        both = stribeck.dsp.notch(self.x, self.fs, 4671.0 / 2, zero_phase=True)
        # The ends are padded in another way.
        np.testing.assert_allclose(both[2000:-2000], filtfilt(b, a, self.x)[2000:-2000], atol=1e-8)

    def test_knocks_are_found_and_called_what_they_are(self):
        shaft_hz, order = 25.0, 3.585
        at = np.arange(0, len(self.x) / self.fs, 1 / (order * shaft_hz))
        x = 0.2 * self.x
        ring = np.exp(-np.arange(120) / 20) * np.sin(2 * np.pi * 3000 / self.fs * np.arange(120))
        for n in (at * self.fs).astype(int):
            x[n : n + 120] += 3 * ring[: len(x) - n]
        found = stribeck.analyse(x, self.fs, bearing="6205", speed_rpm=60 * shaft_hz)
        claimed = [f["name"] for f in found["families"] if f["claimed"]]
        self.assertEqual(claimed, ["BPFO"])
        low, high, kurtosis = max(stribeck.dsp.fast_kurtogram(x, self.fs), key=lambda band: band[2])
        self.assertTrue(low < 3000 < high and kurtosis > 1, (low, high, kurtosis))
        f, spectrum = stribeck.dsp.envelope_spectrum(x, self.fs, (2000.0, 4000.0))
        near = (f > 40) & (f < 130)
        self.assertAlmostEqual(f[near][np.argmax(spectrum[near])], order * shaft_hz, delta=0.5)

    def test_a_wrong_shape_or_word_is_said(self):
        with self.assertRaisesRegex(ValueError, "one dimension"):
            stribeck.dsp.welch(np.zeros((3, 3)))
        with self.assertRaisesRegex(ValueError, "known are hann, boxcar"):
            stribeck.dsp.welch(self.x, window="han")

    def test_help_reads_well(self):
        for thing in map(stribeck.__dict__.get, stribeck.__all__):
            self.assertGreater(len(thing.__doc__ or ""), 40, thing)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    unittest.main()
