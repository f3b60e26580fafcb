//! A facet while a pass is evaluated: its motion, and the forces that accumulate on it.

use stribeck_solver::state::Moment;
use stribeck_surface::{
    Surface,
    facet::Facet,
    foot::{FacetPoint, Foot, Push, Sliding},
    polynomial::Coefficients,
};

/// A facet in motion, and the forces on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MovingFacet<F: Facet> {
    pub(crate) facet: F,
    /// Coefficients of its motion [m/s].
    pub(crate) motion: F::Coefficients,
    forces: F::Coefficients,
    /// Sum of the forces [N].
    pub(crate) force: [f64; 2],
    used: bool,
}

impl<F: Facet> MovingFacet<F> {
    #[inline(always)]
    pub(crate) fn new(facet: F, surface: &Surface, at: &Moment<'_>) -> Self {
        let motion = facet.gather(surface, at.vx, at.vy);
        Self { facet, motion, forces: F::Coefficients::zero(0.0), force: [0.0; 2], used: false }
    }

    /// How a point with the velocity `v` moves against its foot on this facet.
    #[inline(always)]
    pub(crate) fn sliding(&self, v: [f64; 2], foot: &Foot<f64>) -> Sliding<f64> {
        foot.sliding(v, &self.motion)
    }

    /// Velocity of a point [m/s].
    #[inline(always)]
    pub(crate) fn velocity(&self, point: &FacetPoint<f64>) -> [f64; 2] {
        point.velocity(&self.motion)
    }

    #[inline(always)]
    pub(crate) fn push_point(&mut self, point: &FacetPoint<f64>, f: [f64; 2]) {
        point.push(f, &mut self.forces);
        self.force = [self.force[0] + f[0], self.force[1] + f[1]];
        self.used = true;
    }

    /// Adds the reaction to `f`, the sum of a pressure and a shear force on a point whose foot is here.
    #[inline(always)]
    pub(crate) fn push_foot(&mut self, foot: &Foot<f64>, f: [f64; 2], pressure: f64, shear: f64) {
        foot.push(f, foot.lever(pressure, shear), &mut self.forces);
        self.used = true;
    }

    /// Adds the forces of many points to each coefficient.
    #[inline(always)]
    pub(crate) fn push_all(&mut self, forces: &F::Coefficients) {
        self.forces.add_all(forces);
        let all = forces.value(0.0);
        self.force = [self.force[0] + all[0], self.force[1] + all[1]];
        self.used = true;
    }

    /// Hands the forces over to the nodes.
    #[inline(always)]
    pub(crate) fn flush(&self, surface: &Surface, push: &mut Vec<Push>) {
        if self.used {
            self.facet.scatter(surface, &self.forces, push);
        }
    }
}
