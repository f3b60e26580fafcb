//! The nearest places of roller and raceway, on the smooth curves that their outlines represent, and the
//! entrainment speed there.

use stribeck_surface::film::{FacetCurve, Land, Place, Point};
use stribeck_surface::{Error as SurfaceError, Smoothing, Surface};

use crate::{contact::outline::Outline, error::Error, plane::Rotation};

/// The smooth curve that an outline stands for, in the frame of its body.
#[derive(Debug, Clone)]
pub(crate) struct Curved {
    x: Vec<f64>,
    y: Vec<f64>,
    surface: Surface,
    /// Its parts between corners.
    pub(crate) lands: Vec<Land>,
}

/// The rim of a roller, about its centre.
#[derive(Debug, Clone)]
pub(crate) enum Rim {
    /// A circle of this radius [m].
    Round(f64),
    /// One that deviates from it.
    Formed(Box<Curved>),
}

/// A roller in the frame of a raceway's outline.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RollerView {
    /// Centre [m] and direction of vertex 0.
    pub(crate) centre: [f64; 2],
    pub(crate) spin: [f64; 2],
    /// Velocity of the centre [m/s] and angular velocity [rad/s].
    pub(crate) velocity: [f64; 2],
    pub(crate) turning: f64,
    /// By how much its radius exceeds that of its rim [m], where that is round.
    pub(crate) larger: f64,
}

/// The closest approach of a roller and a land.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest {
    /// Gap [m]; negative where they overlap.
    pub(crate) gap: f64,
    /// Direction from the roller to the land.
    pub(crate) d: [f64; 2],
    /// Distance from the roller's centre to the land [m].
    distance: f64,
    /// Moment about the roller's centre of a unit force along d on the land [m].
    pub(crate) lever: f64,
    /// How far off the land ends on both sides [m].
    pub(crate) ends: [f64; 2],
    /// Sine of the angle between d and the land's normal: not zero at an end.
    pub(crate) tilt: f64,
}

impl Curved {
    /// The curve through an outline around its solid, or with `hollow` within it.
    ///
    /// # Errors
    /// When facets meet at such angles that no film lies across a vertex.
    pub(crate) fn new(name: &str, outline: &Outline, hollow: bool) -> Result<Self, Error> {
        let mut slots: Vec<u32> = (0..outline.len() as u32).collect();
        if hollow {
            slots.reverse();
        }
        let (x, y) = (outline.x.clone(), outline.y.clone());
        let surface = Surface::new(name, slots, true, &x, &y)?.smoothed(Smoothing::Nagata, &x, &y)?;
        let lands = Land::of(&surface, &x, &y);
        if lands.is_empty() {
            let reason = "has nothing but corners, which no film lies across: oil needs facets that meet at \
                less than 20°, by `mesh.size_mm`, `mesh.outer_facets` and `mesh.inner_facets`";
            return Err(SurfaceError::BadSurface { name: name.to_owned(), reason }.into());
        }
        Ok(Self { x, y, surface, lands })
    }

    /// The rim of a roller: one land all around.
    pub(crate) fn rim(outline: &Outline) -> Result<Self, Error> {
        let name = "rim of a roller";
        let reason = "has corners: oil needs rollers whose facets meet at less than 20°; take more \
            `mesh.roller_facets`, 19 at least";
        let corners = || SurfaceError::BadSurface { name: name.to_owned(), reason };
        let curved = Self::new(name, outline, false).map_err(|_| corners())?;
        if curved.lands.len() == 1 { Ok(curved) } else { Err(corners().into()) }
    }

    pub(crate) fn holds(&self, place: Place) -> bool {
        (place.facet as usize) < self.surface.facets() && (0.0..=1.0).contains(&place.along)
    }

    fn begin(&self, land: &Land, point: [f64; 2]) -> Place {
        land.begin(&self.surface, &self.x, &self.y, point)
    }

    pub(super) fn nearest(&self, land: &Land, point: [f64; 2], from: Place) -> Point {
        land.nearest(&self.surface, &self.x, &self.y, point, from)
    }
}

impl Curved {
    pub(super) fn curve(&self, land: &Land, facet: u32) -> FacetCurve {
        land.curve(&self.surface, &self.x, &self.y, facet)
    }

    pub(super) fn beside(&self, land: &Land, facet: u32, forward: bool) -> Option<u32> {
        land.beside(&self.surface, facet, forward)
    }
}

impl RollerView {
    /// A point [m] in the frame of the roller.
    fn by_roller(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        Rotation::to(self.spin).back([x - self.centre[0], y - self.centre[1]])
    }
}

/// Places on a land of a raceway and on a rim to search from.
pub(crate) fn begin(race: &Curved, land: &Land, rim: &Rim, seen: &RollerView) -> [Place; 2] {
    let on_race = race.begin(land, seen.centre);
    let on_rim = match rim {
        Rim::Round(_) => Place::default(),
        Rim::Formed(rim) => {
            let foot = race.nearest(land, seen.centre, on_race);
            rim.begin(&rim.lands[0], seen.by_roller(foot.at))
        }
    };
    [on_race, on_rim]
}

impl Nearest {
    /// Of a roller and a land of a raceway, walking on from other places.
    pub(crate) fn new(
        race: &Curved,
        land: &Land,
        rim: &Rim,
        seen: &RollerView,
        places: &mut [Place; 2],
    ) -> Self {
        let foot = race.nearest(land, seen.centre, places[0]);
        places[0] = foot.place;
        let to = [foot.at[0] - seen.centre[0], foot.at[1] - seen.centre[1]];
        let distance = (to[0] * to[0] + to[1] * to[1]).sqrt();
        let (gap, d, lever) = match rim {
            Rim::Round(radius) => {
                (distance - (radius + seen.larger), [to[0] / distance, to[1] / distance], 0.0)
            }
            Rim::Formed(rim) => {
                let own = seen.by_roller(foot.at);
                let point = rim.nearest(&rim.lands[0], own, places[1]);
                places[1] = point.place;
                let [nx, ny] = point.normal;
                let gap = nx * (own[0] - point.at[0]) + ny * (own[1] - point.at[1]);
                (gap, Rotation::to(seen.spin).forth(point.normal), point.at[1] * nx - point.at[0] * ny)
            }
        };
        let ends = land.to_ends(&race.surface, foot.place);
        Self { gap, d, distance, lever, ends, tilt: foot.tilt([-d[0], -d[1]]) }
    }

    /// Entrainment speed [m/s]: half the sum of the speeds of both surfaces past the closest approach.
    pub(crate) fn speed(&self, seen: &RollerView, land: &Land) -> f64 {
        let along = self.d[0] * seen.velocity[1] - self.d[1] * seen.velocity[0];
        let on_land = self.ends.iter().all(|&end| end > 0.0);
        // The closest approach stays at the end of a land, and d turns about it.
        let swept = if on_land { along / (1.0 + land.curvature * self.distance) } else { 0.0 };
        let turned = if on_land { -land.curvature * swept } else { -along / self.distance };
        0.5 * ((seen.turning - turned) * (self.distance - self.gap) - swept)
    }
}
