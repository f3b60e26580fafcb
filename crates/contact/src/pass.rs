//! One pass: the points of a secondary surface against the facets of a primary one.

use serde::{Deserialize, Serialize};
use stribeck_solver::{force::RankOne, state::Moment};

use crate::{
    law::Law,
    points::Points,
    projection::{Frame, Projection, distance, project, project_from},
    surface::Surface,
    touch::{History, Slide, Sum, touch},
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
}

/// What a pass remembers from step to step.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Memory {
    /// Facet of the primary surface on which each point was last found.
    nearest: Vec<u32>,
    candidates: Vec<Candidate>,
    /// What points in contact remember; empty without damping and friction.
    history: Vec<History>,
}

/// A facet that may touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Candidate {
    facet: u32,
    /// Not before this step.
    wake: u64,
}

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
}

/// A force on a node: slot, x [N], y [N].
pub(crate) type Push = (u32, [f64; 2]);

impl Weights {
    /// Larger gaps than this carry nothing [m].
    #[inline(always)]
    fn reach(&self) -> f64 {
        // Beyond 30 softnesses the rounded law is below 1e-13 of one softness of penetration.
        30.0 * self.softness
    }

    /// Effective penetration [m] and its slope [-] at a gap (THEORY §3.2).
    fn rounded(&self, gap: f64) -> [f64; 2] {
        let e = self.softness;
        if e == 0.0 {
            return [-gap, 1.0];
        }
        let t = -gap / e;
        let depth = if t > 30.0 { -gap } else { e * t.exp().ln_1p() };
        [depth, 1.0 / (1.0 + (-t).exp())]
    }
}

/// A facet in motion, and the forces on it.
#[derive(Debug, Clone, Copy)]
struct Side {
    frame: Frame,
    /// Velocity of its first node [m/s].
    v: [f64; 2],
    /// Velocity of the second node relative to the first [m/s].
    dv: [f64; 2],
    /// Sum of the forces at its points, and of those forces times their places [N].
    force: [f64; 2],
    moment: [f64; 2],
    /// Couple along the chord's normal: what the second node gets and the first loses [N].
    couple: f64,
    used: bool,
}

impl Side {
    #[inline(always)]
    fn new(frame: Frame, at: &Moment<'_>) -> Self {
        let (a, b) = frame.ends;
        let v = [at.vx[a], at.vy[a]];
        let dv = [at.vx[b] - v[0], at.vy[b] - v[1]];
        Self { frame, v, dv, force: [0.0; 2], moment: [0.0; 2], couple: 0.0, used: false }
    }

    /// How fast the chord's normal swings towards its tangent, backwards: n·dv [m/s].
    #[inline(always)]
    fn swing(&self) -> f64 {
        self.frame.normal[0] * self.dv[0] + self.frame.normal[1] * self.dv[1]
    }

    /// Velocity of a point of the curve, at a height given in lengths of the facet [m/s].
    #[inline(always)]
    fn velocity(&self, place: f64, height: f64) -> [f64; 2] {
        let back = height * self.swing() * self.frame.inverse;
        let t = self.frame.along;
        [self.v[0] + place * self.dv[0] - back * t[0], self.v[1] + place * self.dv[1] - back * t[1]]
    }

    /// Cosine of a force with the chord's direction, times its amount [N].
    #[inline(always)]
    fn along(&self, f: [f64; 2]) -> f64 {
        (f[0] * self.frame.along[0] + f[1] * self.frame.along[1]) * self.frame.inverse
    }

    #[inline(always)]
    fn add(&mut self, f: [f64; 2], place: f64, couple: f64) {
        self.force = [self.force[0] + f[0], self.force[1] + f[1]];
        self.moment = [self.moment[0] + place * f[0], self.moment[1] + place * f[1]];
        self.couple += couple;
        self.used = true;
    }

    /// Hands the forces over to the two nodes.
    #[inline(always)]
    fn flush(&self, push: &mut Vec<Push>) {
        if self.used {
            let [nx, ny] = self.frame.normal;
            let second = [self.moment[0] + self.couple * nx, self.moment[1] + self.couple * ny];
            push.push((self.frame.ends.0 as u32, [self.force[0] - second[0], self.force[1] - second[1]]));
            push.push((self.frame.ends.1 as u32, second));
        }
    }
}

/// How the point at `place` of `own` moves against its foot.
#[inline(always)]
fn slide(own: &Side, place: f64, height: f64, other: &Side, to: &Projection) -> Slide {
    let v = own.velocity(place, height);
    let u = [other.v[0] + to.place * other.dv[0], other.v[1] + to.place * other.dv[1]];
    let swing = other.swing();
    let [nx, ny] = to.normal;
    let rel = [v[0] - u[0], v[1] - u[1]];
    // The foot stands on the curve, which turns with its chord.
    let back = to.height * swing * other.frame.inverse;
    let foot = [rel[0] + back * other.frame.along[0], rel[1] + back * other.frame.along[1]];
    Slide { opening: nx * rel[0] + ny * rel[1] - to.turn * swing, along: nx * foot[1] - ny * foot[0] }
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
                candidates: Vec::new(),
                history: vec![History::default(); if remembers { n } else { 0 }],
            },
            deepest: 2.0 * surfaces[primary].mean_length().max(surfaces[secondary].mean_length()),
            points,
            asleep: 0,
        }
    }

    /// Whether `memory` can be that of this pass: equal counts, and facets that exist.
    pub(crate) fn can_remember(&self, memory: &Memory, surfaces: &[Surface]) -> bool {
        let (own, secondary, primary) = (&self.memory, &surfaces[self.secondary], &surfaces[self.primary]);
        memory.nearest.len() == own.nearest.len()
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
        x: &[f64],
        y: &[f64],
    ) {
        let (secondary, primary) = (&surfaces[self.secondary], &surfaces[self.primary]);
        let Memory { nearest, candidates, .. } = &mut self.memory;
        candidates.clear();
        self.asleep = 0;
        let mut best: [f64; 64] = [f64::INFINITY; 64];
        let mut last = None;
        for (f, g) in pairs {
            let range = self.points.of_facet(f as usize);
            if last != Some(f) {
                candidates.push(Candidate { facet: f, wake: 0 });
                best = [f64::INFINITY; 64];
                last = Some(f);
            }
            let own = Frame::new(secondary, x, y, f as usize);
            for (k, i) in range.enumerate() {
                let p = own.point(self.points.place[i], self.points.height[i]);
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
        self.memory.candidates.iter().map(|c| 2 + 2 * points(c)).sum()
    }

    /// Evaluates the pass: pushes forces and sums.
    pub(crate) fn evaluate(
        &mut self,
        surfaces: &[Surface],
        at: &Moment<'_>,
        w: &Weights,
        push: &mut Vec<Push>,
    ) -> Sum {
        let mut sum = Sum::default();
        if at.step < self.asleep {
            return sum;
        }
        let (secondary, primary) = (&surfaces[self.secondary], &surfaces[self.primary]);
        let reach = w.reach();
        let mut first_awake = u64::MAX;
        let Memory { nearest, candidates, history } = &mut self.memory;
        // Consecutive points mostly share a primary facet: its forces wait until another one comes.
        let mut other: Option<Side> = None;
        let mut frame = Frame::new(primary, at.x, at.y, 0);
        for candidate in candidates {
            if at.step < candidate.wake {
                first_awake = first_awake.min(candidate.wake);
                continue;
            }
            let facet = candidate.facet as usize;
            let mut own = Side::new(Frame::new(secondary, at.x, at.y, facet), at);
            let mut nearest_gap = f64::INFINITY;
            let mut touched = false;
            for i in self.points.of_facet(facet) {
                let (place, height) = (self.points.place[i], self.points.height[i]);
                let p = own.frame.point(place, height);
                let start = nearest[i] as usize;
                if frame.facet != start {
                    frame = Frame::new(primary, at.x, at.y, start);
                }
                let found = project_from(primary, at.x, at.y, p, &mut frame);
                nearest[i] = frame.facet as u32;
                let gap = found.map_or(f64::INFINITY, |f| f.gap);
                let contact = gap < reach && gap > -self.deepest;
                if !contact {
                    nearest_gap = nearest_gap.min(gap.abs());
                    if let Some(history) = history.get_mut(i).filter(|h| !h.is_empty()) {
                        touched = true;
                        let side = Side::new(frame, at);
                        let slide = found
                            .map_or(Slide::default(), |f| slide(&own, place, height * own.frame.inverse, &side, &f));
                        history.release(self.points.weight[i] * w.thickness, &w.law, at.dt, slide, &mut sum);
                    }
                    continue;
                }
                let Some(to) = found else { continue };
                touched = true;
                let other = match &mut other {
                    Some(side) if side.frame.facet == to.facet => side,
                    last => {
                        if let Some(side) = last {
                            side.flush(push);
                        }
                        last.insert(Side::new(frame, at))
                    }
                };
                let area = self.points.weight[i] * w.thickness;
                let height = height * own.frame.inverse;
                let [pressure, shear] = if w.softness > 0.0 {
                    [w.law.stiffness * area * w.rounded(gap)[0], 0.0]
                } else {
                    sum.stored += 0.5 * w.law.stiffness * area * gap * gap;
                    sum.penetration = sum.penetration.max(-gap);
                    match history.get_mut(i) {
                        Some(history) => {
                            let slide = slide(&own, place, height, other, &to);
                            touch(gap, area, &w.law, at.dt, slide, history, &mut sum)
                        }
                        None => [-w.law.stiffness * area * gap, 0.0],
                    }
                };
                let [nx, ny] = to.normal;
                let f = [pressure * nx - shear * ny, pressure * ny + shear * nx];
                own.add(f, place, -height * own.along(f));
                let back = [-f[0], -f[1]];
                let shear_along = other.along([-shear * ny, shear * nx]);
                other.add(back, to.place, to.height * shear_along - to.turn * pressure);
            }
            if touched {
                own.flush(push);
                sum.force = [sum.force[0] + own.force[0], sum.force[1] + own.force[1]];
                first_awake = 0;
            } else if nearest_gap > 0.0 && w.fastest > 0.0 {
                // Points off both ends of an open surface report an infinite gap; the next search wakes them.
                let steps = nearest_gap / (w.fastest * at.dt);
                candidate.wake = at.step.saturating_add(steps as u64);
                first_awake = first_awake.min(candidate.wake);
            } else {
                first_awake = 0;
            }
        }
        if let Some(side) = &other {
            side.flush(push);
        }
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
        visit: &mut dyn FnMut(RankOne),
    ) {
        let (secondary, primary) = (&surfaces[self.secondary], &surfaces[self.primary]);
        for candidate in &self.memory.candidates {
            let facet = candidate.facet as usize;
            let own = Frame::new(secondary, x, y, facet);
            for i in self.points.of_facet(facet) {
                let (place, height) = (self.points.place[i], self.points.height[i]);
                let p = own.point(place, height);
                let Some(f) = project(primary, x, y, p, self.memory.nearest[i] as usize) else { continue };
                if f.gap >= w.reach() || f.gap <= -self.deepest {
                    continue;
                }
                let [_, slope] = w.rounded(f.gap);
                let other = Frame::new(primary, x, y, f.facet);
                let [nx, ny] = f.normal;
                let along = (nx * own.along[0] + ny * own.along[1]) * own.inverse;
                let lever = height * own.inverse * along;
                let n = [1.0 - place, place, -(1.0 - f.place), -f.place];
                let turns = [
                    lever * own.normal[0],
                    lever * own.normal[1],
                    f.turn * other.normal[0],
                    f.turn * other.normal[1],
                ];
                let sign = [1.0, -1.0, 1.0, -1.0];
                visit(RankOne {
                    nodes: [own.ends.0 as u32, own.ends.1 as u32, other.ends.0 as u32, other.ends.1 as u32],
                    direction: std::array::from_fn(|k| {
                        n[k / 2] * to_xy(nx, ny, k) + sign[k / 2] * turns[2 * (k / 4) + k % 2]
                    }),
                    stiffness: slope * w.law.stiffness * self.points.weight[i] * w.thickness,
                });
            }
        }
    }
}

#[inline(always)]
fn to_xy(x: f64, y: f64, k: usize) -> f64 {
    if k % 2 == 0 { x } else { y }
}
