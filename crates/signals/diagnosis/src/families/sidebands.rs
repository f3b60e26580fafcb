//! Sidebands of a family at the distance of the cage's frequency: they distinguish a spot on a rolling
//! element, which strikes only while the cage carries it through the load zone.

use stribeck_dsp::{BandEnvelope, Whitened};

use crate::Defect;
use crate::families::family::Family;
use crate::families::limits::ALPHA;
use crate::families::unrelated::UNRELATED_SPACINGS;

/// Harmonics whose sidebands are looked for, and how many of both sides of all make a family modulated.
const HARMONICS: usize = 3;
const MODULATED: usize = 3;

/// Lines by which sidebands of two spacings must differ to be others.
const OTHER_LINES: f64 = 2.0;

/// Number of sidebands above the noise, of the six beside the first three harmonics of a family.
pub fn sidebands_seen(spectrum: &Whitened, fundamental_hz: f64, spacing_hz: f64) -> usize {
    let beside =
        (1..=HARMONICS).flat_map(|n| [-1.0, 1.0].map(|side| n as f64 * fundamental_hz + side * spacing_hz));
    beside.filter(|hz| spectrum.line_p_value(spectrum.at(*hz)) < ALPHA).count()
}

/// Whether the shocks at twice BSF are modulated at the cage's frequency, as those of a spot on a rolling
/// element must be.
pub(crate) fn is_modulated_by_the_cage(families: &[Family], bands: &[(&BandEnvelope, Whitened)]) -> bool {
    let of = |name: Defect| families.iter().find(|family| family.name == name);
    let (Some(element), Some(cage)) = (of(Defect::Bsf), of(Defect::Ftf)) else { return false };
    let Some(hz) = element.measured_hz else { return false };
    let band = bands.iter().find(|(band, _)| element.band_hz == Some((band.low_hz, band.high_hz)));
    let spacing_hz = cage.measured_hz.unwrap_or(cage.expected_hz);
    band.is_some_and(|(_, spectrum)| is_modulated(spectrum, 2.0 * hz, spacing_hz))
}

/// Whether a comb has sidebands at a spacing [Hz], and more of them than at any unrelated one: beside a comb
/// that is another part's, lines stand at any.
pub(crate) fn is_modulated(spectrum: &Whitened, comb_hz: f64, spacing_hz: f64) -> bool {
    let seen = sidebands_seen(spectrum, comb_hz, spacing_hz);
    let mut others = UNRELATED_SPACINGS
        .iter()
        .filter(|part| (*part - 1.0).abs() * spacing_hz > OTHER_LINES * spectrum.grid_hz());
    seen >= MODULATED && others.all(|part| sidebands_seen(spectrum, comb_hz, part * spacing_hz) < seen)
}
