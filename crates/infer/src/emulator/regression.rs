//! A Gaussian process, through a base of chosen points: exact where every point is chosen, an approximation
//! that costs no more than the square of their number where there are many (Quiñonero-Candela and Rasmussen,
//! *A unifying view of sparse approximate Gaussian process regression*, J. Machine Learning Research 6, 2005,
//! §5; the variance that the base does not carry is added to the prediction's).

use faer::{
    Mat, Par, Side,
    linalg::{
        solvers::Solve,
        triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place},
    },
};

use super::{
    hyper::{Hyper, Sample, members},
    kernel::{Kernel, TREND_VARIANCE, trend},
};
use crate::error::Error;

/// Most points of the base.
const BASE: usize = 320;

/// A point joins the base while the base leaves more than this share of the noise's variance unknown there.
const ENOUGH: f64 = 1e-2;

/// A fitted Gaussian process, in units of the output's standard deviation.
#[derive(Debug, Clone)]
pub(super) struct Regression {
    kernel: Kernel,
    linear: bool,
    /// The chosen points, scaled.
    base: Vec<Vec<f64>>,
    /// Cholesky factor of their covariance.
    base_factor: Mat<f64>,
    /// Cholesky factor of the weights' precision.
    precision_factor: Mat<f64>,
    /// Mean of the weights.
    weights: Mat<f64>,
    /// The same for covariances with the base in place of features.
    base_weights: Mat<f64>,
}

/// Cross-validated predictions: each point of a sample by the other points.
#[derive(Debug, Clone)]
pub(super) struct LeftOut {
    pub(super) mean: f64,
    /// Variance of that mean.
    pub(super) variance: f64,
}

impl Regression {
    /// Of a sample whose values have the variance `noise × factor`.
    pub(super) fn fit(sample: &Sample, hyper: &Hyper) -> Result<(Self, Vec<LeftOut>), Error> {
        let kernel = hyper.kernel.clone();
        let scaled: Vec<Vec<f64>> = sample.points.iter().map(|point| kernel.scale(point)).collect();
        let base = choose(&kernel, &scaled, ENOUGH * hyper.noise);
        let mut covariance = kernel.matrix(&base, &base);
        for i in 0..base.len() {
            covariance[(i, i)] += 1e-10 * kernel.variance + 1e-14;
        }
        let why = Error::Factorisation("covariance of runs");
        let base_factor = covariance.llt(Side::Lower).map_err(|_| why.clone())?.L().to_owned();
        let terms = trend(&sample.points[0], sample.linear).len();
        let mut fitted = Self {
            kernel,
            linear: sample.linear,
            base,
            base_factor,
            precision_factor: Mat::zeros(0, 0),
            weights: Mat::zeros(0, 0),
            base_weights: Mat::zeros(0, 0),
        };
        let (features, rest) = fitted.features(sample.points);
        let (size, n) = (features.nrows(), sample.points.len());
        let noise = Noise::of(sample, hyper);
        let weighted = noise.weighted(&features);
        let mut precision = &weighted * features.transpose();
        for i in 0..size {
            precision[(i, i)] += if i < terms { 1.0 / TREND_VARIANCE } else { 1.0 };
        }
        let factor = precision.llt(Side::Lower).map_err(|_| why)?;
        fitted.weights = factor.solve(&weighted * Mat::from_fn(n, 1, |i, _| sample.values[i]));
        fitted.precision_factor = factor.L().to_owned();
        fitted.base_weights = fitted.weights.subrows(terms, fitted.base.len()).to_owned();
        let upper = fitted.base_factor.transpose();
        solve_upper_triangular_in_place(upper, fitted.base_weights.as_mut(), Par::Seq);
        let left_out = fitted.left_out(sample.values, &noise, features, &rest);
        Ok((fitted, left_out))
    }

    /// Without the value at each point, and without the others of its block (Rasmussen and Williams, eq.
    /// 5.12, in the weights' form).
    fn left_out(&self, values: &[f64], noise: &Noise, mut features: Mat<f64>, rest: &[f64]) -> Vec<LeftOut> {
        let means = features.transpose() * &self.weights;
        solve_lower_triangular_in_place(self.precision_factor.as_ref(), features.as_mut(), Par::Seq);
        let one = |j: usize| {
            let variance = squared_column(&features, j);
            let lever = (variance / noise.variances[j]).min(1.0 - 1e-9);
            let mean = values[j] - (values[j] - means[(j, 0)]) / (1.0 - lever);
            LeftOut { mean, variance: variance / (1.0 - lever) + rest[j] }
        };
        let mut left_out: Vec<LeftOut> = (0..values.len()).map(one).collect();
        for block in noise.blocks.iter().filter(|block| block.len() > 1) {
            let residuals: Vec<f64> = block.iter().map(|&j| values[j] - means[(j, 0)]).collect();
            let known = Mat::from_fn(block.len(), block.len(), |a, b| {
                let [a, b] = [block[a], block[b]].map(|j| features.col(j));
                a.transpose() * b
            });
            let Some((changes, variances)) = without(&noise.within(block), &known, &residuals) else {
                continue;
            };
            for (a, &j) in block.iter().enumerate() {
                left_out[j] = LeftOut { mean: values[j] - changes[a], variance: variances[a] + rest[j] };
            }
        }
        left_out
    }

    /// Features of points, a column each, and the variance that they leave out.
    fn features(&self, points: &[Vec<f64>]) -> (Mat<f64>, Vec<f64>) {
        let scaled: Vec<Vec<f64>> = points.iter().map(|point| self.kernel.scale(point)).collect();
        let mut smooth = self.kernel.matrix(&self.base, &scaled);
        solve_lower_triangular_in_place(self.base_factor.as_ref(), smooth.as_mut(), Par::Seq);
        let rest =
            (0..points.len()).map(|j| (self.kernel.variance - squared_column(&smooth, j)).max(0.0)).collect();
        let trends: Vec<Vec<f64>> = points.iter().map(|point| trend(point, self.linear)).collect();
        let terms = trends.first().map_or(0, Vec::len);
        let at = |i: usize, j: usize| if i < terms { trends[j][i] } else { smooth[(i - terms, j)] };
        (Mat::from_fn(terms + self.base.len(), points.len(), at), rest)
    }

    /// Mean of the function at points, which takes a fraction of the time of [`Self::predict`].
    pub(super) fn means(&self, points: &[Vec<f64>]) -> Vec<f64> {
        let scaled: Vec<Vec<f64>> = points.iter().map(|point| self.kernel.scale(point)).collect();
        let smooth = self.kernel.matrix(&self.base, &scaled).transpose() * &self.base_weights;
        let one = |(j, point): (usize, &Vec<f64>)| {
            let terms = trend(point, self.linear).into_iter().enumerate();
            smooth[(j, 0)] + terms.map(|(i, term)| term * self.weights[(i, 0)]).sum::<f64>()
        };
        points.iter().enumerate().map(one).collect()
    }

    /// Mean and variance of the function at points.
    pub(super) fn predict(&self, points: &[Vec<f64>]) -> Vec<[f64; 2]> {
        let (mut features, rest) = self.features(points);
        let means = features.transpose() * &self.weights;
        solve_lower_triangular_in_place(self.precision_factor.as_ref(), features.as_mut(), Par::Seq);
        (0..points.len()).map(|j| [means[(j, 0)], squared_column(&features, j) + rest[j]]).collect()
    }

    /// Posterior covariance of the function between points: a row for each of `a`, a column for each of `b`.
    pub(super) fn covariance(&self, a: &[Vec<f64>], b: &[Vec<f64>]) -> Mat<f64> {
        let halves = [a, b].map(|points| {
            let (mut features, _) = self.features(points);
            let terms = features.nrows() - self.base.len();
            let smooth = features.subrows(terms, self.base.len()).to_owned();
            solve_lower_triangular_in_place(self.precision_factor.as_ref(), features.as_mut(), Par::Seq);
            (features, smooth)
        });
        let scaled = [a, b].map(|p| p.iter().map(|point| self.kernel.scale(point)).collect::<Vec<_>>());
        let prior = self.kernel.matrix(&scaled[0], &scaled[1]);
        let [(left, left_smooth), (right, right_smooth)] = &halves;
        prior - left_smooth.transpose() * right_smooth + left.transpose() * right
    }

    /// The share of the function's standard deviation that remains at points after values at further ones,
    /// each with its own variance.
    pub(super) fn left_after(&self, points: &[Vec<f64>], further: &[Vec<f64>], noise: &[f64]) -> Vec<f64> {
        let now = self.predict(points);
        let mut among = self.covariance(further, further);
        for (i, variance) in noise.iter().enumerate() {
            among[(i, i)] += variance + 1e-10 * self.kernel.variance;
        }
        let Ok(factor) = among.llt(Side::Lower) else { return vec![1.0; points.len()] };
        let mut across = self.covariance(further, points);
        solve_lower_triangular_in_place(factor.L(), across.as_mut(), Par::Seq);
        let left = |(j, [_, variance]): (usize, &[f64; 2])| {
            let share = 1.0 - squared_column(&across, j) / variance.max(f64::MIN_POSITIVE);
            share.clamp(0.0, 1.0).sqrt()
        };
        now.iter().enumerate().map(left).collect()
    }
}

/// Covariance of the noise of a sample: blocks, within which a share of the noise is common.
struct Noise {
    variances: Vec<f64>,
    blocks: Vec<Vec<usize>>,
    shared: f64,
}

impl Noise {
    fn of(sample: &Sample, hyper: &Hyper) -> Self {
        let variances = sample.factors.iter().map(|factor| hyper.noise * factor).collect();
        Self { variances, blocks: members(sample.blocks), shared: hyper.shared }
    }

    /// Columns times the inverse of the covariance (Sherman and Morrison's formula in each block).
    fn weighted(&self, columns: &Mat<f64>) -> Mat<f64> {
        let own = 1.0 - self.shared;
        let mut weighted =
            Mat::from_fn(columns.nrows(), columns.ncols(), |i, j| columns[(i, j)] / self.variances[j]);
        for block in self.blocks.iter().filter(|block| block.len() > 1) {
            let common = self.shared / (own + self.shared * block.len() as f64);
            for i in 0..columns.nrows() {
                let sum: f64 = block.iter().map(|&j| columns[(i, j)] / self.variances[j].sqrt()).sum();
                for &j in block {
                    weighted[(i, j)] = (weighted[(i, j)] - common * sum / self.variances[j].sqrt()) / own;
                }
            }
        }
        weighted
    }

    fn within(&self, block: &[usize]) -> Mat<f64> {
        Mat::from_fn(block.len(), block.len(), |a, b| {
            let variance = (self.variances[block[a]] * self.variances[block[b]]).sqrt();
            if a == b { variance } else { self.shared * variance }
        })
    }
}

/// Residuals of a block's values by a fit without them, and the variances of that fit, from the covariance
/// of their noise, that of the fit with them, and its residuals. `None` if the fit without the block is
/// singular.
fn without(noise: &Mat<f64>, known: &Mat<f64>, residuals: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let left = noise - known;
    let factor = left.llt(Side::Lower).ok()?;
    let changes = noise * factor.solve(Mat::from_fn(residuals.len(), 1, |i, _| residuals[i]));
    let added = known * factor.solve(known);
    let variances = (0..residuals.len()).map(|i| known[(i, i)] + added[(i, i)]).collect();
    Some(((0..residuals.len()).map(|i| changes[(i, 0)]).collect(), variances))
}

fn squared_column(matrix: &Mat<f64>, column: usize) -> f64 {
    matrix.col(column).squared_norm_l2()
}

/// Points of the base: one after the other where the ones before leave the largest variance (a pivoted
/// Cholesky factorisation), until they leave less than `enough` anywhere.
fn choose(kernel: &Kernel, scaled: &[Vec<f64>], enough: f64) -> Vec<Vec<f64>> {
    let n = scaled.len();
    let mut left = vec![kernel.variance; n];
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut chosen = Vec::new();
    while chosen.len() < BASE.min(n) {
        let next = (0..n).max_by(|&a, &b| left[a].total_cmp(&left[b]).then(b.cmp(&a))).expect("a point");
        if left[next] <= enough.max(1e-9 * kernel.variance) && !chosen.is_empty() {
            break;
        }
        let root = left[next].sqrt();
        let mut column = vec![0.0; n];
        for i in 0..n {
            let known: f64 = columns.iter().map(|column| column[i] * column[next]).sum();
            column[i] = (kernel.between(&scaled[i], &scaled[next]) - known) / root;
            left[i] -= column[i] * column[i];
        }
        left[next] = 0.0;
        columns.push(column);
        chosen.push(scaled[next].clone());
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTH: f64 = 0.4;
    const NOISE: f64 = 0.1;
    const POINTS: [f64; 3] = [0.1, 0.45, 0.8];
    const VALUES: [f64; 3] = [0.3, -0.8, 1.1];

    /// Relative tolerance: the sum of a jitter of 1e-10 and rounding.
    const CLOSE: f64 = 1e-6;

    fn covariance(x: f64, y: f64) -> f64 {
        let r = 5_f64.sqrt() * (x - y).abs() / LENGTH;
        TREND_VARIANCE + (1.0 + r + r * r / 3.0) * (-r).exp()
    }

    fn fitted(points: &[f64], values: &[f64], factors: &[f64]) -> (Regression, Vec<LeftOut>) {
        in_blocks(points, values, factors, &[0, 1, 2][..points.len()], 0.0)
    }

    fn in_blocks(
        points: &[f64],
        values: &[f64],
        factors: &[f64],
        blocks: &[usize],
        shared: f64,
    ) -> (Regression, Vec<LeftOut>) {
        let points: Vec<Vec<f64>> = points.iter().map(|&x| vec![x]).collect();
        let kernel = Kernel { variance: 1.0, rates: vec![1.0 / LENGTH] };
        let hyper = Hyper { kernel, noise: NOISE, shared };
        let sample = Sample { points: &points, values, factors, blocks, linear: false };
        Regression::fit(&sample, &hyper).unwrap()
    }

    /// Three points, with the inverse of their covariance K by cofactors: mean kᵀ K⁻¹ y and variance k₀ − kᵀ
    /// K⁻¹ k (Rasmussen and Williams, *Gaussian Processes for Machine Learning*, 2006, eq. 2.23 and 2.24).
    #[test]
    fn analytic_mean_and_variance_of_three_points() {
        let factors = [1.0, 0.5, 2.0];
        let k = |i: usize, j: usize| {
            let noise = if i % 3 == j % 3 { NOISE * factors[i % 3] } else { 0.0 };
            covariance(POINTS[i % 3], POINTS[j % 3]) + noise
        };
        let cofactor =
            |i: usize, j: usize| k(i + 1, j + 1) * k(i + 2, j + 2) - k(i + 1, j + 2) * k(i + 2, j + 1);
        let determinant: f64 = (0..3).map(|j| k(0, j) * cofactor(0, j)).sum();
        let product = |a: [f64; 3], b: [f64; 3]| -> f64 {
            (0..9).map(|n| a[n / 3] * cofactor(n / 3, n % 3) / determinant * b[n % 3]).sum()
        };
        let (regression, _) = fitted(&POINTS, &VALUES, &factors);
        for x in [0.0, 0.1, 0.3, 0.97] {
            let across = POINTS.map(|point| covariance(point, x));
            let [mean, variance] = regression.predict(&[vec![x]])[0];
            assert!((mean - product(across, VALUES)).abs() < CLOSE, "{x}: {mean}");
            let expected = covariance(x, x) - product(across, across);
            assert!((variance - expected).abs() < CLOSE, "{x}: {variance}, expected {expected}");
            assert!((regression.means(&[vec![x]])[0] - mean).abs() < CLOSE);
            let own = regression.covariance(&[vec![x]], &[vec![x]])[(0, 0)];
            assert!((own - expected).abs() < CLOSE, "{x}: {own}");
        }
    }

    /// The leave-one-out prediction of a point equals a fit to the other points.
    #[test]
    fn invariant_left_out_is_a_fit_without() {
        let (_, left_out) = fitted(&POINTS, &VALUES, &[1.0; 3]);
        let (without, _) = fitted(&POINTS[1..], &VALUES[1..], &[1.0; 2]);
        let [mean, variance] = without.predict(&[vec![POINTS[0]]])[0];
        assert!((left_out[0].mean - mean).abs() < CLOSE * TREND_VARIANCE, "{:?} {mean}", left_out[0]);
        assert!((left_out[0].variance - variance).abs() < CLOSE * TREND_VARIANCE);
    }

    /// Two values with a common part of their noise, by the inverse of their covariance of two by two
    /// (Rasmussen and Williams, eq. 2.23 and 2.24).
    #[test]
    fn analytic_mean_and_variance_of_two_values_of_one_block() {
        const SHARED: f64 = 0.7;
        let factors = [1.0, 2.0];
        let own = |i: usize| covariance(POINTS[i], POINTS[i]) + NOISE * factors[i];
        let across = covariance(POINTS[0], POINTS[1]) + SHARED * NOISE * (factors[0] * factors[1]).sqrt();
        let determinant = own(0) * own(1) - across * across;
        let solved = |of: [f64; 2]| {
            [(own(1) * of[0] - across * of[1]) / determinant, (own(0) * of[1] - across * of[0]) / determinant]
        };
        let (regression, _) = in_blocks(&POINTS[..2], &VALUES[..2], &factors, &[5, 5], SHARED);
        for x in [0.0, 0.3, 0.97] {
            let to = [0, 1].map(|i| covariance(POINTS[i], x));
            let [mean, variance] = regression.predict(&[vec![x]])[0];
            let weights = solved([VALUES[0], VALUES[1]]);
            let expected = to[0] * weights[0] + to[1] * weights[1];
            assert!((mean - expected).abs() < CLOSE * TREND_VARIANCE, "{x}: {mean}, expected {expected}");
            let weights = solved(to);
            let expected = covariance(x, x) - to[0] * weights[0] - to[1] * weights[1];
            assert!((variance - expected).abs() < CLOSE * TREND_VARIANCE, "{x}: {variance}, not {expected}");
        }
    }

    /// A value of a block is left out together with the others of its block.
    #[test]
    fn invariant_left_out_is_a_fit_without_the_block() {
        let (_, left_out) = in_blocks(&POINTS, &VALUES, &[1.0; 3], &[0, 0, 1], 0.7);
        let (without, _) = fitted(&POINTS[2..], &VALUES[2..], &[1.0; 1]);
        for i in 0..2 {
            let [mean, variance] = without.predict(&[vec![POINTS[i]]])[0];
            assert!((left_out[i].mean - mean).abs() < CLOSE * TREND_VARIANCE, "{:?} {mean}", left_out[i]);
            assert!((left_out[i].variance - variance).abs() < CLOSE * TREND_VARIANCE, "{variance}");
        }
    }

    /// The uncertainty that is announced for a further value is the one that it leaves.
    #[test]
    fn invariant_left_after_is_a_fit_with() {
        let (two, _) = fitted(&POINTS[..2], &VALUES[..2], &[1.0; 2]);
        let (three, _) = fitted(&POINTS, &VALUES, &[1.0; 3]);
        let at = [vec![0.6]];
        let left = two.left_after(&at, &[vec![POINTS[2]]], &[NOISE])[0];
        let [now, then] = [&two, &three].map(|of| of.predict(&at)[0][1].sqrt());
        assert!((left * now - then).abs() < CLOSE * TREND_VARIANCE, "{left} {now} {then}");
    }
}
