"""Stribeck: rolling element bearings, simulated and diagnosed.

A run from a scene, and its signals as NumPy arrays::

    import stribeck

    run = stribeck.run({"mesh": {"size_mm": 1.0}}, duration_ms=2.0)
    time, side = run["time_s"], run["sensor.side.ay_m_s2"]
    print(run.summary["kinematics"]["cage_hz"])

A verdict on a measured record::

    found = stribeck.analyse(signal, 25_600, bearing="6205", speed_rpm=1797)
    print(found["verdict"])

Everything the program can do in a shell it can do here: ``stribeck.command("campaign", "quick64.ron")``.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Callable

from . import _stribeck, dsp

__all__ = ["Run", "analyse", "command", "dsp", "load", "run", "scene"]
__version__ = _stribeck.__version__

Progress = Callable[[str, float, float], None]


def _value(value: Any) -> str:
    """A value as scenes write it."""
    if value is None:
        return "None"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    if isinstance(value, Mapping):
        return "(" + ", ".join(f"{key}: {_value(v)}" for key, v in value.items()) + ")"
    return str(value)


def _overrides(fields: Mapping[str, Any], above: str = "") -> list[str]:
    found: list[str] = []
    for key, value in fields.items():
        path = f"{above}.{key}" if above else str(key)
        if isinstance(value, Mapping) and value:
            found += _overrides(value, path)
        else:
            found.append(f"{path}={_value(value)}")
    return found


def _asked(scene: Any, fields: Mapping[str, Any] | None, duration_ms: float | None) -> tuple[Path | None, list[str]]:
    """The file of a scene, and what is changed in it."""
    file = None
    changed: list[str] = []
    if isinstance(scene, Mapping):
        changed += _overrides(scene)
    elif scene is not None:
        file = Path(scene)
    if fields:
        changed += _overrides(fields)
    if duration_ms is not None:
        changed.append(f"solver.duration_ms={duration_ms}")
    return file, changed


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

    def report(self) -> Path:
        """Writes ``report.html`` and returns its path."""
        return _stribeck.report(self.folder)

    def frame(self) -> Any:
        """All channels as a pandas DataFrame over the time [s]."""
        import pandas

        return pandas.DataFrame(self._all).set_index("time_s")

    def resume(
        self, duration_ms: float | None = None, *, threads: int | None = None, progress: Progress | None = None
    ) -> "Run":
        """Continues the run to its end, or to another duration [ms]."""
        return Run(_stribeck.resume(self.folder, duration_ms, threads, progress))


def run(
    scene: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    fields: Mapping[str, Any] | None = None,
    *,
    duration_ms: float | None = None,
    out: str | os.PathLike[str] | None = None,
    overwrite: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Run:
    """Simulates a scene and returns the run.

    scene: a scene file, or fields that differ from the paper's bearing, as nested dicts
        (``{"operation": {"load_n": 30e3}}``) or with dots (``{"operation.load_n": 30e3}``).
    fields: more fields, over those of a file.
    duration_ms: simulated time [ms].
    out: folder of the run; without it ``runs/NAME``, numbered where there is one already.
    overwrite: replaces the run in ``out`` once the new one is complete.
    threads: worker threads; the results do not depend on it.
    progress: is called some ten times a second with the phase, the share that is done and the simulated time [s].

    Ctrl-C ends the run in good order: what was computed is kept, and ``Run(folder).resume()`` goes on.
    A mistake in the scene is a ValueError that names line, field and range.
    """
    file, changed = _asked(scene, fields, duration_ms)
    folder = Path(out) if out is not None else None
    return Run(_stribeck.simulate(file, changed, folder, overwrite, threads, progress))


def load(folder: str | os.PathLike[str]) -> Run:
    """A run that lies in a folder."""
    found = Run(folder)
    if not (found.folder / "run.json").exists():
        raise FileNotFoundError(f"{folder} holds no run: there is no run.json")
    return found


def scene(
    scene: str | os.PathLike[str] | Mapping[str, Any] | None = None, fields: Mapping[str, Any] | None = None
) -> str:
    """A scene with every default written out, as RON."""
    return _stribeck.scene(*_asked(scene, fields, None))[0]


def analyse(
    signal: Any,
    rate_hz: float,
    *,
    bearing: str | None = None,
    speed_rpm: float | None = None,
    unit: str | None = None,
    name: str = "signal",
) -> dict[str, Any]:
    """What a measured record shows: families of defects, a verdict, health figures, as in ``findings.json``.

    signal: samples, one channel.
    rate_hz: samples a second.
    bearing: a name of the catalogue (``"6205"``) or numbers (``"elements=9, diameter_mm=7.94, pitch_mm=39"``).
    speed_rpm: speed of the shaft; without it nothing can be said of a defect.
    unit: of the samples, for what is shown.
    """
    return json.loads(_stribeck.analyse(dsp._samples(signal), rate_hz, bearing, speed_rpm, unit, name))


def command(*arguments: str | os.PathLike[str]) -> int:
    """Runs a command of the program, as in a shell, in a process of its own, and returns its exit code."""
    return subprocess.run([sys.executable, "-m", "stribeck", *map(os.fspath, arguments)]).returncode


def _main() -> None:
    # The program listens for Ctrl-C itself, which is why it has a process of its own.
    sys.exit(_stribeck.command(sys.argv[1:]))
