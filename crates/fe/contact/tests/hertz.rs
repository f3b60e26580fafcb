//! Line contact of a curved block on a flat one, after Hertz.
//!
//! Johnson, *Contact Mechanics* (1985), §4.2.
//!
//! # Goal
//!
//! Half-width and peak pressure of a contact between elastic bodies, on chords and on splines.
//!
//! # Mesh
//!
//! ```text
//!      w, spread over the top
//!      ↓ ↓ ↓ ↓ ↓ ↓ ↓ ↓ ↓ ↓ ↓
//!    ┌───┬──┬─┬┬┬▷┬┬┬─┬──┬───┐
//!    │   │  │ │││▷│││ │  │   │   H = 20 mm      ▷ the middle column is held in x
//!    ├───┼──┼─┼┼┼▷┼┼┼─┼──┼───┤
//!    └───┴──┴─┴┴┴▷┴┴┴─┴──┴───┘   curved face, R = 0.2 m
//!              2b
//!    ┌───┬──┬─┬┬┬┬┬┬┬─┬──┬───┐   flat face
//!    ├───┼──┼─┼┼┼┼┼┼┼─┼──┼───┤
//!    │   │  │ │││││││ │  │   │   H = 20 mm
//!    └───┴──┴─┴┴┴┴┴┴┴─┴──┴───┘
//!     ▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧
//!    x = −H       0         H
//! ```
//!
//! n × n/2 cells each, n = 20, 40 and 80, five times finer at the contact: 3, 6 and 12 cells in a half-width.
//!
//! # Boundary conditions
//!
//! The base of the lower block is held in x and y, the middle column of the upper one in x, so that it stays
//! upright. A uniform pressure with the resultant w pushes on the top.
//!
//! # Parameters
//!
//! b = 1.2 mm, to which w is chosen; E = 208 GPa, ν = 0.3 in both blocks; a penalty ten times as stiff as the
//! smallest cell.
//!
//! # Expected
//!
//! Under the line load w the half-width is b = √(4 w R/(π E*)), the pressure p(x) = p₀ √(1 − x²/b²) with p₀ =
//! 2 w/(π b); for like bodies E* = E/(2(1 − ν²)).

mod common;
use common::*;
use stribeck_contact::{Law, Method, Smoothing};
use stribeck_mesh::Part;
use stribeck_solver::{Force, NodeMotion, force::NodalLoad, state::NodeForces};
use stribeck_testing::{assert_close, ledger};

/// Radius of the curved face [m]: strains are b/R = 0.6 %, small enough for linear elasticity to hold to as
/// much.
const RADIUS: f64 = 0.2;

/// Half-width that the load is chosen for [m].
const HALF_WIDTH: f64 = 1.2e-3;

/// Height of each block [m]: 17 half-widths, so that both are half-planes to about (b/H)² = 0.4 %.
const HEIGHT: f64 = 0.02;

/// Half-width and peak pressure with 12 cells in a half-width. Strains and the finite blocks leave 0.4 to 0.6
/// % each, of opposite signs; the peak is that of the deepest contact point, which the cells' own error adds
/// to.
const INTEGRATED: [f64; 2] = [0.005, 0.01];

/// With 6 cells and forces at nodes alone: the edge of the contact moves from node to node, and each carries
/// a cell's mean.
const COLLOCATED: [f64; 2] = [0.02, 0.05];

/// A block of `columns` × `columns`/2 cells, five times finer at the middle of its lower (or upper) side.
fn graded(columns: usize, contact_below: bool) -> Part {
    let mut part = rectangle([-1.0, 0.0], 2.0, 1.0, columns, columns / 2);
    let grade = |s: f64| 0.2 * s + 0.8 * s * s * s;
    for n in 0..part.x.len() {
        let x = HEIGHT * grade(part.x[n]);
        let depth = HEIGHT * grade(if contact_below { part.y[n] } else { 1.0 - part.y[n] });
        let arc = x * x / (2.0 * RADIUS) * (1.0 - depth / HEIGHT);
        (part.x[n], part.y[n]) = (x, if contact_below { depth + arc } else { -depth });
    }
    part
}

/// Half-width [m] from the second moment of the contact forces, ∫p x² dx = w b²/4, and peak pressure [Pa], on
/// chords. The law is far stiffer than the cells, whose own compliance is what matters.
fn pressed(columns: usize, method: Method) -> [f64; 2] {
    pressed_by(columns, method, false, 10.0 * steel().plane_strain_modulus() / cell(columns))
}

/// Smallest cell [m].
fn cell(columns: usize) -> f64 {
    0.2 * 2.0 * HEIGHT / columns as f64
}

/// The same under a penalty `stiffness` [Pa/m].
fn pressed_by(columns: usize, method: Method, splines: bool, stiffness: f64) -> [f64; 2] {
    let modulus = 0.5 * steel().plane_strain_modulus();
    let line_load = std::f64::consts::PI * modulus * HALF_WIDTH * HALF_WIDTH / (4.0 * RADIUS);
    let mut scene = Scene::default();
    let lower = scene.add("flat block", &graded(columns, false), "top");
    let upper = scene.add("curved block", &graded(columns, true), "bottom");
    scene.pair(upper, lower, Law::penalty(stiffness).expect("a positive stiffness"), method);
    let mut model = scene.model();
    let row = columns + 1;
    model.motion[..row].fill(NodeMotion::Held);
    let first = model.mesh.bodies[upper].nodes.start;
    // The middle column may not move sideways, which holds the upper block upright.
    for n in (first + columns / 2..model.mesh.x.len()).step_by(row) {
        model.motion[n] = NodeMotion::HeldX;
    }
    let (mut d, mut contacts) = if splines {
        scene.lay_out_smooth(&model, &[(Smoothing::Nagata, true); 2])
    } else {
        scene.lay_out(&model)
    };
    let top = model.mesh.x.len() - row;
    // A uniform pressure on the uneven top: half of each facet to each of its ends.
    let mut loads = Vec::new();
    for n in top..top + columns {
        let push = -0.5 * line_load * THICKNESS * (model.mesh.x[n + 1] - model.mesh.x[n]) / (2.0 * HEIGHT);
        loads.push((slot(&d, n) as u32, 0.0, push));
        loads.push((slot(&d, n + 1) as u32, 0.0, push));
    }
    let mut load = NodalLoad::new(loads);
    let names = ["flat block", "curved block"];
    let bodies = [lower, upper].map(|b| (names[b].to_owned(), of_body(&d, &model, b)));
    let softness = [1e-6, 1e-7, 1e-8, 1e-9, 0.0];
    let tolerance = 1e-7 * line_load * THICKNESS;
    preload(&mut d, &mut contacts, &mut load, bodies.to_vec(), &softness, tolerance);

    let n = d.state.x.len();
    let mut force = NodeForces::zeros(n);
    contacts.accumulate(d.moment(), &mut force);
    let (mut sum, mut moment) = (0.0, 0.0);
    for s in of_body(&d, &model, lower) {
        let (f, x) = (force.fy[s as usize], d.state.x[s as usize]);
        sum += f;
        moment += f * x * x;
    }
    assert_close(-sum, line_load * THICKNESS, 1e-6, "the contact carries the load");
    let deepest = contacts.resultants().next().expect("one pair").penetration;
    [2.0 * (moment / sum).sqrt(), stiffness * deepest]
}

#[test]
fn converges_hertz_half_width_and_pressure() {
    let modulus = 0.5 * steel().plane_strain_modulus();
    let exact = [HALF_WIDTH, modulus * HALF_WIDTH / (2.0 * RADIUS)];
    // 3, 6 and 12 cells in a half-width.
    let found = [20, 40, 80].map(|columns| pressed(columns, Method::Integrated { points: 4 }));
    for (i, what, ceiling) in [(0, "half-width", INTEGRATED[0]), (1, "peak pressure", INTEGRATED[1])] {
        let errors = found.map(|f| (f[i] - exact[i]).abs() / exact[i]);
        let source = "Hertz: Johnson 1985, §4.2";
        let unit = ["m", "Pa"][i];
        ledger::compare(
            &format!("line contact, {what}, integrated"),
            source,
            unit,
            found[2][i],
            exact[i],
            ceiling,
        );
        assert!(errors[2] < 0.5 * errors[0], "{what} converges: {errors:?}");
    }
}

#[test]
fn analytic_hertz_collocated() {
    let modulus = 0.5 * steel().plane_strain_modulus();
    let [half_width, pressure] = pressed(40, Method::Collocated);
    let source = "Hertz: Johnson 1985, §4.2";
    ledger::compare(
        "line contact, half-width, collocated",
        source,
        "m",
        half_width,
        HALF_WIDTH,
        COLLOCATED[0],
    );
    assert_close(pressure, modulus * HALF_WIDTH / (2.0 * RADIUS), COLLOCATED[1], "peak pressure");
}

#[test]
fn converges_hertz_on_splines() {
    // A spline cannot follow a contact that is stiffer than its cells, so Hertz's limit of a rigid law is not
    // tested on it: the law stays that of a layer of the coarsest cells, one problem on every mesh. Its
    // pressure falls to zero without a singularity, so linear elements are of second order, and so is a
    // smoothing whose transfer function leaves one as the square of the wavenumber (THEORY §4.5). Its
    // solution is that of chords under the same law, which reach Hertz's as their law becomes stiff
    // (`converges_hertz_half_width_and_pressure`).
    const ORDER: f64 = 2.0;
    /// With 3 cells in a half-width a term of the fourth order is (h/b)² = 1/9 of that of the second, if
    /// their coefficients are alike; it moves the order by 0.15.
    const HIGHER: f64 = 0.15;
    let stiffness = 1.4 * 0.5 * steel().plane_strain_modulus() / cell(20);
    let method = Method::Integrated { points: 12 };
    let on = |columns: usize, splines: bool| pressed_by(columns, method, splines, stiffness);
    let [coarse, middle, fine] = [20, 40, 80].map(|columns| on(columns, true));
    let order = ((coarse[0] - middle[0]) / (middle[0] - fine[0])).log2();
    assert!((order - ORDER).abs() < HIGHER, "half-widths {coarse:?}, {middle:?}, {fine:?}: order {order}");
    let limit = fine[0] + (fine[0] - middle[0]) / 3.0;
    let [chords, finest_chords] = [40, 80].map(|columns| on(columns, false));
    // No farther apart than the last refinement moves either.
    let apart = (limit - finest_chords[0]).abs();
    assert!(apart < (finest_chords[0] - chords[0]).abs(), "half-width {limit:e} and {finest_chords:?}");
    let apart = (fine[1] - finest_chords[1]).abs();
    let moved = (fine[1] - middle[1]).abs() + (finest_chords[1] - chords[1]).abs();
    assert!(apart < moved, "peak pressure {:e} and {:e}, last moved by {moved:e}", fine[1], finest_chords[1]);
}
