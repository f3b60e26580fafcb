//! Films of eight rollers on a land of a raceway, side by side (THEORY §4.6, §9.4): nearest places, and
//! forces of the oil.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};
use stribeck_surface::film::{
    Land, Place, WIDEST,
    side_by_side::{Gaps, Layers, PushedRows, Wanted},
};
use stribeck_surface::smooth::{bend, height, slope};

use super::{FIXED, Film, FilmStep, Films, OiledRaceway, Rim, RollerView, nearest::Curved};
use crate::row::{Row, Rows, lanes, load, of_one, store};

/// Corrections of the nearest place in a step: from that of the step before one leaves a millionth of a
/// facet, by whose square the gap is off.
const CORRECTIONS: usize = 1;

/// A place farther from its facet than this, in facets, is looked for facet by facet.
const STRAYED: f64 = 0.5;

/// State of the films of eight rollers with a raceway, land by land; those of rollers whose rims are formed
/// are taken one by one.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockFilms {
    /// Rollers with round rims, a bit for each.
    round: u64,
    /// Lands of the outer and of the inner raceway.
    pub(crate) on: [Vec<EightFilms>; 2],
}

/// Films of eight rollers on one land.
#[derive(Debug, Clone, Default)]
pub(crate) struct EightFilms {
    /// Those that there are, and those too pressed to change, a bit for each.
    present: u64,
    fixed: u64,
    layers: Layers,
    /// Facets that they lie on, and shares of their second nodes.
    facet: [u32; LANES],
    along: Row,
    /// Curves of the facets: as [`stribeck_surface::film::FacetCurve`] says.
    origin: Rows,
    tangent: Rows,
    length: Row,
    rise: Rows,
    before: Row,
    behind: Row,
}

/// Eight rollers in the frame of a raceway's outline, as [`RollerView`] of one.
#[derive(Debug, Clone, Default)]
pub(crate) struct SeenRollers {
    pub(crate) centre: Rows,
    pub(crate) spin: Rows,
    pub(crate) velocity: Rows,
    pub(crate) turning: Row,
    pub(crate) larger: Row,
}

impl SeenRollers {
    /// Replaces one of them.
    #[cfg(test)]
    pub(super) fn set(&mut self, lane: usize, seen: &RollerView) {
        for c in 0..2 {
            self.centre[c][lane] = seen.centre[c];
            self.spin[c][lane] = seen.spin[c];
            self.velocity[c][lane] = seen.velocity[c];
        }
        self.turning[lane] = seen.turning;
    }

    /// One of them.
    pub(crate) fn one(&self, lane: usize) -> RollerView {
        RollerView {
            centre: of_one(&self.centre, lane),
            spin: of_one(&self.spin, lane),
            velocity: of_one(&self.velocity, lane),
            turning: self.turning[lane],
            larger: self.larger[lane],
        }
    }
}

/// Where eight films lie in a step.
#[derive(Debug, Default)]
struct Nearby {
    gaps: Gaps,
    /// Directions from the rollers to the land.
    d: Rows,
}

impl BlockFilms {
    /// Those of the rollers from `first` on, `count` in all, as a state has them.
    pub(super) fn of(
        raceways: &[OiledRaceway; 2],
        rims: &[Rim],
        rim_of: &[u32],
        films: &Films,
        [first, count]: [usize; 2],
    ) -> Self {
        let is_round = |lane: &usize| matches!(rims[rim_of[first + lane] as usize], Rim::Round(_));
        let mut block = Self {
            round: (0..count).filter(is_round).map(|lane| 1 << lane).sum(),
            on: raceways.each_ref().map(|race| vec![EightFilms::default(); race.lands()]),
        };
        for ((race, lands), films) in raceways.iter().zip(&mut block.on).zip(&films.at) {
            for (n, film) in films[race.lands() * first..][..race.lands() * count].iter().enumerate() {
                let (lane, land) = (n / race.lands(), n % race.lands());
                lands[land].load(race, land, lane, film);
            }
        }
        block
    }

    /// Leaves films as they are now to those of all rollers.
    pub(crate) fn store(&self, first: usize, count: usize, films: &mut Films) {
        for (lands, films) in self.on.iter().zip(&mut films.at) {
            for lane in lanes(self.round).take(count) {
                let of_roller = films[lands.len() * (first + lane)..].iter_mut();
                lands.iter().zip(of_roller).for_each(|(eight, film)| *film = eight.film(lane));
            }
        }
    }

    /// Rollers with round rims, a bit for each.
    pub(crate) fn round(&self) -> u64 {
        self.round
    }
}

impl EightFilms {
    /// Sets the state of one film.
    pub(crate) fn load(&mut self, race: &OiledRaceway, land: usize, lane: usize, film: &Film) {
        let bit = 1 << lane;
        self.present &= !bit;
        if let Some(layer) = &film.layer {
            self.present |= bit;
            self.layers.set(lane, layer);
        }
        self.fixed = (self.fixed & !bit) | (u64::from(film.fixed) << lane);
        self.lie_on(&race.curved, &race.curved.lands[land], lane, film.places[0]);
    }

    pub(crate) fn film(&self, lane: usize) -> Film {
        let layer = (self.present >> lane) & 1 == 1;
        let place = Place { facet: self.facet[lane], along: self.along[lane] };
        Film {
            layer: layer.then(|| self.layers.get(lane)),
            places: [place, Place::default()],
            fixed: (self.fixed >> lane) & 1 == 1,
        }
    }

    /// Places a film on the land.
    fn lie_on(&mut self, curved: &Curved, land: &Land, lane: usize, place: Place) {
        let curve = curved.curve(land, place.facet);
        (self.facet[lane], self.along[lane]) = (place.facet, place.along);
        (self.length[lane], self.before[lane], self.behind[lane]) =
            (curve.length, curve.before, curve.behind);
        for c in 0..2 {
            self.origin[c][lane] = curve.origin[c];
            self.tangent[c][lane] = curve.tangent[c];
            self.rise[c][lane] = curve.rise[c];
        }
    }

    /// Those that are not here, a bit for each of `all`.
    pub(crate) fn missing(&self, all: u64) -> u64 {
        all & !self.present
    }

    /// One step of the films of those rollers that have one, whose rims are circles of a `radius` [m].
    /// Forces on the rollers are added to `force` [N], in the frame of the raceway; returns their forces,
    /// none where there is none.
    #[inline(always)]
    pub(crate) fn flow<S: Simd>(
        &mut self,
        simd: S,
        race: &OiledRaceway,
        land: usize,
        (seen, radius, round): (&SeenRollers, f64, u64),
        now: FilmStep,
        force: &mut Rows,
    ) -> Option<PushedRows> {
        let mut films = self.present & round;
        if !now.step.is_multiple_of(FIXED) {
            films &= !self.fixed;
        }
        if films == 0 {
            return None;
        }
        let (law, on) = (&race.films[land], &race.curved.lands[land]);
        let mut near = Nearby::default();
        let [strayed, wide] = self.nearest(simd, race, land, (seen, radius), films, &mut near);
        if strayed & films != 0 {
            for lane in lanes(strayed & films) {
                let place = race.curved.nearest(on, of_one(&seen.centre, lane), self.film(lane).places[0]);
                self.lie_on(&race.curved, on, lane, place.place);
            }
            self.nearest(simd, race, land, (seen, radius), films, &mut near);
        }
        self.walk(&race.curved, on, films);
        self.present &= !(wide & films);
        films &= !wide;
        let mut pushed = PushedRows::default();
        let wanted = Wanted { dt: now.dt, films, energy: now.last };
        law.flow_eight(simd, &mut self.layers, &near.gaps, wanted, &mut pushed);
        self.fixed = (self.fixed & !films) | pushed.fixed;
        for at in vector_starts(simd) {
            let size = Vector::load(simd, &pushed.force.0, at);
            let ([dx, dy], [fx, fy]) = (load(simd, &near.d, at), load(simd, force, at));
            // Where there is no roller its direction is no number, and nothing times that is none either.
            let (half, these) = (Vector::all(simd, 0.5), Vector::ones(simd, films >> at));
            let pushed = [[dx, fx], [dy, fy]]
                .map(|[d, had]| half.choose_below(these, (-size).times_plus(d, had), had));
            store(pushed, force, at);
        }
        Some(pushed)
    }

    /// Films whose nearest place is past an end of its facet go on to the next one, on which the next step
    /// finds them.
    #[inline(always)]
    fn walk(&mut self, curved: &Curved, land: &Land, films: u64) {
        for lane in lanes(films) {
            let along = self.along[lane];
            if (0.0..=1.0).contains(&along) {
                continue;
            }
            let forward = along > 1.0;
            let place = match curved.beside(land, self.facet[lane], forward) {
                Some(facet) => {
                    let along = if forward { along - 1.0 } else { along + 1.0 };
                    Place { facet, along: along.clamp(0.0, 1.0) }
                }
                None => Place { facet: self.facet[lane], along: along.clamp(0.0, 1.0) },
            };
            self.lie_on(curved, land, lane, place);
        }
    }

    /// Where rollers with these `films` are nearest to their facets. Returns those that are far beyond an end
    /// of it, and those between whom and the land no oil stays.
    #[inline(always)]
    fn nearest<S: Simd>(
        &mut self,
        simd: S,
        race: &OiledRaceway,
        land: usize,
        (seen, radius): (&SeenRollers, f64),
        films: u64,
        near: &mut Nearby,
    ) -> [u64; 2] {
        let (law, on) = (&race.films[land], &race.curved.lands[land]);
        let all = |value: f64| Vector::all(simd, value);
        let (zero, one, half) = (all(0.0), all(1.0), all(0.5));
        let (mut strayed, mut wide) = (0, 0);
        for at in vector_starts(simd) {
            let ([cx, cy], [ox, oy]) = (load(simd, &seen.centre, at), load(simd, &self.origin, at));
            let [tx, ty] = load(simd, &self.tangent, at);
            let (rise, length) = (load(simd, &self.rise, at), Vector::load(simd, &self.length, at));
            let (px, py) = (cx - ox, cy - oy);
            let (along, off) = (px.times_plus(tx, py * ty), px.times_plus(ty, -(py * tx)));
            let had = Vector::load(simd, &self.along, at);
            let mut s = had;
            for _ in 0..CORRECTIONS {
                let (e, de, dde) = (height(rise, s), slope(rise, s), bend(rise, s));
                let beyond = off - e;
                let rest = (along - s * length).times_plus(length, beyond * de);
                let stiff = length.times_plus(length, de.times_plus(de, -(beyond * dde)));
                s = s + rest / stiff;
            }
            let (before, behind) =
                (Vector::load(simd, &self.before, at), Vector::load(simd, &self.behind, at));
            if !on.is_closed() {
                // Ends are never passed.
                s = before.choose_below(half, s.max(zero), s);
                s = (behind - one).choose_below(half, s.min(one), s);
            }
            let from_middle = s - half;
            strayed |= all(0.5 + STRAYED).bits_below(from_middle.max(-from_middle)) << at;
            half.choose_below(Vector::ones(simd, films >> at), s, had).store(&mut self.along, at);
            let (e, de) = (height(rise, s), slope(rise, s) / length);
            let (u, h) = (s * length - along, e - off);
            let to = [u.times_plus(tx, h * ty), u.times_plus(ty, -(h * tx))];
            let distance = to[0].times_plus(to[0], to[1] * to[1]).sqrt();
            let d = [to[0] / distance, to[1] / distance];
            let gap = distance - (all(radius) + Vector::load(simd, &seen.larger, at));
            wide |= all(WIDEST).bits_below(gap) << at;
            let [vx, vy] = load(simd, &seen.velocity, at);
            let across = d[0].times_plus(vy, -(d[1] * vx));
            let curvature = all(on.curvature);
            let mut swept = across / curvature.times_plus(distance, one);
            let mut turned = -(curvature * swept);
            let mut share = one;
            if !on.is_closed() {
                let ends = [(before + s) * length, (behind - s) * length];
                let normal = [ty - de * tx, -(tx + de * ty)];
                let steep = de.times_plus(de, one).sqrt();
                let tilt = (normal[1].times_plus(d[0], -(normal[0] * d[1]))) / steep;
                share = law.shares(simd, ends, tilt, &self.layers, at);
                // The closest approach stays at the end of a land, and d turns about it.
                let nearer = ends[0].min(ends[1]);
                swept = zero.choose_below(nearer, swept, zero);
                turned = zero.choose_below(nearer, turned, -(across / distance));
            }
            let turning = Vector::load(simd, &seen.turning, at);
            let speed = half * (turning - turned).times_plus(distance - gap, -swept);
            gap.store(&mut near.gaps.gap.0, at);
            speed.store(&mut near.gaps.speed.0, at);
            share.store(&mut near.gaps.share.0, at);
            store(d, &mut near.d, at);
        }
        [strayed, wide]
    }
}
