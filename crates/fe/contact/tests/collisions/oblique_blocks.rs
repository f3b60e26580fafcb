//! Two free blocks meet off centre and at an angle.
//!
//! # Goal
//!
//! Momentum, angular momentum and energy through a collision, with and without friction and damping.
//!
//! # Mesh
//!
//! ```text
//!                  ┌┬┬┬┬┬┐
//!                  ├┼┼┼┼┼┤   10 × 10 mm, 6 × 6 cells, turned by 4 mrad
//!                  ├┼┼┼┼┼┤   ↓ 3 m/s, → 0.5 m/s
//!                  └┴┴┴┴┴┘
//!         ┌┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┐  gap 0.2 mm
//!         ├┼┼┼┼┼┼┼┼┼┼┼┼┼┼┼┼┼┤  20 × 10 mm, 10 × 5 cells
//!         └┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┘  ↑ 1 m/s
//! ```
//!
//! A corner of the upper block meets the flat top of the lower one.
//!
//! # Boundary conditions
//!
//! None.
//!
//! # Parameters
//!
//! E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; a penalty as stiff as 2 mm of steel; half of the critical time step,
//! 3000 steps; µ = 0.3 and a damping ratio of 0.2 where bodies lose energy.
//!
//! # Expected
//!
//! Momentum is kept to rounding, angular momentum too where no friction moves off the line of the penalty
//! force. Energy and heat together are kept to the order of the trapezoidal rule by which the ledger counts
//! them, THEORY §2.5.

use stribeck_contact::{Contacts, Law, Method};
use stribeck_solver::{Dynamics, Force};

use crate::common::*;
use crate::penalty;

/// Rounding of ten thousand sums of forces, relative to the momentum that is exchanged.
const MOMENTUM_ROUNDING: f64 = 1e-11;

/// A spring that sets in within a step is not integrated exactly: parts of a per mille of the energy.
const SET_IN: f64 = 2e-3;

/// Every term is counted over the same span as the others, so that the error of the balance falls with the
/// square of the step; where within a step a point sets in is chance, so the order scatters about two.
const LEAST_ORDER: f64 = 1.4;

/// An eighth of the step leaves a sixty-fourth of [`SET_IN`], scattered likewise.
const FINEST: f64 = 4e-5;

/// Two free blocks that meet off centre at an angle: a flat side of one, a corner region of the other.
fn oblique(law: Law, method: Method) -> (Dynamics, Contacts, [Vec<u32>; 2]) {
    let mut scene = Scene::default();
    let lower = rectangle([-0.01, -0.01], 0.02, 0.01, 10, 5);
    let upper = rectangle([-0.004, 0.2e-3], 0.01, 0.01, 6, 6).rotated(0.004);
    let a = scene.add("lower", &lower, "top");
    let b = scene.add("upper", &upper, "bottom");
    scene.pair(a, b, law, method);
    let model = scene.model();
    let (mut d, contacts) = scene.lay_out(&model);
    set_step(&mut d, &contacts, 0.5);
    let bodies = [a, b].map(|body| of_body(&d, &model, body));
    launch(&mut d, &bodies[0], [0.0, 1.0]);
    launch(&mut d, &bodies[1], [0.5, -3.0]);
    (d, contacts, bodies)
}

#[test]
fn conserves_momentum_in_a_collision() {
    for method in METHODS {
        let (mut d, mut contacts, bodies) = oblique(penalty(2e-3), method);
        let (before, exchanged) = (momentum(&d), momentum_of(&d, &bodies[1])[1].abs());
        let mut hardest = 0.0_f64;
        for _ in 0..3000 {
            d.step(&mut [&mut contacts]);
            hardest = hardest.max(contacts.resultants().next().expect("one pair").force[1].abs());
        }
        assert!(hardest > 1e3, "they have met: {hardest} N");
        assert!(momentum_of(&d, &bodies[1])[1] > 0.0, "the upper block has bounced");
        let after = momentum(&d);
        for i in 0..2 {
            let drift = (after[i] - before[i]).abs() / exchanged;
            assert!(drift < MOMENTUM_ROUNDING, "{method:?}, component {i}: {drift:e}");
        }
        // Forces of penalty lie on one line: angular momentum is kept too (lever 1 cm).
        let drift = (after[2] - before[2]).abs() / (0.01 * exchanged);
        assert!(drift < MOMENTUM_ROUNDING, "{method:?}, angular: {drift:e}");
    }
}

fn momentum_of(d: &Dynamics, slots: &[u32]) -> [f64; 2] {
    let body = d.rigid_motion(slots);
    body.velocity.map(|v| body.mass * v)
}

#[test]
fn conserves_momentum_with_friction_and_damping() {
    for method in METHODS {
        let law =
            penalty(2e-3).with_friction(0.3).and_then(|l| l.with_damping(0.2, 7800.0 * 1e-3)).expect("a law");
        let (mut d, mut contacts, bodies) = oblique(law, method);
        let (before, exchanged) = (momentum(&d), momentum_of(&d, &bodies[1])[1].abs());
        for _ in 0..3000 {
            d.step(&mut [&mut contacts]);
        }
        assert!(contacts.energy().friction > 0.0 && contacts.energy().damping > 0.0);
        let after = momentum(&d);
        for i in 0..2 {
            let drift = (after[i] - before[i]).abs() / exchanged;
            assert!(drift < MOMENTUM_ROUNDING, "{method:?}, component {i}: {drift:e}");
        }
    }
}

#[test]
fn conserves_the_ledger_of_a_collision() {
    let lossy =
        penalty(2e-3).with_friction(0.3).and_then(|l| l.with_damping(0.2, 7800.0 * 1e-3)).expect("a law");
    for (name, law) in [("frictionless", penalty(2e-3)), ("friction and damping", lossy)] {
        for method in METHODS {
            let (mut d, mut contacts, _) = oblique(law, method);
            let start = step_and_balance(&mut d, &mut contacts).mechanical;
            let mut worst = 0.0_f64;
            let mut heat = [0.0; 2];
            for _ in 0..3000 {
                let now = step_and_balance(&mut d, &mut contacts);
                heat = now.heat;
                worst = worst.max((now.mechanical + heat[0] + heat[1] - start).abs());
            }
            assert!(
                worst < SET_IN * start,
                "{name}, {method:?}: {:e} of the energy is missing",
                worst / start
            );
            if law.friction > 0.0 {
                assert!(
                    heat[0] > 5e-3 * start && heat[1] > 5e-3 * start,
                    "{name}: heat {heat:?} J of {start} J"
                );
            } else {
                assert_eq!(heat, [0.0; 2]);
            }
        }
    }
}

/// Source: THEORY §2.5: the trapezoidal rule is of second order.
#[test]
fn converges_the_ledger_of_a_collision() {
    let lossy =
        penalty(2e-3).with_friction(0.3).and_then(|l| l.with_damping(0.2, 7800.0 * 1e-3)).expect("a law");
    for (name, law) in [("frictionless", penalty(2e-3)), ("friction and damping", lossy)] {
        for method in METHODS {
            let missing = |refined: usize| {
                let (mut d, mut contacts, _) = oblique(law, method);
                d.set_time_step(d.time_step() / refined as f64).expect("a positive time step");
                let start = step_and_balance(&mut d, &mut contacts).mechanical;
                let mut worst = 0.0_f64;
                for _ in 0..3000 * refined {
                    let now = step_and_balance(&mut d, &mut contacts);
                    worst = worst.max((now.mechanical + now.heat[0] + now.heat[1] - start).abs());
                }
                worst / start
            };
            let (coarse, fine) = (missing(1), missing(8));
            let order = (coarse / fine).log2() / 3.0;
            assert!(order > LEAST_ORDER, "{name}, {method:?}: order {order}, {coarse:e} to {fine:e}");
            assert!(fine < FINEST, "{name}, {method:?}: {fine:e}");
        }
    }
}
