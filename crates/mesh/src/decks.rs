//! Meshes in the formats of other programs: LS-DYNA keyword files, Abaqus input files and Gmsh files.
//!
//! Written are nodes [m], elements, and for each body a part or element set of its name and a set of its nodes. The reader
//! takes the same from any such file: plane quadrilaterals and triangles of first order, with their sets. Cards that are not
//! mesh (materials, steps, loads) are named with their lines, so that nothing is ignored unsaid.
//!
//! | format | nodes | elements | sets |
//! |---|---|---|---|
//! | LS-DYNA `.k` | `*NODE` | `*ELEMENT_SHELL`, triangles with the last node twice | `*PART`, `*SET_NODE_LIST_TITLE` |
//! | Abaqus `.inp` | `*NODE` | `*ELEMENT` of CPE4, CPE4R, CPS4, S4 …, CPE3 … | `ELSET=`, `*NSET` |
//! | Gmsh `.msh` 4.1, ASCII | `$Nodes` | `$Elements` of types 2 and 3 | `$PhysicalNames` of surfaces, and of curves for sets of nodes |
//!
//! [`Deck::write_model`] adds what makes the mesh a model ([`Model`]): `*MAT_ELASTIC`, `*SECTION_SHELL` and
//! `*CONTACT_2D_AUTOMATIC_SURFACE_TO_SURFACE`, or `*MATERIAL`, `*SOLID SECTION`, `*SURFACE` and `*CONTACT PAIR`; and a step of explicit
//! dynamics ([`Step`]): gravity, loads on nodes, guided and turning nodes, and the velocities of all at the start.
//!
//! Sources: *LS-DYNA Keyword User's Manual*, volume I; *Abaqus Analysis User's Guide*, input syntax; *Gmsh Reference Manual*,
//! MSH file format 4.1.

mod abaqus;
mod gmsh;
mod lsdyna;
mod model;

use std::collections::BTreeMap;
use std::fmt;

pub use self::model::{ContactPair, Model, Side, Step};
use crate::smoothing::sound;
use crate::{Body, Error, Mesh, Part};

/// A format that meshes are exchanged in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deck {
    /// LS-DYNA keyword file, `.k`.
    LsDyna,
    /// Abaqus input file, `.inp`.
    Abaqus,
    /// Gmsh 4.1, ASCII, `.msh`.
    Gmsh,
}

impl Deck {
    /// The format that files with this extension have.
    pub fn of_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "k" | "key" | "dyn" => Some(Self::LsDyna),
            "inp" => Some(Self::Abaqus),
            "msh" => Some(Self::Gmsh),
            _ => None,
        }
    }

    /// The mesh as a file of this format; `title` is its first comment.
    pub fn write(self, mesh: &Mesh, title: &str) -> String {
        let title = title.replace(['\n', '\r'], " ");
        match self {
            Self::LsDyna => lsdyna::write(mesh, &title),
            Self::Abaqus => abaqus::write(mesh, &title),
            Self::Gmsh => gmsh::write(mesh, &title),
        }
    }

    /// The mesh with material, sections, the surfaces of all bodies, their contacts and a step, if there is one; Gmsh's files have no place
    /// for more than the mesh. Not in contact are surfaces that no [`ContactPair`] names.
    pub fn write_model(self, model: &Model<'_>, title: &str) -> String {
        let title = title.replace(['\n', '\r'], " ");
        match self {
            Self::LsDyna => lsdyna::write_model(model, &title),
            Self::Abaqus => abaqus::write_model(model, &title),
            Self::Gmsh => gmsh::write(model.mesh, &title),
        }
    }

    /// Reads a file of this format.
    ///
    /// # Errors
    /// [`DeckError`] with the line, for what contradicts the format, elements of other kinds, and nodes that are not there.
    pub fn read(self, text: &str) -> Result<ReadDeck, DeckError> {
        match self {
            Self::LsDyna => lsdyna::read(text),
            Self::Abaqus => abaqus::read(text),
            Self::Gmsh => gmsh::read(text),
        }
    }
}

/// What a file held.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadDeck {
    /// Bodies are the parts or element sets; elements in none are in a body `rest`. Nodes that no element uses are left out.
    pub mesh: Mesh,
    /// Node sets by name, in numbers of the mesh.
    pub node_sets: BTreeMap<String, Vec<u32>>,
    /// Cards that were not understood, with their lines.
    pub notes: Vec<String>,
}

impl ReadDeck {
    /// All bodies as one part, without surfaces.
    ///
    /// # Errors
    /// When an element is inside out or has no area.
    pub fn part(&self) -> Result<Part, Error> {
        let Mesh { x, y, quads, triangles, .. } = self.mesh.clone();
        sound("mesh from a file", Part { x, y, quads, triangles, ..Part::default() })
    }
}

/// Why a file is no mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeckError {
    /// Line, from 1.
    pub line: usize,
    /// What is wrong, and what to try.
    pub what: String,
}

impl fmt::Display for DeckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.what)
    }
}

impl std::error::Error for DeckError {}

fn fault(line: usize, what: impl Into<String>) -> DeckError {
    DeckError { line, what: what.into() }
}

/// Gathers what a reader finds, by the numbers of the file.
#[derive(Default)]
struct Gathered {
    nodes: BTreeMap<u64, [f64; 2]>,
    /// Corners with the line that they stand in, by element number.
    elements: BTreeMap<u64, (Vec<u64>, usize)>,
    /// Elements by the name of the part or set, in the order in which names came up.
    sets: Vec<(String, Vec<u64>)>,
    node_sets: BTreeMap<String, Vec<u64>>,
    notes: Vec<String>,
}

impl Gathered {
    /// The set of that name.
    fn set(&mut self, name: &str) -> &mut Vec<u64> {
        let at = self.sets.iter().position(|(known, _)| known == name).unwrap_or_else(|| {
            self.sets.push((name.to_owned(), Vec::new()));
            self.sets.len() - 1
        });
        &mut self.sets[at].1
    }

    /// A node in the plane.
    fn node(&mut self, number: u64, [x, y, z]: [f64; 3], line: usize) -> Result<(), DeckError> {
        if !(x.is_finite() && y.is_finite()) {
            return Err(fault(line, "a coordinate is no finite number"));
        }
        if z.abs() > 1e-9 * (x.abs() + y.abs()) {
            return Err(fault(line, format!("node {number} has z = {z}; a plane mesh lies in z = 0")));
        }
        self.nodes.insert(number, [x, y]);
        Ok(())
    }

    /// An element of three or four corners.
    fn element(&mut self, number: u64, mut corners: Vec<u64>, line: usize) -> Result<(), DeckError> {
        if corners.len() == 4 && corners[2] == corners[3] {
            corners.pop();
        }
        if !(3..=4).contains(&corners.len()) {
            return Err(fault(
                line,
                format!("element {number} has {} nodes; 3 or 4 are read", corners.len()),
            ));
        }
        self.elements.insert(number, (corners, line));
        Ok(())
    }

    /// The mesh, body by body: each element belongs to the first set that names it.
    fn finish(self, lines: usize) -> Result<ReadDeck, DeckError> {
        let Self { nodes, elements, mut sets, node_sets, notes } = self;
        if elements.is_empty() {
            return Err(fault(lines.max(1), "the file holds no plane element of three or four nodes"));
        }
        let mut mesh = Mesh::new();
        let mut place: BTreeMap<u64, u32> = BTreeMap::new();
        let mut left = elements;
        sets.push(("rest".to_owned(), left.keys().copied().collect()));
        for (name, numbers) in sets {
            let own: Vec<(Vec<u64>, usize)> =
                numbers.iter().filter_map(|number| left.remove(number)).collect();
            if own.is_empty() {
                continue;
            }
            let starts = (mesh.x.len(), mesh.quads.len(), mesh.triangles.len());
            for (corners, line) in own {
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
                        (None, None) => return Err(fault(line, format!("there is no node {corner}"))),
                    });
                }
                counter_clockwise(&mesh, &mut at);
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
        }
        let in_mesh = |numbers: Vec<u64>| numbers.iter().filter_map(|n| place.get(n).copied()).collect();
        let node_sets = node_sets.into_iter().map(|(name, numbers)| (name, in_mesh(numbers))).collect();
        Ok(ReadDeck { mesh, node_sets, notes })
    }
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

/// Letters and digits of a name, in capitals, others as `_`: what every program takes.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' }).collect()
}

/// A whole number in a file.
fn whole(text: &str, line: usize) -> Result<u64, DeckError> {
    text.trim().parse().map_err(|_| fault(line, format!("`{}` is no whole number", text.trim())))
}

/// A number in a file; Fortran's exponents are understood.
fn real(text: &str, line: usize) -> Result<f64, DeckError> {
    let text = text.trim();
    if text.is_empty() {
        return Ok(0.0);
    }
    text.replace(['d', 'D'], "e").parse().map_err(|_| fault(line, format!("`{text}` is no number")))
}
