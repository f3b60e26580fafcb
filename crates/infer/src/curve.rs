//! Whole curves as targets: a few principal components instead of every sample.

use faer::Mat;
use serde::{Deserialize, Serialize};

use crate::error::Error;

/// The mean of curves and the shapes in which they differ most.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Curves {
    /// Mean curve, in the curves' unit.
    pub mean: Vec<f64>,
    /// Shapes of unit length, orthogonal, the most varied first (`[component][sample]`).
    pub shapes: Vec<Vec<f64>>,
    /// Variance of the scores of each shape over the curves.
    pub variances: Vec<f64>,
    /// Share of the curves' variance that these shapes keep, 0 … 1.
    pub kept: f64,
    /// Root mean square, over curves and samples, of the residual, in the curves' unit.
    pub left_out: f64,
}

impl Curves {
    /// Of curves with as many samples each: as many shapes as keep `share` of their variance (above 0, at
    /// most 1), at most `most`.
    ///
    /// # Errors
    /// When there are fewer than two curves, they differ in length, a number is not finite, or the share is
    /// out of range.
    pub fn fit(curves: &[Vec<f64>], share: f64, most: usize) -> Result<Self, Error> {
        let n = curves.len();
        if n < 2 {
            return Err(Error::Option { option: "curves", value: n as f64, expected: "2 at least" });
        }
        if !(share > 0.0 && share <= 1.0) {
            return Err(Error::Option { option: "share", value: share, expected: "above 0, at most 1" });
        }
        let samples = curves[0].len();
        for (number, curve) in curves.iter().enumerate() {
            same_length("curve", number, curve, samples)?;
            if let Some(sample) = curve.iter().position(|x| !x.is_finite()) {
                let (what, value, expected) = ("sample".to_owned(), curve[sample], "must be finite");
                return Err(Error::Value { what, number: sample, row: number, value, expected });
            }
        }
        let mean: Vec<f64> =
            (0..samples).map(|k| curves.iter().map(|curve| curve[k]).sum::<f64>() / n as f64).collect();
        let centred = Mat::from_fn(samples, n, |k, j| curves[j][k] - mean[k]);
        let svd = centred.thin_svd().map_err(|_| Error::Factorisation("principal components of curves"))?;
        let singular = svd.S().column_vector();
        let squares: Vec<f64> = (0..singular.nrows()).map(|i| singular[i] * singular[i]).collect();
        let total: f64 = squares.iter().sum();
        // The rounding error of equal curves is not a shape.
        let rounding = 1e-28 * n as f64 * mean.iter().map(|m| m * m).sum::<f64>() + 1e-24 * total;
        let mut kept = 0.0;
        let mut count = 0;
        while count < squares.len().min(most) && kept < share * total && squares[count] > rounding {
            kept += squares[count];
            count += 1;
        }
        let left_out = ((total - kept).max(0.0) / (n * samples.max(1)) as f64).sqrt();
        Ok(Self {
            mean,
            shapes: (0..count).map(|i| (0..samples).map(|k| svd.U()[(k, i)]).collect()).collect(),
            variances: squares[..count].iter().map(|square| square / n as f64).collect(),
            kept: if total > 0.0 { kept / total } else { 1.0 },
            left_out,
        })
    }

    /// How much of each shape a curve has, in the curves' unit times the root of the number of samples.
    ///
    /// # Errors
    /// When the curve has another number of samples.
    pub fn scores(&self, curve: &[f64]) -> Result<Vec<f64>, Error> {
        same_length("curve", 0, curve, self.mean.len())?;
        let one =
            |shape: &Vec<f64>| shape.iter().zip(curve).zip(&self.mean).map(|((s, x), m)| s * (x - m)).sum();
        Ok(self.shapes.iter().map(one).collect())
    }

    /// The curve that has these scores.
    ///
    /// # Errors
    /// When there are not as many scores as shapes.
    pub fn curve(&self, scores: &[f64]) -> Result<Vec<f64>, Error> {
        same_length("list of scores", 0, scores, self.shapes.len())?;
        let mut curve = self.mean.clone();
        for (shape, score) in self.shapes.iter().zip(scores) {
            curve.iter_mut().zip(shape).for_each(|(x, s)| *x += score * s);
        }
        Ok(curve)
    }

    /// Root mean square of a curve's residual: where it is far above `left_out`, the curve differs in kind
    /// from those that the shapes were made from.
    ///
    /// # Errors
    /// When the curve has another number of samples.
    pub fn misfit(&self, curve: &[f64]) -> Result<f64, Error> {
        let back = self.curve(&self.scores(curve)?)?;
        let sum: f64 = back.iter().zip(curve).map(|(p, q)| (p - q) * (p - q)).sum();
        Ok((sum / curve.len().max(1) as f64).sqrt())
    }

    /// Standard deviation of a score, given that of single samples whose errors are independent: the shapes
    /// have unit length, so it is the same.
    pub fn tolerance(&self, of_samples: f64) -> f64 {
        of_samples
    }
}

fn same_length(what: &'static str, number: usize, numbers: &[f64], expected: usize) -> Result<(), Error> {
    let found = numbers.len();
    if found == expected { Ok(()) } else { Err(Error::Shape { what, number, found, expected }) }
}
