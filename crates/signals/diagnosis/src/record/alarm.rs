//! Alarm bands: the levels of warning and alarm.
//!
//! Limits are numbers that the user gives (those of a standard, or of the machine's maker), or follow from
//! records of the machine in its healthy state.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::quantities;
use crate::{Defect, MeasuredFindings};

/// Quantity that a limit is set on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Root mean square [unit].
    Rms,
    /// Root mean square of the velocity, 10 to 1000 Hz [mm/s].
    VelocityMmS,
    /// Kurtosis.
    Kurtosis,
    /// Crest factor.
    CrestFactor,
    /// Level of a defect family [dB]; no value where the family is not there.
    #[serde(rename = "BPFO")]
    Bpfo,
    /// As BPFO, for the inner raceway.
    #[serde(rename = "BPFI")]
    Bpfi,
    /// As BPFO, for a rolling element.
    #[serde(rename = "BSF")]
    Bsf,
    /// As BPFO, for the cage.
    #[serde(rename = "FTF")]
    Ftf,
}

quantities! {
    /// Levels of warning and alarm.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize)]
    pub struct Limit {
        /// Its quantity.
        pub quantity: Quantity,
        /// Warning from here.
        pub warning: f64,
        /// Alarm from here.
        pub alarm: f64,
    }
}

/// How a value stands to its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// Below both.
    Good,
    /// At or above the warning.
    Warning,
    /// At or above the alarm.
    Alarm,
}

quantities! {
    /// A value beside its limit.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize)]
    pub struct Judged {
        /// The limit.
        #[serde(flatten)]
        pub limit: Limit,
        /// The value.
        pub value: f64,
        /// How it stands.
        pub state: State,
    }
}

/// Part of the records of an unchanged machine that pass the warning, and the alarm.
const PASSING: [f64; 2] = [0.01, 0.001];
/// Fewest reference records.
pub const LEAST_RECORDS: usize = 3;

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Rms,
        Self::VelocityMmS,
        Self::Kurtosis,
        Self::CrestFactor,
        Self::Bpfo,
        Self::Bpfi,
        Self::Bsf,
        Self::Ftf,
    ];

    /// As a user writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rms => "rms",
            Self::VelocityMmS => "velocity",
            Self::Kurtosis => "kurtosis",
            Self::CrestFactor => "crest",
            Self::Bpfo => "BPFO",
            Self::Bpfi => "BPFI",
            Self::Bsf => "BSF",
            Self::Ftf => "FTF",
        }
    }

    /// Its value in a record; `None` where the record does not have it.
    pub fn of(self, findings: &MeasuredFindings) -> Option<f64> {
        let health = &findings.health;
        match self {
            Self::Rms => Some(health.rms),
            Self::VelocityMmS => findings.velocity_mm_s,
            Self::Kurtosis => Some(health.kurtosis),
            Self::CrestFactor => Some(health.crest_factor),
            Self::Bpfo => level_db(findings, Defect::Bpfo),
            Self::Bpfi => level_db(findings, Defect::Bpfi),
            Self::Bsf => level_db(findings, Defect::Bsf),
            Self::Ftf => level_db(findings, Defect::Ftf),
        }
    }

    /// Why a record does not have it, and which option would help.
    pub fn missing(self, findings: &MeasuredFindings) -> &'static str {
        match self {
            Self::VelocityMmS if findings.acceleration_unit().is_none() => {
                "the samples have no unit of an acceleration; give `--unit g` or `--unit m/s²`"
            }
            Self::VelocityMmS => "10 to 1000 Hz take a record of 1 s, sampled at 2000 Hz or faster",
            _ if findings.families.is_empty() => "there are no families; give `--bearing` and `--speed-rpm`",
            _ => "the record does not hold this family",
        }
    }

    /// Whether it scatters by factors, so that its logarithm is the better normal variable.
    fn by_factors(self) -> bool {
        !matches!(self, Self::Bpfo | Self::Bpfi | Self::Bsf | Self::Ftf)
    }
}

impl Limit {
    /// From `rms=0.5..1.2`: warning from 0.5 on, alarm from 1.2 on.
    ///
    /// # Errors
    /// A sentence on the fault of the text and its right form.
    pub fn parse(text: &str) -> Result<Self, String> {
        let names = || Quantity::ALL.map(Quantity::name).join(", ");
        let form = || {
            format!("`{text}`: write NAME=WARNING..ALARM, for example rms=0.5..1.2; names are {}", names())
        };
        let (name, values) = text.split_once('=').ok_or_else(form)?;
        let (warning, alarm) = values.split_once("..").ok_or_else(form)?;
        let quantity = Quantity::ALL
            .into_iter()
            .find(|q| q.name().eq_ignore_ascii_case(name.trim()))
            .ok_or_else(|| format!("`{}` has no limit; names are {}", name.trim(), names()))?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(form);
        let (warning, alarm) = (number(warning)?, number(alarm)?);
        if warning > alarm {
            return Err(format!("`{text}`: the warning must not lie above the alarm"));
        }
        Ok(Self { quantity, warning, alarm })
    }

    /// Limits that one in a hundred, and one in a thousand, further records of a machine in the state of
    /// `reference` pass: the prediction interval of Student's distribution, `m + t s √(1 + 1/n)`, of the
    /// logarithms of all but decibels. `None` for fewer than three values.
    ///
    /// Source: G. J. Hahn and W. Q. Meeker, Statistical Intervals, Wiley 1991, section 4.8.
    pub fn from_reference(quantity: Quantity, reference: &[f64]) -> Option<Self> {
        let factors = quantity.by_factors();
        let into = |x: f64| if factors { x.ln() } else { x };
        let back = |x: f64| if factors { x.exp() } else { x };
        let values: Vec<f64> = reference.iter().map(|x| into(*x)).filter(|x| x.is_finite()).collect();
        if values.len() < LEAST_RECORDS {
            return None;
        }
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let deviation = (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        let student = StudentsT::new(0.0, 1.0, n - 1.0).ok()?;
        let [warning, alarm] =
            PASSING.map(|p| back(mean + student.inverse_cdf(1.0 - p) * deviation * (1.0 + 1.0 / n).sqrt()));
        Some(Self { quantity, warning, alarm })
    }

    /// How a record stands to it; `None` where the record does not have the quantity.
    pub fn judge(self, findings: &MeasuredFindings) -> Option<Judged> {
        let value = self.quantity.of(findings)?;
        let state = if value >= self.alarm {
            State::Alarm
        } else if value >= self.warning {
            State::Warning
        } else {
            State::Good
        };
        Some(Judged { limit: self, value, state })
    }
}

/// Level of a family [dB]. Healthy records have one, too: that of the noise at the family's lines, by whose
/// scatter a limit is set.
fn level_db(findings: &MeasuredFindings, defect: Defect) -> Option<f64> {
    let family = findings.families.iter().find(|f| f.name == defect)?;
    family.level_db.filter(|db| db.is_finite())
}
