//! One number of one side less that of the first.

use serde::Serialize;

use crate::statistic::Statistic;

/// How a number of one side differs from that of the first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Contrast {
    /// This side's mean less the first's.
    pub difference: f64,
    /// The same as a part of the first's [%]; `None` where that is zero.
    pub percent: Option<f64>,
    /// Lower end of its interval of 95 %; `None` where neither side has a scatter.
    pub low: Option<f64>,
    /// Upper end of it.
    pub high: Option<f64>,
    /// Verdict.
    pub verdict: Verdict,
}

/// Whether chance explains a difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Its interval leaves zero out.
    Differs,
    /// Its interval holds zero.
    WithinScatter,
    /// Both sides are single runs: the scatter is unknown.
    Unknown,
}

impl Contrast {
    pub(super) fn of(first: &Statistic, other: &Statistic) -> Self {
        let difference = other.mean - first.mean;
        let interval = other.less(first);
        let verdict = match interval {
            None => Verdict::Unknown,
            Some([low, high]) if low > 0.0 || high < 0.0 => Verdict::Differs,
            Some(_) => Verdict::WithinScatter,
        };
        Self {
            difference,
            percent: (first.mean != 0.0).then(|| 100.0 * difference / first.mean.abs()),
            low: interval.map(|[low, _]| low),
            high: interval.map(|[_, high]| high),
            verdict,
        }
    }
}

impl Verdict {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Differs => "differs",
            Self::WithinScatter => "within the scatter",
            Self::Unknown => "one signal each",
        }
    }
}
