//! The band of a spectrum with most of a signal's power.

use stribeck_dsp::Spectrum;

/// Parts that a spectrum is cut into.
const PARTS: usize = 25;
/// A neighbour belongs to the band as long as its power is at least this share of the strongest part's.
const SHARE: f64 = 0.25;

/// The band about the strongest part of a density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoudestBand {
    /// Its ends [Hz].
    pub band_hz: (f64, f64),
    /// Root mean square in it, in the signal's unit.
    pub rms: f64,
    /// Root mean square of the whole spectrum.
    pub total_rms: f64,
}

/// Finds it: of 25 equal parts up to half the sampling rate the strongest, with the neighbours that hold at
/// least a quarter of its power. `None` for an empty or zero spectrum, or one that is not a density.
pub fn loudest(density: &Spectrum) -> Option<LoudestBand> {
    let part_hz = 0.5 * density.sample_rate_hz() / PARTS as f64;
    let edge = |n: usize| n as f64 * part_hz;
    let rms = |from: usize, to: usize| density.band_rms(edge(from), edge(to)).ok();
    let powers: Vec<f64> = (0..PARTS).map(|n| rms(n, n + 1).map(|r| r * r)).collect::<Option<_>>()?;
    let (strongest, &most) = powers.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    if most <= 0.0 {
        return None;
    }
    let belongs = |n: &usize| powers[*n] >= SHARE * most;
    let from = (0..strongest).rev().take_while(belongs).last().unwrap_or(strongest);
    let to = 1 + (strongest + 1..PARTS).take_while(belongs).last().unwrap_or(strongest);
    Some(LoudestBand { band_hz: (edge(from), edge(to)), rms: rms(from, to)?, total_rms: rms(0, PARTS)? })
}
