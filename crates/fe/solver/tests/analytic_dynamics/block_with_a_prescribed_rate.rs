//! A rigid block turns at a prescribed constant rate while forces push it.
//!
//! THEORY §6.5.
//!
//! # Goal
//!
//! A drive that prescribes the rotation: the centre stays free, the angle is fixed, and the work is that of
//! the drive.
//!
//! # Mesh
//!
//! ```text
//!       10───11───12───13───14
//!        │    │  ↺ │ Ω  │    │
//!   F ↓  5────6────7────8────9  ↑ F   → P     b = 20 mm
//!        │    │    │    │    │
//!        0────1────2────3────4
//!
//!             a = 40 mm
//! ```
//!
//! # Boundary conditions
//!
//! The block is rigid, turns at Ω about its centre, and is free to move. Forces keep their directions in
//! space.
//!
//! # Parameters
//!
//! Ω = 50 rad/s, F = 3 N, P = 2 N, ρ = 7800 kg/m³, thickness 7 mm; 4000 steps of 1 µs.
//!
//! # Expected
//!
//! θ = Ω t. The centre moves by P t²/(2 m), with Δt² n (n + 1) for t². The drive supplies −∫ Ω M dt: the
//! couple has the moment F a cos θ, and the push that about the centre, −P (a/2) sin θ, so W = −F a sin Ωt −
//! P (a/2)(cos Ωt − 1).

use stribeck_solver::{Behaviour, force::NodalLoad};
use stribeck_testing::assert_close;

use crate::common::*;

/// Rounding of 4000 sums.
const ANGLE: f64 = 1e-12;

/// Rounding of the centre, 20 mm, beside a path of some 0.4 mm in 4000 steps.
const PATH: f64 = 1e-9;

/// Moments are taken at the ends of steps of Ω Δt = 50 µrad, and the last step counts half.
const WORK: f64 = 1e-3;

#[test]
fn analytic_block_that_turns_at_a_prescribed_rate() {
    let mut model = body(&rectangle(0.04, 0.02, 4, 2));
    let rate = 50.0;
    model.behaviour[0] = Behaviour::Turning { rate, braking: 0.0 };
    let mut d = lay_out(&model);
    d.set_time_step(1e-6).expect("a positive time step");
    let (left, right) = (slot(&d, 5) as u32, slot(&d, 9) as u32);
    let (couple, push) = (3.0, 2.0);
    let mut load = NodalLoad::new(vec![(left, 0.0, -couple), (right, push, couple)]);
    let steps = 4000;
    run(&mut d, &mut [&mut load], steps);

    let time = d.state.time;
    assert_close(d.rigid[0].angle, rate * time, ANGLE, "angle");
    assert_eq!(d.rigid[0].spin, rate);
    let mass = steel().density() * THICKNESS * 0.04 * 0.02;
    let path = 0.5 * push / mass * d.time_step().powi(2) * (steps * (steps + 1)) as f64;
    assert_close(d.rigid[0].centre[0] - 0.02, path, PATH, "path");
    let angle = rate * time;
    let of_couple = couple * 0.04 * angle.sin();
    let of_push = push * 0.02 * (angle.cos() - 1.0);
    assert_close(d.drive.at_last_positions(), -(of_couple + of_push), WORK, "work of the drive");
    // A launch does not change a prescribed rate.
    d.launch_rigid(0, [0.0; 2], 7.0);
    assert_eq!(d.rigid[0].spin, rate);
}
