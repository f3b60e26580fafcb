//! Which target moves which field: the posterior without one target beside the posterior with all.

use serde::{Deserialize, Serialize};

use crate::{
    emulator::Emulator,
    error::Error,
    interval::weighted_moments,
    likelihood::Likelihood,
    posterior::{self, Posterior, PosteriorOptions},
    prior::Prior,
    runs::Target,
};

/// Draws are reweighted if their effective share is above this; otherwise the posterior is sampled again,
/// since draws of a narrow posterior do not cover the tails of a wide one.
const ENOUGH: f64 = 0.3;

/// Effect of one target on one field.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pull {
    /// Number of the target.
    pub target: usize,
    /// Number of the coordinate.
    pub field: usize,
    /// How far the target moves the mean of the coordinate, in standard deviations of the posterior with all
    /// targets: positive where it pulls to larger values.
    pub shift: f64,
    /// Variance with the target over the variance without: below 1 where it narrows the field.
    pub variance_ratio: f64,
    /// Kullback–Leibler divergence of the coordinate with the target from the one without [nat], of normal
    /// distributions with their moments.
    pub divergence: f64,
}

/// All pulls, target by target and field by field, of the draws of a posterior.
pub fn pulls(
    emulator: &Emulator,
    priors: &[Prior],
    targets: &[Target],
    posterior: &Posterior,
    options: PosteriorOptions,
) -> Result<Vec<Pull>, Error> {
    posterior::check(emulator, priors)?;
    let likelihood = Likelihood::new(emulator, targets)?;
    let seen = likelihood.see(&posterior.draws);
    let even = vec![1.0 / posterior.draws.len() as f64; posterior.draws.len()];
    let mut pulls = Vec::new();
    for target in 0..targets.len() {
        let change: Vec<f64> = seen
            .iter()
            .map(|seen| likelihood.density(seen, |i| i != target) - likelihood.density(seen, |_| true))
            .collect();
        let (weights, _) = posterior::weights(&change, 1.0);
        let rerun;
        let (draws, weights) = if posterior::effective(&weights) >= ENOUGH * even.len() as f64 {
            (posterior, weights)
        } else {
            let rest = targets.iter().enumerate().filter(|(i, _)| *i != target);
            let rest: Vec<Target> = rest.map(|(_, target)| *target).collect();
            rerun = Posterior::of(emulator, priors, &rest, options)?;
            (&rerun, vec![1.0 / rerun.draws.len() as f64; rerun.draws.len()])
        };
        for field in 0..priors.len() {
            let with = weighted_moments(&posterior.column(field), &even);
            let without = weighted_moments(&draws.column(field), &weights);
            pulls.push(Pull::between(target, field, with, without));
        }
    }
    Ok(pulls)
}

impl Pull {
    /// From mean and standard deviation with the target and without.
    fn between(target: usize, field: usize, with: [f64; 2], without: [f64; 2]) -> Self {
        let least = 1e-9;
        let [sd, sd_without] = [with[1].max(least), without[1].max(least)];
        let (difference, ratio) = (with[0] - without[0], (sd / sd_without).powi(2));
        let divergence = 0.5 * (ratio - 1.0 - ratio.ln() + (difference / sd_without).powi(2));
        Self { target, field, shift: difference / sd, variance_ratio: ratio, divergence }
    }
}
