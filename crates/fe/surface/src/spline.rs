//! Surfaces that move as splines of their nodes: the response to a travelling load does not depend on the
//! positions of nodes (THEORY §4.5).
//!
//! The curve is the uniform cubic B-spline whose control points are means of three neighbouring nodes, ¼ (1,
//! 2, 1), plus a height that makes it the surface's own curve in the reference positions. Corners are kept:
//! the nodes beyond one are its mirror images through the corner.

use crate::{
    foot::Push,
    patch::Patch,
    polynomial::{Polynomial, cubic},
};

/// Nodes that a facet's curve depends on: its own two and two more on either side.
const SUPPORT: usize = 6;

/// Coefficients of s⁰ … s³ from the nodes of the support.
type Rows = [[f64; SUPPORT]; 4];

/// The same by node, for x and y of each coefficient in turn.
type Columns = [[f64; 8]; SUPPORT];

/// Dependence of every facet of a surface on its nodes.
#[derive(Debug, Clone)]
pub struct Spline {
    facets: Vec<Support>,
    matrices: Vec<(Rows, Columns)>,
}

#[derive(Debug, Clone, Copy)]
struct Support {
    /// Vertices of the polyline, and their slots.
    vertices: [u32; SUPPORT],
    slots: [u32; SUPPORT],
    matrix: u32,
    /// Height e(s) above the spline, a cubic [m].
    height: [f64; 4],
}

impl Spline {
    /// For a polyline of these slots and corners; its facets have no heights yet.
    pub fn new(slots: &[u32], corners: &[bool], facets: usize) -> Self {
        let mut spline = Self { facets: Vec::new(), matrices: Vec::new() };
        let n = slots.len() as i64;
        for f in 0..facets {
            let vertex = |offset: i64| (f as i64 + offset).rem_euclid(n) as usize;
            let corner = |offset: i64| corners[vertex(offset)];
            let low = [0, -1, -2].into_iter().find(|&o| corner(o)).unwrap_or(-2);
            let high = [1, 2, 3].into_iter().find(|&o| corner(o)).unwrap_or(3);
            let rows = matrix(low, high);
            let known = spline.matrices.iter().position(|(m, _)| *m == rows);
            let matrix = known.unwrap_or_else(|| {
                spline.matrices.push((rows, columns(&rows)));
                spline.matrices.len() - 1
            });
            // Nodes beyond a corner have no weight; the facet's own stand in for them.
            let vertices = std::array::from_fn(|j| vertex((j as i64 - 2).clamp(low, high)) as u32);
            let slots = vertices.map(|v| slots[v as usize]);
            spline.facets.push(Support { vertices, slots, matrix: matrix as u32, height: [0.0; 4] });
        }
        spline
    }

    /// Sets the height of a facet's curve above the spline [m] at its places 0, 1/3, 2/3 and 1.
    pub fn set_height(&mut self, facet: usize, at: [f64; 4]) {
        self.facets[facet].height = through(at);
    }

    /// A facet in given positions.
    #[inline(always)]
    pub fn patch(&self, x: &[f64], y: &[f64], facet: usize) -> Patch<f64> {
        Patch::new(self.gather(x, y, facet), self.facets[facet].height)
    }

    /// Coefficients of a node field on a facet.
    #[inline(always)]
    pub fn gather(&self, x: &[f64], y: &[f64], facet: usize) -> Polynomial<f64, 4> {
        let Support { slots, matrix, .. } = &self.facets[facet];
        let (_, columns) = &self.matrices[*matrix as usize];
        let mut c = [0.0; 8];
        for (column, &slot) in columns.iter().zip(slots) {
            let (px, py) = (x[slot as usize], y[slot as usize]);
            for k in 0..4 {
                c[2 * k] += column[2 * k] * px;
                c[2 * k + 1] += column[2 * k + 1] * py;
            }
        }
        Polynomial([[c[0], c[1]], [c[2], c[3]], [c[4], c[5]], [c[6], c[7]]])
    }

    /// Hands forces on coefficients over to the nodes: the transpose of `gather`.
    #[inline(always)]
    pub fn scatter(&self, facet: usize, forces: &Polynomial<f64, 4>, push: &mut Vec<Push>) {
        let Support { slots, matrix, .. } = &self.facets[facet];
        let (rows, _) = &self.matrices[*matrix as usize];
        let (mut fx, mut fy) = ([0.0; SUPPORT], [0.0; SUPPORT]);
        for (row, [x, y]) in rows.iter().zip(&forces.0) {
            for j in 0..SUPPORT {
                fx[j] += row[j] * x;
                fy[j] += row[j] * y;
            }
        }
        for j in 0..SUPPORT {
            push.push((slots[j], [fx[j], fy[j]]));
        }
    }

    /// Height above the spline [m].
    #[inline]
    pub fn height(&self, facet: usize, s: f64) -> f64 {
        cubic(&self.facets[facet].height, s)
    }

    /// Vertices that a point depends on, with their shares; near corners shares may be negative.
    #[inline]
    pub fn shares(&self, facet: usize, s: f64) -> [(usize, f64); SUPPORT] {
        let Support { vertices, matrix, .. } = &self.facets[facet];
        let (rows, _) = &self.matrices[*matrix as usize];
        std::array::from_fn(|j| {
            let share = rows.iter().rev().fold(0.0, |sum, row| sum * s + row[j]);
            (vertices[j] as usize, share)
        })
    }

    /// Largest height above or below the spline [m].
    pub fn largest_height(&self) -> f64 {
        let at = |f: &Support| [0.0, 0.5, 1.0].map(|s| cubic(&f.height, s).abs());
        self.facets.iter().flat_map(at).fold(0.0, f64::max)
    }
}

/// Rows of the spline on a facet whose nearest corners stand at these offsets from its first vertex (−2 and 3
/// at most).
fn matrix(low: i64, high: i64) -> Rows {
    // A node, or its substitute beyond a corner, in nodes of the support.
    fn node(offset: i64, low: i64, high: i64) -> [f64; SUPPORT] {
        let corner = match offset {
            o if o < low => low,
            o if o > high => high,
            o => return std::array::from_fn(|j| if j as i64 == o + 2 { 1.0 } else { 0.0 }),
        };
        let (at, mirror) = (node(corner, low, high), node(2 * corner - offset, low, high));
        std::array::from_fn(|j| 2.0 * at[j] - mirror[j])
    }
    let control = |offset: i64| -> [f64; SUPPORT] {
        let [a, b, c] = [-1, 0, 1].map(|o| node(offset + o, low, high));
        std::array::from_fn(|j| 0.25 * (a[j] + 2.0 * b[j] + c[j]))
    };
    let q = [-1, 0, 1, 2].map(control);
    const BASIS: [[f64; 4]; 4] =
        [[1.0, 4.0, 1.0, 0.0], [-3.0, 0.0, 3.0, 0.0], [3.0, -6.0, 3.0, 0.0], [-1.0, 3.0, -3.0, 1.0]];
    BASIS.map(|row| std::array::from_fn(|j| (0..4).map(|i| row[i] * q[i][j]).sum::<f64>() / 6.0))
}

fn columns(rows: &Rows) -> Columns {
    std::array::from_fn(|j| std::array::from_fn(|m| rows[m / 2][j]))
}

/// Coefficients of the cubic with these values at 0, 1/3, 2/3 and 1.
fn through([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [
        a,
        -5.5 * a + 9.0 * b - 4.5 * c + d,
        9.0 * a - 22.5 * b + 18.0 * c - 4.5 * d,
        -4.5 * a + 13.5 * b - 13.5 * c + 4.5 * d,
    ]
}
