//! What films of oil do to rollers, and through them to modes and rings, in a step and at the start (THEORY
//! §9.4, §9.5).

use stribeck_simd::lanes::LANES;

use crate::{
    drive::RingRotation,
    oil::{FilmStep, Films, Lubrication, RollerView},
    rollers::{Rollers, block::Block},
    row::of_one,
    state::State,
};

/// What films do to eight rollers, beside the forces on these.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct OilForces {
    /// Normal force at the outer raceway [N], and its decrease as the raceway recedes [N/m].
    pub(crate) normal: [f64; LANES],
    pub(crate) stiffness: [f64; LANES],
    /// Moments that the drives of outer and inner ring make good [N m].
    pub(crate) drive: [f64; 2],
    /// What their springs hold beside those of contact [J].
    pub(crate) stored: f64,
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
            (fx * x + fy * y) / x.hypot(y)
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
        let at = state.x[i].hypot(state.y[i]);
        Some([at - gaps[1], at + gaps[0]]).filter(|[low, high]| low < high)
    }

    /// Adds the forces of films to those on eight rollers between the raceways, the outer and the inner one
    /// of which turn as given.
    #[inline(never)]
    pub(crate) fn add_film_forces(
        &self,
        rollers: &Rollers,
        films: &mut Films,
        block: &mut Block,
        turning: [Option<RingRotation>; 2],
        now: FilmStep,
    ) -> OilForces {
        let mut by_oil = OilForces::default();
        for lane in 0..block.count {
            let i = block.first + lane;
            let rim = self.rim(rollers.rim_of[i]);
            let [x, y] = of_one(&block.centre, lane);
            let velocity @ [vx, vy] = of_one(&block.velocity, lane);
            let ([bx, by], [mx, my]) = (of_one(&block.by, lane), of_one(&block.moving, lane));
            let [tx, ty] = of_one(&block.tilt, lane);
            let distance = block.distance[lane];
            let orbit = (x * vy - y * vx) / (distance * distance);
            // The outer raceway under the roller moves with the modes, and because the roller goes on to
            // another place of it.
            let from_raceway = [[x - bx, y - by], [x, y]];
            let relative = [[vx - mx - orbit * tx, vy - my - orbit * ty], velocity];
            for (k, race) in self.raceways.iter().enumerate() {
                let ([x, y], [rx, ry]) = (from_raceway[k], relative[k]);
                let RingRotation { rate, turned } = turning[k].unwrap_or(RingRotation::STILL);
                let [rx, ry] = [rx + rate * y, ry - rate * x];
                let contacts = &block.contacts[k];
                let seen = RollerView {
                    centre: of_one(&contacts.centre, lane),
                    spin: of_one(&contacts.spin, lane),
                    velocity: turned.back([rx, ry]),
                    turning: block.spin[lane] - rate,
                };
                let now = FilmStep { felt: now.felt && k == 0, ..now };
                let by_film = race.film_forces(rim, race.of_roller(&mut films.at[k], i), &seen, now);
                let [fx, fy] = turned.forth(by_film.force);
                block.force[k][0][lane] += fx;
                block.force[k][1][lane] += fy;
                block.moment[lane] += by_film.moment;
                by_oil.drive[k] += x * fy - y * fx + by_film.moment;
                by_oil.stored += by_film.stored;
                films.heat += by_film.heat;
                if k == 0 {
                    // As of contact: downhill along a raceway that is displaced more or less (THEORY §9.3).
                    let uphill = (fx * tx + fy * ty) / distance;
                    let [rx, ry] = of_one(&block.radial, lane);
                    block.downhill[0][lane] += uphill * ry;
                    block.downhill[1][lane] -= uphill * rx;
                    (by_oil.normal[lane], by_oil.stiffness[lane]) = (by_film.normal, by_film.stiffness);
                }
            }
        }
        by_oil
    }
}

impl Rollers {
    /// A roller as the outer (0) or the inner (1) raceway sees it before the first step, the former
    /// displaced.
    fn view_at_rest(&self, state: &State, i: usize, raceway: usize, moved: [f64; 2]) -> RollerView {
        let (s, c) = (state.angle[i] + self.starts[i].vertex_angle).sin_cos();
        let [x, y] = [state.x[i], state.y[i]];
        let centre = if raceway == 0 { [x - moved[0], y - moved[1]] } else { [x, y] };
        RollerView { centre, spin: [c, s], velocity: [0.0; 2], turning: 0.0 }
    }
}
