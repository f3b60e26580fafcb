//! Arrays in, arrays out: spectra of envelopes, and what a sensor records.

use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use stribeck_dsp::{EnvelopeSpectrum, Sensor};

use crate::signals::{Array, refused};

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
