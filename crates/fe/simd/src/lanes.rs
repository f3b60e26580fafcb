//! Numbers that a kernel computes with: a single one, or a vector of them in the lanes of a register.

mod functions;

use std::ops::{Add, Div, Mul, Neg, Sub};

#[cfg(target_arch = "x86_64")]
use std::any::Any;

use pulp::Simd;
#[cfg(target_arch = "x86_64")]
use pulp::{
    bytemuck,
    x86::{V3, V4},
};

/// Numbers in a line of cache. No vector is longer, and arrays are cut into groups of that many.
pub const LANES: usize = 8;

/// Operations of a kernel on numbers.
///
/// A kernel that is written over it chooses between two values where a program for single numbers would
/// branch; flags are numbers too, one for yes and zero for no.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// self · factor + term. Vectors round once, whatever the instruction set but WebAssembly's; a single
    /// number rounds twice.
    fn times_plus(self, factor: Self, term: Self) -> Self;

    /// A constant of the same kind.
    fn constant(self, value: f64) -> Self;

    /// The square root.
    fn sqrt(self) -> Self;

    /// The cube root of a number that is not negative: of vectors within 3·10⁻¹⁴ of it.
    fn cube_root(self) -> Self;

    /// The arcus tangent [rad].
    fn arc_tangent(self) -> Self;

    /// The smaller of two numbers.
    fn min(self, other: Self) -> Self;

    /// The larger of two numbers.
    fn max(self, other: Self) -> Self;

    /// `yes` where this is below `limit`, `no` elsewhere.
    fn choose_below(self, limit: Self, yes: Self, no: Self) -> Self;

    /// Of flags: bit l is set where number l is one. A single number is number 0.
    fn bits(self) -> u64;

    /// Bit l is set where number l is below that of `limit`.
    fn bits_below(self, limit: Self) -> u64;
}

impl Number for f64 {
    #[inline(always)]
    fn times_plus(self, factor: f64, term: f64) -> f64 {
        self * factor + term
    }

    #[inline(always)]
    fn constant(self, value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        self.sqrt()
    }

    #[inline(always)]
    fn cube_root(self) -> f64 {
        libm::cbrt(self)
    }

    #[inline(always)]
    fn arc_tangent(self) -> f64 {
        libm::atan(self)
    }

    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        self.min(other)
    }

    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        self.max(other)
    }

    #[inline(always)]
    fn choose_below(self, limit: f64, yes: f64, no: f64) -> f64 {
        if self < limit { yes } else { no }
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        u64::from(self > 0.5)
    }

    #[inline(always)]
    fn bits_below(self, limit: f64) -> u64 {
        u64::from(self < limit)
    }
}

/// a · b + c of single numbers with the bits that vectors get: rounded once, but in WebAssembly.
#[inline(always)]
pub fn fused(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_arch = "wasm32") { a * b + c } else { a.mul_add(b, c) }
}

/// Indices at which the vectors of [`LANES`] numbers begin: one for vectors of eight, two for vectors of
/// four.
///
/// ```
/// # use pulp::Scalar;
/// # use stribeck_simd::lanes::{LANES, Vector, vector_starts};
/// let (numbers, mut doubled) = ([3.0; LANES], [0.0; LANES]);
/// for at in vector_starts(Scalar::new()) {
///     let of = Vector::load(Scalar::new(), &numbers, at);
///     (of + of).store(&mut doubled, at);
/// }
/// assert_eq!(doubled, [6.0; LANES]);
/// ```
#[inline(always)]
pub fn vector_starts<S: Simd>(_: S) -> VectorStarts {
    VectorStarts { at: 0, step: Vector::<S>::LEN }
}

/// See [`vector_starts`].
#[derive(Debug, Clone)]
pub struct VectorStarts {
    at: usize,
    step: usize,
}

impl Iterator for VectorStarts {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let at = self.at;
        self.at += self.step;
        if at < LANES { Some(at) } else { None }
    }
}

/// Numbers side by side, in a register of the instruction set `S`.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub struct Vector<S: Simd> {
    simd: S,
    lanes: S::f64s,
}

/// Ones and then zeros, bit by bit: a window of it keeps the first numbers of a vector.
static KEEP: [u64; 2 * LANES] = {
    let mut keep = [0; 2 * LANES];
    let mut i = 0;
    while i < LANES {
        keep[i] = u64::MAX;
        i += 1;
    }
    keep
};

/// The bits of the last number of a vector that ends here.
static KEEP_LAST: [u64; LANES] = [0, 0, 0, 0, 0, 0, 0, u64::MAX];

impl<S: Simd> Vector<S> {
    /// How many numbers it holds: 1, 2, 4 or 8.
    pub const LEN: usize = S::F64_LANES;

    #[inline(always)]
    pub(crate) fn simd(self) -> S {
        self.simd
    }

    /// The same number in all lanes.
    #[inline(always)]
    pub fn all(simd: S, value: f64) -> Self {
        Self { simd, lanes: simd.splat_f64s(value) }
    }

    /// One in each lane l whose bit l is set, zero in the others: what [`bits`](Number::bits) makes of it.
    #[inline(always)]
    pub fn ones(simd: S, bits: u64) -> Self {
        const BITS: [u64; LANES] = [1, 2, 4, 8, 16, 32, 64, 128];
        let each = S::as_simd_u64s(&BITS[..Self::LEN]).0[0];
        let set = simd.and_u64s(simd.splat_u64s(bits), each);
        let chosen = simd.equal_u64s(set, each);
        let one = simd.transmute_u64s_f64s(simd.splat_f64s(1.0));
        let zero = simd.transmute_u64s_f64s(simd.splat_f64s(0.0));
        Self { simd, lanes: simd.transmute_f64s_u64s(simd.select_u64s(chosen, one, zero)) }
    }

    /// The numbers of `from` from index `at` on.
    ///
    /// # Panics
    /// When fewer than [`Self::LEN`] are left.
    #[inline(always)]
    pub fn load(simd: S, from: &[f64], at: usize) -> Self {
        Self { simd, lanes: S::as_simd_f64s(&from[at..at + Self::LEN]).0[0] }
    }

    /// The numbers of `from` from index `at` on, which are kept in single precision: half the bytes where a
    /// table is looked up.
    ///
    /// # Panics
    /// When fewer than [`Self::LEN`] are left.
    #[inline(always)]
    pub fn load_single(simd: S, from: &[f32], at: usize) -> Self {
        let from = &from[at..at + Self::LEN];
        #[cfg(target_arch = "x86_64")]
        {
            let any = &simd as &dyn Any;
            if let (Some(v4), Some(all)) = (any.downcast_ref::<V4>(), from.first_chunk::<8>()) {
                let lanes = v4.avx512f._mm512_cvtps_pd(bytemuck::cast(*all));
                return Self { simd, lanes: bytemuck::cast(lanes) };
            }
            if let (Some(v3), Some(all)) = (any.downcast_ref::<V3>(), from.first_chunk::<4>()) {
                let lanes = v3.avx._mm256_cvtps_pd(bytemuck::cast(*all));
                return Self { simd, lanes: bytemuck::cast(lanes) };
            }
        }
        let mut numbers = [0.0; LANES];
        for (number, from) in numbers.iter_mut().zip(from) {
            *number = f64::from(*from);
        }
        Self::load(simd, &numbers, 0)
    }

    /// Writes the numbers to `to` from index `at` on.
    ///
    /// # Panics
    /// When there is no room for all of them.
    #[inline(always)]
    pub fn store(self, to: &mut [f64], at: usize) {
        S::as_mut_simd_f64s(&mut to[at..at + Self::LEN]).0[0] = self.lanes;
    }

    /// Writes the first `n` numbers to `to` from index `at` on, and leaves what follows as it is.
    ///
    /// # Panics
    /// When there is no room for all of them.
    #[inline(always)]
    pub fn store_first(self, n: usize, to: &mut [f64], at: usize) {
        let simd = self.simd;
        let keep = S::as_simd_u64s(&KEEP[LANES - n..LANES - n + Self::LEN]).0[0];
        let old = simd.transmute_u64s_f64s(Self::load(simd, to, at).lanes);
        let changed = simd.xor_u64s(old, simd.transmute_u64s_f64s(self.lanes));
        let bits = simd.xor_u64s(old, simd.and_u64s(changed, keep));
        Self { lanes: simd.transmute_f64s_u64s(bits), ..self }.store(to, at);
    }

    /// The first `n` numbers; zeros in the other lanes.
    #[inline(always)]
    pub fn first(self, n: usize) -> Self {
        let keep = S::as_simd_u64s(&KEEP[LANES - n..LANES - n + Self::LEN]).0[0];
        let bits = self.simd.and_u64s(self.simd.transmute_u64s_f64s(self.lanes), keep);
        Self { lanes: self.simd.transmute_f64s_u64s(bits), ..self }
    }

    /// Every number one lane up; the last one of `before` in the first lane.
    #[inline(always)]
    pub fn shifted_in(self, before: Self) -> Self {
        let simd = self.simd;
        #[cfg(target_arch = "x86_64")]
        {
            let any = &simd as &dyn Any;
            if let Some(v4) = any.downcast_ref::<V4>() {
                const NEXT: [u64; LANES] = [7, 8, 9, 10, 11, 12, 13, 14];
                let (now, before) = (bytemuck::cast(self.lanes), bytemuck::cast(before.lanes));
                let joined = v4.avx512f._mm512_permutex2var_pd(before, bytemuck::cast(NEXT), now);
                return Self { lanes: bytemuck::cast(joined), ..self };
            }
            if let Some(v3) = any.downcast_ref::<V3>() {
                let (now, before) = (bytemuck::cast(self.lanes), bytemuck::cast(before.lanes));
                // Numbers b of `before` and n of `self`: b₂ b₃ n₀ n₁, then b₃ n₀ n₁ n₂.
                let middle = v3.avx._mm256_permute2f128_pd::<0x21>(before, now);
                let joined = v3.avx._mm256_shuffle_pd::<0b0101>(middle, now);
                return Self { lanes: bytemuck::cast(joined), ..self };
            }
        }
        let all_but_last = S::as_simd_u64s(&KEEP[LANES - Self::LEN + 1..LANES + 1]).0[0];
        let last = S::as_simd_u64s(&KEEP_LAST[LANES - Self::LEN..LANES]).0[0];
        let (now, before) = (simd.transmute_u64s_f64s(self.lanes), simd.transmute_u64s_f64s(before.lanes));
        let joined = simd.or_u64s(simd.and_u64s(now, all_but_last), simd.and_u64s(before, last));
        Self { lanes: simd.rotate_right_f64s(simd.transmute_f64s_u64s(joined), 1), ..self }
    }

    /// The smallest of all numbers.
    #[inline(always)]
    pub fn smallest(self) -> f64 {
        self.simd.reduce_min_f64s(self.lanes)
    }

    /// The largest of all numbers.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        self.simd.reduce_max_f64s(self.lanes)
    }

    /// The sum of all numbers.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.simd.reduce_sum_f64s(self.lanes)
    }

    /// Writes the sums of eight vectors side by side, which lie at the beginning of `from`: a third of the
    /// instructions that eight sums take one by one.
    ///
    /// # Panics
    /// When one of them has fewer than [`Self::LEN`] numbers.
    #[inline(always)]
    pub fn store_sums(simd: S, from: [&[f64]; LANES], to: &mut [f64; LANES]) {
        Self::store_joined::<SUM>(simd, from, to);
    }

    /// Writes the largest numbers of eight vectors side by side, as [`store_sums`](Self::store_sums) does
    /// their sums.
    ///
    /// # Panics
    /// When one of them has fewer than [`Self::LEN`] numbers.
    #[inline(always)]
    pub fn store_largest(simd: S, from: [&[f64]; LANES], to: &mut [f64; LANES]) {
        Self::store_joined::<LARGEST>(simd, from, to);
    }

    #[inline(always)]
    fn store_joined<const HOW: u8>(simd: S, from: [&[f64]; LANES], to: &mut [f64; LANES]) {
        #[cfg(target_arch = "x86_64")]
        {
            let any = &simd as &dyn Any;
            // Written out: loops would keep all in memory.
            let [a, b, c, d, e, f, g, h] = from;
            if let Some(v4) = any.downcast_ref::<V4>() {
                // Neighbours of two vectors, then their sources in four and in eight.
                let ab = Self::joined::<HOW>(Self::load(simd, a, 0).neighbours(*v4, Self::load(simd, b, 0)));
                let cd = Self::joined::<HOW>(Self::load(simd, c, 0).neighbours(*v4, Self::load(simd, d, 0)));
                let ef = Self::joined::<HOW>(Self::load(simd, e, 0).neighbours(*v4, Self::load(simd, f, 0)));
                let gh = Self::joined::<HOW>(Self::load(simd, g, 0).neighbours(*v4, Self::load(simd, h, 0)));
                let first = Self::joined::<HOW>(ab.pairs(*v4, cd));
                let last = Self::joined::<HOW>(ef.pairs(*v4, gh));
                Self::joined::<HOW>(first.pairs(*v4, last)).store(to, 0);
                return;
            }
            if let Some(v3) = any.downcast_ref::<V3>() {
                Self::joined_four::<HOW>(simd, *v3, [a, b, c, d]).store(to, 0);
                Self::joined_four::<HOW>(simd, *v3, [e, f, g, h]).store(to, 4);
                return;
            }
        }
        for (to, from) in to.iter_mut().zip(from) {
            let of = Self::load(simd, from, 0);
            *to = if HOW == SUM { of.sum() } else { of.largest() };
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn joined<const HOW: u8>([a, b]: [Self; 2]) -> Self {
        if HOW == SUM { a + b } else { a.max(b) }
    }

    /// Four vectors of four, joined lane by lane in the order in which `sum` adds them.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn joined_four<const HOW: u8>(simd: S, v3: V3, [a, b, c, d]: [&[f64]; 4]) -> Self {
        let ac = Self::joined::<HOW>(Self::load(simd, a, 0).halves(v3, Self::load(simd, c, 0)));
        let bd = Self::joined::<HOW>(Self::load(simd, b, 0).halves(v3, Self::load(simd, d, 0)));
        let (ac, bd) = (bytemuck::cast(ac.lanes), bytemuck::cast(bd.lanes));
        let (even, odd) = (v3.avx._mm256_unpacklo_pd(ac, bd), v3.avx._mm256_unpackhi_pd(ac, bd));
        let (even, odd) = (bytemuck::cast(even), bytemuck::cast(odd));
        Self::joined::<HOW>([Self { simd, lanes: even }, Self { simd, lanes: odd }])
    }

    /// Lower halves of two vectors, and upper ones.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn halves(self, v3: V3, other: Self) -> [Self; 2] {
        let (a, b) = (bytemuck::cast(self.lanes), bytemuck::cast(other.lanes));
        let lower = v3.avx._mm256_permute2f128_pd::<0x20>(a, b);
        let upper = v3.avx._mm256_permute2f128_pd::<0x31>(a, b);
        [Self { lanes: bytemuck::cast(lower), ..self }, Self { lanes: bytemuck::cast(upper), ..self }]
    }

    /// Even numbers of two vectors in turn, and odd ones.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn neighbours(self, v4: V4, other: Self) -> [Self; 2] {
        let (a, b) = (bytemuck::cast(self.lanes), bytemuck::cast(other.lanes));
        let (even, odd) = (v4.avx512f._mm512_unpacklo_pd(a, b), v4.avx512f._mm512_unpackhi_pd(a, b));
        [Self { lanes: bytemuck::cast(even), ..self }, Self { lanes: bytemuck::cast(odd), ..self }]
    }

    /// Even pairs of numbers of one vector and then of another, and odd ones.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn pairs(self, v4: V4, other: Self) -> [Self; 2] {
        let (a, b) = (bytemuck::cast(self.lanes), bytemuck::cast(other.lanes));
        let even = v4.avx512f._mm512_shuffle_f64x2::<0b10_00_10_00>(a, b);
        let odd = v4.avx512f._mm512_shuffle_f64x2::<0b11_01_11_01>(a, b);
        [Self { lanes: bytemuck::cast(even), ..self }, Self { lanes: bytemuck::cast(odd), ..self }]
    }
}

/// What eight vectors are joined by.
const SUM: u8 = 0;
const LARGEST: u8 = 1;

macro_rules! lane_by_lane {
    ($($operation:ident, $name:ident, $of_lanes:ident;)*) => {$(
        impl<S: Simd> $operation for Vector<S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self { lanes: self.simd.$of_lanes(self.lanes, other.lanes), ..self }
            }
        }
    )*};
}

lane_by_lane! {
    Add, add, add_f64s;
    Sub, sub, sub_f64s;
    Mul, mul, mul_f64s;
    Div, div, div_f64s;
}

impl<S: Simd> Neg for Vector<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { lanes: self.simd.xor_f64s(self.lanes, self.simd.splat_f64s(-0.0)), ..self }
    }
}

impl<S: Simd> Number for Vector<S> {
    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        // WebAssembly has no instruction that rounds once; a function that imitates it takes fifty times as
        // long.
        #[cfg(target_arch = "wasm32")]
        return Self { lanes: self.simd.mul_add_e_f64s(self.lanes, factor.lanes, term.lanes), ..self };
        #[cfg(not(target_arch = "wasm32"))]
        Self { lanes: self.simd.mul_add_f64s(self.lanes, factor.lanes, term.lanes), ..self }
    }

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        Self::all(self.simd, value)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { lanes: self.simd.sqrt_f64s(self.lanes), ..self }
    }

    #[inline(always)]
    fn cube_root(self) -> Self {
        functions::cube_root(self)
    }

    #[inline(always)]
    fn arc_tangent(self) -> Self {
        functions::arc_tangent(self)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self { lanes: self.simd.min_f64s(self.lanes, other.lanes), ..self }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self { lanes: self.simd.max_f64s(self.lanes, other.lanes), ..self }
    }

    #[inline(always)]
    fn choose_below(self, limit: Self, yes: Self, no: Self) -> Self {
        let below = self.simd.less_than_f64s(self.lanes, limit.lanes);
        let (yes, no) = (self.simd.transmute_u64s_f64s(yes.lanes), self.simd.transmute_u64s_f64s(no.lanes));
        Self { lanes: self.simd.transmute_f64s_u64s(self.simd.select_u64s(below, yes, no)), ..self }
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        self.constant(0.5).bits_below(self)
    }

    #[inline(always)]
    fn bits_below(self, limit: Self) -> u64 {
        const WEIGHTS: [f64; LANES] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0];
        let below = self.simd.less_than_f64s(self.lanes, limit.lanes);
        // A mask register holds these very bits.
        if let &[bits] = pulp::bytemuck::bytes_of(&below) {
            return u64::from(bits);
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = (&self.simd as &dyn Any).downcast_ref::<V3>() {
            return u64::from(v3.avx._mm256_movemask_pd(bytemuck::cast(below)) as u32);
        }
        let weights = Self::load(self.simd, &WEIGHTS, 0);
        self.choose_below(limit, weights, self.constant(0.0)).sum() as u64
    }
}

#[cfg(test)]
mod tests {
    use pulp::{Arch, Scalar, WithSimd};

    use super::*;

    /// Loads, sums, shifts, bits and functions, for any instruction set.
    struct Properties;

    impl WithSimd for Properties {
        type Output = usize;

        fn with_simd<S: Simd>(self, simd: S) -> usize {
            let len = Vector::<S>::LEN;
            let numbers: Vec<f64> = (0..2 * LANES).map(|i| 0.5 + i as f64).collect();
            let (low, high) = (Vector::load(simd, &numbers, 0), Vector::load(simd, &numbers, len));
            assert_eq!(high.sum(), numbers[len..2 * len].iter().sum::<f64>());
            let mut shifted = vec![0.0; len];
            high.shifted_in(low).store(&mut shifted, 0);
            assert_eq!(shifted, numbers[len - 1..2 * len - 1]);
            let eight: [_; LANES] = std::array::from_fn(|k| &numbers[k..k + len]);
            let (mut sums, mut largest) = ([0.0; LANES], [0.0; LANES]);
            Vector::store_sums(simd, eight, &mut sums);
            Vector::store_largest(simd, eight, &mut largest);
            assert_eq!(sums, eight.map(|of| of.iter().sum::<f64>()));
            assert_eq!(largest, eight.map(|of| of[len - 1]));
            let single: Vec<f32> = numbers.iter().map(|number| *number as f32 + 0.1).collect();
            let mut loaded = vec![0.0; len];
            Vector::load_single(simd, &single, 1).store(&mut loaded, 0);
            assert!(loaded.iter().zip(&single[1..]).all(|(loaded, single)| *loaded == f64::from(*single)));
            for n in 0..4000 {
                // From 10⁻³⁰ to 10³⁰ in size.
                let number = 10.0_f64.powf(f64::from(n) * 0.015 - 30.0);
                let of = |vector: Vector<S>| vector.largest();
                let root = of(Vector::all(simd, number).cube_root());
                assert!((root / number.cbrt() - 1.0).abs() < 3e-14, "{root} of {number}");
                for number in [number, -number] {
                    let angle = of(Vector::all(simd, number).arc_tangent());
                    assert!((angle / number.atan() - 1.0).abs() < 5e-16, "{angle} of {number}");
                }
            }
            assert_eq!(Vector::all(simd, 0.0).cube_root().largest(), 0.0);
            for bits in 0..1_u64 << len {
                let ones = Vector::ones(simd, bits);
                assert_eq!(ones.bits(), bits, "{len} lanes");
                assert_eq!(Vector::all(simd, 0.0).bits_below(ones), bits, "{len} lanes");
                assert_eq!(ones.bits_below(ones), 0, "{len} lanes");
                assert_eq!(ones.sum(), f64::from(bits.count_ones()));
            }
            len
        }
    }

    #[test]
    fn invariant_lanes_mean_the_same_on_every_instruction_set() {
        assert_eq!(Properties.with_simd(Scalar), 1);
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = pulp::x86::V3::try_new() {
            assert_eq!(Simd::vectorize(avx2, Properties), 4);
        }
        assert!(Arch::new().dispatch(Properties) <= LANES);
    }
}
