//! Total-Lagrangian elements: the one-point quadrilateral with hourglass stiffness and the constant-strain
//! triangle, St. Venant–Kirchhoff material, plane strain (THEORY §2.1–2.2).
//!
//! A force kernel is written once, for one element or for as many side by side as an instruction takes.

use crate::{error::Error, material::Elastic};
use stribeck_simd::lanes::Number;

/// Reference data of a quadrilateral, in a frame of its own: the material is isotropic, so only the shape
/// matters, and congruent elements have equal references wherever they lie.
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

/// Reference data of a triangle, in a frame of its own.
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
pub struct Stiffness<T = f64> {
    /// First Lamé parameter [Pa].
    pub lame: T,
    /// Twice the shear modulus [Pa].
    pub two_shear: T,
    /// Hourglass stiffness [N/m] on γ·x.
    pub hourglass: T,
    /// First Lamé parameter over twice the shear modulus [-].
    pub ratio: T,
}

impl Stiffness {
    /// Constants for a material, thickness [m] and hourglass scale; scale 1 gives a square its exact
    /// stiffness in pure bending, E' t / 12 (THEORY §2.2).
    pub fn new(material: &Elastic, thickness: f64, hourglass_scale: f64) -> Self {
        Self {
            lame: material.lame(),
            two_shear: 2.0 * material.shear(),
            hourglass: hourglass_scale * material.plane_strain_modulus() * thickness / 12.0,
            ratio: 0.5 * material.lame() / material.shear(),
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

/// Corners relative to the first, turned so that the first side direction (or, for quads, the line joining
/// the middles of sides 4–1 and 2–3) is the first axis.
fn own_frame<const N: usize>(corners: &[[f64; 2]; N]) -> [[f64; 2]; N] {
    let d = |a: usize, b: usize| [corners[b][0] - corners[a][0], corners[b][1] - corners[a][1]];
    let axis = if N == 4 {
        let (p, q) = (d(0, 1), d(3, 2));
        [p[0] + q[0], p[1] + q[1]]
    } else {
        d(0, 1)
    };
    let length = libm::hypot(axis[0], axis[1]);
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

/// Forces −P·b1·V and −P·b2·V of the stresses in an element with F = p ⊗ b1 + r ⊗ b2.
#[inline(always)]
fn stress_forces<T: Number>(
    p: [T; 2],
    r: [T; 2],
    b1: [T; 2],
    b2: [T; 2],
    half_volume: T,
    k: &Stiffness<T>,
) -> ([T; 2], [T; 2]) {
    let fxx = p[0].times_plus(b1[0], r[0] * b2[0]);
    let fxy = p[0].times_plus(b1[1], r[0] * b2[1]);
    let fyx = p[1].times_plus(b1[0], r[1] * b2[0]);
    let fyy = p[1].times_plus(b1[1], r[1] * b2[1]);
    // Twice the Green–Lagrange strain, and minus the second Piola–Kirchhoff stress times volume.
    let minus_one = half_volume.constant(-1.0);
    let exx = fxx.times_plus(fxx, fyx.times_plus(fyx, minus_one));
    let eyy = fxy.times_plus(fxy, fyy.times_plus(fyy, minus_one));
    let exy = fxx.times_plus(fxy, fyx * fyy);
    let (lame, shear) = (-(k.lame * half_volume), -(k.two_shear * half_volume));
    let pressure = lame * (exx + eyy);
    let (sxx, syy, sxy) = (shear.times_plus(exx, pressure), shear.times_plus(eyy, pressure), shear * exy);
    // F·(S·b): two products with b first, then two with F, are fewer operations than F·S.
    let (t1x, t1y) = (sxx.times_plus(b1[0], sxy * b1[1]), sxy.times_plus(b1[0], syy * b1[1]));
    let (t2x, t2y) = (sxx.times_plus(b2[0], sxy * b2[1]), sxy.times_plus(b2[0], syy * b2[1]));
    (
        [fxx.times_plus(t1x, fxy * t1y), fyx.times_plus(t1x, fyy * t1y)],
        [fxx.times_plus(t2x, fxy * t2y), fyx.times_plus(t2x, fyy * t2y)],
    )
}

/// Hourglass mode γ·x of positions [m].
#[inline(always)]
pub(crate) fn hourglass<T: Number>(x: [T; 4], y: [T; 4], p: [T; 2], r: [T; 2], s1: T, s2: T) -> [T; 2] {
    let hx = (x[0] + x[2]) - (x[1] + x[3]);
    let hy = (y[0] + y[2]) - (y[1] + y[3]);
    [(-s1).times_plus(p[0], (-s2).times_plus(r[0], hx)), (-s1).times_plus(p[1], (-s2).times_plus(r[1], hy))]
}

/// Forces [N] on corners 1, 2 and 4 and minus the force on corner 3: where forces are summed it is
/// subtracted, which saves a negation.
pub(crate) type CornerForces<T> = [[T; 2]; 4];

/// Forces on the corners from those of the diagonals and of the hourglass stiffness [N].
#[inline(always)]
pub(crate) fn corner_forces<T: Number>(
    g1: [T; 2],
    g2: [T; 2],
    [wx, wy]: [T; 2],
    s1: T,
    s2: T,
) -> CornerForces<T> {
    let t1 = [s1.times_plus(wx, g1[0]), s1.times_plus(wy, g1[1])];
    let t2 = [s2.times_plus(wx, g2[0]), s2.times_plus(wy, g2[1])];
    [[t1[0] - wx, t1[1] - wy], [t2[0] + wx, t2[1] + wy], [t1[0] + wx, t1[1] + wy], [wx - t2[0], wy - t2[1]]]
}

/// Forces [N] on the four corners of one quadrilateral at positions `x`, `y` [m].
pub fn quad_forces(x: [f64; 4], y: [f64; 4], q: &QuadReference, k: &Stiffness) -> [[f64; 2]; 4] {
    let [f1, f2, [minus_x, minus_y], f4] = any_quad_forces(x, y, [q.b1, q.b2], [q.s1, q.s2], q.volume, k);
    [f1, f2, [-minus_x, -minus_y], f4]
}

/// The same for numbers of any kind.
#[inline(always)]
pub(crate) fn any_quad_forces<T: Number>(
    x: [T; 4],
    y: [T; 4],
    [b1, b2]: [[T; 2]; 2],
    [s1, s2]: [T; 2],
    volume: T,
    k: &Stiffness<T>,
) -> CornerForces<T> {
    let p = [x[0] - x[2], y[0] - y[2]];
    let r = [x[1] - x[3], y[1] - y[3]];
    let (g1, g2) = stress_forces(p, r, b1, b2, volume.constant(0.5) * volume, k);
    let [hx, hy] = hourglass(x, y, p, r, s1, s2);
    corner_forces(g1, g2, [k.hourglass * hx, k.hourglass * hy], s1, s2)
}

impl Stiffness {
    /// The same in numbers of another kind.
    #[inline(always)]
    pub(crate) fn of<T: Number>(&self, kind: T) -> Stiffness<T> {
        let (lame, two_shear) = (kind.constant(self.lame), kind.constant(self.two_shear));
        let (hourglass, ratio) = (kind.constant(self.hourglass), kind.constant(self.ratio));
        Stiffness { lame, two_shear, hourglass, ratio }
    }
}

/// Forces [N] on corners 1 and 2 of one triangle; that on corner 3 is the negative of their sum.
pub fn triangle_forces(x: [f64; 3], y: [f64; 3], t: &TriangleReference, k: &Stiffness) -> [[f64; 2]; 2] {
    any_triangle_forces(x, y, t, k)
}

/// The same for numbers of any kind.
#[inline(always)]
pub(crate) fn any_triangle_forces<T: Number>(
    x: [T; 3],
    y: [T; 3],
    t: &TriangleReference,
    k: &Stiffness<T>,
) -> [[T; 2]; 2] {
    let p = [x[0] - x[2], y[0] - y[2]];
    let r = [x[1] - x[2], y[1] - y[2]];
    let b1 = [p[0].constant(t.b1[0]), p[0].constant(t.b1[1])];
    let b2 = [p[0].constant(t.b2[0]), p[0].constant(t.b2[1])];
    let (f1, f2) = stress_forces(p, r, b1, b2, p[0].constant(0.5 * t.volume), k);
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
#[inline(always)]
pub(crate) fn quad_energy<T: Number>(
    x: [T; 4],
    y: [T; 4],
    [b1, b2]: [[T; 2]; 2],
    [s1, s2]: [T; 2],
    volume: T,
    k: &Stiffness<T>,
) -> [T; 2] {
    let p = [x[0] - x[2], y[0] - y[2]];
    let r = [x[1] - x[3], y[1] - y[3]];
    let [hx, hy] = hourglass(x, y, p, r, s1, s2);
    let fxx = p[0].times_plus(b1[0], r[0] * b2[0]);
    let fxy = p[0].times_plus(b1[1], r[0] * b2[1]);
    let fyx = p[1].times_plus(b1[0], r[1] * b2[0]);
    let fyy = p[1].times_plus(b1[1], r[1] * b2[1]);
    let (half, one) = (volume.constant(0.5), volume.constant(1.0));
    let exx = half * (fxx.times_plus(fxx, fyx * fyx) - one);
    let eyy = half * (fxy.times_plus(fxy, fyy * fyy) - one);
    let twice_exy = fxx.times_plus(fxy, fyx * fyy);
    let trace = exx + eyy;
    let squares = exx.times_plus(exx, eyy.times_plus(eyy, half * twice_exy * twice_exy));
    let density = half * (k.lame * trace).times_plus(trace, k.two_shear * squares);
    [volume * density, half * k.hourglass * hx.times_plus(hx, hy * hy)]
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
