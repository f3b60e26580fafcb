//! Forces of oil films on rollers, modes and rings, in a step and at the start (THEORY §9.4, §9.5).

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};
use stribeck_surface::film::side_by_side::PushedRows;

use crate::{
    drive::RingRotation,
    oil::{FilmForces, FilmStep, Films, Lubrication, RollerView, SeenRollers},
    rollers::{Rollers, block::Block},
    row::{Rows, lanes, load, store},
    state::State,
};

/// Effects of films on eight rollers besides the forces on them.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct OilForces {
    /// Normal force at the outer raceway [N], and its decrease as the raceway recedes [N/m].
    pub(crate) normal: [f64; LANES],
    pub(crate) stiffness: [f64; LANES],
    /// Moments that the drives of outer and inner ring make good [N m].
    pub(crate) drive: [f64; 2],
    /// Energy of their springs beyond that of contact [J], and heat [J].
    pub(crate) stored: f64,
    heat: f64,
}

impl Lubrication {
    /// Films before the first step, with the rollers as they stand in a state.
    pub(crate) fn first_films(&self, rollers: &Rollers, state: &State) -> Films {
        let mut films = Films { at: [Vec::new(), Vec::new()], heat: 0.0 };
        for i in 0..rollers.count {
            for (k, (race, at)) in self.raceways.iter().zip(&mut films.at).enumerate() {
                let seen = rollers.view_at_rest(state, i, k, [0.0; 2]);
                at.extend(race.first_films(self.rim(rollers.rim_of[i]), &seen));
            }
        }
        films
    }

    /// Forces on a roller by the films of steady rolling at the outer and the inner raceway, away from these
    /// [N].
    pub(crate) fn carried(
        &self,
        rollers: &Rollers,
        state: &mut State,
        i: usize,
        moved: [f64; 2],
    ) -> [f64; 2] {
        let Some(mut films) = state.films.take() else { return [0.0; 2] };
        let rim = self.rim(rollers.rim_of[i]);
        let outwards = [0, 1].map(|k| {
            let (race, seen) = (&self.raceways[k], rollers.view_at_rest(state, i, k, moved));
            let [fx, fy] = race.carried(rim, race.of_roller(&mut films.at[k], i), &seen).force;
            let [x, y] = seen.centre;
            (fx * x + fy * y) / libm::hypot(x, y)
        });
        state.films = Some(films);
        [-outwards[0], outwards[1]]
    }

    /// Between which distances from the bearing's centre a roller floats in oil [m]; `None` when it has no
    /// clearance.
    pub(crate) fn floating(
        &self,
        rollers: &Rollers,
        state: &mut State,
        i: usize,
        moved: [f64; 2],
    ) -> Option<[f64; 2]> {
        let mut films = state.films.take()?;
        let rim = self.rim(rollers.rim_of[i]);
        let gaps = [0, 1].map(|k| {
            let (race, seen) = (&self.raceways[k], rollers.view_at_rest(state, i, k, moved));
            race.gap(rim, race.of_roller(&mut films.at[k], i), &seen)
        });
        state.films = Some(films);
        let at = libm::hypot(state.x[i], state.y[i]);
        Some([at - gaps[1], at + gaps[0]]).filter(|[low, high]| low < high)
    }

    /// Adds the forces of films to those on eight rollers between the raceways, the outer and the inner one
    /// of which turn as given.
    #[inline(always)]
    pub(crate) fn add_film_forces<S: Simd>(
        &self,
        simd: S,
        rollers: &Rollers,
        films: &mut Films,
        block: &mut Block,
        turning: [Option<RingRotation>; 2],
        now: FilmStep,
    ) -> OilForces {
        let mut by_oil = OilForces::default();
        let round = block.films.round();
        for (k, race) in self.raceways.iter().enumerate() {
            let turning = turning[k].unwrap_or(RingRotation::STILL);
            let seen = SeenRollers::of(simd, block, k, turning);
            let now = FilmStep { felt: now.felt && k == 0, ..now };
            let mut force = Rows::default();
            for land in 0..race.lands() {
                let eight = &mut block.films.on[k][land];
                let flown = eight.flow(simd, race, land, (&seen, self.radius(), round), now, &mut force);
                if let Some(pushed) = flown {
                    by_oil.add_eight(simd, &pushed, now);
                }
                // Rims that are not round, and films that there may be from now on.
                let missing = if now.looks() { eight.missing(round) } else { 0 };
                for lane in lanes((block.bits & !round) | missing) {
                    let by_film = self.alone(rollers, films, block, [k, land, lane], &seen.one(lane), now);
                    force[0][lane] += by_film.force[0];
                    force[1][lane] += by_film.force[1];
                    block.moment[lane] += by_film.moment;
                    by_oil.add_one(k, lane, &by_film);
                }
            }
            by_oil.drive[k] += push_rollers(simd, block, k, turning, &force);
        }
        films.heat += by_oil.heat;
        by_oil
    }

    /// Forces of the film of one roller on a land, in scalar arithmetic, for the numbers of raceway and land
    /// and of the roller in its block.
    #[inline(never)]
    fn alone(
        &self,
        rollers: &Rollers,
        films: &mut Films,
        block: &mut Block,
        [k, land, lane]: [usize; 3],
        seen: &RollerView,
        now: FilmStep,
    ) -> FilmForces {
        let (race, i) = (&self.raceways[k], block.first + lane);
        let rim = self.rim(rollers.rim_of[i]);
        let kept = &mut race.of_roller(&mut films.at[k], i)[land];
        if (block.films.round() >> lane) & 1 == 0 {
            return race.film_force(land, rim, kept, seen, now);
        }
        let eight = &mut block.films.on[k][land];
        let mut film = eight.film(lane);
        let by_film = race.film_force(land, rim, &mut film, seen, now);
        eight.load(race, land, lane, &film);
        by_film
    }
}

impl OilForces {
    /// Adds the forces of films of eight rollers.
    #[inline(always)]
    fn add_eight<S: Simd>(&mut self, simd: S, pushed: &PushedRows, now: FilmStep) {
        let (mut heat, mut stored) = (Vector::all(simd, 0.0), Vector::all(simd, 0.0));
        for at in vector_starts(simd) {
            heat = heat + Vector::load(simd, &pushed.heat.0, at);
            if now.last {
                stored = stored + Vector::load(simd, &pushed.stored.0, at);
            }
            if now.felt {
                let had = [Vector::load(simd, &self.normal, at), Vector::load(simd, &self.stiffness, at)];
                (had[0] + Vector::load(simd, &pushed.force.0, at)).store(&mut self.normal, at);
                (had[1] + Vector::load(simd, &pushed.stiffness.0, at)).store(&mut self.stiffness, at);
            }
        }
        self.heat += heat.sum();
        self.stored += stored.sum();
    }

    /// Adds the effects of a film of one roller at a raceway, without its force.
    fn add_one(&mut self, raceway: usize, lane: usize, by_film: &FilmForces) {
        self.drive[raceway] += by_film.moment;
        self.heat += by_film.heat;
        self.stored += by_film.stored;
        if raceway == 0 {
            self.normal[lane] += by_film.normal;
            self.stiffness[lane] += by_film.stiffness;
        }
    }
}

impl SeenRollers {
    /// Of a block, by the outer (0) or the inner (1) raceway, which turns as given.
    #[inline(always)]
    fn of<S: Simd>(simd: S, block: &Block, raceway: usize, turning: RingRotation) -> Self {
        let contacts = &block.contacts[raceway];
        let mut seen =
            Self { centre: contacts.centre, spin: contacts.spin, larger: block.larger, ..Self::default() };
        let rate = Vector::all(simd, turning.rate);
        for at in vector_starts(simd) {
            let ([x, y], [vx, vy]) = (load(simd, &block.centre, at), load(simd, &block.velocity, at));
            let (mut from, mut relative) = ([x, y], [vx, vy]);
            if raceway == 0 {
                // The outer raceway under the roller moves with the modes, and because the roller goes on to
                // another place of it.
                let distance = Vector::load(simd, &block.distance, at);
                let orbit = x.times_plus(vy, -(y * vx)) / (distance * distance);
                let ([bx, by], [mx, my]) = (load(simd, &block.by, at), load(simd, &block.moving, at));
                let [tx, ty] = load(simd, &block.tilt, at);
                from = [x - bx, y - by];
                relative = [vx - mx - orbit * tx, vy - my - orbit * ty];
            }
            let relative = [rate.times_plus(from[1], relative[0]), relative[1] - rate * from[0]];
            store(turning.back(simd, relative), &mut seen.velocity, at);
            (Vector::load(simd, &block.spin, at) - rate).store(&mut seen.turning, at);
        }
        seen
    }
}

/// Adds forces of films at a raceway, given in its frame, to those on eight rollers. Returns the moment that
/// its drive balances [N m].
#[inline(always)]
fn push_rollers<S: Simd>(
    simd: S,
    block: &mut Block,
    raceway: usize,
    turning: RingRotation,
    force: &Rows,
) -> f64 {
    let mut drive = Vector::all(simd, 0.0);
    for at in vector_starts(simd) {
        let [fx, fy] = turning.forth(simd, load(simd, force, at));
        let [ox, oy] = load(simd, &block.force[raceway], at);
        store([ox + fx, oy + fy], &mut block.force[raceway], at);
        let [mut x, mut y] = load(simd, &block.centre, at);
        if raceway == 0 {
            let [bx, by] = load(simd, &block.by, at);
            (x, y) = (x - bx, y - by);
            // As of contact: downhill along a raceway that is displaced more or less (THEORY §9.3).
            let [tx, ty] = load(simd, &block.tilt, at);
            let uphill = fx.times_plus(tx, fy * ty) / Vector::load(simd, &block.distance, at);
            let ([rx, ry], [dx, dy]) = (load(simd, &block.radial, at), load(simd, &block.downhill, at));
            store([uphill.times_plus(ry, dx), dy - uphill * rx], &mut block.downhill, at);
        }
        drive = drive + x.times_plus(fy, -(y * fx));
    }
    drive.sum()
}

impl Rollers {
    /// A roller in the frame of the outer (0) or the inner (1) raceway before the first step, the former
    /// displaced.
    fn view_at_rest(&self, state: &State, i: usize, raceway: usize, moved: [f64; 2]) -> RollerView {
        let (s, c) = libm::sincos(state.angle[i] + self.starts[i].vertex_angle);
        let [x, y] = [state.x[i], state.y[i]];
        let centre = if raceway == 0 { [x - moved[0], y - moved[1]] } else { [x, y] };
        RollerView { centre, spin: [c, s], velocity: [0.0; 2], turning: 0.0, larger: self.larger[i] }
    }
}
