//! One compared quantity: its scale, its difference, its limit and the verdict.

use serde::{Deserialize, Serialize};

use crate::statistic::Statistic;

/// On which scale a quantity is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scale {
    /// Forces, relative to the largest one.
    #[serde(rename = "% of the largest")]
    OfLargestForce,
    /// A number of the reduced model, relative to that of the full one.
    #[serde(rename = "%")]
    Relative,
    /// The time of an event.
    #[serde(rename = "ms")]
    EventTime,
    /// Levels of third octaves.
    #[serde(rename = "dB")]
    ThirdOctaves,
}

/// One quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Stable name, the unit at its end.
    pub name: String,
    /// In words.
    pub quantity: String,
    /// Scale of the difference; in files its unit.
    #[serde(rename = "unit")]
    pub scale: Scale,
    /// The difference, reduced less full; over the starts, or for third octaves over the bands.
    pub difference: Statistic,
    /// Largest difference that is still agreement.
    pub limit: f64,
    /// Whether it is kept: by the mean of the starts, or by every band.
    pub within: bool,
    /// Whether the starts suffice for a verdict: their interval, or the error of each band, leaves no other
    /// answer.
    #[serde(default, alias = "told")]
    pub decided: bool,
}

impl Scale {
    /// Unit of a difference.
    pub fn unit(self) -> &'static str {
        match self {
            Self::OfLargestForce => "% of the largest",
            Self::Relative => "%",
            Self::EventTime => "ms",
            Self::ThirdOctaves => "dB",
        }
    }
}

impl Row {
    /// From the differences over the starts.
    pub(super) fn of_starts(
        name: String,
        quantity: String,
        scale: Scale,
        difference: Statistic,
        limit: f64,
    ) -> Self {
        let decided = difference
            .low
            .zip(difference.high)
            .is_some_and(|(low, high)| low.abs().max(high.abs()) <= limit || low > limit || high < -limit);
        let within = difference.mean.abs() <= limit;
        Self { name, quantity, scale, within, decided, difference, limit }
    }

    /// The verdict in words.
    pub fn verdict(&self, starts: usize) -> String {
        match (self.decided, self.within) {
            (true, true) => "yes".to_owned(),
            (true, false) => "no".to_owned(),
            (false, _) if starts == 1 => "one start cannot tell".to_owned(),
            (false, _) => format!("{starts} starts cannot tell"),
        }
    }

    /// Where the difference lies: the 95 % interval of the mean of the starts, or from the least to the most
    /// of the bands; `None` of a single value.
    pub fn range(&self) -> Option<[f64; 2]> {
        let d = &self.difference;
        let interval = if self.over_bands() { None } else { d.low.zip(d.high) };
        interval.or((d.count > 1).then_some((d.least, d.most))).map(<[f64; 2]>::from)
    }

    /// Whether values are those of bands, not of starts.
    pub fn over_bands(&self) -> bool {
        self.scale == Scale::ThirdOctaves
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_a_scale_is_its_unit_in_files() {
        for scale in [Scale::OfLargestForce, Scale::Relative, Scale::EventTime, Scale::ThirdOctaves] {
            assert_eq!(serde_json::to_value(scale).unwrap(), scale.unit());
        }
    }
}
