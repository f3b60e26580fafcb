//! The elastic bodies of one mesh under one load, reduced (THEORY §9.1–9.3).

use serde::{Deserialize, Serialize};

use crate::modal::{compliance::Compliance, seat::Seat};

/// Rings, housing, rollers and cage of one mesh under one load, reduced.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reduction {
    /// Modes of outer ring and housing that are kept.
    pub modes: usize,
    /// Modes with the zeros that fill up the last group of [`GROUP`](crate::modal::GROUP).
    pub padded: usize,
    /// ω² of each mode [rad²/s²].
    pub squares: Vec<f64>,
    /// Vertices of the outer raceway, counter-clockwise, at the preload but without the local dents of the
    /// rollers [m].
    pub outer: Vec<[f64; 2]>,
    /// Shapes at these vertices [1/√kg]: x of all modes, then y, vertex by vertex.
    pub shapes: Vec<f64>,
    /// Vertices of the inner raceway, counter-clockwise, at the start [m].
    pub inner: Vec<[f64; 2]>,
    /// Vertices of a roller that is not turned, from its centre [m].
    pub roller: Vec<[f64; 2]>,
    /// Sensors in the order of the scene.
    pub sensors: Vec<Sensor>,
    /// Forces of load, weight and prestress on each mode at the preload [N/√kg].
    pub constant: Vec<f64>,
    /// Forces of the load and of weight alone on each mode [N/√kg].
    pub external: Vec<f64>,
    /// Forces of the load on each mode.
    pub load: Load,
    /// Forces of dampers on each mode by a unit velocity of every mode [1/s], row by row; empty without
    /// dampers.
    pub dampers: Vec<f64>,
    /// The frame around springs, which moves as one piece.
    pub frame: Option<Frame>,
    /// Strain energy of all bodies at the preload [J].
    pub strain: f64,
    /// Compliance of roller and outer raceway.
    pub outer_compliance: Compliance,
    /// Compliance of roller and inner raceway.
    pub inner_compliance: Compliance,
    /// Compliance of a roller on a wall of the cage, which is rigid and flat.
    pub wall_compliance: Compliance,
    /// Mass [kg] and moment of inertia [kg m²] of a roller.
    pub roller_inertia: [f64; 2],
    /// Mass [kg] and moment of inertia [kg m²] of the cage, if there is one, with its centre of mass [m].
    pub cage: Option<([f64; 2], [f64; 2])>,
    /// Mass of outer ring and adapter [kg].
    pub structure_mass: f64,
    /// Force of the housing on the outer ring that sits in it, at the preload [N].
    pub seat: Option<[f64; 2]>,
    /// Springs of the seat, which may open and slip.
    pub springs: Option<Seat>,
}

/// How a sensor moves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sensor {
    /// Shapes at its node [1/√kg]: x of all modes, then y.
    pub shape: Vec<f64>,
    /// Residual displacement (x, y), beyond the modes, by a unit force towards the outside at each vertex of
    /// the raceway [m/N].
    pub residual: Vec<[f64; 2]>,
}

/// A body that moves as one piece beside an elastic ring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Mass [kg].
    pub mass: f64,
    /// Shapes at its nodes [1/√kg]: x of all modes, then y.
    pub shape: Vec<f64>,
}

/// The load of the preload and its forces on the modes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Load {
    /// Size [N].
    pub force: f64,
    /// Force on each mode [N/√kg].
    pub along: Vec<f64>,
    /// Force on each mode by an equal load a quarter of a turn ahead [N/√kg].
    pub across: Vec<f64>,
}
