//! A Gaussian process, through a base of chosen points: exact where every point is chosen, an approximation that
//! costs no more than the square of their number where there are many (Quiñonero-Candela and Rasmussen, *A unifying
//! view of sparse approximate Gaussian process regression*, J. Machine Learning Research 6, 2005, §5; the variance
//! that the base does not carry is added to the prediction's).

use faer::{
    Mat, Par, Side,
    linalg::{solvers::Solve, triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place}},
};

use super::{
    hyper::{Hyper, Sample},
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

/// Of each point of a sample, what the other points predict.
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
        let noise: Vec<f64> = sample.factors.iter().map(|factor| hyper.noise * factor).collect();
        let weighted = Mat::from_fn(size, n, |i, j| features[(i, j)] / noise[j]);
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

    /// Without the value at each point (Rasmussen and Williams, eq. 5.12, in the weights' form).
    fn left_out(&self, values: &[f64], noise: &[f64], mut features: Mat<f64>, rest: &[f64]) -> Vec<LeftOut> {
        let means = features.transpose() * &self.weights;
        solve_lower_triangular_in_place(self.precision_factor.as_ref(), features.as_mut(), Par::Seq);
        let one = |j: usize| {
            let variance = squared_column(&features, j);
            let lever = (variance / noise[j]).min(1.0 - 1e-9);
            let mean = values[j] - (values[j] - means[(j, 0)]) / (1.0 - lever);
            LeftOut { mean, variance: variance / (1.0 - lever) + rest[j] }
        };
        (0..values.len()).map(one).collect()
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

    /// Covariance of the function between points, as it is known after all runs: a row for each of `a`, a column for
    /// each of `b`.
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

    /// The share of the function's standard deviation that is left at points after values at further ones, each with its
    /// own variance.
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

fn squared_column(matrix: &Mat<f64>, column: usize) -> f64 {
    matrix.col(column).squared_norm_l2()
}

/// Points of the base: one after the other where the ones before leave the largest variance (a pivoted Cholesky
/// factorisation), until they leave less than `enough` anywhere.
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
