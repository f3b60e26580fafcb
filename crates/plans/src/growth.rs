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

use std::path::Path;

use crate::document::{File, unreadable};
use stribeck_scene::fields::{group, words};
use stribeck_scene::scene::DefectRing;
use stribeck_scene::scene_file::{self, Kind, SceneError, without_mark};

group! {
    /// Content of a growth's file, checked.
    pub struct Growth {
        /// Its name, which its folder has.
        pub name: String = String::new(), required();
        /// The scene that all records start from, relative to the folder of the file; `None` for the paper's.
        pub scene: Option<String> = None;
        /// Overrides `field=value` of that scene.
        pub set: Vec<String> = Vec::new();
        /// Seed of all draws.
        pub seed: u64 = 1;
        /// Number of bearings.
        pub units: usize = 5, within(1.0, 10_000.0), required();
        /// The damaged raceway.
        pub on: DefectRing = DefectRing::Outer, required();
        /// Angle of the spall's centre at the start of each record [°]; 90 is the middle of the load zone.
        pub angle_deg: f64 = 90.0, within(-360.0, 360.0);
        /// Length of the spall.
        pub length_mm: Lengths = Lengths::default(), required();
        /// Exponent m of dL/dN ∝ Lᵐ: 1 is exponential growth, 0 a constant rate.
        pub exponent: f64 = 1.0, within(0.0, 10.0);
        /// Depth over length, until the depth is `most_depth_mm`.
        pub depth_share: f64 = 0.05, within(1e-4, 1.0);
        /// Greatest depth [mm].
        pub most_depth_mm: f64 = 0.1, within(1e-4, 10.0), required();
        /// From the first revolution to the onset of the spall.
        pub onset: Revolutions = Revolutions::default(), required();
        /// From the onset to the end of the unit.
        pub life: Revolutions = Revolutions::default(), required();
        /// Standard deviation of the logarithm of the growth rate, from one record to the next.
        pub wander: f64 = 0.2, within(0.0, 3.0);
        /// Revolutions between two records; a bearing at 1500 rpm makes 2 million a day.
        pub every_revolutions: f64 = 1e6, within(1.0, 1e13), required();
        /// Standard deviation of the logarithms of speed and load, from one record to the next: without it,
        /// records of one spall would be one run.
        pub operation_scatter: f64 = 0.01, within(1e-6, 0.2);
        /// Root mean square of the machine's noise, added to each record [m/s²].
        pub noise_m_s2: f64 = 0.0, within(0.0, 1e6);
        /// The quantity from which the length is estimated.
        pub by: Indicator = Indicator::Rms;
    }
}

group! {
    /// Lengths of a spall.
    pub struct Lengths: Copy {
        /// At its onset [mm].
        pub from: f64 = 1.0, within(0.001, 1000.0), required();
        /// At the end of the unit [mm].
        pub to: f64 = 4.0, within(0.001, 1000.0), required();
    }
}

group! {
    /// A number of revolutions, drawn for each unit from a lognormal distribution.
    pub struct Revolutions: Copy {
        /// Median; a bearing at 1500 rpm makes 2 million revolutions a day.
        pub revolutions: f64 = 4e6, within(1.0, 1e13), required();
        /// Standard deviation of the logarithm.
        pub scatter: f64 = 0.3, within(0.0, 3.0), required();
    }
}

words! {
    /// A quantity of a record that grows with the spall.
    pub enum Indicator: Copy, Eq {
        /// Root mean square of the acceleration.
        Rms = "rms",
        /// Kurtosis of the acceleration.
        Kurtosis = "kurtosis",
        /// Height of the defect's family above the background of the envelope spectrum.
        Level = "level",
        /// Length of the spall by the two events of a passage, which takes many passages.
        Spall = "spall",
    }
}

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
        let (growth, place): (Self, _) = File::read(name, text, &GROWTH)?;
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
        let Lengths { from, to } = self.length_mm;
        if to <= from {
            let why = format!("`length_mm` goes from {from} to {to}; a spall grows: `to` is its last length");
            return Err(place.refuse("length_mm", why));
        }
        Ok(())
    }
}

/// The file of a growth.
const GROWTH: Kind = Kind {
    noun: "a growth",
    example: "a growth has `name`, `units`, `on`, `length_mm`, `most_depth_mm`, `onset`, `life` and \
        `every_revolutions`; fixtures/growth/quick.ron is one",
    for_fields_of_scenes: Some("a field of the scene stands in `set: [\"{}=…\"]`"),
};

/// A file to look at.
const FILE: &str = "fixtures/growth/quick.ron";

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
            ("units: 3", "units: 2.5", "g.ron:3:12", "a whole number, 1 to 10000"),
            ("units: 3", "unit: 3", "g.ron:3:5", "did you mean `units`?"),
            ("on: outer", "on: cage", "g.ron:4:9", "allowed: `outer`, `inner`"),
            ("to: 3.0", "to: 0.5", "g.ron:5:16", "goes from 1 to 0.5"),
            ("from: 1.0", "from: -1", "g.ron:5:23", "allowed: 0.001 to 1000"),
            (", to: 3.0", "", "g.ron:5:", "`length_mm` has no field `to`"),
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
