//! What a record lets one conclude of raceways, rolling elements and cage, and what it could have shown.
//!
//! No claim is not yet "no defect": that is said where impacts as strong as a spall makes would have been claimed
//! and nothing at the place of a raceway comes near (THEORY §7.9).

use serde::{Deserialize, Serialize};

use crate::families::family::Family;
use crate::families::power::Limit;
use crate::families::unexplained::Unexplained;
use crate::{Defect, quantities};

/// The conclusion on a part of the bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// It is damaged.
    Defect,
    /// Impacts above the limit would have been claimed, and nothing comes near.
    NoDefect,
    /// It may be damaged or not.
    CannotTell,
    /// The samples are not those of the machine.
    NoSignal,
}

quantities! {
    /// The conclusion on a part of the bearing, and its power.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct Concluded {
        /// The conclusion: `defect`, `no_defect`, `cannot_tell` or `no_signal`.
        pub answer: Answer,
        /// Peak of the weakest impacts that the record would have shown [unit of the channel]; `null` where it
        /// could show none.
        pub limit: Option<f64>,
        /// The same over the root mean square of the record.
        pub limit_over_rms: Option<f64>,
        /// Band in which they would have been seen [Hz].
        pub limit_band_hz: Option<(f64, f64)>,
        /// Share of measured damaged bearings of which the damage of this part is found; `null` where none was
        /// measured.
        pub share: Option<f64>,
    }
}

quantities! {
    /// The conclusion on a bearing.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct Conclusion {
        /// Outer and inner raceway.
        pub raceways: Concluded,
        /// The rolling elements.
        pub elements: Concluded,
        /// The cage.
        pub cage: Concluded,
    }
}

/// Share of damaged raceways, and of damaged rolling elements, that is found on measured records on which no threshold was
/// chosen: the quoted part of docs/results/verdicts.csv, against which a test of the studies holds them.
pub const FOUND: [f64; 2] = [0.78, 0.2];

/// Modulation, and height above unrelated combs [dB], from which a raceway is too near to a claim for "no
/// defect": chosen while looking at all measured records at hand, the five damaged raceways that stay silent among
/// them; of 37 healthy records of four rigs none comes so near. Other records have not been tried.
const NEAR: (f64, f64) = (0.25, 5.0);

/// Weakest impacts that a record must be able to show for "no defect", over its root mean square: about four in five of
/// the 74 measured damaged raceways that are found exceed it. Healthy records of IMS reach 1.78.
pub const OF_A_SPALL: f64 = 2.0;

/// Why a record cannot tell whether a raceway is damaged, beside what its families say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Doubt {
    /// The samples are spoilt.
    Samples,
    /// The speed was sought in the record.
    SoughtSpeed,
    /// It holds few turns of the shaft.
    Short,
}

/// Turns of the shaft with which a record can show that a raceway is whole.
pub(crate) const LEAST_TURNS: f64 = 20.0;

impl Doubt {
    /// Of a record of `turns` turns.
    pub(crate) fn of(is_spoilt: bool, is_sought: bool, turns: f64) -> Option<Self> {
        let all =
            [(is_spoilt, Self::Samples), (is_sought, Self::SoughtSpeed), (turns < LEAST_TURNS, Self::Short)];
        all.into_iter().find(|(applies, _)| *applies).map(|(_, doubt)| doubt)
    }
}

/// Why "no defect" of a raceway is not said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Open<'a> {
    Doubt(Doubt),
    /// Another part is claimed, or something strikes.
    Impacts,
    /// A raceway was not looked for.
    NotLookedFor(&'a Family),
    /// A raceway stands out, and less than would be claimed.
    Near(&'a Family),
    /// The record shows strong impacts only.
    Weak(Option<Limit>),
}

/// The raceways of a bearing.
fn raceways(families: &[Family]) -> impl Iterator<Item = &Family> {
    families.iter().filter(|f| matches!(f.name, Defect::Bpfo | Defect::Bpfi))
}

/// The larger limit of both raceways; `None` where one of them has none.
fn limit_of_raceways(families: &[Family]) -> Option<Limit> {
    let limits: Option<Vec<Limit>> = raceways(families).map(|f| f.limit).collect();
    limits?.into_iter().max_by(|a, b| a.peak.total_cmp(&b.peak))
}

/// All that keeps a record from showing that no raceway is damaged, what is said first in front; nothing where it shows
/// that.
pub(crate) fn open<'a>(
    families: &'a [Family],
    unexplained: Option<&Unexplained>,
    doubt: Option<Doubt>,
) -> Vec<Open<'a>> {
    let near = |f: &&Family| {
        let above_db = f.above_unrelated_db().unwrap_or(f64::NEG_INFINITY);
        f.is_there() && f.depth.is_some_and(|depth| depth >= NEAR.0) && above_db >= NEAR.1
    };
    let limit = limit_of_raceways(families);
    let strikes = unexplained.is_some() || families.iter().any(|f| f.claimed || f.has_impacts());
    let nearest = raceways(families).filter(near).max_by(|a, b| a.height_db.total_cmp(&b.height_db));
    let all = [
        doubt.map(Open::Doubt),
        strikes.then_some(Open::Impacts),
        raceways(families).find(|f| f.band_hz.is_none()).map(Open::NotLookedFor),
        nearest.map(Open::Near),
        limit.is_none_or(|limit| limit.over_rms > OF_A_SPALL).then_some(Open::Weak(limit)),
    ];
    all.into_iter().flatten().collect()
}

impl Open<'_> {
    /// Name of the rule.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Doubt(Doubt::Samples) => "damaged samples",
            Self::Doubt(Doubt::SoughtSpeed) => "speed that was sought",
            Self::Doubt(Doubt::Short) => "fewer than 20 turns",
            Self::Impacts => "other impacts",
            Self::NotLookedFor(_) => "raceway not looked for",
            Self::Near(_) => "near to a claim",
            Self::Weak(_) => "limit above that of spalls",
        }
    }
}

impl Conclusion {
    /// Of the families of a record after the last rules.
    pub(crate) fn of(families: &[Family], unexplained: Option<&Unexplained>, doubt: Option<Doubt>) -> Self {
        let claimed = |name: Defect| families.iter().any(|f| f.claimed && f.name == name);
        let limit_of = |name: Defect| families.iter().find(|f| f.name == name).and_then(|f| f.limit);
        let unclaimed = if doubt == Some(Doubt::Samples) { Answer::NoSignal } else { Answer::CannotTell };
        let answer = |defect: bool, without: Answer| if defect { Answer::Defect } else { without };
        let of = |answer: Answer, limit: Option<Limit>, share: Option<f64>| Concluded {
            answer,
            limit: limit.map(|limit| limit.peak),
            limit_over_rms: limit.map(|limit| limit.over_rms),
            limit_band_hz: limit.map(|limit| limit.band_hz),
            share,
        };
        let none = open(families, unexplained, doubt).is_empty();
        let raceway = claimed(Defect::Bpfo) || claimed(Defect::Bpfi);
        // Where cage and one element are not distinguished, an element is far likelier.
        let element = claimed(Defect::Bsf) || claimed(Defect::Ftf);
        Self {
            raceways: of(
                answer(raceway, if none { Answer::NoDefect } else { unclaimed }),
                limit_of_raceways(families),
                Some(FOUND[0]),
            ),
            elements: of(answer(element, unclaimed), limit_of(Defect::Bsf), Some(FOUND[1])),
            cage: of(unclaimed, limit_of(Defect::Ftf), None),
        }
    }
}

/// Without families: speed or bearing is not known.
impl Default for Conclusion {
    fn default() -> Self {
        Self::of(&[], None, None)
    }
}
