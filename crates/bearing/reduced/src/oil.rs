//! Oil between rollers and raceways: the films of the full model between the circles that the polygons stand
//! for (THEORY §4.6, §9.4).
//!
//! A film follows from the position and velocity of a roller, and from its own state. A bearing without oil
//! has none of it.

mod bodies;
mod eight;
mod nearest;

use crate::modal::parameters as modal;
use serde::{Deserialize, Serialize};
use stribeck_surface::Error as SurfaceError;
use stribeck_surface::film::{FilmLaw, Land, Layer, Oil, Place, Pushed, WIDEST};

use crate::{
    contact::{outline::Outline, raceway::Raceway},
    error::Error,
};
use bodies::BodySpring;
pub(crate) use eight::{BlockFilms, SeenRollers};
pub(crate) use nearest::RollerView;
use nearest::{Curved, Nearest, Rim};

/// Steps between two looks for a film where there is none.
const REST: u64 = 128;

/// Steps between two looks at a film that is too pressed to change.
const FIXED: u64 = 4;

#[derive(Debug, Clone)]
pub(crate) struct Lubrication {
    pub(crate) raceways: [OiledRaceway; 2],
    /// Rims of rollers, in the order of the bearing's.
    rims: Vec<Rim>,
}

/// The lands of a raceway, with the law of a film on each.
#[derive(Debug, Clone)]
pub(crate) struct OiledRaceway {
    curved: Curved,
    films: Vec<FilmLaw<BodySpring>>,
    /// Entrainment speed of rolling without slip [m/s].
    speed: f64,
}

/// State of the films.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Films {
    /// At the outer and the inner raceway, land by land of one roller after the other.
    pub(crate) at: [Vec<Film>; 2],
    /// Heat since the start [J].
    pub(crate) heat: f64,
}

/// State of one film.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Film {
    /// The oil; `None` where there is no film.
    layer: Option<Layer>,
    /// Where it is on the raceway and on the rim.
    places: [Place; 2],
    /// So thin and so pressed that nothing can change for some steps.
    fixed: bool,
}

impl Films {
    /// Largest force that one at the outer raceway carries [N].
    pub(crate) fn most_at_outer(&self) -> f64 {
        self.at[0].iter().filter_map(|film| film.layer).map(|layer| layer.force).fold(0.0, f64::max)
    }
}

/// The present step of all films.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FilmStep {
    pub(crate) step: u64,
    pub(crate) dt: f64,
    pub(crate) last: bool,
    /// Whether the seat responds to them.
    pub(crate) felt: bool,
}

impl FilmStep {
    /// Whether films are looked for where there are none.
    pub(crate) fn looks(&self) -> bool {
        self.step.is_multiple_of(REST)
    }
}

/// Results of a step of the films of a roller.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct FilmForces {
    /// Sum of the sizes of their forces [N], and where the seat responds to them, their decrease as the
    /// raceway gives way, the oil staying as thick as it is [N/m].
    pub(crate) normal: f64,
    pub(crate) stiffness: f64,
    /// Force on the roller [N] in the frame of the raceway, and moment about its centre [N m].
    pub(crate) force: [f64; 2],
    pub(crate) moment: f64,
    /// Heat, and energy that their springs hold beside those of contact [J].
    pub(crate) heat: f64,
    pub(crate) stored: f64,
}

impl Lubrication {
    /// Oil between the outer and the inner raceway and rims of rollers, a round one and others, on a penalty
    /// [N/m²] of the bodies.
    pub(crate) fn new(
        oil: &modal::Oil,
        raceways: &[Raceway; 2],
        (round, others): (&Outline, &[&Outline]),
        penalty: f64,
    ) -> Result<Self, Error> {
        let curvature = Curved::rim(round)?.lands[0].curvature;
        let race = |name: &str, on: &Raceway, hollow, loaded: modal::Film| -> Result<OiledRaceway, Error> {
            let curved = Curved::new(name, &on.outline, hollow)?;
            let length = oil.length;
            let oil = Oil { viscosity: oil.viscosity, least: loaded.least };
            let law = |land: &Land| {
                let relative = curvature + land.curvature;
                if relative <= 0.0 {
                    let reason = "is too narrow for its rollers: a film needs a larger radius than \
                                  `bearing.roller_diameter_mm` has";
                    return Err(SurfaceError::BadSurface { name: name.to_owned(), reason });
                }
                let give = BodySpring::new(penalty, 1.0 / relative, &on.compliance);
                Ok(FilmLaw::new(oil, 1.0 / relative, length, give))
            };
            let films = curved.lands.iter().map(law).collect::<Result<_, _>>()?;
            Ok(OiledRaceway { curved, films, speed: loaded.speed })
        };
        let [outer, inner] = raceways;
        let formed = |rim: &&Outline| Curved::rim(rim).map(|rim| Rim::Formed(Box::new(rim)));
        let others = others.iter().map(formed).collect::<Result<Vec<_>, _>>()?;
        Ok(Self {
            raceways: [
                race("outer raceway", outer, true, oil.outer)?,
                race("inner raceway", inner, false, oil.inner)?,
            ],
            rims: std::iter::once(Rim::Round(round.x[0])).chain(others).collect(),
        })
    }

    pub(crate) fn rim(&self, number: u32) -> &Rim {
        &self.rims[number as usize]
    }

    /// The films of a block of rollers with these rims, the first and number of which are given.
    pub(crate) fn block_films(&self, rim_of: &[u32], films: &Films, of: [usize; 2]) -> BlockFilms {
        BlockFilms::of(&self.raceways, &self.rims, rim_of, films, of)
    }

    /// Radius of rims that are round [m].
    pub(crate) fn radius(&self) -> f64 {
        match self.rims[..] {
            [Rim::Round(radius), ..] => radius,
            _ => 0.0,
        }
    }

    pub(crate) fn fits(&self, films: &Films, rim_of: &[u32]) -> bool {
        self.raceways.iter().zip(&films.at).all(|(race, films)| {
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

impl OiledRaceway {
    /// Films of a roller before the first step: none yet, but known places.
    pub(crate) fn first_films(&self, rim: &Rim, seen: &RollerView) -> impl Iterator<Item = Film> {
        let places = |land| nearest::begin(&self.curved, land, rim, seen);
        self.curved.lands.iter().map(move |land| Film { places: places(land), ..Film::default() })
    }

    /// Advances the film of a roller on one of the lands by a step.
    pub(crate) fn film_force(
        &self,
        land: usize,
        rim: &Rim,
        film: &mut Film,
        seen: &RollerView,
        now: FilmStep,
    ) -> FilmForces {
        let mut by_film = FilmForces::default();
        let (law, land) = (&self.films[land], &self.curved.lands[land]);
        if film.layer.is_none() {
            if !now.looks() {
                return by_film;
            }
            // From anywhere: a land may come into reach at its other end.
            film.places = nearest::begin(&self.curved, land, rim, seen);
        } else if film.fixed && !now.step.is_multiple_of(FIXED) {
            return by_film;
        }
        let nearest = Nearest::new(&self.curved, land, rim, seen, &mut film.places);
        if nearest.gap > WIDEST {
            film.layer = None;
            return by_film;
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
        by_film.add(&nearest, &pushed);
        if let (true, Some(layer)) = (now.felt, film.layer) {
            // The force of dry contact there responds separately.
            let [all, dry] =
                [layer.force, layer.force - pushed.force].map(|force| law.spring.stiffness(force));
            by_film.stiffness += all - dry;
        }
        if now.last {
            by_film.stored += law.stored(&pushed);
        }
        by_film
    }

    /// The smallest gap between a roller and its lands [m].
    pub(crate) fn gap(&self, rim: &Rim, films: &mut [Film], seen: &RollerView) -> f64 {
        let each = self.curved.lands.iter().zip(films);
        let gap = |(land, film): (&Land, &mut Film)| {
            Nearest::new(&self.curved, land, rim, seen, &mut film.places).gap
        };
        each.map(gap).fold(f64::INFINITY, f64::min)
    }

    /// Forces of the films of a roller in steady rolling.
    pub(crate) fn carried(&self, rim: &Rim, films: &mut [Film], seen: &RollerView) -> FilmForces {
        let mut by_film = FilmForces::default();
        for ((law, land), film) in self.films.iter().zip(&self.curved.lands).zip(films) {
            let nearest = Nearest::new(&self.curved, land, rim, seen, &mut film.places);
            if nearest.gap <= WIDEST {
                let share = law.share(nearest.ends, nearest.tilt, &Layer::at(nearest.gap));
                by_film.add(&nearest, &law.settled(nearest.gap, self.speed, share).1);
            }
        }
        by_film
    }

    /// Lands, each of which may hold a film of every roller.
    pub(crate) fn lands(&self) -> usize {
        self.films.len()
    }

    pub(crate) fn of_roller<'a>(&self, films: &'a mut [Film], roller: usize) -> &'a mut [Film] {
        let lands = self.films.len();
        &mut films[lands * roller..lands * (roller + 1)]
    }

    /// Thickness of the thinnest film of a roller [m]; the widest that holds one where there is none.
    pub(crate) fn thickness(&self, films: &[Film], roller: usize) -> f64 {
        let lands = self.films.len();
        self.thinnest(films[lands * roller..lands * (roller + 1)].iter().copied()).min(WIDEST)
    }

    /// Thickness of the thinnest of the films of a roller on all lands [m], endless where there is none.
    pub(crate) fn thinnest(&self, films: impl Iterator<Item = Film>) -> f64 {
        let of = |(law, film): (&FilmLaw<BodySpring>, Film)| film.layer.map(|layer| law.thickness(&layer));
        self.films.iter().zip(films).filter_map(of).fold(f64::INFINITY, f64::min)
    }
}

impl Films {
    /// Removes the films, but keeps their places.
    pub(crate) fn forget(&mut self) {
        self.at.iter_mut().flatten().for_each(|film| (film.layer, film.fixed) = (None, false));
    }
}

impl FilmForces {
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
