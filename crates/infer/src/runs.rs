//! Runs: points, outputs, and the targets for them.

use serde::{Deserialize, Serialize};

use crate::error::Error;

/// Runs of a simulation, a row each. Several starts of one scene are rows with equal points.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Runs {
    /// Where each run lies in the unit cube (`[run][dimension]`, 0 … 1; choices in the middle of their
    /// cells).
    pub points: Vec<Vec<f64>>,
    /// Outputs (`[run][output]`, each in its own unit); none where a run does not yield the quantity, such as
    /// a tone that is not found.
    pub outputs: Vec<Vec<Option<f64>>>,
    /// Number of the simulation that each row is a reading of; empty where every row has its own. Readings
    /// of one simulation have the chance of its start in common, so together they count for less than as
    /// many simulations.
    pub simulations: Vec<usize>,
}

/// A column of outputs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Output {
    /// Its name, for messages.
    pub name: String,
    /// Where it is smooth and its scatter even.
    pub scale: Scale,
}

/// The scale on which an output is emulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// As it is.
    #[default]
    Linear,
    /// Its logarithm: levels, counts and ratios, which must be positive.
    Logarithmic,
}

/// A target for an output.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Target {
    /// Column of the output.
    pub output: usize,
    /// Its value, in the output's unit; none if the quantity must be missing.
    pub value: Option<f64>,
    /// Standard deviation of the value itself, in the output's unit, beside the scatter of runs. 0 if it was
    /// made by a run of the same simulation.
    pub tolerance: f64,
}

impl Scale {
    pub(crate) fn forward(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic => value.ln(),
        }
    }

    /// The number in the output's unit.
    pub(crate) fn back(self, scaled: f64) -> f64 {
        match self {
            Self::Linear => scaled,
            Self::Logarithmic => scaled.exp(),
        }
    }

    /// How much the output changes for one on this scale, at a value of the output.
    pub(crate) fn slope(self, value: f64) -> f64 {
        match self {
            Self::Linear => 1.0,
            Self::Logarithmic => value.abs(),
        }
    }
}

impl Runs {
    /// Dimensions of a point; 0 without runs.
    pub fn dimensions(&self) -> usize {
        self.points.first().map_or(0, Vec::len)
    }

    /// Whether rows and columns fit together and every number is in its range.
    ///
    /// # Errors
    /// Names the first row that is wrong.
    pub fn check(&self, outputs: &[Output]) -> Result<(), Error> {
        let shape = |what, number, found, expected| Err(Error::Shape { what, number, found, expected });
        if self.outputs.len() != self.points.len() {
            return shape("table", 0, self.outputs.len(), self.points.len());
        }
        if !self.simulations.is_empty() && self.simulations.len() != self.points.len() {
            return shape("list of simulations", 0, self.simulations.len(), self.points.len());
        }
        for (row, (point, values)) in self.points.iter().zip(&self.outputs).enumerate() {
            if point.len() != self.dimensions() {
                return shape("point", row, point.len(), self.dimensions());
            }
            if values.len() != outputs.len() {
                return shape("row of outputs", row, values.len(), outputs.len());
            }
            check_point(point, row)?;
            for (number, (value, output)) in values.iter().zip(outputs).enumerate() {
                let expected = match (value, output.scale) {
                    (Some(value), _) if !value.is_finite() => "must be finite, or none where it is missing",
                    (Some(value), Scale::Logarithmic) if *value <= 0.0 => {
                        "must be positive on a logarithmic scale; use `Linear` or leave it out"
                    }
                    _ => continue,
                };
                let (what, value) = (format!("output `{}`", output.name), value.unwrap_or(f64::NAN));
                return Err(Error::Value { what, number, row, value, expected });
            }
        }
        Ok(())
    }

    pub(crate) fn simulation(&self, row: usize) -> usize {
        self.simulations.get(row).copied().unwrap_or(row)
    }

    /// Which of these groups of rows belong together: a number each, equal where they have a simulation in
    /// common.
    pub(crate) fn blocks(&self, groups: &[Vec<usize>]) -> Vec<usize> {
        let mut of_simulation = std::collections::BTreeMap::new();
        let one = |(number, group): (usize, &Vec<usize>)| {
            let known = group.iter().find_map(|&row| of_simulation.get(&self.simulation(row)).copied());
            let block = known.unwrap_or(number);
            for &row in group {
                of_simulation.entry(self.simulation(row)).or_insert(block);
            }
            block
        };
        groups.iter().enumerate().map(one).collect()
    }

    /// Rows with equal points, in the order of first occurrence.
    pub(crate) fn groups(&self) -> Vec<Vec<usize>> {
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        let compare = |&a: &usize, &b: &usize| {
            let pairs = self.points[a].iter().zip(&self.points[b]);
            pairs.map(|(p, q)| p.total_cmp(q)).find(|o| o.is_ne()).unwrap_or(a.cmp(&b))
        };
        order.sort_by(compare);
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for row in order {
            match groups.last_mut() {
                Some(group) if self.points[group[0]] == self.points[row] => group.push(row),
                _ => groups.push(vec![row]),
            }
        }
        groups.sort_by_key(|group| group[0]);
        groups
    }
}

pub(crate) fn check_point(point: &[f64], row: usize) -> Result<(), Error> {
    let outside = |value: &f64| !(0.0..=1.0).contains(value);
    match point.iter().position(outside) {
        Some(number) => {
            let (what, expected) = ("coordinate".to_owned(), "must lie in the unit cube, 0 to 1");
            Err(Error::Value { what, number, row, value: point[number], expected })
        }
        None => Ok(()),
    }
}

impl Target {
    /// Whether it asks for a number that its output can have.
    ///
    /// # Errors
    /// Names the invalid number and its range.
    pub fn check(&self, number: usize, outputs: &[Output]) -> Result<(), Error> {
        let Some(output) = outputs.get(self.output) else {
            let why = format!("there are outputs 0 to {} only", outputs.len().saturating_sub(1));
            return Err(Error::Target { number, output: self.output.to_string(), why });
        };
        let refuse = |why: String| Err(Error::Target { number, output: output.name.clone(), why });
        match self.value {
            Some(value) if !value.is_finite() => refuse(format!("value = {value}: must be finite")),
            Some(value) if output.scale == Scale::Logarithmic && value <= 0.0 => {
                refuse(format!("value = {value}: must be positive on a logarithmic scale"))
            }
            _ if !(self.tolerance.is_finite() && self.tolerance >= 0.0) => {
                refuse(format!("tolerance = {}: must be 0 or above", self.tolerance))
            }
            _ => Ok(()),
        }
    }
}
