//! Targets that no point of the prior reaches: each alone, in pairs, and all together.

use serde::{Deserialize, Serialize};

use crate::{
    design,
    emulator::Emulator,
    error::Error,
    likelihood::{Likelihood, Seen},
    posterior::{self, Posterior},
    prior::{Prior, snapped},
    random::Random,
    runs::Target,
};

/// Points of the prior among which the best is sought first.
const POOL: usize = 8192;

/// Rounds and points a round by which the best point of a target, a pair, or all is improved.
const ROUNDS: [usize; 2] = [16, 48];

/// A target is out of reach where no point brings it within as many standard deviations: 1 % of runs lie
/// further off.
pub const LIMIT: f64 = 2.576;

/// Nearest prediction to one target over the prior, regardless of the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reach {
    /// Number of the target.
    pub target: usize,
    /// The best point.
    pub point: Vec<f64>,
    /// Distance of the target from the prediction there, in standard deviations of scatter, tolerance and the
    /// emulator's uncertainty: positive where the target is larger. For a target on the existence of an
    /// output, the normal deviate of the probability of that target.
    pub deviations: f64,
    /// Median prediction there, in the output's unit; NaN for a target on existence alone.
    pub prediction: f64,
    /// Probability that the output exists, or does not, as the target asks.
    pub probability: f64,
    /// The same at the point that does best for all targets together.
    pub deviations_together: f64,
}

/// Two targets that can be met one by one but not at once.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Exclusion {
    /// Numbers of the targets.
    pub targets: [usize; 2],
    /// The point that does best for the worse of the two.
    pub point: Vec<f64>,
    /// How far the worse of the two lies off there, in standard deviations.
    pub deviations: f64,
}

/// Targets beyond the prior's reach.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Conflict {
    /// Every target alone.
    pub reaches: Vec<Reach>,
    /// The point that does best for the worst of all targets.
    pub best_point: Vec<f64>,
    /// Pairs that exclude one another.
    pub exclusions: Vec<Exclusion>,
}

impl Conflict {
    /// Of targets, sought over the prior and from the draws of the posterior.
    pub fn of(
        emulator: &Emulator,
        priors: &[Prior],
        targets: &[Target],
        posterior: Option<&Posterior>,
        seed: u64,
    ) -> Result<Self, Error> {
        posterior::check(emulator, priors)?;
        let likelihood = Likelihood::new(emulator, targets)?;
        let mut points = design::points(seed ^ 0xc04f, priors.len(), 0..POOL);
        points.extend(posterior.iter().flat_map(|posterior| posterior.draws.iter().cloned()));
        for point in &mut points {
            *point = snapped(priors, point);
        }
        let misses = misses(&likelihood, &points);
        let mut search =
            Search { likelihood: &likelihood, priors, points, misses, random: Random::stream(seed, 3) };
        let count = targets.len();
        let alone: Vec<(Vec<f64>, f64)> = (0..count).map(|target| search.best(&[target])).collect();
        let all: Vec<usize> = (0..count).collect();
        let best_point = search.best(&all).0;
        let mut exclusions = Vec::new();
        for a in 0..count {
            for b in a + 1..count {
                if alone[a].1 > LIMIT || alone[b].1 > LIMIT {
                    continue;
                }
                let (point, deviations) = search.best(&[a, b]);
                if deviations > LIMIT {
                    exclusions.push(Exclusion { targets: [a, b], point, deviations });
                }
            }
        }
        let together = &likelihood.see(std::slice::from_ref(&best_point))[0];
        let reach = |target: usize| {
            let point = alone[target].0.clone();
            let seen = &likelihood.see(std::slice::from_ref(&point))[0][target];
            Reach {
                target,
                deviations: signed(&likelihood, target, seen),
                prediction: likelihood.prediction(target, seen),
                probability: likelihood.probability(seen),
                deviations_together: signed(&likelihood, target, &together[target]),
                point,
            }
        };
        Ok(Self { reaches: (0..count).map(reach).collect(), best_point, exclusions })
    }

    /// Targets that no point makes, each alone.
    pub fn out_of_reach(&self) -> impl Iterator<Item = &Reach> {
        self.reaches.iter().filter(|reach| reach.deviations.abs() > LIMIT)
    }
}

/// Distance of a target: that of its value, or of its existence where that is unlikely.
fn signed(likelihood: &Likelihood, target: usize, seen: &Seen) -> f64 {
    let rarity = likelihood.rarity(seen);
    match likelihood.deviate(target, seen) {
        Some(deviate) if deviate.abs() >= rarity => deviate,
        _ => rarity,
    }
}

fn misses(likelihood: &Likelihood, points: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let row = |seen: &Vec<Seen>| {
        seen.iter().enumerate().map(|(target, seen)| signed(likelihood, target, seen).abs()).collect()
    };
    likelihood.see(points).iter().map(row).collect()
}

/// Evaluated points, and the distance of each target from them.
struct Search<'a> {
    likelihood: &'a Likelihood<'a>,
    priors: &'a [Prior],
    points: Vec<Vec<f64>>,
    misses: Vec<Vec<f64>>,
    random: Random,
}

impl Search<'_> {
    /// The point where the worst of some targets lies least off, and how far: the best of the pool, then the
    /// best of points around it, nearer and nearer.
    fn best(&mut self, targets: &[usize]) -> (Vec<f64>, f64) {
        let worst = |miss: &[f64]| targets.iter().map(|&target| miss[target]).fold(0.0, f64::max);
        let scores = self.misses.iter().map(|miss| worst(miss)).enumerate();
        let first = scores.min_by(|a, b| a.1.total_cmp(&b.1)).expect("a pool that is not empty");
        let (mut point, mut score) = (self.points[first.0].clone(), first.1);
        let mut width = 0.15;
        for _ in 0..ROUNDS[0] {
            if score < 0.05 {
                break;
            }
            let around: Vec<Vec<f64>> = (0..ROUNDS[1]).map(|_| self.near(&point, width)).collect();
            let scores: Vec<f64> = misses(self.likelihood, &around).iter().map(|miss| worst(miss)).collect();
            let next = (0..around.len()).min_by(|&a, &b| scores[a].total_cmp(&scores[b])).unwrap_or(0);
            if scores[next] < score {
                (point, score) = (around[next].clone(), scores[next]);
            } else {
                width *= 0.6;
            }
        }
        (point, score)
    }

    fn near(&mut self, point: &[f64], width: f64) -> Vec<f64> {
        let some = 0.3 + 0.7 * self.random.share();
        let moved: Vec<f64> = point
            .iter()
            .map(|x| if self.random.share() < some { x + width * self.random.normal() } else { *x })
            .map(|x| x.clamp(0.0, 1.0))
            .collect();
        snapped(self.priors, &moved)
    }
}
