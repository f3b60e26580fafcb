//! All contacts of a model: one more force on nodes.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use stribeck_simd::threads::{Met, share_out, share_out_beside};
use stribeck_solver::{
    Force,
    force::RankOne,
    state::{Energy, Moment, NodeForces},
};

use crate::{
    broad_phase::Tree,
    kernel::evaluate::Sum,
    memory::Memory,
    pass::Pass,
    pass_law::{LEAST_SPEED, MOST_STEPS_APART, PassLaw, SPEED_MARGIN},
    points::{Method, Points},
};
use stribeck_surface::{Error, Law, Surface, foot::Push};

/// Two surfaces that may touch.
#[derive(Debug, Clone, Copy)]
pub struct PairSpec {
    /// Index of one surface; the resultant of the pair is the force on its body.
    pub first: usize,
    /// Index of the other.
    pub second: usize,
    /// Law between them.
    pub law: Law,
    /// Where it acts.
    pub method: Method,
    /// Whose points are evaluated.
    pub sides: Sides,
}

/// Whose points a pair evaluates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// Those of either surface against the other, each with half of the stiffness.
    Both,
    /// Those of the first surface alone. Half the work; its points must be closer than the other's features.
    First,
}

/// State of one pair.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Resultant {
    /// Force on the first surface's body [N].
    pub force: [f64; 2],
    /// Deepest penetration [m].
    pub penetration: f64,
}

/// State of contact from step to step, for checkpoints: continued from it, contact computes the same bits.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// Of each pass of each pair.
    passes: Vec<Memory>,
    search: Schedule,
    /// Heat since the start [J].
    friction: f64,
    damping: f64,
}

/// When to search again, and the speed that this counts on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Schedule {
    next: u64,
    /// Fastest approach of two points [m/s].
    fastest: f64,
    /// Whether the states of points are void: Newton's method moves nodes by jumps.
    afresh: bool,
}

/// All contacts of a model.
#[derive(Debug)]
pub struct Contacts {
    surfaces: Vec<Surface>,
    trees: Vec<Tree>,
    pairs: Vec<Pair>,
    /// Room for the forces of a pair.
    push: Vec<Push>,
    /// Where two threads met among the pairs.
    met: Met,
    thickness: f64,
    skin: f64,
    search: Schedule,
    preload: Option<f64>,
    parallel: bool,
    together: bool,
    energy: Energy,
}

#[derive(Debug)]
struct Pair {
    spec: PairSpec,
    /// The first surface's points against the second, then, if wanted, the other way round.
    passes: Vec<Pass>,
    found: Vec<(u32, u32)>,
    result: PairResult,
}

/// Results of a pair in the last step, in one place and not written by an idle pair: one thread reads those
/// of all pairs, and cache lines written by another core are slow to load.
#[derive(Debug, Default)]
struct PairResult {
    /// Nothing acts before this step.
    idle_until: u64,
    /// How long it took, in units of some ten nanoseconds; zero for an idle pair.
    work: usize,
    /// Of each pass.
    sum: [Sum; 2],
    /// Forces that are added later; empty between two steps.
    push: Vec<Push>,
}

/// Points of all surfaces. Surfaces of one shape share theirs, so that they stay in cache from one pass to
/// the next.
#[derive(Default)]
struct Patterns(Vec<(usize, Method, Arc<Points>)>);

impl Patterns {
    /// Those of a surface of this number.
    fn of(&mut self, number: usize, surface: &Surface, method: Method) -> Arc<Points> {
        if let Some((.., points)) = self.0.iter().find(|(n, m, _)| (*n, *m) == (number, method)) {
            return Arc::clone(points);
        }
        let new = Points::new(surface, method);
        let length = surface.mean_length();
        let alike = self.0.iter().find(|(_, m, points)| *m == method && points.are_alike(&new, length));
        let points = alike.map_or_else(|| Arc::new(new), |(.., points)| Arc::clone(points));
        self.0.push((number, method, Arc::clone(&points)));
        points
    }
}

/// Points that are spaced by three quarters of the nodes' distance, one of them on a node, load it by this
/// factor of the mean; no other spacing has a larger one.
const CLUSTERING: f64 = 1.125;

/// The square of the gap's gradient exceeds one by at most this times the square of a curve's slope: once for
/// the normal, half for the turn of the curve that the foot lies on, as much for that of the point.
const STEEPER: f64 = 2.0;

impl Contacts {
    /// Contacts between `surfaces`, in positions `x`, `y` [m] by slot. `thickness` [m] is out of plane.
    ///
    /// Two threads take pairs from either end of the list. The pair with by far the most work had better
    /// stand first, where forces are added at once, and those of one body together.
    ///
    /// # Errors
    /// When a pair names a surface that is not there or one twice, a surface a slot that is not there, a
    /// method no points or too many, or the thickness is not positive.
    pub fn new(
        surfaces: Vec<Surface>,
        pairs: &[PairSpec],
        thickness: f64,
        x: &[f64],
        y: &[f64],
    ) -> Result<Self, Error> {
        check(&surfaces, pairs, thickness, x.len().min(y.len()))?;
        let shortest =
            surfaces.iter().flat_map(|s| s.lengths()).copied().fold(f64::INFINITY, f64::min).min(1.0);
        let mean = surfaces.iter().map(Surface::mean_length).fold(f64::INFINITY, f64::min);
        let skin = 0.4 * mean.max(shortest);
        let trees = surfaces.iter().map(|s| Tree::new(s, x, y, 0.5 * skin + s.largest_sag())).collect();
        let mut patterns = Patterns::default();
        let pairs = pairs
            .iter()
            .map(|spec| {
                let mut pass = |secondary: usize, primary: usize| {
                    let points = patterns.of(secondary, &surfaces[secondary], spec.method);
                    Pass::new(secondary, primary, points, &spec.law, &surfaces)
                };
                Pair {
                    spec: *spec,
                    passes: match spec.sides {
                        Sides::Both => vec![pass(spec.first, spec.second), pass(spec.second, spec.first)],
                        Sides::First => vec![pass(spec.first, spec.second)],
                    },
                    found: Vec::new(),
                    result: PairResult::default(),
                }
            })
            .collect();
        Ok(Self {
            surfaces,
            trees,
            pairs,
            push: Vec::new(),
            met: Met::default(),
            thickness,
            skin,
            search: Schedule::default(),
            preload: None,
            parallel: false,
            together: true,
            energy: Energy::default(),
        })
    }

    /// Evaluates pairs in parallel from now on; the result is the same to the bit.
    pub fn set_parallel(&mut self, parallel: bool) {
        self.parallel = parallel;
    }

    /// Evaluates points one by one from now on, the plain way that whole vectors of points are checked
    /// against. Sums differ by rounding.
    pub fn set_together(&mut self, together: bool) {
        self.together = together;
    }

    /// For a static preload: leaves damping and friction out and rounds the corner of the penalty law over a
    /// gap of `softness` [m] (zero for the sharp law), so that Newton's method sees bodies before they touch.
    /// `None` restores the full law.
    pub fn set_preload(&mut self, softness: Option<f64>) {
        self.preload = softness;
        (self.search.next, self.search.afresh) = (0, true);
    }

    /// State of each pair, in the order of their specification.
    pub fn resultants(&self) -> impl Iterator<Item = Resultant> {
        self.pairs.iter().map(|p| {
            let [a, b] = &p.result.sum;
            Resultant {
                force: [a.force[0] - b.force[0], a.force[1] - b.force[1]],
                penetration: a.penetration.max(b.penetration),
            }
        })
    }

    /// Slots that contact may push.
    pub fn slots(&self) -> impl Iterator<Item = u32> {
        self.surfaces.iter().flat_map(|s| s.slots.iter().copied())
    }

    /// State of contact, for a checkpoint.
    pub fn state(&self) -> ContactState {
        ContactState {
            passes: self.passes().map(|pass| pass.memory.clone()).collect(),
            search: self.search,
            friction: self.energy.friction,
            damping: self.energy.damping,
        }
    }

    /// Restores a state; false when it belongs to other contacts, and nothing is changed then.
    pub fn restore(&mut self, state: ContactState) -> bool {
        let fits = |(pass, memory): (&Pass, &Memory)| pass.can_remember(memory, &self.surfaces);
        if self.passes().count() != state.passes.len() || !self.passes().zip(&state.passes).all(fits) {
            return false;
        }
        for (pass, memory) in self.pairs.iter_mut().flat_map(|p| &mut p.passes).zip(state.passes) {
            pass.remember(memory);
        }
        self.pairs.iter_mut().for_each(|pair| pair.result.idle_until = 0);
        self.search = state.search;
        self.energy.friction = state.friction;
        self.energy.damping = state.damping;
        true
    }

    fn passes(&self) -> impl Iterator<Item = &Pass> {
        self.pairs.iter().flat_map(|p| &p.passes)
    }

    fn search(&mut self, at: &Moment<'_>) {
        let grow = 0.5 * self.skin;
        if self.search.afresh {
            self.pairs.iter_mut().flat_map(|pair| &mut pair.passes).for_each(Pass::forget_candidates);
        }
        for (tree, surface) in self.trees.iter_mut().zip(&self.surfaces) {
            tree.update(surface, at.x, at.y, grow + surface.largest_sag());
        }
        let square = |&n: &u32| at.vx[n as usize] * at.vx[n as usize] + at.vy[n as usize] * at.vy[n as usize];
        let fastest = self.surfaces.iter().flat_map(|s| &s.slots).map(square).fold(0.0, f64::max).sqrt();
        // Two points may approach each other, each at the highest speed.
        let fastest = 2.0 * (SPEED_MARGIN * fastest).max(LEAST_SPEED);
        // Points that are inactive count on the speed of the search before.
        let slower = (self.search.fastest / fastest).min(1.0);
        let threads = self.threads();
        let Self { trees, surfaces, pairs, push, .. } = self;
        let find = |pair: &mut Pair| {
            trees[pair.spec.first].pairs(&trees[pair.spec.second], &mut pair.found);
            for pass in &mut pair.passes {
                if pass.secondary != pair.spec.first {
                    pair.found.iter_mut().for_each(|(a, b)| std::mem::swap(a, b));
                    pair.found.sort_unstable();
                }
                pass.take(&pair.found, surfaces, at, slower);
            }
            pair.result.push.reserve(pair.passes.iter().map(Pass::most_pushes).sum());
            pair.result.idle_until = 0;
        };
        share_out(pairs, threads, LEAST_WORK, &|pair| LEAST_WORK + pair.found.len(), &find);
        push.reserve(pairs.iter().map(|pair| pair.result.push.capacity()).max().unwrap_or(0));
        let rest = if at.dt > 0.0 { self.skin / (fastest * at.dt) } else { 0.0 };
        let next = at.step + rest.clamp(1.0, MOST_STEPS_APART) as u64;
        self.search = Schedule { next, fastest, afresh: self.preload.is_some() };
    }

    /// Counts the energies of the last step, in the order of the pairs.
    fn count_energies(&mut self) {
        self.energy.stored = 0.0;
        for PairResult { sum, .. } in self.pairs.iter().map(|pair| &pair.result).filter(|r| r.work > 0) {
            for sum in sum {
                self.energy.stored += sum.stored;
                self.energy.friction += sum.friction;
                self.energy.damping += sum.damping;
            }
        }
    }

    /// Threads to share pairs out over.
    fn threads(&self) -> usize {
        if self.parallel { micropool::num_threads() + 1 } else { 1 }
    }

    /// Visits the springs of contact of one pair at positions `x`, `y` [m], those last given to `accumulate`,
    /// with their gaps [m]: those of points that touch, and of those nearer than `within` [m], as if they
    /// did.
    pub fn springs_within(
        &self,
        pair: usize,
        [x, y]: [&[f64]; 2],
        within: f64,
        visit: &mut dyn FnMut(RankOne<'_>, f64),
    ) {
        let pair = &self.pairs[pair];
        let law = self.weights(&pair.spec);
        for pass in &pair.passes {
            pass.tangent(&self.surfaces, [x, y], &law, Some(within), visit);
        }
    }

    fn weights(&self, spec: &PairSpec) -> PassLaw {
        weights(spec, self.thickness, self.search.fastest, self.preload, self.together)
    }
}

impl Pair {
    /// About how much there is to do, judged by the step before.
    fn work(&self) -> usize {
        1 + self.result.work
    }

    /// Evaluates both passes.
    fn evaluate(
        &mut self,
        surfaces: &[Surface],
        at: &Moment<'_>,
        weights: &impl Fn(&PairSpec) -> PassLaw,
        push: &mut Vec<Push>,
    ) {
        let result = &mut self.result;
        if at.step < result.idle_until {
            if result.work > 0 {
                (result.work, result.sum) = (0, [Sum::default(); 2]);
            }
            return;
        }
        let w = weights(&self.spec);
        self.passes.iter().for_each(|pass| pass.fetch(surfaces, at));
        (result.work, result.idle_until) = (0, u64::MAX);
        for (pass, sum) in self.passes.iter_mut().zip(&mut result.sum) {
            *sum = pass.evaluate(surfaces, at, &w, push);
            result.work += sum.work;
            result.idle_until = result.idle_until.min(pass.memory.idle_until);
        }
    }
}

/// Less work than this is not worth another thread: a fork and join takes some microseconds.
const LEAST_WORK: usize = 400;

/// Checks combinations of fields that contact cannot compute.
fn check(surfaces: &[Surface], pairs: &[PairSpec], thickness: f64, slots: usize) -> Result<(), Error> {
    if !(thickness > 0.0 && thickness.is_finite()) {
        return Err(Error::OutOfRange { field: "thickness [m]", value: thickness, allowed: "positive" });
    }
    for surface in surfaces {
        if surface.slots.iter().any(|&s| s as usize >= slots) {
            let reason = "lists a slot for which there is no position";
            return Err(Error::BadSurface { name: surface.name.clone(), reason });
        }
    }
    for (pair, spec) in pairs.iter().enumerate() {
        let bad = |reason| Err(Error::BadPair { pair, reason });
        if spec.first.max(spec.second) >= surfaces.len() {
            return bad("names a surface that is not in the list");
        }
        if spec.first == spec.second {
            return bad("names one surface twice; a body does not touch itself");
        }
        if let Method::Integrated { points } = spec.method
            && !(1..=Method::MOST_POINTS).contains(&points)
        {
            return bad("needs 1 to 32 integration points on a facet");
        }
    }
    Ok(())
}

/// Two passes carry half of the stiffness each.
fn weights(spec: &PairSpec, thickness: f64, fastest: f64, preload: Option<f64>, together: bool) -> PassLaw {
    let law = if preload.is_some() { Law { damping: 0.0, friction: 0.0, ..spec.law } } else { spec.law };
    let share = if spec.sides == Sides::Both { 0.5 } else { 1.0 };
    let softness = preload.unwrap_or(0.0);
    PassLaw { law, thickness: share * thickness, fastest, softness, together }
}

/// Adds forces at nodes, and leaves none.
fn hand_over(push: &mut Vec<Push>, to: &mut NodeForces) {
    for (slot, [fx, fy]) in push.drain(..) {
        to.fx[slot as usize] += fx;
        to.fy[slot as usize] += fy;
    }
}

impl Contacts {
    /// [`Force::accumulate`], and `beside` meanwhile: on the second of two threads, before it takes pairs.
    pub fn accumulate_beside(
        &mut self,
        at: Moment<'_>,
        force: &mut NodeForces,
        beside: impl FnOnce() + Send,
    ) {
        if at.step >= self.search.next || self.preload.is_some() {
            self.search(&at);
        }
        let threads = self.threads();
        let Self { surfaces, pairs, thickness, search, preload, together, push, met, .. } = self;
        let weights = |spec: &PairSpec| weights(spec, *thickness, search.fastest, *preload, *together);
        // Pushes are added in the order of the pairs. Those of the first ones can be added at once, while
        // they are in cache.
        let mut at_once = |pair: &mut Pair| {
            pair.evaluate(surfaces, &at, &weights, push);
            hand_over(push, force);
        };
        let later = |pair: &mut Pair| {
            let mut push = std::mem::take(&mut pair.result.push);
            pair.evaluate(surfaces, &at, &weights, &mut push);
            pair.result.push = push;
        };
        share_out_beside(pairs, threads, LEAST_WORK, &Pair::work, met, beside, &mut at_once, &later);
        self.pairs.iter_mut().for_each(|pair| hand_over(&mut pair.result.push, force));
        self.count_energies();
    }
}

impl Force for Contacts {
    fn accumulate(&mut self, at: Moment<'_>, force: &mut NodeForces) {
        self.accumulate_beside(at, force, || {});
    }

    fn energy(&self) -> Energy {
        self.energy
    }

    fn stiffness_bound(&self, dt: f64, bound: &mut [f64]) {
        // A contact spring pulls on the difference of two displacements, (a − b)² ≤ 2a² + 2b², in each of two
        // passes of half the stiffness. A surface touches one other at a time, so pairs do not add up.
        let mut own = vec![0.0_f64; bound.len()];
        for pair in &self.pairs {
            let law = &pair.spec.law;
            let lagged = if dt > 0.0 { law.damping_stiffness(dt) } else { 0.0 };
            let k = (law.stiffness + lagged) * self.thickness;
            // The gap's gradient is a little longer than one where a curve leaves its chord (THEORY §4.4).
            let steepest = [pair.spec.first, pair.spec.second].map(|s| self.surfaces[s].steepest());
            let k = k * (1.0 + STEEPER * (steepest[0] * steepest[0] + steepest[1] * steepest[1]));
            let share = if pair.spec.sides == Sides::Both { 1.0 } else { 2.0 };
            let points = |surface| pair.passes.iter().find(|p| p.secondary == surface).map(|p| &*p.points);
            for (this, that) in [(pair.spec.first, pair.spec.second), (pair.spec.second, pair.spec.first)] {
                let surface = &self.surfaces[this];
                let held = points(this).map(|p| p.on_nodes(surface));
                // Points of the other surface load this one's nodes wherever they lie.
                let other = points(that).map(Points::largest_weight);
                let uneven = surface.unevenness();
                for (v, (&slot, length)) in surface.slots.iter().zip(surface.tributary()).enumerate() {
                    let dealt = other.map_or(0.0, |other| CLUSTERING * length.max(other) * uneven[v]);
                    let weight = held.as_ref().map_or(0.0, |held| held[v]);
                    own[slot as usize] = own[slot as usize].max(share * k * (weight + dealt));
                }
            }
        }
        bound.iter_mut().zip(own).for_each(|(b, k)| *b += k);
    }

    fn tangent(&self, x: &[f64], y: &[f64], visit: &mut dyn FnMut(RankOne<'_>)) {
        for pair in &self.pairs {
            for pass in &pair.passes {
                let law = self.weights(&pair.spec);
                pass.tangent(&self.surfaces, [x, y], &law, None, &mut |piece, _| visit(piece));
            }
        }
    }
}
