//! Facets of splines in present positions: points on them and feet on them, over any [`Number`]; a single one as a
//! [`Facet`].

use stribeck_simd::lanes::Number;

use crate::{
    facet::{Closest, Facet, Push},
    foot::{FacetPoint, Foot},
    plane::{choose, choose_each, dot, magnitude, minus, unit_normal},
    polynomial::{Coefficients, Polynomial, cubic, cubic_slope},
    surface::Surface,
};

/// Feet this close to a smooth joint belong to either facet: the curve goes on beyond its ends as far as that.
pub(crate) const JOINT: f64 = 1e-9;

/// A foot is found when less than this part of a facet is left to it.
pub(crate) const FOUND: f64 = 1e-12;

/// Corrections of single feet at most: far from the facet, where the walk goes on, they are given up.
const MOST_CORRECTIONS: usize = 6;

/// A facet's curve: a cubic in the plane and a cubic height above it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch<N> {
    curve: Polynomial<N, 4>,
    height: [N; 4],
    /// Chord over its squared length [1/m].
    chord: [N; 2],
}

impl Patch<f64> {
    #[inline(always)]
    pub(crate) fn new(curve: Polynomial<f64, 4>, height: [f64; 4]) -> Self {
        let Polynomial(c) = curve;
        let chord = [c[1][0] + c[2][0] + c[3][0], c[1][1] + c[2][1] + c[3][1]];
        let square = dot(chord, chord);
        Self { curve, height, chord: [chord[0] / square, chord[1] / square] }
    }

    /// The same in all lanes.
    #[inline(always)]
    pub(crate) fn spread<N: Number>(&self, like: N) -> Patch<N> {
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
pub(crate) fn spread<N: Number>(Polynomial(c): &Polynomial<f64, 4>, like: N) -> Polynomial<N, 4> {
    let mut lanes = [[like; 2]; 4];
    for k in 0..4 {
        lanes[k] = [like.constant(c[k][0]), like.constant(c[k][1])];
    }
    Polynomial(lanes)
}

/// Coefficients `yes` where the flag is one, `no` where it is zero.
#[inline(always)]
pub(crate) fn choose_all<N: Number>(
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
    pub(crate) fn chosen(flag: N, yes: &Self, no: &Self) -> Self {
        let mut height = yes.height;
        for k in 0..4 {
            height[k] = choose(flag, yes.height[k], no.height[k]);
        }
        let curve = choose_all(flag, &yes.curve, &no.curve);
        Self { curve, height, chord: choose_each(flag, yes.chord, no.chord) }
    }

    /// The point at a place and a height.
    #[inline(always)]
    pub(crate) fn point(&self, place: N, height: N) -> FacetPoint<N> {
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

    /// Foot of `p` on the curve, which goes on beyond its ends, and what part of a facet is left to it. Corrections end
    /// when the feet of all that are `wanted` are found, or after so many.
    #[inline(always)]
    pub(crate) fn foot(&self, p: [N; 2], wanted: N, corrections: usize) -> (Foot<N>, N) {
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
pub(crate) fn within_patch<N: Number>(place: N, flag: N) -> N {
    let (zero, joint) = (flag.constant(0.0), flag.constant(JOINT));
    let above = (-joint).choose_below(place, flag, zero);
    place.choose_below(flag.constant(1.0) + joint, above, zero)
}

/// A facet of a spline.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SplineFacet {
    number: usize,
    pub(crate) patch: Patch<f64>,
}

impl Facet for SplineFacet {
    type Coefficients = Polynomial<f64, 4>;

    #[inline(always)]
    fn new(surface: &Surface, x: &[f64], y: &[f64], number: usize) -> Self {
        let spline = surface.spline.as_ref().expect("only surfaces with a spline are seen as patches");
        Self { number, patch: spline.patch(x, y, number) }
    }

    #[inline(always)]
    fn number(&self) -> usize {
        self.number
    }

    #[inline(always)]
    fn point(&self, place: f64, height: f64) -> FacetPoint<f64> {
        self.patch.point(place, height)
    }

    #[inline(always)]
    fn foot(&self, p: [f64; 2]) -> Foot<f64> {
        self.patch.foot(p, 1.0, MOST_CORRECTIONS).0
    }

    fn closest(&self, p: [f64; 2]) -> Closest {
        let foot = self.foot(p);
        let inside = (0.0..=1.0).contains(&foot.place);
        let end = self.patch.curve.value(foot.place.clamp(0.0, 1.0));
        let distance = if inside { foot.gap.abs() } else { (p[0] - end[0]).hypot(p[1] - end[1]) };
        Closest { foot, distance, inside }
    }

    #[inline(always)]
    fn holds(&self, foot: &Foot<f64>) -> bool {
        within_patch(foot.place, 1.0) > 0.0
    }

    fn is_past(&self, foot: &Foot<f64>, _other: &Self, forward: bool, _p: [f64; 2]) -> bool {
        if forward { foot.place > 1.0 } else { foot.place < 0.0 }
    }

    #[inline(always)]
    fn gather(&self, surface: &Surface, x: &[f64], y: &[f64]) -> Polynomial<f64, 4> {
        match &surface.spline {
            Some(spline) => spline.gather(x, y, self.number),
            None => Polynomial::zero(0.0),
        }
    }

    #[inline(always)]
    fn scatter(&self, surface: &Surface, forces: &Polynomial<f64, 4>, push: &mut Vec<Push>) {
        if let Some(spline) = &surface.spline {
            spline.scatter(self.number, forces, push);
        }
    }
}
