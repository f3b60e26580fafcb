//! The file of a growth.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;
use stribeck_analysis::growth::Law;
use stribeck_analysis::measured::Defect;

/// What the file says.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename = "growth")]
pub(super) struct File {
    pub(super) name: String,
    #[serde(default)]
    pub(super) scene: Option<PathBuf>,
    #[serde(default)]
    pub(super) set: Vec<String>,
    #[serde(default = "one")]
    pub(super) seed: u64,
    pub(super) units: usize,
    pub(super) on: On,
    #[serde(default = "under_the_load")]
    pub(super) angle_deg: f64,
    length_mm: Ends,
    #[serde(default = "exponential")]
    exponent: f64,
    #[serde(default = "shallow")]
    depth_share: f64,
    most_depth_mm: f64,
    onset: Drawn,
    life: Drawn,
    #[serde(default = "usual_wander")]
    wander: f64,
    every_revolutions: f64,
    #[serde(default = "usual_scatter")]
    pub(super) operation_scatter: f64,
    #[serde(default)]
    pub(super) noise_m_s2: f64,
    #[serde(default)]
    pub(super) by: By,
}

/// The damaged raceway.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum On {
    Outer,
    Inner,
}

/// What a length is read from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum By {
    #[default]
    Rms,
    Kurtosis,
    Level,
    Spall,
}

/// Lengths at the onset and at the end [mm].
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, rename = "length_mm")]
struct Ends {
    from: f64,
    to: f64,
}

/// A number of revolutions that is drawn for each unit.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, rename = "revolutions")]
struct Drawn {
    revolutions: f64,
    scatter: f64,
}

fn one() -> u64 {
    1
}

fn under_the_load() -> f64 {
    90.0
}

fn exponential() -> f64 {
    1.0
}

fn shallow() -> f64 {
    0.05
}

fn usual_wander() -> f64 {
    0.2
}

fn usual_scatter() -> f64 {
    0.01
}

const EXAMPLE: &str = "fixtures/growth/quick.ron is one";
/// Most units.
const MOST_UNITS: usize = 10_000;

impl File {
    pub(super) fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path)
            .with_context(|| format!("cannot read `{}` as a growth; {EXAMPLE}", path.display()))?;
        Self::parse(&text).with_context(|| format!("`{}`", path.display()))
    }

    fn parse(text: &str) -> Result<Self> {
        let dialect =
            ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        let file: Self = dialect.from_str(text).map_err(|why| {
            anyhow::anyhow!(
                "line {}, column {}: {}; {EXAMPLE}",
                why.span.start.line,
                why.span.start.col,
                why.code
            )
        })?;
        file.check()?;
        Ok(file)
    }

    fn check(&self) -> Result<()> {
        let letters = self.name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
        ensure!(
            letters && !self.name.is_empty(),
            "`name` is `{}`: letters, digits, `-` and `_` make a folder's name",
            self.name
        );
        ensure!(
            (1..=MOST_UNITS).contains(&self.units),
            "`units` is {}: 1 to {MOST_UNITS} are possible; 5 or more gauge each other",
            self.units
        );
        let within = |field: &str, x: f64, low: f64, high: f64, hint: &str| {
            if (low..=high).contains(&x) {
                return Ok(());
            }
            bail!("`{field}` is {x}: it lies between {low} and {high}; {hint}")
        };
        let revolutions = "a bearing at 1500 rpm makes 2 million a day";
        within("length_mm.from", self.length_mm.from, 1e-3, 1e3, "the spall's length at its onset")?;
        ensure!(
            self.length_mm.to > self.length_mm.from && self.length_mm.to <= 1e3,
            "`length_mm` goes from {} to {}: a spall grows; `to` is the length at the end of a unit",
            self.length_mm.from,
            self.length_mm.to
        );
        within("exponent", self.exponent, 0.0, 10.0, "1 is exponential growth, 0 an even one")?;
        within("depth_share", self.depth_share, 1e-4, 1.0, "depth over length, such as 0.05")?;
        within("most_depth_mm", self.most_depth_mm, 1e-4, 10.0, "the depth at which a spall stays")?;
        within("onset.revolutions", self.onset.revolutions, 1.0, 1e13, revolutions)?;
        within("life.revolutions", self.life.revolutions, 1.0, 1e13, revolutions)?;
        within("every_revolutions", self.every_revolutions, 1.0, 1e13, revolutions)?;
        let scatter = "the standard deviation of its logarithm, such as 0.3";
        within("onset.scatter", self.onset.scatter, 0.0, 3.0, scatter)?;
        within("life.scatter", self.life.scatter, 0.0, 3.0, scatter)?;
        within("wander", self.wander, 0.0, 3.0, scatter)?;
        within("operation_scatter", self.operation_scatter, 1e-6, 0.2, "equal records would be one run")?;
        within("noise_m_s2", self.noise_m_s2, 0.0, 1e6, "root mean square of the machine's noise")
    }

    pub(super) fn law(&self) -> Law {
        Law {
            onset: (self.onset.revolutions, self.onset.scatter),
            life: (self.life.revolutions, self.life.scatter),
            wander: self.wander,
            length_mm: (self.length_mm.from, self.length_mm.to),
            exponent: self.exponent,
            every: self.every_revolutions,
        }
    }

    /// Depth of a spall of this length.
    pub(super) fn depth_mm(&self, length_mm: f64) -> f64 {
        (self.depth_share * length_mm).min(self.most_depth_mm)
    }
}

impl On {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Outer => "outer",
            Self::Inner => "inner",
        }
    }

    /// The family of its defect.
    pub(super) fn family(self) -> Defect {
        match self {
            Self::Outer => Defect::Bpfo,
            Self::Inner => Defect::Bpfi,
        }
    }
}

impl By {
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Rms => "the logarithm of the root mean square",
            Self::Kurtosis => "the logarithm of the kurtosis",
            Self::Level => "the level of the family",
            Self::Spall => "the logarithm of the length between the two events of a passage",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "(name: \"g\", units: 3, on: outer, length_mm: (from: 1.0, to: 3.0), most_depth_mm: 0.08, \
        onset: (revolutions: 2e6, scatter: 0.3), life: (revolutions: 4e6, scatter: 0.3), every_revolutions: 1e6)";

    #[test]
    fn refuses_growths_that_cannot_be() {
        File::parse(TEXT).expect("a growth");
        for (from, to, told) in [
            ("units: 3", "units: 0", "`units` is 0"),
            ("to: 3.0", "to: 0.5", "a spall grows"),
            (
                "revolutions: 2e6, scatter: 0.3",
                "revolutions: -2e6, scatter: 0.3",
                "`onset.revolutions` is -2000000",
            ),
            ("on: outer", "on: cage", "cage"),
            ("units: 3", "unit: 3", "unit"),
            ("most_depth_mm: 0.08", "most_depth_mm: 0.08, wander: 9", "`wander` is 9"),
            ("name: \"g\"", "name: \"a/b\"", "folder's name"),
            ("every_revolutions: 1e6", "every_revolutions: NaN", "`every_revolutions` is NaN"),
        ] {
            let why = format!("{:#}", File::parse(&TEXT.replacen(from, to, 1)).expect_err(to));
            assert!(why.contains(told), "{to}: {why}");
        }
    }
}
