//! Oil between rollers and raceways: the films of the full model between the circles that the polygons stand for (THEORY §4.6, §9.4).
//!
//! A film follows from where a roller is and how it moves; what it remembers is in the state. A bearing without oil has nothing of
//! this.

mod give;
mod nearest;

use serde::{Deserialize, Serialize};
use stribeck_contact::{Error as ContactError, FilmLaw, Land, Layer, Oil, Place, Pushed, WIDEST};
use stribeck_scene::{
    geometry::Geometry,
    lubrication::{self, LoadedFilm},
    scene::Scene,
};
use stribeck_simd::lanes::LANES;

use crate::{
    bearing::{self, Bearing, Track},
    block::Block,
    error::Error,
    row::of_one,
    state::State,
};
use give::Give;
use nearest::{Curved, Nearest, Rim, Seen, begin};

/// Steps between two looks for a film where there is none.
const REST: u64 = 128;

/// Steps between two looks at a film that is too pressed to change.
const FIXED: u64 = 4;

/// The oil of a bearing.
#[derive(Debug, Clone)]
pub(crate) struct Lubrication {
    /// Of the outer and the inner raceway.
    pub(crate) races: [Race; 2],
    /// Rims of rollers, in the order of the bearing's.
    rims: Vec<Rim>,
}

/// The lands of a raceway, with the law of a film on each.
#[derive(Debug, Clone)]
pub(crate) struct Race {
    curved: Curved,
    films: Vec<FilmLaw<Give>>,
    /// Entrainment speed of rolling without slip [m/s].
    speed: f64,
}

/// What films remember from step to step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Films {
    /// At the outer and the inner raceway, land by land of one roller after the other.
    pub(crate) at: [Vec<Film>; 2],
    /// Heat since the start [J].
    pub(crate) heat: f64,
}

/// What one film remembers.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Film {
    /// The oil; `None` where there is no film.
    layer: Option<Layer>,
    /// Where it is on the raceway and on the rim.
    places: [Place; 2],
    /// So thin and so pressed that nothing can change for some steps.
    fixed: bool,
}

/// The present step of all films.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Now {
    pub(crate) step: u64,
    pub(crate) dt: f64,
    /// Whether energy is asked for.
    pub(crate) last: bool,
}

/// What films do to a roller in a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Lifted {
    /// Sum of the sizes of their forces [N].
    pub(crate) normal: f64,
    /// Force on the roller [N] in the frame of the raceway, and moment about its centre [N m].
    pub(crate) force: [f64; 2],
    pub(crate) moment: f64,
    /// Heat, and energy that their springs hold beside those of contact [J].
    pub(crate) heat: f64,
    pub(crate) stored: f64,
}

/// How the shaft turns: cosine and sine of its angle, and its angular velocity [rad/s].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shaft {
    pub(crate) turned: [f64; 2],
    pub(crate) rate: f64,
}

impl Bearing {
    /// Films before the first step, with the rollers as they stand in a state.
    pub(crate) fn first_films(&self, state: &State) -> Option<Films> {
        let oil = self.oil.as_ref()?;
        let mut films = Films { at: [Vec::new(), Vec::new()], heat: 0.0 };
        for i in 0..self.rollers {
            for (k, race) in oil.races.iter().enumerate() {
                let seen = self.seen_at_rest(state, i, k, [0.0; 2]);
                let rim = oil.rim(self.rim_of[i]);
                let places = |land| begin(&race.curved, land, rim, &seen);
                let of_roller = race.curved.lands.iter().map(places);
                films.at[k].extend(of_roller.map(|places| Film { places, ..Film::default() }));
            }
        }
        Some(films)
    }

    /// A roller as outer (0) or inner (1) raceway see it, the former displaced; how it moves does not matter.
    fn seen_at_rest(&self, state: &State, i: usize, raceway: usize, moved: [f64; 2]) -> Seen {
        let (s, c) = (state.angle[i] + self.vertex_angle[i]).sin_cos();
        let (ss, sc) = state.shaft.sin_cos();
        let back = |[x, y]: [f64; 2]| [sc * x + ss * y, sc * y - ss * x];
        let (centre, spin) = match raceway {
            0 => ([state.x[i] - moved[0], state.y[i] - moved[1]], [c, s]),
            _ => (back([state.x[i], state.y[i]]), back([c, s])),
        };
        Seen { centre, spin, velocity: [0.0; 2], turning: 0.0 }
    }

    /// Forces on a roller by the films of steady rolling at both raceways, towards the inner and the outer one [N].
    pub(crate) fn carried_by_oil(&self, state: &mut State, i: usize, moved: [f64; 2]) -> [f64; 2] {
        let (Some(oil), Some(mut films)) = (&self.oil, state.films.take()) else { return [0.0; 2] };
        let mut forces = [0.0; 2];
        for (k, race) in oil.races.iter().enumerate() {
            let seen = self.seen_at_rest(state, i, k, moved);
            let [x, y] = seen.centre;
            let [fx, fy] =
                race.carried(oil.rim(self.rim_of[i]), race.of_roller(&mut films.at[k], i), &seen).force;
            forces[k] = (fx * x + fy * y) / x.hypot(y);
        }
        state.films = Some(films);
        [-forces[0], forces[1]]
    }

    /// Between which distances from the bearing's centre a roller floats in oil [m]; `None` when it has no clearance, or no oil.
    pub(crate) fn floating(&self, state: &mut State, i: usize, moved: [f64; 2]) -> Option<[f64; 2]> {
        let oil = self.oil.as_ref()?;
        let mut films = state.films.take()?;
        let gaps = [0, 1].map(|k| {
            let (race, seen) = (&oil.races[k], self.seen_at_rest(state, i, k, moved));
            race.gap(oil.rim(self.rim_of[i]), race.of_roller(&mut films.at[k], i), &seen)
        });
        state.films = Some(films);
        let at = state.x[i].hypot(state.y[i]);
        Some([at - gaps[1], at + gaps[0]]).filter(|[low, high]| low < high)
    }

    /// Adds what films do to eight rollers, and to the shaft: the moment that the drive makes good [N m]. `normal` becomes what they carry
    /// at the outer raceway [N], and `stored` grows by what their springs hold [J].
    #[inline(never)]
    #[expect(clippy::too_many_arguments, reason = "one kind of force, with all that it reads and adds to")]
    pub(crate) fn lift_rollers(
        &self,
        oil: &Lubrication,
        films: &mut Films,
        block: &mut Block,
        shaft: Shaft,
        now: Now,
        normal: &mut [f64; LANES],
        stored: &mut f64,
    ) -> f64 {
        let Shaft { turned: [c, s], rate } = shaft;
        let mut on_drive = 0.0;
        for lane in 0..block.count {
            let i = block.first + lane;
            let rim = oil.rim(self.rim_of[i]);
            let ([x, y], [vx, vy]) = (of_one(&block.centre, lane), of_one(&block.velocity, lane));
            let distance = block.distance[lane];
            let [mx, my] = of_one(&block.moving, lane);
            let [tx, ty] = of_one(&block.tilt, lane);
            let orbit = (x * vy - y * vx) / (distance * distance);
            let velocities = [
                // The raceway under the roller moves with the modes, and because the roller goes on to another place of it.
                [vx - mx - orbit * tx, vy - my - orbit * ty],
                {
                    let [rx, ry] = [vx + rate * y, vy - rate * x];
                    [c * rx + s * ry, c * ry - s * rx]
                },
            ];
            for (k, race) in oil.races.iter().enumerate() {
                let contacts = &block.contacts[k];
                let seen = Seen {
                    centre: of_one(&contacts.centre, lane),
                    spin: of_one(&contacts.spin, lane),
                    velocity: velocities[k],
                    turning: block.spin[lane] - if k == 0 { 0.0 } else { rate },
                };
                let lifted = race.lift(rim, race.of_roller(&mut films.at[k], i), &seen, now);
                let [fx, fy] = lifted.force;
                let [fx, fy] = if k == 0 { [fx, fy] } else { [c * fx - s * fy, s * fx + c * fy] };
                block.force[k][0][lane] += fx;
                block.force[k][1][lane] += fy;
                block.moment[lane] += lifted.moment;
                if k == 0 {
                    // As of contact: the roller goes downhill along a raceway that is displaced more or less.
                    let uphill = (fx * tx + fy * ty) / distance;
                    let [rx, ry] = of_one(&block.radial, lane);
                    block.downhill[0][lane] += uphill * ry;
                    block.downhill[1][lane] -= uphill * rx;
                    normal[lane] = lifted.normal;
                } else {
                    on_drive += x * fy - y * fx + lifted.moment;
                }
                films.heat += lifted.heat;
                *stored += lifted.stored;
            }
        }
        on_drive
    }
}

impl Lubrication {
    /// The oil of a scene between these raceways and rims, on a penalty [N/m²]; `None` without any.
    pub(crate) fn new(
        scene: &Scene,
        tracks: [&Track; 2],
        rims: &[bearing::Rim],
        penalty: f64,
    ) -> Result<Option<Self>, Error> {
        let g = Geometry::of(scene);
        let (Some(film), Some(loaded)) = (g.film, lubrication::loaded_films(scene)?) else { return Ok(None) };
        let [round, others @ ..] = rims else { return Ok(None) };
        let curvature = Curved::new("rim of a roller", &round.outline, false)?.lands[0].curvature;
        let race = |track: &Track, loaded: LoadedFilm| -> Result<Race, Error> {
            let curved = Curved::new("raceway", &track.outline, track.sides.along)?;
            let oil = Oil { viscosity: film.viscosity, least: loaded.least };
            let law = |land: &Land| {
                let relative = curvature + land.curvature;
                if relative <= 0.0 {
                    let reason = "is too narrow for its rollers: a film needs a larger radius";
                    return Err(ContactError::BadSurface { name: "raceway".into(), reason });
                }
                let give = Give::new(penalty, 1.0 / relative, &track.compliance);
                Ok(FilmLaw::new(oil, 1.0 / relative, g.thickness, give))
            };
            let films = curved.lands.iter().map(law).collect::<Result<_, _>>()?;
            Ok(Race { curved, films, speed: loaded.speed })
        };
        let formed = |rim: &bearing::Rim| -> Result<Rim, Error> {
            Ok(Rim::Formed(Box::new(Curved::new("rim of a roller", &rim.outline, false)?)))
        };
        let others = others.iter().map(formed).collect::<Result<Vec<_>, _>>()?;
        let [outer, inner] = loaded;
        Ok(Some(Self {
            races: [race(tracks[0], outer)?, race(tracks[1], inner)?],
            rims: std::iter::once(Rim::Round(round.top)).chain(others).collect(),
        }))
    }

    /// The rim of this number.
    fn rim(&self, number: u32) -> &Rim {
        &self.rims[number as usize]
    }

    /// Whether films may be those of rollers with these rims.
    pub(crate) fn fits(&self, films: &Films, rim_of: &[u32]) -> bool {
        self.races.iter().zip(&films.at).all(|(race, films)| {
            let lands = race.films.len();
            let fits = |(n, film): (usize, &Film)| {
                let [on_race, on_rim] = film.places;
                let on_rim = match self.rim(rim_of[n / lands]) {
                    Rim::Round(_) => true,
                    Rim::Formed(rim) => rim.holds(on_rim),
                };
                race.curved.holds(on_race) && on_rim
            };
            films.len() == lands * rim_of.len() && films.iter().enumerate().all(fits)
        })
    }
}

impl Race {
    /// What the films of a roller do in a step.
    fn lift(&self, rim: &Rim, films: &mut [Film], seen: &Seen, now: Now) -> Lifted {
        let mut lifted = Lifted::default();
        for ((law, land), film) in self.films.iter().zip(&self.curved.lands).zip(films) {
            if film.layer.is_none() {
                if !now.step.is_multiple_of(REST) {
                    continue;
                }
                // From anywhere: a land may come into reach at its other end.
                film.places = begin(&self.curved, land, rim, seen);
            } else if film.fixed && !now.step.is_multiple_of(FIXED) {
                continue;
            }
            let nearest = Nearest::new(&self.curved, land, rim, seen, &mut film.places);
            if nearest.gap > WIDEST {
                film.layer = None;
                continue;
            }
            let speed = nearest.speed(seen, land);
            let pushed = match &mut film.layer {
                Some(layer) => {
                    let share = law.share(nearest.ends, nearest.tilt, layer);
                    law.flow(layer, nearest.gap, speed, share, now.dt)
                }
                None => {
                    let share = law.share(nearest.ends, nearest.tilt, &Layer::at(nearest.gap));
                    let (layer, pushed) = law.settled(nearest.gap, speed, share);
                    film.layer = Some(layer);
                    pushed
                }
            };
            film.fixed = pushed.fixed;
            lifted.add(&nearest, &pushed);
            if now.last {
                lifted.stored += law.stored(&pushed);
            }
        }
        lifted
    }

    /// The smallest gap between a roller and its lands [m].
    fn gap(&self, rim: &Rim, films: &mut [Film], seen: &Seen) -> f64 {
        let each = self.curved.lands.iter().zip(films);
        let gap = |(land, film): (&Land, &mut Film)| {
            Nearest::new(&self.curved, land, rim, seen, &mut film.places).gap
        };
        each.map(gap).fold(f64::INFINITY, f64::min)
    }

    /// What the films of a roller carry in steady rolling.
    fn carried(&self, rim: &Rim, films: &mut [Film], seen: &Seen) -> Lifted {
        let mut lifted = Lifted::default();
        for ((law, land), film) in self.films.iter().zip(&self.curved.lands).zip(films) {
            let nearest = Nearest::new(&self.curved, land, rim, seen, &mut film.places);
            if nearest.gap <= WIDEST {
                let share = law.share(nearest.ends, nearest.tilt, &Layer::at(nearest.gap));
                lifted.add(&nearest, &law.settled(nearest.gap, self.speed, share).1);
            }
        }
        lifted
    }

    /// The films of a roller among those of all.
    fn of_roller<'a>(&self, films: &'a mut [Film], roller: usize) -> &'a mut [Film] {
        let lands = self.films.len();
        &mut films[lands * roller..lands * (roller + 1)]
    }

    /// Thickness of the thinnest film of a roller [m]; the widest that holds one where there is none.
    pub(crate) fn thickness(&self, films: &[Film], roller: usize) -> f64 {
        let lands = self.films.len();
        let own = &films[lands * roller..lands * (roller + 1)];
        let of = |(law, film): (&FilmLaw<Give>, &Film)| film.layer.map(|layer| law.thickness(&layer));
        self.films.iter().zip(own).filter_map(of).fold(WIDEST, f64::min)
    }
}

impl Films {
    /// Forgets what films there are, but not where they are.
    pub(crate) fn forget(&mut self) {
        self.at.iter_mut().flatten().for_each(|film| (film.layer, film.fixed) = (None, false));
    }
}

impl Lifted {
    fn add(&mut self, nearest: &Nearest, pushed: &Pushed) {
        let force = pushed.force;
        self.normal += force;
        self.force[0] -= force * nearest.d[0];
        self.force[1] -= force * nearest.d[1];
        self.moment += force * nearest.lever;
        self.heat += pushed.heat;
    }
}

#[cfg(test)]
mod tests;
