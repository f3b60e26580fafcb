//! Contact: bars that meet, a Hertz contact, a disc that comes to roll, a block that slides to a stop.

use anyhow::{Context, Result};
use stribeck_contact::{Law, Method};
use stribeck_mesh::{Disc, Part};
use stribeck_solver::{Behaviour, NodeMotion, rigid::RigidState};
use stribeck_system::{Plan, Preload, System};

use super::Timer;
use crate::Rows;
use crate::rig::{THICKNESS, pair, penalty, rectangle, steel, touching};

const G: f64 = 9.81;

const POINTS: Method = Method::Integrated { points: 4 };

/// Two equal bars; error of the velocities after the impact over the velocity of approach.
fn bars(cells: usize, method: Method, scale: f64, factor: f64) -> Result<(f64, f64)> {
    let (length, speed) = (0.05, 1.0);
    let size = length / cells as f64;
    let mut plan = Plan::new(THICKNESS);
    for (name, x) in [("a", -length), ("b", 1e-9)] {
        plan.add(name, &rectangle([x, 0.0], [length, 2.0 * size], [cells, 2])?, steel())?;
        plan.constrain(name, NodeMotion::HeldY)?;
    }
    plan.contact(pair("a.right", "b.left", penalty(&steel(), size, scale)?, method))?;
    let elements = plan.model.mesh.elements() as f64;
    let mut system = plan.build(1)?;
    system.set_time_step_factor(factor)?;
    system.launch(system.body("a")?, [speed, 0.0], 0.0);
    system.launch(system.body("b")?, [-speed, 0.0], 0.0);
    let steps = (3.0 * length / steel().dilatational_speed() / system.time_step()) as u64;
    let (mut first, mut last) = (None, 0);
    for n in 0..steps {
        system.step()?;
        if touching(&system) {
            first = first.or(Some(n));
            last = n;
        }
    }
    let touched = (last - first.context("the bars did not meet")?) as f64 * system.time_step();
    Ok((steps as f64 * elements, (touched * steel().dilatational_speed() / (2.0 * length) - 1.0).abs()))
}

/// Radius of the curved block, half-width that the load is chosen for, height of each block [m].
const HERTZ: [f64; 3] = [0.2, 1.2e-3, 0.02];

/// A block of `columns` × `columns`/2 cells, five times finer at the middle of the side in contact.
fn graded(columns: usize, contact_below: bool, uniform: bool) -> Result<Part> {
    let [radius, _, height] = HERTZ;
    let mut part = rectangle([-1.0, 0.0], [2.0, 1.0], [columns, columns / 2])?;
    let grade = |s: f64| if uniform { s } else { 0.2 * s + 0.8 * s * s * s };
    for n in 0..part.x.len() {
        let x = height * grade(part.x[n]);
        let depth = height * grade(if contact_below { part.y[n] } else { 1.0 - part.y[n] });
        let arc = x * x / (2.0 * radius) * (1.0 - depth / height);
        (part.x[n], part.y[n]) = (x, if contact_below { depth + arc } else { -depth });
    }
    Ok(part)
}

fn pressed(columns: usize, method: Method, scale: f64, uniform: bool) -> Result<(f64, f64)> {
    let [radius, half_width, height] = HERTZ;
    let modulus = 0.5 * steel().plane_strain_modulus();
    let line_load = std::f64::consts::PI * modulus * half_width * half_width / (4.0 * radius);
    let cell = if uniform { 1.0 } else { 0.2 } * 2.0 * height / columns as f64;
    let mut plan = Plan::new(THICKNESS);
    let lower = plan.add("lower", &graded(columns, false, uniform)?, steel())?.body;
    plan.add("upper", &graded(columns, true, uniform)?, steel())?;
    plan.contact(pair("upper.bottom", "lower.top", Law::penalty(scale * modulus / cell)?, method))?;
    plan.constrain("lower.bottom", NodeMotion::Held)?;
    // The middle column of the upper block stays on the axis of symmetry.
    for n in plan.nodes("upper")?.into_iter().skip(columns / 2).step_by(columns + 1) {
        plan.model.motion[n as usize] = NodeMotion::HeldX;
    }
    plan.load("upper.top", [0.0, -line_load * THICKNESS])?;
    let elements = plan.model.mesh.elements() as f64;
    let mut system = plan.build(1)?;
    system.settle(&Preload::default())?;
    let force = system.contact_forces();
    let (mut sum, mut moment) = (0.0, 0.0);
    for n in system.nodes_of(lower) {
        let (f, x) = (force[n as usize][1], system.position(n)[0]);
        sum += f;
        moment += f * x * x;
    }
    Ok((elements, (2.0 * (moment / sum).sqrt() / half_width - 1.0).abs()))
}

/// A rigid body on a fixed floor.
fn on_floor(part: &Part, surface: &str, law: Law, method: Method) -> Result<(System, usize)> {
    let mut plan = Plan::new(THICKNESS);
    let body = plan.add("body", part, steel())?.body;
    plan.add("floor", &rectangle([-0.013, -1e-3], [0.05, 1e-3], [50, 1])?, steel())?;
    plan.contact(pair(&format!("body.{surface}"), "floor.top", law, method))?;
    plan.constrain("floor", NodeMotion::Held)?;
    plan.model.behaviour[body] = Behaviour::Rigid;
    plan.model.gravity = [0.0, -G];
    Ok((plan.build(1)?, body))
}

fn place(system: &System, body: usize) -> Result<RigidState> {
    system.rigid(body).copied().context("the body is rigid")
}

fn take(system: &mut System, steps: u64) -> Result<()> {
    for _ in 0..steps {
        system.step()?;
    }
    Ok(())
}

/// A disc is set down sliding; error of the speed at which it rolls in the end.
fn roll(facets: usize, method: Method, friction: f64) -> Result<(f64, f64)> {
    let (radius, speed) = (0.02, 0.15);
    let law = Law::penalty(1e13)?.with_friction(friction)?.with_damping(0.3, 10.0)?;
    let part = Disc { radius, facets, size: 3e-3, rotation: 0.0 }.part()?.translated(0.0, radius);
    let (mut system, body) = on_floor(&part, "rim", law, method)?;
    system.set_time_step(1e-6, None)?;
    system.launch(body, [speed, 0.0], 0.0);
    take(&mut system, 35_000)?;
    let (from, t) = (place(&system, body)?.centre[0], system.time());
    take(&mut system, 20_000)?;
    let rolled = (place(&system, body)?.centre[0] - from) / (system.time() - t);
    // A step costs its contact points; nothing else is evaluated for a rigid body.
    let points = if let Method::Integrated { points } = method { points } else { 1 };
    Ok((55_000.0 * (facets * points) as f64, (rolled / (2.0 / 3.0 * speed) - 1.0).abs()))
}

/// A block slides to a stop; error of its way v²/(2µg).
fn stop(stiffness: f64, dt: f64, method: Method) -> Result<(f64, f64)> {
    let (speed, friction) = (0.05, 0.2);
    let law = Law::penalty(stiffness)?.with_friction(friction)?.with_damping(0.3, 20.0)?;
    let part = rectangle([0.0; 2], [0.01, 5e-3], [10, 5])?;
    let (mut system, body) = on_floor(&part, "bottom", law, method)?;
    system.set_time_step(dt, None)?;
    // It rests on the floor first.
    let steps = (0.005 / dt) as u64;
    take(&mut system, steps)?;
    let rest = place(&system, body)?;
    system.launch(body, [speed, rest.velocity[1]], rest.spin);
    let time = 1.3 * speed / (friction * G);
    let sliding = (time / dt) as u64;
    take(&mut system, sliding)?;
    let way = place(&system, body)?.centre[0] - rest.centre[0];
    Ok(((steps + sliding) as f64, (way * 2.0 * friction * G / (speed * speed) - 1.0).abs()))
}

pub(super) fn curves(timer: &Timer<'_>, rows: &mut Rows) -> Result<()> {
    let one_point = Method::Integrated { points: 1 };
    for (name, method, scale, factor) in [
        ("integrated, 4 points", POINTS, 1.0, 0.9),
        ("collocated", Method::Collocated, 1.0, 0.9),
        ("integrated, Δt factor 0.4", POINTS, 1.0, 0.4),
        ("integrated, penalty × 0.1", POINTS, 0.1, 0.9),
        ("integrated, penalty × 4", POINTS, 4.0, 0.9),
    ] {
        let cells = [25, 50, 100, 200, 400].map(|n| (0.05 / n as f64, n));
        timer.curve(rows, "Impact of two bars", name, cells, |n| bars(n, method, scale, factor))?;
    }
    for (name, method, scale, uniform, columns) in [
        ("integrated, 4 points, penalty × 20", POINTS, 20.0, false, [20, 40, 80]),
        ("integrated, 1 point, penalty × 20", one_point, 20.0, false, [20, 40, 80]),
        ("collocated, penalty × 20", Method::Collocated, 20.0, false, [20, 40, 80]),
        ("integrated, 4 points, penalty × 1", POINTS, 1.0, false, [20, 40, 80]),
        ("uniform mesh, penalty × 20", POINTS, 20.0, true, [40, 80, 120]),
    ] {
        let columns = columns.map(|n| (2.0 * HERTZ[2] / n as f64, n));
        timer.curve(rows, "Hertz line contact", name, columns, |n| pressed(n, method, scale, uniform))?;
    }
    for (name, method) in [
        ("integrated, 4 points", POINTS),
        ("integrated, 1 point", one_point),
        ("collocated", Method::Collocated),
    ] {
        let facets = [32, 64, 128, 256].map(|n| (std::f64::consts::TAU * 0.02 / n as f64, n));
        timer.curve(rows, "From sliding to rolling", name, facets, |n| roll(n, method, 0.3))?;
    }
    for (name, stiffness, method) in [
        ("integrated, 10¹² Pa/m", 1e12, POINTS),
        ("collocated, 10¹² Pa/m", 1e12, Method::Collocated),
        ("integrated, 10¹¹ Pa/m", 1e11, POINTS),
    ] {
        let steps = [4e-6, 2e-6, 1e-6, 0.5e-6].map(|dt| (dt, dt));
        timer.curve(rows, "A block slides to a stop", name, steps, |dt| stop(stiffness, dt, method))?;
    }
    Ok(())
}
