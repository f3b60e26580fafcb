//! Gmsh files, written in format 4.1, ASCII.

use std::fmt::Write;

use crate::Mesh;

use super::{QUADRILATERAL, TRIANGLE};

pub(in crate::decks) fn write(mesh: &Mesh, title: &str) -> String {
    let bodies = mesh.bodies.len();
    let mut out = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    let _ = writeln!(out, "$Comments\n{title}\n$EndComments\n$PhysicalNames\n{bodies}");
    for (n, body) in mesh.bodies.iter().enumerate() {
        let _ = writeln!(out, "2 {} \"{}\"", n + 1, body.name.replace('"', "'"));
    }
    // A surface for each body, with its box and its name.
    let _ = writeln!(out, "$EndPhysicalNames\n$Entities\n0 0 {bodies} 0");
    for (n, body) in mesh.bodies.iter().enumerate() {
        let range = |of: &[f64]| {
            of[body.nodes.clone()]
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
        };
        let ((ax, bx), (ay, by)) = (range(&mesh.x), range(&mesh.y));
        let _ = writeln!(out, "{} {ax:e} {ay:e} 0 {bx:e} {by:e} 0 1 {} 0", n + 1, n + 1);
    }
    let nodes = mesh.x.len();
    let _ = writeln!(out, "$EndEntities\n$Nodes\n{bodies} {nodes} 1 {nodes}");
    for (n, body) in mesh.bodies.iter().enumerate() {
        let _ = writeln!(out, "2 {} 0 {}", n + 1, body.nodes.len());
        for node in body.nodes.clone() {
            let _ = writeln!(out, "{}", node + 1);
        }
        for node in body.nodes.clone() {
            let _ = writeln!(out, "{:e} {:e} 0", mesh.x[node], mesh.y[node]);
        }
    }
    let blocks =
        mesh.bodies.iter().map(|b| usize::from(!b.quads.is_empty()) + usize::from(!b.triangles.is_empty()));
    let (blocks, all) = (blocks.sum::<usize>(), mesh.elements());
    let _ = writeln!(out, "$EndNodes\n$Elements\n{blocks} {all} 1 {all}");
    let mut number = 0;
    for (n, body) in mesh.bodies.iter().enumerate() {
        if !body.quads.is_empty() {
            let _ = writeln!(out, "2 {} {QUADRILATERAL} {}", n + 1, body.quads.len());
            for [a, b, c, d] in &mesh.quads[body.quads.clone()] {
                number += 1;
                let _ = writeln!(out, "{number} {} {} {} {}", a + 1, b + 1, c + 1, d + 1);
            }
        }
        if !body.triangles.is_empty() {
            let _ = writeln!(out, "2 {} {TRIANGLE} {}", n + 1, body.triangles.len());
            for [a, b, c] in &mesh.triangles[body.triangles.clone()] {
                number += 1;
                let _ = writeln!(out, "{number} {} {} {}", a + 1, b + 1, c + 1);
            }
        }
    }
    out += "$EndElements\n";
    out
}
