//! The power of the test: how strong impacts of a family must be for this record to show them.
//!
//! Impacts that ring as the record does in a band add the part r of its power. Lines of the squared envelope are
//! then modulated by 2r/(1 + r), less at the harmonics that a ring lasts too long for, and noise by noise and
//! impact makes their background 1 + 2r of what it was. The least r with which the comb passes the rules for
//! noise, unrelated combs and depth is what the band could have shown (THEORY §7.9).

use std::f64::consts::PI;

use serde::Serialize;
use stribeck_dsp::{BandEnvelope, CombTest, Whitened};

use crate::families::candidate::{LINES_TO_HZ, SLOW_HZ};
use crate::families::controls::controls;
use crate::families::family::{Family, SOUND_DEPTHS};
use crate::families::limits::{ALPHA, IMPACT};
use crate::families::machine_lines::OwnLines;
use crate::families::unrelated::SLIP;
use crate::record::bands::LOWEST;
use crate::record::pass::Record;
use crate::{Defect, quantities};

quantities! {
    /// The weakest impacts that a record would have shown.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize)]
    pub struct Limit {
        /// Their peak in the band [unit of the channel].
        pub peak: f64,
        /// The same over the root mean square of the record.
        pub over_rms: f64,
        /// The band [Hz].
        pub band_hz: (f64, f64),
    }
}

/// Mean power over that of the strongest impacts: those of a place that turns through the load come and go, as
/// (1 + cos)/2 of the amplitude.
fn mean_power(name: Defect) -> f64 {
    if name == Defect::Bpfo { 1.0 } else { 0.375 }
}

/// Power from which impacts are claimed, over that of the closed form: by injection into eleven healthy records of six
/// rigs these are claimed 0 to 3 dB above it, those that come and go 0 to 6 dB.
fn margin(name: Defect) -> f64 {
    if name == Defect::Bpfo { 1.4 } else { 2.0 }
}

/// Power of a harmonic that lies between two lines, of which the higher counts.
const BETWEEN_LINES: f64 = 0.8;

/// A family with the impacts that the record would have shown, and those that it shows.
pub(crate) fn with_power(
    family: Family,
    bands: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
    record: &Record,
) -> Family {
    let comb_hz = family.name.shocks_per_period() * family.expected_hz;
    let limit = limit(family.name, comb_hz, bands, own, record);
    let shown_over_rms = shown_over_rms(&family, comb_hz, bands, record);
    Family { limit, shown_over_rms, ..family }
}

/// Eighths of the range in which the end of the sensor's band, or of a filter's, is sought.
const EIGHTHS: u32 = 8;
/// By how much the density falls from one eighth to the next at such an end [dB]. Chosen while looking at all measured
/// records at hand: machines alone reach 21, anti-aliasing filters of CWRU 26 to 29.
const CUT_DB: f64 = 24.0;

/// Where the record ends: beyond, a filter, the sensor or interpolation has taken impacts away as it has all else, and that
/// they would stand there above next to nothing says nothing [Hz].
fn end_hz((hz, density): &(Vec<f64>, Vec<f64>)) -> f64 {
    let highest_hz = hz.last().copied().unwrap_or(0.0);
    let end = |n: u32| highest_hz * f64::from(n) / f64::from(EIGHTHS);
    let median_db = |n: u32| {
        let low_hz = end(n).max(LOWEST * highest_hz);
        let inside = hz.iter().zip(density).filter(|(hz, _)| (low_hz..end(n + 1)).contains(*hz));
        let mut inside: Vec<f64> = inside.map(|(_, s)| *s).collect();
        inside.sort_by(f64::total_cmp);
        10.0 * inside.get(inside.len() / 2).copied().unwrap_or(0.0).log10()
    };
    let cut = (1..EIGHTHS).find(|n| median_db(n - 1) - median_db(*n) > CUT_DB);
    cut.map_or(f64::INFINITY, end)
}

/// The least impacts of a family that any band could have shown.
fn limit(
    name: Defect,
    comb_hz: f64,
    bands: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
    record: &Record,
) -> Option<Limit> {
    let of = |(band, spectrum): &(&BandEnvelope, Whitened)| {
        let ring_s = ring_s(&record.density, band).min(0.25 / comb_hz);
        let tried = CombTest::FOUR_OF_FIVE.candidates(spectrum, 2.0 * SLIP * comb_hz);
        let searched = bands.len() as f64 * tried;
        let added = least_added(spectrum, band, comb_hz, (ring_s, searched), own)?;
        let power = 2.0 * band.rms.powi(2) * added * margin(name);
        let peak = (2.0 * power / (comb_hz * ring_s * mean_power(name))).sqrt();
        Some(Limit { peak, over_rms: peak / record.health.rms, band_hz: (band.low_hz, band.high_hz) })
    };
    let end_hz = end_hz(&record.density);
    // Bands begin at eighths, but for rounding.
    bands
        .iter()
        .filter(|(band, _)| band.low_hz < 0.99 * end_hz)
        .filter_map(of)
        .min_by(|a, b| a.peak.total_cmp(&b.peak))
}

/// Peak of the impacts that modulate a band as deeply as a family does, over the root mean square of the record.
fn shown_over_rms(
    family: &Family,
    comb_hz: f64,
    bands: &[(&BandEnvelope, Whitened)],
    record: &Record,
) -> Option<f64> {
    let (band, _) = bands.iter().find(|(b, _)| family.depth_band_hz == Some((b.low_hz, b.high_hz)))?;
    let ring_s = ring_s(&record.density, band).min(0.25 / comb_hz);
    let swing = 2.0 / (1.0 + (PI * comb_hz * ring_s).powi(2)).sqrt();
    // Short impacts alone are as deep as that: nine tenths of the power are then theirs.
    let part = (family.depth? / swing).min(0.9);
    let power = 2.0 * band.rms.powi(2) * part;
    Some((2.0 * power / (comb_hz * ring_s * mean_power(family.name))).sqrt() / record.health.rms)
}

/// How long the record rings in a band [s]: one over its equivalent width, which is the decay time of the one
/// resonance whose spectrum is as wide.
fn ring_s((hz, density): &(Vec<f64>, Vec<f64>), band: &BandEnvelope) -> f64 {
    let inside = hz.iter().zip(density).filter(|(hz, _)| (band.low_hz..band.high_hz).contains(*hz));
    let (sum, squares) = inside.fold((0.0, 0.0), |(sum, squares), (_, s)| (sum + s, squares + s * s));
    let step_hz = hz.get(1).copied().unwrap_or(f64::NAN);
    let width_hz = sum * sum * step_hz / squares;
    if width_hz > 0.0 { 1.0 / width_hz } else { 1.0 / (band.high_hz - band.low_hz) }
}

/// The least power, over that of the band, with which impacts pass the rules there.
fn least_added(
    spectrum: &Whitened,
    band: &BandEnvelope,
    comb_hz: f64,
    (ring_s, searched): (f64, f64),
    own: &OwnLines,
) -> Option<f64> {
    let CombTest { harmonics, needed } = CombTest::FOUR_OF_FIVE;
    let swing = |n: usize| 1.0 / (1.0 + (PI * n as f64 * comb_hz * ring_s).powi(2)).sqrt();
    let depth = IMPACT.max(-ALPHA.ln() / SOUND_DEPTHS);
    let lines = if comb_hz < SLOW_HZ { (LINES_TO_HZ / comb_hz) as usize } else { 1 };
    let of_lines = (1..=lines).map(|n| swing(n).powi(2)).sum::<f64>().sqrt();
    let by_depth = depth / (2.0 * of_lines - depth);
    let asked = CombTest::FOUR_OF_FIVE.search(spectrum, comb_hz, comb_hz).ok()?;
    let unrelated = controls(&asked, comb_hz, spectrum, None, Some(own));
    let highest =
        unrelated.iter().map(|comb| comb.height).fold(height_above_noise(spectrum, searched), f64::max);
    let mut by_harmonic: Vec<f64> = (1..=harmonics)
        .filter_map(|n| {
            let at = (n as f64 * comb_hz / spectrum.grid_hz()).round() as usize;
            let background =
                band.values.get(at)? / spectrum.ratios().get(at).filter(|ratio| **ratio > 0.0)?;
            let needed = highest * background / (2.0 * BETWEEN_LINES * swing(n).powi(2));
            Some(needed + (needed * needed + needed).sqrt())
        })
        .collect();
    by_harmonic.sort_by(f64::total_cmp);
    let by_comb = by_harmonic.get(needed - 1)?;
    (by_depth > 0.0).then_some(by_depth.max(*by_comb))
}

/// The height that noise reaches in one of `searched` combs with a probability of [`ALPHA`].
fn height_above_noise(spectrum: &Whitened, searched: f64) -> f64 {
    let CombTest { harmonics, needed } = CombTest::FOUR_OF_FIVE;
    let line = (ALPHA / (searched * harmonics as f64)).powf(1.0 / needed as f64) / 2.0;
    let (mut low, mut high) = (0.0, 100.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if spectrum.line_p_value(middle) > line { low = middle } else { high = middle }
    }
    high
}
