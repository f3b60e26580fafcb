//! The posterior of points, given targets: tempered sequential Monte Carlo (Del Moral, Doucet and Jasra,
//! *Sequential Monte Carlo samplers*, J. Royal Statistical Society B 68, 2006), which starts from the whole
//! prior, so that regions far apart keep their weights, and moves draws by differences of others (ter Braak,
//! *A Markov chain Monte Carlo version of the genetic algorithm Differential Evolution*, Statistics and
//! Computing 16, 2006).

mod moves;

use serde::{Deserialize, Serialize};

use self::moves::{Population, Scales};
use crate::{
    design,
    emulator::Emulator,
    error::Error,
    interval::{interval, moments},
    likelihood::Likelihood,
    prior::{Prior, snapped},
    random::Random,
    runs::Target,
};

/// Points of the prior per draw from which the first stage chooses.
const FIRST: usize = 4;

/// A stage raises the temperature's inverse until so large a share of the draws would still count.
const KEPT: f64 = 0.5;

/// Least and most sweeps of a stage, and of the last.
const SWEEPS: [[usize; 2]; 2] = [[2, 4], [4, 12]];

/// A stage ends when no coordinate's correlation with its start is above this; the last stage at the second.
const FORGOTTEN: [f64; 2] = [0.5, 0.15];

/// How a posterior is sought.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PosteriorOptions {
    /// Number of draws, 50 to 16384.
    pub draws: usize,
    /// Random numbers follow from it.
    pub seed: u64,
}

impl Default for PosteriorOptions {
    fn default() -> Self {
        Self { draws: 2000, seed: 1 }
    }
}

/// Posterior of the point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Posterior {
    /// Draws of equal weight in the unit cube (`[draw][dimension]`), choices in the middle of their cells.
    pub draws: Vec<Vec<f64>>,
    /// Logarithm of the likelihood at each draw.
    pub log_likelihoods: Vec<f64>,
    /// How many independent draws these count for.
    pub effective_sample_size: f64,
    /// Logarithm of the mean likelihood over the prior.
    pub log_evidence: f64,
    /// Stages from prior to posterior.
    pub stages: usize,
    /// Share of proposed moves that were accepted at the last stage.
    pub acceptance: f64,
    /// Number of the emulator's evaluations.
    pub evaluations: usize,
}

impl Posterior {
    /// Of the point, given priors of its coordinates and targets.
    ///
    /// # Errors
    /// When priors do not match the emulator's dimensions or are impossible, a target is invalid, or the
    /// number of draws is out of range.
    pub fn of(
        emulator: &Emulator,
        priors: &[Prior],
        targets: &[Target],
        options: PosteriorOptions,
    ) -> Result<Self, Error> {
        check(emulator, priors)?;
        if !(50..=design::MOST_POINTS / FIRST).contains(&options.draws) {
            let (value, expected) = (options.draws as f64, "50 to 16384");
            return Err(Error::Option { option: "draws", value, expected });
        }
        let likelihood = Likelihood::new(emulator, targets)?;
        Ok(sample(&likelihood, priors, options))
    }

    /// The central interval of a coordinate that holds a share (0 … 1) of the draws. [`Prior::quantile`]
    /// turns its ends into values.
    pub fn interval(&self, field: usize, share: f64) -> [f64; 2] {
        interval(&self.column(field), share)
    }

    /// Mean and standard deviation of a coordinate.
    pub fn moments(&self, field: usize) -> [f64; 2] {
        moments(&self.column(field))
    }

    /// One coordinate of all draws.
    pub fn column(&self, field: usize) -> Vec<f64> {
        self.draws.iter().map(|draw| draw[field]).collect()
    }
}

pub(crate) fn check(emulator: &Emulator, priors: &[Prior]) -> Result<(), Error> {
    if priors.len() != emulator.dimensions() {
        let (found, expected) = (priors.len(), emulator.dimensions());
        return Err(Error::Shape { what: "list of priors", number: 0, found, expected });
    }
    priors.iter().try_for_each(Prior::check)
}

fn sample(likelihood: &Likelihood, priors: &[Prior], options: PosteriorOptions) -> Posterior {
    let mut random = Random::stream(options.seed, 1);
    let log_likelihood = |points: &[Vec<f64>]| {
        let at: Vec<Vec<f64>> = points.iter().map(|point| snapped(priors, point)).collect();
        likelihood.at(&at)
    };
    let first = FIRST * options.draws;
    let points = design::points(options.seed ^ 0x5eed, priors.len(), 0..first);
    let logs = log_likelihood(&points);
    let mut population = Population { points, logs };
    let mut posterior = Posterior {
        draws: Vec::new(),
        log_likelihoods: Vec::new(),
        effective_sample_size: 0.0,
        log_evidence: 0.0,
        stages: 0,
        acceptance: 0.0,
        evaluations: first,
    };
    let mut inverse_temperature = 0.0;
    let mut scales = Scales::default();
    while inverse_temperature < 1.0 {
        let next = raise(&population.logs, inverse_temperature, options.draws);
        let (weights, log_mean) = weights(&population.logs, next - inverse_temperature);
        posterior.log_evidence += log_mean;
        let kept = effective(&weights).min(options.draws as f64);
        population = population.resampled(&weights, options.draws, &mut random);
        inverse_temperature = next;
        let last = usize::from(next >= 1.0);
        let start = population.points.clone();
        let mut forgotten = 1.0;
        for sweep in 1..=SWEEPS[last][1] {
            posterior.acceptance =
                population.sweep(inverse_temperature, &mut scales, &log_likelihood, &mut random);
            posterior.evaluations += options.draws;
            forgotten = correlation(&start, &population.points);
            if sweep >= SWEEPS[last][0] && forgotten < FORGOTTEN[last] {
                break;
            }
        }
        posterior.stages += 1;
        let share = (forgotten * forgotten).min(1.0);
        posterior.effective_sample_size = options.draws as f64 * (1.0 - share) + kept * share;
    }
    posterior.draws = population.points.iter().map(|point| snapped(priors, point)).collect();
    posterior.log_likelihoods = population.logs;
    posterior
}

/// The next inverse temperature: as high as leaves `KEPT` of `draws` counting, at most 1.
fn raise(logs: &[f64], from: f64, draws: usize) -> f64 {
    let enough = KEPT * draws as f64;
    let counts = |to: f64| effective(&weights(logs, to - from).0);
    if counts(1.0) >= enough {
        return 1.0;
    }
    let (mut low, mut high) = (from, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if counts(middle) >= enough {
            low = middle;
        } else {
            high = middle;
        }
    }
    // However sharp the likelihood, a stage gets on.
    low.max(from + 1e-9).max(from * (1.0 + 1e-6))
}

/// Weights of sum 1 after a rise of the inverse temperature, and the logarithm of their mean before that.
pub(crate) fn weights(logs: &[f64], rise: f64) -> (Vec<f64>, f64) {
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let raw: Vec<f64> = logs.iter().map(|log| (rise * (log - most)).exp()).collect();
    let sum: f64 = raw.iter().sum();
    (raw.iter().map(|w| w / sum).collect(), (sum / logs.len() as f64).ln() + rise * most)
}

/// How many draws of equal weight these weights of sum 1 count for (Kish).
pub(crate) fn effective(weights: &[f64]) -> f64 {
    1.0 / weights.iter().map(|w| w * w).sum::<f64>()
}

/// The largest correlation of a coordinate with itself before.
fn correlation(before: &[Vec<f64>], after: &[Vec<f64>]) -> f64 {
    let column =
        |of: &[Vec<f64>], field: usize| -> Vec<f64> { of.iter().map(|point| point[field]).collect() };
    let one = |field: usize| {
        let [a, b] = [column(before, field), column(after, field)];
        let [[mean_a, sd_a], [mean_b, sd_b]] = [moments(&a), moments(&b)];
        let sum: f64 = a.iter().zip(&b).map(|(x, y)| (x - mean_a) * (y - mean_b)).sum();
        let norm = sd_a * sd_b * a.len() as f64;
        if norm > 0.0 { sum / norm } else { 1.0 }
    };
    (0..before[0].len()).map(one).fold(0.0, f64::max)
}
