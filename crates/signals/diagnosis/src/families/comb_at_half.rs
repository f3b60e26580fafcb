//! A comb at half the frequency of a raceway: the raceway's lines are its even ones, and the source strikes
//! half as often as elements pass.

use stribeck_dsp::{BandEnvelope, Comb, CombTest, Whitened};

use crate::families::limits::decibel;
use crate::families::machine_lines::OwnLines;
use crate::families::unexplained::Unexplained;

/// An odd line of a comb at half the frequency over the even ones beside it, in power. Impacts of 1 + m and
/// 1 − m in turn have (2m/(1 + m²))²; from 0.5 on the weaker ones have two fifths of the others' amplitude at
/// most.
const AS_HIGH: f64 = 0.5;

/// The comb at half the frequency of another one, where four of its first five odd lines are about as high as
/// the even ones beside them. Lines of the machine itself (`own`) are no evidence of it.
pub(crate) fn comb_at_half(
    comb: &Comb,
    (band, spectrum): &(&BandEnvelope, Whitened),
    own: &OwnLines,
) -> Option<Unexplained> {
    let half_hz = 0.5 * comb.fundamental_hz;
    let stands = |n: &usize| {
        let hz = (2 * n + 1) as f64 * half_hz;
        let [before, behind] = [comb.ratios[n.saturating_sub(1)], comb.ratios[*n]];
        !own.holds(hz) && spectrum.at(hz) >= AS_HIGH * (before * behind).sqrt()
    };
    let standing = (0..comb.ratios.len()).filter(stands).count();
    (standing >= CombTest::FOUR_OF_FIVE.needed).then(|| Unexplained {
        hz: half_hz,
        order: half_hz / own.shaft_hz,
        height_db: decibel(comb.height),
        band_hz: (band.low_hz, band.high_hz),
    })
}
