//! Are intervals honest? Each run that was drawn from the prior is inferred from its own outputs by an
//! emulator that has not seen it. Where too few of them lie in their 90 % intervals, the likelihood gets a
//! power below 1, the largest with which they do: one number for all fields, which widens the posterior as if
//! so large a part of the evidence counted (N. Syring and R. Martin, *Calibrating general posterior credible
//! regions*, Biometrika 106, 2019).

use serde::{Deserialize, Serialize};

use crate::{
    calibration::{POOL, targets},
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

/// From fewer truths no power is found.
const LEAST_TRUTHS: usize = 40;

/// Share of truths that 90 % intervals are to hold.
const WANTED: f64 = 0.9;

/// Powers that are tried, from 1 downwards.
const STEP: f64 = 0.05;
const LEAST_POWER: f64 = 0.2;

/// The power of the likelihood, and what it is chosen by.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Power {
    /// The power, 1 where intervals hold as they are.
    pub power: f64,
    /// Number of runs that were inferred; 0 where they are too few, and the power is 1.
    pub truths: usize,
    /// Share of truths in their 90 % intervals, over all fields, with a power of 1.
    pub held_plain: f64,
    /// The same with the power.
    pub held: f64,
}

impl Power {
    /// From runs whose first `drawn` rows are draws of the prior. `columns` are the outputs that count, each
    /// with its tolerance.
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
    ) -> Result<Self, Error> {
        let scenes = scenes(runs);
        let truths = truths(runs, &scenes, drawn);
        let dimensions = runs.dimensions();
        if truths.len() < LEAST_TRUTHS || dimensions != priors.len() {
            return Ok(Self { power: 1.0, truths: 0, held_plain: f64::NAN, held: f64::NAN });
        }
        let pool: Vec<Vec<f64>> = design::points(seed ^ 0xca11, dimensions, 0..POOL)
            .iter()
            .map(|point| snapped(priors, point))
            .collect();
        let fields: Vec<Vec<f64>> =
            (0..dimensions).map(|field| pool.iter().map(|point| point[field]).collect()).collect();
        let asked: Vec<usize> = columns.iter().map(|column| column.0).collect();
        let mut random = Random::stream(seed, 6);
        let powers: Vec<f64> = (0..)
            .map(|n| 1.0 - STEP * f64::from(n))
            .take_while(|power| *power > LEAST_POWER - 0.5 * STEP)
            .collect();
        let mut held = vec![0_usize; powers.len()];
        for part in 0..PARTS {
            let emulator = Emulator::fit(&without(runs, &scenes, part), outputs, seed)?;
            let predictions = Predictions::of(&emulator, &asked, &pool);
            for &row in truths.iter().filter(|&&row| scenes[row] % PARTS == part) {
                let targets = targets(outputs, &runs.outputs[row], columns, row, &mut random)?;
                let logs = Likelihood::new(&emulator, &targets)?.at_predicted(&predictions);
                let ties: Vec<f64> = (0..dimensions).map(|_| random.share()).collect();
                for (power, held) in powers.iter().zip(&mut held) {
                    let (weights, _) = posterior::weights(&logs, *power);
                    let within = |field: &usize| {
                        let rank = rank(runs.points[row][*field], &fields[*field], &weights, ties[*field]);
                        (rank - 0.5).abs() <= 0.5 * WANTED
                    };
                    *held += (0..dimensions).filter(within).count();
                }
            }
        }
        let all = (truths.len() * dimensions) as f64;
        let share = |n: usize| held[n] as f64 / all;
        let chosen = (0..powers.len()).find(|&n| share(n) >= WANTED).unwrap_or(powers.len() - 1);
        Ok(Self { power: powers[chosen], truths: truths.len(), held_plain: share(0), held: share(chosen) })
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
