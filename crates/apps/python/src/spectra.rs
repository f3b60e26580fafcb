//! Levels and lines of arrays, and of their spectra.

use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use stribeck_dsp::{CombTest, Spectrum, Welch, WelchOptions, Whitened};

use crate::signals::{Array, refused};

/// Density with a Hann window; the whole record is one segment where nobody says otherwise.
fn density(x: &[f64], fs: f64, nperseg: Option<usize>) -> PyResult<Spectrum> {
    let options = WelchOptions::new(nperseg.unwrap_or(x.len()).min(x.len()));
    Welch::new(fs, x.len(), &options).and_then(|mut welch| welch.estimate(x)).map_err(refused)
}

/// Root mean square in a band.
#[pyfunction]
#[pyo3(signature = (x, fs, low_hz, high_hz, nperseg))]
pub(crate) fn band_rms(
    x: PyReadonlyArray1<'_, f64>,
    fs: f64,
    low_hz: f64,
    high_hz: f64,
    nperseg: Option<usize>,
) -> PyResult<f64> {
    density(x.as_slice()?, fs, nperseg)?.band_rms(low_hz, high_hz).map_err(refused)
}

/// Root mean square of the integral over time in a band.
#[pyfunction]
#[pyo3(signature = (x, fs, low_hz, high_hz, nperseg))]
pub(crate) fn velocity_rms(
    x: PyReadonlyArray1<'_, f64>,
    fs: f64,
    low_hz: f64,
    high_hz: f64,
    nperseg: Option<usize>,
) -> PyResult<f64> {
    density(x.as_slice()?, fs, nperseg)?.velocity_rms(low_hz, high_hz).map_err(refused)
}

/// The strongest line of a band: frequency, amplitude, and whether it is the flank of something outside.
#[pyfunction]
#[pyo3(signature = (x, fs, low_hz, high_hz, nperseg))]
pub(crate) fn strongest_line(
    x: PyReadonlyArray1<'_, f64>,
    fs: f64,
    low_hz: f64,
    high_hz: f64,
    nperseg: Option<usize>,
) -> PyResult<(f64, f64, bool)> {
    let spectrum = density(x.as_slice()?, fs, nperseg)?;
    let peak = spectrum.peak(low_hz, high_hz).map_err(refused)?;
    let line = spectrum.sinusoid(&peak).map_err(refused)?;
    Ok((line.frequency_hz, line.amplitude, peak.at_edge))
}

/// A spectrum over its background.
#[pyfunction]
pub(crate) fn whitened<'py>(
    py: Python<'py>,
    values: PyReadonlyArray1<'py, f64>,
    grid_hz: f64,
    segments: usize,
) -> PyResult<Array<'py>> {
    let whitened = Whitened::new(values.as_slice()?, grid_hz, segments).map_err(refused)?;
    Ok(whitened.ratios().to_vec().into_pyarray(py))
}

/// The highest family of harmonics: fundamental, height, heights of all harmonics, probability of a false
/// alarm.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "a spectrum of three and a search of four")]
pub(crate) fn comb<'py>(
    py: Python<'py>,
    values: PyReadonlyArray1<'py, f64>,
    grid_hz: f64,
    segments: usize,
    low_hz: f64,
    high_hz: f64,
    harmonics: usize,
    needed: usize,
) -> PyResult<(f64, f64, Array<'py>, f64)> {
    if !(1..=harmonics).contains(&needed) || harmonics > 1000 {
        let why = "from 1 harmonic to all of them can be needed, and 1000 are the most";
        return Err(refused(format!("harmonics={harmonics}, needed={needed}: {why}")));
    }
    let whitened = Whitened::new(values.as_slice()?, grid_hz, segments).map_err(refused)?;
    let found = CombTest { harmonics, needed }.search(&whitened, low_hz, high_hz).map_err(refused)?;
    Ok((found.fundamental_hz, found.height, found.ratios.into_pyarray(py), found.p_value))
}
