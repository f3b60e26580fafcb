//! The evaluation of a pass: which points are awake, vectors of them first, then what is left over, one by one.

use pulp::{Arch, Simd, WithSimd};
use stribeck_simd::lanes::{LANES, Vector};
use stribeck_solver::state::Moment;

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
    /// Evaluates in the widest vectors that this processor has.
    pub(crate) fn dispatch(self) -> Sum {
        #[cfg(test)]
        if let Some(lanes) = tests::LANES_ASKED.get() {
            return tests::in_lanes(self, lanes);
        }
        Arch::new().dispatch(self)
    }

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
        if outcome.touched {
            return;
        }
        let (first, points) = (candidate.first as usize, candidate.pattern.points as usize);
        let mut soonest = f64::INFINITY;
        let mut done = 0;
        if self.stride == 1 {
            let mut of_lanes = Vector::all(simd, soonest);
            while done + Vector::<V>::LEN <= points {
                of_lanes = of_lanes.min(Vector::load(simd, doze, first + done));
                done += Vector::<V>::LEN;
            }
            soonest = of_lanes.smallest();
        }
        for k in done..points {
            soonest = soonest.min(doze[first + k * self.stride]);
        }
        candidate.wake = self.searched.saturating_add(soonest as u64);
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

#[cfg(test)]
mod tests {
    use std::{cell::Cell, f64::consts::TAU};

    use pulp::Scalar;
    use stribeck_solver::{Force, state::NodeForces};

    use super::*;
    use crate::{Contacts, Law, Method, PairSpec, Sides, Surface};

    thread_local! {
        /// Lanes that evaluations on this thread use; `None` for the widest.
        pub(super) static LANES_ASKED: Cell<Option<usize>> = const { Cell::new(None) };
    }

    pub(super) fn in_lanes(evaluation: Evaluation<'_>, lanes: usize) -> Sum {
        #[cfg(target_arch = "x86_64")]
        match (lanes, pulp::x86::V3::try_new(), pulp::x86::V4::try_new()) {
            (4, Some(avx2), _) => return Simd::vectorize(avx2, evaluation),
            (8, _, Some(avx512)) => return Simd::vectorize(avx512, evaluation),
            _ => {}
        }
        evaluation.with_simd(Scalar)
    }

    /// A polygon that turns and bounces in an open trough of a slightly larger radius, in slots of either order.
    struct Trough {
        wheel: Vec<u32>,
        trough: Vec<u32>,
    }

    impl Trough {
        fn new(corners: u32, vertices: u32, backwards: bool) -> Self {
            let last = corners + vertices - 1;
            let slot = |n: u32| if backwards { last - n } else { n };
            Self {
                wheel: (0..corners).map(slot).collect(),
                trough: (corners..corners + vertices).map(slot).collect(),
            }
        }

        /// Positions at a time [s].
        fn at(&self, t: f64) -> [Vec<f64>; 2] {
            let [mut x, mut y] = [(); 2].map(|()| vec![0.0; self.wheel.len() + self.trough.len()]);
            for (k, &slot) in self.wheel.iter().enumerate() {
                let (s, c) = (TAU * k as f64 / self.wheel.len() as f64 + 1.3 * t).sin_cos();
                x[slot as usize] = c + 0.02 * (5.0 * t).sin();
                y[slot as usize] = s - 0.055 + 0.02 * (31.0 * t).sin();
            }
            for (k, &slot) in self.trough.iter().enumerate() {
                // The solid lies on the left of who walks along.
                let (s, c) = (-0.2 - 2.7 * k as f64 / (self.trough.len() - 1) as f64).sin_cos();
                (x[slot as usize], y[slot as usize]) = (1.05 * c, 1.05 * s);
            }
            [x, y]
        }

        fn contacts(&self, points: usize) -> Contacts {
            let law = Law::penalty(1e6).and_then(|law| law.with_friction(0.2));
            let law = law.and_then(|law| law.with_damping(0.1, 1.0)).expect("a possible law");
            let [x, y] = self.at(0.0);
            let surface =
                |slots: &[u32], closed| Surface::new("", slots.to_vec(), closed, &x, &y).expect("a polyline");
            let surfaces = vec![surface(&self.wheel, true), surface(&self.trough, false)];
            let method = Method::Integrated { points };
            let pair = PairSpec { first: 0, second: 1, law, method, sides: Sides::Both };
            Contacts::new(surfaces, &[pair], 0.02, &x, &y).expect("a possible pair")
        }
    }

    #[test]
    fn invariant_points_act_alike_in_lanes_and_one_by_one() {
        let (dt, steps) = (2e-4, 600);
        for (corners, vertices, backwards) in [(40, 23, false), (37, 30, true), (12, 40, false)] {
            let scene = Trough::new(corners, vertices, backwards);
            for points in [1, 2, 3, 4, 7] {
                let mut singly = scene.contacts(points);
                singly.set_together(false);
                let mut in_lanes = [1, 4, 8].map(|lanes| (lanes, scene.contacts(points)));
                let (mut largest, mut touching) = (0.0_f64, 0);
                for step in 1..=steps {
                    let time = step as f64 * dt;
                    let ([x, y], [x0, y0]) = (scene.at(time), scene.at(time - dt));
                    let rate = |now: &[f64], was: &[f64]| -> Vec<f64> {
                        now.iter().zip(was).map(|(a, b)| (a - b) / dt).collect()
                    };
                    let (vx, vy) = (rate(&x, &x0), rate(&y, &y0));
                    let at = Moment { step, time, dt, x: &x, y: &y, vx: &vx, vy: &vy };
                    let forces = |contacts: &mut Contacts| {
                        let mut forces = NodeForces::zeros(x.len());
                        contacts.accumulate(at, &mut forces);
                        forces.fx.iter().chain(&*forces.fy).copied().collect::<Vec<f64>>()
                    };
                    let expected = forces(&mut singly);
                    let now = expected.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
                    largest = largest.max(now);
                    touching += usize::from(now > 0.0);
                    for (lanes, contacts) in &mut in_lanes {
                        LANES_ASKED.set(Some(*lanes));
                        let found = forces(contacts);
                        LANES_ASKED.set(None);
                        // Sums over hundreds of points, of gaps that are a thousandth of positions.
                        let off = found.iter().zip(&expected).map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
                        assert!(
                            off <= 1e-9 * largest,
                            "{lanes} lanes, {points} points, step {step}: off by {off} N"
                        );
                    }
                }
                assert!(
                    touching > steps as usize / 4 && touching < steps as usize,
                    "{touching} steps in contact"
                );
            }
        }
    }
}
