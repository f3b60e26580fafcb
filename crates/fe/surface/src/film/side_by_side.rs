//! Films of eight bodies on one track, side by side in vectors: the law of [`FilmLaw::flow`].
//!
//! Each step takes one step of Newton's method from where the film ended in the last one, and further ones
//! only after a large correction. The remainder, less than a ten-thousandth of the force, is removed by the
//! next step.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::film::{
    law::{FAR, FIXED, FilmLaw, Layer, SLOWEST, STEADY},
    reynolds::{EMPTY, FilmForce, left_at_end, left_on_land},
    spring::SpringInLanes,
};

/// The place where a film ends is not corrected again after a correction by less than this share of one plus
/// its size, …
const NEAR: f64 = 1e-2;

/// … and films that need more corrections than this are taken one by one.
const MOST_CORRECTIONS: usize = 6;

/// Corrections of the force at a depth at most, and the share of its cube root at which the last one leaves
/// its square.
const SEARCHES: usize = 12;
const ENOUGH: f64 = 1e-5;

/// A number of each of eight films.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(64))]
pub struct Eight(pub [f64; LANES]);

/// State of eight films, as [`Layer`] of one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layers {
    above: Eight,
    end: Eight,
    force: Eight,
}

/// Where eight films lie: gaps [m], entrainment speeds [m/s], and the shares of the force that the land
/// leaves.
#[derive(Debug, Clone, Default)]
pub struct Gaps {
    /// Negative where the bodies overlap.
    pub gap: Eight,
    /// Half the sum of the speeds of both surfaces past the closest approach.
    pub speed: Eight,
    /// One where the land ends far off.
    pub share: Eight,
}

/// Parameters of a step.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// Length of the step [s].
    pub dt: f64,
    /// The films that are there, a bit for each.
    pub films: u64,
    /// Whether energies are computed.
    pub energy: bool,
}

/// Results of a step of eight films; zero where there is none.
#[derive(Debug, Clone, Default)]
pub struct PushedRows {
    /// Force that drives the surfaces apart, beside that of dry contact [N].
    pub force: Eight,
    /// Heat [J].
    pub heat: Eight,
    /// Decrease of that force as the surfaces recede and the film stays as thick as it is [N/m].
    pub stiffness: Eight,
    /// Energy in the springs beyond that of dry contact [J], where it is computed.
    pub stored: Eight,
    /// Those so thin and so pressed that nothing can change for some steps, a bit for each.
    pub fixed: u64,
}

impl Layers {
    /// That of one film.
    pub fn get(&self, lane: usize) -> Layer {
        Layer { above: self.above.0[lane], end: self.end.0[lane], force: self.force.0[lane] }
    }

    /// Replaces that of one film.
    pub fn set(&mut self, lane: usize, layer: &Layer) {
        (self.above.0[lane], self.end.0[lane]) = (layer.above, layer.end);
        self.force.0[lane] = layer.force;
    }
}

/// Solution of one vector of films.
struct Found<S: Simd> {
    above: Vector<S>,
    end: Vector<S>,
    force: Vector<S>,
    pushed: Vector<S>,
    heat: Vector<S>,
    stiffness: Vector<S>,
    stored: Vector<S>,
    fixed: u64,
    alone: u64,
}

/// Forces of dry contact and their growth with the depth.
struct Dry<S: Simd> {
    root: Vector<S>,
    force: Vector<S>,
    stiffness: Vector<S>,
}

impl<P: SpringInLanes> FilmLaw<P> {
    /// Advances eight films by a time step, as [`FilmLaw::flow`] does one.
    #[inline(always)]
    pub fn flow_eight<S: Simd>(
        &self,
        simd: S,
        layers: &mut Layers,
        at: &Gaps,
        wanted: Wanted,
        pushed: &mut PushedRows,
    ) {
        *pushed = PushedRows::default();
        let mut alone = 0;
        for start in vector_starts(simd) {
            let films = (wanted.films >> start) & ((1 << Vector::<S>::LEN) - 1);
            if films == 0 {
                continue;
            }
            let found = self.flow_vector(simd, layers, at, Wanted { films, ..wanted }, start);
            found.above.store(&mut layers.above.0, start);
            found.end.store(&mut layers.end.0, start);
            found.force.store(&mut layers.force.0, start);
            found.pushed.store(&mut pushed.force.0, start);
            found.heat.store(&mut pushed.heat.0, start);
            found.stiffness.store(&mut pushed.stiffness.0, start);
            found.stored.store(&mut pushed.stored.0, start);
            pushed.fixed |= found.fixed << start;
            alone |= found.alone << start;
        }
        while alone != 0 {
            self.flow_alone(alone.trailing_zeros() as usize, layers, at, wanted, pushed);
            alone &= alone - 1;
        }
    }

    /// One of eight films in scalar arithmetic.
    #[inline(never)]
    fn flow_alone(
        &self,
        lane: usize,
        layers: &mut Layers,
        at: &Gaps,
        wanted: Wanted,
        pushed: &mut PushedRows,
    ) {
        let mut layer = layers.get(lane);
        let [gap, speed, share] = [&at.gap, &at.speed, &at.share].map(|row| row.0[lane]);
        let by_film = self.flow(&mut layer, gap, speed, share, wanted.dt);
        layers.set(lane, &layer);
        (pushed.force.0[lane], pushed.heat.0[lane]) = (by_film.force, by_film.heat);
        let stiffness = |force: f64| if force > 0.0 { 1.0 / self.spring.depth(force).1 } else { 0.0 };
        pushed.stiffness.0[lane] = stiffness(layer.force) - stiffness(layer.force - by_film.force);
        if wanted.energy {
            pushed.stored.0[lane] = self.stored(&by_film);
        }
        pushed.fixed |= u64::from(by_film.fixed) << lane;
    }

    /// One vector of films from `start` on.
    #[inline(always)]
    fn flow_vector<S: Simd>(
        &self,
        simd: S,
        layers: &Layers,
        at: &Gaps,
        wanted: Wanted,
        start: usize,
    ) -> Found<S> {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, one, half, three) = (all(0.0), all(1.0), all(0.5), all(3.0));
        let had = Vector::load(simd, &layers.above.0, start);
        let before = Vector::load(simd, &layers.force.0, start);
        let ended = Vector::load(simd, &layers.end.0, start);
        let gap = Vector::load(simd, &at.gap.0, start);
        let speed = Vector::load(simd, &at.speed.0, start);
        let dry = (-gap).max(zero);
        let thickness = had + all(self.least);
        let speed = speed.times_plus(speed, all(SLOWEST * SLOWEST)).sqrt();
        let lift = all(self.wedge) * speed * Vector::load(simd, &at.share.0, start) / thickness;
        let opened = speed * thickness.sqrt() * all(self.slope * wanted.dt);
        let pressed = zero.bits_below(dry) & wanted.films;
        let contact = if pressed == 0 {
            Dry { root: zero, force: zero, stiffness: zero }
        } else {
            self.in_contact(simd, dry, before, pressed)
        };
        // Solid: contact alone acts.
        let loose = lift * all(self.steady);
        let carries = contact.force.choose_below(loose, zero, one);
        let solid = zero.choose_below(had, zero, zero.choose_below(dry, carries, zero));
        let still = (all(FIXED) * loose).choose_below(contact.force, solid, zero);

        let room = had - gap;
        let mut left = wanted.films & !solid.bits();
        let mut c = ended.max(all(EMPTY));
        let (mut end, mut carried, mut opens, mut stiffness) = (c, zero, zero, zero);
        for _ in 0..MOST_CORRECTIONS {
            if left == 0 {
                break;
            }
            let film = FilmForce::until(c);
            let force = lift * film.force;
            let these = Vector::ones(simd, left);
            let root = half.choose_below(these, force.cube_root(), zero);
            let [depth, by_root] = self.spring.depth_of(simd, root);
            let stiff = three * root * root / by_root;
            let grows = lift * film.force_slope;
            // Residual of Newton's method: depth under the force less that left by the film, times the
            // stiffness.
            let over = (depth - opened.times_plus(film.opening, room)) * stiff;
            let slope = grows - opened * film.opening_slope * stiff;
            let change = -(over / slope);
            let next = c + change;
            end = half.choose_below(these, next, end);
            carried = half.choose_below(these, grows.times_plus(change, force), carried);
            opens = half.choose_below(these, film.opening_slope.times_plus(change, film.opening), opens);
            stiffness = half.choose_below(these, stiff, stiffness);
            let enough = all(NEAR) * (one + c.max(-c));
            left &= !change.max(-change).bits_below(enough);
            c = next.max(all(EMPTY));
        }
        let above = opened.times_plus(opens, had);
        // A film that cannot follow the surfaces, or that has collapsed.
        let ends = end.choose_below(all(EMPTY), one, above.choose_below(zero, one, zero));
        let alone = left | (ends.bits() & wanted.films & !solid.bits());
        let force = carried.max(zero);
        let heat = half * (before + force) * (had - above);
        let stored = if wanted.energy {
            let of_film = self.spring.energy_at(simd, force.cube_root());
            of_film - self.spring.energy_at(simd, contact.root)
        } else {
            zero
        };
        let flows = Vector::ones(simd, wanted.films & !solid.bits() & !alone);
        let held = Vector::ones(simd, wanted.films & solid.bits());
        Found {
            above: half.choose_below(flows, above, had),
            end: half.choose_below(flows, end, half.choose_below(held, all(STEADY), ended)),
            force: half.choose_below(flows, force, half.choose_below(held, contact.force, before)),
            pushed: half.choose_below(flows, force - contact.force, zero),
            heat: half.choose_below(flows, heat, zero),
            stiffness: half.choose_below(flows, stiffness - contact.stiffness, zero),
            stored: half.choose_below(flows, stored, zero),
            fixed: still.bits() & wanted.films,
            alone,
        }
    }

    /// Dry contact at depths [m], the forces of which are about `guess` [N], where `films` are pressed into
    /// each other.
    #[inline(always)]
    fn in_contact<S: Simd>(&self, simd: S, depth: Vector<S>, guess: Vector<S>, films: u64) -> Dry<S> {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, three) = (all(0.0), all(3.0));
        let most = self.spring.largest_root(simd, depth);
        let these = Vector::ones(simd, films);
        let root = zero.choose_below(guess, guess.cube_root(), most);
        let mut root = all(0.5).choose_below(these, root, zero);
        let mut slope = zero;
        for _ in 0..SEARCHES {
            let [given, steep] = self.spring.depth_of(simd, root);
            let by = (given - depth) / steep;
            slope = steep;
            // No more than the softer of two springs would take.
            root = (root - by).min(most);
            if (all(ENOUGH) * root).bits_below(by.max(-by)) & films == 0 {
                break;
            }
        }
        let (square, half) = (root * root, all(0.5));
        Dry {
            root: half.choose_below(these, root, zero),
            force: half.choose_below(these, square * root, zero),
            stiffness: half.choose_below(these, three * square / slope, zero),
        }
    }

    /// Shares of the forces that remain on lands whose ends lie at these distances [m], as
    /// [`FilmLaw::share`], of the films from `start` on.
    #[inline(always)]
    pub fn shares<S: Simd>(
        &self,
        simd: S,
        ends: [Vector<S>; 2],
        tilt: Vector<S>,
        layers: &Layers,
        start: usize,
    ) -> Vector<S> {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, one, far) = (all(0.0), all(1.0), all(FAR));
        let thickness = Vector::load(simd, &layers.above.0, start) + all(self.least);
        let per_metre = all(self.slope) / thickness.sqrt();
        let beyond = -(tilt.max(-tilt) * all(self.radius));
        let mut share = one;
        for end in ends {
            let edge = zero.choose_below(end, end, beyond) * per_metre;
            if edge.bits_below(far) == 0 {
                continue;
            }
            let left = zero.choose_below(edge, left_on_land(edge), left_at_end(-edge));
            share = share * edge.choose_below(far, left, one);
        }
        share
    }
}
