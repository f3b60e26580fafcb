//! A defect family as a record shows it, and why it is called a defect, or not.

use std::fmt;

use serde::{Serialize, Serializer};

use crate::Defect;
use crate::families::controls::MOST_AS_HIGH;
use crate::families::limits::{ALPHA, IMPACT, decibel};
use crate::families::power::Limit;
use crate::families::unexplained::UnexplainedComb;
use crate::families::unrelated::UNRELATED_SPACINGS;
use crate::quantities;
use crate::words::numbers::chance;

/// Families of healthy bearings are deeper than d in a part exp(−d times this) of all: fitted to the 108 of the
/// same records.
pub(crate) const SOUND_DEPTHS: f64 = 11.4;

quantities! {
    /// One defect family.
    #[derive(Debug, Clone, PartialEq, Serialize)]
    pub struct Family {
        /// Whose family it is.
        pub name: Defect,
        /// Frequency without slip [Hz].
        pub expected_hz: f64,
        /// Frequency at which the family stands highest [Hz]; `null` when it is not there.
        pub measured_hz: Option<f64>,
        /// Harmonics of five that noise would not make.
        pub harmonics: usize,
        /// Height of its first harmonic above the background of the envelope spectrum [dB].
        pub level_db: Option<f64>,
        /// Probability that the record of a healthy bearing shows a family as high and as deep: the largest of
        /// `noise_p_value`, of `rank`, and of the part of healthy bearings whose power swings as much at a family.
        pub p_value: f64,
        /// Probability that noise of the record's own colour makes a family as high; an upper bound.
        pub noise_p_value: f64,
        /// Part of unrelated combs in the same spectrum that stand as high.
        pub rank: Option<f64>,
        /// How deep the power is modulated in the band where it is deepest, of those in which the family stands:
        /// 0 not at all, 1 to zero, 2 short impacts. That of a rolling element counts its sidebands of the cage.
        pub depth: Option<f64>,
        /// That band [Hz].
        pub depth_band_hz: Option<(f64, f64)>,
        /// Band in which it stands highest [Hz].
        pub band_hz: Option<(f64, f64)>,
        /// The weakest impacts at its frequency that the record would have shown; `null` where it could show none.
        pub limit: Option<Limit>,
        /// Whether its impacts keep their phase while an element passes under the load only, so that it has no
        /// lines ([`BandEnvelope::autocorrelation`]).
        pub in_passages: bool,
        /// The family that stands higher, over whose period all numbers of this one are taken
        /// ([`BandEnvelopes::over_period`](stribeck_dsp::BandEnvelopes::over_period)).
        pub over: Option<Defect>,
        /// The family whose lines stand at the same places, so that the record cannot distinguish them.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub not_told_apart_from: Option<Defect>,
        /// Whether the record leaves it open: the machine's own lines stand where the family's would.
        pub undecided: bool,
        /// Whether this is called a defect.
        pub claimed: bool,
        /// Why, or why not.
        pub reason: Reason,
        /// Height of the family [dB], for comparison with others.
        #[serde(skip)]
        pub(crate) height_db: f64,
        /// Peak of its impacts over the root mean square of the record, where it is there.
        #[serde(skip)]
        pub shown_over_rms: Option<f64>,
        /// Names of all rules that refuse it, the one that `reason` words first.
        #[serde(skip)]
        pub refused_by: Vec<&'static str>,
        /// The unrelated combs of the same spectrum that it must stand above: fundamental [Hz] and height [dB];
        /// for pictures.
        #[serde(skip)]
        pub controls: Vec<(f64, f64)>,
    }
}

/// Why a family is called a defect, or not; text in files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Reason {
    /// It has not been judged yet.
    Undecided,
    /// In words.
    Decided(String),
}

impl fmt::Display for Reason {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Undecided => Ok(()),
            Self::Decided(why) => out.write_str(why),
        }
    }
}

impl Serialize for Reason {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl From<String> for Reason {
    fn from(why: String) -> Self {
        Self::Decided(why)
    }
}

impl Family {
    /// A family before it is looked for.
    pub(crate) fn expected(name: Defect, expected_hz: f64) -> Self {
        Self {
            name,
            expected_hz,
            measured_hz: None,
            harmonics: 0,
            level_db: None,
            p_value: 1.0,
            noise_p_value: 1.0,
            rank: None,
            depth: None,
            depth_band_hz: None,
            band_hz: None,
            in_passages: false,
            over: None,
            not_told_apart_from: None,
            undecided: false,
            claimed: false,
            reason: Reason::Undecided,
            height_db: f64::NEG_INFINITY,
            limit: None,
            shown_over_rms: None,
            refused_by: Vec::new(),
            controls: Vec::new(),
        }
    }

    /// The same without its claim, by the rule of this name.
    pub(crate) fn refused(self, rule: &'static str, why: String) -> Self {
        let (reason, refused_by) = (Reason::Decided(why), vec![rule]);
        Self { claimed: false, not_told_apart_from: None, reason, refused_by, ..self }
    }

    /// Whether the family is there, defect or not.
    pub fn is_there(&self) -> bool {
        self.noise_p_value < ALPHA && self.rank.is_some_and(|rank| rank <= MOST_AS_HIGH)
    }

    /// Height of the family's comb above the background [dB]: that of the fourth highest of five harmonics,
    /// by which families are compared; −∞ where none was looked for.
    pub fn score_db(&self) -> f64 {
        self.height_db
    }

    /// Height of the family's comb over that of the unrelated ones of its band, of which a tenth stand as
    /// high [dB]; `None` where it was not looked for, or nothing unrelated was.
    pub fn above_unrelated_db(&self) -> Option<f64> {
        let mut heights: Vec<f64> = self.controls.iter().map(|(_, height_db)| *height_db).collect();
        let last = heights.len().checked_sub(1)?;
        heights.sort_by(f64::total_cmp);
        let at = ((1.0 - MOST_AS_HIGH) * last as f64).round() as usize;
        Some(self.height_db - heights[at]).filter(|db| db.is_finite())
    }

    /// The same at a comb that stands farther from its place than slip of little load allows.
    pub(crate) fn at(self, found: &UnexplainedComb, rank: Option<f64>) -> Self {
        let (comb, band_hz) = (&found.comb, found.band_hz);
        Self {
            measured_hz: Some(comb.fundamental_hz / self.name.shocks_per_period()),
            noise_p_value: found.p_value(),
            height_db: decibel(comb.height),
            level_db: Some(decibel(comb.ratios[0])),
            harmonics: comb.ratios.iter().filter(|r| **r >= comb.height).count(),
            depth: Some(found.depth),
            depth_band_hz: Some(band_hz),
            band_hz: Some(band_hz),
            rank,
            controls: Vec::new(),
            not_told_apart_from: None,
            refused_by: Vec::new(),
            reason: Reason::Undecided,
            ..self
        }
        .calibrated()
    }

    /// The same with its probability of a false alarm on a healthy bearing, from noise, unrelated combs and depth.
    pub(crate) fn calibrated(self) -> Self {
        let by_depth = self.depth.map_or(1.0, |depth| (-SOUND_DEPTHS * depth).exp());
        Self { p_value: by_depth.max(self.noise_p_value).max(self.rank.unwrap_or(1.0)).min(1.0), ..self }
    }

    /// The same where the cage modulates its impacts, as it does those of a spot on an element: of the families
    /// of healthy bearings that are as deep one in nine has more sidebands at the cage's spacing than at eight
    /// unrelated ones.
    pub(crate) fn beside_the_cage(self) -> Self {
        let by_depth = self.depth.map_or(1.0, |depth| (-SOUND_DEPTHS * depth).exp());
        let by_cage = by_depth / (UNRELATED_SPACINGS.len() + 1) as f64;
        Self { p_value: by_cage.max(self.noise_p_value).max(self.rank.unwrap_or(1.0)).min(1.0), ..self }
    }

    /// The probability of a false alarm in words: that of noise and of healthy bearings, beside which a family that
    /// is not claimed may still be another source's.
    pub fn false_alarm(&self) -> String {
        let of_sound = chance(self.p_value);
        if self.claimed || self.p_value >= ALPHA {
            of_sound
        } else {
            format!("{of_sound} but for other sources")
        }
    }

    /// Whether it is more than noise and modulated as deeply as by impacts, whatever their cause.
    pub fn has_impacts(&self) -> bool {
        self.noise_p_value < ALPHA && self.depth.is_some_and(|depth| depth >= IMPACT)
    }
}
