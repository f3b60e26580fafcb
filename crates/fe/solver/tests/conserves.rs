//! Conserved quantities of a free body: linear and angular momentum, energy, shape under spin.
//!
//! Leapfrog with total-Lagrangian elements conserves the momenta to rounding, whatever the step; the energy
//! ½ m v⁻·v⁺ + U is exact for a linear force and wobbles with the strain for this one (Hairer, Lubich and
//! Wanner,
//! *Geometric Numerical Integration*, 2006, §I.1.4 and §VI.6).

mod common;

use std::f64::consts::TAU;

use common::*;
use stribeck_mesh::Disc;
use stribeck_solver::{Dynamics, Force, Model, NodeMotion, force::NodalLoad};
use stribeck_testing::{Noise, assert_refused};

/// A disc of 36 mm in cells of about 5 mm: 60 nodes, quadrilaterals and triangles.
fn disc() -> Model {
    let part = Disc { radius: 0.018, facets: 24, size: 5e-3, rotation: 0.1 }.part();
    body(&part.expect("a disc that can be made"))
}

/// Random velocities of up to `speed` [m/s] and a spin [rad/s] about the origin.
fn stir(d: &mut Dynamics, speed: f64, spin: f64) {
    let mut noise = Noise::new(11);
    for n in massive(d) {
        d.state.vx[n] = speed * noise.uniform() - spin * d.state.y[n];
        d.state.vy[n] = speed * noise.uniform() + spin * d.state.x[n];
    }
}

#[test]
fn conserves_momentum_of_a_vibrating_disc() {
    let mut d = ready(&disc(), 0.9);
    stir(&mut d, 1.0, 300.0);
    // Ten thousand steps add ten thousand roundings of a sum of 60 terms; they walk at random.
    let tolerance = 1e-12;
    let before = momentum(&d);
    let (mut speed, mut moment) = (0.0, 0.0);
    for n in massive(&d) {
        let p = d.mass()[n] * d.state.vx[n].hypot(d.state.vy[n]);
        speed += p;
        moment += p * d.state.x[n].hypot(d.state.y[n]);
    }
    run(&mut d, &mut [], 10_000);
    let after = momentum(&d);
    for i in 0..3 {
        let scale = if i < 2 { speed } else { moment };
        let drift = (after[i] - before[i]).abs() / scale;
        assert!(drift < tolerance, "component {i} drifts by {drift:e}");
    }
}

#[test]
fn conserves_momentum_across_seams_of_tiles() {
    // Tiles are cut across rows here, each at another column: strips on seams begin with other elements in
    // either tile.
    let mut d = ready(&body(&rectangle(0.21, 0.031, 420, 62)), 0.9);
    let wave = |x: f64, y: f64| (15.0 * x).cos() * (50.0 * y + 0.3).sin();
    for n in massive(&d) {
        let v = wave(d.state.x[n], d.state.y[n]);
        [d.state.vx[n], d.state.vy[n]] = [v, -v];
    }
    let (speed, before) =
        (massive(&d).into_iter().map(|n| d.mass()[n] * d.state.vx[n].abs()).sum::<f64>(), momentum(&d));
    run(&mut d, &mut [], 500);
    let after = momentum(&d);
    for i in 0..2 {
        // Sums of 26 000 terms are rounded to some 1e-15 of them; 500 steps walk at random.
        let drift = (after[i] - before[i]).abs() / speed;
        assert!(drift < 2e-14, "component {i} drifts by {drift:e}");
    }
}

#[test]
fn conserves_energy_over_a_million_steps() {
    let mut d = ready(&body(&rectangle(0.01, 0.008, 5, 4)), 0.45);
    // 3 mm/s is a strain of 6e-7, so that the force is linear to about as much. What bends of it is balanced
    // to second order in the step: ten millimetres a second give 1.3e-6. Positions of 1 cm are rounded to
    // 2e-18 m, 1e-9 of displacements of some nanometres, and walk a thousand times as far in a million steps:
    // one millimetre a second gives 1.4e-6. In between neither matters.
    stir(&mut d, 3e-3, 0.0);
    let start = step_and_balance(&mut d, &mut []).mechanical();
    let mut worst = 0.0_f64;
    let mut hourglass = 0.0_f64;
    for _ in 0..10_000 {
        run(&mut d, &mut [], 99);
        let now = step_and_balance(&mut d, &mut []);
        worst = worst.max((now.mechanical() - start).abs() / start);
        hourglass = hourglass.max(now.hourglass / start);
    }
    assert!(worst < 1e-6, "energy drifts by {worst:e}");
    // The balance covers the hourglass stiffness too, because random velocities excite it.
    assert!(hourglass > 1e-3, "hourglass share {hourglass:e}");
}

#[test]
fn conserves_radius_energy_and_spin_of_a_spinning_disc() {
    let mut d = ready(&disc(), 0.9);
    let spin = 1000.0;
    // Velocities half a step before the start of a rotation about the origin.
    let (s, c) = (-0.5 * spin * d.time_step()).sin_cos();
    for n in massive(&d) {
        let (x, y) = (c * d.state.x[n] - s * d.state.y[n], s * d.state.x[n] + c * d.state.y[n]);
        (d.state.vx[n], d.state.vy[n]) = (-spin * y, spin * x);
    }
    let radius = |d: &Dynamics| {
        (0..24).map(|n| d.state.x[slot(d, n)].hypot(d.state.y[slot(d, n)])).sum::<f64>() / 24.0
    };
    let turns = 5.0;
    let steps = (turns * TAU / spin / d.time_step()) as usize;
    let r0 = radius(&d);
    let start = step_and_balance(&mut d, &mut []).mechanical();
    let (mut grown, mut drift, mut slowest, mut fastest) = (0.0_f64, 0.0_f64, f64::INFINITY, 0.0_f64);
    let all: Vec<u32> = massive(&d).into_iter().map(|s| s as u32).collect();
    for _ in 0..steps / 100 {
        run(&mut d, &mut [], 99);
        let now = step_and_balance(&mut d, &mut []).mechanical();
        drift = drift.max((now - start).abs() / start);
        grown = grown.max((radius(&d) - r0).abs() / r0);
        let s = d.rigid_motion(&all).spin;
        (slowest, fastest) = (slowest.min(s), fastest.max(s));
    }
    // Centrifugal growth is about ρ ω² R²/(4 E) = 3e-6, twice that while it rings; a formulation that is not
    // objective would grow by a part of the angle of every step.
    assert!(grown > 1e-7 && grown < 2e-5, "the radius grows by {grown:e}");
    // The ringing is 1e-6 of the energy and is balanced to second order in the step (a quarter for half of
    // it).
    assert!(drift < 1e-6, "energy drifts by {drift:e}");
    // The moment of inertia breathes with the radius.
    assert!(slowest > spin * (1.0 - 4e-5) && fastest < spin * (1.0 + 4e-5), "{slowest} … {fastest} rad/s");
    assert!(fastest - slowest > 0.0);
}

#[test]
fn conserves_the_ledger_of_a_constant_load() {
    // A block held at one end is pulled at the other: work supplied = kinetic + elastic energy, at every
    // step.
    let mut model = body(&rectangle(0.02, 0.01, 8, 4));
    for row in 0..=4 {
        model.motion[row * 9] = NodeMotion::Held;
    }
    let mut d = ready(&model, 0.9);
    let end: Vec<u32> = slots(&d, (0..=4).map(|row| row * 9 + 8));
    let mut load = NodalLoad::new(end.iter().map(|&s| (s, 300.0, -200.0)).collect());
    let mut largest = 0.0_f64;
    let mut worst = 0.0_f64;
    for _ in 0..4000 {
        let now = step_and_balance(&mut d, &mut [&mut load]);
        largest = largest.max(now.mechanical());
        worst = worst.max((now.mechanical() - load.energy().supplied).abs());
    }
    // Strains of 1e-4 bend the force by as much, and that part is integrated to second order only.
    assert!(worst < 2e-5 * largest, "{worst:e} J of {largest:e} J are missing");
}

/// A ring of 48 facets at rest, whose bore turns at a rate [rad/s].
fn driven_ring(rate: f64) -> Dynamics {
    let part = stribeck_mesh::Annulus {
        inner_radius: 0.05,
        outer_radius: 0.08,
        facets: 48,
        layers: 4,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let mut model = body(&part.part().expect("a ring"));
    for n in 0..48 {
        model.motion[n] = NodeMotion::Rotating { centre: [0.0; 2], rate };
    }
    ready(&model, 0.9)
}

/// Fails unless each node of the bore is where an angle [rad] takes it, after 5000 steps of rounding.
fn assert_bore_has_turned(d: &Dynamics, angle: f64) {
    for n in 0..48 {
        let s = slot(d, n);
        let (sin, cos) = (TAU * n as f64 / 48.0 + angle).sin_cos();
        let miss = (d.state.x[s] - 0.05 * cos).hypot(d.state.y[s] - 0.05 * sin);
        assert!(miss < 1e-14 * 5000.0, "node {n} misses its place by {miss:e} m");
    }
}

#[test]
fn conserves_the_ledger_of_a_driven_ring() {
    // A ring is turned at its bore from rest: drive work = kinetic + elastic energy.
    let mut d = driven_ring(40.0);
    // The bore starts with a jolt, whose kinetic energy has no value at the instant itself.
    run(&mut d, &mut [], 1);
    let mut largest = 0.0_f64;
    let mut worst = 0.0_f64;
    for _ in 0..5000 {
        let now = step_and_balance(&mut d, &mut []);
        largest = largest.max(now.mechanical());
        worst = worst.max((now.mechanical() - now.drive).abs());
    }
    // A chord and its arc differ by (ω Δt)²/24 of the drive's path; strains are 1e-3.
    assert!(worst < 1e-5 * largest, "{worst:e} J of {largest:e} J are missing");
    // The bore runs on its circle to rounding, whatever pulls at it.
    assert_bore_has_turned(&d, 40.0 * d.state.time);
}

#[test]
fn conserves_the_ledger_of_a_ring_whose_speed_changes() {
    // Driven from rest at a constant acceleration, and given the mean speed of each step: the bore follows
    // ½αt², and the work of the drive is the ring's energy.
    const ACCELERATION: f64 = 4e5;
    let mut d = driven_ring(0.0);
    let (mut largest, mut worst) = (0.0_f64, 0.0_f64);
    for _ in 0..5000 {
        d.set_rotation_rate(ACCELERATION * (d.state.time + 0.5 * d.time_step())).expect("a possible rate");
        let now = step_and_balance(&mut d, &mut []);
        largest = largest.max(now.mechanical());
        worst = worst.max((now.mechanical() - now.drive).abs());
    }
    assert!(worst < 1e-5 * largest, "{worst:e} J of {largest:e} J are missing");
    let angle = 0.5 * ACCELERATION * d.state.time * d.state.time;
    assert!(angle > 1.0, "{angle} rad");
    assert_bore_has_turned(&d, angle);
    for rate in [f64::NAN, 4e6] {
        assert_refused(d.set_rotation_rate(rate), "below π·10⁶");
    }
}
