//! One pass of a contact pair: the points of a secondary surface against the facets of a primary one. Between
//! searches ([`broad_phase`](crate::broad_phase)) it tracks the points' feet and evaluates the law
//! ([`kernel`](crate::kernel)).

use std::sync::Arc;

use prefetch_index::prefetch_index;
use pulp::Arch;
use stribeck_simd::lanes::LANES;
use stribeck_solver::{force::RankOne, state::Moment};

use stribeck_surface::{
    Law, Surface, chord::ChordFacet, facet::Facet, foot::Push, narrow_phase::find_foot,
    spline_facet::SplineFacet,
};

use crate::{
    kernel::{
        evaluate::{Evaluation, Sum},
        nearest_chord::NearestChord,
    },
    memory::{Arrangement, Candidate, Histories, Memory, NEVER},
    moving_facet::MovingFacet,
    pass_law::PassLaw,
    points::{FEW_POINTS, Points},
};

/// Most nodes that a facet depends on.
const MOST_NODES: usize = 6;

#[derive(Debug, Clone)]
pub(crate) struct Pass {
    pub(crate) secondary: usize,
    pub(crate) primary: usize,
    pub(crate) points: Arc<Points>,
    pub(crate) arrangement: Arrangement,
    pub(crate) memory: Memory,
    /// Deeper penetrations belong to the far side of a body and are no contacts [m].
    pub(crate) deepest: f64,
    /// Scratch space of searches, separate so that data read in every step lie close together.
    room: Box<Room>,
}

/// Scratch space of a search.
#[derive(Debug, Clone)]
struct Room {
    before: Memory,
    /// Facets nearest to the points of one.
    found: Vec<u32>,
}

/// Positions of a facet's end nodes in the arrays of its surface.
fn ends(surface: &Surface, facet: u32) -> [u32; 2] {
    let (a, b) = surface.ends(facet as usize);
    [a as u32, b as u32]
}

impl Pass {
    pub(crate) fn new(
        secondary: usize,
        primary: usize,
        points: Arc<Points>,
        law: &Law,
        surfaces: &[Surface],
    ) -> Self {
        let remembers = law.damping > 0.0 || law.friction > 0.0;
        Self {
            secondary,
            primary,
            memory: Memory::new(remembers),
            room: Box::new(Room { before: Memory::new(remembers), found: Vec::new() }),
            deepest: 2.0 * surfaces[primary].mean_length().max(surfaces[secondary].mean_length()),
            arrangement: if surfaces[primary].is_flat()
                && surfaces[secondary].is_flat()
                && points.most <= FEW_POINTS
            {
                Arrangement::Bands { points: points.most }
            } else {
                Arrangement::Rows
            },
            points,
        }
    }

    /// Whether `memory` can be that of this pass: equal counts, and facets that exist.
    pub(crate) fn can_remember(&self, memory: &Memory, surfaces: &[Surface]) -> bool {
        let (mut taken, mut least) = (0, 0);
        let in_order = memory.candidates.iter().enumerate().all(|(before, c)| {
            let Some(&pattern) = self.points.of_facet.get(c.facet as usize) else { return false };
            let first;
            (first, taken) = self.arrangement.next(before, taken, pattern);
            let fits = c.pattern == pattern
                && c.facet >= least
                && c.first as usize == first
                && c.ends == ends(&surfaces[self.secondary], c.facet);
            least = c.facet.saturating_add(1);
            fits
        });
        let (n, facets) = (taken, surfaces[self.primary].facets());
        in_order
            && memory.nearest.len() == n
            && memory.inactive_until.len() == n + LANES
            && memory.inactive_until.iter().all(|inactive_until| inactive_until.is_finite())
            && memory.history.is_some() == self.memory.history.is_some()
            && memory.history.as_ref().is_none_or(|history| history.serve(n))
            && memory.nearest.iter().all(|&facet| (facet as usize) < facets)
    }

    /// Continues from a state.
    pub(crate) fn remember(&mut self, memory: Memory) {
        self.memory = memory;
    }

    /// Takes new candidates from pairs (secondary facet, primary facet), ascending. Points of facets that
    /// were candidates before keep their state, except where another part of the primary surface has come
    /// nearer; they stay inactive for as much less time as the fastest approach was `slower` in the search
    /// before.
    pub(crate) fn take(&mut self, pairs: &[(u32, u32)], surfaces: &[Surface], at: &Moment<'_>, slower: f64) {
        let (secondary, primary) = (&surfaces[self.secondary], &surfaces[self.primary]);
        let Self { points, arrangement, memory, room, .. } = self;
        let stride = arrangement.stride();
        let Room { before, found } = &mut **room;
        std::mem::swap(memory, before);
        memory.clear();
        (memory.pace, memory.searched, memory.idle_until) = (before.pace, at.step, 0);
        let elapsed = at.step.saturating_sub(before.searched) as f64;
        let mut old = before.candidates.iter().peekable();
        for pairs in pairs.chunk_by(|a, b| a.0 == b.0) {
            let facet = pairs[0].0;
            let pattern = points.of_facet[facet as usize];
            let first = memory.room_for(pattern, *arrangement);
            Arch::new().dispatch(NearestChord {
                secondary,
                primary,
                points,
                x: at.x,
                y: at.y,
                facet: facet as usize,
                pairs,
                found,
            });
            while old.next_if(|c| c.facet < facet).is_some() {}
            let old = old.peek().filter(|c| c.facet == facet);
            let mut soonest = f64::INFINITY;
            for (k, &new) in found.iter().enumerate() {
                let known = old.map(|c| c.first as usize + k * stride);
                let (mut nearest, mut inactive_until) = (new, 0.0);
                if let Some(i) = known.filter(|&i| primary.adjoin(before.nearest[i] as usize, new as usize)) {
                    nearest = before.nearest[i];
                    // Whoever had no foot looks again.
                    inactive_until = if before.inactive_until[i] == NEVER {
                        0.0
                    } else {
                        slower * (before.inactive_until[i] - elapsed)
                    };
                }
                soonest = soonest.min(inactive_until);
                memory.set(first + k * stride, nearest, inactive_until, known.map(|i| (&*before, i)));
            }
            let active_from = at.step.saturating_add(soonest.max(0.0) as u64);
            let (first, ends) = (first as u32, ends(secondary, facet));
            memory.candidates.push(Candidate { active_from, facet, first, pattern, ends });
        }
        memory.pad();
    }

    /// Forgets all candidates: positions are about to change in other ways than by motion.
    pub(crate) fn forget_candidates(&mut self) {
        self.memory.clear();
        self.memory.pad();
    }

    /// Pushes that one evaluation makes at most, until the next candidates are taken.
    pub(crate) fn most_pushes(&self) -> usize {
        self.memory.candidates.iter().map(|c| MOST_NODES * (1 + c.pattern.points as usize)).sum()
    }

    /// Prefetches the first data of a row's evaluation, of all active facets: between two steps the elements
    /// evict it from the near caches, and so it loads while the first facets are evaluated.
    pub(crate) fn fetch(&self, surfaces: &[Surface], at: &Moment<'_>) {
        let Memory { nearest, inactive_until, history, candidates, idle_until, .. } = &self.memory;
        // Facets with few points follow one another in memory as they are read.
        if at.step < *idle_until || self.arrangement != Arrangement::Rows {
            return;
        }
        let primary = &surfaces[self.primary];
        for candidate in candidates.iter().filter(|c| at.step >= c.active_from) {
            let (first, n) = (candidate.first as usize, candidate.pattern.points as usize);
            for i in (first..first + n).step_by(LANES) {
                prefetch_index(&inactive_until[..], i);
                if let Some(Histories { slip, damping }) = history {
                    prefetch_index(&slip[..], i);
                    prefetch_index(&damping[..], i);
                }
            }
            let (a, b) = primary.ends(nearest[first] as usize);
            let [c, d] = candidate.ends.map(|n| n as usize);
            for n in [a, b, c, d] {
                prefetch_index(at.x, n);
                prefetch_index(at.y, n);
                prefetch_index(at.vx, n);
                prefetch_index(at.vy, n);
            }
        }
    }

    /// Evaluates the pass: pushes forces and sums.
    pub(crate) fn evaluate(
        &mut self,
        surfaces: &[Surface],
        at: &Moment<'_>,
        w: &PassLaw,
        push: &mut Vec<Push>,
    ) -> Sum {
        if at.step < self.memory.idle_until {
            return Sum::default();
        }
        let Self { secondary, primary, points, arrangement, memory, deepest, .. } = self;
        Evaluation {
            memory,
            points,
            arrangement: *arrangement,
            secondary: &surfaces[*secondary],
            primary: &surfaces[*primary],
            deepest: *deepest,
            at,
            law: w,
            push,
        }
        .dispatch()
    }

    /// Visits the tangent of the points whose gap is below the law's reach, or `within` [m] where that is
    /// given, at positions `x`, `y`: that of the gap's gradient, with the gap [m]; the derivative of the
    /// gradient is neglected. Points that do not touch have the stiffness with which they would.
    pub(crate) fn tangent(
        &self,
        surfaces: &[Surface],
        [x, y]: [&[f64]; 2],
        w: &PassLaw,
        within: Option<f64>,
        visit: &mut dyn FnMut(RankOne<'_>, f64),
    ) {
        match [self.secondary, self.primary].map(|s| surfaces[s].spline().is_some()) {
            [false, false] => self.tangent_as::<ChordFacet, ChordFacet>(surfaces, [x, y], w, within, visit),
            [false, true] => self.tangent_as::<ChordFacet, SplineFacet>(surfaces, [x, y], w, within, visit),
            [true, false] => self.tangent_as::<SplineFacet, ChordFacet>(surfaces, [x, y], w, within, visit),
            [true, true] => self.tangent_as::<SplineFacet, SplineFacet>(surfaces, [x, y], w, within, visit),
        }
    }

    fn tangent_as<S: Facet, P: Facet>(
        &self,
        surfaces: &[Surface],
        [x, y]: [&[f64]; 2],
        w: &PassLaw,
        within: Option<f64>,
        visit: &mut dyn FnMut(RankOne<'_>, f64),
    ) {
        let reach = within.unwrap_or(w.reach());
        let (secondary, primary) = (&surfaces[self.secondary], &surfaces[self.primary]);
        let at = Moment { step: 0, time: 0.0, dt: 0.0, x, y, vx: x, vy: y };
        let (mut gradient, mut nodes, mut direction) = (Vec::new(), Vec::new(), Vec::new());
        for candidate in &self.memory.candidates {
            let facet = candidate.facet as usize;
            let own_facet = S::new(secondary, x, y, facet);
            let stride = self.arrangement.stride();
            for (i, of_point) in candidate.pattern.range().zip((candidate.first as usize..).step_by(stride)) {
                let point = own_facet.point(self.points.place[i], self.points.height[i]);
                let mut facet = P::new(primary, x, y, self.memory.nearest[of_point] as usize);
                let found = find_foot(&mut facet, primary, x, y, point.at);
                let Some(foot) = found.filter(|f| f.gap < reach && f.gap > -self.deepest) else {
                    continue;
                };
                let slope = if foot.gap < w.reach() { w.rounded(foot.gap)[1] } else { 1.0 };
                // The gap's gradient is the force that a unit pressure makes.
                gradient.clear();
                let (mut own, mut other) =
                    (MovingFacet::new(own_facet, secondary, &at), MovingFacet::new(facet, primary, &at));
                own.push_point(&point, foot.normal);
                other.push_foot(&foot, foot.normal, 1.0, 0.0);
                own.flush(secondary, &mut gradient);
                other.flush(primary, &mut gradient);
                nodes.clear();
                nodes.extend(gradient.iter().map(|(slot, _)| *slot));
                direction.clear();
                direction.extend(gradient.iter().flat_map(|(_, g)| *g));
                let stiffness = slope * w.law.stiffness * self.points.weight[i] * w.thickness;
                visit(RankOne { nodes: &nodes, direction: &direction, stiffness }, foot.gap);
            }
        }
    }
}
