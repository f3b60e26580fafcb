//! Natural modes below a frequency, by shift-invert Lanczos iteration (THEORY §9.1).

use std::f64::consts::TAU;

use super::small_motions::SmallMotions;
use crate::error::Error;
use faer::{Accum, Mat, MatMut, MatRef, Par, Side, linalg::matmul::matmul};

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
    let n = motions.equations();
    let limit = (TAU * hertz).powi(2) + motions.shift();
    let mut basis = Basis { mass: motions.mass().to_vec(), vectors: Vec::new(), momenta: vec![0.0; n] };
    // Any start that no symmetry leaves without some mode will do; the same one always, for the same bits.
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut v: Vec<f64> = basis.mass.iter().map(|&m| if m > 0.0 { next() } else { 0.0 }).collect();
    motions.solve(&mut v);
    basis.normalise(&mut v);
    let (mut alpha, mut beta): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut found = 0;
    while basis.len() < ITERATIONS.min(n) {
        basis.push(&v);
        basis.times_mass(&mut v);
        motions.solve(&mut v);
        let along = basis.take_out_the_last(&mut v, beta.last().copied());
        alpha.push(along);
        let length = basis.make_orthogonal(&mut v);
        beta.push(length);
        let m = basis.len();
        if !m.is_multiple_of(LOOK_EVERY) && m != n {
            continue;
        }
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
        if !beyond || found < wanted {
            continue;
        }
        let shares = Mat::from_fn(m, wanted, |i, k| vectors[(i, m - 1 - k)]);
        let mut shapes = vec![0.0; n * wanted];
        let of_shapes = MatMut::from_column_major_slice_mut(&mut shapes, n, wanted);
        matmul(of_shapes, Accum::Replace, basis.all(), shares.as_ref(), 1.0, Par::Seq);
        for shape in shapes.chunks_exact_mut(n) {
            basis.normalise(shape);
        }
        // A decomposition may be wrong where values are repeated, so the matrix has the last word.
        if are_modes(motions, &shapes, &basis) {
            let shapes: Vec<Vec<f64>> = shapes.chunks_exact(n).map(<[f64]>::to_vec).collect();
            // The quotient of Rayleigh is better than the shifted value where that is small.
            let square = |shape: &Vec<f64>| dot(shape, &motions.stiffness_times(shape));
            let squares = shapes.iter().map(square).collect();
            return Ok(Modes { squares, shapes });
        }
    }
    Err(Error::Modes { found, iterations: basis.len(), hertz })
}

/// Whether (K + σM)⁻¹M turns shapes of length one into multiples of themselves.
fn are_modes(motions: &mut SmallMotions, shapes: &[f64], basis: &Basis) -> bool {
    let n = basis.mass.len();
    let mut turned = shapes.to_vec();
    turned.chunks_exact_mut(n).for_each(|turned| basis.times_mass(turned));
    motions.solve(&mut turned);
    shapes.chunks_exact(n).zip(turned.chunks_exact_mut(n)).all(|(shape, turned)| {
        let value = basis.product(shape, turned);
        turned.iter_mut().zip(shape).for_each(|(t, s)| *t -= value * s);
        basis.product(turned, turned).sqrt() <= 10.0 * RESIDUAL * value
    })
}

/// Vectors v with vᵀMv = 1 that are orthogonal by the mass M.
struct Basis {
    /// Mass of each equation [kg].
    mass: Vec<f64>,
    /// One after the other.
    vectors: Vec<f64>,
    /// Room for mass times a vector.
    momenta: Vec<f64>,
}

impl Basis {
    fn len(&self) -> usize {
        self.vectors.len() / self.mass.len().max(1)
    }

    fn push(&mut self, v: &[f64]) {
        self.vectors.extend_from_slice(v);
    }

    /// All of them, one a column.
    fn all(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.vectors, self.mass.len(), self.len())
    }

    fn times_mass(&self, v: &mut [f64]) {
        v.iter_mut().zip(&self.mass).for_each(|(v, m)| *v *= m);
    }

    fn product(&self, a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).zip(&self.mass).map(|((a, b), m)| a * b * m).sum()
    }

    /// Makes a vector one of length one; the length that it had.
    fn normalise(&self, v: &mut [f64]) -> f64 {
        let length = self.product(v, v).sqrt();
        v.iter_mut().for_each(|v| *v /= length);
        length
    }

    /// Takes the last vector out of `w`, and the one before it, along which `w` has the part `before` but for rounding; the part along
    /// the last one.
    fn take_out_the_last(&self, w: &mut [f64], before: Option<f64>) -> f64 {
        let n = self.mass.len();
        let mut last = self.vectors.rchunks_exact(n);
        let (v, u) = (last.next().unwrap_or_default(), last.next().unwrap_or_default());
        if let Some(before) = before {
            w.iter_mut().zip(u).for_each(|(w, u)| *w -= before * u);
        }
        let along = self.product(w, v);
        w.iter_mut().zip(v).for_each(|(w, v)| *w -= along * v);
        along
    }

    /// Takes all vectors out of `w` and makes it one of length one; the length that it had beside them.
    ///
    /// Where next to nothing is left, as with natural frequencies that come in pairs, rounding has parts along the basis again: it
    /// goes on until hardly anything is taken out any more (Parlett 1998, §6.9).
    fn make_orthogonal(&mut self, w: &mut [f64]) -> f64 {
        let n = self.mass.len();
        let mut length = self.normalise(w);
        for _ in 0..10 {
            for ((momentum, w), m) in self.momenta.iter_mut().zip(&*w).zip(&self.mass) {
                *momentum = m * w;
            }
            let momenta = MatRef::from_column_major_slice(&self.momenta, n, 1);
            let mut along = Mat::<f64>::zeros(self.len(), 1);
            matmul(along.as_mut(), Accum::Replace, self.all().transpose(), momenta, 1.0, Par::Seq);
            let from = MatMut::from_column_major_slice_mut(w, n, 1);
            matmul(from, Accum::Add, self.all(), along.as_ref(), -1.0, Par::Seq);
            let left = self.normalise(w);
            length *= left;
            if left > 0.7 {
                break;
            }
        }
        length
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
