//! Content of a file, by its own numbers, and the mesh that follows from it.

use std::collections::{BTreeMap, BTreeSet};

use super::{DeckError, ReadDeck, fault};
use crate::{Body, Mesh};

/// Numbers in a file are below this, so that readers may number the instances of a part beyond it.
pub(super) const MOST_NUMBER: u64 = 1 << 40;

/// How far out of the plane nodes may be, as a part of the mesh's size: what sums and turns leave.
const FLAT: f64 = 1e-9;

/// Gathers nodes, elements and sets.
#[derive(Default)]
pub(super) struct Gathered {
    nodes: BTreeMap<u64, [f64; 2]>,
    /// Corners with the line that they stand in, by element number.
    elements: BTreeMap<u64, (Vec<u64>, usize)>,
    /// Nodes of line elements, by element number.
    lines: BTreeMap<u64, Vec<u64>>,
    /// Elements by the name of the part or set, in the order in which names came up.
    sets: Vec<(String, Vec<u64>)>,
    node_sets: BTreeMap<String, Vec<u64>>,
    /// Largest coordinate in the plane.
    widest: f64,
    /// The coordinate farthest out of it, of which node, and its line.
    farthest: (f64, u64, usize),
    /// Ignored parts of the file, with their lines.
    notes: Vec<(String, Vec<usize>)>,
}

impl Gathered {
    pub(super) fn set(&mut self, name: &str) -> &mut Vec<u64> {
        let at = self.sets.iter().position(|(known, _)| known == name).unwrap_or_else(|| {
            self.sets.push((name.to_owned(), Vec::new()));
            self.sets.len() - 1
        });
        &mut self.sets[at].1
    }

    pub(super) fn node_set(&mut self, name: &str) -> &mut Vec<u64> {
        self.node_sets.entry(name.to_owned()).or_default()
    }

    /// Says that something in `line` was passed over. The same words are said once, with the number of
    /// places.
    pub(super) fn note(&mut self, line: usize, what: impl Into<String>) {
        let what = what.into();
        match self.notes.iter_mut().find(|(known, _)| *known == what) {
            Some((_, lines)) => lines.push(line),
            None => self.notes.push((what, vec![line])),
        }
    }

    pub(super) fn node(&mut self, number: u64, [x, y, z]: [f64; 3], line: usize) -> Result<(), DeckError> {
        let shown = number % MOST_NUMBER;
        if !(x.is_finite() && y.is_finite() && z.is_finite()) {
            return Err(fault(line, format!("a coordinate of node {shown} is no finite number")));
        }
        self.widest = self.widest.max(x.abs()).max(y.abs());
        if z.abs() > self.farthest.0.abs() {
            self.farthest = (z, shown, line);
        }
        match self.nodes.insert(number, [x, y]) {
            Some(before) if before != [x, y] => Err(fault(
                line,
                format!("node {shown} is at ({x}, {y}), and was at ({}, {}) before", before[0], before[1]),
            )),
            _ => Ok(()),
        }
    }

    /// Numbers of the nodes between two, both included.
    pub(super) fn nodes_between(&self, from: u64, to: u64) -> Vec<u64> {
        if to < from { Vec::new() } else { self.nodes.range(from..=to).map(|(number, _)| *number).collect() }
    }

    /// The same of elements, plane ones and lines.
    pub(super) fn elements_between(&self, from: u64, to: u64) -> Vec<u64> {
        if to < from {
            return Vec::new();
        }
        let lines = self.lines.range(from..=to).map(|(number, _)| *number);
        self.elements.range(from..=to).map(|(number, _)| *number).chain(lines).collect()
    }

    /// Nodes of an element, plane or line.
    pub(super) fn nodes_of(&self, element: u64) -> &[u64] {
        let plane = self.elements.get(&element).map(|(corners, _)| corners);
        plane.or_else(|| self.lines.get(&element)).map_or(&[], Vec::as_slice)
    }

    /// Nodes of line elements bound surfaces: a set of such elements is one of nodes, too.
    pub(super) fn line_element(&mut self, number: u64, nodes: Vec<u64>) {
        self.lines.insert(number, nodes);
    }

    /// An element of three or four corners.
    pub(super) fn element(
        &mut self,
        number: u64,
        mut corners: Vec<u64>,
        line: usize,
    ) -> Result<(), DeckError> {
        if corners.len() == 4 && corners[2] == corners[3] {
            corners.pop();
        }
        let shown = number % MOST_NUMBER;
        if !(3..=4).contains(&corners.len()) {
            return Err(fault(line, format!("element {shown} has {} nodes; 3 or 4 are read", corners.len())));
        }
        if let Some((before, there)) = self.elements.get(&number)
            && *before != corners
        {
            return Err(fault(line, format!("element {shown} has other nodes here than in line {there}")));
        }
        self.elements.insert(number, (corners, line));
        Ok(())
    }

    /// The mesh, body by body: each element belongs to the first set that names it. `last` is the last line.
    pub(super) fn finish(mut self, last: usize) -> Result<ReadDeck, DeckError> {
        let (z, node, line) = self.farthest;
        if z.abs() > FLAT * self.widest {
            return Err(fault(line, format!("node {node} has z = {z}; a plane mesh lies in z = 0")));
        }
        if self.elements.is_empty() {
            return Err(fault(last.max(1), "the file holds no plane element of three or four nodes"));
        }
        self.nodes_along_lines();
        let notes = self.notes.iter().map(|(what, lines)| match &lines[..] {
            [first, others @ ..] if !others.is_empty() => {
                format!("line {first} and {} more: {what}", others.len())
            }
            _ => format!("line {}: {what}", lines[0]),
        });
        let notes = notes.collect();
        let Self { nodes, elements, mut sets, node_sets, .. } = self;
        let mut mesh = Mesh::new();
        let mut place: BTreeMap<u64, u32> = BTreeMap::new();
        let mut left = elements;
        sets.push(("rest".to_owned(), left.keys().copied().collect()));
        for (name, numbers) in sets {
            let own: Vec<(Vec<u64>, usize)> =
                numbers.iter().filter_map(|number| left.remove(number)).collect();
            if !own.is_empty() {
                add_body(&mut mesh, name, own, &nodes, &mut place)?;
            }
        }
        let in_mesh = |numbers: Vec<u64>| {
            let mut seen = BTreeSet::new();
            numbers.iter().filter_map(|n| place.get(n).copied()).filter(|n| seen.insert(*n)).collect()
        };
        let node_sets = node_sets.into_iter().map(|(name, numbers)| (name, in_mesh(numbers))).collect();
        Ok(ReadDeck { mesh, node_sets, notes })
    }

    /// Sets of line elements as sets of nodes, where none has their name.
    fn nodes_along_lines(&mut self) {
        let known: BTreeSet<String> = self.node_sets.keys().cloned().collect();
        for (name, numbers) in &self.sets {
            let nodes: Vec<u64> =
                numbers.iter().filter_map(|number| self.lines.get(number)).flatten().copied().collect();
            if !nodes.is_empty() && !known.contains(name) {
                self.node_sets.entry(name.clone()).or_default().extend(nodes);
            }
        }
    }
}

/// Adds a body of these elements, and the nodes that it is the first to use.
fn add_body(
    mesh: &mut Mesh,
    name: String,
    elements: Vec<(Vec<u64>, usize)>,
    nodes: &BTreeMap<u64, [f64; 2]>,
    place: &mut BTreeMap<u64, u32>,
) -> Result<(), DeckError> {
    let starts = (mesh.x.len(), mesh.quads.len(), mesh.triangles.len());
    for (corners, line) in elements {
        let mut at = Vec::with_capacity(4);
        for corner in corners {
            let known = place.get(&corner).copied();
            at.push(match (known, nodes.get(&corner)) {
                (Some(known), _) => known,
                (None, Some([x, y])) => {
                    let new = mesh.x.len() as u32;
                    mesh.x.push(*x);
                    mesh.y.push(*y);
                    place.insert(corner, new);
                    new
                }
                (None, None) => {
                    return Err(fault(line, format!("there is no node {}", corner % MOST_NUMBER)));
                }
            });
        }
        counter_clockwise(mesh, &mut at);
        match at[..] {
            [a, b, c] => mesh.triangles.push([a, b, c]),
            [a, b, c, d] => mesh.quads.push([a, b, c, d]),
            _ => {}
        }
    }
    mesh.bodies.push(Body {
        name,
        nodes: starts.0..mesh.x.len(),
        quads: starts.1..mesh.quads.len(),
        triangles: starts.2..mesh.triangles.len(),
    });
    Ok(())
}

/// Turns corners that run clockwise.
fn counter_clockwise(mesh: &Mesh, corners: &mut [u32]) {
    let at = |n: u32| [mesh.x[n as usize], mesh.y[n as usize]];
    let area: f64 = (0..corners.len())
        .map(|i| (at(corners[i]), at(corners[(i + 1) % corners.len()])))
        .map(|([ax, ay], [bx, by])| ax * by - bx * ay)
        .sum();
    if area < 0.0 {
        corners.reverse();
    }
}
