use std::f64::consts::{PI, SQRT_2, TAU};

use crate::modal::compliance::Compliance;
use pulp::{Arch, Simd, WithSimd};
use stribeck_simd::lanes::LANES;

use super::{eight::EightFilms, *};
use crate::{contact::outline::Outline, row::Rows};

/// The paper's raceways and roller [m], its oil and a roller's mass [kg].
const OUTER: f64 = 0.1;
const INNER: f64 = 0.08198;
const RADIUS: f64 = 9e-3;
const LENGTH: f64 = 30e-3;
const OIL: Oil = Oil { viscosity: 0.05, least: 0.5e-6 };
const MASS: f64 = 0.06;

/// Penalty [N/m²] and flexibility behind it [m/N].
const PENALTY: f64 = 6e11;
const FLEXIBILITY: f64 = 2e-9;

fn race(radius: f64, hollow: bool) -> OiledRaceway {
    raceway(|_| radius, hollow)
}

/// A raceway with a radius at each angle.
fn raceway(radius: impl Fn(f64) -> f64, hollow: bool) -> OiledRaceway {
    let vertices: Vec<[f64; 2]> = (0..1200)
        .map(|i| TAU * f64::from(i) / 1200.0)
        .map(|angle| [radius(angle) * angle.cos(), radius(angle) * angle.sin()])
        .collect();
    let curved = Curved::new("raceway", &Outline::new(&vertices), hollow).expect("a surface");
    let loads = [1.0, 1e4];
    let compliance = Compliance::through(&loads, &loads.map(|load| FLEXIBILITY * load), 48);
    let law = |land: &Land| {
        let relative = 1.0 / (1.0 / RADIUS + land.curvature);
        FilmLaw::new(OIL, relative, LENGTH, BodySpring::new(PENALTY, relative, &compliance))
    };
    OiledRaceway { films: curved.lands.iter().map(law).collect(), curved, speed: 0.0 }
}

fn on_x_axis(at: f64, velocity: [f64; 2], turning: f64) -> RollerView {
    RollerView { centre: [at, 0.0], spin: [1.0, 0.0], velocity, turning, larger: 0.0 }
}

/// A roller under its weight between the raceways: place, velocity and thickness of the outer film above
/// the least, by F = 3√2 π η L (R/h)^{3/2} (−ḣ) in the film that closes, nothing in the one that opens (A.
/// Cameron, The Principles of Lubrication, Longmans 1966, chapter 7), and springs in series.
struct Sinking {
    at: [f64; 3],
}

impl Sinking {
    const WEIGHT: f64 = 200.0;

    fn rates([x, v, above]: [f64; 3]) -> [f64; 3] {
        let relative = 1.0 / (1.0 / RADIUS - 1.0 / OUTER);
        let hardness = 4.0 / 3.0 * PENALTY * (2.0 * relative).sqrt();
        let depth = above - (OUTER - RADIUS - x);
        let (mut low, mut high) = (0.0, 1e5);
        for _ in 0..60 {
            let force: f64 = 0.5 * (low + high);
            let given = (force / hardness).powf(2.0 / 3.0) + FLEXIBILITY * force;
            if given < depth { low = force } else { high = force }
        }
        let resistance =
            3.0 * SQRT_2 * PI * OIL.viscosity * LENGTH * (relative / (above + OIL.least)).powf(1.5);
        [v, (Self::WEIGHT - low) / MASS, -low / resistance]
    }

    /// A step of the method of Runge and Kutta.
    fn step(&mut self, dt: f64) {
        let known = self.at;
        let ahead = |rate: [f64; 3], by: f64| std::array::from_fn(|c| known[c] + by * rate[c]);
        let a = Self::rates(known);
        let b = Self::rates(ahead(a, 0.5 * dt));
        let c = Self::rates(ahead(b, 0.5 * dt));
        let d = Self::rates(ahead(c, dt));
        self.at = std::array::from_fn(|n| known[n] + dt / 6.0 * (a[n] + 2.0 * (b[n] + c[n]) + d[n]));
    }
}

/// The thickness of the film under a roller that is driven into it from 10 µm to 3.5 µm, where the circles
/// are about to overlap and contact would act, too, against [`Sinking`]; the film goes by implicit steps of
/// the first order. A. Cameron, The Principles of Lubrication, Longmans 1966, chapter 7.
#[test]
fn analytic_a_roller_sinks_through_its_film() {
    // At 0.15 m/s it closes by its own thickness in some 25 µs: steps of 0.125 µs leave about as much as they
    // are of that, and half as much half as long.
    const TOLERANCE: f64 = 0.01;
    const ORDER: std::ops::Range<f64> = 0.8..1.2;
    let raceways = [race(OUTER, true), race(INNER, false)];
    let rim = Rim::Round(RADIUS);
    let start = 0.5 * (OUTER + INNER);
    let farthest = |dt: f64| {
        let (mut x, mut v) = (start, 0.0);
        let mut films = [[Film::default()], [Film::default()]];
        let mut known = Sinking { at: [start, 0.0, OUTER - RADIUS - start] };
        let (mut off, mut thickness) = (0.0_f64, 1.0);
        let mut step = 0;
        while thickness > 3.5e-6 {
            assert!(step as f64 * dt < 1e-3, "the film stays at {thickness} m");
            let now = FilmStep { step, dt, last: false, felt: false };
            let mut force = Sinking::WEIGHT;
            for (race, films) in raceways.iter().zip(&mut films) {
                force += race.film_force(0, &rim, &mut films[0], &on_x_axis(x, [v, 0.0], 0.0), now).force[0];
            }
            thickness = raceways[0].thickness(&films[0], 0);
            off = off.max((thickness / (known.at[2] + OIL.least) - 1.0).abs());
            v += dt * force / MASS;
            x += dt * v;
            (0..4).for_each(|_| known.step(0.25 * dt));
            step += 1;
        }
        off
    };
    let [coarse, fine] = [0.125e-6, 0.0625e-6].map(farthest);
    assert!(coarse < TOLERANCE, "{coarse}");
    assert!(ORDER.contains(&(coarse / fine).log2()), "{coarse}, {fine}");
}

/// Rolling without slip both surfaces sweep past a contact as fast as the contact past the raceway (THEORY
/// §5.1); pivoting about a corner without slip draws in nothing; a roller that spins in place draws in half
/// of its own speed. Plane kinematics of a rolling circle: T. A. Harris, Rolling Bearing Analysis, Wiley
/// 2001, chapter 8.
#[test]
fn analytic_entrainment_follows_from_rolling() {
    const ROUNDING: f64 = 1e-9;
    // A gap of 20 µm over 9 mm; the curve through 1200 vertices has the radius of the circle but for 1e-6.
    const GAP: f64 = 3e-3;
    let at = OUTER - RADIUS - 20e-6;
    let (orbit, rim) = (-24.0, Rim::Round(RADIUS));
    let mut places = [Place::default(); 2];
    for (radius, hollow, shaft) in [(OUTER, true, 0.0), (INNER, false, -52.0)] {
        let race = race(radius, hollow);
        let land = &race.curved.lands[0];
        // In the frame of the raceway.
        let orbit = orbit - shaft;
        let sign = if hollow { 1.0 } else { -1.0 };
        let rolling = on_x_axis(at, [0.0, orbit * at], -sign * orbit * at / RADIUS);
        let speed = Nearest::new(&race.curved, land, &rim, &rolling, &mut places).speed(&rolling, land).abs();
        assert!((speed / (orbit * radius).abs() - 1.0).abs() < GAP, "{speed} m/s");
        let spinning = on_x_axis(at, [0.0; 2], 200.0);
        let nearest = Nearest::new(&race.curved, land, &rim, &spinning, &mut places);
        assert!((nearest.speed(&spinning, land) / (100.0 * RADIUS) - 1.0).abs() < ROUNDING);
    }
}

/// The energy of springs is the integral of their force.
#[test]
fn patch_springs_hold_the_work_that_presses_them_in() {
    // Simpson's rule over 200 steps of a force that grows with the 3/2nd power.
    const QUADRATURE: f64 = 1e-5;
    let law = &race(OUTER, true).films[0];
    let most = 3e-6;
    let mut work = 0.0;
    for i in 0..200 {
        let [a, b] = [i, i + 1].map(|n| most * f64::from(n) / 200.0);
        let f = [a, 0.5 * (a + b), b].map(|depth| stribeck_surface::film::Spring::force(&law.spring, depth));
        work += (b - a) / 6.0 * (f[0] + 4.0 * f[1] + f[2]);
    }
    let pushed = Pushed { pressed: [most, 0.0], ..Pushed::default() };
    assert!((law.stored(&pushed) / work - 1.0).abs() < QUADRATURE, "{} J, {work} J", law.stored(&pushed));
}

/// Eight rollers that roll over a raceway with a groove, while they beat against it and off again: in vectors
/// and one by one their films are as thick, push as hard and make as much heat.
struct Rolling<'a> {
    race: &'a OiledRaceway,
    steps: u64,
}

impl WithSimd for Rolling<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // The place where a film ends is known to 10⁻⁶ in either; the next step makes up for the error of one
        // for, so that sums agree as well.
        const TOLERANCE: f64 = 1e-4;
        let (rim, dt, race) = (Rim::Round(RADIUS), 1e-6, self.race);
        let seen = |step: u64, lane: usize| {
            let (time, turn) = (dt * step as f64, 40.0);
            let angle = 0.06 * lane as f64 + turn * time;
            let beats = 3000.0 * (1.0 + 0.1 * lane as f64) * time;
            // From an overlap of 1.5 µm to a gap of 28.5 µm.
            let at = OUTER - RADIUS - 13.5e-6 + 15e-6 * beats.sin();
            let outwards = 15e-6 * 3000.0 * (1.0 + 0.1 * lane as f64) * beats.cos();
            let ((s, c), along) = (angle.sin_cos(), turn * at);
            let velocity = [outwards * c - along * s, outwards * s + along * c];
            RollerView {
                centre: [at * c, at * s],
                spin: [1.0, 0.0],
                velocity,
                turning: -along / RADIUS,
                larger: 0.0,
            }
        };
        let mut eights = vec![EightFilms::default(); race.lands()];
        let mut alone: Vec<Vec<Film>> =
            (0..LANES).map(|lane| race.first_films(&rim, &seen(0, lane)).collect()).collect();
        let (mut heat, mut most) = ([0.0; 2], 0.0_f64);
        for step in 0..self.steps {
            let now = FilmStep { step, dt, last: true, felt: true };
            let mut row = SeenRollers::default();
            (0..LANES).for_each(|lane| row.set(lane, &seen(step, lane)));
            for (land, eight) in eights.iter_mut().enumerate() {
                let mut force = Rows::default();
                let radius = (&row, RADIUS, 0xff);
                let pushed = eight.flow(simd, race, land, radius, now, &mut force).unwrap_or_default();
                for (lane, films) in alone.iter_mut().enumerate() {
                    let had = films[land].layer.is_some();
                    let by_film = race.film_force(land, &rim, &mut films[land], &seen(step, lane), now);
                    if !had {
                        eight.load(race, land, lane, &films[land]);
                        continue;
                    }
                    heat = [heat[0] + by_film.heat, heat[1] + pushed.heat.0[lane]];
                    most = most.max(by_film.normal);
                    let scale = by_film.normal.abs().max(1.0);
                    let off = [
                        (force[0][lane] - by_film.force[0]) / scale,
                        (force[1][lane] - by_film.force[1]) / scale,
                        (pushed.stored.0[lane] - by_film.stored) / (scale * 1e-6),
                    ];
                    assert!(off.iter().all(|off| off.abs() < TOLERANCE), "{step} {lane} {land}: {off:?}");
                    let thick =
                        |film: &Film| film.layer.map_or(0.0, |layer| race.films[land].thickness(&layer));
                    let [a, b] = [&films[land], &eight.film(lane)].map(thick);
                    assert!((a / b - 1.0).abs() < TOLERANCE || a == b, "{step} {lane}: {a} and {b} m");
                }
            }
        }
        assert!((heat[0] / heat[1] - 1.0).abs() < TOLERANCE && most > 100.0, "{heat:?} J, {most} N");
    }
}

#[test]
fn invariant_films_of_eight_rollers_are_those_of_one() {
    let groove = |angle: f64| if (0.3..0.4).contains(&angle) { OUTER + 3e-4 } else { OUTER };
    let race = raceway(groove, true);
    assert_eq!(race.lands(), 2);
    Arch::new().dispatch(Rolling { race: &race, steps: 6000 });
    Rolling { race: &race, steps: 1000 }.with_simd(pulp::Scalar::new());
}
