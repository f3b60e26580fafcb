//! Inferences: which scenes are consistent with observed numbers.
//!
//! ```text
//! (
//!     name: "singh2014",
//!     scene: "../scenes/singh2014.ron",
//!     set: ["solver.duration_ms=30"],
//!     starts: 2,
//!     unknowns: [
//!         (field: "bearing.thickness_mm", from: 5, to: 1000, log: true),
//!         (field: "contact.damping_ratio", mean: 0.3, sd: 0.2, from: 0, to: 1),
//!         (field: "mesh.roller_copies", values: [rotated, translated]),
//!         (name: "damping", sets: [
//!             ["solver.mass_damping_per_s=5000", "solver.structural_damping=None"],
//!             ["solver.mass_damping_per_s=0"],
//!         ]),
//!         (name: "sensor", readings: ["side", "top"]),
//!     ],
//!     targets: [
//!         (name: "exits", of: "levels.impulse_g", value: 180, tolerance: 18, log: true),
//!         (name: "gaps", of: "levels.sensors[sensor={sensor}].gap_g", value: 50, tolerance: 5, log: true),
//!         (name: "event #2", of: "count(events.floor_n)", value: 3),
//!     ],
//!     budget: (runs: 600),
//! )
//! ```
//!
//! Each unknown has a prior; each target a number, or a curve, of `summary.json`. `readings` are no part of
//! the scene: they select which of several items of a run was observed, as `{sensor}` in a path. Neither the
//! choice of simulations nor the statistics are decided here.

mod quantity;
mod refusal;
#[cfg(test)]
mod tests;
mod text;

use std::path::{Path, PathBuf};

use crate::document::{File, unreadable};
pub use quantity::{Quantity, Take};
use refusal::INFERENCE;
use stribeck_scene::scene::Scene;
use stribeck_scene::scene_file::{self, Place, Problem, SceneError, without_mark};
use text::{Text, budget, targets, unknowns};

/// Most unknowns of an inference: beyond, no number of runs that anybody makes fills their space.
pub const MOST_UNKNOWNS: usize = 30;
/// Most targets.
pub const MOST_TARGETS: usize = 100;
/// Most starts of a scene.
pub const MOST_STARTS: usize = 100;
/// Most runs.
pub const MOST_RUNS: usize = 100_000;
/// Fewest scenes of the first round, per unknown: fewer cannot separate their effects.
const FEWEST_BY_UNKNOWN: usize = 4;

/// An inference that can be made.
#[derive(Debug, Clone)]
pub struct Inference {
    /// Its name.
    pub name: String,
    /// The text of its file.
    pub text: String,
    /// Seed of all draws.
    pub seed: u64,
    /// Runs of each scene, which differ in their starts.
    pub starts: usize,
    /// The unknowns.
    pub unknowns: Vec<Unknown>,
    /// The observations.
    pub targets: Vec<Target>,
    /// How many runs may be made.
    pub budget: Budget,
    base: Option<PathBuf>,
    set: Vec<String>,
}

/// A field of the scene with an unknown value, or several with a common one.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Name: the field's path, or the one given.
    pub name: String,
    /// Its prior.
    pub values: Values,
}

/// Prior distribution of an unknown.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// A number of a range, evenly, or evenly over its logarithm.
    Range {
        /// Least value, in the field's unit.
        from: f64,
        /// Greatest value.
        to: f64,
        /// Evenly over the logarithm.
        log: bool,
    },
    /// A normal distribution, cut off at both ends.
    Normal {
        /// Mean, in the field's unit.
        mean: f64,
        /// Standard deviation.
        sd: f64,
        /// Least value.
        from: f64,
        /// Greatest value.
        to: f64,
    },
    /// One of several values of one field, as they would be written, all equally likely.
    Listed(Vec<String>),
    /// One of several lists of `field=value`, all equally likely.
    Sets(Vec<Vec<String>>),
    /// One of several items of every run's summary, all equally likely.
    Readings(Vec<String>),
}

/// An observed number or curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Name: the one given, or the quantity's.
    pub name: String,
    /// Which number of `summary.json`.
    pub of: Quantity,
    /// Observation.
    pub seen: Seen,
    /// Standard deviation of the observation's error, besides the scatter of starts, in the quantity's unit.
    pub tolerance: f64,
    /// Whether differences count by their ratio: levels do.
    pub log: bool,
}

/// Observation of a quantity.
#[derive(Debug, Clone, PartialEq)]
pub enum Seen {
    /// A number.
    Value(f64),
    /// A curve, as long as the quantity's.
    Curve(Vec<f64>),
    /// That there is none: a line that is not found.
    Nothing,
}

/// How many runs are made, starts counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Budget {
    /// Of all rounds together, without those of the check.
    pub runs: usize,
    /// Scenes of the first round, which fill the prior evenly.
    pub first: usize,
    /// Scenes of each round that follows.
    pub round: usize,
    /// Scenes drawn from the posterior and run at the end, to see whether they make the targets.
    pub check: usize,
}

impl Unknown {
    /// The same value as the file of a scene would have it; of a choice the one of that number, from 0.
    pub fn written(&self, value: f64) -> String {
        match &self.values {
            // Seven digits: short to read in a scene, and finer than anything that is measured.
            Values::Range { .. } | Values::Normal { .. } => {
                format!("{}", format!("{value:.6e}").parse::<f64>().unwrap_or(value))
            }
            Values::Listed(values) | Values::Readings(values) => values[choice(value, values.len())].clone(),
            Values::Sets(sets) => sets[choice(value, sets.len())].join(" "),
        }
    }

    /// Overrides `field=value` that set a value in a scene.
    fn arguments(&self, value: f64) -> Vec<String> {
        match &self.values {
            Values::Sets(sets) => sets[choice(value, sets.len())].clone(),
            Values::Readings(_) => Vec::new(),
            _ => vec![format!("{}={}", self.name, self.written(value))],
        }
    }

    /// How many choices there are; `None` for a number.
    pub fn choices(&self) -> Option<usize> {
        match &self.values {
            Values::Listed(values) | Values::Readings(values) => Some(values.len()),
            Values::Sets(sets) => Some(sets.len()),
            _ => None,
        }
    }
}

fn choice(value: f64, count: usize) -> usize {
    (value.max(0.0) as usize).min(count - 1)
}

impl Inference {
    /// Reads the file of an inference. Paths in it count from its folder.
    ///
    /// # Errors
    /// Mistakes in the file, with line and field: in its own fields, in fields of scenes that it names,
    /// values of the wrong type, and quantities that cannot be read.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let shown = path.display().to_string();
        let text =
            std::fs::read_to_string(path).map_err(|e| unreadable(&shown, &INFERENCE, refusal::FILE, &e))?;
        Self::parse(without_mark(&text), &shown, path.parent().unwrap_or(Path::new("")))
    }

    fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, SceneError> {
        let (file, place): (Text, _) = File::read(name, text, &INFERENCE)?;
        if file.name.is_empty() || !file.name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c)) {
            let why = format!("`name` is `{}`; letters, digits, `-` and `_` make a folder's name", file.name);
            return Err(place.refuse("name", why));
        }
        let base = file.scene.as_ref().map(|scene| folder.join(scene));
        scene_file::readable(base.as_deref(), &file.set).map_err(|why| place.of_base(why))?;
        let unknowns = unknowns(&file.unknowns, &place)?;
        let targets = targets(&file.targets, &unknowns, &place)?;
        let budget = budget(file.budget, unknowns.len(), file.starts, &place)?;
        let inference = Self {
            name: file.name,
            text: text.to_owned(),
            seed: file.seed,
            starts: file.starts,
            unknowns,
            targets,
            budget,
            base,
            set: file.set,
        };
        inference.check_ends(&place)?;
        Ok(inference)
    }

    /// The scene where unknowns have these values, in their order and units; of a choice its number, from 0.
    ///
    /// # Errors
    /// When such a scene cannot be: fields that do not go together.
    pub fn scene(&self, values: &[f64]) -> Result<Scene, SceneError> {
        let of_unknowns =
            self.unknowns.iter().zip(values).flat_map(|(unknown, &value)| unknown.arguments(value));
        let set: Vec<String> = self.set.iter().cloned().chain(of_unknowns).collect();
        match &self.base {
            Some(path) => Scene::read_with(path, &set),
            None => Scene::singh2014().with_overrides(&set),
        }
    }

    /// Both ends of every range, and every choice, must be values that their field can have, the others in
    /// the middle.
    fn check_ends(&self, place: &File<'_>) -> Result<(), SceneError> {
        let middle: Vec<f64> = self.unknowns.iter().map(Values::middle_of).collect();
        for (n, unknown) in self.unknowns.iter().enumerate() {
            for value in unknown.values.ends() {
                let mut values = middle.clone();
                values[n] = value;
                let Err(why) = self.scene(&values) else { continue };
                let arguments = unknown.arguments(value);
                let blamed = |problem: &&Problem| match &problem.place {
                    Place::CommandLine { argument, .. } => arguments.contains(argument),
                    _ => false,
                };
                if let Some(problem) = why.problems().iter().find(blamed) {
                    let at = place.place(&format!("unknowns[{n}]"));
                    return Err(problem.clone().of_value_at(at).into());
                }
                let of_file = |problem: &&Problem| matches!(&problem.place, Place::CommandLine { argument, .. } if self.set.contains(argument));
                if why.problems().iter().any(|problem| of_file(&problem)) {
                    return Err(place.of_base(why));
                }
            }
        }
        Ok(())
    }
}

impl Values {
    fn middle_of(unknown: &Unknown) -> f64 {
        match &unknown.values {
            Self::Range { from, to, log: false } => 0.5 * (from + to),
            Self::Range { from, to, log: true } => (from * to).sqrt(),
            Self::Normal { mean, from, to, .. } => mean.clamp(*from, *to),
            Self::Listed(_) | Self::Sets(_) | Self::Readings(_) => 0.0,
        }
    }

    /// Values that are tried before anything is run.
    fn ends(&self) -> Vec<f64> {
        match self {
            Self::Range { from, to, .. } | Self::Normal { from, to, .. } => vec![*from, *to],
            Self::Listed(values) => (0..values.len()).map(|n| n as f64).collect(),
            Self::Sets(sets) => (0..sets.len()).map(|n| n as f64).collect(),
            Self::Readings(_) => Vec::new(),
        }
    }
}
