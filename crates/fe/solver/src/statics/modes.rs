//! Natural modes below a frequency, by shift-invert Lanczos iteration in blocks (THEORY §9.1).

use std::f64::consts::TAU;

use super::small_motions::SmallMotions;
use crate::error::Error;
use faer::{
    Accum, Auto, Mat, MatMut, MatRef, Par,
    diag::Diag,
    dyn_stack::{MemBuffer, MemStack},
    linalg::{
        evd::{ComputeEigenvectors, SelfAdjointEvdParams, self_adjoint_evd, self_adjoint_evd_scratch},
        matmul::matmul,
    },
};

/// Natural modes φ with φᵀMφ = 1, ascending.
#[derive(Debug, Clone)]
pub struct Modes {
    /// Squares of the angular frequencies [rad²/s²].
    pub squares: Vec<f64>,
    /// Shapes [1/√kg], fields of the [`SmallMotions`] that they belong to.
    pub shapes: Vec<Vec<f64>>,
}

/// Largest residual of a mode that counts as found, relative: the error of its frequency is the square of
/// that.
const RESIDUAL: f64 = 1e-7;

/// Vectors that are taken through an iteration together: the factor and all vectors before are read once for
/// them.
const BLOCK: usize = 4;

/// Vectors between two checks of convergence.
const LOOK_EVERY: usize = 2 * BLOCK;

/// Share of a vector's length below which its rest, orthogonal to all others, is rounding alone.
const NOTHING: f64 = 1e-12;

/// Most vectors.
const VECTORS: usize = 1200;

/// All modes below `hertz`.
///
/// # Errors
/// When they are not found among 1200 vectors.
pub fn modes_below(motions: &mut SmallMotions, hertz: f64) -> Result<Modes, Error> {
    let n = motions.equations();
    let limit = (TAU * hertz).powi(2) + motions.shift();
    let mut basis = Basis::new(motions.mass());
    if basis.movable == 0 {
        return Err(Error::Modes { found: 0, iterations: 0, hertz });
    }
    // Any start that no symmetry leaves without some mode will do; the same one always, for the same bits.
    let mut block: Vec<f64> = (0..BLOCK).flat_map(|_| basis.at_random()).collect();
    motions.solve(&mut block);
    basis.extend(block);
    let mut found = 0;
    while basis.len() < VECTORS {
        let mut images = basis.last_block().to_vec();
        images.chunks_exact_mut(n).for_each(|image| basis.times_mass(image));
        motions.solve(&mut images);
        basis.take_out_the_last(&mut images);
        let m = basis.len();
        let lengths = basis.extend(images);
        // A block that is cut short because hardly any dimensions are left has no estimate before it has been
        // multiplied.
        let all = m == basis.len();
        if !all && (lengths.ncols() < BLOCK || !m.is_multiple_of(LOOK_EVERY)) {
            continue;
        }
        let failed = || Error::Modes { found, iterations: m, hertz };
        let (values, vectors) = eigen(&basis.projected()).ok_or_else(failed)?;
        // Ascending: the last value belongs to the lowest frequency.
        let last = vectors.get(m - lengths.ncols().., ..);
        let converged = |i: usize| {
            let left: f64 = (0..lengths.nrows())
                .map(|r| (0..lengths.ncols()).map(|c| lengths[(r, c)] * last[(c, i)]).sum::<f64>().powi(2))
                .sum();
            all || left.sqrt() <= RESIDUAL * values[i]
        };
        let wanted = (0..m).rev().take_while(|&i| values[i] * limit > 1.0).count();
        let beyond = all || m.checked_sub(wanted + 1).is_some_and(converged);
        found = (m - wanted..m).filter(|&i| converged(i)).count();
        if beyond && found == wanted {
            let shares = Mat::from_fn(m, wanted, |i, k| vectors[(i, m - 1 - k)]);
            let mut shapes = vec![0.0; n * wanted];
            let of_shapes = MatMut::from_column_major_slice_mut(&mut shapes, n, wanted);
            matmul(of_shapes, Accum::Replace, basis.first(m), shares.as_ref(), 1.0, Par::Seq);
            for shape in shapes.chunks_exact_mut(n) {
                basis.normalise(shape);
            }
            // The matrix has the last word.
            if are_modes(motions, &shapes, &basis) {
                let shapes: Vec<Vec<f64>> = shapes.chunks_exact(n).map(<[f64]>::to_vec).collect();
                // The quotient of Rayleigh is better than the shifted value where that is small.
                let square = |shape: &Vec<f64>| dot(shape, &motions.stiffness_times(shape));
                let squares = shapes.iter().map(square).collect();
                return Ok(Modes { squares, shapes });
            }
        }
        if all {
            break;
        }
    }
    Err(Error::Modes { found, iterations: basis.len(), hertz })
}

/// Eigenvalues, ascending, and eigenvectors of a symmetric matrix; `None` if they are not found. By the QR
/// algorithm whatever the size: faer 0.24.4 divides large matrices, and errs then where values are repeated.
fn eigen(matrix: &Mat<f64>) -> Option<(Vec<f64>, Mat<f64>)> {
    let m = matrix.nrows();
    let params = SelfAdjointEvdParams { recursion_threshold: usize::MAX, ..Auto::<f64>::auto() };
    let scratch = self_adjoint_evd_scratch::<f64>(m, ComputeEigenvectors::Yes, Par::Seq, params.into());
    let mut memory = MemBuffer::new(scratch);
    let (mut values, mut vectors) = (Diag::<f64>::zeros(m), Mat::<f64>::zeros(m, m));
    let (s, u) = (values.as_mut(), Some(vectors.as_mut()));
    self_adjoint_evd(matrix.as_ref(), s, u, Par::Seq, MemStack::new(&mut memory), params.into()).ok()?;
    Some((values.column_vector().iter().copied().collect(), vectors))
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

/// Vectors v with vᵀMv = 1 that are orthogonal by the mass M, in blocks.
struct Basis {
    /// Mass of each equation [kg], and how many have any.
    mass: Vec<f64>,
    movable: usize,
    /// Vectors, one after the other.
    vectors: Vec<f64>,
    /// Of each block whose image (K + σM)⁻¹M V is known: products by mass of that image with this block and
    /// the one before it.
    blocks: Vec<Mat<f64>>,
    /// Vectors in the last block, and in the one before it.
    last: [usize; 2],
    seed: u64,
}

impl Basis {
    fn new(mass: &[f64]) -> Self {
        let movable = mass.iter().filter(|&&mass| mass > 0.0).count();
        let seed = 0x9e37_79b9_7f4a_7c15;
        Self { mass: mass.to_vec(), movable, vectors: Vec::new(), blocks: Vec::new(), last: [0; 2], seed }
    }

    fn len(&self) -> usize {
        self.vectors.len() / self.mass.len().max(1)
    }

    /// The first of them, one a column.
    fn first(&self, count: usize) -> MatRef<'_, f64> {
        let n = self.mass.len();
        MatRef::from_column_major_slice(&self.vectors[..n * count], n, count)
    }

    fn last_block(&self) -> &[f64] {
        &self.vectors[self.vectors.len() - self.mass.len() * self.last[0]..]
    }

    fn at_random(&mut self) -> Vec<f64> {
        let Self { mass, seed, .. } = self;
        let mut next = || {
            *seed ^= *seed << 13;
            *seed ^= *seed >> 7;
            *seed ^= *seed << 17;
            (*seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        mass.iter().map(|&mass| if mass > 0.0 { next() } else { 0.0 }).collect()
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

    /// Takes vectors out of others; the parts that these had along them.
    fn take_out(&self, vectors: MatRef<'_, f64>, from: &mut [f64]) -> Mat<f64> {
        let n = self.mass.len();
        let columns = from.len() / n;
        let mut momenta = from.to_vec();
        momenta.chunks_exact_mut(n).for_each(|momentum| self.times_mass(momentum));
        let momenta = MatRef::from_column_major_slice(&momenta, n, columns);
        let mut along = Mat::<f64>::zeros(vectors.ncols(), columns);
        matmul(along.as_mut(), Accum::Replace, vectors.transpose(), momenta, 1.0, Par::Seq);
        let from = MatMut::from_column_major_slice_mut(from, n, columns);
        matmul(from, Accum::Add, vectors, along.as_ref(), -1.0, Par::Seq);
        along
    }

    /// Takes the last block out of its image, and the one before it: the image has no part along others but
    /// for rounding.
    fn take_out_the_last(&mut self, image: &mut [f64]) {
        let [last, before] = self.last;
        let all = self.first(self.len());
        let along = self.take_out(all.get(.., self.len() - last - before..), image);
        self.blocks.push(along);
    }

    /// The operator in terms of the blocks whose images are known, symmetric.
    fn projected(&self) -> Mat<f64> {
        let size = self.blocks.iter().map(Mat::ncols).sum();
        let mut t = Mat::<f64>::zeros(size, size);
        let mut first = 0;
        for block in &self.blocks {
            let own = block.nrows() - block.ncols();
            for j in 0..block.ncols() {
                for i in 0..own {
                    t[(first - own + i, first + j)] = block[(i, j)];
                    t[(first + j, first - own + i)] = block[(i, j)];
                }
                for i in 0..block.ncols() {
                    t[(first + i, first + j)] = 0.5 * (block[(own + i, j)] + block[(own + j, i)]);
                }
            }
            first += block.ncols();
        }
        t
    }

    /// Takes all vectors out of some more, makes these orthogonal, too, and adds as many as there can be;
    /// returns them in terms of the added vectors.
    ///
    /// Where next to nothing is left, as with natural frequencies that come in pairs, rounding has parts
    /// along the basis again: it goes on until hardly anything is taken out any more (Parlett 1998, §6.9).
    fn extend(&mut self, mut more: Vec<f64>) -> Mat<f64> {
        let n = self.mass.len();
        let count = (more.len() / n).min(self.movable - self.len());
        more.truncate(n * count);
        let mut lengths = Mat::<f64>::identity(count, count);
        for _ in 0..10 {
            let before: Vec<f64> = more.chunks_exact(n).map(|v| self.product(v, v).sqrt()).collect();
            if self.len() > 0 {
                self.take_out(self.first(self.len()), &mut more);
            }
            let mut of_pass = Mat::<f64>::zeros(count, count);
            let mut least: f64 = 1.0;
            for (i, before) in before.iter().enumerate() {
                let (done, rest) = more.split_at_mut(n * i);
                let vector = &mut rest[..n];
                for (k, other) in done.chunks_exact(n).enumerate() {
                    let along = self.product(other, vector);
                    vector.iter_mut().zip(other).for_each(|(v, o)| *v -= along * o);
                    of_pass[(k, i)] = along;
                }
                let left = self.normalise(vector);
                if left > NOTHING * before {
                    of_pass[(i, i)] = left;
                    least = least.min(left / before);
                } else {
                    // It says nothing new; anything else may.
                    vector.copy_from_slice(&self.at_random());
                    least = 0.0;
                }
            }
            lengths = &of_pass * &lengths;
            if least > 0.7 {
                break;
            }
        }
        self.vectors.extend_from_slice(&more);
        self.last = [count, self.last[0]];
        lengths
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
