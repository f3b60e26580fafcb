//! The evaluation of a pass: which points are awake, vectors of them first, then what is left over, one by one.

use pulp::{Simd, WithSimd};
use stribeck_solver::{
    lanes::{LANES, Vector},
    state::Moment,
};

use crate::{
    band::{Band, MOST_POINTS},
    pass::{Arrangement, Candidate, Memory, NEVER, PACE_KEPT, Pass, Weights},
    points::Points,
    projection::Frame,
    row::{Outcome, Row},
    shape::{Push, Shape, Side},
    spline::Patch,
    spline_row::Feet,
    surface::Surface,
    touch::{Histories, Sum, touch},
    touch_row::{Law, Work},
};

/// One evaluation, compiled for each instruction set.
pub(crate) struct Evaluation<'a> {
    pub(crate) pass: &'a mut Pass,
    pub(crate) surfaces: &'a [Surface],
    pub(crate) at: &'a Moment<'a>,
    pub(crate) w: &'a Weights,
    pub(crate) push: &'a mut Vec<Push>,
}

impl WithSimd for Evaluation<'_> {
    type Output = Sum;

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) -> Sum {
        // Which curves meet is asked once a pass, and whether points remember; the loop over points is compiled for each.
        let memory = self.pass.memory.history.is_some();
        match [self.pass.secondary, self.pass.primary].map(|s| self.surfaces[s].spline.is_some()) {
            [false, false] if memory => self.evaluate::<V, Frame, Frame, true>(simd),
            [false, false] => self.evaluate::<V, Frame, Frame, false>(simd),
            [true, true] if memory => self.evaluate::<V, Patch, Patch, true>(simd),
            [true, true] => self.evaluate::<V, Patch, Patch, false>(simd),
            [false, true] => self.evaluate::<V, Frame, Patch, true>(simd),
            [true, false] => self.evaluate::<V, Patch, Frame, true>(simd),
        }
    }
}

impl Evaluation<'_> {
    #[inline(always)]
    fn evaluate<V: Simd, S: Shape, P: Shape, const MEMORY: bool>(self, simd: V) -> Sum {
        let Self { pass, surfaces, at, w, push } = self;
        let (secondary, primary) = (&surfaces[pass.secondary], &surfaces[pass.primary]);
        let (deepest, points) = (pass.deepest, &*pass.points);
        let Memory { nearest, searched, doze, pace, candidates, asleep, history } = &mut pass.memory;
        let mut no_history = Histories::default();
        let now = at.step.saturating_sub(*searched) as f64;
        *pace *= PACE_KEPT;
        // Chords against chords and splines against splines, with the law itself: many points at a time.
        let flat = secondary.is_flat() && primary.is_flat();
        let splines = secondary.spline.is_some() && primary.spline.is_some();
        let together = w.together && w.softness == 0.0 && (flat || splines);
        let law = Law::new(simd, w, at.dt, deepest, now, *pace);
        let (mut done, mut feet) = (Work::none(simd), Feet::none());
        let (mut work, mut first_awake) = (0, u64::MAX);
        let mut rest = Rest::<S, P> {
            secondary,
            primary,
            at,
            w,
            points,
            stride: pass.arrangement.stride(),
            deepest,
            searched: *searched,
            now,
            pace: *pace,
            foot: None,
            other: None,
            own: None,
            sum: Sum::default(),
        };
        if let (true, Arrangement::Bands { .. }) = (together, pass.arrangement) {
            for group in candidates.chunks_mut(Vector::<V>::LEN) {
                let wake = group.iter().fold(u64::MAX, |first, c| first.min(c.wake));
                if at.step < wake {
                    first_awake = first_awake.min(wake);
                    continue;
                }
                let outcome = {
                    let history = history.as_mut().unwrap_or(&mut no_history);
                    let band = Band { points, candidates: group, nearest, doze, history };
                    band.touch::<V, MEMORY>(simd, &law, now, primary, at, &mut done, push)
                };
                work += 15 * points.most;
                let force = &mut rest.sum.force;
                *force = [force[0] + outcome.force[0], force[1] + outcome.force[1]];
                let left_over = outcome.left.iter().fold(0, |all, left| all | left);
                let mut soonest = [0.0; LANES];
                outcome.soonest.store(&mut soonest, 0);
                for (l, candidate) in group.iter_mut().enumerate() {
                    if left_over >> l & 1 == 1 {
                        let left = (0..MOST_POINTS).fold(0, |bits, k| bits | (outcome.left[k] >> l & 1) << k);
                        let touched = outcome.touched >> l & 1 == 1;
                        let outcome = Outcome { touched, left, force: [0.0; 2] };
                        rest.finish(simd, candidate, outcome, nearest, doze, history, push);
                    } else {
                        candidate.wake = if outcome.touched >> l & 1 == 1 {
                            0
                        } else {
                            rest.searched.saturating_add(soonest[l] as u64)
                        };
                    }
                    first_awake = first_awake.min(candidate.wake);
                }
            }
        } else {
            for candidate in candidates.iter_mut() {
                if at.step >= candidate.wake {
                    let mut outcome = Outcome::default();
                    if together {
                        let history = history.as_mut().unwrap_or(&mut no_history);
                        let row =
                            Row { candidate, points, nearest, doze, history, secondary, primary, at, now };
                        let (own, law) = (&mut rest.own, &law);
                        outcome = S::touch_row::<V, MEMORY>(simd, row, own, &mut feet, law, &mut done, push);
                        work += if outcome.touched { 20 } else { 10 };
                    } else {
                        let (first, stride) = (candidate.first as usize, rest.stride);
                        let awake = (0..candidate.pattern.points as usize)
                            .filter(|k| doze[first + k * stride] < now + 1.0);
                        outcome.left = awake.fold(0, |bits, k| bits | 1 << k);
                        work += 4;
                    }
                    work += 5 * outcome.left.count_ones() as usize;
                    rest.finish(simd, candidate, outcome, nearest, doze, history, push);
                }
                first_awake = first_awake.min(candidate.wake);
            }
        }
        rest.flush(push);
        feet.flush(primary, push);
        let mut sum = rest.sum;
        done.add_to(&mut sum);
        *pace = rest.pace.max(done.pace());
        *asleep = first_awake;
        pass.work = work;
        sum
    }
}

/// What vectors of points leave over: points one by one, on curves, near ends and corners; and what a facet comes to.
struct Rest<'a, S: Shape, P: Shape> {
    secondary: &'a Surface,
    primary: &'a Surface,
    at: &'a Moment<'a>,
    w: &'a Weights,
    points: &'a Points,
    /// Distance of a facet's points in memory.
    stride: usize,
    deepest: f64,
    /// See [`Memory`].
    searched: u64,
    pace: f64,
    /// Steps since the search.
    now: f64,
    /// The facet at hand in motion, where it was needed.
    own: Option<Side<S>>,
    /// Facet of the primary surface where the last point was found.
    foot: Option<P>,
    /// Consecutive points mostly share a primary facet: its forces wait until another one comes.
    other: Option<Side<P>>,
    sum: Sum,
}

impl<S: Shape, P: Shape> Rest<'_, S, P> {
    /// Finishes a facet: evaluates the points that are left over, hands forces over and lets it sleep if it may.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // what a pass remembers, field by field
    fn finish<V: Simd>(
        &mut self,
        simd: V,
        candidate: &mut Candidate,
        mut outcome: Outcome,
        nearest: &mut [u32],
        doze: &mut [f64],
        history: &mut Option<Histories>,
        push: &mut Vec<Push>,
    ) {
        if outcome.left != 0 {
            self.touch(candidate, &mut outcome, nearest, doze, history, push);
        }
        let force = &mut self.sum.force;
        if let Some(own) = self.own.take() {
            own.flush(self.secondary, push);
            *force = [force[0] + own.force[0], force[1] + own.force[1]];
        }
        *force = [force[0] + outcome.force[0], force[1] + outcome.force[1]];
        candidate.wake = 0;
        if !outcome.touched && self.stride > 1 {
            let points = doze[candidate.first as usize..].iter().step_by(self.stride);
            let soonest =
                points.take(candidate.pattern.points as usize).copied().fold(f64::INFINITY, f64::min);
            candidate.wake = self.searched.saturating_add(soonest as u64);
        } else if !outcome.touched {
            let range = candidate.range();
            let mut soonest = Vector::all(simd, f64::INFINITY);
            let whole = range.len() / Vector::<V>::LEN * Vector::<V>::LEN;
            for start in (0..whole).step_by(Vector::<V>::LEN) {
                soonest = soonest.min(Vector::load(simd, doze, range.start + start));
            }
            let rest = doze[range.start + whole..range.end].iter().copied();
            candidate.wake = self.searched.saturating_add(rest.fold(soonest.smallest(), f64::min) as u64);
        }
    }

    /// Evaluates points one by one.
    #[inline(never)]
    fn touch(
        &mut self,
        candidate: &Candidate,
        outcome: &mut Outcome,
        nearest: &mut [u32],
        doze: &mut [f64],
        history: &mut Option<Histories>,
        push: &mut Vec<Push>,
    ) {
        let Self { secondary, primary, at, w, points, .. } = *self;
        let side = || Side::new(S::new(secondary, at.x, at.y, candidate.facet as usize), secondary, at);
        let own = self.own.get_or_insert_with(side);
        let sum = &mut self.sum;
        let mut left = outcome.left;
        while left != 0 {
            let k = left.trailing_zeros();
            let (i, of_pattern) =
                (candidate.first as usize + k as usize * self.stride, (candidate.pattern.first + k) as usize);
            left &= left - 1;
            let spot = own.shape.spot(points.place[of_pattern], points.height[of_pattern]);
            let area = points.weight[of_pattern] * w.thickness;
            let start = nearest[i] as usize;
            let foot = match &mut self.foot {
                Some(foot) if foot.facet() == start => foot,
                foot => foot.insert(P::new(primary, at.x, at.y, start)),
            };
            let found = foot.project(primary, at.x, at.y, spot.at);
            let foot = *foot;
            nearest[i] = foot.facet() as u32;
            let Some(to) = found.filter(|f| f.gap < w.reach() && f.gap > -self.deepest) else {
                // Points off both ends of an open surface have no foot; the next search wakes them.
                let slide = found.map(|to| Side::new(foot, primary, at).slide(own.velocity(&spot), &to));
                doze[i] = NEVER;
                if let (Some(to), Some(slide)) = (found, slide) {
                    self.pace = self.pace.max(slide.opening.abs());
                    doze[i] = self.now + w.steps_apart(to.gap, slide.along, self.pace, at.dt);
                }
                if let Some(history) = history.as_mut().filter(|h| !h.get(i).is_empty()) {
                    outcome.touched = true;
                    let mut past = history.get(i);
                    past.release(area, &w.law, at.dt, slide.unwrap_or_default(), sum);
                    history.set(i, past);
                }
                continue;
            };
            outcome.touched = true;
            let other = match &mut self.other {
                Some(side) if side.shape.facet() == to.facet => side,
                last => {
                    if let Some(side) = last {
                        side.flush(primary, push);
                    }
                    last.insert(Side::new(foot, primary, at))
                }
            };
            let [pressure, shear] = if w.softness > 0.0 {
                [w.law.stiffness * area * w.rounded(to.gap)[0], 0.0]
            } else {
                let slide = other.slide(own.velocity(&spot), &to);
                self.pace = self.pace.max(slide.opening.abs());
                match history {
                    Some(history) => {
                        let mut past = history.get(i);
                        let push = touch(to.gap, area, &w.law, at.dt, slide, &mut past, sum);
                        history.set(i, past);
                        push
                    }
                    None => {
                        let [depth, _, work] = w.law.depth(to.gap);
                        sum.stored += w.law.stiffness * area * work;
                        sum.penetration = sum.penetration.max(depth);
                        [w.law.stiffness * area * depth, 0.0]
                    }
                }
            };
            let [nx, ny] = to.normal;
            let f = [pressure * nx - shear * ny, pressure * ny + shear * nx];
            own.push_point(&spot, f);
            other.push_foot(&to, f, pressure, shear);
        }
    }

    fn flush(&self, push: &mut Vec<Push>) {
        if let Some(side) = &self.other {
            side.flush(self.primary, push);
        }
    }
}
