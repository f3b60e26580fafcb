//! Constant data of a raceway.

use crate::modal::compliance::{Compliance, Curve};
use stribeck_simd::lanes::Number;

use super::{outline::Outline, penetration::Sides, round::Relief, traction::Traction};

#[derive(Debug, Clone)]
pub(crate) struct Raceway {
    pub(crate) outline: Outline,
    /// One over the angle that each facet takes [1/rad]; 0 for walls.
    pub(crate) angle: Vec<f64>,
    pub(crate) sides: Sides,
    /// Of arcs: the circle that round rollers see, with its relief.
    pub(crate) relief: Option<Relief>,
    /// Centre of the circle [m]; the origin of chords, and of a ring that turns.
    pub(crate) centre: [f64; 2],
    pub(crate) compliance: Compliance,
    pub(crate) curve: Curve,
    /// Radius of the circle about its centre that touches the raceway from the side of the rollers [m]:
    /// inscribed for the outer one, circumscribed for the inner one.
    pub(crate) bound: f64,
    /// The same of the outline near each facet [m]; of the outer one, which is bent by its load. Empty for
    /// the inner one.
    pub(crate) bounds: Vec<f64>,
    /// Largest relative radius [m].
    pub(crate) relative: f64,
    /// Traction of its loaded contacts through oil that resists; without, friction is Coulomb's.
    pub(crate) traction: Option<Traction>,
}

impl Raceway {
    /// +1 where the raceway lies beyond the roller, seen from the bearing's centre, −1 where it lies before
    /// it.
    #[inline(always)]
    pub(crate) fn outwards(&self) -> f64 {
        if self.sides.along { 1.0 } else { -1.0 }
    }

    /// How far from its middle a contact may reach that is `depth` deep between the circles around both [m].
    #[inline(always)]
    pub(crate) fn reach<N: Number>(&self, depth: N) -> N {
        (depth.constant(2.0 * self.relative) * depth).sqrt() * depth.constant(1.001)
    }
}
