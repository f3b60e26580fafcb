//! The damaged part that a family of lines belongs to.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Part of the bearing that is damaged, under the name of its frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Defect {
    /// The outer raceway.
    Bpfo,
    /// The inner raceway.
    Bpfi,
    /// A rolling element.
    Bsf,
    /// The cage.
    Ftf,
}

impl Defect {
    /// All four, in the order in which they are reported.
    pub const ALL: [Self; 4] = [Self::Bpfo, Self::Bpfi, Self::Bsf, Self::Ftf];

    /// Name of the frequency.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bpfo => "BPFO",
            Self::Bpfi => "BPFI",
            Self::Bsf => "BSF",
            Self::Ftf => "FTF",
        }
    }

    /// The damaged part in words.
    pub fn part(self) -> &'static str {
        match self {
            Self::Bpfo => "the outer raceway",
            Self::Bpfi => "the inner raceway",
            Self::Bsf => "a rolling element",
            Self::Ftf => "the cage",
        }
    }

    /// Name of the frequency of its shocks.
    pub fn shocks_name(self) -> &'static str {
        if self == Self::Bsf { "2×BSF" } else { self.name() }
    }

    /// Shocks in one period of the frequency: a spot on a rolling element strikes both raceways once a turn.
    pub fn shocks_per_period(self) -> f64 {
        if self == Self::Bsf { 2.0 } else { 1.0 }
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_files_and_tables_have_the_same_names() {
        for defect in Defect::ALL {
            let text = serde_json::to_value(defect).unwrap();
            assert_eq!(text, defect.name());
            assert_eq!(serde_json::from_value::<Defect>(text).unwrap(), defect);
        }
    }
}
