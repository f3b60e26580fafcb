//! Intervals of valid numbers.

use super::tree::Node;
use super::value::Value;
use super::wording::number;

#[derive(Debug, Clone, Copy)]
pub(crate) enum Limits {
    /// It has no numbers, or its items have theirs.
    None,
    /// Its own.
    Own(Range),
    /// Those of the field that the group around it varies.
    Varied,
    /// From 0 to the largest value of that field.
    Amplitude,
}

/// An interval of valid values.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Range {
    pub low: f64,
    pub low_included: bool,
    pub high: f64,
    pub high_included: bool,
    /// Upper end that another field of the scene sets.
    pub most: Option<Most>,
}

/// An upper end that follows from another field.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Most {
    /// Path of that field.
    pub path: &'static str,
    pub of: fn(f64) -> f64,
}

impl Limits {
    /// The range and its unit, in a group whose own values have those of `around`.
    pub(crate) fn resolved(
        self,
        unit: &'static str,
        around: Option<(Range, &'static str)>,
    ) -> Option<(Range, &'static str)> {
        match self {
            Self::None => None,
            Self::Own(range) => Some((range, unit)),
            Self::Varied => around,
            Self::Amplitude => {
                around.map(|(range, unit)| (Range { low: 0.0, low_included: true, ..range }, unit))
            }
        }
    }
}

impl Range {
    fn high(self, scene: &Node) -> f64 {
        let most = |most: Most| scene.get(most.path).and_then(f64::read).map_or(f64::INFINITY, most.of);
        self.most.map_or(self.high, most)
    }

    pub(crate) fn contains(self, x: f64, scene: &Node) -> bool {
        let high = self.high(scene);
        let above = if self.low_included { x >= self.low } else { x > self.low };
        let below = if self.high_included { x <= high } else { x < high };
        above && below
    }

    /// `3 to 400 mm`.
    pub(crate) fn in_words(self, unit: &str, scene: &Node) -> String {
        let (low, high) = (number(self.low), number(self.high(scene)));
        let words = match (self.low_included, self.high_included) {
            (true, true) => format!("{low} to {high} {unit}"),
            (true, false) => format!("{low} or more, less than {high} {unit}"),
            (false, true) => format!("more than {low}, at most {high} {unit}"),
            (false, false) => format!("more than {low}, less than {high} {unit}"),
        };
        words.trim_end().to_owned()
    }
}
