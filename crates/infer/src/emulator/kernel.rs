//! Covariance of a smooth function of a point: Matérn 5/2 with a length scale per dimension (Rasmussen and
//! Williams, *Gaussian Processes for Machine Learning*, 2006, eq. 4.17 and §5.1).

use faer::Mat;

/// √5, the slope of the Matérn 5/2 kernel's exponent.
const ROOT_5: f64 = 2.236_067_977_499_79;

/// Covariance of a function between two points of the unit cube.
#[derive(Debug, Clone)]
pub(super) struct Kernel {
    /// Variance of the function about its trend.
    pub(super) variance: f64,
    /// One over the length scale of each dimension.
    pub(super) rates: Vec<f64>,
}

/// Correlation at a squared scaled distance, and −2 times its derivative by that.
pub(super) fn matern(squared: f64) -> (f64, f64) {
    let r = ROOT_5 * squared.sqrt();
    let e = (-r).exp();
    ((1.0 + r + r * r / 3.0) * e, 5.0 / 3.0 * (1.0 + r) * e)
}

impl Kernel {
    /// A point in units of the length scales.
    pub(super) fn scale(&self, point: &[f64]) -> Vec<f64> {
        point.iter().zip(&self.rates).map(|(x, rate)| x * rate).collect()
    }

    /// Covariance of two scaled points.
    pub(super) fn between(&self, a: &[f64], b: &[f64]) -> f64 {
        let squared: f64 = a.iter().zip(b).map(|(p, q)| (p - q) * (p - q)).sum();
        self.variance * matern(squared).0
    }

    /// Covariances of scaled points: a row for each of `a`, a column for each of `b`.
    pub(super) fn matrix(&self, a: &[Vec<f64>], b: &[Vec<f64>]) -> Mat<f64> {
        // Coordinate by coordinate, so that a column of distances is summed in vectors.
        let coordinates: Vec<Vec<f64>> =
            (0..self.rates.len()).map(|k| a.iter().map(|point| point[k]).collect()).collect();
        let mut matrix = Mat::<f64>::zeros(a.len(), b.len());
        for (j, to) in b.iter().enumerate() {
            let column = matrix.col_as_slice_mut(j);
            for (coordinate, at) in coordinates.iter().zip(to) {
                column.iter_mut().zip(coordinate).for_each(|(sum, x)| *sum += (x - at) * (x - at));
            }
            column.iter_mut().for_each(|sum| *sum = self.variance * matern(*sum).0);
        }
        matrix
    }
}

/// Terms of the trend at a point: a constant and, where `linear`, one slope a dimension, scaled so that each
/// has unit variance over the cube.
pub(super) fn trend(point: &[f64], linear: bool) -> Vec<f64> {
    let slopes = point.iter().map(|x| 12_f64.sqrt() * (x - 0.5));
    std::iter::once(1.0).chain(slopes.take(if linear { point.len() } else { 0 })).collect()
}

/// Prior variance of the terms of a trend, in units of the output's variance: wide enough to tie down
/// nothing.
pub(super) const TREND_VARIANCE: f64 = 100.0;
