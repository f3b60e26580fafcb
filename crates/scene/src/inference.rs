//! Inferences: which scenes could have made the numbers that somebody saw.
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
//! Each unknown has a prior; each target a number, or a curve, of `summary.json`. `readings` are no part of the
//! scene: they say which of several items of every run is the one that was seen, as `{sensor}` in a path. What is simulated, and what
//! follows from it, is not decided here.

mod quantity;
mod refusal;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use ron::value::RawValue;
use serde::Deserialize;

use crate::document::{File, unreadable};
use crate::scene::Scene;
use crate::scene_file::{self, Place, Problem, SceneError, dialect, without_mark};
pub use quantity::{Quantity, Take, names};
use refusal::INFERENCE;

/// Most unknowns of an inference: beyond, no number of runs that anybody makes fills their space.
pub const MOST_UNKNOWNS: usize = 30;
/// Most targets.
pub const MOST_TARGETS: usize = 100;
/// Most starts of a scene.
pub const MOST_STARTS: usize = 100;
/// Most runs.
pub const MOST_RUNS: usize = 100_000;
/// Fewest scenes of the first round, by unknown: fewer cannot tell one from another.
const FEWEST_BY_UNKNOWN: usize = 4;

/// What lies in the file of an inference.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename = "inference")]
struct Text {
    name: String,
    #[serde(default)]
    scene: Option<PathBuf>,
    #[serde(default)]
    set: Vec<String>,
    #[serde(default = "one")]
    seed: u64,
    #[serde(default = "two")]
    starts: usize,
    unknowns: Vec<UnknownText>,
    targets: Vec<TargetText>,
    #[serde(default)]
    budget: BudgetText,
}

fn one() -> u64 {
    1
}

fn two() -> usize {
    2
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename = "unknown")]
struct UnknownText {
    #[serde(default)]
    field: String,
    #[serde(default)]
    name: String,
    #[serde(default)]
    from: Option<f64>,
    #[serde(default)]
    to: Option<f64>,
    #[serde(default)]
    log: bool,
    #[serde(default)]
    mean: Option<f64>,
    #[serde(default)]
    sd: Option<f64>,
    #[serde(default)]
    values: Vec<Box<RawValue>>,
    #[serde(default)]
    sets: Vec<Vec<String>>,
    #[serde(default)]
    readings: Vec<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename = "target")]
struct TargetText {
    #[serde(default)]
    name: String,
    of: String,
    #[serde(default)]
    value: Option<f64>,
    #[serde(default)]
    values: Vec<f64>,
    #[serde(default)]
    missing: bool,
    #[serde(default)]
    tolerance: f64,
    #[serde(default)]
    log: bool,
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename = "budget")]
struct BudgetText {
    runs: Option<usize>,
    first: Option<usize>,
    round: Option<usize>,
    check: Option<usize>,
}

/// An inference that can be made.
#[derive(Debug, Clone)]
pub struct Inference {
    /// Its name.
    pub name: String,
    /// The text of its file.
    pub text: String,
    /// What is drawn follows from it.
    pub seed: u64,
    /// Runs of each scene, which differ in their starts.
    pub starts: usize,
    /// What is not known.
    pub unknowns: Vec<Unknown>,
    /// What was seen.
    pub targets: Vec<Target>,
    /// How many runs may be made.
    pub budget: Budget,
    base: Option<PathBuf>,
    set: Vec<String>,
}

/// A field of the scene, or several that go together, whose value is not known.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Name: the field's path, or the one given.
    pub name: String,
    /// What it may be.
    pub values: Values,
}

/// What an unknown may be before anything was seen.
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

/// A number, or a curve, that was seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Name: the one given, or the quantity's.
    pub name: String,
    /// Which number of `summary.json`.
    pub of: Quantity,
    /// What it is.
    pub seen: Seen,
    /// Standard deviation of what was seen, beside that of starts, in the quantity's unit: how exactly it was
    /// read.
    pub tolerance: f64,
    /// Whether differences count by their ratio: levels do.
    pub log: bool,
}

/// What was seen of a quantity.
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

    /// What puts a value into a scene.
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
    /// What is wrong with the file, with its line: its own fields, those of a scene that it names, values
    /// that their field cannot have, and quantities that cannot be read.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let shown = path.display().to_string();
        let text =
            std::fs::read_to_string(path).map_err(|e| unreadable(&shown, &INFERENCE, refusal::FILE, &e))?;
        Self::parse(without_mark(&text), &shown, path.parent().unwrap_or(Path::new("")))
    }

    fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, SceneError> {
        let place = File::new(name, text, &INFERENCE);
        let file: Text = dialect::dialect().from_str(text).map_err(|e| place.not_understood(&e))?;
        if file.name.is_empty() || !file.name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c)) {
            let why = format!("`name` is `{}`; letters, digits, `-` and `_` make a folder's name", file.name);
            return Err(place.refuse("name", why));
        }
        let count = |field: &str, count: usize, most: usize| {
            let why = || format!("`{field}` is {count}; it is 1 to {most}");
            if (1..=most).contains(&count) { Ok(count) } else { Err(place.refuse(field, why())) }
        };
        count("starts", file.starts, MOST_STARTS)?;
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
            None => Scene::default().with_overrides(&set),
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

fn unknowns(texts: &[UnknownText], place: &File<'_>) -> Result<Vec<Unknown>, SceneError> {
    if texts.is_empty() || texts.len() > MOST_UNKNOWNS {
        let why = format!("`unknowns` has {} items; it is 1 to {MOST_UNKNOWNS}", texts.len());
        return Err(place.refuse("unknowns", why));
    }
    let mut unknowns: Vec<Unknown> = Vec::with_capacity(texts.len());
    for (n, text) in texts.iter().enumerate() {
        let at = format!("unknowns[{n}]");
        let name = if text.field.is_empty() { &text.name } else { &text.field };
        if text.sets.is_empty() && text.readings.is_empty() {
            if let Some(problem) = scene_file::unknown_field(&text.field) {
                return Err(place.shown(problem, &format!("{at}.field")));
            }
        } else if text.name.is_empty() {
            return Err(place.refuse(
                &at,
                "a choice of `sets` or `readings` has a `name`, by which it is reported".to_owned(),
            ));
        }
        if unknowns.iter().any(|before| before.name == *name) {
            return Err(place.refuse(&at, format!("`{name}` is named twice: an unknown has one prior")));
        }
        let values = text.prior().map_err(|why| place.refuse(&at, format!("`{name}` {why}")))?;
        unknowns.push(Unknown { name: name.clone(), values });
    }
    Ok(unknowns)
}

impl UnknownText {
    fn prior(&self) -> Result<Values, String> {
        let listed: Vec<String> = self.values.iter().map(|value| value.get_ron().trim().to_owned()).collect();
        let choices = [listed.len(), self.sets.len(), self.readings.len()];
        let range = self.from.is_some() || self.to.is_some() || self.mean.is_some();
        if choices.iter().filter(|count| **count > 0).count() + usize::from(range) != 1 {
            return Err("takes one of `values: […]`, `sets: [[…], …]`, `readings: […]`, and `from` and `to`"
                .to_owned());
        }
        match choices {
            [0, 0, 0] => {}
            [1, 0, 0] | [0, 1, 0] | [0, 0, 1] => {
                return Err(
                    "has one choice, which is no unknown: `set: [\"field=value\"]` gives it".to_owned()
                );
            }
            [_, 0, 0] => return Ok(Values::Listed(listed)),
            [0, _, 0] => return Ok(Values::Sets(self.sets.clone())),
            _ => return Ok(Values::Readings(self.readings.clone())),
        }
        let (Some(from), Some(to)) = (self.from, self.to) else {
            return Err("has one end; a prior has `from` and `to`".to_owned());
        };
        if !(from.is_finite() && to.is_finite() && from < to && (!self.log || from > 0.0)) {
            return Err(format!(
                "goes from {from} to {to}; `from` is below `to`, and above 0 with `log: true`"
            ));
        }
        match (self.mean, self.sd) {
            (None, None) => Ok(Values::Range { from, to, log: self.log }),
            (Some(_), Some(_)) if self.log => Err("has `log` and `mean`; one of the two".to_owned()),
            (Some(mean), Some(sd)) if mean.is_finite() && sd.is_finite() && sd > 0.0 => {
                Ok(Values::Normal { mean, sd, from, to })
            }
            _ => Err("is normal with `mean` and `sd`, the latter above 0".to_owned()),
        }
    }
}

fn targets(texts: &[TargetText], unknowns: &[Unknown], place: &File<'_>) -> Result<Vec<Target>, SceneError> {
    if texts.is_empty() || texts.len() > MOST_TARGETS {
        let why = format!("`targets` has {} items; it is 1 to {MOST_TARGETS}", texts.len());
        return Err(place.refuse("targets", why));
    }
    let mut targets: Vec<Target> = Vec::with_capacity(texts.len());
    for (n, text) in texts.iter().enumerate() {
        let at = format!("targets[{n}]");
        let of = Quantity::parse(&text.of).map_err(|why| place.refuse(&format!("{at}.of"), why))?;
        let readings = |unknown: &&Unknown| matches!(unknown.values, Values::Readings(_));
        if let Some(lost) = of
            .placeholders()
            .into_iter()
            .find(|name| !unknowns.iter().filter(readings).any(|unknown| unknown.name == *name))
        {
            let why =
                format!("`{}` asks for `{{{lost}}}`, and no unknown of `readings` has that name", text.of);
            return Err(place.refuse(&format!("{at}.of"), why));
        }
        let name = if text.name.is_empty() { text.of.clone() } else { text.name.clone() };
        if targets.iter().any(|before| before.name == name) {
            return Err(place.refuse(&at, format!("`{name}` is named twice: a target has one value")));
        }
        let seen = text.seen().map_err(|why| place.refuse(&at, format!("`{name}` {why}")))?;
        if !(text.tolerance >= 0.0 && text.tolerance.is_finite()) {
            let why = format!("`tolerance` of `{name}` is {}; it is 0 or more", text.tolerance);
            return Err(place.refuse(&format!("{at}.tolerance"), why));
        }
        targets.push(Target { name, of, seen, tolerance: text.tolerance, log: text.log });
    }
    Ok(targets)
}

impl TargetText {
    fn seen(&self) -> Result<Seen, String> {
        let seen = match (self.value, self.values.is_empty(), self.missing) {
            (Some(value), true, false) => Seen::Value(value),
            (None, false, false) => Seen::Curve(self.values.clone()),
            (None, true, true) => Seen::Nothing,
            _ => return Err("takes one of `value`, `values: […]` and `missing: true`".to_owned()),
        };
        let all = match &seen {
            Seen::Value(value) => std::slice::from_ref(value),
            Seen::Curve(values) => values,
            Seen::Nothing => &[],
        };
        if all.iter().any(|value| !value.is_finite() || (self.log && *value <= 0.0)) {
            return Err("is a finite number, above 0 with `log: true`".to_owned());
        }
        Ok(seen)
    }
}

fn budget(text: BudgetText, unknowns: usize, starts: usize, place: &File<'_>) -> Result<Budget, SceneError> {
    let fewest = FEWEST_BY_UNKNOWN * unknowns;
    let runs = text.runs.unwrap_or(60 * unknowns * starts);
    let scenes = runs / starts;
    if scenes < fewest || runs > MOST_RUNS {
        let why = format!(
            "`budget.runs` is {runs}, which are {scenes} scenes of {starts} starts; {unknowns} unknowns take \
             {fewest} scenes at least, {} runs, and there are {MOST_RUNS} runs at most",
            fewest * starts
        );
        return Err(place.refuse(if text.runs.is_some() { "budget.runs" } else { "budget" }, why));
    }
    let first = text.first.unwrap_or((12 * unknowns).max(scenes / 3).min(scenes));
    if first < fewest || first > scenes {
        let why = format!(
            "`budget.first` is {first}; it is {fewest} to {scenes}: {FEWEST_BY_UNKNOWN} scenes an unknown, and no \
             more than all"
        );
        return Err(place.refuse("budget.first", why));
    }
    let round = text.round.unwrap_or((scenes / 8).max(8));
    if round == 0 {
        return Err(place.refuse("budget.round", "`budget.round` is 0; it is 1 or more".to_owned()));
    }
    Ok(Budget { runs, first, round, check: text.check.unwrap_or(12) })
}
