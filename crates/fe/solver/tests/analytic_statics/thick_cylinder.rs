//! A thick cylinder under inner pressure, after Lamé.
//!
//! Timoshenko and Goodier, *Theory of Elasticity* (1970), §28, in plane strain.
//!
//! # Goal
//!
//! Radial displacements converge with the square of the element size, and those of the finest mesh are right.
//!
//! # Mesh
//!
//! ```text
//!              . ─ ─ ─ ─ ─ .
//!          ╱       .─.       ╲
//!        ╱       ↖  ↑  ↗       ╲       24 × 3, 48 × 6 and 96 × 12 cells
//!       │      ( ←  p  → )      │      node 0 on the bore at θ = 0, rows outwards
//!        ╲       ↙  ↓  ↘       ╱
//!          ╲       '─'       ╱
//!              ' ─ ─ ─ ─ ─ '
//!        a = 50 mm       b = 100 mm
//! ```
//!
//! # Boundary conditions
//!
//! The pressure p acts on each chord of the bore, half of its force on each of its two nodes, along the
//! chord's normal. Nothing is held: loads are in balance, and statics keeps the rigid motion of the start.
//!
//! # Parameters
//!
//! p = 1 MPa, E = 208 GPa, ν = 0.3.
//!
//! # Expected
//!
//! u(r) = (1 + ν) p a²/(E (b² − a²)) · [(1 − 2ν) r + b²/r], at r = a and r = b.

use stribeck_solver::force::NodalLoad;
use stribeck_testing::{ledger, orders};

use crate::common::*;
use crate::{INNER, OUTER, ROUNDING, growth, ring};

/// Second order; terms of higher order move it in meshes of three layers.
const ORDERS: std::ops::Range<f64> = 1.8..2.3;

/// Of the finest mesh: (1/12)² of the thickness in layers is 0.7 %, of which the polygon and the linear
/// elements each leave a part.
const DISPLACEMENT: f64 = 3e-3;

/// Radial growth of bore and rim [m] under the inner pressure `p` [Pa].
fn under_pressure(facets: usize, layers: usize, p: f64) -> [f64; 2] {
    let model = ring(facets, layers);
    let mut d = lay_out(&model);
    // Half of the force on each of the two chords that meet at a node: p · chord · thickness, along the
    // chord's normal.
    let half_angle = std::f64::consts::PI / facets as f64;
    let push = p * THICKNESS * 2.0 * INNER * half_angle.sin() * half_angle.cos();
    let at = |n: usize| (model.mesh.x[n] / INNER, model.mesh.y[n] / INNER);
    let loads = (0..facets).map(|n| (slot(&d, n) as u32, push * at(n).0, push * at(n).1)).collect();
    equilibrate(&mut d, &mut [&mut NodalLoad::new(loads)], Vec::new(), ROUNDING).expect("a balanced load");
    [growth(&d, &model, 0, facets), growth(&d, &model, layers * facets, facets)]
}

#[test]
fn converges_lame_thick_cylinder() {
    let p = 1e6;
    let (e, nu) = (steel().youngs_modulus(), steel().poissons_ratio());
    let (a2, b2) = (INNER * INNER, OUTER * OUTER);
    let exact = |r: f64| (1.0 + nu) * p * a2 / (e * (b2 - a2)) * ((1.0 - 2.0 * nu) * r + b2 / r);
    let found = [(24, 3), (48, 6), (96, 12)].map(|(facets, layers)| under_pressure(facets, layers, p));
    for (i, r, what) in [(0, INNER, "bore"), (1, OUTER, "rim")] {
        let errors = found.map(|u| (u[i] - exact(r)).abs() / exact(r));
        for order in orders(&errors) {
            assert!(ORDERS.contains(&order), "{what}: order {order}, errors {errors:?}");
        }
        let quantity = format!("thick cylinder under pressure, {what}");
        let source = "Lamé: Timoshenko and Goodier 1970, §28";
        ledger::compare(&quantity, source, "m", found[2][i], exact(r), DISPLACEMENT);
    }
}
