"""Data sets for learning, and what it takes to try a model on another rig.

    from stribeck import learn

    simulated = learn.from_campaign("runs/learn6205", bearing="6205")
    measured = learn.Windows.of([(signal, 12_000, 1797, "inner", "rig 1")], bearing="6205")
    for train, test in learn.by_bearing(measured.bearings, folds=3):
        ...

A model must not learn the rig: a window is described by its envelope spectra over orders of the families, in which neither speed
nor bearing matters (``Windows.features``), and a bearing is in one part of a split only. ``Windows`` has ``__len__`` and
``__getitem__``, which is a data set for ``torch.utils.data.DataLoader``; ``features`` and ``labels`` are what scikit-learn takes.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _stribeck

CLASSES = ("sound", "outer", "inner", "ball")
"""What a bearing can have, in the order of the labels 0 to 3."""

_OF_TRUTH = {"healthy": "sound", "outer_race": "outer", "inner_race": "inner", "rolling_element": "ball"}
_HARMONICS = 3
_BANDS = 4
_LOWEST_HZ = 500.0
_HIGHEST_HZ = 6000.0


class Windows:
    """Windows of records with their class, their bearing and their features."""

    def __init__(self, samples: list[Any], rates: list[float], speeds: list[float], labels: Any, bearings: list[str], bearing: str):
        self.samples, self.rates, self.speeds = samples, rates, speeds
        self.labels = np.asarray(labels, dtype=np.int64)
        self.bearings = np.asarray(bearings)
        self.bearing = bearing
        self._features: Any = None

    @classmethod
    def of(
        cls,
        records: Iterable[tuple[Any, float, float, str, str]],
        *,
        bearing: str,
        window_s: float = 0.5,
        most: int = 8,
    ) -> "Windows":
        """Cuts records, each (samples, rate [Hz], speed [rpm], class, name of the bearing), into windows, ``most`` of each."""
        columns: tuple[list[Any], ...] = ([], [], [], [], [])
        for signal, rate, speed, kind, name in records:
            if kind not in CLASSES:
                raise ValueError(f"class {kind!r} of {name!r}: one of {', '.join(CLASSES)}")
            signal = np.asarray(signal, dtype=float).ravel()
            length = int(window_s * rate)
            if not 256 <= length <= len(signal):
                raise ValueError(
                    f"a window of {window_s} s at {rate} Hz has {length} samples, and {name!r} {len(signal)}: 256 samples at "
                    "least, and no more than the record; change window_s"
                )
            for start in np.linspace(0, len(signal) - length, min(most, len(signal) // length)).astype(int):
                row = (signal[start : start + length], rate, speed, CLASSES.index(kind), name)
                for column, value in zip(columns, row):
                    column.append(value)
        return cls(*columns, bearing=bearing)

    def __len__(self) -> int:
        return len(self.labels)

    def __getitem__(self, at: int) -> tuple[Any, int]:
        """Features [float32] and label of a window."""
        return self.features[at].astype(np.float32), int(self.labels[at])

    def take(self, places: Any) -> "Windows":
        """The windows at these places."""
        places = [int(at) for at in places]
        columns = [[of[at] for at in places] for of in (self.samples, self.rates, self.speeds)]
        return Windows(*columns, self.labels[places], [str(self.bearings[at]) for at in places], self.bearing)

    def split(self, train: Any, test: Any) -> tuple["Windows", "Windows"]:
        """Windows at the places of training and of test; warns of what stands on both sides (``leaks``)."""
        parts = self.take(train), self.take(test)
        for leak in leaks(parts[0].samples, parts[1].samples, parts[0].bearings, parts[1].bearings):
            warnings.warn(leak, LeakWarning, stacklevel=2)
        return parts

    def __repr__(self) -> str:
        counts = {kind: int((self.labels == n).sum()) for n, kind in enumerate(CLASSES)}
        return f"stribeck.learn.Windows({len(self)} windows of {len(set(self.bearings))} bearings, {counts})"

    def __add__(self, other: "Windows") -> "Windows":
        return Windows(
            self.samples + other.samples,
            self.rates + other.rates,
            self.speeds + other.speeds,
            np.concatenate([self.labels, other.labels]),
            [*self.bearings, *other.bearings],
            self.bearing,
        )

    @property
    def features(self) -> Any:
        """A row a window: the height of the first harmonics of BPFO, BPFI, twice BSF and the shaft above the envelope spectrum around
        them [dB], each in the band in which it stands highest. So neither speed, bearing nor resonance is in them."""
        if self._features is None:
            each = zip(self.samples, self.rates, self.speeds)
            self._features = np.array([_features(x, rate, speed, self.bearing) for x, rate, speed in each])
        return self._features

    def with_background(self, background: Any, rate: float, ratio: float, seed: int = 0) -> "Windows":
        """The windows with a measured record of a healthy machine added, from a random place each, at ``ratio`` times the root mean
        square of the window; the record is resampled to their rate."""
        if not ratio >= 0:
            raise ValueError(f"ratio is {ratio}: the root mean square of the background over that of the window, 0 or more")
        rng = np.random.default_rng(seed)
        background = np.asarray(background, dtype=float).ravel()
        mixed = [_mixed(x, own, background, rate, ratio, rng) for x, own in zip(self.samples, self.rates)]
        return Windows(mixed, self.rates, self.speeds, self.labels, list(self.bearings), self.bearing)


def _mixed(x: Any, own: float, background: Any, rate: float, ratio: float, rng: Any) -> Any:
    need = int(np.ceil(len(x) * rate / own)) + 1
    if need > len(background):
        raise ValueError(f"the background has {len(background)} samples, and a window needs {need} of them")
    start = rng.integers(0, len(background) - need + 1)
    part = background[start : start + need]
    part = np.interp(np.arange(len(x)) / own, np.arange(need) / rate, part)
    part = part - part.mean()
    return x + ratio * np.std(x) / max(np.std(part), 1e-30) * part


def _features(x: Any, rate: float, speed: float, bearing: str) -> Any:
    bpfo, bpfi, bsf, _ = _stribeck.defect_orders(bearing)
    combs = [bpfo, bpfi, 2 * bsf, 1.0]
    x = x - x.mean()
    edges = np.geomspace(_LOWEST_HZ, min(_HIGHEST_HZ, 0.47 * rate), _BANDS + 1)
    spectrum = np.fft.fft(x)
    freq = np.fft.fftfreq(len(x), 1 / rate)
    heights = []
    for low, high in zip(edges[:-1], edges[1:]):
        analytic = np.fft.ifft(np.where((freq >= low) & (freq < high), 2 * spectrum, 0))
        power = np.abs(analytic) ** 2
        lines = np.abs(np.fft.rfft((power - power.mean()) * np.hanning(len(power)))) ** 2
        heights.append([_height(lines, len(x) / rate, comb * speed / 60) for comb in combs])
    return np.max(heights, axis=0)


def _height(lines: Any, duration: float, hz: float) -> float:
    """Mean height [dB] of the first harmonics of a frequency, within 2 % of slip, above the median around them."""
    heights = []
    for n in range(1, _HARMONICS + 1):
        at, wide = n * hz * duration, max(2.0, 0.02 * n * hz * duration)
        near = lines[int(max(1, at - wide)) : int(at + wide) + 1]
        around = lines[int(max(1, at - 12 * wide)) : int(at + 12 * wide) + 1]
        if len(near) == 0 or len(around) == 0:
            heights.append(0.0)
            continue
        heights.append(10 * np.log10(max(near.max(), 1e-300) / max(np.median(around), 1e-300)))
    return float(np.mean(heights))


def from_campaign(
    folder: str | os.PathLike[str], *, bearing: str, sensor: str | None = None, window_s: float = 0.5, most: int = 2
) -> Windows:
    """Windows of the runs of a campaign that keeps signals, each run a bearing of its own; runs with several faults and without any of
    the four classes are left out."""
    import pandas

    folder = Path(folder)
    if not (folder / "signals.parquet").exists():
        raise FileNotFoundError(f"{folder} has no signals.parquet: a campaign with `keep: signals`, or `all`, makes one")
    runs = pandas.read_parquet(folder / "runs.parquet").set_index("run")
    signals = pandas.read_parquet(folder / "signals.parquet")
    # A machine has one sensor in one direction; others are on the ring, in two.
    names = [name for name in signals.columns if name.startswith("sensor.") and name.endswith((".a_m_s2", ".ay_m_s2"))]
    named = sensor if sensor is not None else next(iter(names), None)
    if named not in signals.columns:
        raise ValueError(f"no sensor {named!r} in {folder}; there are {', '.join(names)}")
    records = []
    for name, run in signals.groupby("run", sort=True):
        kind = _OF_TRUTH.get(runs.loc[name, "fault_location"])
        if kind is not None:
            time = run["time_s"].to_numpy()
            rate = (len(time) - 1) / (time[-1] - time[0])
            speed = abs(runs.loc[name, "scene.operation.speed_rpm"])
            records.append((run[named].to_numpy(), rate, speed, kind, f"simulated {name}"))
    return Windows.of(records, bearing=bearing, window_s=window_s, most=most)


def by_bearing(bearings: Sequence[str], labels: Any = None, folds: int = 3, seed: int = 0) -> Iterator[tuple[Any, Any]]:
    """Places of training and of test, ``folds`` times: all windows of a bearing are in one of them, and with ``labels`` each class
    is spread over the folds."""
    bearings = np.asarray(bearings)
    names = np.unique(bearings)
    if not 2 <= folds <= len(names):
        raise ValueError(f"folds is {folds}: 2 at least, and no more than the {len(names)} bearings")
    rng = np.random.default_rng(seed)
    order = names[rng.permutation(len(names))]
    if labels is not None:
        first = {name: np.asarray(labels)[bearings == name][0] for name in names}
        order = np.array(sorted(order, key=lambda name: first[name]))
    part = {name: n % folds for n, name in enumerate(order)}
    fold = np.array([part[name] for name in bearings])
    for n in range(folds):
        yield np.flatnonzero(fold != n), np.flatnonzero(fold == n)


class LeakWarning(UserWarning):
    """Training and test are not independent: the score is of memory, not of a diagnosis."""


_BLOCK = 16


def leaks(train: Sequence[Any], test: Sequence[Any], train_bearings: Sequence[str] = (), test_bearings: Sequence[str] = ()) -> list[str]:
    """What stands on both sides of a split, a sentence each: bearings by their names, and windows that share samples, whatever they are
    cut from. ``train`` and ``test`` are windows [arrays of samples]; shifted or overlapping ones are found from 32 common samples on."""
    found = []
    both = sorted(set(map(str, train_bearings)) & set(map(str, test_bearings)))
    if both:
        named = ", ".join(both[:5]) + (", …" if len(both) > 5 else "")
        found.append(f"{len(both)} bearings stand on both sides of the split: {named}; split by bearing, as by_bearing does")
    known = set()
    for window in train:
        blocks = np.ascontiguousarray(np.ravel(window), dtype=float)
        blocks = blocks[: len(blocks) // _BLOCK * _BLOCK].reshape(-1, _BLOCK)
        known.update(block.tobytes() for block in blocks[np.ptp(blocks, axis=1) > 0])
    shared = 0
    for window in test:
        samples = np.ascontiguousarray(np.ravel(window), dtype=float)
        # Of two windows that overlap, the beginning or the end of one lies in the other.
        last = max(len(samples) - 2 * _BLOCK + 1, 0)
        starts = {*range(min(_BLOCK, last)), *range(max(last - _BLOCK, 0), last + _BLOCK)}
        shared += any(samples[at : at + _BLOCK].tobytes() in known for at in starts if at + _BLOCK <= len(samples))
    if shared:
        found.append(f"{shared} of {len(test)} windows of the test share samples with those of training: cut windows after the split")
    return found


def macro_f1(truth: Any, said: Any) -> float:
    """Mean over the classes that are there of 2 TP/(2 TP + FP + FN)."""
    truth, said = np.asarray(truth), np.asarray(said)
    scores = []
    for kind in np.unique(truth):
        hit = np.sum((truth == kind) & (said == kind))
        scores.append(2 * hit / (np.sum(truth == kind) + np.sum(said == kind)))
    return float(np.mean(scores))


def interval(truth: Any, said: Any, bearings: Any, draws: int = 1000, seed: int = 0) -> tuple[float, float]:
    """Interval of 95 % of ``macro_f1`` by drawing whole bearings anew, within each class: windows of one are no independent witnesses."""
    truth, said, bearings = map(np.asarray, (truth, said, bearings))
    rng = np.random.default_rng(seed)
    places = {name: np.flatnonzero(bearings == name) for name in np.unique(bearings)}
    kinds = {name: truth[at[0]] for name, at in places.items()}
    groups = [[name for name in places if kinds[name] == kind] for kind in np.unique(truth)]
    scores = []
    for _ in range(draws):
        drawn = [name for group in groups for name in rng.choice(group, len(group))]
        at = np.concatenate([places[name] for name in drawn])
        scores.append(macro_f1(truth[at], said[at]))
    low, high = np.quantile(scores, [0.025, 0.975])
    return float(low), float(high)
