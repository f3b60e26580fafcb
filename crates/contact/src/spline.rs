//! Surfaces that move as splines of their nodes: a load that travels over them does not see where the nodes are
//! (THEORY §4.5).
//!
//! The curve is the uniform cubic B-spline whose control points are means of three neighbouring nodes, ¼ (1, 2, 1), plus a
//! height that makes it the surface's own curve in the reference positions. Corners are kept: the nodes beyond one are
//! its mirror images through the corner.

use pulp::Simd;

use crate::{
    projection::{Foot, Frame, Projection, walk},
    row::{Outcome, Row},
    shape::{Coefficients, Poly, Push, Shape, Side, Spot},
    spline_row::Feet,
    surface::Surface,
    touch_row::{Law, Work},
};

/// Nodes that a facet's curve depends on: its own two and two more on either side.
const SUPPORT: usize = 6;

/// Coefficients of s⁰ … s³ from the nodes of the support.
type Rows = [[f64; SUPPORT]; 4];

/// The same by node, for x and y of each coefficient in turn.
type Columns = [[f64; 8]; SUPPORT];

/// Feet this close to a smooth joint belong to either facet: the curve goes on beyond its ends as far as that.
pub(crate) const JOINT: f64 = 1e-9;

/// Newton's method for a foot ends after a correction that leaves an error of rounding: a facet's curve turns by a tenth,
/// so an error ε becomes less than 0.1 ε².
const SMALL: f64 = 1e-5;

/// It is given up after this many: far from the facet, where the walk goes on.
const MOST_CORRECTIONS: usize = 4;

/// How every facet of a surface hangs on its nodes.
#[derive(Debug, Clone)]
pub(crate) struct Spline {
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
    /// For a surface in its reference positions, whose curve it is to follow.
    pub(crate) fn new(surface: &Surface, x: &[f64], y: &[f64]) -> Self {
        let mut spline = Self { facets: Vec::new(), matrices: Vec::new() };
        let n = surface.slots.len() as i64;
        for f in 0..surface.facets() {
            let vertex = |offset: i64| (f as i64 + offset).rem_euclid(n) as usize;
            let corner = |offset: i64| surface.corner[vertex(offset)];
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
            let slots = vertices.map(|v| surface.slots[v as usize]);
            spline.facets.push(Support { vertices, slots, matrix: matrix as u32, height: [0.0; 4] });
        }
        for f in 0..surface.facets() {
            let patch = spline.patch(x, y, f);
            let at = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|s| height_to(surface, x, y, &patch, s));
            spline.facets[f].height = cubic(at);
        }
        spline
    }

    #[inline(always)]
    fn patch(&self, x: &[f64], y: &[f64], facet: usize) -> Patch {
        Patch { facet, curve: self.gather(x, y, facet), height: self.facets[facet].height }
    }

    #[inline(always)]
    fn gather(&self, x: &[f64], y: &[f64], facet: usize) -> Poly<4> {
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
        Poly([[c[0], c[1]], [c[2], c[3]], [c[4], c[5]], [c[6], c[7]]])
    }

    /// Height above the spline [m].
    pub(crate) fn height(&self, facet: usize, s: f64) -> f64 {
        value(&self.facets[facet].height, s)
    }

    /// Vertices that a point hangs on, with their shares; near corners shares may be negative.
    pub(crate) fn shares(&self, facet: usize, s: f64) -> [(usize, f64); SUPPORT] {
        let Support { vertices, matrix, .. } = &self.facets[facet];
        let (rows, _) = &self.matrices[*matrix as usize];
        std::array::from_fn(|j| {
            let share = rows.iter().rev().fold(0.0, |sum, row| sum * s + row[j]);
            (vertices[j] as usize, share)
        })
    }

    /// Largest height above or below the spline [m].
    pub(crate) fn largest_height(&self) -> f64 {
        let at = |f: &Support| [0.0, 0.5, 1.0].map(|s| value(&f.height, s).abs());
        self.facets.iter().flat_map(at).fold(0.0, f64::max)
    }
}

/// Rows of the spline on a facet whose nearest corners stand at these offsets from its first vertex (−2 and 3 at most).
fn matrix(low: i64, high: i64) -> Rows {
    // A node, or what stands for it beyond a corner, in nodes of the support.
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

/// Distance along the patch's normal from its point at `s` to the surface's curve [m].
fn height_to(surface: &Surface, x: &[f64], y: &[f64], patch: &Patch, s: f64) -> f64 {
    let mut height = 0.0;
    // The curve is all but parallel to the spline: each turn takes out all but a thousandth of the rest.
    for _ in 0..4 {
        let spot = patch.spot(s, height);
        let Some(to) = Frame::new(surface, x, y, patch.facet).project(surface, x, y, spot.at) else { break };
        height -= to.gap / to.normal[0].hypot(to.normal[1]);
    }
    height
}

/// Coefficients of the cubic with these values at 0, 1/3, 2/3 and 1.
fn cubic([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [
        a,
        -5.5 * a + 9.0 * b - 4.5 * c + d,
        9.0 * a - 22.5 * b + 18.0 * c - 4.5 * d,
        -4.5 * a + 13.5 * b - 13.5 * c + 4.5 * d,
    ]
}

#[inline(always)]
fn value(c: &[f64; 4], s: f64) -> f64 {
    ((c[3] * s + c[2]) * s + c[1]) * s + c[0]
}

#[inline(always)]
fn derivative(c: &[f64; 4], s: f64) -> f64 {
    (3.0 * c[3] * s + 2.0 * c[2]) * s + c[1]
}

/// A facet of a spline in present positions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch {
    facet: usize,
    pub(crate) curve: Poly<4>,
    pub(crate) height: [f64; 4],
}

impl Patch {
    /// Projection of `p` on the curve, which goes on beyond its ends.
    #[inline(always)]
    fn above(&self, p: [f64; 2]) -> Projection {
        let (r, d, dd) = self.curve.seen_from(p, 0.5);
        // Far beyond the facet's ends its polynomial is no guide.
        let mut s = (0.5 + correction(r, d, dd)).clamp(-2.0, 3.0);
        let (mut r, mut d, mut dd) = self.curve.seen_from(p, s);
        for _ in 0..MOST_CORRECTIONS {
            let more = correction(r, d, dd);
            s = (s + more).clamp(-2.0, 3.0);
            (r, d, dd) = self.curve.seen_from(p, s);
            if more.abs() < SMALL {
                break;
            }
        }
        let square = d[0] * d[0] + d[1] * d[1];
        let inverse = 1.0 / square.sqrt();
        let n = [d[1] * inverse, -d[0] * inverse];
        let off = r[0] * n[0] + r[1] * n[1];
        let height = value(&self.height, s);
        let steep = derivative(&self.height, s) / (square - off * (n[0] * dd[0] + n[1] * dd[1]));
        Projection {
            gap: off - height,
            normal: [n[0] - steep * d[0], n[1] - steep * d[1]],
            facet: self.facet,
            place: s,
            turn: steep * off,
            height,
            curve_normal: n,
            inverse,
        }
    }
}

/// How far along the foot of a point lies, seen from a place of the curve (Newton's method): `r` leads there.
#[inline(always)]
fn correction(r: [f64; 2], d: [f64; 2], dd: [f64; 2]) -> f64 {
    let square = d[0] * d[0] + d[1] * d[1];
    let bend = r[0] * dd[0] + r[1] * dd[1];
    (r[0] * d[0] + r[1] * d[1]) / (square - bend.min(0.5 * square))
}

impl Poly<4> {
    /// From a point of the curve to `p`, and its first and second derivatives.
    #[inline(always)]
    fn seen_from(&self, p: [f64; 2], s: f64) -> ([f64; 2], [f64; 2], [f64; 2]) {
        let (c, v) = (&self.0, self.value(s));
        let dd = [6.0 * c[3][0] * s + 2.0 * c[2][0], 6.0 * c[3][1] * s + 2.0 * c[2][1]];
        ([p[0] - v[0], p[1] - v[1]], self.slope(s), dd)
    }
}

impl Shape for Patch {
    type Coefficients = Poly<4>;

    #[inline(always)]
    fn new(surface: &Surface, x: &[f64], y: &[f64], facet: usize) -> Self {
        surface.spline.as_ref().expect("only surfaces with a spline are seen as patches").patch(x, y, facet)
    }

    #[inline(always)]
    fn facet(&self) -> usize {
        self.facet
    }

    #[inline(always)]
    fn touch_row<V: Simd, const MEMORY: bool>(
        simd: V,
        row: Row<'_>,
        own: &mut Option<Side<Self>>,
        feet: &mut Feet<V>,
        law: &Law<V>,
        work: &mut Work<V>,
        push: &mut Vec<Push>,
    ) -> Outcome {
        let facet = row.candidate.facet as usize;
        let patch = Self::new(row.secondary, row.at.x, row.at.y, facet);
        let own = own.insert(Side::new(patch, row.secondary, row.at));
        row.touch_splines::<V, MEMORY>(simd, own, feet, law, work, push)
    }

    #[inline(always)]
    fn spot(&self, place: f64, height: f64) -> Spot {
        let (c, d) = (self.curve.value(place), self.curve.slope(place));
        let inverse = 1.0 / (d[0] * d[0] + d[1] * d[1]).sqrt();
        let normal = [d[1] * inverse, -d[0] * inverse];
        Spot { at: [c[0] + height * normal[0], c[1] + height * normal[1]], place, height, normal, inverse }
    }

    #[inline(always)]
    fn project(&mut self, surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2]) -> Option<Projection> {
        let to = self.above(p);
        if !surface.beside_corner[self.facet] && self.holds(&to) {
            return Some(to);
        }
        walk(surface, x, y, p, self)
    }

    fn foot(&mut self, p: [f64; 2]) -> Foot {
        let to = self.above(p);
        let inside = (0.0..=1.0).contains(&to.place);
        let end = self.curve.value(to.place.clamp(0.0, 1.0));
        let distance = if inside { to.gap.abs() } else { (p[0] - end[0]).hypot(p[1] - end[1]) };
        Foot { to, distance, inside }
    }

    #[inline(always)]
    fn holds(&self, to: &Projection) -> bool {
        to.place > -JOINT && to.place < 1.0 + JOINT
    }

    fn is_past(&self, to: &Projection, _other: &Self, forward: bool, _p: [f64; 2]) -> bool {
        if forward { to.place > 1.0 } else { to.place < 0.0 }
    }

    #[inline(always)]
    fn gather(&self, surface: &Surface, x: &[f64], y: &[f64]) -> Poly<4> {
        let Some(spline) = &surface.spline else { return Poly::zero() };
        spline.gather(x, y, self.facet)
    }

    #[inline(always)]
    fn scatter(&self, surface: &Surface, forces: &Poly<4>, push: &mut Vec<Push>) {
        let Some(spline) = &surface.spline else { return };
        let Support { slots, matrix, .. } = &spline.facets[self.facet];
        let (rows, _) = &spline.matrices[*matrix as usize];
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
}
