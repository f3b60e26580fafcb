//! Oil between round bodies and their tracks: squeeze and rolling entrainment, without suction (THEORY §4.6).
//!
//! A film is one more force on nodes. It lies in series with the springs of contact: the gap between the
//! nodes' curves is the film's thickness less the deflection of the surfaces under its pressure. So its force
//! depends on positions alone, is never tensile, and is no stiffer than contact.

use serde::{Deserialize, Serialize};

use stribeck_solver::{
    Force,
    force::RankOne,
    state::{Energy, Moment, NodeForces},
};
use stribeck_surface::film::{Bed, FilmLaw, Land, Layer, Oil, Place, Pushed, Spring, WIDEST};

use stribeck_surface::{Error, Smoothing, Surface};

/// Steps from one look for the nearest places to the next; in between the film stays at the nodes where it
/// was.
const LOOK_EVERY: u64 = 16;

/// Steps between two looks at a film that is too thick to push.
const REST: u64 = 128;

/// Looks over which the speed of rolling is taken, and the shortest time [s]: nodes that shake move the
/// nearest places to and fro.
const SPEED_EVERY: u64 = 4;
const SPEED_OVER: f64 = 4e-6;

/// A round body on a surface, with oil between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmSpec {
    /// Number of the round body's surface.
    pub round: usize,
    /// Slot of the node in its centre.
    pub centre: u32,
    /// Number of the surface that it rolls on.
    pub track: usize,
    /// The oil.
    pub oil: Oil,
    /// Penalty stiffness of the contact of the two [Pa/m].
    pub stiffness: f64,
    /// Length out of plane [m].
    pub length: f64,
    /// Initial entrainment speed [m/s]: half the sum of the speeds of both surfaces relative to the contact.
    pub speed: f64,
}

/// State of a film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmResultant {
    /// Force on the round body [N].
    pub force: [f64; 2],
    /// Film thickness [m]; a millimetre where there is none, the widest that holds one.
    pub thickness: f64,
}

/// State of all films: everything that changes in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FilmState {
    films: Vec<Memory>,
    heat: f64,
}

/// All films of a model.
#[derive(Debug)]
pub struct Films {
    surfaces: Vec<Surface>,
    films: Vec<Film>,
    /// First film of each spec, and one more.
    first: Vec<usize>,
    /// Whether films are those of steady rolling, in a static preload.
    preload: bool,
    heat: f64,
}

/// The film of a round body on one land.
#[derive(Debug, Clone)]
struct Film {
    round: usize,
    track: usize,
    centre: u32,
    /// Of the track, and all of the round body.
    lands: [Land; 2],
    law: FilmLaw<Bed>,
    memory: Memory,
    /// Nodes that it depends on, which follow from its places.
    nodes: [u32; 4],
    /// Results of the last step.
    pushed: Pushed,
}

/// State of a film from step to step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Memory {
    /// The oil; `None` where there is no film.
    layer: Option<Layer>,
    /// Entrainment speed [m/s].
    speed: f64,
    /// Places of the film on the track and on the round body, and at the last evaluation of the speed.
    places: [Place; 2],
    /// Distribution of a unit force over nodes: two of the track, two of the round body.
    shares: [[f64; 2]; 4],
    /// The gap when each node stands at the origin [m]: it grows as the force would move nodes.
    offset: f64,
    speed_places: [Place; 2],
    /// Speeds at which the places sweep over the track and the round body [m/s].
    swept: [f64; 2],
    speed_step: u64,
    next_look: u64,
    /// Share of the force that the land leaves.
    share: f64,
    /// So thin and so pressed that nothing can change before the next look.
    fixed: bool,
}

impl Films {
    /// Films between `surfaces`, in reference positions `x`, `y` [m] by slot; `thickness` [m] is that of
    /// their contacts out of plane.
    ///
    /// # Errors
    /// When a number is out of range or a surface cannot hold a film.
    pub fn new(
        surfaces: Vec<Surface>,
        specs: &[FilmSpec],
        thickness: f64,
        x: &[f64],
        y: &[f64],
    ) -> Result<Self, Error> {
        let check = |field, value: f64, ok: bool| {
            let allowed = "positive";
            if value.is_finite() && ok { Ok(()) } else { Err(Error::OutOfRange { field, value, allowed }) }
        };
        check("thickness [m]", thickness, thickness > 0.0)?;
        // Through a film thinner than the sag of its facets a polygon would load the body.
        let surfaces: Vec<Surface> =
            surfaces.into_iter().map(|s| s.smoothed(Smoothing::Nagata, x, y)).collect::<Result<_, _>>()?;
        let lands: Vec<Vec<Land>> = surfaces.iter().map(|s| Land::of(s, x, y)).collect();
        let (mut films, mut first) = (Vec::new(), Vec::new());
        for spec in specs {
            first.push(films.len());
            let FilmSpec { round, centre, track, oil, stiffness, length, speed } = *spec;
            check("dynamic viscosity [Pa s]", oil.viscosity, oil.viscosity > 0.0)?;
            check("least film thickness [m]", oil.least, oil.least > 0.0)?;
            check("length of a film [m]", length, length > 0.0)?;
            check("penalty stiffness [Pa/m]", stiffness, stiffness > 0.0)?;
            let name = || surfaces[round].name.clone();
            let [whole] = &lands[round][..] else {
                return Err(Error::BadSurface {
                    name: name(),
                    reason: "is not round: a film needs a body without corners",
                });
            };
            for land in &lands[track] {
                let curvature = whole.curvature + land.curvature;
                if curvature <= 0.0 {
                    let reason =
                        "is too large for the surface that it rolls on: a film needs a smaller radius";
                    return Err(Error::BadSurface { name: name(), reason });
                }
                let radius = 1.0 / curvature;
                let bed = Bed::new(stiffness * thickness, radius);
                films.push(Film {
                    round,
                    track,
                    centre,
                    lands: [land.clone(), whole.clone()],
                    law: FilmLaw::new(oil, radius, length, bed),
                    memory: Memory::new(speed),
                    nodes: [0; 4],
                    pushed: Pushed::default(),
                });
            }
        }
        first.push(films.len());
        Ok(Self { surfaces, films, first, preload: false, heat: 0.0 })
    }

    /// For a static preload: films have the thickness of steady rolling at any moment.
    pub fn set_preload(&mut self, preload: bool) {
        self.preload = preload;
        // Each restarts from the positions of the next evaluation.
        self.films.iter_mut().for_each(|film| (film.memory.layer, film.memory.next_look) = (None, 0));
    }

    /// State of each film, in the order of their specification.
    pub fn resultants(&self) -> impl Iterator<Item = FilmResultant> {
        self.first.windows(2).map(|of_spec| {
            let mut sum = FilmResultant { force: [0.0; 2], thickness: WIDEST };
            for film in &self.films[of_spec[0]..of_spec[1]] {
                let Some(layer) = film.memory.layer else { continue };
                let [.., a, b] = film.memory.shares;
                sum.force[0] += film.pushed.force * (a[0] + b[0]);
                sum.force[1] += film.pushed.force * (a[1] + b[1]);
                sum.thickness = sum.thickness.min(film.law.thickness(&layer));
            }
            sum
        })
    }

    /// State of the films, for a checkpoint.
    pub fn state(&self) -> FilmState {
        FilmState { films: self.films.iter().map(|film| film.memory).collect(), heat: self.heat }
    }

    /// Restores a state; false when it belongs to other films, and nothing is changed then.
    pub fn restore(&mut self, state: &FilmState) -> bool {
        let fits = |(film, memory): (&Film, &Memory)| self.fits(film, memory);
        if state.films.len() != self.films.len() || !self.films.iter().zip(&state.films).all(fits) {
            return false;
        }
        for (film, memory) in self.films.iter_mut().zip(&state.films) {
            film.take_over(memory, &self.surfaces);
            film.pushed = Pushed::default();
        }
        self.heat = state.heat;
        true
    }

    /// Whether a film can remember this.
    fn fits(&self, film: &Film, memory: &Memory) -> bool {
        let on = |place: Place, surface: usize| {
            let on = (place.facet as usize) < self.surfaces[surface].facets();
            on && (0.0..=1.0).contains(&place.along)
        };
        let [track, round] = memory.places;
        on(track, film.track) && on(round, film.round)
    }
}

impl Memory {
    fn new(speed: f64) -> Self {
        let places = [Place::default(); 2];
        Self {
            layer: None,
            speed,
            places,
            shares: [[0.0; 2]; 4],
            offset: 0.0,
            speed_places: places,
            swept: [0.0; 2],
            speed_step: 0,
            next_look: 0,
            share: 1.0,
            fixed: false,
        }
    }
}

impl Film {
    /// Continues from a state.
    fn take_over(&mut self, memory: &Memory, surfaces: &[Surface]) {
        self.memory = *memory;
        let [track, round] = memory.places;
        let ends = |surface: usize, place: Place| surfaces[surface].ends(place.facet as usize);
        let ((a, b), (c, d)) = (ends(self.track, track), ends(self.round, round));
        self.nodes = [a, b, c, d].map(|n| n as u32);
    }

    /// Looks for the nearest places, and whether there is a film between them at all; true when one begins.
    fn look(&mut self, surfaces: &[Surface], at: &Moment<'_>) -> bool {
        let mut begins = false;
        let both = [&surfaces[self.track], &surfaces[self.round]];
        let c = self.centre as usize;
        let centre = [at.x[c], at.y[c]];
        let m = &mut self.memory;
        if m.layer.is_none() {
            // From anywhere: a land may come into reach at its other end.
            m.places[0] = self.lands[0].begin(both[0], at.x, at.y, centre);
        }
        let track = self.lands[0].nearest(both[0], at.x, at.y, centre, m.places[0]);
        if m.layer.is_none() {
            m.places[1] = self.lands[1].begin(both[1], at.x, at.y, track.at);
        }
        let round = self.lands[1].nearest(both[1], at.x, at.y, track.at, m.places[1]);
        m.places = [track.place, round.place];
        // The point of the round body is the one nearest to that of the track: its normal is the line between
        // them, so that forces along it turn nothing, on average between two looks.
        let normal = round.normal.map(|n| -n);
        let gap = normal[0] * (round.at[0] - track.at[0]) + normal[1] * (round.at[1] - track.at[1]);
        // The film stays at these points until the next update, so they are placed where it is half-way till
        // then. Points that lag behind would exert a couple on a rolling body, with a gap that opens as
        // bodies roll away from it and closes at the next update: a gain of energy.
        let half = 0.5 * LOOK_EVERY as f64 * at.dt;
        let [on_track, on_round] = [0, 1].map(|i| m.places[i].ahead(both[i], at.x, at.y, half * m.swept[i]));
        let ([a, b], [c, d]) = (on_track.shares(round.normal), on_round.shares(normal));
        m.shares = [a, b, c, d];
        let ([a, b], [c, d]) = (track.ends, round.ends);
        self.nodes = [a, b, c, d];
        m.offset = 0.0;
        self.memory.offset = gap - self.gap(at);
        let m = &mut self.memory;
        if gap > WIDEST {
            m.layer = None;
            self.pushed = Pushed::default();
        } else if m.layer.is_none() {
            (m.layer, begins) = (Some(Layer::at(gap)), true);
        }
        let steps = at.step.saturating_sub(m.speed_step);
        let time = at.dt * steps as f64;
        if begins || m.layer.is_none() || m.next_look + REST < at.step {
            (m.speed_places, m.speed_step, m.swept) = (m.places, at.step, [0.0; 2]);
        } else if steps >= LOOK_EVERY * SPEED_EVERY && time >= SPEED_OVER {
            // The nearest places sweep over both surfaces at the speeds with which these draw oil in.
            m.swept = [0, 1].map(|i| m.places[i].since(both[i], m.speed_places[i]) / time);
            m.speed = 0.5 * (m.swept[1] - m.swept[0]);
            (m.speed_places, m.speed_step) = (m.places, at.step);
        }
        m.next_look = at.step + if m.layer.is_some() { LOOK_EVERY } else { REST };
        if let Some(layer) = &m.layer {
            let ends = self.lands[0].to_ends(both[0], track.place);
            m.share = self.law.share(ends, track.tilt(normal), layer);
        }
        begins
    }

    /// Takes the film to this moment.
    fn evaluate(&mut self, surfaces: &[Surface], at: &Moment<'_>, preload: bool) {
        self.pushed.heat = 0.0;
        let (mut settle, mut moved) = (preload, 0.0);
        if preload || at.step >= self.memory.next_look {
            // The force does half of the work of the step up to here at the points that it leaves, and half at
            // those that it comes to.
            let left = self.gap_half_a_step_ago(at);
            settle |= self.look(surfaces, at);
            moved = self.gap_half_a_step_ago(at) - left;
        } else if self.memory.fixed {
            return;
        }
        let gap = self.gap(at);
        let Self { law, memory, pushed, .. } = self;
        let Some(layer) = &mut memory.layer else { return };
        if settle {
            (*layer, *pushed) = law.settled(gap, memory.speed, memory.share);
        } else {
            *pushed = law.flow(layer, gap, memory.speed, memory.share, at.dt);
            pushed.heat += pushed.force * moved;
        }
        memory.fixed = pushed.fixed;
    }

    /// The gap between the two points [m].
    #[inline]
    fn gap(&self, at: &Moment<'_>) -> f64 {
        let mut gap = self.memory.offset;
        for (&n, [x, y]) in self.nodes.iter().zip(&self.memory.shares) {
            gap += x * at.x[n as usize] + y * at.y[n as usize];
        }
        gap
    }

    /// The gap between the two points in the middle of the last step [m].
    fn gap_half_a_step_ago(&self, at: &Moment<'_>) -> f64 {
        let ends = self.nodes.iter().zip(&self.memory.shares);
        let opens = ends.map(|(&n, [x, y])| x * at.vx[n as usize] + y * at.vy[n as usize]);
        self.gap(at) - 0.5 * at.dt * opens.sum::<f64>()
    }
}

impl Films {
    /// Takes all films to this moment, without their forces on nodes: these follow with [`Films::hand_over`].
    /// Nothing is read that other forces change, so that it may be done beside them.
    pub fn evaluate(&mut self, at: Moment<'_>) {
        let Self { surfaces, films, preload, heat, .. } = self;
        for film in films {
            film.evaluate(surfaces, &at, *preload);
            *heat += film.pushed.heat;
        }
    }

    /// Adds the forces [N] of the last [`Films::evaluate`] at nodes.
    pub fn hand_over(&self, force: &mut NodeForces) {
        for film in self.films.iter().filter(|film| film.pushed.force != 0.0) {
            for (&n, [x, y]) in film.nodes.iter().zip(&film.memory.shares) {
                force.fx[n as usize] += film.pushed.force * x;
                force.fy[n as usize] += film.pushed.force * y;
            }
        }
    }
}

impl Force for Films {
    fn accumulate(&mut self, at: Moment<'_>, force: &mut NodeForces) {
        self.evaluate(at);
        self.hand_over(force);
    }

    fn energy(&self) -> Energy {
        let stored = self.films.iter().map(|film| film.law.stored(&film.pushed)).sum();
        Energy { stored, damping: self.heat, ..Energy::default() }
    }

    fn stiffness_bound(&self, _dt: f64, bound: &mut [f64]) {
        // As in contact, (a − b)² ≤ 2a² + 2b², and a surface holds one film at a place. All of it may load
        // one node.
        let mut own = vec![0.0_f64; bound.len()];
        for film in &self.films {
            for surface in [film.track, film.round] {
                let surface = &self.surfaces[surface];
                let stiffness = 2.0 * film.law.spring.stiffest() * (1.0 + surface.steepest().powi(2));
                for &slot in &surface.slots {
                    own[slot as usize] = own[slot as usize].max(stiffness);
                }
            }
        }
        bound.iter_mut().zip(own).for_each(|(b, k)| *b += k);
    }

    fn tangent(&self, _x: &[f64], _y: &[f64], visit: &mut dyn FnMut(RankOne<'_>)) {
        for film in &self.films {
            let Film { nodes, memory, law, pushed, .. } = film;
            let Some(layer) = &memory.layer else { continue };
            let [depth, dry] = pushed.pressed.map(|depth| law.spring.stiffness(depth));
            let mut stiffness = depth;
            if self.preload && pushed.force > 0.0 {
                // The film is compliant, too: in steady rolling its force is in inverse proportion to its
                // thickness.
                stiffness = 1.0 / (1.0 / depth + law.thickness(layer) / layer.force);
            }
            let stiffness = stiffness - dry;
            if stiffness <= 0.0 {
                continue;
            }
            visit(RankOne { nodes, direction: memory.shares.as_flattened(), stiffness });
        }
    }
}
