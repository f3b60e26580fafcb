//! Polynomials in the place on a facet, over any [`Number`]: curves in the plane, and heights above them.

use stribeck_simd::lanes::Number;

/// A polynomial in the plane, coefficients of s⁰, s¹ …; as a sum of forces, the force on each coefficient.
#[derive(Debug, Clone, Copy)]
pub struct Polynomial<N, const K: usize>(pub [[N; 2]; K]);

/// Operations that facets of any degree need of their polynomials.
pub trait Coefficients<N>: Copy {
    /// All zero, of the kind of `like`.
    fn zero(like: N) -> Self;
    /// Value at a place.
    fn value(&self, s: N) -> [N; 2];
    /// Derivative by the place.
    fn slope(&self, s: N) -> [N; 2];
    /// Adds a force that acts on the value, and one that acts on the slope at `s`.
    fn add(&mut self, s: N, on_value: [N; 2], on_slope: [N; 2]);
    /// Adds coefficient by coefficient.
    fn add_all(&mut self, other: &Self);
}

impl<N: Number, const K: usize> Coefficients<N> for Polynomial<N, K> {
    #[inline(always)]
    fn zero(like: N) -> Self {
        Self([[like.constant(0.0); 2]; K])
    }

    #[inline(always)]
    fn value(&self, s: N) -> [N; 2] {
        let Self(c) = self;
        let mut v = c[K - 1];
        for k in (0..K - 1).rev() {
            v = [v[0].times_plus(s, c[k][0]), v[1].times_plus(s, c[k][1])];
        }
        v
    }

    #[inline(always)]
    fn slope(&self, s: N) -> [N; 2] {
        let Self(c) = self;
        let mut v = [times(K - 1, c[K - 1][0]), times(K - 1, c[K - 1][1])];
        for k in (1..K - 1).rev() {
            v = [v[0].times_plus(s, times(k, c[k][0])), v[1].times_plus(s, times(k, c[k][1]))];
        }
        v
    }

    #[inline(always)]
    fn add(&mut self, s: N, on_value: [N; 2], on_slope: [N; 2]) {
        let Self(c) = self;
        let mut power = s;
        c[0] = [c[0][0] + on_value[0], c[0][1] + on_value[1]];
        for k in 1..K {
            let mut steep = on_slope;
            if k > 1 {
                let slope = s.constant(k as f64) * power;
                power = power * s;
                steep = [on_slope[0] * slope, on_slope[1] * slope];
            }
            for x in 0..2 {
                c[k][x] = c[k][x] + on_value[x].times_plus(power, steep[x]);
            }
        }
    }

    #[inline(always)]
    fn add_all(&mut self, other: &Self) {
        for k in 0..K {
            self.0[k] = [self.0[k][0] + other.0[k][0], self.0[k][1] + other.0[k][1]];
        }
    }
}

/// k · x.
#[inline(always)]
fn times<N: Number>(k: usize, x: N) -> N {
    if k == 1 { x } else { x.constant(k as f64) * x }
}

/// Value of a cubic.
#[inline(always)]
pub fn cubic<N: Number>(c: &[N; 4], s: N) -> N {
    c[3].times_plus(s, c[2]).times_plus(s, c[1]).times_plus(s, c[0])
}

/// Derivative of a cubic.
#[inline(always)]
pub fn cubic_slope<N: Number>(c: &[N; 4], s: N) -> N {
    times(3, c[3]).times_plus(s, times(2, c[2])).times_plus(s, c[1])
}
