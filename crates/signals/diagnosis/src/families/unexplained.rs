//! A comb that strikes and is no family's: slip, speed or bearing differ from those given.
//!
//! A claim rests on the place of a comb. Where a comb that belongs to nothing in the bearing stands higher
//! than all that do, the places are wrong, and a lower comb at one of them is chance or a sideband.

use serde::Serialize;
use stribeck_dsp::{BandEnvelope, Comb, CombTest, Whitened};

use crate::families::limits::{ALPHA, IMPACT, decibel};
use crate::families::machine_lines::OwnLines;
use crate::quantities;

quantities! {
    /// The highest comb that nothing in the bearing accounts for.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize)]
    pub struct Unexplained {
        /// Its fundamental [Hz].
        pub hz: f64,
        /// The same over the frequency of the shaft.
        pub order: f64,
        /// Height of its fourth highest harmonic of five above the background [dB].
        pub height_db: f64,
        /// Band in which it stands highest [Hz].
        pub band_hz: (f64, f64),
    }
}

/// A comb and where it stands highest.
#[derive(Debug)]
pub(crate) struct UnexplainedComb {
    pub(crate) band: usize,
    pub(crate) band_hz: (f64, f64),
    pub(crate) comb: Comb,
    pub(crate) depth: f64,
    /// Bands and frequencies that were searched.
    pub(crate) searched: f64,
    /// The bands in which it stands [Hz].
    pub(crate) stands_in_hz: Vec<(f64, f64)>,
}

/// A family that is there, and may account for lines beside its own.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AboveNoise {
    /// Its comb [Hz].
    pub(crate) comb_hz: f64,
    /// Ends of the place in which it was looked for [Hz].
    pub(crate) low_hz: f64,
    pub(crate) high_hz: f64,
    /// The part turns with the shaft, through the load and past the sensor.
    pub(crate) turns: bool,
    /// Its height over the background.
    pub(crate) height: f64,
}

/// Ends of the search over the frequency of the shaft, and over the highest family.
const FROM: f64 = 1.2;
const TO: f64 = 1.5;
/// Width of a window of the search over its lower end.
const WINDOW: f64 = 0.01;
/// Sidebands of the shaft and of the cage that a family may have, either way.
const BESIDE_SHAFT: i32 = 4;
const BESIDE_CAGE: i32 = 2;
/// A comb that stands higher than a family by this factor, 6 dB, is no part of it.
const FAR_HIGHER: f64 = 4.0;
/// Probability of a false alarm at which such a comb is named.
pub(crate) const NAMED: f64 = 1e-9;

/// The highest comb of each band that is no multiple of the shaft or the cage, no multiple or fraction of a
/// family, no sideband of a higher one, is far beyond noise, and strikes. `of_others` says whether a frequency
/// [Hz] is another bearing's.
pub(crate) fn of_each_band(
    bands: &[(&BandEnvelope, Whitened)],
    own: &OwnLines,
    cage_hz: f64,
    highest_hz: f64,
    families: &[AboveNoise],
    of_others: &dyn Fn(f64) -> bool,
) -> Vec<UnexplainedComb> {
    let (low_hz, high_hz) = (FROM * own.shaft_hz, TO * highest_hz);
    let mut highest: Vec<(usize, Comb)> = Vec::new();
    let mut searched = 0.0;
    for (n, (_, spectrum)) in bands.iter().enumerate() {
        let mut best: Option<Comb> = None;
        let mut from = low_hz;
        while from < high_hz {
            let to = from * (1.0 + WINDOW);
            let found = CombTest::FOUR_OF_FIVE.search(spectrum, from, to);
            from = to;
            let Ok(comb) = found else { break };
            searched += 1.0;
            let leads = best.as_ref().is_none_or(|best| comb.height > best.height);
            if leads && !of_others(comb.fundamental_hz) && !is_explained(&comb, own, cage_hz, families) {
                best = Some(comb);
            }
        }
        highest.extend(best.map(|comb| (n, comb)));
    }
    let striking = highest.into_iter().map(|(band, comb)| {
        let (of, _) = &bands[band];
        let (depth, band_hz) = (of.depth(comb.fundamental_hz), (of.low_hz, of.high_hz));
        UnexplainedComb { band, band_hz, comb, depth, searched, stands_in_hz: Vec::new() }
    });
    let named = striking.filter(|found| found.comb.p_value * searched < NAMED && found.depth >= IMPACT);
    named
        .map(|found| UnexplainedComb { stands_in_hz: standing_in(found.comb.fundamental_hz, bands), ..found })
        .collect()
}

/// The bands in which a comb at `hz` is more than noise [Hz].
fn standing_in(hz: f64, bands: &[(&BandEnvelope, Whitened)]) -> Vec<(f64, f64)> {
    let stands = |(_, spectrum): &&(&BandEnvelope, Whitened)| {
        let (low, high) = (hz - spectrum.grid_hz(), hz + spectrum.grid_hz());
        CombTest::FOUR_OF_FIVE.search(spectrum, low, high).is_ok_and(|comb| comb.p_value < ALPHA)
    };
    bands.iter().filter(stands).map(|(band, _)| (band.low_hz, band.high_hz)).collect()
}

/// Whether shaft, cage or a family that stands higher account for a comb.
fn is_explained(comb: &Comb, own: &OwnLines, cage_hz: f64, families: &[AboveNoise]) -> bool {
    let hz = comb.fundamental_hz;
    let is = |other: f64| (hz - other).abs() < own.width_hz;
    // A comb that is half, a third or twice as wide shares lines with the shaft's.
    // The load on a cage that stands goes round with it: lines beside the shaft's multiples.
    let beside_shaft = own.cage_hz.is_some_and(|cage_hz| {
        (-BESIDE_CAGE..=BESIDE_CAGE).any(|k| own.is_of_shaft(hz + f64::from(k) * cage_hz))
    });
    let near_shaft =
        (1..=3).any(|q| own.is_of_shaft(f64::from(q) * hz)) || own.is_of_cage(hz) || beside_shaft;
    near_shaft
        || families.iter().any(|family| {
            let f = family.comb_hz;
            // A multiple or an even part of a family is the family's, however high it stands. A family whose
            // place ends beside the comb has its flank; two that share some lines may be parts of each other:
            // the comb is the family's unless it stands far higher.
            let is_lower = comb.height < FAR_HIGHER * family.height;
            let is_same = is(f) && ((family.low_hz..=family.high_hz).contains(&hz) || is_lower);
            let part = (2..=5).any(|n| is(f * f64::from(n)) || is(f / f64::from(n)));
            let shared = (2..=5).any(|q| (2..=5).any(|p| p != q && is(f * f64::from(p) / f64::from(q))));
            let fraction = is_same || part || (shared && is_lower);
            // The first sidebands of a raceway that turns may stand higher than its own line.
            let turned = family.turns && [-1.0, 1.0].iter().any(|k| is(f + k * own.shaft_hz));
            let by_shaft = (-BESIDE_SHAFT..=BESIDE_SHAFT)
                .any(|k| (1..=2).any(|m| is(f64::from(m) * f + f64::from(k) * own.shaft_hz)));
            let by_cage = (-BESIDE_CAGE..=BESIDE_CAGE)
                .any(|k| (1..=2).any(|m| is(f64::from(m) * f + f64::from(k) * cage_hz)));
            fraction || (turned && is_lower) || (family.height >= comb.height && (by_shaft || by_cage))
        })
}

impl UnexplainedComb {
    /// Whether it stands in a band.
    pub(crate) fn is_in(&self, band_hz: Option<(f64, f64)>) -> bool {
        self.stands_in_hz.iter().any(|stands_hz| Some(*stands_hz) == band_hz)
    }

    /// As it is reported.
    pub(crate) fn report(&self, shaft_hz: f64) -> Unexplained {
        let hz = self.comb.fundamental_hz;
        Unexplained { hz, order: hz / shaft_hz, height_db: decibel(self.comb.height), band_hz: self.band_hz }
    }

    /// Probability that noise makes such a comb anywhere in the search; an upper bound.
    pub(crate) fn p_value(&self) -> f64 {
        (self.comb.p_value * self.searched).min(ALPHA)
    }
}
