//! Mass-proportional damping: rates of decay, undamped motions, its heat.
//!
//! Problems with a closed form have a file each.

#[path = "../common/mod.rs"]
mod common;

mod bar_that_vibrates;
mod block_in_flight;
mod disc_on_an_orbit;

use common::*;
use stribeck_mesh::Disc;
use stribeck_solver::{
    Dynamics, Model,
    damping::{Frame, MassDamping},
};
use stribeck_testing::{Noise, assert_close};

/// A disc of 20 mm about a place.
fn disc_at(x: f64, y: f64) -> Model {
    let part = Disc { radius: 0.01, facets: 24, size: 3e-3, rotation: 0.0 }.part().expect("a disc");
    body(&part.translated(x, y))
}

/// Damps the first body of a model.
fn damp(d: &mut Dynamics, rate: f64, frame: Frame) {
    d.set_mass_damping(&MassDamping::new(rate, vec![(0, frame)]).expect("a possible rate"));
}

fn all(d: &Dynamics) -> Vec<u32> {
    massive(d).into_iter().map(|s| s as u32).collect()
}

#[test]
fn conserves_the_ledger_of_mass_damping() {
    // What vibrates becomes heat, at every step and at every frequency that the mesh has.
    let mut d = ready(&disc_at(0.0, 0.0), 0.9);
    damp(&mut d, 1e3, Frame::OwnMotion);
    let mut noise = Noise::new(6);
    for n in massive(&d) {
        (d.state.vx[n], d.state.vy[n]) = (1e-3 * noise.uniform(), 1e-3 * noise.uniform());
    }
    // Heat is counted in every fourth step: the first steps, while half of the energy goes from motion into
    // strain, are too short for that.
    run(&mut d, &mut [], 16);
    let [start, none] = step_and_count(&mut d);
    let mut heat = none;
    let mut worst = 0.0_f64;
    for _ in 0..60_000 {
        let [mechanical, so_far] = step_and_count(&mut d);
        heat = so_far;
        worst = worst.max((mechanical + heat - start - none).abs());
    }
    assert!(heat - none > 0.8 * start, "{heat} J of {start} J");
    // Heat is counted from the mean of two half steps, which is right on average over a period, not at each
    // instant.
    assert!(worst < 5e-3 * start, "{:e} of the energy is missing", worst / start);
}

#[test]
fn conserves_rigid_motion_under_relative_damping() {
    // Damping relative to the rigid motion calms a ringing disc and leaves its flight and spin alone.
    let mut d = ready(&disc_at(0.0, 0.0), 0.9);
    let rate = 2e4;
    damp(&mut d, rate, Frame::OwnMotion);
    // It stretches along x, spins and flies.
    for n in massive(&d) {
        d.state.vx[n] = 3.0 + 100.0 * d.state.x[n] - 60.0 * d.state.y[n];
        d.state.vy[n] = -50.0 * d.state.y[n] + 60.0 * d.state.x[n];
    }
    let before = momentum(&d);
    let [start, _] = step_and_count(&mut d);
    let steps = (20.0 / (rate * d.time_step())) as usize;
    run(&mut d, &mut [], steps);
    let (after, rigid) = (momentum(&d), d.rigid_motion(&all(&d)));
    let flight = before[0].abs();
    assert!((after[0] - before[0]).abs() < 1e-10 * flight, "{after:?} from {before:?}");
    assert!((after[1] - before[1]).abs() < 1e-10 * flight, "{after:?} from {before:?}");
    // The frame is updated every 64 steps, while the moment of inertia breathes by 2e-5.
    assert!((after[2] - before[2]).abs() < 1e-4 * before[2].abs(), "{after:?} from {before:?}");
    let carried = 0.5 * rigid.mass * (rigid.velocity[0].powi(2) + rigid.velocity[1].powi(2))
        + 0.5 * rigid.inertia * rigid.spin.powi(2);
    let vibration = start - carried;
    // Amplitudes fall as exp(−α t/2), here by exp(−10): the rigid motion and its static stretch
    // remain.
    let [left, heat] = step_and_count(&mut d);
    assert!(left - carried < 1e-6 * vibration + 1e-5 * carried, "{left} J against {carried} J");
    // The heat is that of the mean velocity of two half steps; the start lies within the first of them.
    assert_close(heat, vibration, 0.01, "heat of damping");
}

#[test]
fn behaves_damping_set_in_the_middle_of_a_run_acts_at_once() {
    // Whatever the number of the step: a body in flight must not be braked against a frame that was never
    // placed.
    for late in [0, 10, 63] {
        let mut d = ready(&disc_at(0.0, 0.0), 0.9);
        for n in massive(&d) {
            d.state.vx[n] = 3.0;
        }
        run(&mut d, &mut [], late);
        damp(&mut d, 1e5, Frame::OwnMotion);
        run(&mut d, &mut [], 30);
        let speed = d.rigid_motion(&all(&d)).velocity[0];
        assert!((speed - 3.0).abs() < 1e-9, "set after {late} steps: {speed} m/s");
    }
}

#[test]
fn invariant_a_damped_run_resumes_with_the_same_bits() {
    let start = || {
        let mut d = ready(&disc_at(0.0, 0.0), 0.9);
        damp(&mut d, 1e4, Frame::OwnMotion);
        for n in massive(&d) {
            d.state.vx[n] = 3.0 + 100.0 * d.state.x[n] - 60.0 * d.state.y[n];
            d.state.vy[n] = 60.0 * d.state.x[n];
        }
        d
    };
    let mut whole = start();
    run(&mut whole, &mut [], 200);
    // Frames are placed at every 64th step: 128 is one, the others lie between.
    for until in [0, 1, 100, 128, 191] {
        let mut first = start();
        run(&mut first, &mut [], until);
        let saved = serde_json::to_string(&first.snapshot()).expect("numbers are finite");
        let mut second = start();
        second
            .restore(serde_json::from_str(&saved).expect("what was written can be read"))
            .expect("the same model");
        run(&mut second, &mut [], 200 - until);
        assert!(whole.snapshot() == second.snapshot(), "resumed at step {until}");
    }
}

#[test]
fn refuses_impossible_rates() {
    for rate in [-1.0, f64::NAN, f64::INFINITY] {
        let text = MassDamping::new(rate, Vec::new()).expect_err("refused").to_string();
        assert!(text.contains("mass damping rate [1/s]") && text.contains("zero or positive"), "{text}");
    }
}
