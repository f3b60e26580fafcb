//! The text of an inference's file, and its meaning.

use super::{
    Budget, FEWEST_BY_UNKNOWN, MOST_RUNS, MOST_STARTS, MOST_TARGETS, MOST_UNKNOWNS, Quantity, Seen, Target,
    Unknown, Values,
};
use crate::document::{File, Written};
use stribeck_scene::fields::group;
use stribeck_scene::scene_file::{self, SceneError};

group! {
    /// Content of the file of an inference.
    pub(super) struct Text {
        /// Its name.
        pub(super) name: String = String::new(), required();
        /// The scene that all runs start from.
        pub(super) scene: Option<String> = None;
        /// Overrides of that scene.
        pub(super) set: Vec<String> = Vec::new();
        /// Seed of all draws.
        pub(super) seed: u64 = 1;
        /// Runs of each scene.
        pub(super) starts: usize = 2, within(1.0, MOST_STARTS as f64);
        /// What is not known.
        pub(super) unknowns: Vec<UnknownText> = Vec::new(), required();
        /// What was observed.
        pub(super) targets: Vec<TargetText> = Vec::new(), required();
        /// How many runs may be made.
        pub(super) budget: BudgetText = BudgetText::default();
    }
}

group! {
    /// An unknown and its prior.
    pub(super) struct UnknownText {
        /// Path of the field.
        field: String = String::new();
        /// Name of a choice.
        name: String = String::new();
        /// Least value.
        from: Option<f64> = None;
        /// Greatest value.
        to: Option<f64> = None;
        /// Evenly over the logarithm.
        log: bool = false;
        /// Mean of a normal distribution.
        mean: Option<f64> = None;
        /// Its standard deviation.
        sd: Option<f64> = None;
        /// Values of the field.
        values: Vec<Written> = Vec::new();
        /// Choices of several overrides.
        sets: Vec<Vec<String>> = Vec::new();
        /// Choices of an item of the summary.
        readings: Vec<String> = Vec::new();
    }
}

group! {
    /// An observation.
    pub(super) struct TargetText {
        /// Its name.
        name: String = String::new();
        /// Path of the quantity.
        of: String = String::new(), required();
        /// A number.
        value: Option<f64> = None;
        /// A curve.
        values: Vec<f64> = Vec::new();
        /// There is none.
        missing: bool = false;
        /// Standard deviation of its error.
        tolerance: f64 = 0.0;
        /// Differences count by their ratio.
        log: bool = false;
    }
}

group! {
    /// How many runs may be made.
    pub(super) struct BudgetText: Copy {
        /// Of all rounds together.
        runs: Option<usize> = None;
        /// Scenes of the first round.
        first: Option<usize> = None;
        /// Scenes of each further round.
        round: Option<usize> = None;
        /// Scenes that check the result.
        check: Option<usize> = None;
    }
}

pub(super) fn unknowns(texts: &[UnknownText], place: &File<'_>) -> Result<Vec<Unknown>, SceneError> {
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
        let values = text.prior(place).map_err(|why| place.refuse(&at, format!("`{name}` {why}")))?;
        unknowns.push(Unknown { name: name.clone(), values });
    }
    Ok(unknowns)
}

impl UnknownText {
    fn prior(&self, place: &File<'_>) -> Result<Values, String> {
        let listed: Vec<String> = self.values.iter().map(|value| place.written(value)).collect();
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

pub(super) fn targets(
    texts: &[TargetText],
    unknowns: &[Unknown],
    place: &File<'_>,
) -> Result<Vec<Target>, SceneError> {
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

pub(super) fn budget(
    text: BudgetText,
    unknowns: usize,
    starts: usize,
    place: &File<'_>,
) -> Result<Budget, SceneError> {
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
            "`budget.first` is {first}; it is {fewest} to {scenes}: {FEWEST_BY_UNKNOWN} scenes an unknown, \
             and no more than all"
        );
        return Err(place.refuse("budget.first", why));
    }
    let round = text.round.unwrap_or((scenes / 8).max(8));
    if round == 0 {
        return Err(place.refuse("budget.round", "`budget.round` is 0; it is 1 or more".to_owned()));
    }
    Ok(Budget { runs, first, round, check: text.check.unwrap_or(12) })
}
