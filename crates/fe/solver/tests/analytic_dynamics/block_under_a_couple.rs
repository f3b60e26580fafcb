//! A free rigid block is turned by a couple.
//!
//! THEORY §1 (lumped masses) and §2.3 (the step of a rigid body).
//!
//! # Goal
//!
//! The moment of inertia and the rotation of a rigid body, and the work of the forces on it.
//!
//! # Mesh
//!
//! ```text
//!       10───11───12───13───14
//!        │    │    │    │    │
//!   F ↓  5────6────7────8────9  ↑ F     b = 20 mm
//!        │    │    │    │    │
//!        0────1────2────3────4
//!
//!             a = 40 mm
//! ```
//!
//! # Boundary conditions
//!
//! The block is rigid and free. Opposite forces act at the middles of the short sides and keep their
//! directions.
//!
//! # Parameters
//!
//! F = 1 N, ρ = 7800 kg/m³, thickness 7 mm; 2000 steps of 1 µs, within which the block turns by less than
//! 0.02 rad.
//!
//! # Expected
//!
//! θ = M t²/(2 I) with M = F a and the moment of inertia of masses lumped to a grid of m × n cells, I = m/12
//! [a² (1 + 2/m²) + b² (1 + 2/n²)]; leapfrog from rest has Δt² n (n + 1) for t². The centre stays where it
//! is, and the work is the kinetic energy.

use stribeck_solver::{Behaviour, Dynamics, Force, force::NodalLoad};
use stribeck_testing::{assert_close, ledger};

use crate::common::*;

/// The centre may move by the rounding of coordinates of 10 mm [m].
const CENTRE: f64 = 1e-15;

/// The trapezoidal rule is exact for the work on a rigid body but for the curvature of the path within a
/// step, (ωΔt)²: with rounding of 2000 sums below this.
const WORK: f64 = 1e-9;

/// Work supplied by a load over kinetic energy, at the same instant.
fn work_over_energy(d: &mut Dynamics, load: &mut NodalLoad) -> f64 {
    let now = step_and_balance(d, &mut [load]);
    load.energy().supplied / now.kinetic
}

#[test]
fn analytic_rigid_block_under_a_couple() {
    let (a, b, columns, rows) = (0.04, 0.02, 4, 2);
    let mut model = body(&rectangle(a, b, columns, rows));
    model.behaviour[0] = Behaviour::Rigid;
    let mut d = lay_out(&model);
    d.set_time_step(1e-6).expect("a positive time step");
    let (left, right) = (slot(&d, 5) as u32, slot(&d, 9) as u32);
    let force = 1.0;
    let mut couple = NodalLoad::new(vec![(left, 0.0, -force), (right, 0.0, force)]);
    let steps = 2000;
    run(&mut d, &mut [&mut couple], steps);

    let mass = steel().density() * THICKNESS * a * b;
    let share = |cells: usize| 1.0 + 2.0 / (cells * cells) as f64;
    let inertia = mass / 12.0 * (a * a * share(columns) + b * b * share(rows));
    let t2 = d.time_step().powi(2) * steps as f64 * (steps + 1) as f64;
    let angle = 0.5 * force * a / inertia * t2;
    assert!(angle > 1e-3 && angle < 0.02, "{angle} rad");
    // The lever shortens as cos θ, by θ²/2 at the end.
    let lever = angle * angle;
    let source = "θ = M t²/(2 I), lumped masses";
    ledger::compare("rigid block under a couple, angle", source, "rad", d.rigid[0].angle, angle, lever);
    let [x, y] = d.rigid[0].centre;
    assert!((x - 0.5 * a).abs() < CENTRE && (y - 0.5 * b).abs() < CENTRE, "{x} m, {y} m");
    assert_close(work_over_energy(&mut d, &mut couple), 1.0, WORK, "work / energy");
}
