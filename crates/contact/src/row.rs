//! Many points of one chord against one chord at a time, with the sharp penalty law, damping and friction.
//!
//! On chords everything is linear in the place of a point, so that whole vectors of points take the same few operations
//! (PERFORMANCE.md §2). What lies near the end of the other chord, near a corner, or does not touch is left for the loop
//! over single points.

use std::ops::Range;

use pulp::Simd;
use stribeck_solver::{
    lanes::{LANES, Number, Vector},
    state::Moment,
};

use crate::{
    pass::Weights,
    points::Points,
    projection::{Frame, NEAR_END},
    shape::{Push, Shape, Side},
    surface::Surface,
    touch::{Histories, Sum},
};

/// Most points of a facet that are done together.
pub(crate) const MOST_POINTS: usize = 40;

/// The points of one facet of a pass.
pub(crate) struct Row<'a> {
    pub(crate) points: &'a Points,
    pub(crate) range: Range<usize>,
    /// Of all points of the pass: where they were found last, until when they doze, what they remember.
    pub(crate) nearest: &'a [u32],
    pub(crate) doze: &'a [u16],
    pub(crate) now: u16,
    pub(crate) history: &'a mut Histories,
}

/// Two chords and what acts between them, the same for all points.
struct Meeting<V: Simd> {
    /// Point of place 0 relative to the other chord's first node [m], and how it changes to place 1.
    origin: [Vector<V>; 2],
    along: [Vector<V>; 2],
    /// The other chord over its squared length [1/m], and its normal.
    other: [Vector<V>; 2],
    normal: [Vector<V>; 2],
    inverse: Vector<V>,
    /// Velocities at place 0 and their change to place 1 [m/s].
    own_motion: [[Vector<V>; 2]; 2],
    other_motion: [[Vector<V>; 2]; 2],
}

/// Sums over points in contact.
#[derive(Clone, Copy)]
struct Sums<V: Simd> {
    force: [Vector<V>; 2],
    with_own_place: [Vector<V>; 2],
    with_other_place: [Vector<V>; 2],
    stored: Vector<V>,
    friction: Vector<V>,
    damping: Vector<V>,
    penetration: Vector<V>,
}

impl Row<'_> {
    /// Evaluates the points that certainly touch; marks them as done. Returns whether there was one.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // a facet's whole situation
    pub(crate) fn touch<V: Simd, S: Shape>(
        &mut self,
        simd: V,
        own: &mut Side<S>,
        primary: &Surface,
        at: &Moment<'_>,
        w: &Weights,
        deepest: f64,
        done: &mut [bool; MOST_POINTS],
        sum: &mut Sum,
        push: &mut Vec<Push>,
    ) -> bool {
        let Some(chord) = own.shape.chord().copied() else { return false };
        let mut touched = false;
        let mut tried = None;
        for k in 0..self.range.len() {
            let i = self.range.start + k;
            let facet = self.nearest[i] as usize;
            if done[k] || self.doze[i] > self.now || tried == Some(facet) || primary.beside_corner[facet] {
                continue;
            }
            tried = Some(facet);
            let mut other = Side::new(Frame::new(primary, at.x, at.y, facet), primary, at);
            let meeting = Meeting::new(simd, &chord, own, &other);
            let Some(sums) = self.meet(simd, &meeting, k, w, at.dt, deepest, done) else { continue };
            touched = true;
            let force = [sums.force[0].sum(), sums.force[1].sum()];
            own.push_sums(force, [sums.with_own_place[0].sum(), sums.with_own_place[1].sum()]);
            let there = [-sums.with_other_place[0].sum(), -sums.with_other_place[1].sum()];
            other.push_sums([-force[0], -force[1]], there);
            other.flush(primary, push);
            sum.stored += sums.stored.sum();
            sum.friction += sums.friction.sum();
            sum.damping += sums.damping.sum();
            sum.penetration = sum.penetration.max(sums.penetration.largest());
        }
        touched
    }

    /// All points from the `first` on against one chord.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // see above
    fn meet<V: Simd>(
        &mut self,
        simd: V,
        m: &Meeting<V>,
        first: usize,
        w: &Weights,
        dt: f64,
        deepest: f64,
        done: &mut [bool; MOST_POINTS],
    ) -> Option<Sums<V>> {
        let law = &w.law;
        let (zero, one) = (Vector::all(simd, 0.0), Vector::all(simd, 1.0));
        let half_dt = Vector::all(simd, 0.5 * dt);
        let dt = Vector::all(simd, dt);
        let stiffness = Vector::all(simd, law.stiffness * w.thickness);
        let dashpot = Vector::all(simd, law.damping * w.thickness);
        let tangential = Vector::all(simd, law.tangential);
        let ratio = Vector::all(simd, law.friction / law.tangential);
        let half = Vector::all(simd, 0.5);
        let mut sums = Sums {
            force: [zero; 2],
            with_own_place: [zero; 2],
            with_other_place: [zero; 2],
            stored: zero,
            friction: zero,
            damping: zero,
            penetration: zero,
        };
        let mut any = false;
        for start in (first..self.range.len()).step_by(Vector::<V>::LEN) {
            let n = (self.range.len() - start).min(Vector::<V>::LEN);
            let i = self.range.start + start;
            let waiting = {
                let mut flags = [0.0; LANES];
                for l in 0..n {
                    let free = !done[start + l] && self.doze[i + l] <= self.now;
                    flags[l] = if free { 1.0 } else { 0.0 };
                }
                Vector::load(simd, &flags, 0)
            };
            let s = Vector::load_first(simd, n, &self.points.place, i);
            let r = [s.times_plus(m.along[0], m.origin[0]), s.times_plus(m.along[1], m.origin[1])];
            let place = r[0].times_plus(m.other[0], r[1] * m.other[1]);
            let gap = r[0].times_plus(m.normal[0], r[1] * m.normal[1]);
            let depth = -gap;
            // As in `Shape::holds`; only points in contact, whose gap is negative, matter.
            let margin = Vector::all(simd, NEAR_END) * depth * m.inverse;
            let within = margin.choose_below(place, place.choose_below(one - margin, waiting, zero), zero);
            let shallow = depth.choose_below(Vector::all(simd, deepest), within, zero);
            let on = gap.choose_below(zero, shallow, zero);
            let mut flags = [0.0; LANES];
            on.store(&mut flags, 0);
            let mut touches = false;
            for l in 0..n {
                if flags[l] != 0.0 {
                    done[start + l] = true;
                    touches = true;
                }
            }
            if !touches {
                continue;
            }
            any = true;
            let weight = Vector::load_first(simd, n, &self.points.weight, i);
            let [v, u] = [motion(&m.own_motion, s), motion(&m.other_motion, place)];
            let relative = [v[0] - u[0], v[1] - u[1]];
            let opening = relative[0].times_plus(m.normal[0], relative[1] * m.normal[1]);
            let along = relative[1] * m.normal[0] - relative[0] * m.normal[1];
            let k = stiffness * weight;
            let elastic = k * depth;
            let damping = (-(dashpot * weight * opening)).max(-elastic);
            let before = Vector::load_first(simd, n, &self.history.damping, i);
            let damping_heat = -(half_dt * (before + damping) * opening);
            let kt = tangential * k;
            let limit = ratio * depth;
            let slip = Vector::load_first(simd, n, &self.history.slip, i);
            let moved = along * dt;
            let after = (slip + moved).max(-limit).min(limit);
            let (was, is) = (half * kt * slip * slip, half * kt * after * after);
            let friction_heat = half * kt * (slip + after) * moved - (is - was);
            let (normal, shear) = (elastic + damping, -(kt * after));
            let fx = on * (normal * m.normal[0] - shear * m.normal[1]);
            let fy = on * (normal * m.normal[1] + shear * m.normal[0]);
            zero.choose_below(on, damping, before).store_first(n, &mut self.history.damping, i);
            zero.choose_below(on, after, slip).store_first(n, &mut self.history.slip, i);
            sums.force = [sums.force[0] + fx, sums.force[1] + fy];
            let [ox, oy] = sums.with_own_place;
            sums.with_own_place = [fx.times_plus(s, ox), fy.times_plus(s, oy)];
            let [ox, oy] = sums.with_other_place;
            sums.with_other_place = [fx.times_plus(place, ox), fy.times_plus(place, oy)];
            sums.stored = sums.stored + on * (half * elastic * depth + is);
            sums.friction = sums.friction + on * friction_heat;
            sums.damping = sums.damping + on * damping_heat;
            sums.penetration = sums.penetration.max(on * depth);
        }
        any.then_some(sums)
    }
}

impl<V: Simd> Meeting<V> {
    #[inline(always)]
    fn new<S: Shape>(simd: V, chord: &Frame, own: &Side<S>, other: &Side<Frame>) -> Self {
        let to = &other.shape;
        let square = to.inverse * to.inverse;
        Self {
            origin: both(simd, [chord.origin[0] - to.origin[0], chord.origin[1] - to.origin[1]]),
            along: both(simd, chord.along),
            other: both(simd, [to.along[0] * square, to.along[1] * square]),
            normal: both(simd, to.normal),
            inverse: Vector::all(simd, to.inverse),
            own_motion: each(simd, own.linear_motion()),
            other_motion: each(simd, other.linear_motion()),
        }
    }
}

#[inline(always)]
fn both<V: Simd>(simd: V, [x, y]: [f64; 2]) -> [Vector<V>; 2] {
    [Vector::all(simd, x), Vector::all(simd, y)]
}

#[inline(always)]
fn each<V: Simd>(simd: V, [first, change]: [[f64; 2]; 2]) -> [[Vector<V>; 2]; 2] {
    [both(simd, first), both(simd, change)]
}

/// Velocity at a place.
#[inline(always)]
fn motion<V: Simd>([first, change]: &[[Vector<V>; 2]; 2], place: Vector<V>) -> [Vector<V>; 2] {
    [place.times_plus(change[0], first[0]), place.times_plus(change[1], first[1])]
}
