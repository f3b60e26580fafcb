//! An elastic column rests on a floor.
//!
//! # Goal
//!
//! Penetration under a uniform pressure, in equilibrium, and the sign of the resultant.
//!
//! # Mesh
//!
//! ```text
//!        ▷┌┬┬┬┬┬┬┬┬┬┬┐◁
//!        ▷├┼┼┼┼┼┼┼┼┼┼┤◁   20 × 10 cells, 20 × 10 mm           ↓ g
//!        ▷├┼┼┼┼┼┼┼┼┼┼┤◁
//!        ▷└┴┴┴┴┴┴┴┴┴┴┘◁   sinks by ρ g H/k
//!   ┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬
//!   └┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┘   40 × 1 cells of 1 mm, 0.3 mm off the column's
//!    ▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧
//! ```
//!
//! # Boundary conditions
//!
//! The column's nodes are held in x, so that the pressure is the same everywhere; all nodes of the floor are
//! held.
//!
//! # Parameters
//!
//! g = 9.81 m/s², E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³, penalty k = 10¹¹ Pa/m; contact points at nodes and
//! integrated.
//!
//! # Expected
//!
//! The penetration is ρ g H/k; the resultant on the first body, the column, is its weight, upwards.

use stribeck_contact::{Law, Method};
use stribeck_solver::{NodeMotion, force::NodalLoad};
use stribeck_testing::assert_close;

use crate::common::*;
use crate::{G, STIFFNESS};

/// The floor's nodes stand 0.3 mm off the column's, so that it leans a little.
const LEANING: f64 = 1e-3;

/// Integrated, corners have a point of their own: half a share at each end, beside 20 cells of 3.
const CORNERS: f64 = 1.0 / 60.0;

/// Forces are balanced to 1e-7 N of 0.1 N.
const WEIGHT: f64 = 1e-4;

/// Nothing pushes across; sums of forces round [N].
const ACROSS: f64 = 1e-9;

#[test]
fn by_hand_penetration_is_pressure_over_stiffness() {
    let (height, width) = (0.01, 0.02);
    for (method, tolerance) in
        [(Method::Collocated, LEANING), (Method::Integrated { points: 3 }, CORNERS + LEANING)]
    {
        let mut scene = Scene::default();
        let column = scene.add("column", &rectangle([0.0, 0.0], width, height, 20, 10), "bottom");
        // No contact point of the floor lies below an edge of the column: whether it projects onto the column
        // would depend on rounding.
        let floor = scene.add("floor", &rectangle([-0.0103, -1e-3], 0.04, 1e-3, 40, 1), "top");
        scene.pair(column, floor, Law::penalty(STIFFNESS).expect("a positive stiffness"), method);
        let mut model = scene.model();
        model.gravity = [0.0, -G];
        // No sideways motion: the pressure is then the same everywhere.
        model.motion[model.mesh.bodies[column].nodes.clone()].fill(NodeMotion::HeldX);
        model.motion[model.mesh.bodies[floor].nodes.clone()].fill(NodeMotion::Held);
        let (mut d, mut contacts) = scene.lay_out(&model);
        let bodies = vec![("column".to_owned(), of_body(&d, &model, column))];
        let mut no_load = NodalLoad::default();
        preload(&mut d, &mut contacts, &mut no_load, bodies, &[1e-8, 1e-9, 0.0], 1e-7);
        let found = contacts.resultants().next().expect("one pair");
        let pressure = steel().density() * G * height;
        assert_close(found.penetration, pressure / STIFFNESS, tolerance, "penetration");
        assert_close(found.force[1], pressure * width * THICKNESS, WEIGHT, "resultant, up on the first");
        assert!(found.force[0].abs() < ACROSS);
    }
}
