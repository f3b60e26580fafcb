//! Knocks of a rolling element that lose their phase with every turn of the cage.
//!
//! Beyond the load little drives the spin of an element, so it comes back under the load at any angle: its family has no lines.
//! What is left is the cage's rhythm, and within a passage the time of half a spin between two knocks (THEORY §7.9).

use stribeck_dsp::{Autocorrelation, BandEnvelope};

use super::Family;
use super::verdict::{SLIP, unrelated_hz};

/// Knocks of a passage after the first one that must keep the rhythm.
const REPEATS: usize = 3;
/// Steps in which a rhythm is looked for between its ends.
const STEPS: usize = 16;

/// Where something knocks once a turn of the cage and no other family is there, names a rolling element that knocks twice a spin, by
/// the whole range or by the band in which the cage stands highest.
pub(super) fn tell_the_element(families: &mut [Family], bands: &[BandEnvelope]) {
    let place = |name: &str| families.iter().position(|family| family.name == name);
    let (Some(element), Some(cage)) = (place("BSF"), place("FTF")) else { return };
    // A spot on a rolling element meets both raceways in a turn.
    let knocks_hz = 2.0 * families[element].expected_hz;
    let is_taken = |f: &Family| f.is_there() && (f.expected_hz / knocks_hz - 1.0).abs() < 2.25 * SLIP;
    if !families[cage].claimed || families.iter().any(is_taken) {
        return;
    }
    let whole = bands.first();
    let highest = bands.iter().find(|band| families[cage].band_hz == Some((band.low_hz, band.high_hz)));
    let heard =
        [whole, highest].into_iter().flatten().find_map(|band| Some((band, rhythm(band, knocks_hz)?)));
    let Some((band, hz)) = heard else { return };
    let (low, high) = (band.low_hz, band.high_hz);
    let family = &mut families[element];
    family.measured_hz = Some(0.5 * hz);
    family.band_hz = Some((low, high));
    family.in_passages = true;
    family.claimed = true;
    family.reason = format!(
        "something knocks once a turn of the cage, and as it passes at {hz:.1} Hz, twice the spin of an element, which no unrelated rhythm \
         does as much; from turn to turn it loses its phase, so that it has no lines"
    );
    let cage = &mut families[cage];
    cage.claimed = false;
    "it is there, as the rhythm in which one rolling element passes under the load"
        .clone_into(&mut cage.reason);
}

/// The frequency within slip of `knocks_hz` at which knocks repeat most, if they do so more than at any unrelated one.
fn rhythm(band: &BandEnvelope, knocks_hz: f64) -> Option<f64> {
    let correlation = band.autocorrelation().ok()?;
    let (height, hz) = highest(&correlation, knocks_hz)?;
    let others: Vec<f64> =
        unrelated_hz(knocks_hz).filter_map(|hz| Some(highest(&correlation, hz)?.0)).collect();
    (!others.is_empty() && height > 0.0 && others.iter().all(|other| *other < height)).then_some(hz)
}

/// How much a rhythm within slip of `hz` repeats, and its frequency [Hz].
fn highest(correlation: &Autocorrelation, hz: f64) -> Option<(f64, f64)> {
    let tried = (0..=STEPS).map(|n| hz * (1.0 - SLIP + 2.0 * SLIP * n as f64 / STEPS as f64));
    let heights = tried.filter_map(|hz| {
        let after: Option<f64> = (1..=REPEATS).map(|n| correlation.at(n as f64 / hz)).sum();
        Some((after? / REPEATS as f64, hz))
    });
    heights.max_by(|a, b| a.0.total_cmp(&b.0))
}
