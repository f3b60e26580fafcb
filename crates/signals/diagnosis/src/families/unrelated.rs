//! Frequencies unrelated to a family's: whatever stands there is chance.

/// Slip that moves a family from its place, either way.
pub(crate) const SLIP: f64 = 0.02;
/// Frequencies tried, from 0.4 to 2.5 times that of the family.
const CONTROLS: usize = 160;
/// Two frequencies are one when they differ by less than this part: both may slip.
const SAME: f64 = 2.25 * SLIP;

/// Spacings of sidebands over that of the cage at which no part of a bearing has any.
pub(crate) const UNRELATED_SPACINGS: [f64; 8] = [0.6, 0.7, 0.8, 0.9, 1.1, 1.2, 1.3, 1.4];

/// Fundamentals [Hz] that share no line with `hz`, with slip.
pub(crate) fn unrelated_hz(hz: f64) -> impl Iterator<Item = f64> {
    let ratios = (0..CONTROLS).map(|n| 0.4 * 6.25_f64.powf(n as f64 / (CONTROLS - 1) as f64));
    ratios.map(move |ratio| ratio * hz).filter(move |other| {
        let mut fractions = (1..=5).flat_map(|p| (1..=5).map(move |q| f64::from(p) / f64::from(q)));
        !fractions.any(|fraction| is_the_same(*other, fraction * hz))
    })
}

/// Whether slip alone may keep two frequencies apart.
pub(crate) fn is_the_same(a_hz: f64, b_hz: f64) -> bool {
    (a_hz / b_hz - 1.0).abs() < SAME
}
