//! State of the seat during a run, a part of the checkpoint.

use serde::{Deserialize, Serialize};

use crate::roller_force::RollerForce;

/// Opening and slip of the panels, and the tensions and modal forces that follow: part of the checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeatState {
    /// Gap of each panel, then its slip [m].
    pub(crate) open: Vec<f64>,
    /// The same before the last step.
    pub(super) before: Vec<f64>,
    /// Tension that each spring has lost by opening and slip [N].
    pub(super) lost: Vec<f64>,
    /// Modal forces of the lost tensions [N/√kg].
    pub(crate) push: Vec<f64>,
    /// Forces of the rollers on the outer raceway in the last step.
    pub(crate) pressed: Vec<RollerForce>,
}
