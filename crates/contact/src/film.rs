//! Oil between round bodies and what they roll on: squeeze and rolling entrainment, without suction (THEORY §4.6).
//!
//! A film is one more force on nodes. It lies in series with the springs of contact: the gap that the nodes leave is the
//! film's thickness less what the surfaces give under its pressure. So its force hangs on positions alone, never pulls, and
//! is no stiffer than contact.

mod divided;
mod reynolds;
mod spring;
mod track;

use serde::{Deserialize, Serialize};

use stribeck_solver::{
    Force,
    force::RankOne,
    state::{Energy, Moment, NodeForces},
};

use crate::{error::Error, smooth::Smoothing, surface::Surface};
use reynolds::{EMPTY, Pressed, left_of_land};
use spring::Spring;
use track::{Land, Place, Point};

/// Steps from one look for the nearest places to the next; in between the film stays at the nodes where it was.
const LOOK_EVERY: u64 = 16;

/// Steps between two looks at a film that is too thick to push.
const REST: u64 = 128;

/// Looks over which the speed of rolling is taken.
const SPEED_EVERY: u64 = 4;

/// Wider gaps hold no film [m].
const WIDEST: f64 = 1e-3;

/// Bodies that roll more slowly than this count as rolling at it [m/s]: enough to divide by, and a ten-thousandth of what
/// a bearing does.
const SLOWEST: f64 = 1e-3;

/// Where a film ends that neither opens nor closes.
const STEADY: f64 = 0.475_131;

/// A land that ends this many film widths away has no end.
const FAR: f64 = 20.0;

/// A contact that carries so many times what its film can lift stays as it is until the next look.
const FIXED: f64 = 4.0;

/// Share of the way that is left when the end of a film is found. The next step makes up for it.
const ACCURACY: f64 = 1e-6;

/// Most corrections of the place where a film ends.
const MOST_CORRECTIONS: usize = 30;

/// What lies between two surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oil {
    /// Dynamic viscosity η [Pa s].
    pub viscosity: f64,
    /// Least film thickness [m]: that of a loaded contact, where the oil is as good as solid and contact alone acts.
    pub least: f64,
}

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
    /// Entrainment speed [m/s] before any motion was seen: half the sum of the speeds of both surfaces against the contact.
    pub speed: f64,
}

/// What a film does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmResultant {
    /// Force on the round body [N].
    pub force: [f64; 2],
    /// Film thickness [m]; a millimetre where there is none, the widest that holds one.
    pub thickness: f64,
}

/// What films remember: all that changes in time.
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
    /// Whether ranks share the films, so that heat is counted once all have told theirs.
    divided: bool,
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
    /// Relative radius R [m].
    radius: f64,
    /// 4ηRL [N s]: times u/h a force.
    wedge: f64,
    /// 1/√(2R) [1/√m].
    slope: f64,
    least: f64,
    spring: Spring,
    memory: Memory,
    /// Nodes that it hangs on, which follow from its places.
    nodes: [u32; 4],
    /// Force on the round body [N], and how far springs are pressed in with and without the film [m].
    push: f64,
    pressed: [f64; 2],
    /// Heat of the last step [J].
    heat: f64,
    /// Whether this rank computes it.
    here: bool,
}

/// What a film remembers from step to step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Memory {
    /// Thickness above the least [m]; `None` where there is no film.
    above: Option<f64>,
    /// Where it ends.
    end: f64,
    /// Force through it [N].
    force: f64,
    /// Entrainment speed [m/s].
    speed: f64,
    /// Places of the film on the track and on the round body, and what they were when the speed was last taken.
    places: [Place; 2],
    /// Where a unit of force goes, node by node: two of the track, two of the round body.
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
    /// Films between `surfaces`, in reference positions `x`, `y` [m] by slot; `thickness` [m] is out of plane.
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
        // Polygons would be felt through a film that is thinner than their sag.
        let surfaces: Vec<Surface> =
            surfaces.into_iter().map(|s| s.smoothed(Smoothing::Nagata, x, y)).collect::<Result<_, _>>()?;
        let lands: Vec<Vec<Land>> = surfaces.iter().map(|s| Land::of(s, x, y)).collect();
        let (mut films, mut first) = (Vec::new(), Vec::new());
        for spec in specs {
            first.push(films.len());
            let FilmSpec { round, centre, track, oil, stiffness, speed } = *spec;
            check("dynamic viscosity [Pa s]", oil.viscosity, oil.viscosity > 0.0)?;
            check("least film thickness [m]", oil.least, oil.least > 0.0)?;
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
                films.push(Film {
                    round,
                    track,
                    centre,
                    lands: [land.clone(), whole.clone()],
                    radius,
                    wedge: 4.0 * oil.viscosity * radius * thickness,
                    slope: 1.0 / (2.0 * radius).sqrt(),
                    least: oil.least,
                    spring: Spring::new(stiffness * thickness, radius),
                    memory: Memory::new(speed),
                    nodes: [0; 4],
                    push: 0.0,
                    pressed: [0.0; 2],
                    heat: 0.0,
                    here: true,
                });
            }
        }
        first.push(films.len());
        Ok(Self { surfaces, films, first, preload: false, divided: false, heat: 0.0 })
    }

    /// For a static preload: films have the thickness of steady rolling at any moment.
    pub fn set_preload(&mut self, preload: bool) {
        self.preload = preload;
        // Each begins anew from the positions that it then finds.
        self.films.iter_mut().for_each(|film| (film.memory.above, film.memory.next_look) = (None, 0));
    }

    /// What each film does, in the order given.
    pub fn resultants(&self) -> impl Iterator<Item = FilmResultant> {
        self.first.windows(2).map(|of_spec| {
            let mut sum = FilmResultant { force: [0.0; 2], thickness: WIDEST };
            for film in &self.films[of_spec[0]..of_spec[1]] {
                let Some(above) = film.memory.above else { continue };
                let [.., a, b] = film.memory.shares;
                sum.force[0] += film.push * (a[0] + b[0]);
                sum.force[1] += film.push * (a[1] + b[1]);
                sum.thickness = sum.thickness.min(above + film.least);
            }
            sum
        })
    }

    /// What films remember.
    pub fn state(&self) -> FilmState {
        FilmState { films: self.films.iter().map(|film| film.memory).collect(), heat: self.heat }
    }

    /// Resumes from what films remembered; false when it belongs to other films, and nothing is changed then.
    pub fn restore(&mut self, state: &FilmState) -> bool {
        let fits = |(film, memory): (&Film, &Memory)| self.fits(film, memory);
        if state.films.len() != self.films.len() || !self.films.iter().zip(&state.films).all(fits) {
            return false;
        }
        for (film, memory) in self.films.iter_mut().zip(&state.films) {
            film.take_over(memory, &self.surfaces);
            (film.push, film.pressed) = (0.0, [0.0; 2]);
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
            above: None,
            end: STEADY,
            force: 0.0,
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
    /// Goes on from a memory.
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
        if m.above.is_none() {
            // From anywhere: a land may come into reach at its other end.
            m.places[0] = self.lands[0].begin(both[0], at.x, at.y, centre);
        }
        let track = self.lands[0].nearest(both[0], at.x, at.y, centre, m.places[0]);
        if m.above.is_none() {
            m.places[1] = self.lands[1].begin(both[1], at.x, at.y, track.at);
        }
        let round = self.lands[1].nearest(both[1], at.x, at.y, track.at, m.places[1]);
        m.places = [track.place, round.place];
        // The point of the round body is the one nearest to that of the track: its normal is the line between them, so that
        // forces along it turn nothing, on average between two looks.
        let normal = round.normal.map(|n| -n);
        let gap = normal[0] * (round.at[0] - track.at[0]) + normal[1] * (round.at[1] - track.at[1]);
        // The film stays at these points until the next look, so they lie where it is half-way till then. Points that fall
        // behind turn what rolls, with a gap that opens while bodies roll away from it and closes at the next look: energy
        // from nowhere.
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
            *m = Memory { above: None, force: 0.0, end: STEADY, ..*m };
            (self.push, self.pressed) = (0.0, [0.0; 2]);
        } else if m.above.is_none() {
            (m.above, begins) = (Some(gap.max(0.0)), true);
        }
        if begins || m.above.is_none() || m.speed_step + REST < at.step {
            (m.speed_places, m.speed_step, m.swept) = (m.places, at.step, [0.0; 2]);
        } else if at.step >= m.speed_step + LOOK_EVERY * SPEED_EVERY {
            // The nearest places sweep over both surfaces at the speeds with which these draw oil in.
            let time = at.dt * (at.step - m.speed_step) as f64;
            m.swept = [0, 1].map(|i| m.places[i].since(both[i], m.speed_places[i]) / time);
            m.speed = 0.5 * (m.swept[1] - m.swept[0]);
            (m.speed_places, m.speed_step) = (m.places, at.step);
        }
        m.next_look = at.step + if m.above.is_some() { LOOK_EVERY } else { REST };
        if let Some(above) = m.above {
            self.memory.share = self.share(both[0], track, normal, above + self.least);
        }
        begins
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

    /// Share of the force that is left where the land ends nearby.
    fn share(&self, surface: &Surface, track: Point, normal: [f64; 2], thickness: f64) -> f64 {
        let per_metre = self.slope / thickness.sqrt();
        let ends = self.lands[0].to_ends(surface, track.place);
        let tilt = track.normal[0] * normal[1] - track.normal[1] * normal[0];
        ends.map(|end| {
            // At the very end the closest approach may lie beyond it.
            let edge = if end > 0.0 { end } else { -tilt.abs() * self.radius };
            let edge = edge * per_metre;
            if edge < FAR { left_of_land(edge) } else { 1.0 }
        })
        .iter()
        .product()
    }

    /// Gives the film the thickness of steady rolling at this gap [m].
    fn settle(&mut self, gap: f64) {
        let m = &mut self.memory;
        let steady = Pressed::until(STEADY);
        let carried = self.wedge * m.speed.abs().max(SLOWEST) * m.share * steady.force;
        let dry = (-gap).max(0.0);
        let mut above = gap.max(0.0);
        if self.spring.force(dry) < carried / self.least {
            // Spring force less film force rises with the thickness.
            let (mut low, mut high) = (above, above + carried / self.least / self.spring.stiffest() + WIDEST);
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if self.spring.force(middle - gap) < carried / (middle + self.least) {
                    low = middle
                } else {
                    high = middle
                }
            }
            above = low;
        }
        let depth = above - gap;
        (m.above, m.end, m.force) = (Some(above), STEADY, self.spring.force(depth));
        (self.pressed, self.push) = ([depth, dry], m.force - self.spring.force(dry));
    }

    /// Lets a time step `dt` [s] pass at this gap [m]; the heat of it [J].
    fn flow(&mut self, above: f64, gap: f64, dt: f64) -> f64 {
        let m = &mut self.memory;
        let dry = (-gap).max(0.0);
        let thickness = above + self.least;
        let speed = m.speed.hypot(SLOWEST);
        let lift = self.wedge * speed * m.share / thickness;
        let rate = speed * thickness.sqrt() * self.slope;
        let before = m.force;
        m.fixed = false;
        if above == 0.0 && dry > 0.0 {
            let (carried, loose) = (self.spring.force(dry), lift * Pressed::until(STEADY).force);
            if carried >= loose {
                // Solid: contact alone acts.
                m.fixed = carried > FIXED * loose;
                (m.force, m.end) = (carried, STEADY);
                (self.push, self.pressed) = (0.0, [dry; 2]);
                return 0.0;
            }
        }
        let room = above - gap;
        let new = match end_of(lift, rate * dt, room, m.end, &self.spring) {
            Some((end, film)) => {
                m.end = end;
                (above + rate * dt * film.opening).max(0.0)
            }
            None => {
                m.end = EMPTY;
                gap.max(0.0)
            }
        };
        m.above = Some(new);
        let depth = (new - gap).max(0.0);
        m.force = self.spring.force(depth);
        (self.push, self.pressed) = (m.force - self.spring.force(dry), [depth, dry]);
        0.5 * (before + m.force) * (above - new)
    }

    /// Energy in its springs, beside what contact has [J].
    fn stored(&self) -> f64 {
        self.spring.energy(self.pressed[0]) - self.spring.energy(self.pressed[1])
    }
}

/// Where the film ends that presses springs in by what is left of `room` [m] after it has opened for a time: at the force
/// `lift` · G and the rate `opened` · q [m]. `None` when it cannot follow.
fn end_of(lift: f64, opened: f64, room: f64, from: f64, spring: &Spring) -> Option<(f64, Pressed)> {
    let need = |c: f64| {
        let film = Pressed::until(c);
        let (depth, by_force) = spring.depth(lift * film.force);
        let value = depth - opened * film.opening - room;
        (value, by_force * lift * film.force_slope - opened * film.opening_slope, film)
    };
    let mut c = from.max(EMPTY);
    let (mut low, mut high) = (EMPTY, f64::INFINITY);
    for _ in 0..MOST_CORRECTIONS {
        let (value, slope, film) = need(c);
        if value >= 0.0 && c == EMPTY {
            return None;
        }
        if value.abs() <= ACCURACY * (room.abs() + opened) {
            return Some((c, film));
        }
        if value > 0.0 {
            high = c
        } else {
            low = c
        }
        let next = c - value / slope;
        c = if next > low && next < high {
            next
        } else if value > 0.0 {
            if low == EMPTY { EMPTY } else { 0.5 * (low + high) }
        } else if high.is_finite() {
            0.5 * (low + high)
        } else {
            2.0 * c.abs() + 1.0
        };
    }
    Some((c, Pressed::until(c)))
}

impl Force for Films {
    fn accumulate(&mut self, at: Moment<'_>, force: &mut NodeForces) {
        let Self { surfaces, films, preload, .. } = self;
        for film in films.iter_mut().filter(|film| film.here) {
            film.heat = 0.0;
            let mut settle = *preload;
            if *preload || at.step >= film.memory.next_look {
                settle |= film.look(surfaces, &at);
            } else if film.memory.fixed {
                continue;
            }
            let Some(above) = film.memory.above else { continue };
            let gap = film.gap(&at);
            if settle {
                film.settle(gap);
            } else {
                film.heat = film.flow(above, gap, at.dt);
            }
            if film.push != 0.0 {
                for (&n, [x, y]) in film.nodes.iter().zip(&film.memory.shares) {
                    force.fx[n as usize] += film.push * x;
                    force.fy[n as usize] += film.push * y;
                }
            }
        }
        if !self.divided {
            self.count_heat();
        }
    }

    fn energy(&self) -> Energy {
        let stored = self.films.iter().map(Film::stored).sum();
        Energy { stored, damping: self.heat, ..Energy::default() }
    }

    fn stiffness_bound(&self, _dt: f64, bound: &mut [f64]) {
        // As in contact, (a − b)² ≤ 2a² + 2b², and a surface holds one film at a place. All of it may hang on one node.
        let mut own = vec![0.0_f64; bound.len()];
        for film in &self.films {
            for surface in [film.track, film.round] {
                let surface = &self.surfaces[surface];
                let stiffness = 2.0 * film.spring.stiffest() * (1.0 + surface.steepest().powi(2));
                for &slot in &surface.slots {
                    own[slot as usize] = own[slot as usize].max(stiffness);
                }
            }
        }
        bound.iter_mut().zip(own).for_each(|(b, k)| *b += k);
    }

    fn tangent(&self, _x: &[f64], _y: &[f64], visit: &mut dyn FnMut(RankOne<'_>)) {
        for film in &self.films {
            let Film { nodes, memory, .. } = film;
            let Some(above) = memory.above else { continue };
            let [depth, dry] = film.pressed.map(|depth| film.spring.stiffness(depth));
            let mut stiffness = depth;
            if self.preload && film.push > 0.0 {
                // The film gives, too: in steady rolling its force is in inverse proportion to its thickness.
                stiffness = 1.0 / (1.0 / depth + (above + film.least) / memory.force);
            }
            let stiffness = stiffness - dry;
            if stiffness <= 0.0 {
                continue;
            }
            visit(RankOne { nodes, direction: memory.shares.as_flattened(), stiffness });
        }
    }
}
