//! Gmsh files, format 4.1, ASCII.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::{DeckError, Gathered, ReadDeck, fault, real, whole};
use crate::Mesh;

/// Types of elements: three nodes, four nodes.
const TRIANGLE: u64 = 2;
const QUADRILATERAL: u64 = 3;

pub(super) fn write(mesh: &Mesh, title: &str) -> String {
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

/// Lines with their numbers.
struct Lines<'a> {
    all: std::iter::Enumerate<std::str::Lines<'a>>,
    last: usize,
}

impl<'a> Lines<'a> {
    /// The next line that is not empty.
    fn next(&mut self) -> Result<(usize, &'a str), DeckError> {
        loop {
            let Some((at, line)) = self.all.next() else {
                return Err(fault(self.last.max(1), "the file ends in the middle of a section"));
            };
            self.last = at + 1;
            if !line.trim().is_empty() {
                return Ok((at + 1, line.trim()));
            }
        }
    }

    /// Whole numbers of the next line, at least `least` of them.
    fn numbers(&mut self, least: usize) -> Result<(usize, Vec<u64>), DeckError> {
        let (line, text) = self.next()?;
        let numbers: Result<Vec<u64>, DeckError> =
            text.split_whitespace().map(|cell| whole(cell, line)).collect();
        let numbers = numbers?;
        if numbers.len() < least {
            return Err(fault(line, format!("{} numbers stand where {least} belong", numbers.len())));
        }
        Ok((line, numbers))
    }
}

pub(super) fn read(text: &str) -> Result<ReadDeck, DeckError> {
    let mut found = Gathered::default();
    let mut lines = Lines { all: text.lines().enumerate(), last: 0 };
    let mut names: BTreeMap<(u64, u64), String> = BTreeMap::new();
    // Names of curves and surfaces, by dimension and tag.
    let mut named: BTreeMap<(u64, u64), String> = BTreeMap::new();
    while let Ok((line, head)) = lines.next() {
        let Some(section) = head.strip_prefix('$') else {
            return Err(fault(line, format!("`{head}` stands outside of a section; is this a Gmsh file?")));
        };
        match section {
            "MeshFormat" => {
                let (line, text) = lines.next()?;
                let mut cells = text.split_whitespace();
                let (version, kind) = (cells.next().unwrap_or_default(), cells.next().unwrap_or_default());
                if version != "4.1" || kind != "0" {
                    return Err(fault(
                        line,
                        format!(
                            "format {version}{} is not read: save it as version 4.1, ASCII (`gmsh in.msh -save -format msh41`)",
                            if kind == "1" { ", binary," } else { "" }
                        ),
                    ));
                }
            }
            "PhysicalNames" => {
                let (_, count) = lines.numbers(1)?;
                for _ in 0..count[0] {
                    let (line, text) = lines.next()?;
                    let mut cells = text.splitn(3, ' ');
                    let mut number = || whole(cells.next().unwrap_or_default(), line);
                    let key = (number()?, number()?);
                    names.insert(key, cells.next().unwrap_or_default().trim_matches('"').to_owned());
                }
            }
            "Entities" => entities(&mut lines, &names, &mut named)?,
            "Nodes" => nodes(&mut lines, &mut found)?,
            "Elements" => elements(&mut lines, &mut found, &named)?,
            "Comments" => {}
            other => found.notes.push(format!("line {line}: section `${other}` is not read")),
        }
        // To its end, whatever follows.
        loop {
            let (_, text) = lines.next()?;
            if text.strip_prefix("$End") == Some(section) {
                break;
            }
        }
    }
    let last = lines.last;
    found.finish(last)
}

fn entities(
    lines: &mut Lines<'_>,
    names: &BTreeMap<(u64, u64), String>,
    named: &mut BTreeMap<(u64, u64), String>,
) -> Result<(), DeckError> {
    let (_, counts) = lines.numbers(4)?;
    for _ in 0..counts[0] {
        lines.next()?;
    }
    for dimension in [1, 2] {
        for _ in 0..counts[dimension as usize] {
            let (line, text) = lines.next()?;
            let cells: Vec<&str> = text.split_whitespace().collect();
            let tag = whole(cells.first().copied().unwrap_or_default(), line)?;
            let physical = whole(cells.get(7).copied().unwrap_or("0"), line)?;
            if physical > 0 {
                let number = whole(cells.get(8).copied().unwrap_or_default(), line)?;
                let name = names.get(&(dimension, number)).cloned();
                named.insert((dimension, tag), name.unwrap_or_else(|| format!("physical {number}")));
            }
        }
    }
    Ok(())
}

fn nodes(lines: &mut Lines<'_>, found: &mut Gathered) -> Result<(), DeckError> {
    let (_, counts) = lines.numbers(4)?;
    for _ in 0..counts[0] {
        let (_, block) = lines.numbers(4)?;
        let mut tags = Vec::new();
        for _ in 0..block[3] {
            tags.push(lines.numbers(1)?.1[0]);
        }
        for tag in tags {
            let (line, text) = lines.next()?;
            let cells: Vec<&str> = text.split_whitespace().collect();
            let number = |n: usize| real(cells.get(n).copied().unwrap_or_default(), line);
            found.node(tag, [number(0)?, number(1)?, number(2)?], line)?;
        }
    }
    Ok(())
}

fn elements(
    lines: &mut Lines<'_>,
    found: &mut Gathered,
    named: &BTreeMap<(u64, u64), String>,
) -> Result<(), DeckError> {
    let (_, counts) = lines.numbers(4)?;
    for _ in 0..counts[0] {
        let (line, block) = lines.numbers(4)?;
        let [dimension, tag, kind, count] = block[..4] else {
            return Err(fault(line, "four numbers belong here"));
        };
        let plane = kind == TRIANGLE || kind == QUADRILATERAL;
        if dimension == 2 && !plane {
            return Err(fault(
                line,
                format!("elements of type {kind} are not read; triangles (2) and quadrilaterals (3) are"),
            ));
        }
        for _ in 0..count {
            let (line, numbers) = lines.numbers(2)?;
            let name = named.get(&(dimension, tag));
            if plane {
                found.element(numbers[0], numbers[1..].to_vec(), line)?;
                let name = name.cloned().unwrap_or_else(|| format!("surface {tag}"));
                found.set(&name).push(numbers[0]);
            } else if let (1, Some(name)) = (dimension, name) {
                // Lines bound the surfaces; those of a named curve make a set of nodes.
                found.node_sets.entry(name.clone()).or_default().extend(&numbers[1..]);
            }
        }
    }
    Ok(())
}
