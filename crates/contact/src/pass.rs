//! One pass: the points of a secondary surface against the facets of a primary one.

use std::{ops::Range, sync::Arc};

use prefetch_index::prefetch_index;
use pulp::Arch;
use serde::{Deserialize, Serialize};
use stribeck_simd::{field::Field, lanes::LANES};
use stribeck_solver::{force::RankOne, state::Moment};

use crate::{
    band,
    evaluation::Evaluation,
    law::Law,
    nearest::Nearest,
    points::{Pattern, Points},
    projection::Frame,
    shape::{Push, Shape, Side},
    spline::Patch,
    surface::Surface,
    touch::{Histories, Sum},
};

/// One pass of a pair.
#[derive(Debug, Clone)]
pub(crate) struct Pass {
    pub(crate) secondary: usize,
    pub(crate) primary: usize,
    pub(crate) points: Arc<Points>,
    pub(crate) arrangement: Arrangement,
    pub(crate) memory: Memory,
    /// Deeper penetrations than this are not contacts but other sides of a body [m].
    pub(crate) deepest: f64,
    /// About how long the last evaluation took, in units of some ten nanoseconds.
    pub(crate) work: usize,
    /// Apart, so that what every step reads lies close together.
    room: Box<Room>,
}

/// Room for a search.
#[derive(Debug, Clone)]
struct Room {
    /// The memory before it.
    before: Memory,
    /// Facets nearest to the points of one.
    found: Vec<u32>,
}

/// What a pass remembers from step to step: of the points of its candidates alone, as its [`Arrangement`] says, so that what is
/// read in every step lies close together. Facets of many points have whole vectors of room, each in a line of cache; behind
/// the last point there is room for a vector that reads on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Memory {
    pub(crate) candidates: Vec<Candidate>,
    /// Facet of the primary surface on which each point was last found.
    pub(crate) nearest: Vec<u32>,
    /// Steps after the search before which each point cannot touch; it wakes in the step that holds the last of them.
    pub(crate) doze: Field,
    /// What points in contact remember; `None` without damping and friction.
    pub(crate) history: Option<Histories>,
    /// Fastest that a point of the pass opened or closed of late [m/s].
    pub(crate) pace: f64,
    /// Step of the last search.
    pub(crate) searched: u64,
    /// No candidate wakes before this step.
    pub(crate) asleep: u64,
}

/// A facet that may touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Candidate {
    /// Not before this step.
    pub(crate) wake: u64,
    pub(crate) facet: u32,
    /// First of its points in what the pass remembers.
    pub(crate) first: u32,
    pub(crate) pattern: Pattern,
    /// Slots of its ends.
    pub(crate) ends: [u32; 2],
}

impl Candidate {
    /// Its points in what the pass remembers, where it remembers them row by row.
    #[inline(always)]
    pub(crate) fn range(&self) -> Range<usize> {
        self.first as usize..(self.first + self.pattern.points) as usize
    }
}

/// How what a pass remembers of points lies in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Arrangement {
    /// Facet by facet.
    Rows,
    /// [`LANES`] facets side by side, whatever the instruction set: the first point of each, then the second of each, and so
    /// on.
    Bands {
        /// Points that a facet has room for.
        points: usize,
    },
}

impl Arrangement {
    /// Distance of a facet's points.
    #[inline(always)]
    pub(crate) fn stride(self) -> usize {
        match self {
            Self::Rows => 1,
            Self::Bands { .. } => LANES,
        }
    }

    /// First point of the facet after `before` others that take `taken` places, and places that are taken with it.
    fn next(self, before: usize, taken: usize, pattern: Pattern) -> (usize, usize) {
        match self {
            Self::Rows => (taken, taken + pattern.room() as usize),
            Self::Bands { points } => {
                let (band, lane) = (before / LANES * LANES * points, before % LANES);
                (band + lane, band + LANES * points)
            }
        }
    }
}

impl Memory {
    /// Of no candidates.
    fn new(remembers: bool) -> Self {
        let mut memory = Self { history: remembers.then(Histories::default), ..Self::default() };
        memory.clear();
        memory.pad();
        memory
    }

    /// Forgets all candidates.
    fn clear(&mut self) {
        self.candidates.clear();
        self.nearest.clear();
        self.doze.clear();
        if let Some(history) = &mut self.history {
            history.slip.clear();
            history.damping.clear();
        }
    }

    /// Makes room behind the last point.
    fn pad(&mut self) {
        let padded = self.nearest.len() + LANES;
        self.doze.resize(padded);
        if let Some(history) = &mut self.history {
            history.slip.resize(padded);
            history.damping.resize(padded);
        }
    }

    /// Makes room for the points of one more candidate; the number of the first.
    fn room_for(&mut self, pattern: Pattern, arrangement: Arrangement) -> usize {
        let (first, taken) = arrangement.next(self.candidates.len(), self.nearest.len(), pattern);
        self.nearest.resize(taken, 0);
        // Places without a point never wake.
        while self.doze.len() < taken {
            self.doze.push(NEVER);
        }
        if let Some(history) = &mut self.history {
            history.slip.resize(taken);
            history.damping.resize(taken);
        }
        first
    }

    /// Sets a point; one that was `known` as number `i` of another memory takes its history along.
    fn set(&mut self, point: usize, nearest: u32, doze: f64, known: Option<(&Self, usize)>) {
        (self.nearest[point], self.doze[point]) = (nearest, doze);
        if let (Some(history), Some((memory, i))) = (&mut self.history, known)
            && let Some(past) = &memory.history
        {
            history.set(point, past.get(i));
        }
    }
}

/// Speeds are allowed for with this margin until the next look.
pub(crate) const SPEED_MARGIN: f64 = 2.0;

/// Least speed allowed for until then [m/s]: what an impact may give to a surface at rest.
pub(crate) const LEAST_SPEED: f64 = 2.0;

/// A point allows for this part of the fastest approach too: bodies turn by less than a tenth while it dozes.
const FASTEST_OVER: f64 = 16.0;

/// What is left of a pass's pace from one evaluation to the next.
pub(crate) const PACE_KEPT: f64 = 0.99;

/// Longest time between two searches or looks at a point, in steps: speeds may change meanwhile.
pub(crate) const LONGEST_REST: f64 = 400.0;

/// Steps that a point without a foot dozes: until the next search.
pub(crate) const NEVER: f64 = 1e9;

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

impl Weights {
    /// Larger gaps than this carry nothing [m].
    #[inline(always)]
    pub(crate) fn reach(&self) -> f64 {
        // Beyond 30 softnesses the rounded law is below 1e-13 of one softness of penetration.
        if self.softness > 0.0 { 30.0 * self.softness } else { self.law.onset }
    }

    /// Steps that a point with this gap, sliding so, stays away for certain in a pass of this pace (THEORY §4.1).
    #[inline(always)]
    pub(crate) fn steps_apart(&self, gap: f64, sliding: f64, pace: f64, dt: f64) -> f64 {
        let closing = SPEED_MARGIN * (pace + sliding.abs()) + self.least_speed();
        ((gap - self.reach()).abs() / (closing.min(self.fastest) * dt)).min(LONGEST_REST)
    }

    /// Approach allowed for however slow a point is [m/s].
    pub(crate) fn least_speed(&self) -> f64 {
        LEAST_SPEED.max(self.fastest / FASTEST_OVER)
    }

    /// Effective penetration [m] and its slope [-] at a gap (THEORY §3.2).
    pub(crate) fn rounded(&self, gap: f64) -> [f64; 2] {
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

/// Slots of the ends of a facet.
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
                && points.most <= band::MOST_POINTS
            {
                Arrangement::Bands { points: points.most }
            } else {
                Arrangement::Rows
            },
            points,
            work: 0,
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
            && memory.doze.len() == n + LANES
            && memory.doze.iter().all(|doze| doze.is_finite())
            && memory.history.is_some() == self.memory.history.is_some()
            && memory.history.as_ref().is_none_or(|history| history.serve(n))
            && memory.nearest.iter().all(|&facet| (facet as usize) < facets)
    }

    /// Goes on from a memory.
    pub(crate) fn remember(&mut self, memory: Memory) {
        self.memory = memory;
    }

    /// Takes new candidates from pairs (secondary facet, primary facet), ascending. Points of facets that were candidates
    /// before go on from what they remember, but where another part of the primary surface has come nearer; they doze for
    /// as much less time as the fastest approach was `slower` in the search before.
    pub(crate) fn take(&mut self, pairs: &[(u32, u32)], surfaces: &[Surface], at: &Moment<'_>, slower: f64) {
        let (secondary, primary) = (&surfaces[self.secondary], &surfaces[self.primary]);
        let Self { points, arrangement, memory, room, .. } = self;
        let stride = arrangement.stride();
        let Room { before, found } = &mut **room;
        std::mem::swap(memory, before);
        memory.clear();
        (memory.pace, memory.searched, memory.asleep) = (before.pace, at.step, 0);
        let elapsed = at.step.saturating_sub(before.searched) as f64;
        let mut old = before.candidates.iter().peekable();
        for pairs in pairs.chunk_by(|a, b| a.0 == b.0) {
            let facet = pairs[0].0;
            let pattern = points.of_facet[facet as usize];
            let first = memory.room_for(pattern, *arrangement);
            Arch::new().dispatch(Nearest {
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
                let (mut nearest, mut doze) = (new, 0.0);
                if let Some(i) = known.filter(|&i| primary.adjoin(before.nearest[i] as usize, new as usize)) {
                    nearest = before.nearest[i];
                    // Whoever had no foot looks again.
                    doze = if before.doze[i] == NEVER { 0.0 } else { slower * (before.doze[i] - elapsed) };
                }
                soonest = soonest.min(doze);
                memory.set(first + k * stride, nearest, doze, known.map(|i| (&*before, i)));
            }
            let wake = at.step.saturating_add(soonest.max(0.0) as u64);
            let (first, ends) = (first as u32, ends(secondary, facet));
            memory.candidates.push(Candidate { wake, facet, first, pattern, ends });
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

    /// Fetches what an evaluation of rows begins with, of all facets that are awake: between two steps the elements push it out
    /// of the near caches, and so it is on its way while the first facets are evaluated.
    pub(crate) fn fetch(&self, surfaces: &[Surface], at: &Moment<'_>) {
        let Memory { nearest, doze, history, candidates, asleep, .. } = &self.memory;
        // Facets with few points follow one another in memory as they are read.
        if at.step < *asleep || self.arrangement != Arrangement::Rows {
            return;
        }
        let primary = &surfaces[self.primary];
        for candidate in candidates.iter().filter(|c| at.step >= c.wake) {
            let (first, n) = (candidate.first as usize, candidate.pattern.points as usize);
            for i in (first..first + n).step_by(LANES) {
                prefetch_index(&doze[..], i);
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
        w: &Weights,
        push: &mut Vec<Push>,
    ) -> Sum {
        self.work = 0;
        if at.step < self.memory.asleep {
            return Sum::default();
        }
        Evaluation { pass: self, surfaces, at, w, push }.dispatch()
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
            let stride = self.arrangement.stride();
            for (i, of_point) in candidate.pattern.range().zip((candidate.first as usize..).step_by(stride)) {
                let spot = shape.spot(self.points.place[i], self.points.height[i]);
                let mut foot = P::new(primary, x, y, self.memory.nearest[of_point] as usize);
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
