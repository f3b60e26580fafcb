"""Commands of the program that make many runs or other files, each in a process of its own."""

from __future__ import annotations

import contextlib
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from . import _ron

def command(*arguments: str | os.PathLike[str]) -> int:
    """Runs a command of the program, as in a shell, in a process of its own, and returns its exit code."""
    return subprocess.run([sys.executable, "-m", "stribeck", *map(os.fspath, arguments)]).returncode


def _asked(**flags: Any) -> list[str]:
    """Flags of the program; one that is None is left to it."""
    given = {name.replace("_", "-"): flag for name, flag in flags.items() if flag is not None}
    return [f"--{name}={os.fspath(flag) if isinstance(flag, os.PathLike) else flag}" for name, flag in given.items()]


def _done(arguments: list[str]) -> str:
    """What the command has printed. What it says of its progress or its mistakes it says itself."""
    done = subprocess.run([sys.executable, "-m", "stribeck", *arguments], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"stribeck {' '.join(arguments)} ended with {done.returncode}; its words stand above")
    return done.stdout


def _in_python(words: str) -> str:
    """A message with the names of arguments for flags of the program."""
    return re.sub(r"(?<![\w-])--([a-z][a-z-]+)", lambda flag: flag[1].replace("-", "_"), words)


@contextlib.contextmanager
def _python_words() -> Iterator[None]:
    """Mistakes speak of arguments, not of flags."""
    try:
        yield
    except (ValueError, RuntimeError) as why:
        said = _in_python(str(why))
        if said == str(why):
            raise
        raise type(why)(said) from None


def _analysed(file: str | os.PathLike[str], flags: Mapping[str, Any]) -> dict[str, Any]:
    """Findings of a file by ``stribeck analyse``; a mistake is a ValueError."""
    with tempfile.TemporaryDirectory() as folder:
        out = {} if flags.get("out") is not None else {"out": Path(folder) / "analysis"}
        arguments = ["analyse", os.fspath(file), "--json", *_asked(**{**flags, **out})]
        done = subprocess.run([sys.executable, "-m", "stribeck", *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        said = done.stderr.strip().split("error: ", 1)[-1]
        if not Path(file).exists():
            raise FileNotFoundError(f"{os.fspath(file)}: no file and no run")
        raise ValueError(_in_python(said))
    return json.loads(done.stdout)


class Campaign:
    """The data set of a campaign: its folder and tables, as pandas DataFrames."""

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = Path(folder)

    def __repr__(self) -> str:
        return f"stribeck.Campaign({str(self.folder)!r})"

    def _table(self, name: str) -> Any:
        import pandas

        return pandas.read_parquet(self.folder / name)

    @property
    def runs(self) -> Any:
        """A row a run, with the ground truth and what the analysis found."""
        return self._table("runs.parquet")

    @property
    def events(self) -> Any:
        """A row a passage of a roller over a spall of a raceway."""
        return self._table("events.parquet")

    @property
    def signals(self) -> Any:
        """A row a sample, where the campaign keeps signals. All runs at once: for a large campaign read
        ``signals.parquet`` in groups of rows, a run each."""
        return self._table("signals.parquet")


def campaign(
    file: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    jobs: int | None = None,
    threads: int | None = None,
    memory_gb: float | None = None,
) -> Campaign:
    """Makes the runs of a campaign, or goes on with them, and returns its data set.

    file: the campaign's file, such as ``fixtures/campaigns/quick64.ron``.
    out: its folder; without it ``runs/NAME``.
    jobs, threads, memory_gb: as of ``stribeck campaign``; the results do not depend on them.
    """
    printed = _done(["campaign", os.fspath(file), *_asked(out=out, jobs=jobs, threads=threads, memory_gb=memory_gb)])
    # The last line ends in the path of the table of runs.
    return Campaign(out if out is not None else Path(printed.strip().rsplit(": ", 1)[-1]).parent)


def validate(
    scene: str | os.PathLike[str],
    fields: Mapping[str, Any] | None = None,
    *,
    out: str | os.PathLike[str],
    starts: int = 4,
    seed: int = 1,
    jobs: int | None = None,
    threads: int | None = None,
) -> Path:
    """Runs the same starts of a scene by the full and by the reduced model, and returns the page that says how far apart they are.

    scene: a scene file, with either model.
    fields: fields over those of the file.
    out: folder of the runs and of the page.
    """
    changed = [word for field in _ron.overrides(fields or {}) for word in ("--set", field)]
    flags = _asked(out=out, starts=starts, seed=seed, jobs=jobs, threads=threads)
    _done(["validate", os.fspath(scene), *changed, *flags])
    return Path(out) / "report.html"


def export(
    run: str | os.PathLike[str],
    to: str,
    *,
    channels: list[str] | None = None,
    sensor: str | None = None,
    out: str | os.PathLike[str] | None = None,
) -> Path:
    """Writes a run in the format of another program, and returns the file's path.

    run: the folder of the run.
    to: ``csv``, ``npz``, ``mat``, ``uff``, ``parquet``, ``wav``, ``pvd``, ``inp`` or ``msh``.
    channels: only channels whose name contains one of these.
    sensor: records the accelerations through a sensor, ``"rate_hz=25600, bits=24"``.
    out: the file; without it one in the run's folder.
    """
    wanted = [f"--channel={part}" for part in channels or []]
    printed = _done(["export", os.fspath(run), *_asked(to=to, sensor=sensor, out=out), *wanted])
    return Path(printed.strip().splitlines()[-1])
