//! Spectra of arrays, and their lines.

use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use stribeck_dsp::{
    Averaging, CombTest, Detrend, Scaling, Sides, Spectrum, Welch, WelchOptions, Whitened, Window,
};

use crate::signals::{Array, one_of, refused};

/// A window by the name that scipy has for it.
fn window(name: &str, periodic: bool) -> PyResult<Window> {
    let known: &[(&str, Window)] = if periodic {
        &[("hann", Window::Hann), ("boxcar", Window::Boxcar)]
    } else {
        &[("hann", Window::SymmetricHann), ("hamming", Window::SymmetricHamming), ("boxcar", Window::Boxcar)]
    };
    one_of("window", name, known)
}

/// Weights of a window.
#[pyfunction]
pub(crate) fn get_window<'py>(
    py: Python<'py>,
    name: &str,
    count: usize,
    periodic: bool,
) -> PyResult<Array<'py>> {
    Ok(window(name, periodic)?.samples(count).map_err(refused)?.into_pyarray(py))
}

/// The choices that Welch's estimate and the spectrogram have in common.
fn options(
    name: &str,
    segment: usize,
    overlap: Option<usize>,
    nfft: Option<usize>,
    detrend: &str,
    scaling: &str,
) -> PyResult<WelchOptions> {
    let detrends = [("constant", Detrend::Constant), ("linear", Detrend::Linear), ("none", Detrend::None)];
    Ok(WelchOptions {
        window: window(name, true)?,
        detrend: one_of("detrend", detrend, &detrends)?,
        scaling: one_of(
            "scaling",
            scaling,
            &[("density", Scaling::Density), ("spectrum", Scaling::Spectrum)],
        )?,
        sides: Sides::One,
        overlap: overlap.unwrap_or(segment / 2),
        nfft: nfft.unwrap_or(segment),
        ..WelchOptions::new(segment)
    })
}

/// Welch's estimate: frequencies and values.
#[pyfunction]
#[pyo3(signature = (x, fs, window, nperseg, noverlap, nfft, detrend, scaling, average))]
#[expect(clippy::too_many_arguments, reason = "those of scipy.signal.welch")]
pub(crate) fn welch<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    fs: f64,
    window: &str,
    nperseg: usize,
    noverlap: Option<usize>,
    nfft: Option<usize>,
    detrend: &str,
    scaling: &str,
    average: &str,
) -> PyResult<(Array<'py>, Array<'py>)> {
    let x = x.as_slice()?;
    let mut options = options(window, nperseg.min(x.len()), noverlap, nfft, detrend, scaling)?;
    options.averaging =
        one_of("average", average, &[("mean", Averaging::Mean), ("median", Averaging::Median)])?;
    let spectrum = Welch::new(fs, x.len(), &options).and_then(|mut w| w.estimate(x)).map_err(refused)?;
    Ok((spectrum.frequencies_hz().to_vec().into_pyarray(py), spectrum.values().to_vec().into_pyarray(py)))
}

/// Frequencies, times and values of a spectrogram, one row a time.
#[pyfunction]
#[pyo3(signature = (x, fs, window, nperseg, noverlap, nfft, detrend, scaling, mode))]
#[expect(clippy::too_many_arguments, reason = "those of scipy.signal.spectrogram")]
pub(crate) fn spectrogram<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    fs: f64,
    window: &str,
    nperseg: usize,
    noverlap: Option<usize>,
    nfft: Option<usize>,
    detrend: &str,
    scaling: &str,
    mode: &str,
) -> PyResult<(Array<'py>, Array<'py>, Array<'py>)> {
    let x = x.as_slice()?;
    let options = options(window, nperseg.min(x.len()), noverlap, nfft, detrend, scaling)?;
    let all = match one_of("mode", mode, &[("psd", false), ("magnitude", true)])? {
        false => stribeck_dsp::spectrogram(x, fs, &options),
        true => stribeck_dsp::magnitude_spectrogram(x, fs, &options),
    };
    let all = all.map_err(refused)?;
    Ok((all.frequencies_hz.into_pyarray(py), all.times_s.into_pyarray(py), all.values.into_pyarray(py)))
}

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
