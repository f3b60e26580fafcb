//! Two more forms of the quadrilateral's force, for the hot loops: in terms of the inner products of the
//! diagonals, they take fewer numbers or fewer operations than [`crate::element::quad_forces`] and differ
//! from it by rounding (THEORY §2.1).

use stribeck_simd::lanes::Number;

use crate::element::{CornerForces, QuadReference, Stiffness, corner_forces, hourglass};

/// Data of a quadrilateral whose neighbours have other shapes: the fewest numbers that define its shape
/// (THEORY §2.1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct QuadShape<T = f64> {
    /// Inner products of the reference diagonals p·p, r·r and p·r [m²].
    pub(crate) rest: [T; 3],
    /// Shear modulus times volume over (p × r)⁴ [N/m⁷].
    pub(crate) scale: T,
    /// See [`QuadReference::s1`].
    pub(crate) s1: T,
    /// See [`QuadReference::s1`].
    pub(crate) s2: T,
}

impl QuadShape {
    /// The same element in other terms.
    pub(crate) fn new(q: &QuadReference, k: &Stiffness) -> Self {
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let (b11, b12, b22) = (dot(q.b1, q.b1), dot(q.b1, q.b2), dot(q.b2, q.b2));
        // The diagonals are dual to the gradients, so their inner products are the inverse of those of the
        // gradients.
        let determinant = b11 * b22 - b12 * b12;
        let rest = [b22 / determinant, b11 / determinant, -b12 / determinant];
        Self { rest, scale: 0.5 * k.two_shear * q.volume * determinant * determinant, s1: q.s1, s2: q.s2 }
    }
}

impl<T: Number> QuadShape<T> {
    /// Forces on the four corners at positions `x`, `y` [m]; equal to [`crate::element::quad_forces`] but for
    /// rounding.
    #[inline(always)]
    pub(crate) fn forces(&self, x: [T; 4], y: [T; 4], k: &Stiffness<T>) -> CornerForces<T> {
        let [pp, rr, pr] = self.rest;
        let (px, py, rx, ry) = (x[0] - x[2], y[0] - y[2], x[1] - x[3], y[1] - y[3]);
        // Minus the changes of the inner products, scaled.
        let e1 = self.scale * (-px).times_plus(px, (-py).times_plus(py, pp));
        let e2 = self.scale * (-rx).times_plus(rx, (-ry).times_plus(ry, rr));
        let e3 = self.scale * (-px).times_plus(rx, (-py).times_plus(ry, pr));
        // The tensions κ (B:e) B + B e B, where B is the metric of the gradients times (p × r)².
        let (m11, m12) = (rr.times_plus(e1, -(pr * e3)), rr.times_plus(e3, -(pr * e2)));
        let (m21, m22) = (pp.times_plus(e3, -(pr * e1)), pp.times_plus(e2, -(pr * e3)));
        let trace = m11 + m22;
        let (n11, n22) = (k.ratio.times_plus(trace, m11), k.ratio.times_plus(trace, m22));
        let t11 = n11.times_plus(rr, -(m12 * pr));
        let t12 = m12.times_plus(pp, -(n11 * pr));
        let t22 = n22.times_plus(pp, -(m21 * pr));
        let g1 = [t11.times_plus(px, t12 * rx), t11.times_plus(py, t12 * ry)];
        let g2 = [t22.times_plus(rx, t12 * px), t22.times_plus(ry, t12 * py)];
        let [hx, hy] = hourglass(x, y, [px, py], [rx, ry], self.s1, self.s2);
        corner_forces(g1, g2, [k.hourglass * hx, k.hourglass * hy], self.s1, self.s2)
    }
}

/// A quadrilateral's reference and material in terms of the inner products of its diagonals: the fewest
/// operations where the numbers need not be loaded for every element (THEORY §2.1).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct QuadMetric<T = f64> {
    /// Minus the inner products of the reference diagonals p·p, r·r and p·r [m²].
    minus_rest: [T; 3],
    /// Minus the stiffness [N/m³] from changes of p·p and r·r to the tensions along p·p, r·r and p·r: 11, 12,
    /// 22, 13, 23.
    stiffness: [T; 5],
    /// The same from a change of p·r, which counts twice.
    from_mixed: [T; 3],
    /// See [`QuadReference::s1`].
    s1: T,
    /// See [`QuadReference::s1`].
    s2: T,
    /// Hourglass stiffness [N/m].
    hourglass: T,
}

impl QuadMetric {
    /// The same element in other terms.
    pub(crate) fn new(q: &QuadReference, k: &Stiffness) -> Self {
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let (b11, b12, b22) = (dot(q.b1, q.b1), dot(q.b1, q.b2), dot(q.b2, q.b2));
        // The diagonals are dual to the gradients, so their inner products are the inverse of those of the
        // gradients.
        let determinant = b11 * b22 - b12 * b12;
        let minus_rest = [-b22 / determinant, -b11 / determinant, b12 / determinant];
        let (half_lame, shear, v) = (0.5 * k.lame, 0.5 * k.two_shear, q.volume);
        let direct = half_lame + shear;
        let (k13, k23) = (-v * direct * b11 * b12, -v * direct * b22 * b12);
        let stiffness = [
            -v * direct * b11 * b11,
            -v * (half_lame * b11 * b22 + shear * b12 * b12),
            -v * direct * b22 * b22,
            k13,
            k23,
        ];
        let k33 = -v * (half_lame * b12 * b12 + 0.5 * shear * (b11 * b22 + b12 * b12));
        let from_mixed = [2.0 * k13, 2.0 * k23, 2.0 * k33];
        Self { minus_rest, stiffness, from_mixed, s1: q.s1, s2: q.s2, hourglass: k.hourglass }
    }

    /// Makes the element stiffer by a factor.
    pub(crate) fn stiffen(&mut self, factor: f64) {
        let Self { stiffness, from_mixed, hourglass, .. } = self;
        stiffness.iter_mut().chain(from_mixed).chain([hourglass]).for_each(|k| *k *= factor);
    }

    /// The same element with corners numbered 4, 3, 2, 1.
    pub(crate) fn turned_over(&self) -> Self {
        let ([p, r, pr], [k11, k12, k22, k13, k23]) = (self.minus_rest, self.stiffness);
        let [m1, m2, m3] = self.from_mixed;
        Self {
            minus_rest: [r, p, pr],
            stiffness: [k22, k12, k11, k23, k13],
            from_mixed: [m2, m1, m3],
            s1: self.s2,
            s2: self.s1,
            hourglass: self.hourglass,
        }
    }

    /// The same in numbers of another kind.
    #[inline(always)]
    pub(crate) fn of<T: Number>(&self, kind: T) -> QuadMetric<T> {
        let ([p, r, pr], [k11, k12, k22, k13, k23]) = (self.minus_rest, self.stiffness);
        let [m1, m2, m3] = self.from_mixed;
        let (k11, k12, k22) = (kind.constant(k11), kind.constant(k12), kind.constant(k22));
        QuadMetric {
            minus_rest: [kind.constant(p), kind.constant(r), kind.constant(pr)],
            stiffness: [k11, k12, k22, kind.constant(k13), kind.constant(k23)],
            from_mixed: [kind.constant(m1), kind.constant(m2), kind.constant(m3)],
            s1: kind.constant(self.s1),
            s2: kind.constant(self.s2),
            hourglass: kind.constant(self.hourglass),
        }
    }
}

impl<T: Number> QuadMetric<T> {
    /// Forces on the four corners at positions `x`, `y` [m]; equal to [`crate::element::quad_forces`] but for
    /// rounding.
    #[inline(always)]
    pub(crate) fn forces(&self, x: [T; 4], y: [T; 4]) -> CornerForces<T> {
        let ([k11, k12, k22, k13, k23], [m1, m2, m3]) = (self.stiffness, self.from_mixed);
        let (px, py, rx, ry) = (x[0] - x[2], y[0] - y[2], x[1] - x[3], y[1] - y[3]);
        let e1 = px.times_plus(px, py.times_plus(py, self.minus_rest[0]));
        let e2 = rx.times_plus(rx, ry.times_plus(ry, self.minus_rest[1]));
        let e3 = px.times_plus(rx, py.times_plus(ry, self.minus_rest[2]));
        let t11 = k11.times_plus(e1, k12.times_plus(e2, m1 * e3));
        let t22 = k22.times_plus(e2, k12.times_plus(e1, m2 * e3));
        let t12 = k13.times_plus(e1, k23.times_plus(e2, m3 * e3));
        let g1 = [t11.times_plus(px, t12 * rx), t11.times_plus(py, t12 * ry)];
        let g2 = [t22.times_plus(rx, t12 * px), t22.times_plus(ry, t12 * py)];
        let [hx, hy] = hourglass(x, y, [px, py], [rx, ry], self.s1, self.s2);
        corner_forces(g1, g2, [self.hourglass * hx, self.hourglass * hy], self.s1, self.s2)
    }
}
