"""Stribeck: rolling element bearings, simulated and diagnosed.

A run from a scene, and its signals as NumPy arrays::

    import stribeck

    run = stribeck.run({"mesh": {"size_mm": 1.0}}, duration_ms=2.0)
    time, side = run["time_s"], run["sensor.side.ay_m_s2"]
    print(run.summary["kinematics"]["cage_hz"])

A verdict on a measured record::

    found = stribeck.analyse(signal, 25_600, bearing="6205", speed_rpm=1797)
    print(found["verdict"])

Many runs and their tables::

    data = stribeck.campaign("fixtures/campaigns/quick64.ron")
    print(data.runs.groupby("fault_location").size(), data.events.spall_mm.mean())

What else the program can do in a shell it can do here: ``stribeck.command("plan", "scene.ron")``.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Callable

import numpy as np

from . import _progress, _ron, _stribeck
from ._program import Campaign, _analysed, _python_words, campaign, command, export, validate

__all__ = [
    "Campaign",
    "Run",
    "analyse",
    "campaign",
    "command",
    "defect_orders",
    "export",
    "load",
    "run",
    "scene",
    "validate",
]
__version__ = _stribeck.__version__

Progress = Callable[[str, float, float], None]


def _asked(scene: Any, fields: Mapping[str, Any] | None, duration_ms: float | None) -> tuple[Path | None, list[str], bool]:
    """The file of a scene, what is changed in it, and whether it is fields alone, without a file."""
    file = None
    changed: list[str] = []
    if isinstance(scene, Mapping):
        changed += _ron.overrides(scene)
    elif scene is not None:
        file = Path(scene)
    if fields:
        changed += _ron.overrides(fields)
    if duration_ms is not None:
        changed.append(f"solver.duration_ms={duration_ms}")
    return file, changed, isinstance(scene, Mapping)


class Run:
    """A run: its folder, its signals, what it comes to.

    ``run["sensor.side.ay_m_s2"]`` is a channel as a NumPy array; ``run.channels`` lists the names.
    """

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = Path(folder)
        self._columns: dict[str, Any] | None = None
        self._summary: dict[str, Any] | None = None

    def __repr__(self) -> str:
        return f"stribeck.Run({str(self.folder)!r})"

    @property
    def _all(self) -> dict[str, Any]:
        if self._columns is None:
            self._columns = dict(_stribeck.channels(self.folder))
        return self._columns

    @property
    def channels(self) -> list[str]:
        """Names of the channels; the unit is the end of each."""
        return list(self._all)

    def __getitem__(self, channel: str) -> Any:
        try:
            return self._all[channel]
        except KeyError:
            import difflib

            near = difflib.get_close_matches(channel, self._all, n=3)
            hint = f"; did you mean {', '.join(near)}?" if near else f"; there are {', '.join(self._all)}"
            raise KeyError(f"no channel {channel!r} in {self.folder}{hint}") from None

    @property
    def rate_hz(self) -> float:
        """Samples a second."""
        time = self["time_s"]
        return round(10 * (len(time) - 1) / (time[-1] - time[0])) / 10

    @property
    def summary(self) -> dict[str, Any]:
        """Everything the run says in numbers, as in ``summary.json``."""
        if self._summary is None:
            self._summary = json.loads(_stribeck.summary(self.folder))
        return self._summary

    @property
    def info(self) -> dict[str, Any]:
        """How the run went: status, steps, times, versions, as in ``run.json``."""
        return json.loads((self.folder / "run.json").read_text())

    @property
    def energy(self) -> dict[str, Any]:
        """The sampled ledger of energy, ``energy.npy``: arrays by name, whose unit is its end."""
        import numpy

        table = numpy.load(self.folder / "energy.npy")
        return {name: numpy.ascontiguousarray(table[name]) for name in table.dtype.names}

    def export(self, to: str, **options: Any) -> Path:
        """Writes the run in the format of another program and returns the path: ``help(stribeck.export)``."""
        return export(self.folder, to, **options)

    def report(self) -> Path:
        """Writes ``report.html`` and returns its path."""
        return _stribeck.report(self.folder)

    def frame(self) -> Any:
        """All channels as a pandas DataFrame over the time [s]."""
        import pandas

        return pandas.DataFrame(self._all).set_index("time_s")

    def resume(
        self, duration_ms: float | None = None, *, threads: int | None = None, progress: Progress | bool | None = None
    ) -> "Run":
        """Continues the run to its end, or to another duration [ms]."""
        with _progress.shown(progress) as told, _python_words():
            return Run(_stribeck.resume(self.folder, duration_ms, threads, told))

    def plot(self, *channels: str) -> Any:
        """Draws channels over the time and returns the matplotlib figure; without names, the accelerations of the first sensor."""
        try:
            from matplotlib.figure import Figure
        except ImportError:
            raise ImportError("run.plot() needs matplotlib: pip install matplotlib") from None
        names = channels or tuple(name for name in self.channels if name.endswith(("ax_m_s2", "ay_m_s2")))[:2]
        figure = Figure(figsize=(9, 1 + 1.8 * len(names)), layout="constrained")
        axes = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
        time_ms = 1e3 * self["time_s"]
        for axis, name in zip(axes, names):
            axis.plot(time_ms, self[name], linewidth=0.6)
            axis.set_ylabel(name, fontsize=8)
            axis.grid(True, linewidth=0.3)
        axes[-1].set_xlabel("time (ms)")
        figure.suptitle(self.folder.name, fontsize=10)
        return figure

    def _repr_html_(self) -> str:
        from html import escape

        info = self.info
        rows = {
            "folder": str(self.folder),
            "status": info.get("status", ""),
            "simulated": f"{1e3 * info.get('simulated_s', 0.0):.2f} ms",
            "samples": f"{len(self['time_s'])} at {self.rate_hz:g} Hz, {len(self.channels)} channels",
        }
        cells = "".join(f"<tr><th>{name}</th><td>{escape(value)}</td></tr>" for name, value in rows.items())
        warnings = "".join(f"<li>{escape(str(warning))}</li>" for warning in info.get("warnings", []))
        return f"<table>{cells}</table>" + (f"<ul>{warnings}</ul>" if warnings else "")


def run(
    scene: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    fields: Mapping[str, Any] | None = None,
    *,
    duration_ms: float | None = None,
    out: str | os.PathLike[str] | None = None,
    overwrite: bool = False,
    threads: int | None = None,
    progress: Progress | bool | None = None,
) -> Run:
    """Simulates a scene and returns the run.

    scene: a scene file, or fields that differ from the defaults, the paper's bearing in oil, as nested dicts
        (``{"operation": {"load_n": 30e3}}``) or with dots (``{"operation.load_n": 30e3}``). A word of a scene that has fields of its
        own is a dict of one key (``{"model": {"reduced": {"modes_khz": 30}}}``), a list is given whole
        (``{"defects": [{"on": "outer", "form": {"spall": {"length_mm": 4, "depth_mm": 0.05}}}]}``).
        Without either the paper's run, ``singh2014.ron``.
    fields: more fields, over those of a file.
    duration_ms: simulated time [ms].
    out: folder of the run; without it ``runs/NAME``, numbered where there is one already.
    overwrite: replaces the run in ``out`` once the new one is complete.
    threads: worker threads; the results do not depend on it.
    progress: a function that is called some ten times a second with the phase, the share that is done and the simulated time [s];
        without one a line in a terminal and a bar in a notebook, with False nothing.

    Ctrl-C ends the run in good order: what was computed is kept, and ``Run(folder).resume()`` goes on.
    A mistake in the scene is a ValueError that names line, field and range.
    """
    folder = Path(out) if out is not None else None
    with _progress.shown(progress) as told, _python_words():
        return Run(_stribeck.simulate(_asked(scene, fields, duration_ms), folder, overwrite, threads, told))


def load(folder: str | os.PathLike[str]) -> Run:
    """A run that lies in a folder; its signals are read when they are first asked for."""
    found = Run(folder)
    if not (found.folder / "run.json").exists():
        raise FileNotFoundError(f"{folder} holds no run: there is no run.json")
    return found


def scene(
    scene: str | os.PathLike[str] | Mapping[str, Any] | None = None, fields: Mapping[str, Any] | None = None
) -> str:
    """A scene with every default written out, as RON."""
    return _stribeck.scene(_asked(scene, fields, None))[0]


def analyse(
    signal: Any,
    rate_hz: float | None = None,
    *,
    bearing: str | None = None,
    speed_rpm: float | str | None = None,
    unit: str | None = None,
    name: str = "signal",
    channel: str | None = None,
    tacho: str | None = None,
    **options: Any,
) -> dict[str, Any]:
    """What a measured record shows: families of defects, a verdict, health figures, as in ``findings.json``.

    signal: samples of one channel, or the path of a file in any of the formats, or of a run.
    rate_hz: samples a second; a file may say it.
    bearing: a name of the catalogue (``"6205"``) or numbers (``"elements=9, diameter_mm=7.94, pitch_mm=39"``).
    speed_rpm: speed of the shaft; without it nothing can be said of a defect. Of a file also a range, ``"1400..1600"``.
    unit: of the samples, for what is shown.
    channel, tacho: of a file, the channel and that of a tachometer or of the angle of the shaft.
    options: of a file, what ``stribeck analyse`` takes, such as ``pulses_per_turn=20`` or ``out="folder"``.
    """
    if isinstance(signal, (str, os.PathLike)):
        asked = {"rate_hz": rate_hz, "bearing": bearing, "speed_rpm": speed_rpm, "unit": unit, "channel": channel, "tacho": tacho}
        return _analysed(signal, {**asked, **options})
    unfit = [name for name, value in {"channel": channel, "tacho": tacho, **options}.items() if value is not None]
    if unfit:
        raise TypeError(f"{', '.join(unfit)}: of a file alone; give its path instead of samples")
    if rate_hz is None:
        raise TypeError("analyse() of samples needs rate_hz, the samples a second")
    speed = float(speed_rpm) if speed_rpm is not None else None
    with _python_words():
        return json.loads(_stribeck.analyse(_samples(signal), rate_hz, bearing, speed, unit, name))


def _samples(x: Any) -> Any:
    if np.iscomplexobj(x):
        raise ValueError("a signal is real, this is complex: take its real part or its magnitude")
    samples = np.ascontiguousarray(x, dtype=np.float64)
    if samples.ndim != 1:
        raise ValueError(f"a signal has one dimension, this has the shape {samples.shape}: take one channel")
    return samples


def defect_orders(bearing: str) -> dict[str, float]:
    """Frequencies of the defects of a bearing over that of the shaft, from geometry without slip: ``bpfo`` and ``bpfi`` for the outer
    and the inner raceway, ``bsf`` for a rolling element, ``ftf`` for the cage, while the outer ring stands.

    bearing: a name of the catalogue or numbers, as for `analyse`.
    """
    return dict(zip(("bpfo", "bpfi", "bsf", "ftf"), _stribeck.defect_orders(bearing)))


def _main() -> None:
    # The program listens for Ctrl-C itself, which is why it has a process of its own.
    sys.exit(_stribeck.command(sys.argv[1:]))
