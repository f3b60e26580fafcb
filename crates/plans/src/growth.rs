//! Growths: spalls of several bearings that become longer from record to record.
//!
//! ```text
//! (
//!     name: "grow6205",
//!     scene: "../scenes/first_look.ron",
//!     set: ["bearing=6205", "defect=None"],
//!     units: 5,
//!     on: outer,
//!     length_mm: (from: 1.0, to: 4.0),
//!     most_depth_mm: 0.08,
//!     onset: (revolutions: 3e6, scatter: 0.3),
//!     life: (revolutions: 4e6, scatter: 0.4),
//!     every_revolutions: 2e6,
//! )
//! ```
//!
//! This is the file alone: the law of the growth and the estimates from its records are in `analysis`.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::document::{File, Kind, unreadable};
use stribeck_scene::scene::DefectRing;
use stribeck_scene::scene_file::{self, Problem, SceneError, dialect, without_mark};

/// Most units.
const MOST_UNITS: usize = 10_000;

/// Content of a growth's file, checked.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename = "growth")]
pub struct Growth {
    /// Its name, which its folder has.
    pub name: String,
    /// The scene that all records start from, relative to the folder of the file; `None` for the paper's.
    #[serde(default)]
    pub scene: Option<PathBuf>,
    /// Overrides `field=value` of that scene.
    #[serde(default)]
    pub set: Vec<String>,
    /// Seed of all draws.
    #[serde(default = "one")]
    pub seed: u64,
    /// Number of bearings.
    pub units: usize,
    /// The damaged raceway.
    pub on: DefectRing,
    /// Angle of the spall's centre at the start of each record [°].
    #[serde(default = "top")]
    pub angle_deg: f64,
    /// Length of the spall.
    pub length_mm: Lengths,
    /// Exponent m of dL/dN ∝ Lᵐ.
    #[serde(default = "exponential")]
    pub exponent: f64,
    /// Depth over length, until the depth is `most_depth_mm`.
    #[serde(default = "usual_depth_share")]
    pub depth_share: f64,
    /// Greatest depth [mm].
    pub most_depth_mm: f64,
    /// From the first revolution to the onset of the spall.
    pub onset: Revolutions,
    /// From the onset to the end of the unit.
    pub life: Revolutions,
    /// Standard deviation of the logarithm of the growth rate, from one record to the next.
    #[serde(default = "usual_wander")]
    pub wander: f64,
    /// Revolutions between two records.
    pub every_revolutions: f64,
    /// Standard deviation of the logarithms of speed and load, from one record to the next.
    #[serde(default = "usual_operation_scatter")]
    pub operation_scatter: f64,
    /// Root mean square of the machine's noise, added to each record [m/s²].
    #[serde(default)]
    pub noise_m_s2: f64,
    /// The quantity from which the length is estimated.
    #[serde(default)]
    pub by: Indicator,
}

/// Lengths of a spall.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "lengths")]
pub struct Lengths {
    /// At its onset [mm].
    pub from: f64,
    /// At the end of the unit [mm].
    pub to: f64,
}

/// A number of revolutions, drawn for each unit from a lognormal distribution.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "revolutions")]
pub struct Revolutions {
    /// Median.
    pub revolutions: f64,
    /// Standard deviation of the logarithm.
    pub scatter: f64,
}

/// A quantity of a record that grows with the spall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case", rename = "by")]
pub enum Indicator {
    /// Root mean square of the acceleration.
    #[default]
    Rms,
    /// Kurtosis of the acceleration.
    Kurtosis,
    /// Height of the defect's family above the background of the envelope spectrum.
    Level,
    /// Length of the spall by the two events of a passage, which takes many passages.
    Spall,
}

fn one() -> u64 {
    1
}

/// The middle of the load zone.
fn top() -> f64 {
    90.0
}

fn exponential() -> f64 {
    1.0
}

fn usual_depth_share() -> f64 {
    0.05
}

fn usual_wander() -> f64 {
    0.2
}

fn usual_operation_scatter() -> f64 {
    0.01
}

/// Range of a number of the file: its path and value, the least and the greatest value as they are shown,
/// and a remark.
type Range = (&'static str, f64, [&'static str; 2], &'static str);

const A_DAY: &str = "a bearing at 1500 rpm makes 2 million revolutions a day";
const OF_LOGARITHM: &str = "it is the standard deviation of a logarithm, such as 0.3";

impl Growth {
    /// Reads a growth's file.
    ///
    /// # Errors
    /// Mistakes in the file, with line and field: in its own fields, and in the scene that it starts from.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let shown = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|e| unreadable(&shown, &GROWTH, FILE, &e))?;
        Self::parse(without_mark(&text), &shown, path.parent().unwrap_or(Path::new("")))
    }

    fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, SceneError> {
        let place = File::new(name, text, &GROWTH);
        let growth: Self = dialect().from_str(text).map_err(|e| place.not_understood(&e))?;
        growth.check(&place)?;
        let base = growth.scene.as_ref().map(|scene| folder.join(scene));
        scene_file::readable(base.as_deref(), &growth.set).map_err(|why| place.of_base(why))?;
        Ok(growth)
    }

    /// Depth of a spall of this length [mm].
    pub fn depth_mm(&self, length_mm: f64) -> f64 {
        (self.depth_share * length_mm).min(self.most_depth_mm)
    }

    fn check(&self, place: &File<'_>) -> Result<(), SceneError> {
        let letter = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
        if self.name.is_empty() || !self.name.chars().all(letter) {
            let why = format!("`name` is `{}`; letters, digits, `-` and `_` make a folder's name", self.name);
            return Err(place.refuse("name", why));
        }
        if !(1..=MOST_UNITS).contains(&self.units) {
            let most = MOST_UNITS.to_string();
            let remark = "the lengths of a unit are estimated by the records of the others: take 5 or more";
            return Err(refusal(place, "units", self.units as f64, ["1", &most], remark));
        }
        for (path, value, ends, remark) in self.ranges() {
            let [low, high] = ends.map(|end| end.parse().unwrap_or(f64::NAN));
            if !(low..=high).contains(&value) {
                return Err(refusal(place, path, value, ends, remark));
            }
        }
        let Lengths { from, to } = self.length_mm;
        if to <= from {
            let why = format!("`length_mm` goes from {from} to {to}; a spall grows: `to` is its last length");
            return Err(place.refuse("length_mm", why));
        }
        Ok(())
    }

    fn ranges(&self) -> [Range; 14] {
        let millions = ["1", "1e13"];
        let scatter = ["0", "3"];
        let length = ["0.001", "1000"];
        [
            ("angle_deg", self.angle_deg, ["-360", "360"], "90 is the middle of the load zone"),
            ("length_mm.from", self.length_mm.from, length, "it is the length at the onset"),
            ("length_mm.to", self.length_mm.to, length, "it is the length at the end of a unit"),
            ("exponent", self.exponent, ["0", "10"], "1 is exponential growth, 0 a constant rate"),
            ("depth_share", self.depth_share, ["1e-4", "1"], "it is depth over length, such as 0.05"),
            ("most_depth_mm", self.most_depth_mm, ["1e-4", "10"], "the spall becomes no deeper than this"),
            ("onset.revolutions", self.onset.revolutions, millions, A_DAY),
            ("onset.scatter", self.onset.scatter, scatter, OF_LOGARITHM),
            ("life.revolutions", self.life.revolutions, millions, A_DAY),
            ("life.scatter", self.life.scatter, scatter, OF_LOGARITHM),
            ("wander", self.wander, scatter, OF_LOGARITHM),
            ("every_revolutions", self.every_revolutions, millions, A_DAY),
            (
                "operation_scatter",
                self.operation_scatter,
                ["1e-6", "0.2"],
                "without it, records of one spall would be one run",
            ),
            ("noise_m_s2", self.noise_m_s2, ["0", "1e6"], "it is the root mean square of the noise"),
        ]
    }
}

/// Refuses a number outside its range.
fn refusal(place: &File<'_>, path: &str, value: f64, [low, high]: [&str; 2], remark: &str) -> SceneError {
    let mut problem = Problem::new(format!("`{path}` is {value}"), place.place(path));
    path.clone_into(&mut problem.field);
    problem.allowed = format!("{low} to {high}; {remark}");
    problem.into()
}

/// The file of a growth.
const GROWTH: Kind = Kind {
    noun: "a growth",
    example: "a growth has `name`, `units`, `on`, `length_mm`, `most_depth_mm`, `onset`, `life` and \
        `every_revolutions`; fixtures/growth/quick.ron is one",
    part,
    lacking,
    for_fields_of_scenes: "a field of the scene stands in `set: [\"{}=…\"]`",
    most,
};

/// A file to look at.
const FILE: &str = "fixtures/growth/quick.ron";

/// The part of a growth whose type has this name.
fn part(outer: Option<&str>) -> &'static str {
    match outer {
        Some("lengths") => "`length_mm`",
        Some("revolutions") => "a number of revolutions",
        _ => "a growth",
    }
}

/// Remedy for a missing field without default.
fn lacking(outer: Option<&str>) -> Option<&'static str> {
    match outer {
        Some("lengths") => Some("`length_mm: (from: 1, to: 4)` is one"),
        Some("revolutions") => Some("`(revolutions: 4e6, scatter: 0.3)` is one"),
        _ => None,
    }
}

/// How large a whole number may be.
fn most(field: &str) -> Option<u64> {
    match field {
        "seed" => Some(u64::MAX),
        "units" => Some(MOST_UNITS as u64),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "(\n    name: \"g\",\n    units: 3,\n    on: outer,\n    \
        length_mm: (from: 1.0, to: 3.0),\n    most_depth_mm: 0.08,\n    \
        onset: (revolutions: 2e6, scatter: 0.3),\n    life: (revolutions: 4e6, scatter: 0.3),\n    \
        every_revolutions: 1e6,\n)\n";

    fn parse(text: &str) -> Result<Growth, String> {
        Growth::parse(text, "g.ron", Path::new("")).map_err(|why| why.to_string())
    }

    #[test]
    fn behaves_what_a_growth_leaves_out_has_a_default() {
        let growth = parse(TEXT).expect("a growth");
        assert_eq!((growth.seed, growth.angle_deg, growth.by), (1, 90.0, Indicator::Rms));
        // A twentieth of its length, and 0.08 mm at most.
        assert_eq!([1.0, 3.0].map(|mm| growth.depth_mm(mm)), [0.05, 0.08]);
    }

    /// Each message has file, line and column of the value to blame, and its range or the words that it may
    /// be.
    #[test]
    fn refuses_growths_that_cannot_be() {
        for (from, to, at, told) in [
            ("name: \"g\"", "name: \"a/b\"", "g.ron:2:11", "folder's name"),
            ("units: 3", "units: 0", "g.ron:3:12", "allowed: 1 to 10000"),
            ("units: 3", "units: 2.5", "g.ron:3:12", "a whole number, at most 10000"),
            ("units: 3", "unit: 3", "g.ron:3:5", "did you mean `units`?"),
            ("on: outer", "on: cage", "g.ron:4:9", "allowed: `outer`, `inner`"),
            ("to: 3.0", "to: 0.5", "g.ron:5:16", "goes from 1 to 0.5"),
            ("from: 1.0", "from: -1", "g.ron:5:23", "allowed: 0.001 to 1000"),
            (", to: 3.0", "", "g.ron:5:", "`length_mm` lacks `to`"),
            ("0.08", "0.08, wander: 9", "g.ron:6:34", "allowed: 0 to 3"),
            ("2e6", "-2e6", "g.ron:7:26", "`onset.revolutions` is -2000000"),
            ("1e6,\n)", "NaN,\n)", "g.ron:9:24", "`every_revolutions` is NaN"),
            ("1e6,\n)", "1e6, set: [\"operation.load=1\"])", "g.ron:9:", "load_n"),
        ] {
            assert!(TEXT.contains(from), "{from}");
            let why = parse(&TEXT.replacen(from, to, 1)).expect_err(to);
            assert!(why.contains(told) && why.contains(at), "{to}: {why}");
        }
    }
}
