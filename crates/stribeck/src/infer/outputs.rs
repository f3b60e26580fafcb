//! The targets' numbers of every run, as rows of outputs over points of the unit cube.

use anyhow::{Result, bail};
use serde_json::Value;
use stribeck_analysis::summary::Summary;
use stribeck_infer::{Curves, Output, Runs, Scale, Target};
use stribeck_plans::inference::{Inference, Quantity, Seen, Values};
use stribeck_store::run_dir::Keep;

use super::rounds::{Point, Rounds};
use crate::many_runs::{Stage, Wanted, summary_of};

/// Readings of each run that become rows, where an unknown has readings: further ones of the same run add
/// little.
const READINGS: usize = 4;

/// Share of a curve's variance over the runs that its components keep.
const KEPT: f64 = 0.99;

/// Most components of a curve.
const MOST_COMPONENTS: usize = 6;

/// Outputs of every run for the targets.
pub(super) struct Table {
    /// Points and outputs, a row for each run and reading.
    pub(super) runs: Runs,
    pub(super) outputs: Vec<Output>,
    /// Targets of the outputs; a curve has one for each component.
    pub(super) targets: Vec<Target>,
    /// Which target of the file each of these belongs to.
    pub(super) of: Vec<usize>,
    /// Shapes of the curves, by the target of the file.
    curves: Vec<Option<Curves>>,
}

/// One run: its point, and the number or the curve of each target.
pub(super) struct Row {
    pub(super) point: Vec<f64>,
    /// Number of the reading of its run, from 0.
    pub(super) reading: usize,
    pub(super) seen: Vec<Found>,
}

/// Output of a run for a target.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Found {
    Number(Option<f64>),
    Curve(Option<Vec<f64>>),
}

/// The rows of these scenes' runs, by several readings of each where an unknown has readings. Scenes that
/// cannot be and runs that failed are rows without numbers.
pub(super) fn rows(inference: &Inference, rounds: &Rounds<'_>, points: &[Point]) -> Result<Vec<Row>> {
    rows_of_readings(inference, rounds, points, READINGS)
}

/// The same with a limit of readings per run.
pub(super) fn rows_of_readings(
    inference: &Inference,
    rounds: &Rounds<'_>,
    points: &[Point],
    count: usize,
) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for point in points {
        let Ok(scenes) = &point.scenes else {
            rows.push(Row { point: point.shares.clone(), reading: 0, seen: nothing(inference) });
            continue;
        };
        for (number, scene) in scenes.iter().enumerate() {
            let wanted = Wanted { number: number + 1, scene: Ok(scene) };
            let summary = match rounds.runs().stage(Keep::Numbers, wanted)? {
                Stage::Done => Some(summary_of(&rounds.runs().run(scene))?),
                _ => None,
            };
            let readings = readings(inference, &point.shares, count).into_iter().enumerate();
            for (reading, (point, quantities)) in readings {
                let seen = match &summary {
                    Some(summary) => found(inference, &quantities, summary),
                    None => nothing(inference),
                };
                rows.push(Row { point, reading, seen });
            }
        }
    }
    Ok(rows)
}

/// Refuses targets that no number of a summary has, with the nearest name.
pub(super) fn check(inference: &Inference) -> Result<()> {
    let all = Summary::quantities();
    for target in &inference.targets {
        let path = target.of.path();
        if all.iter().all(|quantity| quantity.path != path) {
            let wanted = target.of.to_string();
            let near = all.iter().min_by_key(|quantity| strsim::levenshtein(&quantity.path, &wanted));
            let near = near.map_or("", |quantity| &quantity.path);
            bail!(
                "target `{}`: `{wanted}` is no number of summary.json. The nearest is `{near}`; \
                 a finished run's summary.json has all {} of them",
                target.name,
                all.len()
            );
        }
    }
    Ok(())
}

/// Points and quantities of each reading that is taken of a run: that of its point, and some evenly beyond.
fn readings(inference: &Inference, shares: &[f64], most: usize) -> Vec<(Vec<f64>, Vec<Quantity>)> {
    let plain: Vec<Quantity> = inference.targets.iter().map(|target| target.of.clone()).collect();
    let mut all = vec![(shares.to_vec(), plain)];
    for (dimension, unknown) in inference.unknowns.iter().enumerate() {
        let Values::Readings(readings) = &unknown.values else { continue };
        let count = readings.len();
        let taken = most.min(count);
        let first = (shares[dimension] * count as f64) as usize;
        let one = |k: usize| (first + k * count / taken) % count;
        let with = |(shares, quantities): &(Vec<f64>, Vec<Quantity>), k: usize| {
            let number = one(k);
            let mut shares = shares.clone();
            shares[dimension] = (number as f64 + 0.5) / count as f64;
            let quantities = quantities.iter().map(|of| of.with(&unknown.name, &readings[number])).collect();
            (shares, quantities)
        };
        all = all
            .iter()
            .flat_map(|before| (0..taken).map(move |k| with(before, k)).collect::<Vec<_>>())
            .collect();
    }
    all
}

fn found(inference: &Inference, quantities: &[Quantity], summary: &Value) -> Vec<Found> {
    let one = |(target, of): (&stribeck_plans::inference::Target, &Quantity)| match &target.seen {
        // On a logarithmic scale nothing is no number.
        Seen::Value(_) | Seen::Nothing => {
            Found::Number(of.number(summary).filter(|value| !target.log || *value > 0.0))
        }
        Seen::Curve(curve) => Found::Curve(of.curve(summary).filter(|found| found.len() == curve.len())),
    };
    inference.targets.iter().zip(quantities).map(one).collect()
}

fn nothing(inference: &Inference) -> Vec<Found> {
    let one = |target: &stribeck_plans::inference::Target| match target.seen {
        Seen::Value(_) | Seen::Nothing => Found::Number(None),
        Seen::Curve(_) => Found::Curve(None),
    };
    inference.targets.iter().map(one).collect()
}

impl Table {
    /// Outputs of all rows: numbers as they are, curves by their principal components.
    pub(super) fn of(inference: &Inference, rows: &[Row]) -> Result<Self> {
        let points = rows.iter().map(|row| row.point.clone()).collect();
        let simulation = |number: &mut usize, row: &Row| {
            *number += usize::from(row.reading == 0);
            Some(*number)
        };
        let simulations = rows.iter().scan(0, simulation).collect();
        let mut table = Self {
            runs: Runs { points, outputs: Vec::new(), simulations },
            outputs: Vec::new(),
            targets: Vec::new(),
            of: Vec::new(),
            curves: vec![None; inference.targets.len()],
        };
        for (number, target) in inference.targets.iter().enumerate() {
            match &target.seen {
                Seen::Value(value) => table.push(inference, number, None, Some(*value)),
                Seen::Nothing => table.push(inference, number, None, None),
                Seen::Curve(curve) => {
                    let shapes = shapes(&target.name, rows.iter().map(|row| &row.seen[number]), curve.len())?;
                    for (component, score) in shapes.scores(curve)?.into_iter().enumerate() {
                        table.push(inference, number, Some(component), Some(score));
                    }
                    table.curves[number] = Some(shapes);
                }
            }
        }
        table.runs.outputs = Self::rows_like(inference, &table, rows);
        Ok(table)
    }

    /// Output and tolerance of every target.
    pub(super) fn columns(&self) -> Vec<(usize, f64)> {
        self.targets.iter().map(|target| (target.output, target.tolerance)).collect()
    }

    fn push(&mut self, inference: &Inference, of: usize, component: Option<usize>, value: Option<f64>) {
        let target = &inference.targets[of];
        let name = match component {
            Some(component) => format!("{}, component {}", target.name, component + 1),
            None => target.name.clone(),
        };
        let scale = if target.log && component.is_none() { Scale::Logarithmic } else { Scale::Linear };
        // Shapes of curves are orthonormal: the random error of a score is that of a single sample.
        self.targets.push(Target { output: self.outputs.len(), value, tolerance: target.tolerance });
        self.outputs.push(Output { name, scale });
        self.of.push(of);
    }

    /// Outputs of further rows, in the columns of a table.
    pub(super) fn rows_like(inference: &Inference, table: &Self, rows: &[Row]) -> Vec<Vec<Option<f64>>> {
        let one = |row: &Row| {
            (0..inference.targets.len())
                .flat_map(|number| {
                    let columns = table.of.iter().filter(|of| **of == number).count();
                    match (&row.seen[number], &table.curves[number]) {
                        (Found::Number(value), _) => vec![*value; columns],
                        (Found::Curve(Some(curve)), Some(shapes)) => match shapes.scores(curve) {
                            Ok(scores) => scores.into_iter().map(Some).collect(),
                            Err(_) => vec![None; columns],
                        },
                        _ => vec![None; columns],
                    }
                })
                .collect()
        };
        rows.iter().map(one).collect()
    }
}

/// Principal components of a target's curves over the runs.
fn shapes<'a>(name: &str, found: impl Iterator<Item = &'a Found>, length: usize) -> Result<Curves> {
    let curves: Vec<Vec<f64>> = found
        .filter_map(|found| match found {
            Found::Curve(curve) => curve.clone(),
            Found::Number(_) => None,
        })
        .collect();
    if curves.len() < 3 {
        bail!(
            "target `{name}`: {} runs have a curve of {length} numbers; 3 at least are needed",
            curves.len()
        );
    }
    Ok(Curves::fit(&curves, KEPT, MOST_COMPONENTS)?)
}
