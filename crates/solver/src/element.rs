//! Total-Lagrangian elements: the one-point quadrilateral with hourglass stiffness and the constant-strain
//! triangle, St. Venant–Kirchhoff material, plane strain (THEORY §2.1–2.2).
//!
//! A force kernel is written once for `L` elements side by side; `L = 1` is the gather path, `L = 8` the one for
//! congruent bodies, and strips run it over neighbouring elements.

use crate::{error::Error, material::Elastic};

/// What a quadrilateral keeps of its reference shape, in a frame of its own: the material is isotropic, so only
/// the shape matters, and congruent elements have equal references wherever they lie.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct QuadReference {
    /// Gradient of shape function 1 (that of 3 is its negative) [1/m].
    pub b1: [f64; 2],
    /// Gradient of shape function 2 (that of 4 is its negative) [1/m].
    pub b2: [f64; 2],
    /// Parts of the hourglass vector along b1 and b2 [-]; zero for parallelograms.
    pub s1: f64,
    /// See `s1`.
    pub s2: f64,
    /// Area times thickness [m³].
    pub volume: f64,
}

/// What a triangle keeps of its reference shape, in a frame of its own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TriangleReference {
    /// Gradient of shape function 1 [1/m].
    pub b1: [f64; 2],
    /// Gradient of shape function 2 [1/m]; that of 3 is −(b1 + b2).
    pub b2: [f64; 2],
    /// Area times thickness [m³].
    pub volume: f64,
}

/// Constants of one body's elements.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stiffness {
    /// First Lamé parameter [Pa].
    pub lame: f64,
    /// Twice the shear modulus [Pa].
    pub two_shear: f64,
    /// Hourglass stiffness [N/m] on γ·x.
    pub hourglass: f64,
}

impl Stiffness {
    /// Constants for a material, thickness [m] and hourglass scale; scale 1 gives a square its exact stiffness
    /// in pure bending, E' t / 12 (THEORY §2.2).
    pub fn new(material: &Elastic, thickness: f64, hourglass_scale: f64) -> Self {
        Self {
            lame: material.lame(),
            two_shear: 2.0 * material.shear(),
            hourglass: hourglass_scale * material.plane_strain_modulus() * thickness / 12.0,
        }
    }
}

/// Signed area of a polygon [m²].
pub(crate) fn area(corners: &[[f64; 2]]) -> f64 {
    // A fan from the first corner, so that an element far from the origin loses no digits.
    let [x0, y0] = corners[0];
    let twice = |w: &[[f64; 2]]| (w[0][0] - x0) * (w[1][1] - y0) - (w[1][0] - x0) * (w[0][1] - y0);
    0.5 * corners[1..].windows(2).map(twice).sum::<f64>()
}

/// Corners relative to the first, turned so that the first side direction (or, for quads, the line joining the
/// middles of sides 4–1 and 2–3) is the first axis.
fn own_frame<const N: usize>(corners: &[[f64; 2]; N]) -> [[f64; 2]; N] {
    let d = |a: usize, b: usize| [corners[b][0] - corners[a][0], corners[b][1] - corners[a][1]];
    let axis = if N == 4 {
        let (p, q) = (d(0, 1), d(3, 2));
        [p[0] + q[0], p[1] + q[1]]
    } else {
        d(0, 1)
    };
    let length = axis[0].hypot(axis[1]);
    let (c, s) = (axis[0] / length, axis[1] / length);
    std::array::from_fn(|i| {
        let [x, y] = d(0, i);
        [c * x + s * y, c * y - s * x]
    })
}

impl QuadReference {
    /// Reference of a quadrilateral with corners [m] in counter-clockwise order.
    ///
    /// # Errors
    /// The signed area when it is not positive.
    pub fn new(corners: &[[f64; 2]; 4], thickness: f64) -> Result<Self, f64> {
        let area = area(corners);
        if !(area.is_finite() && area > 0.0) {
            return Err(area);
        }
        let c = own_frame(corners);
        let scale = 0.5 / area;
        let b1 = [(c[1][1] - c[3][1]) * scale, (c[3][0] - c[1][0]) * scale];
        let b2 = [(c[2][1] - c[0][1]) * scale, (c[0][0] - c[2][0]) * scale];
        let h = |k: usize| c[0][k] - c[1][k] + c[2][k] - c[3][k];
        let (hx, hy) = (h(0), h(1));
        let (s1, s2) = (hx * b1[0] + hy * b1[1], hx * b2[0] + hy * b2[1]);
        Ok(Self { b1, b2, s1, s2, volume: area * thickness })
    }

    /// True when the two shapes are the same to rounding.
    pub fn is_congruent(&self, other: &Self) -> bool {
        gradients_agree([self.b1, self.b2], [other.b1, other.b2])
            && (self.s1 - other.s1).abs() <= CONGRUENT
            && (self.s2 - other.s2).abs() <= CONGRUENT
    }
}

impl TriangleReference {
    /// Reference of a triangle with corners [m] in counter-clockwise order.
    ///
    /// # Errors
    /// The signed area when it is not positive.
    pub fn new(corners: &[[f64; 2]; 3], thickness: f64) -> Result<Self, f64> {
        let area = area(corners);
        if !(area.is_finite() && area > 0.0) {
            return Err(area);
        }
        let c = own_frame(corners);
        let scale = 0.5 / area;
        let b1 = [(c[1][1] - c[2][1]) * scale, (c[2][0] - c[1][0]) * scale];
        let b2 = [(c[2][1] - c[0][1]) * scale, (c[0][0] - c[2][0]) * scale];
        Ok(Self { b1, b2, volume: area * thickness })
    }

    /// True when the two shapes are the same to rounding.
    pub fn is_congruent(&self, other: &Self) -> bool {
        gradients_agree([self.b1, self.b2], [other.b1, other.b2])
    }
}

/// Rounding of positions of 0.1 m against edges of 0.1 mm is 1e-13 of the gradients.
const CONGRUENT: f64 = 1e-11;

fn gradients_agree(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> bool {
    let size: f64 = a.as_flattened().iter().map(|v| v.abs()).sum();
    a.as_flattened().iter().zip(b.as_flattened()).all(|(p, q)| (p - q).abs() <= CONGRUENT * size)
}

/// Stress power of one element: internal nodal forces −P·b1·V and −P·b2·V for F = p ⊗ b1 + r ⊗ b2.
#[inline(always)]
fn stress_forces(
    p: [f64; 2],
    r: [f64; 2],
    b1: [f64; 2],
    b2: [f64; 2],
    lame_v: f64,
    two_shear_v: f64,
) -> ([f64; 2], [f64; 2]) {
    let fxx = p[0] * b1[0] + r[0] * b2[0];
    let fxy = p[0] * b1[1] + r[0] * b2[1];
    let fyx = p[1] * b1[0] + r[1] * b2[0];
    let fyy = p[1] * b1[1] + r[1] * b2[1];
    // Green–Lagrange strain (halved once, here) and second Piola–Kirchhoff stress times volume.
    let exx = 0.5 * (fxx * fxx + fyx * fyx) - 0.5;
    let eyy = 0.5 * (fxy * fxy + fyy * fyy) - 0.5;
    let exy = 0.5 * (fxx * fxy + fyx * fyy);
    let pressure = lame_v * (exx + eyy);
    let sxx = pressure + two_shear_v * exx;
    let syy = pressure + two_shear_v * eyy;
    let sxy = two_shear_v * exy;
    // Forces −F·(S·b): two products with b first, then two with F, are fewer operations than F·S.
    let (t1x, t1y) = (sxx * b1[0] + sxy * b1[1], sxy * b1[0] + syy * b1[1]);
    let (t2x, t2y) = (sxx * b2[0] + sxy * b2[1], sxy * b2[0] + syy * b2[1]);
    (
        [-(fxx * t1x + fxy * t1y), -(fyx * t1x + fyy * t1y)],
        [-(fxx * t2x + fxy * t2y), -(fyx * t2x + fyy * t2y)],
    )
}

/// Forces [N] on the four corners of one quadrilateral at positions `x`, `y` [m].
#[inline(always)]
pub fn quad_forces(x: [f64; 4], y: [f64; 4], q: &QuadReference, k: &Stiffness) -> [[f64; 2]; 4] {
    let p = [x[0] - x[2], y[0] - y[2]];
    let r = [x[1] - x[3], y[1] - y[3]];
    let (g1, g2) = stress_forces(p, r, q.b1, q.b2, k.lame * q.volume, k.two_shear * q.volume);
    let wx = k.hourglass * (((x[0] + x[2]) - (x[1] + x[3])) - q.s1 * p[0] - q.s2 * r[0]);
    let wy = k.hourglass * (((y[0] + y[2]) - (y[1] + y[3])) - q.s1 * p[1] - q.s2 * r[1]);
    let t1 = [g1[0] + q.s1 * wx, g1[1] + q.s1 * wy];
    let t2 = [g2[0] + q.s2 * wx, g2[1] + q.s2 * wy];
    [[t1[0] - wx, t1[1] - wy], [t2[0] + wx, t2[1] + wy], [-t1[0] - wx, -t1[1] - wy], [wx - t2[0], wy - t2[1]]]
}

/// A quadrilateral's reference and material in terms of the inner products of its diagonals: the fewest operations
/// where the numbers need not be loaded for every element (THEORY §2.1).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct QuadMetric {
    /// Inner products of the reference diagonals p·p, r·r and 2 p·r [m²].
    rest: [f64; 3],
    /// Minus the stiffness from changes of those to the tensions along p·p, r·r and p·r, symmetric: 11, 12, 13, 22, 23,
    /// 33 [N/m³].
    stiffness: [f64; 6],
    /// See [`QuadReference::s1`].
    s1: f64,
    /// See [`QuadReference::s1`].
    s2: f64,
    /// Hourglass stiffness [N/m].
    hourglass: f64,
}

impl QuadMetric {
    /// The same element in other terms.
    pub fn new(q: &QuadReference, k: &Stiffness) -> Self {
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let (b11, b12, b22) = (dot(q.b1, q.b1), dot(q.b1, q.b2), dot(q.b2, q.b2));
        // The diagonals are dual to the gradients, so their inner products are the inverse of those of the gradients.
        let determinant = b11 * b22 - b12 * b12;
        let rest = [b22 / determinant, b11 / determinant, -2.0 * b12 / determinant];
        let (half_lame, shear, v) = (0.5 * k.lame, 0.5 * k.two_shear, q.volume);
        let direct = half_lame + shear;
        let stiffness = [
            -v * direct * b11 * b11,
            -v * (half_lame * b11 * b22 + shear * b12 * b12),
            -v * direct * b11 * b12,
            -v * direct * b22 * b22,
            -v * direct * b22 * b12,
            -v * (half_lame * b12 * b12 + 0.5 * shear * (b11 * b22 + b12 * b12)),
        ];
        Self { rest, stiffness, s1: q.s1, s2: q.s2, hourglass: k.hourglass }
    }

    /// Forces [N] on the four corners at positions `x`, `y` [m]; equal to [`quad_forces`] but for rounding.
    #[inline(always)]
    pub fn forces(&self, x: [f64; 4], y: [f64; 4]) -> [[f64; 2]; 4] {
        let [k11, k12, k13, k22, k23, k33] = self.stiffness;
        let (px, py, rx, ry) = (x[0] - x[2], y[0] - y[2], x[1] - x[3], y[1] - y[3]);
        let pr = px * rx + py * ry;
        let e1 = (px * px + py * py) - self.rest[0];
        let e2 = (rx * rx + ry * ry) - self.rest[1];
        let e3 = (pr + pr) - self.rest[2];
        let t11 = (k11 * e1 + k12 * e2) + k13 * e3;
        let t22 = (k12 * e1 + k22 * e2) + k23 * e3;
        let t12 = (k13 * e1 + k23 * e2) + k33 * e3;
        let wx = self.hourglass * (((x[0] + x[2]) - (x[1] + x[3])) - (self.s1 * px + self.s2 * rx));
        let wy = self.hourglass * (((y[0] + y[2]) - (y[1] + y[3])) - (self.s1 * py + self.s2 * ry));
        let t1x = (t11 * px + t12 * rx) + self.s1 * wx;
        let t1y = (t11 * py + t12 * ry) + self.s1 * wy;
        let t2x = (t12 * px + t22 * rx) + self.s2 * wx;
        let t2y = (t12 * py + t22 * ry) + self.s2 * wy;
        [[t1x - wx, t1y - wy], [t2x + wx, t2y + wy], [-(t1x + wx), -(t1y + wy)], [wx - t2x, wy - t2y]]
    }
}

/// Forces [N] on corners 1 and 2 of one triangle; that on corner 3 is the negative of their sum.
#[inline(always)]
pub fn triangle_forces(x: [f64; 3], y: [f64; 3], t: &TriangleReference, k: &Stiffness) -> [[f64; 2]; 2] {
    let p = [x[0] - x[2], y[0] - y[2]];
    let r = [x[1] - x[2], y[1] - y[2]];
    let (f1, f2) = stress_forces(p, r, t.b1, t.b2, k.lame * t.volume, k.two_shear * t.volume);
    [f1, f2]
}

/// Green–Lagrange strain (xx, yy, xy) of F = p ⊗ b1 + r ⊗ b2, in the element's own frame [-].
pub fn strain(p: [f64; 2], r: [f64; 2], b1: [f64; 2], b2: [f64; 2]) -> [f64; 3] {
    let f = [
        [p[0] * b1[0] + r[0] * b2[0], p[0] * b1[1] + r[0] * b2[1]],
        [p[1] * b1[0] + r[1] * b2[0], p[1] * b1[1] + r[1] * b2[1]],
    ];
    [
        0.5 * (f[0][0] * f[0][0] + f[1][0] * f[1][0]) - 0.5,
        0.5 * (f[0][1] * f[0][1] + f[1][1] * f[1][1]) - 0.5,
        0.5 * (f[0][0] * f[0][1] + f[1][0] * f[1][1]),
    ]
}

/// Strain energy density [J/m³] of a Green–Lagrange strain.
pub fn energy_density([exx, eyy, exy]: [f64; 3], k: &Stiffness) -> f64 {
    let trace = exx + eyy;
    0.5 * (k.lame * trace * trace + k.two_shear * (exx * exx + eyy * eyy + 2.0 * exy * exy))
}

/// Strain and hourglass energy [J] of one quadrilateral.
pub fn quad_energy(x: [f64; 4], y: [f64; 4], q: &QuadReference, k: &Stiffness) -> [f64; 2] {
    let p = [x[0] - x[2], y[0] - y[2]];
    let r = [x[1] - x[3], y[1] - y[3]];
    let hx = ((x[0] + x[2]) - (x[1] + x[3])) - q.s1 * p[0] - q.s2 * r[0];
    let hy = ((y[0] + y[2]) - (y[1] + y[3])) - q.s1 * p[1] - q.s2 * r[1];
    let strain = strain(p, r, q.b1, q.b2);
    [q.volume * energy_density(strain, k), 0.5 * k.hourglass * (hx * hx + hy * hy)]
}

/// Strain energy [J] of one triangle.
pub fn triangle_energy(x: [f64; 3], y: [f64; 3], t: &TriangleReference, k: &Stiffness) -> f64 {
    let p = [x[0] - x[2], y[0] - y[2]];
    let r = [x[1] - x[2], y[1] - y[2]];
    t.volume * energy_density(strain(p, r, t.b1, t.b2), k)
}

/// Wraps the signed area of a bad element into an error.
pub(crate) fn bad(body: &str, element: usize) -> impl Fn(f64) -> Error {
    let body = body.to_owned();
    move |area| Error::BadElement { body: body.clone(), element, area }
}
