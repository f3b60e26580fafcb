//! What makes a mesh a model: material, sections, surfaces and contacts, and a step with its loads and
//! motions.

use std::collections::{BTreeMap, HashMap};

use crate::Mesh;

/// A side of a body: its outer boundary, or those of its holes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// The boundary around it.
    Outside,
    /// The boundaries of all holes in it.
    Inside,
}

/// Two surfaces that may touch.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactPair {
    /// Body and side of each.
    pub surfaces: [(usize, Side); 2],
    /// Coefficient of friction [-].
    pub friction: f64,
}

/// A step of explicit dynamics: what is done to the bodies, and how they move when it begins.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Step {
    /// How long it is [s].
    pub duration: f64,
    /// Acceleration of gravity [m/s²].
    pub gravity: [f64; 2],
    /// Nodes that share a load alike, and the whole of it [N].
    pub load: (Vec<u32>, [f64; 2]),
    /// Nodes that do not move along x.
    pub guided: Vec<u32>,
    /// Nodes that turn about the origin, and how fast [rad/s], counter-clockwise.
    pub turning: Vec<(Vec<u32>, f64)>,
    /// Velocity of each node at the start [m/s].
    pub velocity: Vec<[f64; 2]>,
    /// Remarks for which the formats have no field: comments of the file.
    pub left_out: Vec<String>,
}

impl Step {
    /// What each of the nodes under load takes [N].
    pub(super) fn force(&self) -> [f64; 2] {
        let (nodes, [x, y]) = &self.load;
        let share = 1.0 / nodes.len().max(1) as f64;
        [share * x, share * y]
    }

    /// Nodes that move at the start, with their numbers in a file, from 1, and velocities.
    pub(super) fn moving(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        let all = self.velocity.iter().enumerate().map(|(n, v)| (n + 1, *v));
        all.filter(|(_, v)| *v != [0.0; 2])
    }
}

/// Numbers of nodes in a file, from 1.
pub(super) fn numbers(nodes: &[u32]) -> Vec<usize> {
    nodes.iter().map(|n| *n as usize + 1).collect()
}

/// A mesh with the material, contacts and loads that another program needs to compute it. All bodies are of
/// one material, in plane strain.
#[derive(Debug, Clone, PartialEq)]
pub struct Model<'a> {
    /// Nodes, elements and bodies.
    pub mesh: &'a Mesh,
    /// Young's modulus [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio [-].
    pub poissons_ratio: f64,
    /// Density [kg/m³].
    pub density: f64,
    /// Thickness across the plane [m].
    pub thickness: f64,
    /// Bodies that do not deform.
    pub rigid: Vec<usize>,
    /// What may touch.
    pub contacts: Vec<ContactPair>,
    /// What happens; none leaves the file without a step.
    pub step: Option<Step>,
}

/// An edge of an element on a boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Face {
    /// Number of the element in a file, from 1.
    pub(super) element: usize,
    /// Which of its edges, from 1: that from its first to its second corner.
    pub(super) edge: usize,
    /// Its nodes, the body to the left.
    nodes: [u32; 2],
}

/// A side of a body.
pub(super) struct Surface {
    pub(super) body: usize,
    pub(super) side: Side,
    /// Along the boundary.
    pub(super) faces: Vec<Face>,
}

impl Surface {
    /// Its nodes along the boundary, in numbers of a file, from 1.
    pub(super) fn nodes(&self) -> Vec<usize> {
        self.faces.iter().map(|face| face.nodes[0] as usize + 1).collect()
    }
}

impl Side {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Outside => "OUTSIDE",
            Self::Inside => "INSIDE",
        }
    }
}

/// The sides of all bodies. Elements are numbered body by body, quadrilaterals first, as files have them.
pub(super) fn surfaces(mesh: &Mesh) -> Vec<Surface> {
    let mut number = 0;
    let mut all = Vec::new();
    for (body, held) in mesh.bodies.iter().enumerate() {
        let quads = mesh.quads[held.quads.clone()].iter().map(|q| &q[..]);
        let mut edges: HashMap<[u32; 2], Face> = HashMap::new();
        for corners in quads.chain(mesh.triangles[held.triangles.clone()].iter().map(|t| &t[..])) {
            number += 1;
            for (at, &a) in corners.iter().enumerate() {
                let b = corners[(at + 1) % corners.len()];
                // An edge between two elements is gone through both ways.
                if edges.remove(&[b, a]).is_none() {
                    edges.insert([a, b], Face { element: number, edge: at + 1, nodes: [a, b] });
                }
            }
        }
        let mut from: BTreeMap<u32, Vec<Face>> = BTreeMap::new();
        edges.into_values().for_each(|face| from.entry(face.nodes[0]).or_default().push(face));
        from.values_mut().for_each(|faces| faces.sort_by_key(|face| face.element));
        let mut sides: BTreeMap<Side, Vec<Face>> = BTreeMap::new();
        while let Some((&first, _)) = from.first_key_value() {
            let (mut boundary, mut at) = (Vec::new(), first);
            while let Some(faces) = from.get_mut(&at) {
                let next = faces.pop();
                if faces.is_empty() {
                    from.remove(&at);
                }
                let Some(face) = next else { break };
                at = face.nodes[1];
                boundary.push(face);
            }
            let place = |n: u32| [mesh.x[n as usize], mesh.y[n as usize]];
            let twice_area: f64 = boundary
                .iter()
                .map(|face| face.nodes.map(place))
                .map(|[[ax, ay], [bx, by]]| ax * by - bx * ay)
                .sum();
            let side = if twice_area > 0.0 { Side::Outside } else { Side::Inside };
            sides.entry(side).or_default().extend(boundary);
        }
        all.extend(sides.into_iter().map(|(side, faces)| Surface { body, side, faces }));
    }
    all
}
