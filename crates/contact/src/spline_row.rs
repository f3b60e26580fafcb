//! Many points of one facet of a spline against facets of another spline at a time.
//!
//! The points of a facet mostly have their feet on one or two facets of the other surface, already known from the step
//! before. Every lane takes the coefficients of its own; two of Newton's corrections from the foot on the chord find the
//! foot on the curve. Lanes that this does not bring to rest, or brings beyond the facet's ends, are left for the loop
//! over single points.

use pulp::Simd;
use stribeck_solver::{
    lanes::{LANES, Number, Vector},
    state::Moment,
};

use crate::{
    pass::Weights,
    row::{Against, MOST_POINTS, Row, mark},
    shape::{Poly, Push, Shape, Side},
    spline::{JOINT, Patch},
    surface::Surface,
    touch::Sum,
    touch_row::{Law, Touching, Work},
};

/// A foot is found when the last correction is below this: what is left is a tenth of its square (`spline.rs`).
const SMALL: f64 = 1e-6;

/// Values of a curve's polynomial in all lanes.
type Curve<V> = [[Vector<V>; 2]; 4];

/// One or two facets of the primary surface that points have their feet on, kept from one facet of points to the next:
/// what acts on them is handed to the nodes when others come.
pub(crate) struct Feet<V: Simd> {
    facets: [Option<Met<V>>; 2],
    law: Law<V>,
    work: Work<V>,
}

/// A facet of the primary surface and the forces on it, lane by lane.
#[derive(Clone, Copy)]
struct Met<V: Simd> {
    side: Side<Patch>,
    forces: Curve<V>,
}

/// A facet's coefficients, each lane its own.
struct Lanes<V: Simd> {
    curve: Curve<V>,
    motion: Curve<V>,
    height: [Vector<V>; 4],
    /// Chord over its squared length [1/m].
    chord: [Vector<V>; 2],
}

impl<V: Simd> Feet<V> {
    #[inline(always)]
    pub(crate) fn new(simd: V, w: &Weights, dt: f64) -> Self {
        Self { facets: [None; 2], law: Law::new(simd, w, dt), work: Work::none(simd) }
    }

    /// Makes facet `wanted` one of the two, in the place of one that is not `kept`; returns its place.
    #[inline(always)]
    fn take(
        &mut self,
        simd: V,
        wanted: usize,
        kept: usize,
        primary: &Surface,
        at: &Moment<'_>,
        push: &mut Vec<Push>,
    ) -> usize {
        let facet = |met: &Option<Met<V>>| met.as_ref().map(|met| met.side.shape.facet());
        if let Some(place) = self.facets.iter().position(|met| facet(met) == Some(wanted)) {
            return place;
        }
        let place = usize::from(facet(&self.facets[0]) == Some(kept));
        if let Some(met) = &mut self.facets[place] {
            met.flush(primary, push);
        }
        let side = Side::new(Patch::new(primary, at.x, at.y, wanted), primary, at);
        self.facets[place] = Some(Met { side, forces: [[Vector::all(simd, 0.0); 2]; 4] });
        place
    }

    /// Hands all forces over to the nodes, and the sums to the pass.
    #[inline(always)]
    pub(crate) fn flush(&mut self, primary: &Surface, sum: &mut Sum, push: &mut Vec<Push>) {
        if self.facets.iter().any(Option::is_some) {
            self.work.add_to(sum);
        }
        for met in self.facets.iter_mut().flatten() {
            met.flush(primary, push);
        }
    }
}

impl<V: Simd> Met<V> {
    #[inline(always)]
    fn flush(&mut self, primary: &Surface, push: &mut Vec<Push>) {
        self.side.push_all(&totals(&self.forces));
        self.side.flush(primary, push);
    }
}

impl Row<'_> {
    /// Evaluates the points whose feet lie within the facet known for the first of them and the next one that differs;
    /// marks those that touch as done and lets the others doze. Returns whether one touches.
    #[inline(always)]
    pub(crate) fn touch_splines<V: Simd>(
        &mut self,
        simd: V,
        own: &mut Side<Patch>,
        feet: &mut Feet<V>,
        done: &mut [bool; MOST_POINTS],
        push: &mut Vec<Push>,
    ) -> bool {
        let Against { primary, at, w, deepest } = self.against;
        let waits =
            |i: &usize| self.doze[*i] <= self.now && !primary.beside_corner[self.nearest[*i] as usize];
        let mut facets = self.range.clone().filter(waits).map(|i| self.nearest[i] as usize);
        let Some(a) = facets.next() else { return false };
        let b = facets.find(|&facet| facet != a).unwrap_or(a);
        let places = [feet.take(simd, a, b, primary, at, push), feet.take(simd, b, a, primary, at, push)];
        let [Some(near), Some(far)] = places.map(|place| feet.facets[place].as_ref()) else { return false };
        let (near, far) = (Lanes::of(simd, &near.side), Lanes::of(simd, &far.side));
        let line = Lanes::of(simd, own);
        let (zero, one) = (Vector::all(simd, 0.0), Vector::all(simd, 1.0));
        let (reach, deepest) = (Vector::all(simd, w.reach()), Vector::all(simd, deepest));
        let (joint, small) = (Vector::all(simd, JOINT), Vector::all(simd, SMALL));
        let closing = w.fastest * at.dt;
        let mut forces = [[zero; 2]; 4];
        let mut touched = false;
        for start in (0..self.range.len()).step_by(Vector::<V>::LEN) {
            let n = (self.range.len() - start).min(Vector::<V>::LEN);
            let i = self.range.start + start;
            let (mut waiting, mut first) = ([0.0; LANES], [0.0; LANES]);
            for l in 0..n {
                let facet = self.nearest[i + l] as usize;
                first[l] = f64::from(u8::from(facet == a));
                waiting[l] = f64::from(u8::from(self.doze[i + l] <= self.now && (facet == a || facet == b)));
            }
            let (waiting, first) = (Vector::load(simd, &waiting, 0), Vector::load(simd, &first, 0));
            let to = Lanes::chosen(first, &near, &far);

            let s = Vector::load(simd, &self.points.place, i);
            let height = Vector::load(simd, &self.points.height, i);
            let (c, d) = (value(&line.curve, s), slope(&line.curve, s));
            let inverse = one / dot(d, d).square_root();
            let normal = [d[1] * inverse, -(d[0] * inverse)];
            let p = [height.times_plus(normal[0], c[0]), height.times_plus(normal[1], c[1])];

            let foot = to.foot(p);
            let held = foot.place.choose_below(one + joint, waiting, zero);
            let held = (-joint).choose_below(foot.place, held, zero);
            let held = foot.rest.choose_below(small, held, zero);
            let on = foot.gap.choose_below(reach, held, zero);
            let on = (-foot.gap).choose_below(deepest, on, zero);
            self.let_doze(held - on, foot.gap - reach, closing, i, n);
            if !mark(on, n, &mut done[start..]) {
                continue;
            }
            touched = true;

            let weight = Vector::load(simd, &self.points.weight, i);
            let (v, swing) = (value(&line.motion, s), dot(normal, slope(&line.motion, s)));
            let v = off_curve(v, swing * height * inverse, normal);
            let (u, swing) =
                (value(&to.motion, foot.place), dot(foot.curve_normal, slope(&to.motion, foot.place)));
            let opening = dot(foot.normal, [v[0] - u[0], v[1] - u[1]]) - foot.turn * swing;
            let u = off_curve(u, swing * foot.height * foot.inverse, foot.curve_normal);
            let along = foot.normal[0] * (v[1] - u[1]) - foot.normal[1] * (v[0] - u[0]);
            let points = Touching { first: i, on, gap: foot.gap, weight, opening, along };
            let [pressure, shear] = feet.law.act(&points, self.history, &mut feet.work);

            let f = [
                pressure * foot.normal[0] - shear * foot.normal[1],
                pressure * foot.normal[1] + shear * foot.normal[0],
            ];
            let f = pick(on, f, [zero; 2]);
            let lever = height * inverse * (f[0] * normal[1] - f[1] * normal[0]);
            add(&mut forces, s, f, [lever * normal[0], lever * normal[1]]);
            let lever = foot.height * foot.inverse * shear * dot(foot.normal, foot.curve_normal)
                - foot.turn * pressure;
            let lever = zero.choose_below(on, lever, zero);
            let mut there = [[zero; 2]; 4];
            let on_slope = [lever * foot.curve_normal[0], lever * foot.curve_normal[1]];
            add(&mut there, foot.place, [-f[0], -f[1]], on_slope);
            for (place, lanes) in [(places[0], first), (places[1], one - first)] {
                let Some(met) = &mut feet.facets[place] else { continue };
                for (sum, part) in met.forces.iter_mut().zip(&there) {
                    for k in 0..2 {
                        sum[k] = sum[k] + zero.choose_below(lanes, part[k], zero);
                    }
                }
            }
        }
        if touched {
            own.push_all(&totals(&forces));
        }
        touched
    }

    /// Points that are apart need not be looked at before they may have come near; those that remember something settle
    /// it one by one.
    #[inline(always)]
    fn let_doze<V: Simd>(&mut self, apart: Vector<V>, gap: Vector<V>, closing: f64, i: usize, n: usize) {
        let (mut flags, mut gaps) = ([0.0; LANES], [0.0; LANES]);
        apart.store(&mut flags, 0);
        gap.store(&mut gaps, 0);
        for l in 0..n {
            if flags[l] != 0.0 && gaps[l] >= 0.0 && self.history.get(i + l).is_none_or(|h| h.is_empty()) {
                self.doze[i + l] = self.now.saturating_add((gaps[l] / closing) as u16);
            }
        }
    }
}

/// Feet of points, as in [`Projection`](crate::Projection), and the last correction of their places.
struct Foot<V: Simd> {
    gap: Vector<V>,
    normal: [Vector<V>; 2],
    place: Vector<V>,
    turn: Vector<V>,
    height: Vector<V>,
    curve_normal: [Vector<V>; 2],
    inverse: Vector<V>,
    rest: Vector<V>,
}

impl<V: Simd> Lanes<V> {
    /// The same facet in all lanes.
    #[inline(always)]
    fn of(simd: V, side: &Side<Patch>) -> Self {
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
    fn chosen(lanes: Vector<V>, yes: &Self, no: &Self) -> Self {
        let (mut curve, mut motion, mut height) = (yes.curve, yes.motion, yes.height);
        for k in 0..4 {
            curve[k] = pick(lanes, yes.curve[k], no.curve[k]);
            motion[k] = pick(lanes, yes.motion[k], no.motion[k]);
            height[k] = lanes.constant(0.0).choose_below(lanes, yes.height[k], no.height[k]);
        }
        Self { curve, motion, height, chord: pick(lanes, yes.chord, no.chord) }
    }

    /// From points of the curve to `p`, and the first and second derivatives there.
    #[inline(always)]
    fn seen_from(&self, p: [Vector<V>; 2], s: Vector<V>) -> ([Vector<V>; 2], [Vector<V>; 2], [Vector<V>; 2]) {
        let (c, at) = (&self.curve, value(&self.curve, s));
        let (two, steep) = (s.constant(2.0), s.constant(3.0) * s);
        let bend = [two * steep.times_plus(c[3][0], c[2][0]), two * steep.times_plus(c[3][1], c[2][1])];
        ([p[0] - at[0], p[1] - at[1]], slope(c, s), bend)
    }

    /// Feet of the points `p`, as `Patch::above` finds them.
    #[inline(always)]
    fn foot(&self, p: [Vector<V>; 2]) -> Foot<V> {
        let (zero, half, one) = (p[0].constant(0.0), p[0].constant(0.5), p[0].constant(1.0));
        let (low, high) = (p[0].constant(-2.0), p[0].constant(3.0));
        let start = [p[0] - self.curve[0][0], p[1] - self.curve[0][1]];
        let mut s = dot(start, self.chord).max(low).min(high);
        let mut rest = zero;
        for _ in 0..2 {
            let (r, d, dd) = self.seen_from(p, s);
            let square = dot(d, d);
            rest = dot(r, d) / (square - dot(r, dd).min(half * square));
            s = (s + rest).max(low).min(high);
        }
        let (r, d, dd) = self.seen_from(p, s);
        let square = dot(d, d);
        let inverse = one / square.square_root();
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
            rest: rest.max(-rest),
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
fn pick<V: Simd>(lanes: Vector<V>, yes: [Vector<V>; 2], no: [Vector<V>; 2]) -> [Vector<V>; 2] {
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
fn totals<V: Simd>(forces: &Curve<V>) -> Poly<4> {
    let mut sums = [[0.0; 2]; 4];
    for k in 0..4 {
        sums[k] = [forces[k][0].sum(), forces[k][1].sum()];
    }
    Poly(sums)
}
