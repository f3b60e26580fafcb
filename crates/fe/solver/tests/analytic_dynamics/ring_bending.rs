//! A free thin ring vibrates in its first two bending modes.
//!
//! Love, *A Treatise on the Mathematical Theory of Elasticity* (1927), §293, inextensional bending in its
//! plane; the benchmark of Code_Aster V2.03.109.
//!
//! # Goal
//!
//! Bending frequencies from a run in time: the elements, their hourglass stiffness and the lumped mass
//! together.
//!
//! # Mesh
//!
//! ```text
//!              . ─ ─ ─ ─ .
//!          ╱ ╱             ╲ ╲          314 × 2 squares of 2 mm
//!        ╱ ╱     mode n = 2   ╲ ╲
//!       │ │    ←  ─  ┼  ─  →   │ │      u_r = cos nθ
//!       │ │          │         0 │→ x   u_θ = −(sin nθ)/n at the middle radius
//!        ╲ ╲                  ╱ ╱
//!          ╲ ╲             ╱ ╱          node 0 on the bore at θ = 0
//!              ' ─ ─ ─ ─ '
//!        bore 98 mm, outside 102 mm
//! ```
//!
//! Squares, because the hourglass stiffness of a square is exact in bending.
//!
//! # Boundary conditions
//!
//! None: the ring is free. It starts round, with the velocities of the mode, 10 mm/s at the crest.
//!
//! # Parameters
//!
//! R = 0.1 m, h = 4 mm, E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; 0.95 of the critical time step; 3.3 periods.
//!
//! # Expected
//!
//! f = n (n² − 1)/(2π R²) √(E' I/(ρ A (n² + 1))), I/A = h²/12, E' = E/(1 − ν²) for plane strain.

use std::f64::consts::TAU;

use stribeck_mesh::Annulus;
use stribeck_testing::ledger;

use crate::common::*;

/// Shear and rotary inertia, left out by Love, lower the frequency by about n² (h/R)²/3 = 0.5 % for n = 3; as
/// much is left for the mesh of two cells through the thickness.
const FREQUENCY: f64 = 0.01;

/// Frequency [Hz] of a signal from its first and last upward zero crossing.
fn frequency(signal: &[f64], dt: f64) -> f64 {
    let crossings: Vec<f64> = signal
        .windows(2)
        .enumerate()
        .filter(|(_, w)| w[0] < 0.0 && w[1] >= 0.0)
        .map(|(i, w)| i as f64 + w[0] / (w[0] - w[1]))
        .collect();
    let [first, .., last] = crossings.as_slice() else { panic!("fewer than two periods") };
    (crossings.len() - 1) as f64 / ((last - first) * dt)
}

#[test]
fn analytic_bending_modes_of_a_free_ring() {
    let (inner, outer, facets, layers) = (0.098, 0.102, 314, 2);
    let ring = Annulus {
        inner_radius: inner,
        outer_radius: outer,
        facets,
        layers,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let model = body(&ring.part().expect("a ring"));
    for n in [2, 3] {
        let mut d = ready(&model, 0.95);
        let k = n as f64;
        // So slow that strains stay below 1e-5; off the middle radius sections turn with the centre line.
        for node in 0..model.mesh.x.len() {
            let (x, y, s) = (model.mesh.x[node], model.mesh.y[node], slot(&d, node));
            let (angle, r) = (y.atan2(x), x.hypot(y) / 0.1);
            let (radial, hoop) =
                (0.01 * (k * angle).cos(), -0.01 / k * (k * angle).sin() * (1.0 + (1.0 - k * k) * (1.0 - r)));
            d.state.vx[s] = radial * angle.cos() - hoop * angle.sin();
            d.state.vy[s] = radial * angle.sin() + hoop * angle.cos();
        }
        let thickness = outer - inner;
        let stiffness = steel().plane_strain_modulus() * thickness * thickness / (12.0 * steel().density());
        let expected = k * (k * k - 1.0) / (TAU * 0.01) * (stiffness / (k * k + 1.0)).sqrt();

        let every = 20;
        let samples = (3.3 / expected / d.time_step()) as usize / every;
        let bore = slot(&d, 0);
        let signal: Vec<f64> = (0..samples)
            .map(|_| {
                run(&mut d, &mut [], every);
                d.state.x[bore].hypot(d.state.y[bore]) - inner
            })
            .collect();
        let found = frequency(&signal, every as f64 * d.time_step());
        let source = "Love 1927, §293; Code_Aster V2.03.109";
        ledger::compare(&format!("ring, bending mode {n}"), source, "Hz", found, expected, FREQUENCY);
    }
}
