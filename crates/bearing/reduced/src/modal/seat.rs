//! The seat of the outer ring in its housing, divided into panels (THEORY §9.1).

use serde::{Deserialize, Serialize};

/// Springs of the seat: normal springs of all panels, then tangential ones, each list filled up with zeros to
/// whole groups.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Seat {
    /// Panels.
    pub panels: usize,
    /// Panels with the zeros that fill up the last group of [`GROUP`](crate::modal::GROUP).
    pub padded: usize,
    /// Normal force on each panel at the preload [N].
    pub pressed: Vec<f64>,
    /// How far a panel that nothing presses at the preload is from touching [m]; zero for the others.
    pub gaps: Vec<f64>,
    /// Normal stiffness of each panel [N/m].
    pub across: Vec<f64>,
    /// Tension of each spring by a unit of every mode when nothing opens or slips [N/(√kg m)], mode by mode.
    pub tension: Vec<f64>,
    /// Residual tension of each spring, beyond the modes, by a unit force towards the outside at each vertex
    /// of the raceway, vertex by vertex.
    pub by_rollers: Vec<f64>,
    /// Residual tension of each spring by the rollers of the preload [N].
    pub at_preload: Vec<f64>,
    /// Loss of tension of each spring by a unit opening or slip of another [N/m], spring by spring.
    pub stiffness: Vec<f64>,
    /// Force on the ring by a unit tension of each spring.
    pub on_ring: Vec<[f64; 2]>,
    /// Radial modal displacement of the raceway cancelled by the tangential springs [1/√kg], vertex by
    /// vertex.
    pub taken_back: Vec<f64>,
    /// Residual displacement of each sensor by a unit tension of each spring [m/N]; for normal springs, of
    /// missing tension.
    pub at_sensors: Vec<Vec<[f64; 2]>>,
    /// Displacement of the raceway at each vertex under a unit force there if the whole seat opens [m/N].
    /// Empty until the numbers of a scene are known, because the tables above are rounded before.
    pub flexibility: Vec<f64>,
}
