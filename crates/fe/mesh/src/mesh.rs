//! Several bodies in one pair of coordinate arrays.

use std::ops::Range;

use crate::part::named;
use crate::{Part, Surface};

/// Nodes and elements of all bodies, numbered body by body.
///
/// Elements are counter-clockwise. Output that lists all elements (see [`crate::vtu`]) puts the
/// quadrilaterals first and the triangles after them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Abscissae of the nodes [m].
    pub x: Vec<f64>,
    /// Ordinates of the nodes [m].
    pub y: Vec<f64>,
    /// Corners of the quadrilaterals, counter-clockwise.
    pub quads: Vec<[u32; 4]>,
    /// Corners of the triangles, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// The bodies, in the order in which they were added.
    pub bodies: Vec<Body>,
}

/// Where one body lies in the arrays of its [`Mesh`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Body {
    /// Name given by the caller.
    pub name: String,
    /// Its nodes.
    pub nodes: Range<usize>,
    /// Its quadrilaterals.
    pub quads: Range<usize>,
    /// Its triangles.
    pub triangles: Range<usize>,
}

/// A body added by [`Mesh::add`]; node numbers are those of the mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Placed {
    /// Index of the body in [`Mesh::bodies`].
    pub body: usize,
    /// Named surfaces of the part.
    pub surfaces: Vec<(String, Surface)>,
    /// Named nodes of the part.
    pub marks: Vec<(String, u32)>,
}

impl Placed {
    /// The surface of that name, if the part had one.
    pub fn surface(&self, name: &str) -> Option<&Surface> {
        named(&self.surfaces, name)
    }

    /// The node that carries that name, if the part had one.
    pub fn mark(&self, name: &str) -> Option<u32> {
        named(&self.marks, name).copied()
    }
}

impl Mesh {
    /// A mesh without bodies.
    pub fn new() -> Mesh {
        Mesh::default()
    }

    /// Adds a body where it stands and says which node numbers it got.
    pub fn add(&mut self, name: impl Into<String>, part: &Part) -> Placed {
        let (nodes, quads, triangles) = (self.x.len(), self.quads.len(), self.triangles.len());
        let shift = nodes as u32;
        self.x.extend_from_slice(&part.x);
        self.y.extend_from_slice(&part.y);
        self.quads.extend(part.quads.iter().map(|q| q.map(|n| n + shift)));
        self.triangles.extend(part.triangles.iter().map(|t| t.map(|n| n + shift)));
        self.bodies.push(Body {
            name: name.into(),
            nodes: nodes..self.x.len(),
            quads: quads..self.quads.len(),
            triangles: triangles..self.triangles.len(),
        });
        Placed {
            body: self.bodies.len() - 1,
            surfaces: part.surfaces.iter().map(|(n, s)| (n.clone(), s.renumbered(shift))).collect(),
            marks: part.marks.iter().map(|(n, node)| (n.clone(), node + shift)).collect(),
        }
    }

    /// Number of elements of both kinds.
    pub fn elements(&self) -> usize {
        self.quads.len() + self.triangles.len()
    }

    /// Corner positions of one element [m].
    pub(crate) fn corners<const N: usize>(&self, element: &[u32; N]) -> [[f64; 2]; N] {
        element.map(|n| [self.x[n as usize], self.y[n as usize]])
    }
}
