//! Stiffness damping brakes a free spin a little.
//!
//! THEORY §2.7.
//!
//! # Goal
//!
//! A property of the method, known in closed form: a rigid spin is not left alone.
//!
//! # Mesh
//!
//! ```text
//!           .─.
//!         (  ↺  )  ↗ drift      disc of 24 facets, r = 10 mm, beside the origin
//!           '─'
//! ```
//!
//! # Boundary conditions
//!
//! None. The disc starts unstretched with the velocities of a rigid motion.
//!
//! # Parameters
//!
//! ω = 300 rad/s, drift 2 m/s, β = 20 ns, E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; 20 000 steps of 0.9 of the
//! critical one.
//!
//! # Expected
//!
//! Elements see a body turned by βω ahead and push in directions turned by as much. Momentum stays; the
//! centripetal forces, with the virial I ω², have the torque −βω · I ω², so that the spin falls as dω/dt =
//! −βω³, into heat.

use stribeck_mesh::Disc;
use stribeck_testing::{assert_close, ledger};

use crate::common::*;
use crate::{damp, step_and_count};

/// Forces cancel to rounding in 20 000 steps, relative to the momentum of the drift.
const MOMENTUM: f64 = 1e-10;

/// The disc begins without the stretch of its spin and rings about it, by 1e-9 of the moment of inertia,
/// beside a loss of some 1e-5.
const LOSS: f64 = 0.02;

/// Heat of the spin; what that ringing loses is heat too.
const HEAT: f64 = 0.05;

#[test]
fn analytic_forces_turned_ahead_brake_a_spin() {
    let part = Disc { radius: 0.01, facets: 24, size: 3e-3, rotation: 0.0 }.part().expect("a disc");
    let mut d = lay_out(&body(&part.translated(0.05, -0.02)));
    let (beta, spin) = (2e-8, 300.0);
    damp(&mut d, beta, 0.9);
    for n in massive(&d) {
        d.state.vx[n] = 2.0 - spin * (d.state.y[n] + 0.02);
        d.state.vy[n] = spin * (d.state.x[n] - 0.05);
    }
    let all: Vec<u32> = massive(&d).into_iter().map(|n| n as u32).collect();
    let before = momentum(&d);
    let [start, _] = step_and_count(&mut d);
    run(&mut d, &mut [], 20_000);
    let after = momentum(&d);
    for i in 0..2 {
        assert!((after[i] - before[i]).abs() < MOMENTUM * before[0], "{after:?} from {before:?}");
    }
    let inertia = d.rigid_motion(&all).inertia;
    let loss = (before[2] - after[2]) / (inertia * spin);
    let source = "dω/dt = −βω³, own (THEORY §2.7)";
    let expected = beta * spin * spin * d.state.time;
    ledger::compare("free spin under stiffness damping", source, "-", loss, expected, LOSS);
    // The heat is that of the spin.
    let [left, heat] = step_and_count(&mut d);
    assert_close(heat, start - left, HEAT, "heat");
}
