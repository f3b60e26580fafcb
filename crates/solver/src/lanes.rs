//! Eight values side by side: what one instruction works on where the processor has wide registers.

/// Values that the kernels work on at a time, and congruent bodies that share a tile.
pub(crate) const LANES: usize = 8;

pub(crate) type Lanes = [f64; LANES];

/// The values from `at` on.
#[inline(always)]
pub(crate) fn lanes(v: &[f64], at: usize) -> &Lanes {
    v[at..at + LANES].try_into().expect("a slice of LANES values")
}

/// The values from `at` on, to change.
#[inline(always)]
pub(crate) fn lanes_mut(v: &mut [f64], at: usize) -> &mut Lanes {
    (&mut v[at..at + LANES]).try_into().expect("a slice of LANES values")
}
