//! Points of facets and their feet on others: their motion, and the nodal forces equivalent to forces on them
//! (THEORY §4.4), over any [`Number`].
//!
//! A facet's curve is a polynomial c(s), linear in the positions of some nodes, plus a height e along its
//! normal n: x = c(s) + e(s) n. Its variation is δx = δc − e t (n·δc′)/|c′|, with the unit tangent t: the
//! height turns with the curve. Velocities follow from the same two terms, forces go the same way back.

use stribeck_simd::lanes::Number;

use crate::{
    plane::{cross, dot, minus},
    polynomial::Coefficients,
};

/// A force on a node: slot, x [N], y [N].
pub type Push = (u32, [f64; 2]);

/// A point of a facet in present positions.
#[derive(Debug, Clone, Copy)]
pub struct FacetPoint<N> {
    /// Position [m].
    pub at: [N; 2],
    /// Place on the facet, 0 at its first node, 1 at its second.
    pub place: N,
    /// Height above the polynomial [m].
    pub height: N,
    /// Unit normal of the polynomial there.
    pub normal: [N; 2],
    /// One over the length of its derivative [1/m].
    pub inverse: N,
}

/// Where a point projects on a facet.
#[derive(Debug, Clone, Copy)]
pub struct Foot<N> {
    /// Signed, see [`Projection`](crate::Projection).
    pub gap: N,
    /// Gradient of the gap with respect to the point.
    pub normal: [N; 2],
    /// Place on the facet, 0 at its first node, 1 at its second.
    pub place: N,
    /// How the gap falls as the facet's polynomial turns: −∂gap/∂(n·c′) [-].
    pub turn: N,
    /// Height of the foot above the polynomial [m].
    pub height: N,
    /// Unit normal of the polynomial there.
    pub curve_normal: [N; 2],
    /// One over the length of its derivative [1/m].
    pub inverse: N,
}

/// How a point moves against its foot.
#[derive(Debug, Clone, Copy)]
pub struct Sliding<N> {
    /// Rate of the gap [m/s].
    pub opening: N,
    /// Tangential velocity, to the left of the normal [m/s].
    pub along: N,
}

impl<N: Number> FacetPoint<N> {
    /// Velocity [m/s], of a facet whose polynomial moves with these coefficients.
    #[inline(always)]
    pub fn velocity(&self, motion: &impl Coefficients<N>) -> [N; 2] {
        let swing = dot(self.normal, motion.slope(self.place));
        off_curve(motion.value(self.place), swing * self.height * self.inverse, self.normal)
    }

    /// Adds a force on the point to those on its facet.
    #[inline(always)]
    pub fn push(&self, f: [N; 2], forces: &mut impl Coefficients<N>) {
        let n = self.normal;
        let lever = -(self.height * self.inverse * cross(n, f));
        forces.add(self.place, f, [lever * n[0], lever * n[1]]);
    }
}

impl<N: Number> Foot<N> {
    /// How a point with the velocity `v` moves against this foot, on a facet that moves with these
    /// coefficients.
    #[inline(always)]
    pub fn sliding(&self, v: [N; 2], motion: &impl Coefficients<N>) -> Sliding<N> {
        let swing = dot(self.curve_normal, motion.slope(self.place));
        let u = motion.value(self.place);
        let opening = dot(self.normal, minus(v, u)) - self.turn * swing;
        let u = off_curve(u, swing * self.height * self.inverse, self.curve_normal);
        Sliding { opening, along: cross(self.normal, minus(v, u)) }
    }

    /// Moment by which the reaction to a pressure and a shear force [N] turns the facet's polynomial.
    #[inline(always)]
    pub fn lever(&self, pressure: N, shear: N) -> N {
        // The shear's own direction, (−n_y, n_x), along the curve's tangent, (−m_y, m_x).
        self.height * self.inverse * shear * dot(self.normal, self.curve_normal) - self.turn * pressure
    }

    /// Adds the reaction to the force `f` with its lever to the forces on the facet.
    #[inline(always)]
    pub fn push(&self, f: [N; 2], lever: N, forces: &mut impl Coefficients<N>) {
        let [mx, my] = self.curve_normal;
        forces.add(self.place, [-f[0], -f[1]], [lever * mx, lever * my]);
    }
}

/// Velocity at a height above a curve that moves with `v`: `back` is how fast the height swings backwards.
#[inline(always)]
fn off_curve<N: Number>(v: [N; 2], back: N, n: [N; 2]) -> [N; 2] {
    [back.times_plus(n[1], v[0]), v[1] - back * n[0]]
}
