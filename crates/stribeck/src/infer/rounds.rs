//! Which scenes an inference has run, round by round: `rounds/NN.csv` has a line for each, written before any
//! of them runs, so that a continued inference runs the same ones.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Result, ensure};
use stribeck_infer::Prior;
use stribeck_plans::inference::{Inference, Unknown, Values};
use stribeck_scene::ensemble::start;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::{Keep, write_atomic};

use crate::many_runs::{ManyRuns, Stage, Wanted};
use crate::place::shown;

/// One scene of a round, with all of its starts.
#[derive(Debug, Clone)]
pub(super) struct Point {
    /// Its place in the unit cube, an unknown each.
    pub(super) shares: Vec<f64>,
    /// Its starts, or why there is no such scene.
    pub(super) scenes: Result<Vec<Scene>, String>,
}

/// Which scenes these are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Round {
    /// Of the inference, from 1.
    Number(usize),
    /// Drawn from the posterior, to see whether they make the targets.
    Check,
    /// Drawn from the prior, to see whether intervals hold them.
    Truths,
}

impl Round {
    fn file(self) -> String {
        match self {
            Self::Number(number) => format!("{number:02}.csv"),
            Self::Check => "check.csv".to_owned(),
            Self::Truths => "truths.csv".to_owned(),
        }
    }

    /// In words.
    pub(super) fn shown(self) -> String {
        match self {
            Self::Number(number) => format!("round {number}"),
            Self::Check => "check of the posterior".to_owned(),
            Self::Truths => "truths of the calibration".to_owned(),
        }
    }
}

pub(super) fn prior(unknown: &Unknown) -> Prior {
    match &unknown.values {
        Values::Range { from, to, log: false } => Prior::Uniform { from: *from, to: *to },
        Values::Range { from, to, log: true } => Prior::LogUniform { from: *from, to: *to },
        Values::Normal { mean, sd, from, to } => Prior::Normal { mean: *mean, sd: *sd, from: *from, to: *to },
        Values::Listed(_) | Values::Sets(_) | Values::Readings(_) => {
            Prior::Choices(unknown.choices().unwrap_or(1))
        }
    }
}

/// Scenes that an inference has planned so far.
pub(super) struct Rounds<'a> {
    inference: &'a Inference,
    priors: Vec<Prior>,
    folder: PathBuf,
    runs: ManyRuns,
}

impl<'a> Rounds<'a> {
    pub(super) fn new(inference: &'a Inference, folder: PathBuf) -> Self {
        let runs = ManyRuns(folder.clone());
        Self { inference, priors: inference.unknowns.iter().map(prior).collect(), folder, runs }
    }

    pub(super) fn priors(&self) -> &[Prior] {
        &self.priors
    }

    pub(super) fn runs(&self) -> &ManyRuns {
        &self.runs
    }

    fn path(&self, round: Round) -> PathBuf {
        self.folder.join("rounds").join(round.file())
    }

    /// The scenes of a round; `None` when it is not planned yet.
    pub(super) fn read(&self, round: Round) -> Result<Option<Vec<Point>>> {
        let path = self.path(round);
        let Ok(text) = std::fs::read_to_string(&path) else { return Ok(None) };
        let unknowns = self.inference.unknowns.len();
        let line = |(number, line): (usize, &str)| {
            let shares: Vec<f64> =
                line.split(',').map_while(|cell| cell.trim().parse().ok()).take(unknowns).collect();
            ensure!(
                shares.len() == unknowns && shares.iter().all(|share| (0.0..=1.0).contains(share)),
                "`{}`, line {}: {unknowns} shares from 0 to 1 are expected; delete the file to plan the \
                 round anew",
                shown(&path),
                number + 1
            );
            Ok(self.point(round, number, shares))
        };
        text.lines().enumerate().skip(1).map(line).collect::<Result<_>>().map(Some)
    }

    /// Plans a round: writes down its points.
    pub(super) fn plan(&self, round: Round, shares: &[Vec<f64>]) -> Result<Vec<Point>> {
        let path = self.path(round);
        let names: Vec<&str> = self.inference.unknowns.iter().map(|unknown| unknown.name.as_str()).collect();
        let mut text = String::new();
        let head: Vec<String> = names.iter().map(|name| format!("share of {name}")).collect();
        writeln!(text, "{},{}", head.join(","), names.join(","))?;
        for shares in shares {
            let numbers: Vec<String> = shares.iter().map(ToString::to_string).collect();
            let values = self.values(shares);
            let written = self
                .inference
                .unknowns
                .iter()
                .zip(&values)
                .map(|(unknown, &value)| quoted(&unknown.written(value)));
            writeln!(text, "{},{}", numbers.join(","), written.collect::<Vec<_>>().join(","))?;
        }
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        write_atomic(&path, text.as_bytes())?;
        Ok(shares.iter().enumerate().map(|(n, shares)| self.point(round, n + 1, shares.clone())).collect())
    }

    /// Values of all unknowns at a place of the unit cube, in their units; of choices their numbers.
    pub(super) fn values(&self, shares: &[f64]) -> Vec<f64> {
        self.priors.iter().zip(shares).map(|(prior, &share)| prior.quantile(share)).collect()
    }

    /// Every scene has its own starts, so that scatter is independent between scenes. A truth has one.
    fn point(&self, round: Round, number: usize, shares: Vec<f64>) -> Point {
        let starts = if round == Round::Truths { 1 } else { self.inference.starts };
        let scenes =
            self.inference.scene(&self.values(&shares)).map_err(|why| why.to_string()).map(|scene| {
                let seed = match round {
                    Round::Number(round) => 1000 * round,
                    Round::Check => 1_000_000,
                    Round::Truths => 2_000_000,
                };
                let seed = self.inference.seed.wrapping_mul(0x9E37_79B9_7F4A_7C15)
                    ^ ((seed as u64) << 32)
                    ^ number as u64;
                (1..=starts).map(|number| start(&scene, seed, number)).collect()
            });
        Point { shares, scenes }
    }

    /// Runs of a round, a number for each start.
    pub(super) fn wanted(points: &[Point]) -> impl Iterator<Item = Wanted<'_>> {
        let scenes = points.iter().flat_map(|point| match &point.scenes {
            Ok(scenes) => scenes.iter().map(Ok).collect::<Vec<_>>(),
            Err(why) => vec![Err(why.as_str())],
        });
        scenes.enumerate().map(|(n, scene)| Wanted { number: n + 1, scene })
    }

    /// How many runs of a round are not at their end.
    pub(super) fn left(&self, points: &[Point]) -> Result<usize> {
        let mut left = 0;
        for wanted in Self::wanted(points) {
            left += usize::from(matches!(self.runs.stage(Keep::Numbers, wanted)?, Stage::Due | Stage::Ended));
        }
        Ok(left)
    }
}

/// As a cell of a CSV file.
fn quoted(text: &str) -> String {
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
