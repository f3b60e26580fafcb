//! Numbers of eight rollers, contacts or modes side by side.

use std::ops::{Deref, DerefMut};

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

/// A number of each of eight, in one line of cache.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
pub(crate) struct Row(pub(crate) [f64; LANES]);

impl Deref for Row {
    type Target = [f64];

    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.0
    }
}

impl DerefMut for Row {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.0
    }
}

impl AsMut<[f64]> for Row {
    #[inline(always)]
    fn as_mut(&mut self) -> &mut [f64] {
        &mut self.0
    }
}

/// The same in single precision: of a table that is looked up in every step, and has been rounded for all its
/// uses.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(32))]
pub(crate) struct Single([f32; LANES]);

impl Deref for Single {
    type Target = [f32];

    #[inline(always)]
    fn deref(&self) -> &[f32] {
        &self.0
    }
}

/// A table in single precision, in rows.
pub(crate) fn in_single(table: &[f64]) -> Vec<Single> {
    table.as_chunks::<LANES>().0.iter().map(|row| Single(row.map(|number| number as f32))).collect()
}

/// The same of a closed boundary, with the row or rows of its first vertex repeated after those of the last
/// one, so that both ends of every facet lie one after the other.
pub(crate) fn closed_in_single(table: &[f64], per_vertex: usize) -> Vec<Single> {
    let mut rows = in_single(table);
    rows.extend_from_within(..per_vertex.min(rows.len()));
    rows
}

/// Numbers that belong together, in either precision.
pub(crate) trait Numbers {
    /// Those in the lanes from `at` on.
    fn load<S: Simd>(&self, simd: S, at: usize) -> Vector<S>;
}

impl Numbers for Row {
    #[inline(always)]
    fn load<S: Simd>(&self, simd: S, at: usize) -> Vector<S> {
        Vector::load(simd, self, at)
    }
}

impl Numbers for Single {
    #[inline(always)]
    fn load<S: Simd>(&self, simd: S, at: usize) -> Vector<S> {
        Vector::load_single(simd, self, at)
    }
}

/// Two components of each of eight.
pub(crate) type Rows = [Row; 2];

/// Both components in the lanes from `at` on.
#[inline(always)]
pub(crate) fn load<S: Simd>(simd: S, from: &Rows, at: usize) -> [Vector<S>; 2] {
    [Vector::load(simd, &from[0], at), Vector::load(simd, &from[1], at)]
}

/// Writes both components to the lanes from `at` on.
#[inline(always)]
pub(crate) fn store<S: Simd>([x, y]: [Vector<S>; 2], to: &mut Rows, at: usize) {
    x.store(&mut to[0], at);
    y.store(&mut to[1], at);
}

/// Both components of one of them.
#[inline(always)]
pub(crate) fn of_one(from: &Rows, lane: usize) -> [f64; 2] {
    [from[0][lane], from[1][lane]]
}

/// Upper bound of the magnitude of a sum of products, from the magnitudes of one factor and the bounds of the
/// other.
#[inline(always)]
pub(crate) fn largest_sum<S: Simd>(simd: S, sizes: &[Row], others: &[Row]) -> f64 {
    let mut sum = Vector::all(simd, 0.0);
    for (size, other) in sizes.iter().zip(others) {
        for at in vector_starts(simd) {
            let other = Vector::load(simd, other, at);
            sum = Vector::load(simd, size, at).times_plus(other.max(-other), sum);
        }
    }
    sum.sum()
}

/// The largest size of a vector of each kind, of lists of them with the components of all kinds one after the
/// other.
pub(crate) fn largest_of<const N: usize>(lists: &[f64], kinds: usize) -> Vec<Row> {
    let mut largest = vec![0.0_f64; kinds];
    for list in lists.chunks_exact(N * kinds) {
        for (kind, largest) in largest.iter_mut().enumerate() {
            let square: f64 = (0..N).map(|c| list[c * kinds + kind].powi(2)).sum();
            *largest = largest.max(square.sqrt());
        }
    }
    largest.as_chunks::<LANES>().0.iter().copied().map(Row).collect()
}

/// The lanes whose bits are set.
#[inline(always)]
pub(crate) fn lanes(bits: u64) -> Lanes {
    Lanes(bits)
}

/// See [`lanes`].
pub(crate) struct Lanes(u64);

impl Iterator for Lanes {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let lane = self.0.trailing_zeros() as usize;
        self.0 &= self.0.wrapping_sub(1);
        if lane < LANES { Some(lane) } else { None }
    }
}
