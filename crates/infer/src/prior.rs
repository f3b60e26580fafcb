//! Priors of single fields: from shares of the unit interval to values and back.

use serde::{Deserialize, Serialize};

use crate::{
    error::Error,
    random::{normal_quantile, normal_share},
};

/// Prior distribution of a field. Fields are independent of each other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Prior {
    /// Every value of a range is as likely.
    Uniform {
        /// Smallest value.
        from: f64,
        /// Largest value.
        to: f64,
    },
    /// Every factor is as likely: uniform in the logarithm.
    LogUniform {
        /// Smallest value, above 0.
        from: f64,
        /// Largest value.
        to: f64,
    },
    /// A normal distribution, cut off at bounds.
    Normal {
        /// Mean before it is cut off.
        mean: f64,
        /// Standard deviation before it is cut off, above 0.
        sd: f64,
        /// Smallest value.
        from: f64,
        /// Largest value.
        to: f64,
    },
    /// One of several choices, each as likely; values are their numbers from 0.
    Choices(usize),
}

impl Prior {
    /// Whether its numbers make a distribution.
    ///
    /// # Errors
    /// Names the first number that does not, and its range.
    pub fn check(&self) -> Result<(), Error> {
        let refuse = |field, value, expected| Err(Error::Prior { field, value, expected });
        let ordered = |from: f64, to: f64| {
            if !from.is_finite() {
                return refuse("from", from, "must be a finite number");
            }
            if !(to.is_finite() && to > from) {
                return refuse("to", to, "must be finite and above `from`");
            }
            Ok(())
        };
        match *self {
            Self::Uniform { from, to } => ordered(from, to),
            Self::LogUniform { from, .. } if from.is_nan() || from <= 0.0 => {
                refuse("from", from, "must be above 0 where factors are as likely; `Uniform` may start at 0")
            }
            Self::LogUniform { from, to } => ordered(from, to),
            Self::Normal { mean, sd, from, to } => {
                ordered(from, to)?;
                if !mean.is_finite() {
                    return refuse("mean", mean, "must be a finite number");
                }
                if !(sd.is_finite() && sd > 0.0) {
                    return refuse("sd", sd, "must be above 0");
                }
                let within = normal_share((to - mean) / sd) - normal_share((from - mean) / sd);
                if within < 1e-6 {
                    return refuse(
                        "mean",
                        mean,
                        "lies too far outside `from` … `to`: less than 1e-6 is left",
                    );
                }
                Ok(())
            }
            Self::Choices(0) => refuse("choices", 0.0, "must be 1 at least"),
            Self::Choices(_) => Ok(()),
        }
    }

    /// The value with `share` (0 … 1) of the prior below it; for choices, the number of the choice.
    pub fn quantile(&self, share: f64) -> f64 {
        let share = share.clamp(0.0, 1.0);
        match *self {
            Self::Uniform { from, to } => from + share * (to - from),
            Self::LogUniform { from, to } => (from.ln() + share * (to / from).ln()).exp().clamp(from, to),
            Self::Normal { mean, sd, from, to } => {
                let [low, high] = [from, to].map(|bound| normal_share((bound - mean) / sd));
                (mean + sd * normal_quantile(low + share * (high - low))).clamp(from, to)
            }
            Self::Choices(n) => choice(n, share) as f64,
        }
    }

    /// The share (0 … 1) of the prior below `value`; for the number of a choice, the middle of its cell.
    pub fn share(&self, value: f64) -> f64 {
        match *self {
            Self::Uniform { from, to } => ((value - from) / (to - from)).clamp(0.0, 1.0),
            Self::LogUniform { from, .. } if value <= from => 0.0,
            Self::LogUniform { from, to } => ((value / from).ln() / (to / from).ln()).clamp(0.0, 1.0),
            Self::Normal { mean, sd, from, to } => {
                let [low, high, at] = [from, to, value].map(|bound| normal_share((bound - mean) / sd));
                ((at - low) / (high - low)).clamp(0.0, 1.0)
            }
            Self::Choices(n) => (value.clamp(0.0, n as f64 - 1.0).round() + 0.5) / n as f64,
        }
    }

    /// The share that a run at this one has: the middle of its cell for choices, unchanged otherwise. Points
    /// that an emulator is fitted to are snapped, so that equal choices have equal coordinates.
    pub fn snap(&self, share: f64) -> f64 {
        match *self {
            Self::Choices(n) => (choice(n, share) as f64 + 0.5) / n as f64,
            _ => share,
        }
    }
}

fn choice(n: usize, share: f64) -> usize {
    ((share.clamp(0.0, 1.0) * n as f64) as usize).min(n.saturating_sub(1))
}

/// A point of the unit cube with every coordinate snapped ([`Prior::snap`]).
pub fn snapped(priors: &[Prior], point: &[f64]) -> Vec<f64> {
    priors.iter().zip(point).map(|(prior, &share)| prior.snap(share)).collect()
}
