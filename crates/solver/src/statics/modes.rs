//! Natural modes below a frequency, by shift-invert Lanczos iteration (THEORY §9.1).

use std::f64::consts::TAU;

use super::small_motions::SmallMotions;
use crate::error::Error;
use faer::{Mat, Side};

/// Natural modes φ with φᵀMφ = 1, ascending.
#[derive(Debug, Clone)]
pub struct Modes {
    /// Squares of the angular frequencies [rad²/s²].
    pub squares: Vec<f64>,
    /// Shapes [1/√kg], fields of the [`SmallMotions`] that they belong to.
    pub shapes: Vec<Vec<f64>>,
}

/// Largest residual of a mode that counts as found, relative: the error of its frequency is the square of that.
const RESIDUAL: f64 = 1e-7;

/// Iterations between two looks at what has converged.
const LOOK_EVERY: usize = 8;

/// Most iterations.
const ITERATIONS: usize = 1200;

/// All modes below `hertz`.
///
/// # Errors
/// When they are not found in 1200 iterations.
pub fn modes_below(motions: &mut SmallMotions, hertz: f64) -> Result<Modes, Error> {
    let mass = motions.mass().to_vec();
    let n = mass.len();
    let limit = (TAU * hertz).powi(2) + motions.shift();
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).zip(&mass).map(|((a, b), m)| a * b * m).sum::<f64>();
    // Any start that no symmetry leaves without some mode will do; the same one always, for the same bits.
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut v: Vec<f64> = mass.iter().map(|&m| if m > 0.0 { next() } else { 0.0 }).collect();
    motions.solve(&mut v);
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let (mut alpha, mut beta): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let scale = 1.0 / product(&v, &v).sqrt();
    v.iter_mut().for_each(|v| *v *= scale);
    let mut found = 0;
    while basis.len() < ITERATIONS.min(n) {
        let mut w: Vec<f64> = v.iter().zip(&mass).map(|(v, m)| v * m).collect();
        motions.solve(&mut w);
        basis.push(std::mem::take(&mut v));
        alpha.push(product(&w, &basis[basis.len() - 1]));
        let length = make_orthogonal(&mut w, &basis, &product);
        beta.push(length);
        let m = basis.len();
        if m.is_multiple_of(LOOK_EVERY) || m == n {
            let t = Mat::from_fn(m, m, |i, j| match i.abs_diff(j) {
                0 => alpha[i],
                1 => beta[i.min(j)],
                _ => 0.0,
            });
            let failed = |_| Error::Modes { found, iterations: m, hertz };
            let eigen = t.self_adjoint_eigen(Side::Lower).map_err(failed)?;
            let (values, vectors) = (eigen.S(), eigen.U());
            // Ascending: the last value belongs to the lowest frequency.
            let converged = |i: usize| (length * vectors[(m - 1, i)]).abs() <= RESIDUAL * values[i];
            let wanted = (0..m).rev().take_while(|&i| values[i] * limit > 1.0).count();
            let beyond = m.checked_sub(wanted + 1).is_some_and(converged) || m == n;
            found = (m - wanted..m).filter(|&i| converged(i)).count();
            if beyond && found == wanted {
                let mut shapes = vec![vec![0.0; n]; wanted];
                for (k, shape) in shapes.iter_mut().enumerate() {
                    let column = m - 1 - k;
                    for (i, b) in basis.iter().enumerate() {
                        let share = vectors[(i, column)];
                        shape.iter_mut().zip(b).for_each(|(s, b)| *s += share * b);
                    }
                    let scale = 1.0 / product(shape, shape).sqrt();
                    shape.iter_mut().for_each(|s| *s *= scale);
                }
                // A decomposition may be wrong where values are repeated, so the matrix has the last word.
                if !shapes.iter().all(|shape| is_mode(motions, shape, &product)) {
                    v = w;
                    continue;
                }
                // The quotient of Rayleigh is better than the shifted value where that is small.
                let square = |shape: &Vec<f64>| {
                    let force = motions.stiffness_times(shape);
                    shape.iter().zip(&force).map(|(u, f)| u * f).sum::<f64>()
                };
                let squares = shapes.iter().map(square).collect();
                return Ok(Modes { squares, shapes });
            }
        }
        v = w;
    }
    Err(Error::Modes { found, iterations: basis.len(), hertz })
}

/// Whether (K + σM)⁻¹M turns a shape of length one into a multiple of itself.
fn is_mode(motions: &mut SmallMotions, shape: &[f64], product: &dyn Fn(&[f64], &[f64]) -> f64) -> bool {
    let mut turned: Vec<f64> = shape.iter().zip(motions.mass()).map(|(s, m)| s * m).collect();
    motions.solve(&mut turned);
    let value = product(shape, &turned);
    turned.iter_mut().zip(shape).for_each(|(t, s)| *t -= value * s);
    product(&turned, &turned).sqrt() <= 10.0 * RESIDUAL * value
}

/// Takes all vectors of the basis out of `w` and makes it one of length one; the length that it had beside them.
///
/// Where next to nothing is left, as with natural frequencies that come in pairs, rounding has parts along the basis again: it
/// goes on until hardly anything is taken out any more.
fn make_orthogonal(w: &mut [f64], basis: &[Vec<f64>], product: &dyn Fn(&[f64], &[f64]) -> f64) -> f64 {
    let mut length = 1.0;
    // Twice is enough (Parlett 1998, §6.9) but for the case above.
    for round in 0..10 {
        let before = product(w, w).sqrt();
        for b in basis {
            let along = product(b, w);
            w.iter_mut().zip(b).for_each(|(w, b)| *w -= along * b);
        }
        let left = product(w, w).sqrt();
        w.iter_mut().for_each(|w| *w /= left);
        length *= left;
        if round > 0 && left > 0.7 * before {
            break;
        }
    }
    length
}
