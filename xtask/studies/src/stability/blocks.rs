//! Blocks and a cylinder: Poisson's ratio, odd cells, far places and units, loads that change in mid-run.

use std::f64::consts::TAU;

use anyhow::Result;
use stribeck_contact::Method;
use stribeck_mesh::{Annulus, Part};
use stribeck_solver::{Elastic, NodeMotion};
use stribeck_system::{Plan, Preload, System};

use super::Case;
use super::bars::{POINTS, collide};
use crate::rig::{THICKNESS, pair, penalty, rectangle, steel, stir, stop_reason, touching};

/// Momentum of a stirred free body may drift by this over the sum of its nodes' momenta.
const ROUNDING: f64 = 1e-10;
/// Inner and outer radius of the cylinder [m], and its internal pressure [Pa].
const CYLINDER: [f64; 2] = [0.05, 0.1];
const PRESSURE: f64 = 10e6;

/// Every quadrilateral as two triangles.
pub(crate) fn split(mut part: Part) -> Part {
    part.triangles = part.quads.drain(..).flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    part
}

/// The ring of a thick cylinder.
pub(crate) fn ring(facets: usize, layers: usize) -> Annulus {
    let [inner_radius, outer_radius] = CYLINDER;
    Annulus { inner_radius, outer_radius, facets, layers, start_angle: 0.0, grooves: Vec::new() }
}

/// Displacement of the bore of a thick cylinder, whose mesh has `facets` there, under internal pressure over
/// Lamé's (Timoshenko and Goodier, *Theory of Elasticity*, 3rd ed. 1970, §28, plane strain).
pub(crate) fn cylinder(part: &Part, material: Elastic, facets: usize) -> Result<f64> {
    let [a, b] = CYLINDER;
    let mut plan = Plan::new(THICKNESS);
    plan.add("cylinder", part, material)?;
    let bore = plan.nodes("cylinder.inner")?;
    // The pressure on a chord is that on its arc's projection.
    let share = PRESSURE * THICKNESS * a * (TAU / facets as f64).sin();
    let mesh = &plan.model.mesh;
    let push = |n: usize| [share * mesh.x[n] / a, share * mesh.y[n] / a];
    let loads = bore.iter().map(|&n| (n, push(n as usize))).collect();
    plan.load_nodes("pressure", loads)?;
    let mut system = plan.build(1)?;
    system.settle(&Preload { longest_step: 1e-3, ..Preload::default() })?;
    let radii = bore.iter().map(|&n| system.position(n)).map(|[x, y]| x.hypot(y));
    let radius = radii.sum::<f64>() / bore.len() as f64;
    let (e, nu) = (material.youngs_modulus(), material.poissons_ratio());
    let lame = PRESSURE * a * a / (e * (b * b - a * a)) * (1.0 + nu) * ((1.0 - 2.0 * nu) * a + b * b / a);
    Ok((radius - a) / lame)
}

/// Poisson's ratio from 0 to nearly incompressible.
pub(super) fn poisson() -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    for nu in [0.0, 0.3, 0.49, 0.499, 0.4999] {
        let material = Elastic::new(208e9, nu, 7800.0)?;
        let (right, seen) = match cylinder(&ring(96, 12).part()?, material, 96) {
            Ok(r) => ((r - 1.0).abs() < 0.01, format!("bore of a thick cylinder moves {r:.4} × Lamé")),
            Err(e) => (true, format!("static start refused: {e}")),
        };
        let mut plan = Plan::new(THICKNESS);
        plan.add("block", &rectangle([0.0; 2], [0.01, 0.008], [10, 8])?, material)?;
        let mut system = plan.build(1)?;
        system.set_time_step_factor(0.9)?;
        stir(&mut system, 0.01);
        let stop = stop_reason(system.run(50_000, 50, |_, _| ())?);
        let done = format!("ν = {nu}: 50 000 steps of a stirred block");
        cases.push(Case::of(done, system.balance().largest_error, stop, right, seen));
    }
    Ok(cases)
}

/// A stirred free body of this shape keeps energy and momentum over 20 000 steps.
fn stirred(done: &str, part: &Part) -> Result<Case> {
    let mut plan = Plan::new(THICKNESS);
    let body = plan.add("block", part, steel())?.body;
    let mut system = plan.build(1)?;
    system.set_time_step_factor(0.9)?;
    stir(&mut system, 0.01);
    let before = system.motion_of(body).velocity;
    let stop = stop_reason(system.run(20_000, 20, |_, _| ())?);
    let after = system.motion_of(body).velocity;
    let drift = (after[0] - before[0]).hypot(after[1] - before[1]) / 0.01;
    let seen = format!("time step {:.3e} s, momentum kept to {drift:.0e}", system.time_step());
    Ok(Case::of(done, system.balance().largest_error, stop, drift < ROUNDING, seen))
}

/// Columns of a rectangle, one of them `narrow` times as wide as the others.
fn one_narrow(narrow: f64) -> Result<Part> {
    let mut part = rectangle([0.0; 2], [0.01, 0.004], [10, 4])?;
    for x in &mut part.x {
        let column = (*x / 1e-3).round();
        *x = if column <= 5.0 { column * 1e-3 } else { (column - 1.0 + narrow) * 1e-3 };
    }
    Ok(part)
}

/// Slivers, aspect ratios, one very small cell, far away from the origin, very small and very large.
pub(super) fn shapes() -> Result<Vec<Case>> {
    let flat = || rectangle([0.0; 2], [0.01, 0.4e-3], [10, 40]);
    let mut sliver = split(rectangle([0.0; 2], [0.01, 0.004], [10, 4])?);
    // An inner node comes close to the opposite side of one of its triangles.
    sliver.y[2 * 11 + 5] -= 0.998e-3;
    let mut cases = vec![
        stirred("cells of aspect 100", &flat()?)?,
        stirred("triangles of aspect 100", &split(flat()?))?,
        stirred("one column a hundredth as wide", &one_narrow(0.01)?)?,
        stirred("one column a ten-thousandth as wide", &one_narrow(1e-4)?)?,
        stirred("a sliver of 2 µm among triangles of 1 mm", &sliver)?,
    ];
    let home = collide([steel(); 2], 1.0, 1.0, POINTS, 0.0, 1.0)?;
    for (done, place, unit) in [
        ("bar impact, 1 km from the origin", 1e3, 1.0),
        ("bar impact, 100 km from the origin", 1e5, 1.0),
        ("bar impact, bars of 20 nm", 0.0, 1e-6),
        ("bar impact, bars of 20 km", 0.0, 1e6),
    ] {
        let c = collide([steel(); 2], 1.0, 1.0, POINTS, place, unit)?;
        let off = (c.after[0] - home.after[0]).abs().max((c.after[1] - home.after[1]).abs());
        let momentum = c.momentum();
        let seen =
            format!("velocities within {off:.1e} m/s of those at home, momentum kept to {momentum:.0e}");
        cases.push(Case::of(done, c.energy, c.stop, off < 2e-3 && momentum < 1e-6, seen));
    }
    Ok(cases)
}

/// Two blocks pressed together by 100 MPa.
pub(super) fn pressed(method: Method, scale: f64) -> Result<System> {
    let (size, [width, height]) = (1e-3, [8e-3, 4e-3]);
    let mut plan = Plan::new(THICKNESS);
    plan.add("lower", &rectangle([0.0, -height], [width, height], [8, 4])?, steel())?;
    // Narrower, so that no corner sits on the edge of a corner.
    plan.add("upper", &rectangle([1.2e-3, 1e-9], [0.7 * width, height], [6, 4])?, steel())?;
    plan.contact(pair("upper.bottom", "lower.top", penalty(&steel(), size, scale)?, method))?;
    plan.constrain("lower.bottom", NodeMotion::Held)?;
    plan.load("upper.top", [0.0, -100e6 * 0.7 * width * THICKNESS])?;
    let mut system = plan.build(1)?;
    system.settle(&Preload::default())?;
    Ok(system)
}

/// Loads that vanish or turn round while a block is pressed on another.
pub(super) fn loads() -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    for (done, factor) in [("removed", 0.0), ("reversed", -1.0), ("ten times as large at once", 10.0)] {
        let mut system = pressed(POINTS, 1.0)?;
        system.set_time_step_factor(0.9)?;
        let mut stop = stop_reason(system.run(500, 5, |_, _| ())?);
        if stop.is_none() {
            system.scale_load("upper.top", factor)?;
            stop = stop_reason(system.run(1500, 5, |_, _| ())?);
        }
        let leaves = system.motion_of(system.body("upper")?).velocity[1];
        let sunk = system.resultants().any(|r| r.penetration >= 1e-4);
        let right = if factor > 0.0 { !sunk } else { leaves > 0.0 };
        let way = if leaves > 0.0 { "rises" } else { "sinks" };
        let seen = if touching(&system) { "touching" } else { "free" };
        let seen = format!("the block {way} at {leaves:.3} m/s, {seen}");
        let done = format!("100 MPa between two blocks, the load {done} in mid-run");
        cases.push(Case::of(done, system.balance().largest_error, stop, right, seen));
    }
    Ok(cases)
}
