//! One pass: the points of a secondary surface against the facets of a primary one.

use pulp::{Arch, Simd, WithSimd};
use serde::{Deserialize, Serialize};
use stribeck_solver::{force::RankOne, state::Moment};

use crate::{
    law::Law,
    points::Points,
    projection::{Frame, distance},
    row::{Against, MOST_POINTS, Row},
    shape::{Push, Shape, Side},
    spline::Patch,
    spline_row::Feet,
    surface::Surface,
    touch::{Histories, Slide, Sum, touch},
};

/// One pass of a pair.
#[derive(Debug, Clone)]
pub(crate) struct Pass {
    pub(crate) secondary: usize,
    pub(crate) primary: usize,
    pub(crate) points: Points,
    pub(crate) memory: Memory,
    /// Deeper penetrations than this are not contacts but other sides of a body [m].
    deepest: f64,
    /// No candidate wakes before this step.
    asleep: u64,
    /// About how long the last evaluation took, in units of some ten nanoseconds.
    pub(crate) work: usize,
}

/// What a pass remembers from step to step.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Memory {
    /// Facet of the primary surface on which each point was last found.
    nearest: Vec<u32>,
    /// Step of the last search.
    searched: u64,
    /// Steps after the search before which each point cannot touch.
    doze: Vec<u16>,
    candidates: Vec<Candidate>,
    /// What points in contact remember.
    history: Histories,
}

/// A facet that may touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Candidate {
    facet: u32,
    /// Not before this step.
    wake: u64,
}

/// Most nodes that a facet hangs on.
const MOST_NODES: usize = 6;

/// Which laws act: the static preload takes the penalty alone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights {
    /// Law of the pair.
    pub(crate) law: Law,
    /// Thickness times the share of this pass [m].
    pub(crate) thickness: f64,
    /// Fastest approach of two points [m/s], for letting distant facets sleep.
    pub(crate) fastest: f64,
    /// Rounds the corner of the penalty law over about this gap [m]; zero for the law itself.
    pub(crate) softness: f64,
    /// Whether points may be done together.
    pub(crate) together: bool,
}

/// The evaluation of a pass, to be compiled for each instruction set.
struct Evaluation<'a> {
    pass: &'a mut Pass,
    surfaces: &'a [Surface],
    at: &'a Moment<'a>,
    w: &'a Weights,
    push: &'a mut Vec<Push>,
}

impl WithSimd for Evaluation<'_> {
    type Output = Sum;

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) -> Sum {
        let Self { pass, surfaces, at, w, push } = self;
        // Which curves meet is asked once a pass; the loop over points is compiled for each.
        match [pass.secondary, pass.primary].map(|s| surfaces[s].spline.is_some()) {
            [false, false] => pass.evaluate_as::<V, Frame, Frame>(simd, surfaces, at, w, push),
            [false, true] => pass.evaluate_as::<V, Frame, Patch>(simd, surfaces, at, w, push),
            [true, false] => pass.evaluate_as::<V, Patch, Frame>(simd, surfaces, at, w, push),
            [true, true] => pass.evaluate_as::<V, Patch, Patch>(simd, surfaces, at, w, push),
        }
    }
}

impl Weights {
    /// Larger gaps than this carry nothing [m].
    #[inline(always)]
    pub(crate) fn reach(&self) -> f64 {
        // Beyond 30 softnesses the rounded law is below 1e-13 of one softness of penetration.
        if self.softness > 0.0 { 30.0 * self.softness } else { self.law.onset }
    }

    /// Effective penetration [m] and its slope [-] at a gap (THEORY §3.2).
    fn rounded(&self, gap: f64) -> [f64; 2] {
        let e = self.softness;
        if e == 0.0 {
            let [depth, slope, _] = self.law.depth(gap);
            return [depth, slope];
        }
        let t = -gap / e;
        let depth = if t > 30.0 { -gap } else { e * t.exp().ln_1p() };
        [depth, 1.0 / (1.0 + (-t).exp())]
    }
}

impl Pass {
    pub(crate) fn new(
        secondary: usize,
        primary: usize,
        points: Points,
        law: &Law,
        surfaces: &[Surface],
    ) -> Self {
        let n = points.len();
        let remembers = law.damping > 0.0 || law.friction > 0.0;
        Self {
            secondary,
            primary,
            memory: Memory {
                nearest: vec![0; n],
                searched: 0,
                doze: vec![0; n],
                candidates: Vec::new(),
                history: if remembers { Histories::new(n) } else { Histories::default() },
            },
            deepest: 2.0 * surfaces[primary].mean_length().max(surfaces[secondary].mean_length()),
            points,
            asleep: 0,
            work: 0,
        }
    }

    /// Whether `memory` can be that of this pass: equal counts, and facets that exist.
    pub(crate) fn can_remember(&self, memory: &Memory, surfaces: &[Surface]) -> bool {
        let (own, secondary, primary) = (&self.memory, &surfaces[self.secondary], &surfaces[self.primary]);
        memory.nearest.len() == own.nearest.len()
            && memory.doze.len() == own.doze.len()
            && memory.history.len() == own.history.len()
            && memory.nearest.iter().all(|&facet| (facet as usize) < primary.facets())
            && memory.candidates.iter().all(|c| (c.facet as usize) < secondary.facets())
    }

    /// Goes on from a memory.
    pub(crate) fn remember(&mut self, memory: Memory) {
        (self.memory, self.asleep) = (memory, 0);
    }

    /// Takes new candidates from pairs (secondary facet, primary facet), ascending.
    pub(crate) fn take(
        &mut self,
        pairs: impl Iterator<Item = (u32, u32)>,
        surfaces: &[Surface],
        at: &Moment<'_>,
    ) {
        let (x, y) = (at.x, at.y);
        let (secondary, primary) = (&surfaces[self.secondary], &surfaces[self.primary]);
        let Memory { nearest, searched, doze, candidates, .. } = &mut self.memory;
        *searched = at.step;
        candidates.clear();
        self.asleep = 0;
        let mut best: [f64; 64] = [f64::INFINITY; 64];
        let mut last = None;
        for (f, g) in pairs {
            let range = self.points.of_facet(f as usize);
            if last != Some(f) {
                candidates.push(Candidate { facet: f, wake: 0 });
                doze[range.clone()].fill(0);
                best = [f64::INFINITY; 64];
                last = Some(f);
            }
            let own = Frame::new(secondary, x, y, f as usize);
            for (k, i) in range.enumerate() {
                // On the chord: near enough to begin a walk.
                let p = own.spot(self.points.place[i], 0.0).at;
                let d = distance(primary, x, y, p, g as usize);
                let best = &mut best[k.min(63)];
                if d < *best {
                    *best = d;
                    nearest[i] = g;
                }
            }
        }
    }

    /// Pushes that one evaluation makes at most, until the next candidates are taken.
    pub(crate) fn most_pushes(&self) -> usize {
        let points = |c: &Candidate| self.points.of_facet(c.facet as usize).len();
        self.memory.candidates.iter().map(|c| MOST_NODES * (1 + points(c))).sum()
    }

    /// Evaluates the pass: pushes forces and sums.
    pub(crate) fn evaluate(
        &mut self,
        surfaces: &[Surface],
        at: &Moment<'_>,
        w: &Weights,
        push: &mut Vec<Push>,
    ) -> Sum {
        self.work = 0;
        if at.step < self.asleep {
            return Sum::default();
        }
        Arch::new().dispatch(Evaluation { pass: self, surfaces, at, w, push })
    }

    #[inline(always)]
    fn evaluate_as<V: Simd, S: Shape, P: Shape>(
        &mut self,
        simd: V,
        surfaces: &[Surface],
        at: &Moment<'_>,
        w: &Weights,
        push: &mut Vec<Push>,
    ) -> Sum {
        let mut sum = Sum::default();
        let (secondary, primary) = (&surfaces[self.secondary], &surfaces[self.primary]);
        let reach = w.reach();
        let mut first_awake = u64::MAX;
        let Memory { nearest, searched, doze, candidates, history } = &mut self.memory;
        let now = u16::try_from(at.step.saturating_sub(*searched)).unwrap_or(u16::MAX);
        let closing = w.fastest * at.dt;
        // Consecutive points mostly share a primary facet: its forces wait until another one comes.
        let mut other: Option<Side<P>> = None;
        // Chords against chords and splines against splines, with the law itself: many points at a time.
        let flat = secondary.is_flat() && primary.is_flat();
        let splines = secondary.spline.is_some() && primary.spline.is_some();
        let together = w.together && (flat || splines) && w.softness == 0.0 && history.len() > 0;
        let mut feet = Feet::new(simd, w, at.dt);
        let mut shape: Option<P> = None;
        for candidate in candidates {
            if at.step < candidate.wake {
                first_awake = first_awake.min(candidate.wake);
                continue;
            }
            let facet = candidate.facet as usize;
            let mut own = Side::<S>::new(S::new(secondary, at.x, at.y, facet), secondary, at);
            let mut soonest = u16::MAX;
            let mut touched = false;
            let range = self.points.of_facet(facet);
            self.work += 4 + range.len() / 4;
            let mut done = [false; MOST_POINTS];
            if together && range.len() <= MOST_POINTS {
                let against = Against { primary, at, w, deepest: self.deepest };
                let points = &self.points;
                let mut row = Row { points, range: range.clone(), nearest, doze, now, history, against };
                touched = S::touch_row(simd, &mut row, &mut own, &mut feet, &mut done, &mut sum, push);
            }
            for i in range.clone() {
                if done.get(i - range.start) == Some(&true) {
                    continue;
                }
                if doze[i] > now {
                    soonest = soonest.min(doze[i]);
                    continue;
                }
                self.work += 4;
                let spot = own.shape.spot(self.points.place[i], self.points.height[i]);
                let start = nearest[i] as usize;
                let shape = match &mut shape {
                    Some(shape) if shape.facet() == start => shape,
                    shape => shape.insert(P::new(primary, at.x, at.y, start)),
                };
                let found = shape.project(primary, at.x, at.y, spot.at);
                nearest[i] = shape.facet() as u32;
                let gap = found.map_or(f64::INFINITY, |f| f.gap);
                let Some(to) = found.filter(|f| f.gap < reach && f.gap > -self.deepest) else {
                    // Points off both ends of an open surface report an infinite gap; the next search wakes them.
                    let steps = ((gap - reach).abs() / closing) as u16;
                    doze[i] = now.saturating_add(steps);
                    soonest = soonest.min(doze[i]);
                    if let Some(mut past) = history.get(i).filter(|h| !h.is_empty()) {
                        touched = true;
                        let side = Side::new(*shape, primary, at);
                        let slide = found.map_or(Slide::default(), |to| side.slide(own.velocity(&spot), &to));
                        past.release(self.points.weight[i] * w.thickness, &w.law, at.dt, slide, &mut sum);
                        history.set(i, past);
                    }
                    continue;
                };
                touched = true;
                let other = match &mut other {
                    Some(side) if side.shape.facet() == to.facet => side,
                    last => {
                        if let Some(side) = last {
                            side.flush(primary, push);
                        }
                        last.insert(Side::new(*shape, primary, at))
                    }
                };
                let area = self.points.weight[i] * w.thickness;
                let [pressure, shear] = if w.softness > 0.0 {
                    [w.law.stiffness * area * w.rounded(gap)[0], 0.0]
                } else {
                    match history.get(i) {
                        Some(mut past) => {
                            let slide = other.slide(own.velocity(&spot), &to);
                            let push = touch(gap, area, &w.law, at.dt, slide, &mut past, &mut sum);
                            history.set(i, past);
                            push
                        }
                        None => {
                            let [depth, _, work] = w.law.depth(gap);
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
            if touched {
                own.flush(secondary, push);
                sum.force = [sum.force[0] + own.force[0], sum.force[1] + own.force[1]];
                first_awake = 0;
            } else {
                candidate.wake = *searched + u64::from(soonest);
                first_awake = first_awake.min(candidate.wake);
            }
        }
        if let Some(side) = &other {
            side.flush(primary, push);
        }
        feet.flush(primary, &mut sum, push);
        self.asleep = first_awake;
        sum
    }

    /// Visits the tangent of the points that penetrate at positions `x`, `y`: that of the gap's gradient; what the
    /// gradient itself changes by is left out.
    pub(crate) fn tangent(
        &self,
        surfaces: &[Surface],
        x: &[f64],
        y: &[f64],
        w: &Weights,
        visit: &mut dyn FnMut(RankOne<'_>),
    ) {
        match [self.secondary, self.primary].map(|s| surfaces[s].spline.is_some()) {
            [false, false] => self.tangent_as::<Frame, Frame>(surfaces, x, y, w, visit),
            [false, true] => self.tangent_as::<Frame, Patch>(surfaces, x, y, w, visit),
            [true, false] => self.tangent_as::<Patch, Frame>(surfaces, x, y, w, visit),
            [true, true] => self.tangent_as::<Patch, Patch>(surfaces, x, y, w, visit),
        }
    }

    fn tangent_as<S: Shape, P: Shape>(
        &self,
        surfaces: &[Surface],
        x: &[f64],
        y: &[f64],
        w: &Weights,
        visit: &mut dyn FnMut(RankOne<'_>),
    ) {
        let (secondary, primary) = (&surfaces[self.secondary], &surfaces[self.primary]);
        let at = Moment { step: 0, time: 0.0, dt: 0.0, x, y, vx: x, vy: y };
        let (mut gradient, mut nodes, mut direction) = (Vec::new(), Vec::new(), Vec::new());
        for candidate in &self.memory.candidates {
            let facet = candidate.facet as usize;
            let shape = S::new(secondary, x, y, facet);
            for i in self.points.of_facet(facet) {
                let spot = shape.spot(self.points.place[i], self.points.height[i]);
                let mut foot = P::new(primary, x, y, self.memory.nearest[i] as usize);
                let found = foot.project(primary, x, y, spot.at);
                let Some(to) = found.filter(|f| f.gap < w.reach() && f.gap > -self.deepest) else { continue };
                let [_, slope] = w.rounded(to.gap);
                // The gap's gradient is the force that a unit pressure makes.
                gradient.clear();
                let (mut own, mut other) = (Side::new(shape, secondary, &at), Side::new(foot, primary, &at));
                own.push_point(&spot, to.normal);
                other.push_foot(&to, to.normal, 1.0, 0.0);
                own.flush(secondary, &mut gradient);
                other.flush(primary, &mut gradient);
                nodes.clear();
                nodes.extend(gradient.iter().map(|(slot, _)| *slot));
                direction.clear();
                direction.extend(gradient.iter().flat_map(|(_, g)| *g));
                visit(RankOne {
                    nodes: &nodes,
                    direction: &direction,
                    stiffness: slope * w.law.stiffness * self.points.weight[i] * w.thickness,
                });
            }
        }
    }
}
