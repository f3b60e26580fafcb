//! References of elements that differ from their neighbours, stored as the kernels read them.

use prefetch_index::prefetch_index;
use pulp::Simd;

use crate::kernel::{advance::FETCH, quad_forms::QuadShape};
use stribeck_simd::{
    field::Field,
    lanes::{LANES, Vector},
};

/// Shapes of quadrilaterals ([`QuadShape`]) in groups of lanes: eight values of each kind,
/// one kind after the other, so that a kernel reads them as one stream.
#[derive(Debug, Clone, Default)]
pub(crate) struct VaryingReferences(Field);

impl VaryingReferences {
    /// Numbers of a [`QuadShape`].
    const KINDS: usize = 6;

    /// Appends groups with the shapes of some elements; returns the number of the first group. The last group
    /// is filled up with its last element, and one more follows, because kernels read a group beyond the end.
    pub(crate) fn push(&mut self, elements: impl ExactSizeIterator<Item = QuadShape>) -> usize {
        let start = self.0.len() / (Self::KINDS * LANES);
        let groups = elements.len() / LANES + 1;
        let mut kinds = [const { Vec::new() }; Self::KINDS];
        for QuadShape { rest: [pp, rr, pr], scale, s1, s2 } in elements {
            kinds.iter_mut().zip([pp, rr, pr, scale, s1, s2]).for_each(|(kind, value)| kind.push(value));
        }
        for group in 0..groups {
            for kind in &kinds {
                let last = kind.last().copied().unwrap_or(0.0);
                (0..LANES).for_each(|l| self.0.push(kind.get(group * LANES + l).copied().unwrap_or(last)));
            }
        }
        start
    }

    /// Renumbers the corners 4, 3, 2, 1 of `n` elements from group `start` on.
    pub(crate) fn turn_over(&mut self, start: usize, n: usize) {
        if n == 0 {
            return;
        }
        for group in start..=start + n / LANES {
            let at = group * Self::KINDS * LANES;
            for l in at..at + LANES {
                // Diagonals change places, and so do their parts of the hourglass vector.
                self.0.swap(l, LANES + l);
                self.0.swap(4 * LANES + l, 5 * LANES + l);
            }
        }
    }

    /// Makes all elements stiffer by a factor, but for their hourglass stiffness, which is no part of a
    /// shape.
    pub(crate) fn stiffen(&mut self, factor: f64) {
        let groups = self.0.chunks_mut(Self::KINDS * LANES);
        groups.flat_map(|group| &mut group[3 * LANES..4 * LANES]).for_each(|scale| *scale *= factor);
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of::<f64>() * self.0.len()
    }

    /// Fetches shapes of elements further on than `e` of those whose first group is `start`.
    #[inline(always)]
    pub(crate) fn fetch(&self, start: usize, e: usize) {
        let at = (start + (e + FETCH) / LANES) * Self::KINDS * LANES;
        (0..Self::KINDS).for_each(|kind| prefetch_index(&self.0[..], at + kind * LANES));
    }

    /// Shapes of the elements from `e` on of those whose first group is `start`.
    #[inline(always)]
    pub(crate) fn group<S: Simd>(&self, simd: S, start: usize, e: usize) -> QuadShape<Vector<S>> {
        let at = (start + e / LANES) * Self::KINDS * LANES;
        let values = &self.0[at..at + Self::KINDS * LANES];
        let lane = e % LANES;
        QuadShape {
            rest: [
                Vector::load(simd, values, lane),
                Vector::load(simd, values, LANES + lane),
                Vector::load(simd, values, 2 * LANES + lane),
            ],
            scale: Vector::load(simd, values, 3 * LANES + lane),
            s1: Vector::load(simd, values, 4 * LANES + lane),
            s2: Vector::load(simd, values, 5 * LANES + lane),
        }
    }
}
