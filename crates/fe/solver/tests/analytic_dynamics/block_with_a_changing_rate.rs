//! A rigid block is driven from rest at a constant angular acceleration against a couple.
//!
//! THEORY §6.3 and §6.5.
//!
//! # Goal
//!
//! A prescribed rate that changes before each step: the angle it leads to, and the work of the drive.
//!
//! # Mesh
//!
//! ```text
//!       10───11───12───13───14
//!        │    │  ↺ │ αt │    │
//!   F ↓  5────6────7────8────9  ↑ F     b = 20 mm
//!        │    │    │    │    │
//!        0────1────2────3────4
//!
//!             a = 40 mm
//! ```
//!
//! # Boundary conditions
//!
//! The block is rigid; in each step it turns at the mean rate of that step, α (t + Δt/2). The couple's forces
//! keep their directions in space and have no resultant.
//!
//! # Parameters
//!
//! α = 50 000 rad/s², F = 3 N, ρ = 7800 kg/m³, thickness 7 mm; 4000 steps of 1 µs, to 0.4 rad.
//!
//! # Expected
//!
//! θ = ½ α t². The drive leaves ½ I (α t)² in the block and supplies −∫ M ω dt = −F a sin θ on top, with the
//! moment of inertia of lumped masses, I = m/12 [a² (1 + 2/m²) + b² (1 + 2/n²)] for m × n cells.

use stribeck_solver::{Behaviour, force::NodalLoad};
use stribeck_testing::{assert_close, assert_refused};

use crate::common::*;

/// Rounding of 4000 sums.
const ANGLE: f64 = 1e-12;

/// The couple's lever is taken at the ends of steps of up to 200 µrad.
const WORK: f64 = 1e-3;

#[test]
fn analytic_a_block_whose_prescribed_rate_changes() {
    let mut model = body(&rectangle(0.04, 0.02, 4, 2));
    model.behaviour[0] = Behaviour::Turning { rate: 0.0, braking: 0.0 };
    let mut d = lay_out(&model);
    d.set_time_step(1e-6).expect("a positive time step");
    let (left, right) = (slot(&d, 5) as u32, slot(&d, 9) as u32);
    let (couple, acceleration) = (3.0, 5e4);
    let mut load = NodalLoad::new(vec![(left, 0.0, -couple), (right, 0.0, couple)]);
    for _ in 0..4000 {
        d.set_turning_rate(acceleration * (d.state.time + 0.5 * d.time_step())).expect("a possible rate");
        let now = step_and_balance(&mut d, &mut [&mut load]);
        assert!(now.kinetic >= 0.0);
    }

    let angle = 0.5 * acceleration * d.state.time.powi(2);
    assert_close(d.rigid[0].angle, angle, ANGLE, "angle");
    let mass = steel().density() * THICKNESS * 0.04 * 0.02;
    let (cells_x, cells_y) = (4.0_f64, 2.0_f64);
    let lumped = |length: f64, cells: f64| mass * length * length / 12.0 * (1.0 + 2.0 / (cells * cells));
    let inertia = lumped(0.04, cells_x) + lumped(0.02, cells_y);
    let kinetic = 0.5 * inertia * (acceleration * d.state.time).powi(2);
    let by_couple = couple * 0.04 * angle.sin();
    // Both terms count, or the sum would not test them.
    assert!(kinetic > 0.1 * by_couple.abs(), "{kinetic} J beside {by_couple} J");
    assert_close(d.drive.at_last_positions(), kinetic - by_couple, WORK, "work of the drive");
    for rate in [f64::NAN, 4e6] {
        assert_refused(d.set_turning_rate(rate), "below π·10⁶");
    }
}
