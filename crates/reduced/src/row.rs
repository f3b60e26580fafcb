//! Numbers of eight rollers, contacts or modes side by side.

use std::ops::{Deref, DerefMut};

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Vector};

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
