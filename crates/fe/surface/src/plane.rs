//! Vectors in the plane, and choices lane by lane, over any [`Number`].
//!
//! Nothing in code over a `Number` is a closure: its body would not be compiled for the vectors' instruction
//! set.

use stribeck_simd::lanes::Number;

/// a · b.
#[inline(always)]
pub fn dot<N: Number>(a: [N; 2], b: [N; 2]) -> N {
    a[0].times_plus(b[0], a[1] * b[1])
}

/// a × b: how far b points to the left of a.
#[inline(always)]
pub fn cross<N: Number>(a: [N; 2], b: [N; 2]) -> N {
    a[0] * b[1] - a[1] * b[0]
}

/// a − b.
#[inline(always)]
pub fn minus<N: Number>(a: [N; 2], b: [N; 2]) -> [N; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// Absolute value.
#[inline(always)]
pub fn magnitude<N: Number>(a: N) -> N {
    a.max(-a)
}

/// Unit normal to the right of a tangent, and one over the tangent's length.
#[inline(always)]
pub fn unit_normal<N: Number>(tangent: [N; 2]) -> ([N; 2], N) {
    let inverse = tangent[0].constant(1.0) / dot(tangent, tangent).sqrt();
    ([tangent[1] * inverse, -(tangent[0] * inverse)], inverse)
}

/// Force [N] of a pressure force against a normal and a shear force to its left.
#[inline(always)]
pub fn force_of<N: Number>(normal: [N; 2], pressure: N, shear: N) -> [N; 2] {
    let [nx, ny] = normal;
    [pressure * nx - shear * ny, pressure * ny + shear * nx]
}

/// `yes` where the flag is one, `no` where it is zero. Chosen, not multiplied: a lane that does not count may
/// hold no number.
#[inline(always)]
pub fn choose<N: Number>(flag: N, yes: N, no: N) -> N {
    flag.constant(0.0).choose_below(flag, yes, no)
}

/// See [`choose`].
#[inline(always)]
pub fn choose_each<N: Number>(flag: N, yes: [N; 2], no: [N; 2]) -> [N; 2] {
    [choose(flag, yes[0], no[0]), choose(flag, yes[1], no[1])]
}
