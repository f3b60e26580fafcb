//! Statistics of a whole record. All need a signal without infinite or missing samples.

use crate::error::check_signal;
use crate::{Error, Result};

/// Arithmetic mean [unit].
///
/// # Errors
/// [`Error::TooShort`] for an empty signal, [`Error::NotFinite`] for a bad sample.
pub fn mean(signal: &[f64]) -> Result<f64> {
    check_signal(signal, 1, "a mean")?;
    Ok(average(signal.iter().copied(), signal.len()))
}

/// Root mean square about zero [unit]; the mean is part of it.
///
/// # Errors
/// [`Error::TooShort`] for an empty signal, [`Error::NotFinite`] for a bad sample.
pub fn rms(signal: &[f64]) -> Result<f64> {
    check_signal(signal, 1, "a root mean square")?;
    Ok(average(signal.iter().map(|x| x * x), signal.len()).sqrt())
}

/// Largest magnitude [unit], not negative.
///
/// # Errors
/// [`Error::TooShort`] for an empty signal, [`Error::NotFinite`] for a bad sample.
pub fn peak(signal: &[f64]) -> Result<f64> {
    check_signal(signal, 1, "a peak")?;
    Ok(signal.iter().fold(0.0, |most, x| x.abs().max(most)))
}

/// Crest factor: peak over root mean square. 1 for a square wave, √2 for a sine, above 4 for impacts.
///
/// # Errors
/// Those of [`rms`], and [`Error::Undefined`] for a signal of zeros.
pub fn crest_factor(signal: &[f64]) -> Result<f64> {
    let rms = rms(signal)?;
    if rms == 0.0 {
        return Err(Error::Undefined { quantity: "crest factor", why: "the signal is zero throughout" });
    }
    Ok(peak(signal)? / rms)
}

/// Kurtosis: fourth central moment over the square of the second, both divided by the number of samples.
/// 1.5 for a sine, 3 for Gaussian noise (`scipy.stats.kurtosis(x, fisher=False)`), more for impacts.
///
/// # Errors
/// [`Error::TooShort`] for fewer than two samples, [`Error::NotFinite`] for a bad sample,
/// [`Error::Undefined`] for a constant signal.
pub fn kurtosis(signal: &[f64]) -> Result<f64> {
    check_signal(signal, 2, "a kurtosis")?;
    let mean = average(signal.iter().copied(), signal.len());
    let largest = signal.iter().fold(0.0_f64, |most, x| (x - mean).abs().max(most));
    // The mean of equal values may miss them by rounding, hence both conditions.
    if largest == 0.0 || signal.iter().all(|&x| x == signal[0]) {
        return Err(Error::Undefined { quantity: "kurtosis", why: "the signal is constant" });
    }
    // Deviations relative to the largest: their fourth powers cannot overflow, nor all vanish.
    let moment = |power| average(signal.iter().map(|x| ((x - mean) / largest).powi(power)), signal.len());
    Ok(moment(4) / moment(2).powi(2))
}

fn average(values: impl Iterator<Item = f64>, count: usize) -> f64 {
    values.sum::<f64>() / count as f64
}
