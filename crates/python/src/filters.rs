//! Arrays in, arrays out: filters, envelopes, other rates, parts of a signal, and its single numbers.

use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use stribeck_dsp::{Envelope, EnvelopeSpectrum, Notch, Sensor, statistics};

use crate::signals::{Array, one_of, refused};

/// Numerator and denominator of a notch.
#[pyfunction]
pub(crate) fn iirnotch<'py>(
    py: Python<'py>,
    centre_hz: f64,
    quality: f64,
    fs: f64,
) -> PyResult<(Array<'py>, Array<'py>)> {
    let notch = Notch::new(fs, centre_hz, quality).map_err(refused)?;
    Ok((notch.numerator().to_vec().into_pyarray(py), notch.denominator().to_vec().into_pyarray(py)))
}

/// The notch of `scipy.signal.iirnotch`, once forward or there and back.
#[pyfunction]
pub(crate) fn notch<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    fs: f64,
    centre_hz: f64,
    quality: f64,
    zero_phase: bool,
) -> PyResult<Array<'py>> {
    let x = x.as_slice()?;
    let notch = Notch::new(fs, centre_hz, quality).map_err(refused)?;
    let filtered = if zero_phase { notch.filtfilt(x) } else { notch.filter(x) };
    Ok(filtered.map_err(refused)?.into_pyarray(py))
}

/// The Hilbert envelope, in a band of a signal with a rate.
#[pyfunction]
#[pyo3(signature = (x, fs, band_hz))]
pub(crate) fn envelope<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    fs: f64,
    band_hz: Option<(f64, f64)>,
) -> PyResult<Array<'py>> {
    let x = x.as_slice()?;
    let plan = match band_hz {
        Some((low_hz, high_hz)) => Envelope::in_band(fs, x.len(), low_hz, high_hz),
        None => Envelope::new(x.len()),
    };
    let mut out = vec![0.0; x.len()];
    plan.and_then(|mut plan| plan.process(x, &mut out)).map_err(refused)?;
    Ok(out.into_pyarray(py))
}

/// Spectrum of the envelope in a band: frequencies and amplitudes.
#[pyfunction]
#[pyo3(signature = (x, fs, band_hz))]
pub(crate) fn envelope_spectrum<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    fs: f64,
    band_hz: Option<(f64, f64)>,
) -> PyResult<(Array<'py>, Array<'py>)> {
    let x = x.as_slice()?;
    let mut envelope = EnvelopeSpectrum::new(fs, x.len(), band_hz).map_err(refused)?;
    let mut spectrum = envelope.blank();
    envelope.process(x, &mut spectrum).map_err(refused)?;
    Ok((spectrum.frequencies_hz().to_vec().into_pyarray(py), spectrum.values().to_vec().into_pyarray(py)))
}

/// The signal at another rate.
#[pyfunction]
pub(crate) fn resample_poly<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    up: usize,
    down: usize,
) -> PyResult<Array<'py>> {
    Ok(stribeck_dsp::resample_poly(x.as_slice()?, up, down).map_err(refused)?.into_pyarray(py))
}

/// The signal as a sensor and its recorder record it.
#[pyfunction]
#[pyo3(signature = (x, fs, rate_hz, resonance, noise_density, range, bits, seed))]
#[expect(clippy::too_many_arguments, reason = "a signal of two and a sensor of six")]
pub(crate) fn record<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    fs: f64,
    rate_hz: f64,
    resonance: Option<(f64, f64)>,
    noise_density: f64,
    range: f64,
    bits: Option<u32>,
    seed: u64,
) -> PyResult<Array<'py>> {
    if !(noise_density >= 0.0 && noise_density.is_finite()) {
        return Err(refused(format!("noise_density={noise_density}: it is finite and not negative")));
    }
    if bits.is_some_and(|bits| !(1..=52).contains(&bits)) {
        return Err(refused(format!("bits={}: 1 to 52, or None for none", bits.unwrap_or(0))));
    }
    let sensor = Sensor { rate_hz, resonance, noise_density, range, bits, seed };
    Ok(sensor.record(x.as_slice()?, fs).map_err(refused)?.into_pyarray(py))
}

/// One number of a signal.
#[pyfunction]
pub(crate) fn statistic(x: PyReadonlyArray1<'_, f64>, which: &str) -> PyResult<f64> {
    type Of = fn(&[f64]) -> stribeck_dsp::Result<f64>;
    let known: [(&str, Of); 4] = [
        ("rms", statistics::rms),
        ("peak", statistics::peak),
        ("crest_factor", statistics::crest_factor),
        ("kurtosis", statistics::kurtosis),
    ];
    one_of("which", which, &known)?(x.as_slice()?).map_err(refused)
}
