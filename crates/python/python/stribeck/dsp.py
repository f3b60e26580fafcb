"""Signal processing, with the signatures and conventions of ``scipy.signal`` where it has the function."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _stribeck

__all__ = ["cepstral_prewhitening", "envelope_spectrum", "fast_kurtogram", "notch", "welch"]


def _samples(x: Any) -> Any:
    samples = np.ascontiguousarray(x, dtype=np.float64)
    if samples.ndim != 1:
        raise ValueError(f"a signal has one dimension, this has the shape {samples.shape}: take one channel")
    return samples


def welch(
    x: Any,
    fs: float = 1.0,
    window: str = "hann",
    nperseg: int = 256,
    noverlap: int | None = None,
    nfft: int | None = None,
    detrend: str = "constant",
    scaling: str = "density",
    average: str = "mean",
) -> tuple[Any, Any]:
    """Power spectral density by Welch's method: frequencies [Hz] and values, as ``scipy.signal.welch``."""
    return _stribeck.welch(_samples(x), fs, window, nperseg, noverlap, nfft, detrend, scaling, average)


def notch(x: Any, fs: float, centre_hz: float, quality: float = 15.0, *, zero_phase: bool = False) -> Any:
    """The signal behind the notch of ``scipy.signal.iirnotch``; with ``zero_phase`` there and back."""
    return _stribeck.notch(_samples(x), fs, centre_hz, quality, zero_phase)


def envelope_spectrum(x: Any, fs: float, band_hz: tuple[float, float] | None = None) -> tuple[Any, Any]:
    """Spectrum of the envelope in a band: frequencies [Hz] and values."""
    return _stribeck.envelope_spectrum(_samples(x), fs, band_hz)


def fast_kurtogram(x: Any, fs: float, levels: int = 5) -> list[tuple[float, float, float]]:
    """Bands with their kurtosis, the widest first: ``(low_hz, high_hz, kurtosis)``. The largest is
    ``max(bands, key=lambda band: band[2])``."""
    return _stribeck.fast_kurtogram(_samples(x), fs, levels)


def cepstral_prewhitening(x: Any) -> Any:
    """The signal with all magnitudes of its spectrum made one: what is periodic loses its lead."""
    return _stribeck.cepstral_prewhitening(_samples(x))
