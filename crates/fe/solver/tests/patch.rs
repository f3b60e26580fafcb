//! Constant strain and rigid motion, the two fields that every element must represent exactly.
//!
//! Irons and Razzaque, *Experience with the patch test for convergence of finite elements* (1972); here in
//! its explicit form: a body under a linear displacement field, its sides held, stays at rest.

mod common;

use common::*;
use stribeck_mesh::{Annulus, Groove, Mesh, Part};
use stribeck_solver::{Dynamics, Model, NodeMotion};
use stribeck_testing::{Noise, assert_close};

const COLUMNS: usize = 7;
const ROWS: usize = 6;
/// Side of an undistorted cell [m].
const CELL: f64 = 1e-3;
/// Nodes move by up to this part of a cell, so that no two elements are alike.
const DISTORTION: f64 = 0.3;

/// Rounding of a nodal force relative to E · thickness · cell: strains are differences of numbers near one.
const FORCE_ROUNDING: f64 = 3e-13;

/// Rounding of two sums of the same few terms in different order, relative to the largest; strains of 1e-2
/// are differences of numbers near one, and congruent elements share one reference, which differs from theirs
/// in the last digits.
const SUM_ROUNDING: f64 = 1e-11;

fn square_cells() -> Part {
    rectangle(COLUMNS as f64 * CELL, ROWS as f64 * CELL, COLUMNS, ROWS)
}

fn distorted() -> Part {
    let mut part = square_cells();
    distort(&mut part, COLUMNS, ROWS, DISTORTION * CELL);
    part
}

/// Elements in reverse order: no two neighbours follow each other, so that every one is gathered.
fn without_strips(mut part: Part) -> Part {
    part.quads.reverse();
    part
}

/// Copies of a part, each turned and moved elsewhere.
fn copies(part: &Part, n: usize) -> (Model, Vec<(f64, [f64; 2])>) {
    let mut mesh = Mesh::new();
    let places: Vec<_> = (0..n).map(|i| (0.7 * i as f64, [0.02 * i as f64, -0.01 * i as f64])).collect();
    for (i, (angle, [x, y])) in places.iter().enumerate() {
        mesh.add(format!("copy {i}"), &part.rotated(*angle).translated(*x, *y));
    }
    (Model::new(mesh, steel(), THICKNESS).expect("a positive thickness"), places)
}

/// Elastic forces at present positions, by slot.
fn forces(d: &Dynamics) -> (Vec<f64>, Vec<f64>) {
    let n = d.state.x.len();
    let (mut fx, mut fy) = (vec![0.0; n], vec![0.0; n]);
    d.elastic_forces(&d.state.x, &d.state.y, &mut fx, &mut fy);
    (fx, fy)
}

/// Largest velocity of a body that carries the field x → F·X on its sides, after 100 steps.
fn speed_under_linear_field(part: &Part, f: [[f64; 2]; 2]) -> f64 {
    let mut model = body(part);
    for n in on_sides(COLUMNS, ROWS) {
        model.motion[n] = NodeMotion::Held;
    }
    let mut d = ready(&model, 0.9);
    for n in 0..model.mesh.x.len() {
        let (x, y, s) = (model.mesh.x[n], model.mesh.y[n], slot(&d, n));
        d.state.x[s] = f[0][0] * x + f[0][1] * y;
        d.state.y[s] = f[1][0] * x + f[1][1] * y;
    }
    run(&mut d, &mut [], 100);
    d.state.vx.iter().chain(&d.state.vy).fold(0.0, |a, v| a.max(v.abs()))
}

#[test]
fn patch_linear_field_stays_at_rest() {
    // Stretch, shear and a turn of 0.2 rad together, strains of some per cent: the element is exact at any
    // size.
    let (s, c) = 0.2_f64.sin_cos();
    let (a, b, g) = (1.02, 0.97, 0.03);
    let f = [[c * a - s * g, c * g - s * b], [s * a + c * g, s * g + c * b]];
    // A velocity of strain · wave speed would be a wrong force; rounding is 14 digits below 1 · wave speed.
    let at_rest = 1e-12 * steel().dilatational_speed();
    for (name, part) in [
        ("strips", distorted()),
        ("gathered", without_strips(distorted())),
        ("triangles", split(distorted())),
    ] {
        let speed = speed_under_linear_field(&part, f);
        assert!(speed < at_rest, "{name}: {speed:e} m/s after 100 steps");
    }
}

#[test]
fn patch_bent_field_does_not_stay_at_rest() {
    // The same measurement sees a field that is not linear: the test above can fail.
    let mut model = body(&distorted());
    for n in on_sides(COLUMNS, ROWS) {
        model.motion[n] = NodeMotion::Held;
    }
    let mut d = ready(&model, 0.9);
    for s in massive(&d) {
        d.state.x[s] += 1e-2 * d.state.x[s] * d.state.x[s] / CELL;
    }
    run(&mut d, &mut [], 100);
    assert!(d.state.vx.iter().any(|v| v.abs() > 1.0));
}

#[test]
fn patch_hourglass_field_is_resisted() {
    let mut d = lay_out(&body(&rectangle(CELL, CELL, 1, 1)));
    let before = d.elastic_energy();
    for (n, sign) in [1.0, -1.0, -1.0, 1.0].into_iter().enumerate() {
        let s = slot(&d, n);
        d.state.x[s] += 1e-6 * sign;
    }
    let after = d.elastic_energy();
    // Pure bending of a square: ½ E' t/12 (γ·u)², γ·u = 4 · 1 µm (THEORY §2.2).
    let expected = 0.5 * steel().plane_strain_modulus() * THICKNESS / 12.0 * 16e-12;
    assert_close(after.hourglass - before.hourglass, expected, 1e-9, "hourglass energy");
}

#[test]
fn patch_rigid_rotation_gives_no_force() {
    let (eight, _) = copies(&distorted(), 8);
    for (name, model) in [
        ("squares", body(&square_cells())),
        ("quadrilaterals", body(&distorted())),
        ("triangles", body(&split(distorted()))),
        ("congruent bodies", eight),
    ] {
        for angle in [0.3, 1.5, 3.0, -2.2_f64] {
            let mut d = ready(&model, 0.9);
            let (s, c) = angle.sin_cos();
            for n in massive(&d) {
                let (x, y) = (d.state.x[n], d.state.y[n]);
                d.state.x[n] = c * x - s * y;
                d.state.y[n] = s * x + c * y;
            }
            // Coordinates of 0.1 m round to 1e-17 m: strains of 1e-14 in cells of 1 mm.
            let zero = FORCE_ROUNDING * steel().youngs_modulus() * THICKNESS * CELL;
            let (fx, fy) = forces(&d);
            let worst = fx.iter().chain(&fy).fold(0.0_f64, |a, f| a.max(f.abs()));
            assert!(worst < zero, "{name} turned by {angle} rad: {worst:e} N");
            // The kernels of the time loop agree: no node starts to move.
            d.step(&mut []);
            let lightest = massive(&d).iter().map(|&n| d.mass()[n]).fold(f64::INFINITY, f64::min);
            let still = d.time_step() * zero / lightest;
            assert!(d.state.vx.iter().chain(&d.state.vy).all(|v| v.abs() < still), "{name}, {angle} rad");
        }
    }
}

/// Deforms copy `places[i]` of a body by the same field in its own frame, takes a step and returns the
/// accelerations [m/s²] of its nodes in its own frame.
fn accelerations(model: &Model, places: &[(f64, [f64; 2])], field: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut d = ready(model, 0.5);
    for (copy, (angle, _)) in places.iter().enumerate() {
        let (s, c) = angle.sin_cos();
        for (i, [u, v]) in field.iter().enumerate() {
            let n = slot(&d, copy * field.len() + i);
            d.state.x[n] += c * u - s * v;
            d.state.y[n] += s * u + c * v;
        }
    }
    d.step(&mut []);
    let own = |copy: usize, angle: f64, i: usize| {
        let n = slot(&d, copy * field.len() + i);
        let (s, c) = angle.sin_cos();
        let (ax, ay) = (d.state.vx[n] / d.time_step(), d.state.vy[n] / d.time_step());
        [c * ax + s * ay, c * ay - s * ax]
    };
    places
        .iter()
        .enumerate()
        .map(|(copy, (angle, _))| (0..field.len()).map(|i| own(copy, *angle, i)).collect())
        .collect()
}

fn largest(a: &[[f64; 2]]) -> f64 {
    a.as_flattened().iter().fold(0.0, |m, v| m.max(v.abs()))
}

fn difference(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    a.as_flattened().iter().zip(b.as_flattened()).fold(0.0, |m, (p, q)| m.max((p - q).abs()))
}

#[test]
fn patch_every_path_gives_the_same_accelerations() {
    let mut noise = Noise::new(7);
    for (name, part) in
        [("squares", square_cells()), ("quads", distorted()), ("triangles", split(distorted()))]
    {
        // One per cent of a cell at every node: strains of some per cent, hourglass modes included.
        let field: Vec<[f64; 2]> =
            part.x.iter().map(|_| [0.01 * CELL * noise.uniform(), 0.01 * CELL * noise.uniform()]).collect();
        let alone = [(0.0, [0.0; 2])];
        let reference = &accelerations(&body(&part), &alone, &field)[0];
        let scale = largest(reference);
        assert!(scale > 0.0);
        let gathered = &accelerations(&body(&without_strips(part.clone())), &alone, &field)[0];
        assert!(
            difference(reference, gathered) < SUM_ROUNDING * scale,
            "{name}, gathered: {:e}",
            difference(reference, gathered) / scale
        );
        for n in [2, 8, 11] {
            let (model, places) = copies(&part, n);
            // Slots of one body's nodes lie eight apart: the bodies share a tile.
            let layout = lay_out(&model).layout().slot_of_node.clone();
            assert_eq!(layout[1] - layout[0], 8, "{n} {name} are laid out side by side");
            for (i, a) in accelerations(&model, &places, &field).iter().enumerate() {
                // Places up to 0.2 m away leave 3e-17 m of 1e-5 m of displacement.
                let off = difference(reference, a) / scale;
                assert!(off < 1e-10, "{name}, copy {i} of {n}: {off:e}");
            }
        }
    }
}

/// More nodes than one tile holds, so that those at the seams have ghosts: a plate is cut between rows, a
/// ring across them.
#[test]
fn patch_tiles_of_one_body_agree_with_the_plain_sum() {
    let mut plate = rectangle(0.12, 0.1, 120, 100);
    distort(&mut plate, 120, 100, DISTORTION * CELL);
    let ring = Annulus {
        inner_radius: 0.1,
        outer_radius: 0.12,
        facets: 600,
        layers: 20,
        start_angle: 0.1,
        grooves: vec![Groove::rectangular(1.0, 0.02, 1e-3)],
    };
    // Rows of squares with others among them, at either end and in the middle.
    let squares = rectangle(0.12, 0.1, 120, 100);
    let odd = |columns: std::ops::Range<usize>| {
        let mut part = squares.clone();
        for n in (0..part.x.len()).filter(|n| columns.contains(&(n % 121))) {
            part.y[n] += 0.1 * CELL * (n as f64).sin();
        }
        part
    };
    let ring = ring.part().expect("a ring with a groove");
    for part in [plate, ring, odd(0..3), odd(61..64), odd(50..52), odd(110..121), odd(32..90)] {
        let model = body(&part);
        let mut d = ready(&model, 0.5);
        assert!(d.layout().len() > model.mesh.x.len() + 60, "there are ghosts");
        let mut noise = Noise::new(3);
        for n in massive(&d) {
            d.state.x[n] += 0.01 * CELL * noise.uniform();
            d.state.y[n] += 0.01 * CELL * noise.uniform();
        }
        let (fx, fy) = forces(&d);
        d.step(&mut []);
        let scale = fx.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        for n in massive(&d) {
            let m = d.mass()[n] / d.time_step();
            assert!((m * d.state.vx[n] - fx[n]).abs() < SUM_ROUNDING * scale, "slot {n}");
            assert!((m * d.state.vy[n] - fy[n]).abs() < SUM_ROUNDING * scale, "slot {n}");
        }
    }
}

#[test]
fn issue_small_cells_far_from_the_origin_are_still_alike() {
    // Areas from products of absolute coordinates lost four digits here, so that copies of one body no longer
    // counted as congruent and rows of equal cells not as uniform.
    let part = rectangle(0.3e-3, 0.2e-3, 6, 4);
    let mut mesh = Mesh::new();
    for i in 0..8 {
        mesh.add(format!("copy {i}"), &part.rotated(0.8 * i as f64).translated(0.2, 0.01 * i as f64 - 0.1));
    }
    let model = Model::new(mesh, steel(), THICKNESS).expect("a positive thickness");
    let slots = lay_out(&model).layout().slot_of_node.clone();
    assert_eq!(slots[1] - slots[0], 8, "eight congruent bodies lie side by side");
}
