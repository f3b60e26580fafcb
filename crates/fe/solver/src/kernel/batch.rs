//! Batches of elements: their numbers are gathered from wherever they lie in memory, then read as vectors.

use pulp::Simd;

use crate::element::QuadReference;
use stribeck_simd::lanes::{LANES, Vector};

/// Elements of a batch. All are gathered before the first is computed, because a vector that is read while
/// its numbers are still on their way to memory stalls the processor.
pub(crate) const BATCH: usize = 8 * LANES;

/// Corner values of a batch of elements, one row a corner.
pub(crate) type Corners = [[f64; BATCH]; 4];

/// The corner values of some elements of a batch, from `at` on.
#[inline(always)]
pub(crate) fn corner_vectors<S: Simd>(simd: S, v: &Corners, at: usize) -> [Vector<S>; 4] {
    let [a, b, c, d] = v;
    [
        Vector::load(simd, a, at),
        Vector::load(simd, b, at),
        Vector::load(simd, c, at),
        Vector::load(simd, d, at),
    ]
}

/// Adds corner forces [N] of a batch of quadrilaterals to those of the nodes; that on the third corner is
/// handed over negative.
#[inline(always)]
pub(crate) fn scatter<'a>(
    corners: impl Iterator<Item = &'a [u32; 4]>,
    [of_x, of_y]: [&Corners; 2],
    fx: &mut [f64],
    fy: &mut [f64],
) {
    for (l, corners) in corners.enumerate() {
        for c in [0, 1, 3] {
            fx[corners[c] as usize] += of_x[c][l];
            fy[corners[c] as usize] += of_y[c][l];
        }
        fx[corners[2] as usize] -= of_x[2][l];
        fy[corners[2] as usize] -= of_y[2][l];
    }
}

/// Positions and references of a batch of quadrilaterals.
pub(crate) struct QuadBatch {
    x: Corners,
    y: Corners,
    /// Components of b1, then of b2.
    gradients: Corners,
    /// s1, s2 and the volume; the last row stays zero.
    rest: Corners,
}

/// Some quadrilaterals of a batch.
pub(crate) struct Quads<T> {
    pub(crate) x: [T; 4],
    pub(crate) y: [T; 4],
    pub(crate) b: [[T; 2]; 2],
    pub(crate) s: [T; 2],
    pub(crate) volume: T,
}

impl QuadBatch {
    pub(crate) const EMPTY: Self = {
        let zeros = [[0.0; BATCH]; 4];
        Self { x: zeros, y: zeros, gradients: zeros, rest: zeros }
    };

    /// Fills the batch with at most [`BATCH`] elements at positions `x`, `y` [m]. Those that it lacks then
    /// have no volume and lie in one point.
    #[inline(always)]
    pub(crate) fn gather(&mut self, elements: &[([u32; 4], QuadReference)], x: &[f64], y: &[f64]) {
        for (l, (corners, q)) in elements.iter().enumerate() {
            let gradients = [q.b1[0], q.b1[1], q.b2[0], q.b2[1]];
            for c in 0..4 {
                self.x[c][l] = x[corners[c] as usize];
                self.y[c][l] = y[corners[c] as usize];
                self.gradients[c][l] = gradients[c];
            }
            (self.rest[0][l], self.rest[1][l], self.rest[2][l]) = (q.s1, q.s2, q.volume);
        }
        for field in [&mut self.x, &mut self.y, &mut self.gradients, &mut self.rest] {
            field.iter_mut().for_each(|row| row[elements.len()..].fill(0.0));
        }
    }

    /// As many as an instruction takes, from `at` on.
    #[inline(always)]
    pub(crate) fn at<S: Simd>(&self, simd: S, at: usize) -> Quads<Vector<S>> {
        let [b1x, b1y, b2x, b2y] = corner_vectors(simd, &self.gradients, at);
        let [s1, s2, volume, _] = corner_vectors(simd, &self.rest, at);
        let (x, y) = (corner_vectors(simd, &self.x, at), corner_vectors(simd, &self.y, at));
        Quads { x, y, b: [[b1x, b1y], [b2x, b2y]], s: [s1, s2], volume }
    }
}
