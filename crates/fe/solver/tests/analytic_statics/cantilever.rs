//! A cantilever under an end load.
//!
//! Timoshenko and Goodier, *Theory of Elasticity* (1970), §21, with Cowper's shear coefficient (J. Appl.
//! Mech. 33, 1966).
//!
//! # Goal
//!
//! Bending of quadrilaterals with one integration point: neither shear locking nor hourglass softness.
//!
//! # Mesh
//!
//! ```text
//!    ▧ ┌──┬──┬──┬── … ──┬──┐ ↓
//!    ▧ ├──┼──┼──┼── … ──┼──┤ ↓  P, spread evenly over the nodes of the end
//!    ▧ ├──┼──┼──┼── … ──┼──┤ ↓      h = 10 mm
//!    ▧ ├──┼──┼──┼── … ──┼──┤ ↓
//!    ▧ └──┴──┴──┴── … ──┴──┘ ↓
//!
//!            L = 100 mm
//! ```
//!
//! 40 × 4 squares of 2.5 mm, as drawn; and 10 × 1 squares of 10 mm.
//!
//! # Boundary conditions
//!
//! All nodes of the left side are held in x and y.
//!
//! # Parameters
//!
//! P = 1 N, E = 208 GPa, ν = 0.3, thickness 7 mm.
//!
//! # Expected
//!
//! δ = P L³/(3 E' I) + P L/(κ µ A), E' = E/(1 − ν²), κ = 5/6 for a rectangle in plane strain.

use stribeck_solver::{NodeMotion, force::NodalLoad};
use stribeck_testing::assert_close;

use crate::ROUNDING;
use crate::common::*;

/// The hourglass stiffness of a square is exact in bending. The error is that of the parabola of shear, which
/// four linear cells follow in steps, and the clamp, which lets no section warp.
const FOUR_CELLS: f64 = 0.01;

/// One cell through the height is right for the same reason, and has no parabola at all.
const ONE_CELL: f64 = 0.02;

/// Tip deflection [m] of a clamped beam of `columns` × `rows` cells under the end load `p` [N].
fn tip_deflection(length: f64, height: f64, columns: usize, rows: usize, p: f64) -> f64 {
    let mut model = body(&rectangle(length, height, columns, rows));
    for row in 0..=rows {
        model.motion[row * (columns + 1)] = NodeMotion::Held;
    }
    let mut d = lay_out(&model);
    let end = |row: usize| row * (columns + 1) + columns;
    let share = -p / (rows + 1) as f64;
    let loads = (0..=rows).map(|r| (slot(&d, end(r)) as u32, 0.0, share)).collect();
    equilibrate(&mut d, &mut [&mut NodalLoad::new(loads)], Vec::new(), ROUNDING).expect("a held beam");
    -(0..=rows).map(|r| d.state.y[slot(&d, end(r))] - model.mesh.y[end(r)]).sum::<f64>() / (rows + 1) as f64
}

#[test]
fn analytic_cantilever() {
    let (length, height, p) = (0.1_f64, 0.01_f64, 1.0);
    let inertia = THICKNESS * height.powi(3) / 12.0;
    let bending = p * length.powi(3) / (3.0 * steel().plane_strain_modulus() * inertia);
    let shear = p * length / (5.0 / 6.0 * steel().shear() * THICKNESS * height);
    let found = tip_deflection(length, height, 40, 4, p);
    assert_close(found, bending + shear, FOUR_CELLS, "tip deflection");
    let found = tip_deflection(length, height, 10, 1, p);
    assert_close(found, bending + shear, ONE_CELL, "tip deflection, one cell through the height");
}
