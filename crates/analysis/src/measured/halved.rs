//! A comb at half the frequency of a raceway: the raceway's lines are its even ones, and the source knocks
//! half as often as elements pass.

use stribeck_dsp::{Comb, CombTest, Whitened};

use super::limits::decibel;
use super::machine_lines::OwnLines;
use super::unexplained::Unexplained;

/// Odd lines of a comb at half the frequency over the even ones, in power. Knocks of 1 + m and 1 − m in turn
/// have (2m/(1 + m²))²; from 0.5 on the weaker ones have two fifths of the others' amplitude at most.
const AS_HIGH: f64 = 0.5;

/// The comb at half the frequency of another one, where its odd lines stand about as high as the even ones.
/// Lines of the machine itself (`own`) are no evidence of it.
pub(super) fn comb_at_half(comb: &Comb, spectrum: &Whitened, own: &OwnLines) -> Option<Unexplained> {
    let CombTest { harmonics, needed } = CombTest::FOUR_OF_FIVE;
    let half_hz = 0.5 * comb.fundamental_hz;
    let odd = (0..harmonics).map(|n| (2 * n + 1) as f64 * half_hz).filter(|hz| !own.holds(*hz));
    let mut heights: Vec<f64> = odd.map(|hz| spectrum.at(hz)).collect();
    heights.sort_by(|a, b| b.total_cmp(a));
    let height = *heights.get(needed - 1)?;
    (height >= AS_HIGH * comb.height).then(|| Unexplained {
        hz: half_hz,
        order: half_hz / own.shaft_hz,
        height_db: decibel(height.max(comb.height)),
    })
}
