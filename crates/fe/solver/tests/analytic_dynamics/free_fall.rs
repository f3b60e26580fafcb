//! Discs and blocks, elastic and rigid, fall side by side.
//!
//! # Goal
//!
//! Gravity in both directions, through every path by which a node is moved: triangles, strips of
//! quadrilaterals, congruent bodies, a rigid body.
//!
//! # Mesh
//!
//! ```text
//!   ┌─┬─┬─┬─┐             ╔═╤═╤═╤═╗
//!   ├─┼─┼─┼─┤ elastic     ╟─┼─┼─┼─╢ rigid        y = 0.1 m
//!   └─┴─┴─┴─┘             ╚═╧═╧═╧═╝
//!
//!     .-.         .-.         .-.
//!    (   )       (   )       (   )   elastic     y = 0
//!     '-'         '-'         '-'
//!    x = 0       0.05 m      0.1 m               g ↘
//! ```
//!
//! Discs of 10 mm radius with 24 facets; blocks of 20 × 10 mm with 4 × 2 cells.
//!
//! # Boundary conditions
//!
//! None. All bodies start at rest; nothing touches.
//!
//! # Parameters
//!
//! g = (2, −9.81) m/s², 0.9 of the critical time step Δt, n = 20 000 steps.
//!
//! # Expected
//!
//! From rest half a step before the start leapfrog sums the fall exactly: u = g Δt² n (n + 1)/2. Nothing is
//! strained.

use stribeck_mesh::{Disc, Mesh};
use stribeck_solver::{Behaviour, Model};
use stribeck_testing::assert_close;

use crate::common::*;

/// Positions of 0.1 m round to 1e-17 m in each of 20 000 steps [m].
const ROUNDING: f64 = 1e-12;

/// Time is a product of the number of steps.
const TIME: f64 = 1e-14;

/// Share of the work of gravity: more than strains of rounding hold, less than any motion of a node against
/// its neighbours.
const STRAIN: f64 = 1e-12;

#[test]
fn by_hand_free_fall() {
    let mut mesh = Mesh::new();
    let disc = Disc { radius: 0.01, facets: 24, size: 3e-3, rotation: 0.0 }.part().expect("a disc");
    for i in 0..3 {
        mesh.add(format!("disc {i}"), &disc.translated(0.05 * i as f64, 0.0));
    }
    mesh.add("block", &rectangle(0.02, 0.01, 4, 2).translated(0.0, 0.1));
    let rigid = mesh.add("rigid block", &rectangle(0.02, 0.01, 4, 2).translated(0.1, 0.1));
    let mut model = Model::new(mesh, steel(), THICKNESS).expect("a positive thickness");
    model.behaviour[rigid.body] = Behaviour::Rigid;
    model.gravity = [2.0, -9.81];
    let mut d = ready(&model, 0.9);
    let n = 20_000;
    run(&mut d, &mut [], n);

    let fall = 0.5 * d.time_step().powi(2) * n as f64 * (n + 1) as f64;
    assert_close(d.state.time, n as f64 * d.time_step(), TIME, "time");
    for node in 0..model.mesh.x.len() {
        let s = slot(&d, node);
        assert!((d.state.x[s] - model.mesh.x[node] - 2.0 * fall).abs() < ROUNDING, "node {node}");
        assert!((d.state.y[s] - model.mesh.y[node] + 9.81 * fall).abs() < ROUNDING, "node {node}");
    }
    assert!(d.elastic_energy().strain < STRAIN * d.gravity_work().abs(), "nothing is strained");
}
