//! How likely it is that a run yields an output at all: a Gaussian process on zeros and ones, whose
//! cross-validated predictions are turned into probabilities by a logistic curve (Rasmussen and Williams,
//! §6.5; Platt 1999).

use super::{
    hyper::{Hyper, Sample, members, representatives},
    regression::Regression,
};
use crate::error::Error;

/// Steps of Newton's method for the two numbers of the logistic curve.
const STEPS: usize = 30;

/// Predictions of the regression nearer to 0 or 1 than this count as this near; the logistic curve may be
/// surer.
const SURE: f64 = 0.02;

#[derive(Debug, Clone)]
pub(super) struct Existence {
    function: Option<Regression>,
    /// Mean and standard deviation of the zeros and ones.
    share: f64,
    deviation: f64,
    offset: f64,
    slope: f64,
    /// Nearest probability to 0 or 1 that this number of runs can support.
    least: f64,
}

impl Existence {
    /// From how many of the runs at each point have it. Readings of one simulation are in one block, which
    /// counts once.
    pub(super) fn fit(
        points: &[Vec<f64>],
        have: &[f64],
        runs: &[f64],
        blocks: &[usize],
    ) -> Result<Self, Error> {
        let shares: Vec<f64> = have.iter().zip(runs).map(|(h, n)| h / n).collect();
        if let Some(kept) = representatives(blocks, &shares) {
            let rows: Vec<usize> = kept.iter().map(|(row, _)| *row).collect();
            let points: Vec<Vec<f64>> = rows.iter().map(|&row| points[row].clone()).collect();
            let [have, runs] = [have, runs].map(|of| rows.iter().map(|&row| of[row]).collect::<Vec<f64>>());
            return Self::fit(&points, &have, &runs, &rows);
        }
        let mut weights = vec![1.0; points.len()];
        for block in members(blocks) {
            block.iter().for_each(|&i| weights[i] = 1.0 / block.len() as f64);
        }
        let weighted = |of: &[f64]| -> Vec<f64> { of.iter().zip(&weights).map(|(x, w)| x * w).collect() };
        let factors: Vec<f64> = runs.iter().map(|n| 1.0 / n).collect();
        let [have, runs] = [&weighted(have), &weighted(runs)];
        let (some, all): (f64, f64) = (have.iter().sum(), runs.iter().sum());
        let least = 0.5 / (all + 1.0);
        let share = (some + 0.5) / (all + 1.0);
        if have.iter().all(|h| *h == 0.0) || have == runs {
            let none = Self { function: None, share, deviation: 0.0, offset: 0.0, slope: 1.0, least };
            return Ok(none);
        }
        let deviation = (share * (1.0 - share)).sqrt();
        let values: Vec<f64> = have.iter().zip(runs).map(|(h, n)| (h / n - share) / deviation).collect();
        let linear = points.len() > points[0].len() + 2;
        let sample = Sample { points, values: &values, factors: &factors, blocks, linear };
        let (function, left_out) = Regression::fit(&sample, &Hyper::fit(&sample, None))?;
        let means: Vec<f64> = left_out.iter().map(|point| logit(share + deviation * point.mean)).collect();
        let [offset, slope] = logistic(&means, have, runs);
        Ok(Self { function: Some(function), share, deviation, offset, slope, least })
    }

    pub(super) fn predict(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let probability = |mean: f64| {
            let x = self.offset + self.slope * logit(self.share + self.deviation * mean);
            (1.0 / (1.0 + (-x).exp())).clamp(self.least, 1.0 - self.least)
        };
        match &self.function {
            None => vec![self.share; points.len()],
            Some(function) => function.means(points).into_iter().map(probability).collect(),
        }
    }
}

/// Logarithm of the odds. A regression on zeros and ones may leave 0 … 1 a little; it is held within `SURE`
/// of the ends.
fn logit(share: f64) -> f64 {
    let share = share.clamp(SURE, 1.0 - SURE);
    (share / (1.0 - share)).ln()
}

/// Offset and slope of the most likely logistic curve, with a weak prior (standard deviations 5) that keeps
/// it finite where the two kinds are separate.
fn logistic(means: &[f64], have: &[f64], runs: &[f64]) -> [f64; 2] {
    let mut at = [0.0, 1.0];
    for _ in 0..STEPS {
        let mut gradient = [-at[0] / 25.0, -at[1] / 25.0];
        let [mut aa, mut ab, mut bb] = [1.0 / 25.0, 0.0, 1.0 / 25.0];
        for ((x, h), n) in means.iter().zip(have).zip(runs) {
            let p = 1.0 / (1.0 + (-at[0] - at[1] * x).exp());
            let weight = n * p * (1.0 - p);
            gradient[0] += h - n * p;
            gradient[1] += (h - n * p) * x;
            aa += weight;
            ab += weight * x;
            bb += weight * x * x;
        }
        let determinant = aa * bb - ab * ab;
        let step = [
            (bb * gradient[0] - ab * gradient[1]) / determinant,
            (aa * gradient[1] - ab * gradient[0]) / determinant,
        ];
        at = [at[0] + step[0].clamp(-2.0, 2.0), at[1] + step[1].clamp(-2.0, 2.0)];
    }
    at
}
