//! Roller forces on the outer raceway, whose quasi-static response drives sensors and seat.

use serde::{Deserialize, Serialize};

/// The force of a roller on the outer raceway [N], its facet, and the share of the facet's second vertex.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct RollerForce {
    pub(crate) facet: u32,
    pub(crate) share: f64,
    pub(crate) force: f64,
    /// Growth of the force in the last step [N].
    pub(crate) growth: f64,
    /// Stiffness of the contact as the raceway recedes and the roller stays [N/m], from which the seat's
    /// response follows.
    pub(crate) stiffness: f64,
}

impl RollerForce {
    /// Force of the step that begins, extrapolated; never tensile [N].
    #[inline(always)]
    pub(crate) fn next(&self) -> f64 {
        (self.force + self.growth).max(0.0)
    }
}
