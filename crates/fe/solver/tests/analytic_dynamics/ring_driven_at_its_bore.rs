//! An elastic ring launched at the speed of its driven bore turns as one body.
//!
//! THEORY §2.5.
//!
//! # Goal
//!
//! Nodes on a prescribed circular path about any centre, and the drive's work, which is zero in steady
//! rotation.
//!
//! # Mesh
//!
//! ```text
//!            . ─ ─ ─ ─ ─ .
//!        ╱   . ─ ─ ─ .     ╲       60 × 4 cells
//!      ╱   ▲           ▲     ╲
//!     │   ▲      + →    ▲     │    ▲  nodes 0 … 59 of the bore, driven at ω
//!      ╲   ▲   (20, −10) ▲   ╱     +  centre, in mm from the origin
//!        ╲   ' ─ ─ ─ '     ╱
//!            ' ─ ─ ─ ─ ─ '
//!      bore 50 mm, outside 70 mm
//! ```
//!
//! # Boundary conditions
//!
//! The bore's nodes turn about the centre at ω; all others are free. All start with the velocities of rigid
//! rotation.
//!
//! # Parameters
//!
//! ω = −80 rad/s, E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³, thickness 7 mm; 5000 steps of 0.9 of the critical
//! one.
//!
//! # Expected
//!
//! Kinetic energy ½ I ω² with I = Σ m r² of the nodes; no work of the drive.

use stribeck_mesh::Annulus;
use stribeck_solver::NodeMotion;
use stribeck_testing::ledger;

use crate::common::*;

/// Held at its bore the ring stretches by less than ρ ω² h²/E = 1e-7 of its thickness h and rings about that;
/// nothing else differs from a rigid body.
const ENERGY: f64 = 1e-6;

#[test]
fn analytic_driven_ring_turns_as_one() {
    let (facets, layers, rate) = (60, 4, -80.0);
    let ring = Annulus {
        inner_radius: 0.05,
        outer_radius: 0.07,
        facets,
        layers,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let centre = [0.02, -0.01];
    let mut model = body(&ring.part().expect("a ring").translated(centre[0], centre[1]));
    for n in 0..facets {
        model.motion[n] = NodeMotion::Rotating { centre, rate };
    }
    let mut d = ready(&model, 0.9);
    let mut inertia = 0.0;
    for n in massive(&d) {
        let (x, y) = (d.state.x[n] - centre[0], d.state.y[n] - centre[1]);
        inertia += d.mass()[n] * (x * x + y * y);
        let (s, c) = (-0.5 * rate * d.time_step()).sin_cos();
        (d.state.vx[n], d.state.vy[n]) = (-rate * (s * x + c * y), rate * (c * x - s * y));
    }
    run(&mut d, &mut [], 5000);

    let now = step_and_balance(&mut d, &mut []);
    let expected = 0.5 * inertia * rate * rate;
    ledger::compare("driven ring, kinetic energy", "½ I ω²", "J", now.kinetic, expected, ENERGY);
    assert!(now.drive.abs() < ENERGY * now.kinetic, "drive work {:e} J", now.drive);
}
