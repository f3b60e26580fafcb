//! How the scatter of runs changes over the cube: a second Gaussian process, on the logarithm of the variance
//! of the first one's residuals (Kersting and others, *Most likely heteroscedastic Gaussian process
//! regression*, ICML 2007), with the weights of Gamma regression, since a mean of squares is Gamma
//! distributed.

use super::{
    hyper::{Hyper, Sample},
    regression::{LeftOut, Regression},
};
use crate::error::Error;

/// Least number of points for a scatter that varies over the cube.
const LEAST_POINTS: usize = 40;

/// Passes of the weighted regression.
const PASSES: usize = 4;

/// A squared residual counts as no more than this many variances, so that one outlier makes no region.
const LARGEST: f64 = 8.0;

/// −E ln χ²₁ and its variance: bias and variance of the logarithm of one squared residual.
const LOG_CHI: [f64; 2] = [1.270_362_845, 4.934_802_2];

/// Runs at one point, as this regression needs them.
pub(super) struct Spread {
    /// Sum of their squared distances from their own mean.
    pub(super) squares: f64,
    /// How many they are.
    pub(super) runs: f64,
}

/// Logarithm of the variance of runs at each point and the function that it follows; none where it is even.
pub(super) struct Scatter {
    pub(super) function: Option<Regression>,
    /// At the points of the sample: variance of one run in units of the even noise.
    pub(super) factors: Vec<f64>,
    /// The same, each as the other points predict it.
    pub(super) left_out: Vec<f64>,
}

impl Scatter {
    /// The same everywhere.
    pub(super) fn even(points: usize) -> Self {
        Self { function: None, factors: vec![1.0; points], left_out: vec![1.0; points] }
    }

    /// From the residuals of a fit with `noise × factors` as the variance of a run.
    pub(super) fn fit(
        sample: &Sample,
        spreads: &[Spread],
        noise: f64,
        factors: &[f64],
        left_out: &[LeftOut],
    ) -> Result<Self, Error> {
        let n = sample.points.len();
        if n < LEAST_POINTS {
            return Ok(Self::even(n));
        }
        let residual = |i: usize, factor: f64| relative(sample, spreads, noise, left_out, i, factor);
        let mut logarithms: Vec<f64> = factors.iter().map(|factor| factor.ln()).collect();
        let start: Vec<f64> = (0..n)
            .map(|i| {
                let [square, freedom] = residual(i, factors[i]);
                logarithms[i] + (square + 1e-4).ln() + LOG_CHI[0] / freedom.max(1.0)
            })
            .collect();
        let weights: Vec<f64> = (0..n).map(|i| LOG_CHI[1] / residual(i, factors[i])[1].max(0.05)).collect();
        let first = Sample { values: &start, factors: &weights, linear: false, ..*sample };
        let hyper = Hyper::fit(&first, None);
        let hyper = Hyper { noise: 1.0, ..hyper };
        let mut function = None;
        let mut others = Vec::new();
        for _ in 0..PASSES {
            let pairs: Vec<[f64; 2]> = (0..n).map(|i| residual(i, logarithms[i].exp())).collect();
            let values: Vec<f64> = (0..n).map(|i| logarithms[i] + pairs[i][0].min(LARGEST) - 1.0).collect();
            let weights: Vec<f64> = pairs.iter().map(|pair| 2.0 / pair[1].max(0.05)).collect();
            let working = Sample { values: &values, factors: &weights, linear: false, ..*sample };
            let (regression, left_out) = Regression::fit(&working, &hyper)?;
            logarithms = regression.means(sample.points).iter().map(|mean| mean.clamp(-12.0, 12.0)).collect();
            others = left_out;
            function = Some(regression);
        }
        Ok(Self {
            function,
            factors: logarithms.iter().map(|x| x.exp()).collect(),
            left_out: others.iter().map(|point| point.mean.clamp(-12.0, 12.0).exp()).collect(),
        })
    }
}

/// Mean squared residual at a point in units of its variance, and the degrees of freedom that it stands on.
/// The part of the residual that the function's own uncertainty explains counts for less.
fn relative(
    sample: &Sample,
    spreads: &[Spread],
    noise: f64,
    left_out: &[LeftOut],
    i: usize,
    factor: f64,
) -> [f64; 2] {
    let (variance, runs) = (noise * factor, spreads[i].runs);
    let whole = left_out[i].variance + variance / runs;
    let share = variance / runs / whole;
    let freedom = runs - 1.0 + share * share;
    let residual = sample.values[i] - left_out[i].mean;
    let square = spreads[i].squares / variance + share * share * residual * residual / whole;
    [square / freedom.max(1e-9), freedom]
}
