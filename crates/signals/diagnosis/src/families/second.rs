//! Is there a second defect beside the family that stands highest?
//!
//! Sidebands of the first family are its own, and stand as high as many a second defect. What modulates it is
//! a factor of its power, and a second defect is a term beside it: over the mean course of the power in a
//! period of the first family, the factor is left at the frequency of the shaft or of the cage, and the term
//! keeps its lines (THEORY §7.9).

use stribeck_dsp::{BandEnvelope, Comb, CombTest, Whitened};

use crate::families::controls::rank;
use crate::families::family::Family;
use crate::families::limits::{ALPHA, IMPACT, decibel};
use crate::families::sidebands::is_modulated;
use crate::families::unrelated::SLIP;
use crate::families::verdict::FirstDefect;
use crate::{Defect, Reason};

/// Where a family has the strongest impacts over the period of the first.
struct Beside {
    at: usize,
    comb: Comb,
    p_value: f64,
    depth: f64,
    band_hz: (f64, f64),
}

/// The families with a second claim: of the one that stands highest in `bands`, those over the period of the
/// first family, if it passes there; `whole` is the whole range as it is.
pub(crate) fn with_second(
    families: Vec<Family>,
    first: &FirstDefect,
    whole: Option<&BandEnvelope>,
    bands: &[BandEnvelope],
) -> Vec<Family> {
    let whitened: Vec<(&BandEnvelope, Whitened)> = bands
        .iter()
        .filter_map(|b| Some((b, Whitened::new(&b.values, b.grid_hz, b.segments).ok()?)))
        .collect();
    let asked = families.iter().enumerate().filter(|(at, family)| {
        // A family that was not looked for is not there, either.
        *at != first.at
            && family.name != Defect::Ftf
            && family.band_hz.is_some()
            && family.not_told_apart_from.is_none()
    });
    let passing = asked.filter_map(|(at, family)| beside(at, family, first, whole, &whitened));
    let Some(second) = passing.max_by(|a, b| a.comb.height.total_cmp(&b.comb.height)) else {
        return families;
    };
    let over = families[first.at].name;
    let claim =
        |(at, family): (usize, Family)| if at == second.at { second.claim(family, over) } else { family };
    families.into_iter().enumerate().map(claim).collect()
}

impl Beside {
    /// The family as it stands beside the first one.
    fn claim(&self, family: Family, over: Defect) -> Family {
        Family {
            measured_hz: Some(self.comb.fundamental_hz / family.name.shocks_per_period()),
            level_db: Some(decibel(self.comb.ratios[0])),
            noise_p_value: self.p_value,
            rank: Some(0.0),
            depth: Some(self.depth),
            depth_band_hz: Some(self.band_hz),
            band_hz: Some(self.band_hz),
            over: Some(over),
            claimed: true,
            reason: Reason::Decided(format!(
                "with the mean course in a period of {over} divided out of the power its lines stand out, no \
                 comb at another spacing stands as high, and its power varies by {:.0} % of its mean",
                100.0 * self.depth
            )),
            ..family
        }
        .calibrated()
    }
}

/// A family that passes in the band in which its power is modulated most, of those in which it is more than
/// noise: normalised by the first family, the power of bands is not comparable.
fn beside(
    at: usize,
    family: &Family,
    first: &FirstDefect,
    whole: Option<&BandEnvelope>,
    bands: &[(&BandEnvelope, Whitened)],
) -> Option<Beside> {
    let comb_hz = family.name.shocks_per_period() * family.expected_hz;
    let search = |spectrum: &Whitened, hz: f64| {
        CombTest::FOUR_OF_FIVE.search(spectrum, (1.0 - SLIP) * hz, (1.0 + SLIP) * hz).ok()
    };
    let found: Vec<(usize, Comb)> = bands
        .iter()
        .enumerate()
        .filter_map(|(n, (_, spectrum))| Some((n, search(spectrum, comb_hz)?)))
        .collect();
    let searched = found.len() as f64;
    let there = found.into_iter().filter(|(_, comb)| comb.p_value * searched < ALPHA);
    let deep = there.map(|(n, comb)| (n, bands[n].0.depth(comb.fundamental_hz), comb));
    let (n, depth, comb) = deep.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let (band, spectrum) = &bands[n];
    let remains = search(spectrum, first.comb_hz).map_or(0.0, |left| left.height);
    let own = match family.name {
        // A spot on an element comes under the load once a turn of the cage.
        Defect::Bsf => {
            is_modulated(spectrum, comb.fundamental_hz, first.cage_hz)
                && !first.has_sideband(comb.fundamental_hz)
        }
        // Healthy elements pass as well, and may dominate once the louder family is removed: a second defect
        // must therefore impact in the whole range.
        Defect::Bpfo => {
            let loud = whole.is_some_and(|whole| whole.depth(comb.fundamental_hz) >= IMPACT);
            family.is_there() && loud && !first.takes(comb.fundamental_hz)
        }
        Defect::Bpfi | Defect::Ftf => !first.takes(comb.fundamental_hz),
    };
    let passes = depth >= IMPACT
        && own
        && remains < comb.height
        && rank(&comb, comb_hz, spectrum, Some(first.comb_hz), None) == Some(0.0);
    passes.then_some(Beside {
        at,
        p_value: comb.p_value * searched,
        comb,
        depth,
        band_hz: (band.low_hz, band.high_hz),
    })
}

/// Lines within which two frequencies are one, each by its own comb.
const SAME_LINES: f64 = 2.0;
/// Sidebands of the shaft that a first family may have, either way.
const SIDEBANDS: i32 = 3;

impl FirstDefect {
    /// Whether `hz` is a sideband of the first family at the distance of the shaft.
    fn has_sideband(&self, hz: f64) -> bool {
        let beside = |k: i32| {
            (hz - self.comb_hz - f64::from(k) * self.shaft_hz).abs() < SAME_LINES * self.resolution_hz
        };
        (-SIDEBANDS..=SIDEBANDS).any(beside)
    }

    /// Whether `hz` is a multiple of the shaft's frequency.
    fn takes(&self, hz: f64) -> bool {
        let turns = (hz / self.shaft_hz).round();
        (hz - turns * self.shaft_hz).abs() < self.resolution_hz
    }
}
