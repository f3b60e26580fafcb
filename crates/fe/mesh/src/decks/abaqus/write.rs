//! Abaqus input files, written.

use std::fmt::Write;

use crate::Mesh;
use crate::decks::model::{Model, Side, Step, numbers, surfaces};
use crate::decks::plain;

/// Numbers in a data line.
const A_LINE: usize = 16;

/// Characters in an item of a data line.
const AN_ITEM: usize = 20;

/// A number to its last bit, or as near as an item holds it: within 10⁻¹³ of it.
fn item(value: f64) -> String {
    let short = format!("{value:e}");
    if short.len() <= AN_ITEM {
        return short;
    }
    let plain = format!("{value}").replacen("0.", ".", 1);
    if plain.len() <= AN_ITEM {
        return plain;
    }
    // A sign, a point and an exponent of four characters leave fourteen digits.
    format!("{value:.13e}")
}

pub(in crate::decks) fn write(mesh: &Mesh, title: &str) -> String {
    let mut out = format!("*HEADING\n{title}\n*NODE\n");
    for (n, (x, y)) in mesh.x.iter().zip(&mesh.y).enumerate() {
        let _ = writeln!(out, "{}, {}, {}, 0.0", n + 1, item(*x), item(*y));
    }
    let mut number = 0;
    for body in &mesh.bodies {
        let set = plain(&body.name);
        if !body.quads.is_empty() {
            let _ = writeln!(out, "*ELEMENT, TYPE=CPE4R, ELSET={set}");
            for [a, b, c, d] in &mesh.quads[body.quads.clone()] {
                number += 1;
                let _ = writeln!(out, "{number}, {}, {}, {}, {}", a + 1, b + 1, c + 1, d + 1);
            }
        }
        if !body.triangles.is_empty() {
            let _ = writeln!(out, "*ELEMENT, TYPE=CPE3, ELSET={set}");
            for [a, b, c] in &mesh.triangles[body.triangles.clone()] {
                number += 1;
                let _ = writeln!(out, "{number}, {}, {}, {}", a + 1, b + 1, c + 1);
            }
        }
        if !body.nodes.is_empty() {
            let _ = writeln!(
                out,
                "*NSET, NSET=NODES_{set}, GENERATE\n{}, {}, 1",
                body.nodes.start + 1,
                body.nodes.end
            );
        }
    }
    out
}

/// Rigid bodies are elastic ones here: to make them stiff, add `*RIGID BODY` with a node of their own.
pub(in crate::decks) fn write_model(model: &Model<'_>, title: &str) -> String {
    let Model { mesh, youngs_modulus, poissons_ratio, density, thickness, rigid, contacts, step } = model;
    let mut out = write(mesh, title);
    let set = |body: usize| plain(&mesh.bodies[body].name);
    let surface_name = |(body, side): (usize, Side)| format!("{}_{}", set(body), side.name());
    for surface in surfaces(mesh) {
        let name = surface_name((surface.body, surface.side));
        let _ = writeln!(out, "*SURFACE, NAME={name}, TYPE=ELEMENT");
        for face in &surface.faces {
            let _ = writeln!(out, "{}, S{}", face.element, face.edge);
        }
        node_set(&mut out, &format!("NODES_{name}"), &surface.nodes());
    }
    let _ = writeln!(
        out,
        "*MATERIAL, NAME=ELASTIC\n*DENSITY\n{density:e}\n*ELASTIC\n{youngs_modulus:e}, {poissons_ratio}"
    );
    for body in 0..mesh.bodies.len() {
        let set = set(body);
        if rigid.contains(&body) {
            let _ = writeln!(out, "** {set} is rigid: add *RIGID BODY, ELSET={set}");
        }
        let _ = writeln!(out, "*SOLID SECTION, ELSET={set}, MATERIAL=ELASTIC\n{thickness}");
    }
    let mut interactions: Vec<f64> = Vec::new();
    for pair in contacts {
        if !interactions.contains(&pair.friction) {
            interactions.push(pair.friction);
        }
    }
    for (n, friction) in interactions.iter().enumerate() {
        let _ = writeln!(
            out,
            "*SURFACE INTERACTION, NAME=CONTACT_{}\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD",
            n + 1
        );
        if *friction > 0.0 {
            let _ = writeln!(out, "*FRICTION\n{friction}");
        }
    }
    for pair in contacts {
        let n = interactions.iter().position(|friction| *friction == pair.friction).unwrap_or_default();
        let [one, other] = pair.surfaces.map(surface_name);
        let _ = writeln!(
            out,
            "*CONTACT PAIR, INTERACTION=CONTACT_{}, TYPE=SURFACE TO SURFACE\n{one}, {other}",
            n + 1
        );
    }
    if let Some(step) = step {
        step_cards(&mut out, mesh, step);
    }
    out
}

/// Sets, velocities at the start, and the step.
fn step_cards(out: &mut String, mesh: &Mesh, step: &Step) {
    for what in &step.left_out {
        let _ = writeln!(out, "** left out: {what}");
    }
    let sets = [("LOADED", &step.load.0), ("GUIDED", &step.guided)];
    for (name, nodes) in sets.into_iter().filter(|(_, nodes)| !nodes.is_empty()) {
        node_set(out, name, &numbers(nodes));
    }
    // Nodes that turn are tied to one in the centre.
    let centre = |n: usize| mesh.x.len() + n + 1;
    for (n, (nodes, _)) in step.turning.iter().enumerate() {
        node_set(out, &format!("TURNING_{}", n + 1), &numbers(nodes));
        let _ = writeln!(
            out,
            "*NODE, NSET=CENTRE_{0}\n{1}, 0.0, 0.0\n*RIGID BODY, REF NODE={1}, TIE NSET=TURNING_{0}",
            n + 1,
            centre(n)
        );
    }
    *out += "*INITIAL CONDITIONS, TYPE=VELOCITY\n";
    for (node, velocity) in step.moving() {
        for (axis, v) in velocity.into_iter().enumerate().filter(|(_, v)| *v != 0.0) {
            let _ = writeln!(out, "{node}, {}, {}", axis + 1, item(v));
        }
    }
    let _ = writeln!(out, "*STEP, NLGEOM\n*DYNAMIC, EXPLICIT\n, {:e}", step.duration);
    if !step.guided.is_empty() {
        *out += "*BOUNDARY\nGUIDED, 1, 1\n";
    }
    for (n, (_, rate)) in step.turning.iter().enumerate() {
        let _ =
            writeln!(out, "*BOUNDARY, TYPE=VELOCITY\n{0}, 1, 2, 0.0\n{0}, 6, 6, {1}", centre(n), item(*rate));
    }
    if !step.load.0.is_empty() {
        *out += "*CLOAD\n";
        for (axis, force) in step.force().into_iter().enumerate().filter(|(_, force)| *force != 0.0) {
            let _ = writeln!(out, "LOADED, {}, {}", axis + 1, item(force));
        }
    }
    let [gx, gy] = step.gravity;
    let g = libm::hypot(gx, gy);
    if g > 0.0 {
        *out += "*DLOAD\n";
        for body in &mesh.bodies {
            let _ = writeln!(out, "{}, GRAV, {g}, {}, {}, 0.0", plain(&body.name), gx / g, gy / g);
        }
    }
    *out += "*END STEP\n";
}

fn node_set(out: &mut String, name: &str, nodes: &[usize]) {
    let _ = writeln!(out, "*NSET, NSET={name}");
    for line in nodes.chunks(A_LINE) {
        let words: Vec<String> = line.iter().map(usize::to_string).collect();
        let _ = writeln!(out, "{}", words.join(", "));
    }
}
