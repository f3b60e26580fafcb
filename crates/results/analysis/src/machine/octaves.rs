//! Third octaves of a record, and the distance between two records in them.

use stribeck_dsp::{Welch, WelchOptions};
use stribeck_scene::machine::third_octaves as middles;

use crate::Error;

/// Lowest third octave that is compared [Hz].
const LOWEST_HZ: f64 = 60.0;
/// Length of a segment [s]: the lowest third octave holds five of its lines.
const SEGMENT_S: f64 = 0.5;

/// One third octave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Its middle [Hz].
    pub hz: f64,
    /// Root mean square in it [unit of the signal].
    pub rms: f64,
}

/// The third octaves of a signal from 63 Hz up to `highest_hz`, or to half its rate.
///
/// # Errors
/// [`Error::Signal`] for a signal that is not finite, or shorter than half a second.
pub fn third_octaves(samples: &[f64], rate_hz: f64, highest_hz: f64) -> Result<Vec<Band>, Error> {
    let segment = (SEGMENT_S * rate_hz) as usize;
    let mut welch = Welch::new(rate_hz, samples.len(), &WelchOptions::new(segment)).map_err(Error::Signal)?;
    let spectrum = welch.estimate(samples).map_err(Error::Signal)?;
    let edge = (1.0_f64 / 6.0).exp2();
    middles(LOWEST_HZ, highest_hz.min(0.5 * rate_hz))
        .into_iter()
        .map(|hz| Ok(Band { hz, rms: spectrum.band_rms(hz / edge, hz * edge).map_err(Error::Signal)? }))
        .collect()
}

/// By how much the levels of one record stand above those of another, band by band [dB].
pub fn above_db(ours: &[Band], theirs: &[Band]) -> Vec<f64> {
    ours.iter().zip(theirs).map(|(ours, theirs)| 20.0 * (ours.rms / theirs.rms).log10()).collect()
}

/// Median of the magnitudes; 0 of none.
pub fn median_size(values: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = values.iter().map(|x| x.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let n = sizes.len();
    match n {
        0 => 0.0,
        _ if n % 2 == 1 => sizes[n / 2],
        _ => 0.5 * (sizes[n / 2 - 1] + sizes[n / 2]),
    }
}
