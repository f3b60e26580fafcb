//! Static equilibrium against closed forms: thick cylinder, spinning ring, cantilever, column. One problem a
//! file.

#[path = "../common/mod.rs"]
mod common;

mod spinning_ring;
mod thick_cylinder;

mod cantilever;
mod column_under_its_weight;

use stribeck_mesh::Annulus;
use stribeck_solver::{Dynamics, Model};

use common::*;

/// Unbalanced force allowed [N]: E · thickness = 1.5e9 N/m rounds a force of strained cells to some 1e-8 N of
/// loads of newtons.
const ROUNDING: f64 = 2e-7;

/// Bore of the rings [m].
const INNER: f64 = 0.05;

/// Outside of the rings [m].
const OUTER: f64 = 0.1;

/// A ring whose row `r` of nodes, from the bore outwards, begins with node `r` × `facets`.
fn ring(facets: usize, layers: usize) -> Model {
    let ring = Annulus {
        inner_radius: INNER,
        outer_radius: OUTER,
        facets,
        layers,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    body(&ring.part().expect("a ring that can be made"))
}

/// Mean radial displacement [m] of the row of nodes that starts at `first`.
fn growth(d: &Dynamics, model: &Model, first: usize, facets: usize) -> f64 {
    let radial = |n: usize| {
        let (x, y, s) = (model.mesh.x[n], model.mesh.y[n], slot(d, n));
        d.state.x[s].hypot(d.state.y[s]) - x.hypot(y)
    };
    (first..first + facets).map(radial).sum::<f64>() / facets as f64
}
