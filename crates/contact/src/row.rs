//! Many points of one chord against one chord at a time, with damping and friction.
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
    shape::{Poly, Push, Shape, Side},
    surface::Surface,
    touch::{Histories, Sum},
    touch_row::{Law, Touching, Work},
};

/// Most points of a facet that are done together.
pub(crate) const MOST_POINTS: usize = 40;

/// The points of one facet of a pass.
pub(crate) struct Row<'a> {
    pub(crate) points: &'a Points,
    pub(crate) range: Range<usize>,
    /// Of all points of the pass: where they were found last, until when they doze, what they remember.
    pub(crate) nearest: &'a [u32],
    pub(crate) doze: &'a mut [u16],
    pub(crate) now: u16,
    pub(crate) history: &'a mut Histories,
    pub(crate) against: Against<'a>,
}

/// What a pass's points meet, and when.
#[derive(Clone, Copy)]
pub(crate) struct Against<'a> {
    pub(crate) primary: &'a Surface,
    pub(crate) at: &'a Moment<'a>,
    pub(crate) w: &'a Weights,
    /// Deeper penetrations than this are not contacts [m].
    pub(crate) deepest: f64,
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
    work: Work<V>,
}

impl Row<'_> {
    /// Evaluates the points that certainly touch; marks them as done. Returns whether there was one.
    #[inline(always)]
    pub(crate) fn touch<V: Simd>(
        &mut self,
        simd: V,
        own: &mut Side<Frame>,
        done: &mut [bool; MOST_POINTS],
        sum: &mut Sum,
        push: &mut Vec<Push>,
    ) -> bool {
        let Against { primary, at, .. } = self.against;
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
            let meeting = Meeting::new(simd, own, &other);
            let Some(sums) = self.meet(simd, &meeting, k, done) else { continue };
            touched = true;
            own.push_all(&Poly([total(sums.force), total(sums.with_own_place)]));
            let Poly(there) = Poly([total(sums.force), total(sums.with_other_place)]);
            other.push_all(&Poly(there.map(|[x, y]| [-x, -y])));
            other.flush(primary, push);
            sums.work.add_to(sum);
        }
        touched
    }

    /// All points from the `first` on against one chord.
    #[inline(always)]
    fn meet<V: Simd>(
        &mut self,
        simd: V,
        m: &Meeting<V>,
        first: usize,
        done: &mut [bool; MOST_POINTS],
    ) -> Option<Sums<V>> {
        let Against { at, w, deepest, .. } = self.against;
        let law = Law::new(simd, w, at.dt);
        let (zero, one, reach) =
            (Vector::all(simd, 0.0), Vector::all(simd, 1.0), Vector::all(simd, w.law.onset));
        let mut sums = Sums {
            force: [zero; 2],
            with_own_place: [zero; 2],
            with_other_place: [zero; 2],
            work: Work::none(simd),
        };
        let mut any = false;
        for start in (first..self.range.len()).step_by(Vector::<V>::LEN) {
            let n = (self.range.len() - start).min(Vector::<V>::LEN);
            let i = self.range.start + start;
            let waiting = self.waiting(simd, start, n, done);
            let s = Vector::load(simd, &self.points.place, i);
            let r = [s.times_plus(m.along[0], m.origin[0]), s.times_plus(m.along[1], m.origin[1])];
            let place = r[0].times_plus(m.other[0], r[1] * m.other[1]);
            let gap = r[0].times_plus(m.normal[0], r[1] * m.normal[1]);
            let depth = -gap;
            // As in `Shape::holds`.
            let margin = Vector::all(simd, NEAR_END) * depth.max(gap) * m.inverse;
            let within = margin.choose_below(place, place.choose_below(one - margin, waiting, zero), zero);
            let shallow = depth.choose_below(Vector::all(simd, deepest), within, zero);
            let on = gap.choose_below(reach, shallow, zero);
            if !mark(on, n, &mut done[start..]) {
                continue;
            }
            any = true;
            let weight = Vector::load(simd, &self.points.weight, i);
            let [v, u] = [motion(&m.own_motion, s), motion(&m.other_motion, place)];
            let relative = [v[0] - u[0], v[1] - u[1]];
            let opening = relative[0].times_plus(m.normal[0], relative[1] * m.normal[1]);
            let along = relative[1] * m.normal[0] - relative[0] * m.normal[1];
            let points = Touching { first: i, on, gap, weight, opening, along };
            let [normal, shear] = law.act(&points, self.history, &mut sums.work);
            let fx = on * (normal * m.normal[0] - shear * m.normal[1]);
            let fy = on * (normal * m.normal[1] + shear * m.normal[0]);
            sums.force = [sums.force[0] + fx, sums.force[1] + fy];
            let [ox, oy] = sums.with_own_place;
            sums.with_own_place = [fx.times_plus(s, ox), fy.times_plus(s, oy)];
            let [ox, oy] = sums.with_other_place;
            sums.with_other_place = [fx.times_plus(place, ox), fy.times_plus(place, oy)];
        }
        any.then_some(sums)
    }

    /// One where one of `n` points from the `start`-th on may touch and is not done.
    #[inline(always)]
    pub(crate) fn waiting<V: Simd>(
        &self,
        simd: V,
        start: usize,
        n: usize,
        done: &[bool; MOST_POINTS],
    ) -> Vector<V> {
        let mut flags = [0.0; LANES];
        for l in 0..n {
            let free = !done[start + l] && self.doze[self.range.start + start + l] <= self.now;
            flags[l] = if free { 1.0 } else { 0.0 };
        }
        Vector::load(simd, &flags, 0)
    }
}

/// Marks those of `n` points that are on; whether there is one.
#[inline(always)]
pub(crate) fn mark<V: Simd>(on: Vector<V>, n: usize, done: &mut [bool]) -> bool {
    let mut flags = [0.0; LANES];
    on.store(&mut flags, 0);
    let mut any = false;
    for l in 0..n {
        if flags[l] != 0.0 {
            done[l] = true;
            any = true;
        }
    }
    any
}

impl<V: Simd> Meeting<V> {
    #[inline(always)]
    fn new(simd: V, own: &Side<Frame>, other: &Side<Frame>) -> Self {
        let (chord, to) = (&own.shape, &other.shape);
        let square = to.inverse * to.inverse;
        Self {
            origin: both(simd, [chord.origin[0] - to.origin[0], chord.origin[1] - to.origin[1]]),
            along: both(simd, chord.along),
            other: both(simd, [to.along[0] * square, to.along[1] * square]),
            normal: both(simd, to.normal),
            inverse: Vector::all(simd, to.inverse),
            own_motion: each(simd, own),
            other_motion: each(simd, other),
        }
    }
}

#[inline(always)]
fn both<V: Simd>(simd: V, [x, y]: [f64; 2]) -> [Vector<V>; 2] {
    [Vector::all(simd, x), Vector::all(simd, y)]
}

/// Velocities of the first node and how they change to the second.
#[inline(always)]
fn each<V: Simd>(simd: V, side: &Side<Frame>) -> [[Vector<V>; 2]; 2] {
    let Poly(motion) = side.coefficients_of_motion();
    motion.map(|v| both(simd, v))
}

#[inline(always)]
fn total<V: Simd>(force: [Vector<V>; 2]) -> [f64; 2] {
    [force[0].sum(), force[1].sum()]
}

/// Velocity at a place.
#[inline(always)]
fn motion<V: Simd>([first, change]: &[[Vector<V>; 2]; 2], place: Vector<V>) -> [Vector<V>; 2] {
    [place.times_plus(change[0], first[0]), place.times_plus(change[1], first[1])]
}
