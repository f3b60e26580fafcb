//! Structural damping gives bending modes of a free ring the ratio of its branch.
//!
//! THEORY §2.8; bending modes of a thin ring: Love, *A Treatise on the Mathematical Theory of Elasticity*
//! (1944), §293.
//!
//! # Goal
//!
//! Damping of bending, in which elements shear and bend, at frequencies that the mesh itself has.
//!
//! # Mesh
//!
//! ```text
//!               . ─ ─ ─ ─ .
//!           ╱ ╱             ╲ ╲          360 × 6 cells
//!         ╱ ╱     mode n = 2   ╲ ╲
//!        │ │    ←  ─  ┼  ─  →   │ │      u_r = cos nθ
//!        │ │          │         │ │      u_θ = −(sin nθ)/n at the middle radius
//!         ╲ ╲                  ╱ ╱
//!           ╲ ╲             ╱ ╱
//!               ' ─ ─ ─ ─ '
//!         bore 100 mm, outside 110 mm
//! ```
//!
//! # Boundary conditions
//!
//! None. The ring starts round with the velocities of the mode, 1 mm/s at the crest.
//!
//! # Parameters
//!
//! n = 2, 4, 6; E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; a branch for a ratio of 0.02 from 2 to 20 kHz;
//! eight cycles in steps of 0.9 of the critical one.
//!
//! # Expected
//!
//! The ratio of the root of s² + ω₀² (1 + g sτ/(1 + sτ)) = 0 near iω₀, with ω₀ measured on the same mesh
//! without damping; Love's frequency is the first guess of it.

use std::f64::consts::TAU;

use stribeck_mesh::Annulus;
use stribeck_solver::{Dynamics, structural_damping::StructuralDamping};
use stribeck_testing::ledger;

use crate::common::*;
use crate::{damp, ring_down, root};

/// Peaks of the amplitude over eight cycles; other modes ring along a little.
const RATIO: f64 = 0.02;

#[test]
fn analytic_structural_damping_of_a_rings_bending_modes() {
    let (inner, outer) = (0.1, 0.11);
    let ring = Annulus {
        inner_radius: inner,
        outer_radius: outer,
        facets: 360,
        layers: 6,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let model = body(&ring.part().expect("a ring"));
    let fit = StructuralDamping::over_band(0.02, [2e3, 2e4], vec![0]).expect("a possible band");
    for n in [2, 4, 6] {
        let n = n as f64;
        let radius = 0.5 * (inner + outer);
        // The shape of a thin ring without stretch, sections turning as they do in bending.
        let shape = |d: &Dynamics| -> Vec<[f64; 2]> {
            let places = d.state.x.iter().zip(&d.state.y);
            let velocity = |(x, y): (&f64, &f64)| {
                let (r, phi) = (x.hypot(*y), y.atan2(*x));
                let radial = (n * phi).cos();
                let middle = -(n * phi).sin() / n;
                let along = middle + (r / radius - 1.0) * (middle + n * (n * phi).sin());
                let (s, c) = phi.sin_cos();
                [1e-3 * (radial * c - along * s), 1e-3 * (radial * s + along * c)]
            };
            places.map(velocity).collect()
        };
        // Undamped, for the frequency of this mesh.
        let mut free = ready(&model, 0.9);
        let thin = n * (n * n - 1.0) / (n * n + 1.0).sqrt() * (outer - inner)
            / (12.0_f64.sqrt() * radius * radius)
            * (208e9 / (1.0 - 0.09) / 7800.0_f64).sqrt();
        let shape_free = shape(&free);
        let [omega, none] = ring_down(&mut free, &shape_free, thin, 8.0);
        println!(
            "n = {n}: {:.1} Hz, thin ring {:.1} Hz, ratio without damping {none:.1e}",
            omega / TAU,
            thin / TAU
        );
        let mut d = lay_out(&model);
        damp(&mut d, fit.branch(), vec![0], 0.9);
        let shape_damped = shape(&d);
        let [_, ratio] = ring_down(&mut d, &shape_damped, omega, 8.0);
        let [decay, expected] = root(fit.branch(), omega);
        let source = "root of s² + ω₀²(1 + g sτ/(1 + sτ)), THEORY §2.8";
        let quantity = format!("ring, structural damping of n = {n}");
        ledger::compare(&quantity, source, "-", ratio, decay / expected, RATIO);
    }
}
