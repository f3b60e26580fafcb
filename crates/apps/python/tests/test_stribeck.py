"""What the Python module promises. Run with `python -m unittest discover crates/apps/python/tests` where `stribeck` is installed."""

import importlib.util
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np

import stribeck
import stribeck.learn

QUICK = {"mesh": {"size_mm": 4.0}, "contact.method": "collocated"}


class Learning(unittest.TestCase):
    """Windows, splits by bearing, background, scores."""

    @staticmethod
    def records(kinds, seed=0, rate=12_800.0):
        rng = np.random.default_rng(seed)
        orders = stribeck.defect_orders("6205")
        combs = {"outer": orders["bpfo"], "inner": orders["bpfi"], "ball": 2 * orders["bsf"]}
        for n, kind in enumerate(kinds):
            speed = rng.uniform(900, 1800)
            time = np.arange(int(2 * rate)) / rate
            signal = rng.normal(size=len(time))
            if kind != "sound":
                since = np.mod(time, 60 / (combs[kind] * speed))
                signal += 6 * np.exp(-since / 1e-3) * np.sin(2 * np.pi * rng.uniform(1500, 5000) * since)
            yield signal, rate, speed, kind, f"{kind} {n}"

    def test_families_stand_in_the_features_of_their_class(self):
        windows = stribeck.learn.Windows.of(self.records(["sound", "outer", "inner", "ball"] * 2), bearing="6205")
        self.assertEqual(windows.features.shape, (len(windows), 4))
        for n, row in zip(windows.labels, windows.features):
            if n > 0:
                self.assertEqual(np.argmax(row[:3]), n - 1, row)
        features, label = windows[0]
        self.assertEqual((features.dtype, label), (np.float32, 0))

    def test_a_bearing_is_in_one_part_of_a_split(self):
        names = [f"b{n // 4}" for n in range(48)]
        seen = []
        for train, test in stribeck.learn.by_bearing(names, [n // 4 % 4 for n in range(48)]):
            self.assertFalse({names[n] for n in train} & {names[n] for n in test})
            seen += list(test)
        self.assertEqual(sorted(seen), list(range(48)))
        with self.assertRaisesRegex(ValueError, "folds"):
            next(stribeck.learn.by_bearing(["a", "a"], folds=2))

    def test_a_leak_is_named(self):
        rng = np.random.default_rng(3)
        record = rng.normal(size=4000)
        cut = lambda start: record[start : start + 1000]
        train = [cut(0), cut(1000)]
        self.assertEqual(stribeck.learn.leaks(train, [cut(2000), cut(3000)], ["a", "a"], ["b", "b"]), [])
        # By 50 samples at either end, or all of it; of two channels that are off nothing is shared.
        for start in (1950, 1000, 537):
            self.assertIn("1 of 2 windows", stribeck.learn.leaks(train, [cut(start), cut(3000)])[0], start)
        self.assertIn("1 of 1", stribeck.learn.leaks([cut(1000)], [cut(50)])[0])
        self.assertEqual(stribeck.learn.leaks([np.zeros(500)], [np.zeros(500)]), [])
        self.assertIn("2 bearings stand on both sides", stribeck.learn.leaks([], [], ["a", "b", "c"], ["b", "c"])[0])
        windows = stribeck.learn.Windows.of(self.records(["outer", "inner"]), bearing="6205")
        with self.assertWarnsRegex(stribeck.learn.LeakWarning, "split by bearing"):
            windows.split([0, 1], [2, 3, 4, 5])
        train, test = windows.split(*next(stribeck.learn.by_bearing(windows.bearings, folds=2)))
        self.assertEqual(len(train) + len(test), len(windows))

    def test_background_has_its_stated_ratio(self):
        windows = stribeck.learn.Windows.of(self.records(["outer"]), bearing="6205")
        background = np.random.default_rng(5).normal(size=100_000)
        mixed = windows.with_background(background, 25_600.0, ratio=2.0)
        for before, after in zip(windows.samples, mixed.samples):
            self.assertAlmostEqual(np.std(after - before) / np.std(before), 2.0, places=6)
        with self.assertRaisesRegex(ValueError, "0 or more"):
            windows.with_background(background, 25_600.0, ratio=-1)
        with self.assertRaisesRegex(ValueError, "samples"):
            windows.with_background(background[:50], 25_600.0, ratio=1)

    def test_scores_by_hand(self):
        # Class 0: 2 of 3 found and nothing else, F1 0.8; class 1: one found, and one too many, F1 2/3.
        truth, said = [0, 0, 0, 1], [0, 0, 1, 1]
        self.assertAlmostEqual(stribeck.learn.macro_f1(truth, said), (0.8 + 2 / 3) / 2)
        low, high = stribeck.learn.interval(truth, said, ["a", "b", "c", "d"])
        self.assertLessEqual(low, high)
        with self.assertRaisesRegex(ValueError, "one of sound"):
            stribeck.learn.Windows.of([(np.zeros(9000), 1e4, 1e3, "broken", "x")], bearing="6205")

    @unittest.skipUnless(importlib.util.find_spec("sklearn"), "no scikit-learn")
    def test_the_guide_trains_on_a_campaign(self):
        root = Path(__file__).resolve().parents[4]
        with tempfile.TemporaryDirectory() as folder:
            small = Path(folder) / "small.ron"
            text = (root / "fixtures/campaigns/learn6205.ron").read_text()
            text = text.replace("count: 48", "count: 12").replace("../scenes", str(root / "fixtures/scenes"))
            short = '"mesh.grading=()", "solver.duration_ms=560"'
            text = text.replace('"output.interval_us=20"', f'"output.interval_us=20", {short}')
            small.write_text(text)
            stribeck.campaign(small, out=Path(folder) / "sim")
            script = root / "docs/guide/learn/sim_to_real.py"
            self.assertLessEqual(len(script.read_text().splitlines()), 150)
            done = subprocess.run([sys.executable, script, Path(folder) / "sim"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout.count("simulated, split by bearing"), 3, done.stdout)


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

    def test_a_run_draws_and_describes_itself(self):
        figure = self.run_.plot()
        self.assertEqual([axis.get_ylabel() for axis in figure.axes], ["sensor.side.ax_m_s2", "sensor.side.ay_m_s2"])
        table = self.run_._repr_html_()
        self.assertIn("complete", table)
        self.assertIn("100000 Hz", table)
        with self.assertRaisesRegex(KeyError, "did you mean time_s"):
            self.run_.plot("time")

    def test_a_run_shows_its_progress_where_asked(self):
        import contextlib
        import io

        for progress, told in ((True, True), (False, False), (None, False)):
            with contextlib.redirect_stderr(io.StringIO()) as said:
                stribeck.run(QUICK, duration_ms=0.05, out=Path(self.folder.name) / f"bar {progress}", progress=progress)
            self.assertEqual("100.0 %" in said.getvalue() or "ms" in said.getvalue(), told, said.getvalue())

    def test_a_file_is_analysed_as_its_samples_are(self):
        file = Path(self.folder.name) / "record.csv"
        rate, hz = 12_800, 71.7
        time = np.arange(65_536) / rate
        since = np.mod(time, 1 / hz)
        noise = np.random.default_rng(1).uniform(-0.5, 0.5, len(time))
        signal = noise + 2 * np.exp(-since / 1e-3) * np.sin(2 * np.pi * 3000 * since)
        np.savetxt(file, np.column_stack([time, signal]), delimiter=",", header="time_s,a_m_s2", comments="", fmt="%.9g")
        found = stribeck.analyse(file, bearing="6205", speed_rpm=1200)
        self.assertEqual([family["name"] for family in found["families"] if family["claimed"]], ["BPFO"])
        with self.assertRaisesRegex(ValueError, "9999999"):
            stribeck.analyse(file, bearing="9999999", speed_rpm=1200)
        with self.assertRaises(FileNotFoundError):
            stribeck.analyse(Path(self.folder.name) / "none.csv", bearing="6205")
        with self.assertRaisesRegex(TypeError, "tacho"):
            stribeck.analyse(signal, rate, tacho="pulses")
        with self.assertRaisesRegex(TypeError, "rate_hz"):
            stribeck.analyse(signal)
        npy = Path(self.folder.name) / "record.npy"
        np.save(npy, signal)
        with self.assertRaisesRegex(ValueError, "`rate_hz`"):
            stribeck.analyse(npy)

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
        quick = Path(__file__).parents[4] / "fixtures" / "scenes" / "quick.ron"
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
            (
                {
                    "model": {"reduced": {"modes_khz": 30}},
                    "housing": {"rigid": {"mass_kg": 5}},
                    "operation": {"outer_speed_profile": {"ramp": {"to": 300.0}}},
                },
                [
                    "model=reduced(modes_khz: 30)",
                    "housing=rigid(mass_kg: 5)",
                    "operation.outer_speed_profile=ramp(to: 300.0)",
                ],
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
        for fields, says in [
            ({"defects": [{"form": {"spal": {"length_mm": 4}}}]}, "form is spal.*dent.*did you mean spall"),
            ({"defects": [{"on": {"roler": 3}}]}, "on is roler.*inner, outer, roller.*did you mean roller"),
            ({"model": {"reducd": {"modes_khz": 30}}}, "model is reducd.*full.*did you mean reduced"),
        ]:
            with self.assertRaisesRegex(ValueError, says):
                stribeck.scene({"film": None, **fields})


class Signals(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(1)
        self.fs = 12_000.0
        self.x = random.normal(size=60_000)

    def test_orders_of_the_catalogue_are_those_of_geometry(self):
        # SKF's numbers for the 6205-2RS of the Case Western bearing data center: 5.4152, 3.5848, 4.7135/2, 0.39828.
        orders = stribeck.defect_orders("6205")
        self.assertAlmostEqual(orders["bpfi"], 5.4152, delta=2e-3)
        self.assertAlmostEqual(orders["bpfo"], 3.5848, delta=2e-3)
        self.assertAlmostEqual(orders["bsf"], 4.7135 / 2, delta=2e-3)
        self.assertAlmostEqual(orders["ftf"], 0.39828, delta=2e-3)
        with self.assertRaisesRegex(ValueError, "6000 to 6322"):
            stribeck.defect_orders("620S")

    def test_impacts_are_found_and_called_what_they_are(self):
        shaft_hz, order = 25.0, 3.585
        at = np.arange(0, len(self.x) / self.fs, 1 / (order * shaft_hz))
        x = 0.2 * self.x
        ring = np.exp(-np.arange(120) / 20) * np.sin(2 * np.pi * 3000 / self.fs * np.arange(120))
        for n in (at * self.fs).astype(int):
            x[n : n + 120] += 3 * ring[: len(x) - n]
        found = stribeck.analyse(x, self.fs, bearing="6205", speed_rpm=60 * shaft_hz)
        claimed = [f["name"] for f in found["families"] if f["claimed"]]
        self.assertEqual(claimed, ["BPFO"])

    def test_a_wrong_shape_is_said(self):
        for signal, says in [(np.zeros((3, 3)), "one dimension"), (self.x * 1j, "is real")]:
            with self.assertRaisesRegex(ValueError, says):
                stribeck.analyse(signal, self.fs)

    def test_help_reads_well(self):
        for thing in map(stribeck.__dict__.get, stribeck.__all__):
            self.assertGreater(len(thing.__doc__ or ""), 40, thing)

    def test_every_native_function_has_its_stub(self):
        import inspect
        import re

        from stribeck import _stribeck

        text = (Path(stribeck.__file__).parent / "_stribeck.pyi").read_text()
        stubs = {name: re.findall(r"(\w+):", arguments) for name, arguments in re.findall(r"def (\w+)\((.*?)\) ->", text, re.S)}
        native = {name: thing for name, thing in vars(_stribeck).items() if callable(thing)}
        self.assertEqual(set(stubs), set(native))
        for name, thing in native.items():
            self.assertEqual(stubs[name], list(inspect.signature(thing).parameters), name)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    unittest.main()
