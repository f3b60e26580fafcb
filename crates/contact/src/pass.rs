//! One pass: the points of a secondary surface against the facets of a primary one.

use serde::{Deserialize, Serialize};
use stribeck_solver::{force::RankOne, state::Moment};

use crate::{
    law::Law,
    points::Points,
    projection::{Projection, distance, project},
    surface::Surface,
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

/// What a point in contact remembers of the step before.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct History {
    /// Elastic part of the tangential displacement [m].
    slip: f64,
    /// Damping force [N].
    damping: f64,
}

/// Sums over one pass.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sum {
    /// Force on the secondary body [N].
    pub(crate) force: [f64; 2],
    /// Elastic energy [J].
    pub(crate) stored: f64,
    /// Heat of friction in the last step [J].
    pub(crate) friction: f64,
    /// Heat of damping in the last step [J].
    pub(crate) damping: f64,
    /// Deepest penetration [m].
    pub(crate) penetration: f64,
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
        let mut best: [f64; 64] = [f64::INFINITY; 64];
        let mut last = None;
        for (f, g) in pairs {
            let range = self.points.of_facet(f as usize);
            if last != Some(f) {
                candidates.push(Candidate { facet: f, wake: 0 });
                best = [f64::INFINITY; 64];
                last = Some(f);
            }
            let (a, b) = secondary.ends(f as usize);
            for (k, i) in range.enumerate() {
                let d = distance(primary, x, y, between(x, y, a, b, self.points.place[i]), g as usize);
                let best = &mut best[k.min(63)];
                if d < *best {
                    *best = d;
                    nearest[i] = g;
                }
            }
        }
    }

    /// Evaluates the pass: pushes (slot, force x, force y) and sums.
    pub(crate) fn evaluate(
        &mut self,
        surfaces: &[Surface],
        at: &Moment<'_>,
        w: &Weights,
        push: &mut Vec<(u32, [f64; 2])>,
    ) -> Sum {
        let (secondary, primary) = (&surfaces[self.secondary], &surfaces[self.primary]);
        let mut sum = Sum::default();
        let reach = w.reach();
        let Memory { nearest, candidates, history } = &mut self.memory;
        for candidate in candidates {
            if at.step < candidate.wake {
                continue;
            }
            let facet = candidate.facet as usize;
            let (a, b) = secondary.ends(facet);
            let mut force_a = [0.0; 2];
            let mut force_b = [0.0; 2];
            let mut nearest_gap = f64::INFINITY;
            let mut touched = false;
            for i in self.points.of_facet(facet) {
                let place = self.points.place[i];
                let p = between(at.x, at.y, a, b, place);
                let found = project(primary, at.x, at.y, p, nearest[i] as usize);
                if let Some(found) = &found {
                    nearest[i] = found.facet as u32;
                }
                let contact = found.filter(|f| f.gap < reach && f.gap > -self.deepest);
                let mut none = History::default();
                let history = history.get_mut(i).unwrap_or(&mut none);
                let Some(projection) = contact else {
                    nearest_gap = nearest_gap.min(found.map_or(f64::INFINITY, |f| f.gap.abs()));
                    if *history != History::default() {
                        touched = true;
                        let relative = found
                            .map(|f| relative_velocity(secondary, primary, at, facet, place, &f))
                            .unwrap_or_default();
                        let normal = found.map_or([0.0, 0.0], |f| f.normal);
                        let stiffness = w.law.stiffness * self.points.weight[i] * w.thickness;
                        release(history, relative, normal, stiffness, &w.law, at.dt, &mut sum);
                    }
                    continue;
                };
                touched = true;
                let area = self.points.weight[i] * w.thickness;
                let f = contact_force(
                    secondary,
                    primary,
                    at,
                    facet,
                    place,
                    &projection,
                    w,
                    area,
                    history,
                    &mut sum,
                );
                let (c, d) = primary.ends(projection.facet);
                force_a = [force_a[0] + (1.0 - place) * f[0], force_a[1] + (1.0 - place) * f[1]];
                force_b = [force_b[0] + place * f[0], force_b[1] + place * f[1]];
                let s = projection.place;
                push.push((c as u32, [-(1.0 - s) * f[0], -(1.0 - s) * f[1]]));
                push.push((d as u32, [-s * f[0], -s * f[1]]));
            }
            if touched {
                push.push((a as u32, force_a));
                push.push((b as u32, force_b));
                sum.force =
                    [sum.force[0] + (force_a[0] + force_b[0]), sum.force[1] + (force_a[1] + force_b[1])];
            } else if nearest_gap > 0.0 && w.fastest > 0.0 {
                // Points off both ends of an open surface report an infinite gap; the next search wakes them.
                let steps = nearest_gap / (w.fastest * at.dt);
                candidate.wake = at.step.saturating_add(steps as u64);
            }
        }
        sum
    }

    /// Visits the tangent of the points that penetrate at positions `x`, `y`.
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
            let (a, b) = secondary.ends(facet);
            for i in self.points.of_facet(facet) {
                let place = self.points.place[i];
                let p = between(x, y, a, b, place);
                let Some(f) = project(primary, x, y, p, self.memory.nearest[i] as usize) else { continue };
                if f.gap >= w.reach() || f.gap <= -self.deepest {
                    continue;
                }
                let [_, slope] = w.rounded(f.gap);
                let (c, d) = primary.ends(f.facet);
                let [nx, ny] = f.normal;
                let n = [1.0 - place, place, -(1.0 - f.place), -f.place];
                visit(RankOne {
                    nodes: [a as u32, b as u32, c as u32, d as u32],
                    direction: std::array::from_fn(|k| n[k / 2] * if k % 2 == 0 { nx } else { ny }),
                    stiffness: slope * w.law.stiffness * self.points.weight[i] * w.thickness,
                });
            }
        }
    }
}

#[inline(always)]
fn between(v: &[f64], w: &[f64], a: usize, b: usize, place: f64) -> [f64; 2] {
    [v[a] + place * (v[b] - v[a]), w[a] + place * (w[b] - w[a])]
}

/// Velocity of the secondary point relative to its foot on the primary surface [m/s].
#[inline(always)]
fn relative_velocity(
    secondary: &Surface,
    primary: &Surface,
    at: &Moment<'_>,
    facet: usize,
    place: f64,
    to: &Projection,
) -> [f64; 2] {
    let (a, b) = secondary.ends(facet);
    let (c, d) = primary.ends(to.facet);
    let u = between(at.vx, at.vy, a, b, place);
    let v = between(at.vx, at.vy, c, d, to.place);
    [u[0] - v[0], u[1] - v[1]]
}

/// Force on the secondary point [N]; updates its history.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // one point's whole situation
fn contact_force(
    secondary: &Surface,
    primary: &Surface,
    at: &Moment<'_>,
    facet: usize,
    place: f64,
    to: &Projection,
    w: &Weights,
    area: f64,
    history: &mut History,
    sum: &mut Sum,
) -> [f64; 2] {
    let [nx, ny] = to.normal;
    let law = &w.law;
    let stiffness = law.stiffness * area;
    if w.softness > 0.0 {
        let [depth, _] = w.rounded(to.gap);
        return [stiffness * depth * nx, stiffness * depth * ny];
    }
    let elastic = -stiffness * to.gap;
    sum.stored -= 0.5 * elastic * to.gap;
    sum.penetration = sum.penetration.max(-to.gap);
    if law.damping == 0.0 && law.friction == 0.0 {
        return [elastic * nx, elastic * ny];
    }
    let v = relative_velocity(secondary, primary, at, facet, place, to);
    let approach = v[0] * nx + v[1] * ny;
    // Damping never pulls: the sum of both stays a pressure.
    let damping = (-law.damping * area * approach).max(-elastic);
    // Work of a force over a step is the mean of its two ends times the displacement (THEORY §2.5).
    sum.damping -= 0.5 * (history.damping + damping) * approach * at.dt;
    history.damping = damping;
    let normal = elastic + damping;
    if law.friction == 0.0 {
        return [normal * nx, normal * ny];
    }
    let (tx, ty) = (-ny, nx);
    let moved = (v[0] * tx + v[1] * ty) * at.dt;
    let tangential = law.tangential * stiffness;
    let limit = law.friction * elastic / tangential;
    let before = history.slip;
    let after = (before + moved).clamp(-limit, limit);
    history.slip = after;
    let stored = 0.5 * tangential * after * after;
    sum.stored += stored;
    sum.friction +=
        0.5 * tangential * (before + after) * moved - (stored - 0.5 * tangential * before * before);
    let shear = -tangential * after;
    [normal * nx + shear * tx, normal * ny + shear * ty]
}

/// A point lost contact: settles the last half step of its history and forgets it.
fn release(
    history: &mut History,
    v: [f64; 2],
    normal: [f64; 2],
    stiffness: f64,
    law: &Law,
    dt: f64,
    sum: &mut Sum,
) {
    let approach = v[0] * normal[0] + v[1] * normal[1];
    let moved = (v[1] * normal[0] - v[0] * normal[1]) * dt;
    let tangential = law.tangential * stiffness;
    sum.damping -= 0.5 * history.damping * approach * dt;
    sum.friction += 0.5 * tangential * history.slip * (moved + history.slip);
    *history = History::default();
}
