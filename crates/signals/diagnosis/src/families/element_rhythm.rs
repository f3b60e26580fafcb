//! Impacts of a rolling element that lose their phase with every turn of the cage.
//!
//! Beyond the load little drives the spin of an element, so it comes back under the load at any angle: its
//! family has no lines. The record shows the cage's rhythm, and within a passage the time of half a spin
//! between two impacts (THEORY §7.9).

use stribeck_dsp::{Autocorrelation, BandEnvelope};

use crate::families::unrelated::{SLIP, unrelated_hz};

/// Impacts of a passage after the first one that must be periodic.
const REPEATS: usize = 3;
/// Steps of the search over the range of slip.
const STEPS: usize = 16;

/// The frequency within slip of `impacts_hz` at which the envelope repeats most, if it does so more than at
/// any unrelated one [Hz].
pub(crate) fn repeating_hz(band: &BandEnvelope, impacts_hz: f64) -> Option<f64> {
    let correlation = band.autocorrelation().ok()?;
    let (height, hz) = highest(&correlation, impacts_hz)?;
    let mut others = unrelated_hz(impacts_hz).filter_map(|hz| Some(highest(&correlation, hz)?.0)).peekable();
    (others.peek().is_some() && height > 0.0 && others.all(|other| other < height)).then_some(hz)
}

/// Largest correlation of the envelope at a rhythm within slip of `hz`, and its frequency [Hz].
fn highest(correlation: &Autocorrelation, hz: f64) -> Option<(f64, f64)> {
    let tried = (0..=STEPS).map(|n| hz * (1.0 - SLIP + 2.0 * SLIP * n as f64 / STEPS as f64));
    let heights = tried.filter_map(|hz| {
        let after: Option<f64> = (1..=REPEATS).map(|n| correlation.at(n as f64 / hz)).sum();
        Some((after? / REPEATS as f64, hz))
    });
    heights.max_by(|a, b| a.0.total_cmp(&b.0))
}
