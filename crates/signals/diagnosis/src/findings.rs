//! The numbers of an analysis, under stable names.

use serde::Serialize;

use crate::conclusion::{Doubt, Open, open};
use crate::quantities;
use crate::record::quality::Quality;
use crate::record::zone;
use crate::words::sentence::{Told, conclude};
use crate::{AccelerationUnit, Conclusion, Family, Health, Unexplained};

quantities! {
    /// Contents of `findings.json`. A number that the record cannot yield is `null`, with the reason in `notes`.
    #[derive(Debug, Clone, PartialEq, Serialize)]
    pub struct MeasuredFindings {
        /// The channel.
        pub channel: String,
        /// Its unit, if known.
        pub unit: Option<String>,
        /// Sample rate [Hz].
        pub rate_hz: f64,
        /// Samples read.
        pub samples: u64,
        /// Length of the record [s].
        pub duration_s: f64,
        /// Speed of the shaft that was taken [1/min].
        pub speed_rpm: Option<f64>,
        /// The user's speed, where the lines of the shaft correct it [1/min].
        #[serde(skip_serializing_if = "Option::is_none")]
        pub speed_given_rpm: Option<f64>,
        /// Uncertainty of a speed that was found in the record alone [1/min].
        #[serde(skip_serializing_if = "Option::is_none")]
        pub speed_uncertainty_rpm: Option<f64>,
        /// The bearing, in words.
        pub bearing: Option<String>,
        /// Resolution of the envelope spectra: one over the length of a segment [Hz].
        pub resolution_hz: f64,
        /// Segments averaged.
        pub segments: usize,
        /// Numbers that describe the signal as a whole.
        pub health: Health,
        /// Root mean square of the velocity from 10 to 1000 Hz [mm/s], for accelerations in m/s² or g.
        pub velocity_mm_s: Option<f64>,
        /// Its zone by ISO 20816-3, where group and foundation of the machine are known.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub zone: Option<zone::Zoned>,
        /// The defect families; none without speed and bearing.
        pub families: Vec<Family>,
        /// A comb that strikes, is no family's of this bearing, and stands higher than all that are.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub unexplained: Option<Unexplained>,
        /// How far the rolling family that stands farthest above unrelated combs does so [dB]: the scores of sound
        /// records of a machine calibrate that of a further one.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub score_db: Option<f64>,
        /// Records of the healthy machine with as high a score.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub sound_as_high: Option<SoundAsHigh>,
        /// The conclusion on each part of the bearing.
        pub conclusion: Conclusion,
        /// The conclusion in one sentence.
        pub verdict: String,
        /// Length of a spall, from two events a passage [mm].
        pub spall_mm: Option<Interval>,
        /// Length of a spall longer than half of the distance of two elements, whose exit and the entry of the
        /// next element are as far apart as these events [mm].
        #[serde(skip_serializing_if = "Option::is_none")]
        pub spall_otherwise_mm: Option<Interval>,
        /// Time between these events [ms].
        #[serde(skip_serializing_if = "Option::is_none")]
        pub event_spacing_ms: Option<f64>,
        /// Where a passage has a single event: the spall is shorter than this, if entry and exit both impact [mm].
        #[serde(skip_serializing_if = "Option::is_none")]
        pub spall_below_mm: Option<f64>,
        /// What sensor, amplifier, converter and recorder did to the samples; none for a valid record. The notes
        /// have it in words.
        pub quality: Vec<Quality>,
        /// Limits of the conclusion.
        pub notes: Vec<String>,
    }
}

impl MeasuredFindings {
    /// Whether the samples are no record of a signal, so that neither a defect nor its absence follows.
    pub fn is_no_signal(&self) -> bool {
        self.quality.iter().any(Quality::is_no_signal)
    }

    /// Conclusion and verdict after a change of the families.
    pub(crate) fn conclude_again(&mut self) {
        if self.is_no_signal() {
            return;
        }
        let doubt = self.doubt();
        self.conclusion = Conclusion::of(&self.families, self.unexplained.as_ref(), doubt);
        let told = Told {
            doubt,
            conclusion: &self.conclusion,
            unit: self.unit.as_deref(),
            speed_rpm: self.speed_rpm.unwrap_or(f64::NAN),
            rate_hz: self.rate_hz,
        };
        self.verdict = conclude(&self.families, self.unexplained.as_ref(), told);
    }

    fn doubt(&self) -> Option<Doubt> {
        let is_spoilt = self.quality.iter().any(|found| found.kind.spoils_verdicts());
        let turns = self.duration_s * self.speed_rpm.unwrap_or(0.0) / 60.0;
        Doubt::of(is_spoilt, self.speed_uncertainty_rpm.is_some(), turns)
    }

    /// Names of all rules by which it cannot be said that no raceway is damaged; nothing where that is said.
    pub fn open(&self) -> Vec<&'static str> {
        open(&self.families, self.unexplained.as_ref(), self.doubt()).iter().map(Open::name).collect()
    }

    /// The unit of the channel; `None` where it is unknown, or not an acceleration.
    pub fn acceleration_unit(&self) -> Option<AccelerationUnit> {
        self.unit.as_deref().and_then(AccelerationUnit::parse)
    }
}

quantities! {
    /// How many records of the healthy machine have as high a score as a record.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
    pub struct SoundAsHigh {
        /// Those that have.
        pub as_high: usize,
        /// All of them.
        pub records: usize,
    }
}

quantities! {
    /// A value with its interval of 90 %.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize)]
    pub struct Interval {
        /// Best estimate.
        pub value: f64,
        /// Lower end.
        pub low: f64,
        /// Upper end.
        pub high: f64,
    }
}
