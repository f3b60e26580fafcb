//! Oil films between a roller and a raceway with a groove, without the bodies behind them: where they push,
//! and how much.

use std::f64::consts::TAU;

use stribeck_contact::{FilmResultant, FilmSpec, Films, Oil, Surface};
use stribeck_solver::{
    Force,
    state::{Moment, NodeForces},
};

/// Raceway, roller, groove [m] and out-of-plane thickness [m]: the paper's.
const RACEWAY: f64 = 0.1;
const RADIUS: f64 = 9e-3;
const HALF_GROOVE: f64 = 5e-3;
const DEPTH: f64 = 0.2e-3;
const LENGTH: f64 = 30e-3;

/// Oil [Pa s, m] and entrainment speed [m/s].
const VISCOSITY: f64 = 0.05;
const LEAST: f64 = 0.5e-6;
const SPEED: f64 = 2.4;

/// Penalty stiffness [Pa/m].
const STIFFNESS: f64 = 2e13;

/// Nodes of a raceway with a groove at its top, of a roller, and of its centre.
struct Model {
    x: Vec<f64>,
    y: Vec<f64>,
    ring: Surface,
    rim: Surface,
    rim_at: std::ops::Range<usize>,
    centre: usize,
    turned: f64,
}

impl Model {
    fn new() -> Self {
        let (mut x, mut y) = (Vec::new(), Vec::new());
        let mut add = |r: f64, angle: f64| {
            x.push(r * angle.cos());
            y.push(r * angle.sin());
            x.len() as u32 - 1
        };
        // The solid lies outside: clockwise, from the end of the groove all round to its beginning, then
        // along its floor.
        let (half, top) = (HALF_GROOVE / RACEWAY, 0.25 * TAU);
        let (land, floor) = (1200, 20);
        let mut ring: Vec<u32> = (0..=land)
            .map(|i| add(RACEWAY, top - half - (TAU - 2.0 * half) * f64::from(i) / f64::from(land)))
            .collect();
        ring.extend(
            (0..=floor)
                .map(|i| add(RACEWAY + DEPTH, top + half - 2.0 * half * f64::from(i) / f64::from(floor))),
        );
        let first = ring.len();
        let rim: Vec<u32> = (0..112).map(|i| add(RADIUS, TAU * f64::from(i) / 112.0)).collect();
        let centre = add(0.0, 0.0) as usize;
        let ring = Surface::new("raceway", ring, true, &x, &y).expect("a surface");
        let rim = Surface::new("rim", rim, true, &x, &y).expect("a surface");
        Self { x, y, ring, rim, rim_at: first..centre, centre, turned: 0.0 }
    }

    /// Turns the roller about its centre to an angle and puts that at `r`, `along` the raceway from the
    /// middle of the groove [m].
    fn place(&mut self, r: f64, along: f64, turned: f64) {
        let (cx, cy) = (self.x[self.centre], self.y[self.centre]);
        let angle = 0.25 * TAU - along / RACEWAY;
        let (nx, ny) = (r * angle.cos(), r * angle.sin());
        let (s, c) = (turned - self.turned).sin_cos();
        for n in self.rim_at.clone() {
            let (dx, dy) = (self.x[n] - cx, self.y[n] - cy);
            (self.x[n], self.y[n]) = (nx + c * dx - s * dy, ny + s * dx + c * dy);
        }
        (self.x[self.centre], self.y[self.centre]) = (nx, ny);
        self.turned = turned;
    }

    /// Turns the raceway about one of its points.
    fn tilt(&mut self, by: f64, [px, py]: [f64; 2]) {
        let (s, c) = by.sin_cos();
        for n in 0..self.rim_at.start {
            let (dx, dy) = (self.x[n] - px, self.y[n] - py);
            (self.x[n], self.y[n]) = (px + c * dx - s * dy, py + s * dx + c * dy);
        }
    }

    fn films(&self) -> Films {
        let oil = Oil { viscosity: VISCOSITY, least: LEAST };
        let centre = self.centre as u32;
        let spec =
            FilmSpec { round: 1, centre, track: 0, oil, stiffness: STIFFNESS, length: LENGTH, speed: SPEED };
        Films::new(vec![self.ring.clone(), self.rim.clone()], &[spec], LENGTH, &self.x, &self.y)
            .expect("a film")
    }

    /// Forces of a film in steady rolling; forces and their moment must cancel.
    fn steady(&self, films: &mut Films) -> FilmResultant {
        /// Of a few dozen products of forces of some 100 N.
        const ROUNDING: f64 = 1e-11;
        let rest = vec![0.0; self.x.len()];
        let mut force = NodeForces::zeros(self.x.len());
        films.set_preload(true);
        let at = Moment { step: 0, time: 0.0, dt: 0.0, x: &self.x, y: &self.y, vx: &rest, vy: &rest };
        films.accumulate(at, &mut force);
        let (mut sum, mut scale) = ([0.0; 3], 0.0);
        for n in 0..self.x.len() {
            sum[0] += force.fx[n];
            sum[1] += force.fy[n];
            sum[2] += (self.x[n] * force.fy[n] - self.y[n] * force.fx[n]) / RACEWAY;
            scale += force.fx[n].abs() + force.fy[n].abs();
        }
        assert!(sum.iter().all(|s| s.abs() <= ROUNDING * scale), "{sum:?} of {scale} N");
        films.resultants().next().expect("one film")
    }
}

/// Away from the groove W = 4.895 ηuRL/h (H. M. Martin, Engineering 102 (1916) 119) with the relative radius
/// of a roller in a raceway, wherever nodes lie; over the middle of the groove the same with its floor.
#[test]
fn analytic_films_on_the_raceway_and_on_the_floor() {
    /// Shares of the land's ends, and what springs give: 0.2 µm of 20.
    const TOLERANCE: f64 = 0.02;
    let mut model = Model::new();
    let mut films = model.films();
    for (along, race, gap) in [
        (0.1, RACEWAY, 20e-6),
        (0.10013, RACEWAY, 20e-6),
        (0.10026, RACEWAY, 5e-6),
        (-0.1, RACEWAY, 20e-6),
        (0.0, RACEWAY + DEPTH, 30e-6),
        (0.11e-3, RACEWAY + DEPTH, 30e-6),
    ] {
        for turned in [0.0, 0.011, 0.028] {
            model.place(race - RADIUS - gap, along, turned);
            let film = model.steady(&mut films);
            let radius = 1.0 / (1.0 / RADIUS - 1.0 / race);
            let force = film.force[0].hypot(film.force[1]);
            let expected = 4.895 * VISCOSITY * SPEED * radius * LENGTH / film.thickness;
            assert!((force / expected - 1.0).abs() < TOLERANCE, "{along}: {force} N, not {expected} N");
            let given = film.thickness - LEAST - gap;
            let spring = 4.0 / 3.0 * STIFFNESS * LENGTH * (2.0 * radius).sqrt() * given.powf(1.5);
            assert!(
                (force / spring - 1.0).abs() < TOLERANCE,
                "{along}: {force} N, not {spring} N of springs"
            );
        }
    }
}

/// Nodes of fine meshes shake by nanometres, which moves the nearest places by micrometres within a few steps
/// of nanoseconds. Taken for a speed of rolling that made physical.ron run away within 15 µs.
#[test]
fn issue_a_raceway_that_tilts_to_and_fro_draws_in_no_oil() {
    /// What springs give.
    const TOLERANCE: f64 = 0.05;
    const STEP: f64 = 3.5e-9;
    const GAP: f64 = 5e-6;
    let mut model = Model::new();
    let mut films = model.films();
    films.set_preload(false);
    let rest = vec![0.0; model.x.len()];
    for step in 0..3000_u64 {
        let way = SPEED * STEP * step as f64;
        model.place(RACEWAY - RADIUS - GAP, 0.1 + way, way * (1.0 / RADIUS - 1.0 / RACEWAY));
        if step % 64 == 40 {
            // By 10 nm over 0.1 mm, which moves the places by 1 µm.
            let (s, c) = (0.25 * TAU - (0.1 + way) / RACEWAY).sin_cos();
            let by = if step % 128 == 40 { 1e-4 } else { -1e-4 };
            model.tilt(by, [RACEWAY * c, RACEWAY * s]);
        }
        let (time, mut force) = (STEP * step as f64, NodeForces::zeros(model.x.len()));
        let at = Moment { step, time, dt: STEP, x: &model.x, y: &model.y, vx: &rest, vy: &rest };
        films.accumulate(at, &mut force);
        let film = films.resultants().next().expect("one film");
        let carried = film.force[0].hypot(film.force[1]);
        let radius = 1.0 / (1.0 / RADIUS - 1.0 / RACEWAY);
        let expected = 4.895 * VISCOSITY * SPEED * radius * LENGTH / film.thickness;
        assert!((carried / expected - 1.0).abs() < TOLERANCE, "step {step}: {carried} N, not {expected} N");
    }
}

/// A film that a roller is led through pays for all that its force does on nodes, in the step in which it
/// moves to other points, too: what it stores and dissipates is that work, by the trapezoidal rule of central
/// differences. The step into a look was once taken as wholly done at the old points, which lost
/// F u² Δt/2R, 607 µJ a millisecond of the paper's bearing on 1 mm at 1000 rpm.
#[test]
fn conserves_the_energy_of_a_film_that_follows_a_roller() {
    /// Of the work that the points' moves alone would lose: what trapezoids leave of the springs' energy.
    const REMAINDER: f64 = 0.02;
    const STEP: f64 = 1.4e-7;
    let mut model = Model::new();
    let mut films = model.films();
    films.set_preload(false);
    let (mut before, mut force) = ([model.x.clone(), model.y.clone()], NodeForces::zeros(model.x.len()));
    let (mut work, mut lost, mut begun) = (0.0, 0.0, None);
    for step in 0..4000_u64 {
        let way = SPEED * STEP * step as f64;
        // The gap breathes, so that springs and oil take part.
        let gap = 8e-6 + 2e-6 * (4000.0 * way).sin();
        model.place(RACEWAY - RADIUS - gap, 0.1 + way, way * (1.0 / RADIUS - 1.0 / RACEWAY));
        let moved =
            |now: &[f64], then: &[f64]| -> Vec<f64> { now.iter().zip(then).map(|(a, b)| a - b).collect() };
        let [dx, dy] = [moved(&model.x, &before[0]), moved(&model.y, &before[1])];
        let [vx, vy] = [&dx, &dy].map(|by| by.iter().map(|d| d / STEP).collect::<Vec<f64>>());
        let done = |force: &NodeForces| -> f64 {
            (0..dx.len()).map(|n| 0.5 * (force.fx[n] * dx[n] + force.fy[n] * dy[n])).sum()
        };
        let by_old = done(&force);
        force = NodeForces::zeros(model.x.len());
        let (time, x, y) = (STEP * step as f64, &model.x[..], &model.y[..]);
        films.accumulate(Moment { step, time, dt: STEP, x, y, vx: &vx, vy: &vy }, &mut force);
        let energy = films.energy();
        let held = energy.stored + energy.damping;
        let film = films.resultants().next().expect("one film");
        // Entrainment speeds are taken from the second look on.
        if step > 200 {
            work += by_old + done(&force);
            lost += film.force[0].hypot(film.force[1]) * SPEED * SPEED * STEP * STEP / (2.0 * RADIUS);
            let off = held + work - *begun.get_or_insert(held + work);
            assert!(off.abs() < REMAINDER * lost.max(1e-7), "step {step}: {off} J of {lost} J");
        }
        before = [model.x.clone(), model.y.clone()];
    }
    assert!(lost > 4e-7, "{lost} J");
}

/// On a roller that is led over the groove the film fades and returns, without a jump. In the middle of
/// the groove only the floor carries, with the share that a squeeze film between two open ends has: ∫ X²/(1 +
/// X²)³ dX between them over π/8, by quadrature (A. Cameron, The Principles of Lubrication, Longmans 1966,
/// chapter 7).
#[test]
fn analytic_a_groove_fades_the_film_in_and_out() {
    /// From place to place, 5 µm apart, of the force on the healthy raceway; the film is a millimetre wide.
    const STEP: f64 = 0.02;
    /// Shares of both ends are multiplied, which is right to 0.2 %, and lengths are those of the nearest
    /// facet.
    const TOLERANCE: f64 = 0.02;
    let gap = 10e-6;
    let mut model = Model::new();
    let mut films = model.films();
    let mut force_at = |along: f64| {
        model.place(RACEWAY - RADIUS - gap, along, 0.0);
        let film = model.steady(&mut films);
        film.force[0].hypot(film.force[1])
    };
    let whole = force_at(0.1);
    let mut last = force_at(-8e-3);
    let mut largest = 0.0_f64;
    for n in -1600..=1600 {
        let along = 5e-6 * f64::from(n);
        let force = force_at(along);
        let jump = (force - last) / whole;
        assert!(jump.abs() < STEP, "{along}: from {last} to {force} N of {whole} N");
        (largest, last) = (largest.max(jump), force);
    }
    assert!(largest > 1e-4, "{largest}");
    let radius = 1.0 / (1.0 / RADIUS - 1.0 / (RACEWAY + DEPTH));
    let thickness = DEPTH + gap + LEAST;
    let edge = HALF_GROOVE / (2.0 * radius * thickness).sqrt();
    let step = edge / 1000.0;
    let share: f64 = (0..1000)
        .map(|n| (f64::from(n) + 0.5) * step)
        .map(|x| 2.0 * x * x / (1.0 + x * x).powi(3) * step * 8.0 / std::f64::consts::PI)
        .sum();
    let floor = share * 4.895 * VISCOSITY * SPEED * radius * LENGTH / thickness;
    let middle = force_at(0.0);
    assert!((middle / floor - 1.0).abs() < TOLERANCE, "{middle} N, not {floor} N");
}
