//! The most informative next runs, and how much they would narrow the posterior.

use serde::{Deserialize, Serialize};

use crate::{
    design,
    emulator::Emulator,
    error::Error,
    interval::weighted_moments,
    likelihood::{Likelihood, Seen},
    posterior::{self, Posterior},
    prior::{Prior, snapped},
    random::Random,
    runs::Target,
};

/// Draws of the posterior that are considered.
const CANDIDATES: usize = 400;

/// How next points are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NextOptions {
    /// Number of points.
    pub count: usize,
    /// Share of them that fill the prior evenly whatever the posterior is, 0 … 1, against regions without
    /// runs.
    pub filling: f64,
    /// Points of the filling sequence that earlier calls with this seed have used.
    pub filled: usize,
    /// Random numbers follow from it.
    pub seed: u64,
}

/// Points of the next runs: draws of the posterior where the emulator's uncertainty changes the likelihood
/// most, each given the ones chosen before it, and points that fill the prior.
///
/// # Errors
/// When priors do not match the emulator, a target is invalid, `filling` is out of range, or the filling
/// sequence ends.
pub fn next(
    emulator: &Emulator,
    priors: &[Prior],
    targets: &[Target],
    posterior: &Posterior,
    options: NextOptions,
) -> Result<Vec<Vec<f64>>, Error> {
    posterior::check(emulator, priors)?;
    emulator.check(&posterior.draws)?;
    if !(0.0..=1.0).contains(&options.filling) {
        return Err(Error::Option { option: "filling", value: options.filling, expected: "0 to 1" });
    }
    let likelihood = Likelihood::new(emulator, targets)?;
    let filling = (options.count as f64 * options.filling).round() as usize;
    let sought = options.count - filling;
    let mut random = Random::stream(options.seed, 4);
    let mut candidates = thinned(&posterior.draws, CANDIDATES.max(4 * sought), &mut random);
    let mut chosen = Vec::with_capacity(options.count);
    let mut seen = likelihood.see(&candidates);
    while chosen.len() < sought && !candidates.is_empty() {
        let doubts: Vec<f64> = seen.iter().map(|seen| likelihood.doubt(seen)).collect();
        let best = (0..candidates.len()).max_by(|&a, &b| doubts[a].total_cmp(&doubts[b])).unwrap_or(0);
        let point = candidates.remove(best);
        seen.remove(best);
        likelihood.learn(&candidates, &mut seen, std::slice::from_ref(&point));
        chosen.push(point);
    }
    let first = options.filled;
    let fill = design::sobol(options.seed ^ 0xf111, priors.len(), first, options.count - chosen.len())?;
    chosen.extend(fill.iter().map(|point| snapped(priors, point)));
    Ok(chosen)
}

/// Effect of further runs on one field.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Gain {
    /// Number of the coordinate.
    pub field: usize,
    /// Standard deviation of the coordinate now.
    pub deviation: f64,
    /// Expected value after the runs: at most `deviation`, within the error of reweighting.
    pub after: f64,
    /// Expected value without the emulator's uncertainty: the scatter of starts and the targets' tolerances
    /// remain.
    pub limit: f64,
}

/// How much runs at further points are expected to narrow each field. To first order: the emulator's mean is
/// assumed right, with its uncertainty after those runs; draws are reweighted.
///
/// # Errors
/// When priors or points do not match the emulator, or a target is invalid.
pub fn expected_gain(
    emulator: &Emulator,
    priors: &[Prior],
    targets: &[Target],
    posterior: &Posterior,
    points: &[Vec<f64>],
) -> Result<Vec<Gain>, Error> {
    posterior::check(emulator, priors)?;
    emulator.check(points)?;
    let likelihood = Likelihood::new(emulator, targets)?;
    let now = likelihood.see(&posterior.draws);
    let mut after = now.clone();
    likelihood.learn(&posterior.draws, &mut after, points);
    let mut limit = now.clone();
    limit.iter_mut().flatten().for_each(|seen| seen.uncertainty = 0.0);
    let [after, limit] = [after, limit].map(|then| weights(&likelihood, &now, &then));
    let even = vec![1.0 / now.len() as f64; now.len()];
    let gain = |field: usize| {
        let column = posterior.column(field);
        let deviation = |weights: &[f64]| weighted_moments(&column, weights)[1];
        Gain { field, deviation: deviation(&even), after: deviation(&after), limit: deviation(&limit) }
    };
    Ok((0..priors.len()).map(gain).collect())
}

fn weights(likelihood: &Likelihood, now: &[Vec<Seen>], then: &[Vec<Seen>]) -> Vec<f64> {
    let change = |(now, then): (&Vec<Seen>, &Vec<Seen>)| {
        likelihood.density(then, |_| true) - likelihood.density(now, |_| true)
    };
    let logs: Vec<f64> = now.iter().zip(then).map(change).collect();
    posterior::weights(&logs, 1.0).0
}

/// Some of the draws, without repeats.
fn thinned(draws: &[Vec<f64>], count: usize, random: &mut Random) -> Vec<Vec<f64>> {
    let mut rows: Vec<usize> = (0..draws.len()).collect();
    for i in (1..rows.len()).rev() {
        rows.swap(i, random.below(i + 1));
    }
    let mut some: Vec<Vec<f64>> = Vec::new();
    for row in rows {
        if some.len() == count {
            break;
        }
        if !some.contains(&draws[row]) {
            some.push(draws[row].clone());
        }
    }
    some
}
