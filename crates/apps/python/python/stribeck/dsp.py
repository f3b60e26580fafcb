"""Signal processing of bearings that ``scipy.signal`` does not have; spectra, filters and other rates are scipy's.

Signals are arrays of one dimension, real, evenly sampled ``fs`` times a second; what is not finite is refused. Arrays that
come back are new. What cannot be done is a ``ValueError`` that says why and what to try.

================================================== ====================================================================
how strong it is, and at which frequencies         `band_rms`, `velocity_rms`, `strongest_line`
what a sensor and its recorder make of it          `record`
where it knocks, and at what rate                  `fast_kurtogram`, `envelope_spectrum`, `band_envelopes`,
                                                   `spectral_correlation`, `whitened_spectrum`, `comb_search`,
                                                   `event_spacing`
over the angle of the shaft                        `ridge`, `ridge_turns`, `order_track`, `means_over_angle`
================================================== ====================================================================
"""

from __future__ import annotations

import operator
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _stribeck

__all__ = [
    "BandEnvelope",
    "Comb",
    "EventSpacing",
    "Line",
    "Ridge",
    "band_envelopes",
    "band_rms",
    "comb_search",
    "envelope_spectrum",
    "event_spacing",
    "fast_kurtogram",
    "means_over_angle",
    "order_track",
    "record",
    "ridge",
    "ridge_turns",
    "spectral_correlation",
    "strongest_line",
    "velocity_rms",
    "whitened_spectrum",
]

Samples = NDArray[np.float64]
Band = tuple[float, float]


class Line(NamedTuple):
    """A line of a spectrum."""

    frequency_hz: float
    amplitude: float
    """Peak amplitude, the root of two times the root mean square, in the unit of the signal."""
    at_edge: bool
    """True when the spectrum rises past the end of the band: this is the flank of something outside of it."""


class BandEnvelope(NamedTuple):
    """What one band of a record shows."""

    low_hz: float
    high_hz: float
    rms: float
    kurtosis: float
    """Of the complex envelope: 0 for Gaussian noise, -1 for a steady tone."""
    frequencies_hz: Samples
    values: Samples
    """Spectrum of the squared envelope over the square of its mean."""


class Comb(NamedTuple):
    """A family of harmonics."""

    fundamental_hz: float
    height: float
    """Height over the background of the weakest harmonic that counts."""
    ratios: Samples
    """Height of each harmonic, from the first."""
    p_value: float
    """Probability that noise reaches this height anywhere in the search."""


class EventSpacing(NamedTuple):
    """What a record says of the distance of two events."""

    verdict: str
    """``"pairs"``, ``"alone"`` or ``"unknown"``."""
    lag_s: float | None
    """Distance of the two, for pairs."""
    correlation: float | None
    """Correlation of the squared envelope at that distance, for pairs."""
    clear_from_s: float | None
    """From this distance on a second event would have shown, where events come alone."""


class Ridge(NamedTuple):
    """A line through a spectrogram."""

    frequencies_hz: Samples
    height_db: float
    """Mean height above the median of the spectrogram."""


def _samples(x: ArrayLike, name: str = "a signal") -> Samples:
    if np.iscomplexobj(x):
        raise ValueError(f"{name} is real, this is complex: take its real part or its magnitude")
    samples = np.ascontiguousarray(x, dtype=np.float64)
    if samples.ndim != 1:
        raise ValueError(f"{name} has one dimension, this has the shape {samples.shape}: take one channel")
    return samples


_MOST = 1 << 27
"""No window, transform or turn is longer: a slip of the finger is an error, not a full memory."""

_MOST_VALUES = 1 << 30


def _count(name: str, value: int, least: int = 1, most: int = _MOST) -> int:
    count = operator.index(value)
    if not least <= count <= most:
        raise ValueError(f"{name}={count}: must be from {least} to {most}")
    return count


def _optional(name: str, value: int | None, least: int = 1) -> int | None:
    return None if value is None else _count(name, value, least)


def _fits(name: str, values: float) -> None:
    if not values <= _MOST_VALUES:
        raise ValueError(f"{name} would make {values:.3g} values; {_MOST_VALUES} are possible")


def _grid(f: ArrayLike, values: Samples) -> float:
    frequencies = _samples(f, "`f`")
    if len(frequencies) != len(values) or len(frequencies) < 2:
        raise ValueError(f"`f` has {len(frequencies)} frequencies for {len(values)} values: both of one spectrum")
    step = frequencies[-1] / (len(frequencies) - 1)
    if not (step > 0 and np.allclose(frequencies, step * np.arange(len(frequencies)), rtol=0, atol=1e-6 * step)):
        raise ValueError("`f` begins at zero and has equal steps, as from `scipy.signal.welch` or `envelope_spectrum`")
    return float(step)


def _steps(step: float, count: int) -> Samples:
    """Multiples of a step, from zero."""
    return np.asarray(step * np.arange(count), dtype=np.float64)





def band_rms(x: ArrayLike, fs: float, low_hz: float, high_hz: float, nperseg: int | None = None) -> float:
    """Root mean square of what lies in a band, in the unit of the signal, from a density with a Hann window. The
    whole record is one segment without ``nperseg``."""
    return _stribeck.band_rms(_samples(x), fs, low_hz, high_hz, _optional("nperseg", nperseg))


def velocity_rms(
    x: ArrayLike, fs: float, low_hz: float = 10.0, high_hz: float = 1000.0, nperseg: int | None = None
) -> float:
    """Root mean square of the velocity [m/s] in a band, from an acceleration [m/s²]: what ISO 20816 judges machines
    by."""
    return _stribeck.velocity_rms(_samples(x), fs, low_hz, high_hz, _optional("nperseg", nperseg))


def strongest_line(x: ArrayLike, fs: float, low_hz: float, high_hz: float, nperseg: int | None = None) -> Line:
    """The sinusoid of the highest peak in a band: frequency between the lines of the grid, amplitude corrected for
    the window.

    Exact for one steady sinusoid without noise, but for the leakage of its mirror image.
    """
    return Line(*_stribeck.strongest_line(_samples(x), fs, low_hz, high_hz, _optional("nperseg", nperseg)))




def envelope_spectrum(x: ArrayLike, fs: float, band_hz: Band | None = None) -> tuple[Samples, Samples]:
    """Spectrum of the squared envelope in a band: frequencies [Hz] and powers [unit⁴], with a Hann window, the mean
    removed.

    Repeated impacts are lines at their rate and its multiples. Source: Randall and Antoni 2011.
    """
    return _stribeck.envelope_spectrum(_samples(x), fs, band_hz)


def record(
    x: ArrayLike,
    fs: float,
    rate_hz: float,
    *,
    resonance: tuple[float, float] | None = None,
    noise_density: float = 0.0,
    range: float = float("inf"),
    bits: int | None = None,
    seed: int = 0,
) -> Samples:
    """What a sensor and its recorder make of a computed signal, at ``rate_hz``: the mounted sensor's ``resonance``
    (frequency [Hz] and quality), an anti-alias filter without delay, white noise [unit/√Hz], clipping beyond
    ``range`` and steps of ``bits``."""
    bits, seed = _optional("bits", bits), _count("seed", seed, 0, (1 << 64) - 1)
    return _stribeck.record(_samples(x), fs, rate_hz, resonance, noise_density, range, bits, seed)





def fast_kurtogram(x: ArrayLike, fs: float, levels: int = 5) -> list[tuple[float, float, float]]:
    """Bands with their kurtosis, the widest first: ``(low_hz, high_hz, kurtosis)``. The largest is ``max(bands,
    key=lambda band: band[2])``. At least ``2**(levels + 7)`` samples. Source: Antoni 2007."""
    return _stribeck.fast_kurtogram(_samples(x), fs, _count("levels", levels, 0, 40))


def band_envelopes(
    x: ArrayLike, fs: float, bands_hz: Iterable[Band], highest_hz: float, nperseg: int = 65536
) -> list[BandEnvelope]:
    """Spectra of the squared envelope of several bands at once, each up to ``highest_hz``, averaged over segments of
    at most ``nperseg`` samples. A band without signal is left out. Source: Randall and Antoni 2011."""
    pairs = [(float(low), float(high)) for low, high in bands_hz]
    found = _stribeck.band_envelopes(_samples(x), fs, pairs, highest_hz, _count("nperseg", nperseg))
    return [
        BandEnvelope(low, high, level, peaky, _steps(grid, len(values)), values)
        for low, high, level, peaky, grid, values in found
    ]


def spectral_correlation(
    x: ArrayLike, fs: float, highest_hz: float, nperseg: int = 256, *, coherence: bool = False
) -> tuple[Samples, Samples, NDArray[np.complex128]]:
    """Fast spectral correlation [unit²/Hz], or with ``coherence`` the spectral coherence, 0 to about 1.

    Cyclic frequencies [Hz] up to ``highest_hz``, shape ``(a,)``, carrier frequencies [Hz], shape ``(f,)``, and
    complex values, shape ``(f, a)``. The mean magnitude of the coherence over carriers, ``abs(S).mean(axis=0)``, is
    the enhanced envelope spectrum, over a chosen band of them the improved one. Source: Antoni, Xin and Hamzaoui
    2017.
    """
    x = _samples(x)
    nperseg = _count("nperseg", nperseg)
    step, count, grid, values = _stribeck.spectral_correlation(x, fs, nperseg, highest_hz, coherence)
    values = values.reshape(-1, count)
    return _steps(step, count), _steps(grid, len(values)), values


def whitened_spectrum(f: ArrayLike, Pxx: ArrayLike, segments: int = 1) -> Samples:
    """A power spectrum of ``segments`` averaged segments over its own smoothed background, as long as the spectrum:
    noise of any colour has a mean of one, and the lines next to zero are 0. 104 lines at least."""
    values = _samples(Pxx, "`Pxx`")
    return _stribeck.whitened(values, _grid(f, values), _count("segments", segments))


def comb_search(
    f: ArrayLike,
    Pxx: ArrayLike,
    low_hz: float,
    high_hz: float,
    segments: int = 1,
    harmonics: int = 5,
    needed: int = 4,
) -> Comb:
    """The highest family of harmonics of a power spectrum, such as one of an envelope, whose fundamental lies between
    two frequencies [Hz], and the probability that noise looks like it. ``needed`` of ``harmonics`` must stand: one
    strong line is no family."""
    values = _samples(Pxx, "`Pxx`")
    segments, harmonics, needed = (
        _count("segments", segments),
        _count("harmonics", harmonics),
        _count("needed", needed),
    )
    return Comb(*_stribeck.comb(values, _grid(f, values), segments, low_hz, high_hz, harmonics, needed))


def event_spacing(
    x: ArrayLike, fs: float, shortest_s: float, longest_s: float, passing_hz: float | None = None
) -> EventSpacing:
    """The distance between ``shortest_s`` and ``longest_s`` that pairs of events keep, as the entry into a spall and
    the exit from it, if two bands agree on one. With ``passing_hz``, how often the pairs come, one event may be much
    weaker than the other. Source: after Sawalhi and Randall 2011; means over passages are own."""
    return EventSpacing(*_stribeck.event_spacing(_samples(x), fs, shortest_s, longest_s, passing_hz))


def ridge(f: ArrayLike, t: ArrayLike, Sxx: ArrayLike, steepest_hz_s: float) -> Ridge:
    """The line of most power through a ``scipy.signal.spectrogram`` among all that change by at most ``steepest_hz_s`` [Hz/s]: a
    speed without a tachometer. Shapes are scipy's; give only the frequencies to be searched: ``Sxx[(f
    > 20) & (f < 60)]``."""
    f, t = _samples(f, "`f`"), _samples(t, "`t`")
    values = np.asarray(Sxx, dtype=np.float64)
    if values.shape != (len(f), len(t)):
        raise ValueError(f"`Sxx` has the shape {values.shape}; with these `f` and `t` it is {(len(f), len(t))}")
    if not (np.isfinite(values).all() and np.isfinite(f).all() and np.isfinite(t).all() and (values >= 0).all()):
        raise ValueError("`f`, `t` and `Sxx` are finite, and `Sxx` is not negative")
    if (np.diff(f) <= 0).any() or (np.diff(t) <= 0).any():
        raise ValueError("`f` and `t` ascend, as those of `scipy.signal.spectrogram`")
    return Ridge(*_stribeck.ridge(f.tolist(), t.tolist(), values.T.ravel().tolist(), steepest_hz_s))


def ridge_turns(t: ArrayLike, frequencies_hz: ArrayLike, fs: float, samples: int, order: float = 1.0) -> Samples:
    """Times of whole turns [samples] in a record of ``samples``, from the ``frequencies_hz`` of the shaft's
    ``order``-th line at times ``t`` [s], such as a `ridge`: pulses for `order_track`."""
    t, hz = _samples(t, "`t`"), _samples(frequencies_hz, "`frequencies_hz`")
    if len(t) != len(hz) or len(t) == 0:
        raise ValueError(f"`t` has {len(t)} times for {len(hz)} frequencies")
    if not (np.isfinite(t).all() and np.isfinite(hz).all() and (hz > 0).all() and (np.diff(t) > 0).all()):
        raise ValueError("`t` ascends, and frequencies are finite and above 0")
    if fs > 0 and order > 0 and hz.max() / order > fs / 2:
        raise ValueError("the shaft would turn more than once in two samples: look at `fs` and `order`")
    return _stribeck.turns_of_ridge(t.tolist(), hz.tolist(), fs, _count("samples", samples, 1, 1 << 40), order)


def order_track(x: ArrayLike, pulses: ArrayLike, samples_per_turn: int) -> Samples:
    """The signal at equal angles between ``pulses``, the times [samples] of one pulse a turn: shape ``(turns,
    samples_per_turn)``.

    ``.mean(axis=0)`` is the time-synchronous average, what it leaves is not locked to the shaft; a spectrum of
    ``.ravel()`` with ``fs=samples_per_turn`` is one over orders. Between samples the signal follows a cubic (Catmull
    and Rom 1974).
    """
    pulses, count = _samples(pulses, "`pulses`"), _count("samples_per_turn", samples_per_turn)
    _fits("samples_per_turn", len(pulses) * count)
    return _stribeck.order_track(_samples(x), pulses, count).reshape(-1, count)


def means_over_angle(x: ArrayLike, turns: ArrayLike, steps_per_turn: int) -> Samples:
    """Means of the signal over equal steps of the shaft's angle, ``steps_per_turn`` of them: ``turns`` is the angle
    at each sample, in turns, never falling. Safe from aliases down to rest, which is what an envelope needs."""
    turns, steps = _samples(turns, "`turns`"), _count("steps_per_turn", steps_per_turn)
    if len(turns) and np.isfinite(turns).all():
        _fits("steps_per_turn", float(turns[-1] - turns[0]) * steps)
    return _stribeck.means_over_angle(_samples(x), turns, steps)
