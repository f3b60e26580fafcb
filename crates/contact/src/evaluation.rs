//! The evaluation of a pass: which points are awake, vectors of them first, then what is left over, one by one.

use pulp::{Simd, WithSimd};
use stribeck_solver::{
    lanes::{LANES, Vector},
    state::Moment,
};

use crate::{
    band::{self, Band},
    pass::{Memory, NEVER, PACE_KEPT, Pass, Weights},
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
        let memory = !self.pass.memory.history.is_empty();
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
        let (deepest, points) = (pass.deepest, &pass.points);
        let Memory { nearest, searched, doze, pace, candidates, asleep, history } = &mut pass.memory;
        let now = at.step.saturating_sub(*searched) as f64;
        *pace *= PACE_KEPT;
        // Chords against chords and splines against splines, with the law itself: many points at a time.
        let flat = secondary.is_flat() && primary.is_flat();
        let splines = secondary.spline.is_some() && primary.spline.is_some();
        let together = w.together && w.softness == 0.0 && (flat || splines);
        let lanes = if together && flat && points.most <= band::MOST_POINTS { Vector::<V>::LEN } else { 1 };
        let law = Law::new(simd, w, at.dt, deepest, now, *pace);
        let (mut done, mut feet) = (Work::none(simd), Feet::none());
        let (mut sum, mut work, mut first_awake) = (Sum::default(), 0, u64::MAX);
        let mut singles =
            Singles::<P> { primary, at, w, points, deepest, now, pace: *pace, foot: None, other: None };
        for group in candidates.chunks_mut(lanes) {
            let awake = group.iter().rev().fold(0_u64, |bits, c| bits << 1 | u64::from(at.step >= c.wake));
            if awake == 0 {
                group.iter().for_each(|c| first_awake = first_awake.min(c.wake));
                continue;
            }
            let mut outcomes = [Outcome::default(); LANES];
            let mut own = None;
            let facet = group[0].facet as usize;
            if lanes > 1 {
                let mut facets = [facet; LANES];
                facets.iter_mut().zip(group.iter()).for_each(|(f, c)| *f = c.facet as usize);
                let band = Band { secondary, points, facets, awake, nearest, doze, history };
                outcomes = band.touch::<V, MEMORY>(simd, &law, now, primary, at, &mut done, push);
                work += 15 * points.most;
            } else if together {
                let range = points.of_facet(facet);
                let row = Row { points, range, nearest, doze, history, secondary, primary, at, now };
                outcomes[0] =
                    S::touch_row::<V, MEMORY>(simd, row, facet, &mut own, &mut feet, &law, &mut done, push);
                work += if outcomes[0].touched { 20 } else { 10 };
            } else {
                let awake = points.of_facet(facet).enumerate().filter(|(_, i)| doze[*i] < now + 1.0);
                outcomes[0].left = awake.fold(0, |bits, (k, _)| bits | 1 << k);
                work += 4;
            }
            for (l, candidate) in group.iter_mut().enumerate() {
                let outcome = &mut outcomes[l];
                if awake >> l & 1 == 1 {
                    let facet = candidate.facet as usize;
                    if outcome.left != 0 {
                        work += 5 * outcome.left.count_ones() as usize;
                        let side = || Side::new(S::new(secondary, at.x, at.y, facet), secondary, at);
                        let own = own.get_or_insert_with(side);
                        singles.touch(own, outcome, nearest, doze, history, &mut sum, push);
                    }
                    if let Some(own) = own.take() {
                        own.flush(secondary, push);
                        sum.force = [sum.force[0] + own.force[0], sum.force[1] + own.force[1]];
                    }
                    sum.force = [sum.force[0] + outcome.force[0], sum.force[1] + outcome.force[1]];
                    candidate.wake = if outcome.touched {
                        0
                    } else {
                        let soonest =
                            doze[points.of_facet(facet)].iter().copied().fold(f64::INFINITY, f64::min);
                        searched.saturating_add(soonest as u64)
                    };
                }
                first_awake = first_awake.min(candidate.wake);
            }
        }
        singles.flush(push);
        feet.flush(primary, push);
        done.add_to(&mut sum);
        *pace = singles.pace.max(done.pace());
        *asleep = first_awake;
        pass.work = work;
        sum
    }
}

/// Points one by one: those on curves, near ends and corners, and those that do not touch and may doze.
struct Singles<'a, P: Shape> {
    primary: &'a Surface,
    at: &'a Moment<'a>,
    w: &'a Weights,
    points: &'a Points,
    deepest: f64,
    now: f64,
    /// See [`Memory`].
    pace: f64,
    /// Facet of the primary surface where the last point was found.
    foot: Option<P>,
    /// Consecutive points mostly share a primary facet: its forces wait until another one comes.
    other: Option<Side<P>>,
}

impl<P: Shape> Singles<'_, P> {
    /// Evaluates what is left over of a facet.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // what a pass remembers, field by field
    fn touch<S: Shape>(
        &mut self,
        own: &mut Side<S>,
        outcome: &mut Outcome,
        nearest: &mut [u32],
        doze: &mut [f64],
        history: &mut Histories,
        sum: &mut Sum,
        push: &mut Vec<Push>,
    ) {
        let Self { primary, at, w, points, .. } = *self;
        let first = points.of_facet(own.shape.facet()).start;
        let mut left = outcome.left;
        while left != 0 {
            let i = first + left.trailing_zeros() as usize;
            left &= left - 1;
            let spot = own.shape.spot(points.place[i], points.height[i]);
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
                if let Some(mut past) = history.get(i).filter(|h| !h.is_empty()) {
                    outcome.touched = true;
                    let area = points.weight[i] * w.thickness;
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
            let area = points.weight[i] * w.thickness;
            let [pressure, shear] = if w.softness > 0.0 {
                [w.law.stiffness * area * w.rounded(to.gap)[0], 0.0]
            } else {
                let slide = other.slide(own.velocity(&spot), &to);
                self.pace = self.pace.max(slide.opening.abs());
                match history.get(i) {
                    Some(mut past) => {
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
