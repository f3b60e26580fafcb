//! Which bands of an array knock, and at what rate; arrays over the angle of a shaft.

use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use stribeck_dsp::{BandEnvelopes, Cyclic, EventSpacing, Ridge, Spectrogram};

use crate::signals::{Array, refused};

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

/// Distance and number of the cyclic frequencies, distance of the carriers, values by carrier.
#[pyfunction]
pub(crate) fn spectral_correlation<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    fs: f64,
    window: usize,
    highest_hz: f64,
    coherence: bool,
) -> PyResult<(f64, usize, f64, Bound<'py, PyArray1<numpy::Complex64>>)> {
    let kind = if coherence { Cyclic::Coherence } else { Cyclic::Correlation };
    let found =
        stribeck_dsp::spectral_correlation(x.as_slice()?, fs, window, highest_hz, kind).map_err(refused)?;
    let values: Vec<numpy::Complex64> =
        found.values.iter().map(|v| numpy::Complex64::new(v.re, v.im)).collect();
    Ok((found.cyclic_grid_hz, found.cyclic, found.grid_hz, values.into_pyarray(py)))
}

/// For each band with signal: ends, root mean square, kurtosis, distance of the lines of its spectrum, the
/// spectrum.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "a tuple in Python, too")]
pub(crate) fn band_envelopes<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    fs: f64,
    bands_hz: Vec<(f64, f64)>,
    highest_hz: f64,
    nperseg: usize,
) -> PyResult<Vec<(f64, f64, f64, f64, f64, Array<'py>)>> {
    let x = x.as_slice()?;
    let segment = BandEnvelopes::segment_of(x.len(), nperseg);
    let mut plan = BandEnvelopes::new(fs, segment, &bands_hz, highest_hz).map_err(refused)?;
    for piece in x.chunks_exact(segment) {
        plan.add(piece).map_err(refused)?;
    }
    let bands = plan.bands().into_iter();
    Ok(bands
        .map(|b| (b.low_hz, b.high_hz, b.rms, b.kurtosis, b.grid_hz, b.values.into_pyarray(py)))
        .collect())
}

/// What is said of the distance of two events, then lag, correlation and the distance from which on a second
/// one would show.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "a tuple in Python, too")]
pub(crate) fn event_spacing(
    x: PyReadonlyArray1<'_, f64>,
    fs: f64,
    shortest_s: f64,
    longest_s: f64,
    passing_hz: Option<f64>,
) -> PyResult<(&'static str, Option<f64>, Option<f64>, Option<f64>)> {
    let x = x.as_slice()?;
    let found = match passing_hz {
        Some(hz) => stribeck_dsp::passage_spacing(x, fs, hz, shortest_s, longest_s),
        None => stribeck_dsp::event_spacing(x, fs, shortest_s, longest_s),
    };
    let found = found.map_err(refused)?;
    Ok(match found {
        EventSpacing::Pairs(pair) => ("pairs", Some(pair.lag_s), Some(pair.correlation), None),
        EventSpacing::Alone { clear_from_s } => ("alone", None, None, Some(clear_from_s)),
        EventSpacing::Unknown => ("unknown", None, None, None),
    })
}

/// Samples at equal angles, turn after turn.
#[pyfunction]
pub(crate) fn order_track<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    pulses: PyReadonlyArray1<'py, f64>,
    samples_per_turn: usize,
) -> PyResult<Array<'py>> {
    let tracked = stribeck_dsp::order_track(x.as_slice()?, pulses.as_slice()?, samples_per_turn);
    Ok(tracked.map_err(refused)?.values.into_pyarray(py))
}

/// Means over equal steps of an angle.
#[pyfunction]
pub(crate) fn means_over_angle<'py>(
    py: Python<'py>,
    x: PyReadonlyArray1<'py, f64>,
    turns: PyReadonlyArray1<'py, f64>,
    steps_per_turn: usize,
) -> PyResult<Array<'py>> {
    let means = stribeck_dsp::means_over_angle(x.as_slice()?, turns.as_slice()?, steps_per_turn);
    Ok(means.map_err(refused)?.into_pyarray(py))
}

/// The strongest line through a spectrogram, given by its rows: frequency at each time, height.
#[pyfunction]
pub(crate) fn ridge<'py>(
    py: Python<'py>,
    frequencies_hz: Vec<f64>,
    times_s: Vec<f64>,
    values: Vec<f64>,
    steepest_hz_s: f64,
) -> PyResult<(Array<'py>, f64)> {
    let spectrogram = Spectrogram { times_s, frequencies_hz, values };
    let line = stribeck_dsp::ridge(&spectrogram, steepest_hz_s).map_err(refused)?;
    Ok((line.frequencies_hz.into_pyarray(py), line.height_db))
}

/// Times of whole turns in samples, from a line of an order of the shaft.
#[pyfunction]
pub(crate) fn turns_of_ridge<'py>(
    py: Python<'py>,
    times_s: Vec<f64>,
    frequencies_hz: Vec<f64>,
    fs: f64,
    samples: usize,
    order: f64,
) -> PyResult<Array<'py>> {
    let line = Ridge { times_s, frequencies_hz, height_db: 0.0 };
    Ok(line.turns(fs, samples, order).map_err(refused)?.into_pyarray(py))
}
