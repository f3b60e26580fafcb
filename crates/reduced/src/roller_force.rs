//! What rollers press on the raceway beyond the modes: sensors measure it, and the seat feels it.

use serde::{Deserialize, Serialize};

/// A force that sensors measure beyond the modes: its facet, the share of the facet's second vertex, and how large it is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct RollerForce {
    pub(crate) facet: u32,
    pub(crate) share: f64,
    pub(crate) force: f64,
    /// By how much it has grown in the last step.
    pub(crate) growth: f64,
    /// By how much it falls when the raceway gives way, the roller staying where it is [N/m]: what the seat feels of a roller.
    pub(crate) stiffness: f64,
}

impl RollerForce {
    /// The force of the step that begins, if it goes on as it did; none pulls.
    #[inline(always)]
    pub(crate) fn next(&self) -> f64 {
        (self.force + self.growth).max(0.0)
    }
}
