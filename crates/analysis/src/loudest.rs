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

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use stribeck_dsp::Welch;

    /// Two tones: 3 g at 1 kHz and 4 g in two neighbouring parts at 5.9 and 6.1 kHz, sampled at 20 kHz; parts
    /// are 400 Hz wide, and the band's root mean square is that of its two tones.
    #[test]
    fn example_the_band_of_two_tones_beside_a_weaker_one() {
        const RATE_HZ: f64 = 20e3;
        /// The window spreads each tone over neighbouring lines.
        const SPREAD: f64 = 0.01;
        let wave = |g: f64, hz: f64, n: usize| g * (TAU * hz * n as f64 / RATE_HZ).sin();
        let signal: Vec<f64> =
            (0..20_000).map(|n| wave(3.0, 1000.0, n) + wave(4.0, 5900.0, n) + wave(4.0, 6100.0, n)).collect();
        let density = Welch::for_grid(RATE_HZ, signal.len(), 3.0).unwrap().estimate(&signal).unwrap();
        let found = loudest(&density).unwrap();
        assert_eq!(found.band_hz, (5600.0, 6400.0));
        assert!((found.rms - 4.0).abs() < SPREAD, "{}", found.rms);
        assert!((found.total_rms - (16.0_f64 + 4.5).sqrt()).abs() < SPREAD, "{}", found.total_rms);
        let silent = Welch::for_grid(RATE_HZ, 20_000, 3.0).unwrap().estimate(&vec![0.0; 20_000]).unwrap();
        assert_eq!(loudest(&silent), None);
    }
}
