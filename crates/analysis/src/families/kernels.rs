//! The kernels of the fit of combs, compiled for the vectors of each processor. Nothing is fused and sums
//! have a fixed order, so that all of them give the same bits.

use std::f64::consts::TAU;

use pulp::{Arch, Simd, WithSimd};

/// Real and imaginary part.
pub(super) type Complex = (f64, f64);

/// Values that are turned with one table.
const BLOCK: usize = 16;

/// Averages that are taken together, of values that lie near the processor.
const TOGETHER: usize = 32;

/// Values times exp 2πi f t, t from zero on.
pub(super) fn turned(values: &[Complex], hz: f64, interval_s: f64) -> Vec<Complex> {
    let turns = |samples: usize| unit(TAU * hz * interval_s * samples as f64);
    let mut turned = values.to_vec();
    Arch::new().dispatch(Turn { values: &mut turned, table: std::array::from_fn(turns), step: turns(BLOCK) });
    turned
}

struct Turn<'a> {
    values: &'a mut [Complex],
    table: [Complex; BLOCK],
    step: Complex,
}

impl WithSimd for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut start = (1.0, 0.0);
        for block in self.values.chunks_mut(BLOCK) {
            for (value, turn) in block.iter_mut().zip(&self.table) {
                *value = times(times(start, *turn), *value);
            }
            start = times(start, self.step);
        }
    }
}

/// A shift in frequency, and decimated by weighted averages.
pub(super) struct Shift<'a> {
    /// Factor of each value.
    turns: Vec<Complex>,
    taps: &'a [f64],
    step: usize,
    /// Of the values, those for a few averages.
    shifted: Vec<Complex>,
}

impl<'a> Shift<'a> {
    /// Shifts `values` samples, `interval_s` apart, by `hz`, and averages them with the weights `taps`, one
    /// average every `step` samples.
    pub(super) fn new(hz: f64, interval_s: f64, values: usize, taps: &'a [f64], step: usize) -> Self {
        let turns = turned(&vec![(1.0, 0.0); values], hz, interval_s);
        Self { turns, taps, step, shifted: vec![(0.0, 0.0); TOGETHER * step + taps.len()] }
    }

    /// The averages of one signal.
    pub(super) fn apply(&mut self, values: &[Complex]) -> Vec<Complex> {
        let Self { turns, taps, step, shifted } = self;
        let mut averages = vec![(0.0, 0.0); (values.len() + *step).saturating_sub(taps.len()) / *step];
        Arch::new().dispatch(Average { values, turns, taps, step: *step, shifted, averages: &mut averages });
        averages
    }
}

struct Average<'a> {
    values: &'a [Complex],
    turns: &'a [Complex],
    taps: &'a [f64],
    step: usize,
    shifted: &'a mut [Complex],
    averages: &'a mut [Complex],
}

impl WithSimd for Average<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (at, averages) in self.averages.chunks_mut(TOGETHER).enumerate() {
            let from = at * TOGETHER * self.step;
            let shifted = &mut self.shifted[..(averages.len() - 1) * self.step + self.taps.len()];
            for ((shifted, turn), value) in
                shifted.iter_mut().zip(&self.turns[from..]).zip(&self.values[from..])
            {
                *shifted = times(*turn, *value);
            }
            for (n, average) in averages.iter_mut().enumerate() {
                let part = &shifted[n * self.step..][..self.taps.len()];
                *average = sum(self.taps, part, |tap, value| (tap * value.0, tap * value.1));
            }
        }
    }
}

/// Subtracts from a column its projection on the orthonormal columns of `basis`: Gram–Schmidt, twice for
/// rounding.
pub(super) fn orthogonalise(column: &mut [Complex], basis: &[Vec<Complex>]) {
    Arch::new().dispatch(Orthogonalise { column, basis });
}

struct Orthogonalise<'a> {
    column: &'a mut [Complex],
    basis: &'a [Vec<Complex>],
}

impl WithSimd for Orthogonalise<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for _ in 0..2 {
            for q in self.basis {
                let share = product(q, self.column);
                for (r, q) in self.column.iter_mut().zip(q) {
                    let part = times(share, *q);
                    *r = (r.0 - part.0, r.1 - part.1);
                }
            }
        }
    }
}

/// Σ ā b.
pub(super) fn dot(a: &[Complex], b: &[Complex]) -> Complex {
    Arch::new().dispatch(Dot { a, b })
}

struct Dot<'a> {
    a: &'a [Complex],
    b: &'a [Complex],
}

impl WithSimd for Dot<'_> {
    type Output = Complex;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Complex {
        product(self.a, self.b)
    }
}

/// e^{iφ}.
pub(super) fn unit(phase: f64) -> Complex {
    let (sin, cos) = phase.sin_cos();
    (cos, sin)
}

#[inline(always)]
fn product(a: &[Complex], b: &[Complex]) -> Complex {
    sum(a, b, |a, b| (a.0 * b.0 + a.1 * b.1, a.0 * b.1 - a.1 * b.0))
}

#[inline(always)]
fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// Sum over pairs in four partial sums, which do not wait for each other.
#[inline(always)]
fn sum<A: Copy, B: Copy>(a: &[A], b: &[B], of: impl Fn(A, B) -> Complex) -> Complex {
    let (a, b) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut parts = [(0.0, 0.0); 4];
    for (a, b) in a.0.iter().zip(b.0) {
        for n in 0..4 {
            let more = of(a[n], b[n]);
            parts[n] = (parts[n].0 + more.0, parts[n].1 + more.1);
        }
    }
    for ((a, b), part) in a.1.iter().zip(b.1).zip(&mut parts) {
        let more = of(*a, *b);
        *part = (part.0 + more.0, part.1 + more.1);
    }
    let [a, b, c, d] = parts;
    ((a.0 + b.0) + (c.0 + d.0), (a.1 + b.1) + (c.1 + d.1))
}
