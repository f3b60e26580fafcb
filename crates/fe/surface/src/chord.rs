//! Facets that depend on their own two nodes only: a chord as polynomial, and the height of an arc above it
//! (THEORY §4.4).

use stribeck_simd::lanes::Number;

use crate::{
    facet::{Closest, Facet},
    foot::{FacetPoint, Foot, Push},
    plane::{dot, magnitude, minus, unit_normal},
    polynomial::Polynomial,
    smooth::{Rise, height, slope},
    surface::Surface,
};

/// A point at the distance d from a facet is compared with the neighbour where it stands closer to an end
/// than this times d: the line that halves the angle at a joint leans by half the turn there, at most 0.175
/// except at corners.
const NEAR_END: f64 = 0.25;

/// A chord in present positions.
#[derive(Debug, Clone, Copy)]
pub struct ChordFacet {
    number: usize,
    /// Slots of its ends.
    pub ends: (usize, usize),
    /// Its first node [m].
    origin: [f64; 2],
    /// From its first node to its second [m].
    along: [f64; 2],
    /// One over its length [1/m].
    inverse: f64,
    /// Unit normal of the chord, outwards.
    pub normal: [f64; 2],
    rise: Rise,
}

/// A foot so far within a chord of the length 1/`inverse` that no neighbour is nearer: the flag where it is
/// so, zero elsewhere.
#[inline(always)]
pub fn within_chord<N: Number>(place: N, gap: N, inverse: N, flag: N) -> N {
    let (zero, one) = (flag.constant(0.0), flag.constant(1.0));
    let margin = flag.constant(NEAR_END) * magnitude(gap) * inverse;
    margin.choose_below(place, place.choose_below(one - margin, flag, zero), zero)
}

impl Facet for ChordFacet {
    type Coefficients = Polynomial<f64, 2>;

    #[inline(always)]
    fn new(surface: &Surface, x: &[f64], y: &[f64], number: usize) -> Self {
        let (a, b) = surface.ends(number);
        let along = [x[b] - x[a], y[b] - y[a]];
        let (normal, inverse) = unit_normal(along);
        let rise = surface.rise[number];
        Self { number, ends: (a, b), origin: [x[a], y[a]], along, inverse, normal, rise }
    }

    #[inline(always)]
    fn number(&self) -> usize {
        self.number
    }

    #[inline(always)]
    fn point(&self, place: f64, height: f64) -> FacetPoint<f64> {
        let Self { origin: [ax, ay], along: [tx, ty], normal, inverse, .. } = *self;
        let at = [ax + place * tx + height * normal[0], ay + place * ty + height * normal[1]];
        FacetPoint { at, place, height, normal, inverse }
    }

    #[inline(always)]
    fn foot(&self, p: [f64; 2]) -> Foot<f64> {
        self.foot_at(p, dot(minus(p, self.origin), self.along) * (self.inverse * self.inverse))
    }

    #[inline(always)]
    fn closest(&self, p: [f64; 2]) -> Closest {
        let foot = self.foot(p);
        if (0.0..=1.0).contains(&foot.place) {
            return Closest { foot, distance: foot.gap.abs(), inside: true };
        }
        let end = if foot.place < 0.0 { 0.0 } else { 1.0 };
        let dx = p[0] - self.origin[0] - end * self.along[0];
        let dy = p[1] - self.origin[1] - end * self.along[1];
        Closest { foot, distance: (dx * dx + dy * dy).sqrt(), inside: false }
    }

    #[inline(always)]
    fn holds(&self, foot: &Foot<f64>) -> bool {
        within_chord(foot.place, foot.gap, self.inverse, 1.0) > 0.0
    }

    /// Beyond the line that halves the angle between the two chords.
    #[inline]
    fn is_past(&self, _foot: &Foot<f64>, other: &Self, forward: bool, p: [f64; 2]) -> bool {
        let vertex = if forward { other.origin } else { self.origin };
        let t = [0, 1].map(|k| self.along[k] * self.inverse + other.along[k] * other.inverse);
        let along = (p[0] - vertex[0]) * t[0] + (p[1] - vertex[1]) * t[1];
        if forward { along > 0.0 } else { along < 0.0 }
    }

    #[inline(always)]
    fn gather(&self, _surface: &Surface, x: &[f64], y: &[f64]) -> Polynomial<f64, 2> {
        let (a, b) = self.ends;
        Polynomial([[x[a], y[a]], [x[b] - x[a], y[b] - y[a]]])
    }

    #[inline(always)]
    fn scatter(&self, _surface: &Surface, forces: &Polynomial<f64, 2>, push: &mut Vec<Push>) {
        let Polynomial([all, second]) = *forces;
        push.push((self.ends.0 as u32, [all[0] - second[0], all[1] - second[1]]));
        push.push((self.ends.1 as u32, second));
    }
}

impl ChordFacet {
    /// Foot of `p`, of which the place is known.
    #[inline(always)]
    pub fn foot_at(&self, p: [f64; 2], place: f64) -> Foot<f64> {
        let Self { origin, along: [tx, ty], inverse, normal, rise, .. } = *self;
        let off = dot(minus(p, origin), normal);
        let (h, dh) = (height(rise, place), slope(rise, place));
        let square = inverse * inverse;
        // The chord's tangent falls with the curve's slope.
        let fall = dh * square;
        Foot {
            gap: off - h,
            normal: [normal[0] - fall * tx, normal[1] - fall * ty],
            place,
            turn: dh * off * square,
            height: h,
            curve_normal: normal,
            inverse,
        }
    }
}
