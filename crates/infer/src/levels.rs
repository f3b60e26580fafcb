//! Are intervals as wide as they have to be? Each run that was drawn from the prior is inferred from its own
//! outputs by an emulator that has not seen it. Where the central 90 % of an unknown's draws hold fewer than
//! 90 % of these runs, its interval takes in the share of draws that does (conformal prediction with ranks as
//! scores: V. Vovk, A. Gammerman and G. Shafer, *Algorithmic Learning in a Random World*, Springer 2005; as
//! quantiles are widened by Y. Romano, E. Patterson and E. Candès, *Conformalized quantile regression*,
//! NeurIPS 2019). No interval becomes narrower.

use serde::{Deserialize, Serialize};

use crate::{
    calibration::targets,
    design,
    emulator::{Emulator, members},
    error::Error,
    interval::rank,
    likelihood::{Likelihood, Predictions},
    posterior,
    prior::{Prior, snapped},
    random::Random,
    runs::{Output, Runs},
};

/// Parts of the runs, each of which is inferred by an emulator of the others.
const PARTS: usize = 5;

/// Fewer truths say nothing.
const LEAST_TRUTHS: usize = 40;

/// Points of the prior that stand for it.
const POOL: usize = 16_384;

/// No interval takes in more of the draws than this.
const MOST: f64 = 0.998;

/// How much of the draws an interval has to take in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Levels {
    /// Runs that were inferred by an emulator of others.
    pub truths: usize,
    /// In the order of the coordinates.
    pub fields: Vec<FieldLevels>,
}

/// The same of one coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FieldLevels {
    /// Share of these runs in the central 90 % of the draws.
    pub held_90: f64,
    /// Share of the draws whose central interval holds half of the runs, ½ at least.
    pub level_50: f64,
    /// Share of the draws whose central interval holds 90 % of the runs, 0.9 at least.
    pub level_90: f64,
}

impl Levels {
    /// From runs whose first `drawn` rows are draws of the prior. `columns` are the outputs that count, each
    /// with its tolerance. None where they are too few.
    ///
    /// # Errors
    /// When runs, priors or columns do not fit together.
    pub fn of(
        runs: &Runs,
        outputs: &[Output],
        priors: &[Prior],
        columns: &[(usize, f64)],
        drawn: usize,
        seed: u64,
    ) -> Result<Option<Self>, Error> {
        runs.check(outputs)?;
        let scenes = scenes(runs);
        let truths = truths(runs, &scenes, drawn);
        let dimensions = runs.dimensions();
        if truths.len() < LEAST_TRUTHS || dimensions != priors.len() {
            return Ok(None);
        }
        let pool: Vec<Vec<f64>> = design::points(seed ^ 0xca11, dimensions, 0..POOL)
            .iter()
            .map(|point| snapped(priors, point))
            .collect();
        let asked: Vec<usize> = columns.iter().map(|column| column.0).collect();
        let mut random = Random::stream(seed, 6);
        let mut scores = vec![Vec::with_capacity(truths.len()); dimensions];
        for part in 0..PARTS {
            let emulator = Emulator::fit(&without(runs, &scenes, part), outputs, seed)?;
            let predictions = Predictions::of(&emulator, &asked, &pool);
            for &row in truths.iter().filter(|&&row| scenes[row] % PARTS == part) {
                let targets = targets(outputs, &runs.outputs[row], columns, row, &mut random)?;
                let logs = Likelihood::new(&emulator, &targets)?.at_predicted(&predictions);
                let (weights, _) = posterior::weights(&logs, 1.0);
                for (field, scores) in scores.iter_mut().enumerate() {
                    let draws: Vec<f64> = pool.iter().map(|point| point[field]).collect();
                    let rank = rank(runs.points[row][field], &draws, &weights, random.share());
                    scores.push((2.0 * rank - 1.0).abs());
                }
            }
        }
        let fields = scores.into_iter().map(FieldLevels::of).collect();
        Ok(Some(Self { truths: truths.len(), fields }))
    }
}

impl FieldLevels {
    /// From the share of draws that each run's smallest central interval takes in.
    fn of(mut scores: Vec<f64>) -> Self {
        scores.sort_by(f64::total_cmp);
        let n = scores.len();
        let level = |share: f64| {
            let place = ((n as f64 + 1.0) * share).ceil() as usize;
            scores.get(place.max(1) - 1).copied().unwrap_or(1.0).clamp(share, MOST)
        };
        let held = scores.iter().filter(|score| **score <= 0.9).count();
        Self { held_90: held as f64 / n as f64, level_50: level(0.5), level_90: level(0.9) }
    }
}

/// Number of the scene of each row, with all of its starts and their readings.
fn scenes(runs: &Runs) -> Vec<usize> {
    let groups = runs.groups();
    let mut scenes = vec![0; runs.points.len()];
    for (scene, block) in members(&runs.blocks(&groups)).iter().enumerate() {
        block.iter().flat_map(|&group| &groups[group]).for_each(|&row| scenes[row] = scene);
    }
    scenes
}

/// One row of each scene among the first `drawn`: its first reading, or another in turn.
fn truths(runs: &Runs, scenes: &[usize], drawn: usize) -> Vec<usize> {
    let mut of_scene = std::collections::BTreeMap::<usize, Vec<usize>>::new();
    for row in 0..drawn.min(runs.points.len()) {
        of_scene.entry(scenes[row]).or_default().push(row);
    }
    of_scene.values().enumerate().map(|(number, rows)| rows[number % rows.len()]).collect()
}

/// The runs without one part of the scenes.
fn without(runs: &Runs, scenes: &[usize], part: usize) -> Runs {
    let rows: Vec<usize> = (0..runs.points.len()).filter(|&row| scenes[row] % PARTS != part).collect();
    Runs {
        points: rows.iter().map(|&row| runs.points[row].clone()).collect(),
        outputs: rows.iter().map(|&row| runs.outputs[row].clone()).collect(),
        simulations: rows.iter().map(|&row| runs.simulation(row)).collect(),
    }
}
