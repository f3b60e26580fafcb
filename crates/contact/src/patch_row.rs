//! Facets of splines, a vector of points at a time: points on them, feet on them, how they move and what acts on them.
//! Each formula is that of `spline.rs` and `shape.rs` for one point.
//!
//! Nothing here is a closure: what a closure does is not compiled for the vectors' instruction set.

use pulp::Simd;
use stribeck_simd::lanes::{Number, Vector};

use crate::{
    shape::{Poly, Side},
    spline::{JOINT, Patch},
};

/// A foot is found when less than this part of a facet is left to it.
const SMALL: f64 = 1e-12;

/// Corrections of a foot at most; on meshes that resolve their curves one is enough.
const CORRECTIONS: usize = 3;

/// Values of a curve's polynomial in all lanes.
pub(crate) type Curve<V> = [[Vector<V>; 2]; 4];

/// A facet's coefficients, each lane its own.
pub(crate) struct Lanes<V: Simd> {
    curve: Curve<V>,
    motion: Curve<V>,
    height: [Vector<V>; 4],
    /// Chord over its squared length [1/m].
    chord: [Vector<V>; 2],
}

/// Points of a facet, as in [`Spot`](crate::shape::Spot).
pub(crate) struct Spots<V: Simd> {
    pub(crate) at: [Vector<V>; 2],
    place: Vector<V>,
    height: Vector<V>,
    normal: [Vector<V>; 2],
    inverse: Vector<V>,
}

/// Feet of points, as in [`Projection`](crate::Projection), and what is left to them.
pub(crate) struct Foot<V: Simd> {
    pub(crate) gap: Vector<V>,
    normal: [Vector<V>; 2],
    place: Vector<V>,
    turn: Vector<V>,
    height: Vector<V>,
    curve_normal: [Vector<V>; 2],
    inverse: Vector<V>,
    rest: Vector<V>,
}

impl<V: Simd> Spots<V> {
    /// Adds forces on the points to those on the facet, as `Side::push_point` does.
    #[inline(always)]
    pub(crate) fn push(&self, f: [Vector<V>; 2], forces: &mut Curve<V>) {
        let n = self.normal;
        let lever = self.height * self.inverse * (f[0] * n[1] - f[1] * n[0]);
        add(forces, self.place, f, [lever * n[0], lever * n[1]]);
    }
}

impl<V: Simd> Foot<V> {
    /// Those of `waiting` whose foot is found and lies within the facet.
    #[inline(always)]
    pub(crate) fn held(&self, waiting: Vector<V>) -> Vector<V> {
        let (zero, joint) = (waiting.constant(0.0), waiting.constant(JOINT));
        let found = self.rest.choose_below(waiting.constant(SMALL), waiting, zero);
        let above = (-joint).choose_below(self.place, found, zero);
        self.place.choose_below(waiting.constant(1.0) + joint, above, zero)
    }

    /// Force of a pressure and a shear force on the points that are on.
    #[inline(always)]
    pub(crate) fn force(&self, [pressure, shear]: [Vector<V>; 2], on: Vector<V>) -> [Vector<V>; 2] {
        let [nx, ny] = self.normal;
        pick(on, [pressure * nx - shear * ny, pressure * ny + shear * nx], [on.constant(0.0); 2])
    }

    /// The reaction to the force `f`, what each coefficient gets, as `Side::push_foot` finds it.
    #[inline(always)]
    pub(crate) fn push(
        &self,
        f: [Vector<V>; 2],
        [pressure, shear]: [Vector<V>; 2],
        on: Vector<V>,
    ) -> Curve<V> {
        let zero = on.constant(0.0);
        let swing = self.height * self.inverse * shear * dot(self.normal, self.curve_normal);
        let lever = zero.choose_below(on, swing - self.turn * pressure, zero);
        let mut forces = [[zero; 2]; 4];
        let on_slope = [lever * self.curve_normal[0], lever * self.curve_normal[1]];
        add(&mut forces, self.place, [-f[0], -f[1]], on_slope);
        forces
    }
}

/// Rates of the gaps and tangential velocities, as `Side::slide` finds them.
#[inline(always)]
pub(crate) fn slide<V: Simd>(
    own: &Lanes<V>,
    spots: &Spots<V>,
    to: &Lanes<V>,
    foot: &Foot<V>,
) -> [Vector<V>; 2] {
    let swing = dot(spots.normal, slope(&own.motion, spots.place));
    let v = off_curve(value(&own.motion, spots.place), swing * spots.height * spots.inverse, spots.normal);
    let swing = dot(foot.curve_normal, slope(&to.motion, foot.place));
    let u = value(&to.motion, foot.place);
    let opening = dot(foot.normal, [v[0] - u[0], v[1] - u[1]]) - foot.turn * swing;
    let u = off_curve(u, swing * foot.height * foot.inverse, foot.curve_normal);
    [opening, foot.normal[0] * (v[1] - u[1]) - foot.normal[1] * (v[0] - u[0])]
}

impl<V: Simd> Lanes<V> {
    /// The same facet in all lanes.
    #[inline(always)]
    pub(crate) fn of(simd: V, side: &Side<Patch>) -> Self {
        let (Poly(curve), Poly(motion)) = (side.shape.curve, side.coefficients_of_motion());
        let chord = [curve[1][0] + curve[2][0] + curve[3][0], curve[1][1] + curve[2][1] + curve[3][1]];
        let square = chord[0] * chord[0] + chord[1] * chord[1];
        let [e, f, g, h] = side.shape.height;
        Self {
            curve: all(simd, &curve),
            motion: all(simd, &motion),
            height: [Vector::all(simd, e), Vector::all(simd, f), Vector::all(simd, g), Vector::all(simd, h)],
            chord: [Vector::all(simd, chord[0] / square), Vector::all(simd, chord[1] / square)],
        }
    }

    /// `yes` in the lanes that are one, `no` in those that are zero.
    #[inline(always)]
    pub(crate) fn chosen(lanes: Vector<V>, yes: &Self, no: &Self) -> Self {
        let (mut curve, mut motion, mut height) = (yes.curve, yes.motion, yes.height);
        for k in 0..4 {
            curve[k] = pick(lanes, yes.curve[k], no.curve[k]);
            motion[k] = pick(lanes, yes.motion[k], no.motion[k]);
            height[k] = lanes.constant(0.0).choose_below(lanes, yes.height[k], no.height[k]);
        }
        Self { curve, motion, height, chord: pick(lanes, yes.chord, no.chord) }
    }

    /// Points at places and heights.
    #[inline(always)]
    pub(crate) fn spots(&self, place: Vector<V>, height: Vector<V>) -> Spots<V> {
        let (c, d) = (value(&self.curve, place), slope(&self.curve, place));
        let inverse = place.constant(1.0) / dot(d, d).sqrt();
        let normal = [d[1] * inverse, -(d[0] * inverse)];
        let at = [height.times_plus(normal[0], c[0]), height.times_plus(normal[1], c[1])];
        Spots { at, place, height, normal, inverse }
    }

    /// From points of the curve to `p`, and the first and second derivatives there.
    #[inline(always)]
    fn seen_from(&self, p: [Vector<V>; 2], s: Vector<V>) -> [[Vector<V>; 2]; 3] {
        let (c, at) = (&self.curve, value(&self.curve, s));
        let (two, steep) = (s.constant(2.0), s.constant(3.0) * s);
        let bend = [two * steep.times_plus(c[3][0], c[2][0]), two * steep.times_plus(c[3][1], c[2][1])];
        [[p[0] - at[0], p[1] - at[1]], slope(c, s), bend]
    }

    /// Feet of the points `p`, as `Patch::above` finds them, until those of the points `open` are found.
    #[inline(always)]
    pub(crate) fn foot(&self, p: [Vector<V>; 2], open: Vector<V>) -> Foot<V> {
        let (half, one, small) = (p[0].constant(0.5), p[0].constant(1.0), p[0].constant(SMALL));
        let (low, high) = (p[0].constant(-2.0), p[0].constant(3.0));
        let start = [p[0] - self.curve[0][0], p[1] - self.curve[0][1]];
        let mut s = dot(start, self.chord).max(low).min(high);
        let [mut r, mut d, mut dd] = self.seen_from(p, s);
        let six = p[0].constant(6.0);
        let third = [six * self.curve[3][0], six * self.curve[3][1]];
        let mut square = dot(d, d);
        let mut rest = one;
        for _ in 0..CORRECTIONS {
            // Chebyshev's: Newton's correction and the bend of r·d.
            let inverse = one / (square - dot(r, dd).min(half * square));
            let newton = dot(r, d) * inverse;
            let bend = half * inverse * (dot(r, third) - p[0].constant(3.0) * dot(d, dd));
            s = (bend * newton).times_plus(newton, s + newton).max(low).min(high);
            [r, d, dd] = self.seen_from(p, s);
            square = dot(d, d);
            rest = dot(r, d);
            rest = rest.max(-rest);
            if (small * square).choose_below(rest, open, rest.constant(0.0)).bits() == 0 {
                break;
            }
        }
        let inverse = one / square.sqrt();
        let n = [d[1] * inverse, -(d[0] * inverse)];
        let off = dot(r, n);
        let h = &self.height;
        let height = h[3].times_plus(s, h[2]).times_plus(s, h[1]).times_plus(s, h[0]);
        let rise = (s.constant(3.0) * h[3]).times_plus(s, s.constant(2.0) * h[2]).times_plus(s, h[1]);
        let steep = rise / (square - off * dot(n, dd));
        Foot {
            gap: off - height,
            normal: [n[0] - steep * d[0], n[1] - steep * d[1]],
            place: s,
            turn: steep * off,
            height,
            curve_normal: n,
            inverse,
            rest: rest * inverse * inverse,
        }
    }
}

#[inline(always)]
fn all<V: Simd>(simd: V, c: &[[f64; 2]; 4]) -> Curve<V> {
    let mut lanes = [[Vector::all(simd, 0.0); 2]; 4];
    for k in 0..4 {
        lanes[k] = [Vector::all(simd, c[k][0]), Vector::all(simd, c[k][1])];
    }
    lanes
}

#[inline(always)]
pub(crate) fn pick<V: Simd>(lanes: Vector<V>, yes: [Vector<V>; 2], no: [Vector<V>; 2]) -> [Vector<V>; 2] {
    let zero = lanes.constant(0.0);
    [zero.choose_below(lanes, yes[0], no[0]), zero.choose_below(lanes, yes[1], no[1])]
}

#[inline(always)]
fn dot<V: Simd>(a: [Vector<V>; 2], b: [Vector<V>; 2]) -> Vector<V> {
    a[0].times_plus(b[0], a[1] * b[1])
}

#[inline(always)]
fn value<V: Simd>(c: &Curve<V>, s: Vector<V>) -> [Vector<V>; 2] {
    [
        c[3][0].times_plus(s, c[2][0]).times_plus(s, c[1][0]).times_plus(s, c[0][0]),
        c[3][1].times_plus(s, c[2][1]).times_plus(s, c[1][1]).times_plus(s, c[0][1]),
    ]
}

#[inline(always)]
fn slope<V: Simd>(c: &Curve<V>, s: Vector<V>) -> [Vector<V>; 2] {
    let (two, three) = (s.constant(2.0), s.constant(3.0));
    [
        (three * c[3][0]).times_plus(s, two * c[2][0]).times_plus(s, c[1][0]),
        (three * c[3][1]).times_plus(s, two * c[2][1]).times_plus(s, c[1][1]),
    ]
}

/// Velocity off a curve that moves with `v`: `back` is how fast the height swings backwards.
#[inline(always)]
fn off_curve<V: Simd>(v: [Vector<V>; 2], back: Vector<V>, n: [Vector<V>; 2]) -> [Vector<V>; 2] {
    [back.times_plus(n[1], v[0]), v[1] - back * n[0]]
}

/// Adds forces on values and on slopes, as [`Coefficients::add`](crate::shape::Coefficients::add) does.
#[inline(always)]
fn add<V: Simd>(to: &mut Curve<V>, s: Vector<V>, f: [Vector<V>; 2], on_slope: [Vector<V>; 2]) {
    let (square, two, three) = (s * s, s.constant(2.0), s.constant(3.0));
    let (cube, twice, thrice) = (square * s, two * s, three * square);
    for k in 0..2 {
        to[0][k] = to[0][k] + f[k];
        to[1][k] = to[1][k] + f[k].times_plus(s, on_slope[k]);
        to[2][k] = to[2][k] + f[k].times_plus(square, on_slope[k] * twice);
        to[3][k] = to[3][k] + f[k].times_plus(cube, on_slope[k] * thrice);
    }
}

/// Sums over the lanes.
#[inline(always)]
pub(crate) fn totals<V: Simd>(forces: &Curve<V>) -> Poly<4> {
    let mut sums = [[0.0; 2]; 4];
    for k in 0..4 {
        sums[k] = [forces[k][0].sum(), forces[k][1].sum()];
    }
    Poly(sums)
}
