//! LS-DYNA keyword files, written.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::Mesh;
use crate::decks::model::{Model, Side, Step, numbers, surfaces};

/// Node numbers in a line of a node set.
const A_LINE: usize = 8;

pub(in crate::decks) fn write(mesh: &Mesh, title: &str) -> String {
    let mut out = head(title);
    mesh_cards(&mut out, mesh, |_| String::new());
    out + "*END\n"
}

/// Elastic bodies have material 1, rigid ones 2.
pub(in crate::decks) fn write_model(model: &Model<'_>, title: &str) -> String {
    let Model { mesh, youngs_modulus, poissons_ratio, density, thickness, rigid, contacts, step } = model;
    let mut out = head(title);
    let _ = writeln!(out, "*MAT_ELASTIC\n1,{density:e},{youngs_modulus:e},{poissons_ratio}");
    // Free in all directions, seen in the axes of the model.
    let _ = writeln!(
        out,
        "*MAT_RIGID\n2,{density:e},{youngs_modulus:e},{poissons_ratio}\n0.0,0,0\n0.0,0.0,0.0,0.0,0.0,0.0"
    );
    // Element form 13: plane strain in the plane of x and y.
    let _ = writeln!(out, "*SECTION_SHELL\n1,13\n{0},{0},{0},{0}", thickness);
    mesh_cards(&mut out, mesh, |body| format!(",1,{}", 1 + usize::from(rigid.contains(&body))));
    let surfaces = surfaces(mesh);
    let mut sets: BTreeMap<(usize, Side), usize> = BTreeMap::new();
    for (n, surface) in surfaces.iter().enumerate() {
        let set = mesh.bodies.len() + n + 1;
        sets.insert((surface.body, surface.side), set);
        let name = format!("{} {}", mesh.bodies[surface.body].name, surface.side.name().to_lowercase());
        node_set(&mut out, &name, set, surface.nodes());
    }
    for pair in contacts {
        // Negative numbers are sets of nodes.
        if let [Some(one), Some(other)] = pair.surfaces.map(|surface| sets.get(&surface)) {
            let _ = writeln!(
                out,
                "*CONTACT_2D_AUTOMATIC_SURFACE_TO_SURFACE\n-{one},-{other},1.0,50,{0},{0},0.0,6\n0.0,1e20,1.0,1.0,0,0,0,0",
                pair.friction
            );
        }
    }
    if let Some(step) = step {
        step_cards(&mut out, step, mesh.bodies.len() + surfaces.len() + 1);
    }
    out + "*END\n"
}

/// Sets, whose numbers are free from `free` on, loads, motions and velocities at the start.
fn step_cards(out: &mut String, step: &Step, free: usize) {
    for what in &step.left_out {
        let _ = writeln!(out, "$ left out: {what}");
    }
    let _ = writeln!(out, "*CONTROL_TERMINATION\n{:e}", step.duration);
    // Curve 1 is one all the time: everything begins at once and stays.
    let _ = writeln!(out, "*DEFINE_CURVE\n1\n0.0,1.0\n{:e},1.0", 2.0 * step.duration);
    if !step.load.0.is_empty() {
        node_set(out, "loaded", free, numbers(&step.load.0));
        for (axis, force) in step.force().into_iter().enumerate().filter(|(_, force)| *force != 0.0) {
            let _ = writeln!(out, "*LOAD_NODE_SET\n{free},{},1,{force:e}", axis + 1);
        }
    }
    // A base that accelerates upwards is a weight downwards.
    for (axis, g) in ["X", "Y"].into_iter().zip(step.gravity).filter(|(_, g)| *g != 0.0) {
        let _ = writeln!(out, "*LOAD_BODY_{axis}\n1,{:e}", -g);
    }
    if !step.guided.is_empty() {
        node_set(out, "guided", free + 1, numbers(&step.guided));
        let _ = writeln!(out, "*BOUNDARY_SPC_SET\n{},0,1,0,0,0,0,0", free + 1);
    }
    for (n, (nodes, rate)) in step.turning.iter().enumerate() {
        let set = free + 2 + n;
        node_set(out, &format!("turning {}", n + 1), set, numbers(nodes));
        // Degree of freedom 11: nodes that turn about an axis along z, through the offsets of the second
        // line.
        let _ = writeln!(out, "*BOUNDARY_PRESCRIBED_MOTION_SET\n{set},11,0,1,{rate:e}\n0.0,0.0");
    }
    *out += "*INITIAL_VELOCITY_NODE\n";
    for (node, [vx, vy]) in step.moving() {
        let _ = writeln!(out, "{node},{vx:e},{vy:e},0.0");
    }
}

fn head(title: &str) -> String {
    // Long lines would be cut at 80 characters.
    let title: String = title.chars().take(79).collect();
    format!("*KEYWORD\n*TITLE\n{title}\n")
}

/// Nodes, parts, elements, and the nodes of each body as a set; `of_part` follows the number of a part.
fn mesh_cards(out: &mut String, mesh: &Mesh, of_part: impl Fn(usize) -> String) {
    *out += "*NODE\n";
    for (n, (x, y)) in mesh.x.iter().zip(&mesh.y).enumerate() {
        // Free format: fixed columns would leave ten digits.
        let _ = writeln!(out, "{},{x:e},{y:e},0.0", n + 1);
    }
    for (n, body) in mesh.bodies.iter().enumerate() {
        let name: String = body.name.chars().take(70).collect();
        let _ = writeln!(out, "*PART\n{name}\n{}{}", n + 1, of_part(n));
    }
    *out += "*ELEMENT_SHELL\n";
    let mut number = 0;
    for (n, body) in mesh.bodies.iter().enumerate() {
        let quads = mesh.quads[body.quads.clone()].iter().copied();
        let triangles = mesh.triangles[body.triangles.clone()].iter().map(|[a, b, c]| [*a, *b, *c, *c]);
        for [a, b, c, d] in quads.chain(triangles) {
            number += 1;
            let _ = writeln!(out, "{number},{},{},{},{},{}", n + 1, a + 1, b + 1, c + 1, d + 1);
        }
    }
    for (n, body) in mesh.bodies.iter().enumerate().filter(|(_, body)| !body.nodes.is_empty()) {
        node_set(out, &body.name, n + 1, body.nodes.clone().map(|n| n + 1).collect());
    }
}

fn node_set(out: &mut String, name: &str, number: usize, nodes: Vec<usize>) {
    let _ = writeln!(out, "*SET_NODE_LIST_TITLE\n{name}\n{number}");
    for line in nodes.chunks(A_LINE) {
        let words: Vec<String> = line.iter().map(usize::to_string).collect();
        let _ = writeln!(out, "{}", words.join(","));
    }
}
