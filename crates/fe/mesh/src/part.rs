//! One body before it is placed, and its oriented boundary.

use serde::{Deserialize, Serialize};

/// An oriented piece of boundary: a polyline through nodes.
///
/// Walking along it, the solid lies on the left and the outward normal points to the right.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Surface {
    /// Nodes in walking order; the first node of a closed surface is not repeated at the end.
    pub nodes: Vec<u32>,
    /// Whether a facet joins the last node to the first.
    pub closed: bool,
}

impl Surface {
    /// Number of facets (straight pieces between neighbouring nodes).
    pub fn facets(&self) -> usize {
        if self.closed { self.nodes.len() } else { self.nodes.len().saturating_sub(1) }
    }

    /// First and last node of a facet, in walking order.
    ///
    /// # Panics
    /// If `facet` is not below [`Surface::facets`].
    pub fn facet(&self, facet: usize) -> [u32; 2] {
        let last = if facet + 1 == self.nodes.len() && self.closed { 0 } else { facet + 1 };
        [self.nodes[facet], self.nodes[last]]
    }

    /// The same surface with every node number raised by `by`.
    pub(crate) fn renumbered(&self, by: u32) -> Surface {
        Surface { nodes: self.nodes.iter().map(|n| n + by).collect(), closed: self.closed }
    }
}

/// One body before it is placed in a [`Mesh`](crate::Mesh), with node numbers that start at zero.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Abscissae of the nodes [m].
    pub x: Vec<f64>,
    /// Ordinates of the nodes [m].
    pub y: Vec<f64>,
    /// Corners of the quadrilaterals, counter-clockwise.
    pub quads: Vec<[u32; 4]>,
    /// Corners of the triangles, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// Named boundary surfaces; each generator documents its names.
    pub surfaces: Vec<(String, Surface)>,
    /// Named single nodes, such as the `centre` of a disc.
    pub marks: Vec<(String, u32)>,
}

impl Part {
    /// The surface of that name, if the part has one.
    pub fn surface(&self, name: &str) -> Option<&Surface> {
        named(&self.surfaces, name)
    }

    /// The node that carries that name, if the part has one.
    pub fn mark(&self, name: &str) -> Option<u32> {
        named(&self.marks, name).copied()
    }

    /// The same part moved by (`dx`, `dy`) [m].
    pub fn translated(&self, dx: f64, dy: f64) -> Part {
        let mut part = self.clone();
        part.x.iter_mut().for_each(|x| *x += dx);
        part.y.iter_mut().for_each(|y| *y += dy);
        part
    }

    /// The same part turned about the origin by `angle` [rad], counter-clockwise.
    pub fn rotated(&self, angle: f64) -> Part {
        let (sin, cos) = libm::sincos(angle);
        let mut part = self.clone();
        for (x, y) in part.x.iter_mut().zip(&mut part.y) {
            (*x, *y) = (cos * *x - sin * *y, sin * *x + cos * *y);
        }
        part
    }

    /// Area enclosed by the elements [m²].
    pub fn area(&self) -> f64 {
        let quads: f64 = self.quads.iter().map(|q| signed_area(&self.corners(q))).sum();
        let triangles: f64 = self.triangles.iter().map(|t| signed_area(&self.corners(t))).sum();
        quads + triangles
    }

    /// Corner positions of one element [m].
    pub(crate) fn corners<const N: usize>(&self, element: &[u32; N]) -> [[f64; 2]; N] {
        element.map(|n| [self.x[n as usize], self.y[n as usize]])
    }

    pub(crate) fn push_node(&mut self, x: f64, y: f64) -> u32 {
        self.x.push(x);
        self.y.push(y);
        (self.x.len() - 1) as u32
    }

    pub(crate) fn push_surface(&mut self, name: &str, nodes: Vec<u32>, closed: bool) {
        self.surfaces.push((name.to_owned(), Surface { nodes, closed }));
    }
}

/// Finds an entry of a short list by its name.
pub(crate) fn named<'a, T>(list: &'a [(String, T)], name: &str) -> Option<&'a T> {
    list.iter().find(|(n, _)| n == name).map(|(_, value)| value)
}

/// Area of a polygon [m²]; positive when its corners run counter-clockwise.
pub(crate) fn signed_area(corners: &[[f64; 2]]) -> f64 {
    // Measured from the first corner, so that a body far from the origin loses no digits.
    let [x0, y0] = corners[0];
    let fan = corners[1..].windows(2);
    fan.map(|w| 0.5 * ((w[0][0] - x0) * (w[1][1] - y0) - (w[1][0] - x0) * (w[0][1] - y0))).sum()
}
