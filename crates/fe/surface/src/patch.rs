//! The curve of a spline's facet in present positions: points on it and feet on it, over any [`Number`].

use stribeck_simd::lanes::Number;

use crate::{
    foot::{FacetPoint, Foot},
    plane::{choose, choose_each, dot, magnitude, minus, unit_normal},
    polynomial::{Coefficients, Polynomial, cubic, cubic_slope},
};

/// Feet this close to a smooth joint belong to either facet: the curve goes on beyond its ends as far as
/// that.
pub const JOINT: f64 = 1e-9;

/// A foot is found when less than this part of a facet is left to it.
pub const FOUND: f64 = 1e-12;

/// A facet's curve: a cubic in the plane and a cubic height above it.
#[derive(Debug, Clone, Copy)]
pub struct Patch<N> {
    /// The cubic in the plane [m].
    pub curve: Polynomial<N, 4>,
    height: [N; 4],
    /// Chord over its squared length [1/m].
    chord: [N; 2],
}

impl Patch<f64> {
    /// From the coefficients of the curve and of the height above it [m].
    #[inline(always)]
    pub fn new(curve: Polynomial<f64, 4>, height: [f64; 4]) -> Self {
        let Polynomial(c) = curve;
        let chord = [c[1][0] + c[2][0] + c[3][0], c[1][1] + c[2][1] + c[3][1]];
        let square = dot(chord, chord);
        Self { curve, height, chord: [chord[0] / square, chord[1] / square] }
    }

    /// The same in all lanes.
    #[inline(always)]
    pub fn spread<N: Number>(&self, like: N) -> Patch<N> {
        let [e, f, g, h] = self.height;
        Patch {
            curve: spread(&self.curve, like),
            height: [like.constant(e), like.constant(f), like.constant(g), like.constant(h)],
            chord: [like.constant(self.chord[0]), like.constant(self.chord[1])],
        }
    }
}

/// The same polynomial in all lanes.
#[inline(always)]
pub fn spread<N: Number>(Polynomial(c): &Polynomial<f64, 4>, like: N) -> Polynomial<N, 4> {
    let mut lanes = [[like; 2]; 4];
    for k in 0..4 {
        lanes[k] = [like.constant(c[k][0]), like.constant(c[k][1])];
    }
    Polynomial(lanes)
}

/// Coefficients `yes` where the flag is one, `no` where it is zero.
#[inline(always)]
pub fn choose_all<N: Number>(
    flag: N,
    Polynomial(yes): &Polynomial<N, 4>,
    Polynomial(no): &Polynomial<N, 4>,
) -> Polynomial<N, 4> {
    let mut chosen = *yes;
    for k in 0..4 {
        chosen[k] = choose_each(flag, yes[k], no[k]);
    }
    Polynomial(chosen)
}

impl<N: Number> Patch<N> {
    /// `yes` where the flag is one, `no` where it is zero.
    #[inline(always)]
    pub fn chosen(flag: N, yes: &Self, no: &Self) -> Self {
        let mut height = yes.height;
        for k in 0..4 {
            height[k] = choose(flag, yes.height[k], no.height[k]);
        }
        let curve = choose_all(flag, &yes.curve, &no.curve);
        Self { curve, height, chord: choose_each(flag, yes.chord, no.chord) }
    }

    /// The point at a place and a height.
    #[inline(always)]
    pub fn point(&self, place: N, height: N) -> FacetPoint<N> {
        let c = self.curve.value(place);
        let (normal, inverse) = unit_normal(self.curve.slope(place));
        let at = [height.times_plus(normal[0], c[0]), height.times_plus(normal[1], c[1])];
        FacetPoint { at, place, height, normal, inverse }
    }

    /// From the point of the curve to `p`, and the curve's first and second derivatives there.
    #[inline(always)]
    fn seen_from(&self, p: [N; 2], s: N) -> [[N; 2]; 3] {
        let Polynomial(c) = &self.curve;
        let (two, steep) = (s.constant(2.0), s.constant(3.0) * s);
        let bend = [two * steep.times_plus(c[3][0], c[2][0]), two * steep.times_plus(c[3][1], c[2][1])];
        [minus(p, self.curve.value(s)), self.curve.slope(s), bend]
    }

    /// Foot of `p` on the curve, which goes on beyond its ends, and what part of a facet is left to it.
    /// Corrections end when the feet of all that are `wanted` are found, or after this number.
    #[inline(always)]
    pub fn foot(&self, p: [N; 2], wanted: N, corrections: usize) -> (Foot<N>, N) {
        let (half, one, small) = (p[0].constant(0.5), p[0].constant(1.0), p[0].constant(FOUND));
        // Far beyond the facet's ends its polynomial is no guide.
        let (low, high) = (p[0].constant(-2.0), p[0].constant(3.0));
        let Polynomial(c) = &self.curve;
        let mut s = dot(minus(p, c[0]), self.chord).max(low).min(high);
        let [mut r, mut d, mut dd] = self.seen_from(p, s);
        let six = p[0].constant(6.0);
        let third = [six * c[3][0], six * c[3][1]];
        let mut square = dot(d, d);
        let mut rest = one;
        for _ in 0..corrections {
            // Chebyshev's: Newton's correction and the bend of r·d.
            let inverse = one / (square - dot(r, dd).min(half * square));
            let newton = dot(r, d) * inverse;
            let bend = half * inverse * (dot(r, third) - p[0].constant(3.0) * dot(d, dd));
            s = (bend * newton).times_plus(newton, s + newton).max(low).min(high);
            [r, d, dd] = self.seen_from(p, s);
            square = dot(d, d);
            rest = magnitude(dot(r, d));
            if (small * square).choose_below(rest, wanted, rest.constant(0.0)).bits() == 0 {
                break;
            }
        }
        let (n, inverse) = unit_normal(d);
        let off = dot(r, n);
        let height = cubic(&self.height, s);
        let steep = cubic_slope(&self.height, s) / (square - off * dot(n, dd));
        let foot = Foot {
            gap: off - height,
            normal: [n[0] - steep * d[0], n[1] - steep * d[1]],
            place: s,
            turn: steep * off,
            height,
            curve_normal: n,
            inverse,
        };
        (foot, rest * inverse * inverse)
    }
}

/// A place within the facet, or at a smooth joint: the flag where it is so, zero elsewhere.
#[inline(always)]
pub fn within_patch<N: Number>(place: N, flag: N) -> N {
    let (zero, joint) = (flag.constant(0.0), flag.constant(JOINT));
    let above = (-joint).choose_below(place, flag, zero);
    place.choose_below(flag.constant(1.0) + joint, above, zero)
}

#[cfg(test)]
mod tests {
    use pulp::{Arch, Simd, WithSimd};
    use stribeck_simd::lanes::{LANES, Vector};

    use super::*;

    const CORRECTIONS: usize = 6;

    /// Curves that leave their chord by up to a twentieth, with heights of a hundredth; points about the
    /// facet.
    fn cases() -> Vec<(Patch<f64>, [f64; 2])> {
        let mut seed = 1882_u64;
        let mut random = |scale: f64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            scale * ((seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
        };
        (0..25 * LANES)
            .map(|_| {
                let curve = [
                    [random(1.0), random(1.0)],
                    [1.0 + random(0.05), random(0.5)],
                    [random(0.05), random(0.05)],
                    [random(0.02), random(0.02)],
                ];
                let patch = Patch::new(Polynomial(curve), [(); 4].map(|()| random(0.01)));
                let at = patch.point(0.5 + random(0.6), random(0.1)).at;
                (patch, at)
            })
            .collect()
    }

    /// Value, normal and distance along it of a curve's point, power by power.
    fn plain(patch: &Patch<f64>, s: f64, p: [f64; 2]) -> ([f64; 2], f64) {
        let Polynomial(c) = patch.curve;
        let sum = |weights: [f64; 4], k: usize| (0..4).map(|i| weights[i] * c[i][k]).sum::<f64>();
        let at = [0, 1].map(|k| sum([1.0, s, s.powi(2), s.powi(3)], k));
        let t = [0, 1].map(|k| sum([0.0, 1.0, 2.0 * s, 3.0 * s.powi(2)], k));
        let length = t[0].hypot(t[1]);
        let r = [p[0] - at[0], p[1] - at[1]];
        // How far along the curve the point lies, and how far to the right of it.
        ([(r[0] * t[0] + r[1] * t[1]) / length, (r[0] * t[1] - r[1] * t[0]) / length], length)
    }

    /// The foot by bisection, and the gap there: distance along the normal, less the height.
    fn bisected(patch: &Patch<f64>, p: [f64; 2]) -> [f64; 2] {
        let (mut low, mut high) = (-2.0, 3.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if plain(patch, middle, p).0[0] > 0.0 { low = middle } else { high = middle }
        }
        let height: f64 = (0..4).map(|k| patch.height[k] * low.powi(k as i32)).sum();
        [low, plain(patch, low, p).0[1] - height]
    }

    fn check(what: &str, (patch, p): &(Patch<f64>, [f64; 2]), found: [f64; 4]) {
        // What corrections leave, and roundings of places of order one; the gradient has a difference of
        // 1e-6.
        const ROUNDING: f64 = 1e-11;
        const DIFFERENCE: f64 = 1e-8;
        let [place, gap] = bisected(patch, *p);
        assert!((found[0] - place).abs() < ROUNDING, "{what}: foot at {}, not {place}", found[0]);
        assert!((found[1] - gap).abs() < ROUNDING, "{what}: gap {}, not {gap}", found[1]);
        let h = 1e-6;
        for k in 0..2 {
            let moved = |by: f64| {
                let mut p = *p;
                p[k] += by;
                bisected(patch, p)[1]
            };
            let gradient = (moved(h) - moved(-h)) / (2.0 * h);
            assert!(
                (found[2 + k] - gradient).abs() < DIFFERENCE,
                "{what}: normal {found:?}, gradient {gradient}"
            );
        }
    }

    struct InLanes;

    impl WithSimd for InLanes {
        type Output = ();

        fn with_simd<S: Simd>(self, simd: S) {
            let len = Vector::<S>::LEN;
            let zero = Vector::all(simd, 0.0);
            for group in cases().chunks_exact(len) {
                // Each lane its own facet, chosen one after the other.
                let mut patch = group[0].0.spread(zero);
                for (l, (own, _)) in group.iter().enumerate() {
                    patch = Patch::chosen(Vector::ones(simd, 1 << l), &own.spread(zero), &patch);
                }
                let [x, y] = [0, 1].map(|k| group.iter().map(|(_, p)| p[k]).collect::<Vec<f64>>());
                let p = [Vector::load(simd, &x, 0), Vector::load(simd, &y, 0)];
                let (foot, rest) = patch.foot(p, Vector::all(simd, 1.0), CORRECTIONS);
                let mut found = [[0.0; LANES]; 5];
                let numbers = [foot.place, foot.gap, foot.normal[0], foot.normal[1], rest];
                for (vector, numbers) in numbers.into_iter().zip(&mut found) {
                    vector.store(numbers, 0);
                }
                for (l, case) in group.iter().enumerate() {
                    let [place, gap, nx, ny, rest] = found.map(|numbers| numbers[l]);
                    assert!(rest < FOUND, "lane {l}: {rest} left");
                    check(&format!("lane {l} of {len}"), case, [place, gap, nx, ny]);
                }
            }
        }
    }

    #[test]
    fn invariant_foot_is_where_bisection_finds_it_at_single_points_and_in_lanes() {
        for case in cases() {
            let (foot, rest) = case.0.foot(case.1, 1.0, CORRECTIONS);
            assert!(rest < FOUND, "{rest} left");
            check("single point", &case, [foot.place, foot.gap, foot.normal[0], foot.normal[1]]);
        }
        Arch::new().dispatch(InLanes);
    }
}
