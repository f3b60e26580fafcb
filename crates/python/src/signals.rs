//! Signal processing and diagnosis of arrays.

use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use stribeck_analysis::measured::{Analysis, Machine};
use stribeck_dsp::{
    Averaging, Detrend, EnvelopeSpectrum, Notch, Scaling, Sides, Welch, WelchOptions, Window,
};
use stribeck_formats::Channel;
use stribeck_scene::catalogue::CatalogueBearing;

type Array<'py> = Bound<'py, PyArray1<f64>>;

fn refused(why: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(why.to_string())
}

/// One of the words that a flag knows.
fn one_of<T: Copy>(flag: &str, word: &str, known: &[(&str, T)]) -> PyResult<T> {
    known.iter().find(|(name, _)| *name == word).map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        refused(format!("{flag}={word:?}: known are {}", names.join(", ")))
    })
}

/// What a record shows, as JSON in the form of `findings.json`.
#[pyfunction]
#[pyo3(signature = (signal, rate_hz, bearing, speed_rpm, unit, name))]
pub(crate) fn analyse(
    py: Python<'_>,
    signal: PyReadonlyArray1<'_, f64>,
    rate_hz: f64,
    bearing: Option<String>,
    speed_rpm: Option<f64>,
    unit: Option<String>,
    name: String,
) -> PyResult<String> {
    let samples = signal.as_slice()?.to_vec();
    py.detach(|| {
        let bearing = bearing.map(|text| CatalogueBearing::parse(&text)).transpose().map_err(refused)?;
        let channel = Channel::held(name, samples).in_unit(unit);
        let analysis = Analysis::of(&channel, rate_hz, &Machine { speed_rpm, bearing }).map_err(refused)?;
        serde_json::to_string(&analysis.findings).map_err(refused)
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
    let mut options = WelchOptions::new(nperseg.min(x.len()));
    options.window = one_of("window", window, &[("hann", Window::Hann), ("boxcar", Window::Boxcar)])?;
    options.detrend = one_of(
        "detrend",
        detrend,
        &[("constant", Detrend::Constant), ("linear", Detrend::Linear), ("none", Detrend::None)],
    )?;
    options.scaling =
        one_of("scaling", scaling, &[("density", Scaling::Density), ("spectrum", Scaling::Spectrum)])?;
    options.averaging =
        one_of("average", average, &[("mean", Averaging::Mean), ("median", Averaging::Median)])?;
    options.sides = Sides::One;
    options.overlap = noverlap.unwrap_or(options.segment / 2);
    options.nfft = nfft.unwrap_or(options.segment);
    let spectrum = Welch::new(fs, x.len(), &options).and_then(|mut w| w.estimate(x)).map_err(refused)?;
    Ok((spectrum.frequencies_hz().to_vec().into_pyarray(py), spectrum.values().to_vec().into_pyarray(py)))
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

/// Bands of the fast kurtogram: lower end, upper end, kurtosis.
#[pyfunction]
pub(crate) fn fast_kurtogram(
    x: PyReadonlyArray1<'_, f64>,
    fs: f64,
    levels: u32,
) -> PyResult<Vec<(f64, f64, f64)>> {
    let bands = stribeck_dsp::fast_kurtogram(x.as_slice()?, fs, levels).map_err(refused)?;
    Ok(bands.iter().map(|band| (band.low_hz, band.high_hz, band.kurtosis)).collect())
}

/// The signal with a flat spectrum.
#[pyfunction]
pub(crate) fn cepstral_prewhitening<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
) -> PyResult<Array<'py>> {
    Ok(stribeck_dsp::cepstral_prewhitening(x.as_slice()?).map_err(refused)?.into_pyarray(py))
}
