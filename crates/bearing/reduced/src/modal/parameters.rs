//! Numbers of one scene for a reduction: outlines, contact, damping, speeds, cage and oil, in SI.

use serde::{Deserialize, Serialize};
use stribeck_theory::duty::Duty;

/// The numbers of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    /// Surfaces that roll on each other.
    pub outlines: Outlines,
    /// Radius of the outer raceway, of the inner raceway and of a roller, as drawn [m].
    pub radii: Radii,
    /// Thickness of all bodies [m].
    pub thickness: f64,
    /// Rollers at the start.
    pub rollers: Vec<RollerStart>,
    /// Contact and friction.
    pub contact: Contact,
    /// Damping of the material.
    pub damping: Damping,
    /// Gravity, downwards [m/s²].
    pub gravity: f64,
    /// Angular velocities at the start.
    pub speeds: Speeds,
    /// Whether the outer ring turns.
    pub outer_turns: bool,
    /// Speeds and load, where they change.
    pub duty: Option<Duty>,
    /// Load on the housing at the start [N].
    pub load_at_start: f64,
    /// Friction coefficient of the seat [-].
    pub seat_friction: f64,
    /// Pockets of the cage, if there is one.
    pub pockets: Option<Pockets>,
    /// Oil between rollers and raceways, if there is some.
    pub oil: Option<Oil>,
    /// Ragged edges of spalls in the outer and the inner raceway.
    pub ragged: [Ragged; 2],
}

/// Edges of the spalls of a raceway of which other parts are gone wherever across its width a roller meets them,
/// drawn anew for each passage.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Ragged {
    /// Largest depth that is gone [m]; 0 where edges are straight.
    pub by: f64,
    /// Angle of the spall at the start [rad]; draws change opposite to it.
    pub at: f64,
    /// Seed of the draws.
    pub seed: u64,
}

/// Vertices of the surfaces that roll on each other, counter-clockwise [m], with all deviations from round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outlines {
    /// Outer raceway.
    pub outer: Vec<[f64; 2]>,
    /// Inner raceway.
    pub inner: Vec<[f64; 2]>,
    /// Rims of rollers from their centres: the round one first, then those that deviate from round.
    pub rims: Vec<Vec<[f64; 2]>>,
    /// Rim of each roller, as an index of `rims`.
    pub rim_of: Vec<u32>,
    /// By how much the radius of each roller exceeds that of its rim [m]: a deviation that leaves it round.
    #[serde(default)]
    pub larger: Vec<f64>,
    /// Whether facets stand for arcs of the circles that they are drawn in, or are straight.
    pub arcs: bool,
}

/// Radii as drawn [m].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Radii {
    /// Outer raceway.
    pub outer: f64,
    /// Inner raceway.
    pub inner: f64,
    /// Roller.
    pub roller: f64,
}

/// A roller at the start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RollerStart {
    /// Angle of its centre [rad].
    pub angle: f64,
    /// Angle of its vertex 0 [rad].
    pub vertex_angle: f64,
}

/// Contact and friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Penalty stiffness [N/m³].
    pub stiffness: f64,
    /// Contact damping [N s/m³].
    pub damping: f64,
    /// Friction coefficient [-].
    pub friction: f64,
}

/// Damping of the material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Damping {
    /// Mass damping of rollers [1/s].
    pub mass: f64,
    /// Mass damping of the modes [1/s]: zero where it acts on deformation alone.
    pub mass_of_modes: f64,
    /// Motion that mass damping acts on.
    pub frame: DampingFrame,
    /// Stiffness damping β [s].
    pub stiffness: f64,
    /// Maxwell branches of the structural damping of outer ring and adapter.
    pub branches: Vec<Branch>,
}

/// The motion of a body that mass damping acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum DampingFrame {
    /// All of it but the orbit of rollers and their spin: motion across the raceways remains.
    Rolling,
    /// Deformation alone.
    RigidMotion,
    /// All of it.
    Absolute,
}

/// A spring and a dashpot in series beside every element.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Branch {
    /// Stiffness of the spring over that of the element [-].
    pub stiffness: f64,
    /// Relaxation time [s]: dashpot over spring.
    pub relaxation_time: f64,
}

/// Angular velocities of rolling without slip [rad/s], counter-clockwise positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Speeds {
    /// Inner ring.
    pub shaft: f64,
    /// Outer ring.
    pub outer: f64,
    /// Cage, and with it the orbit of rollers.
    pub cage: f64,
    /// Spin of rollers.
    pub roller: f64,
}

/// Pockets of the cage, alike but for their angles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pockets {
    /// Radii of the inner and of the outer end of the walls [m].
    pub ends: [f64; 2],
    /// Radius of the circle on which the centres of rollers run [m].
    pub path: f64,
    /// Half the distance of both walls of a pocket [m].
    pub half_width: f64,
    /// Angle of the pocket of each roller [rad].
    pub angles: Vec<f64>,
    /// Length of a facet of the wall [m].
    pub facet: f64,
    /// Contact points on each facet; `None` where points are the vertices.
    pub points_per_facet: Option<usize>,
}

/// Oil between rollers and raceways.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Oil {
    /// Viscosity [Pa s].
    pub viscosity: f64,
    /// Length of films, out of plane [m].
    pub length: f64,
    /// Films at the outer raceway.
    pub outer: Film,
    /// Films at the inner raceway.
    pub inner: Film,
    /// What it takes from the motion, if anything.
    #[serde(default)]
    pub resistance: Option<Resistance>,
}

/// Resistance of oil to rolling and sliding, and its drag on rollers (THEORY §4.6).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Resistance {
    /// Largest traction of a loaded contact over its normal force [-].
    pub limiting_traction: f64,
    /// Pressure–viscosity coefficient [1/Pa].
    pub pressure_viscosity: f64,
    /// Modulus of Hertz's contact between like bodies, E/(2(1 − ν²)) [Pa].
    pub contact_modulus: f64,
    /// Density of what rollers push along [kg/m³].
    pub density: f64,
}

/// Films at one raceway.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Film {
    /// Thickness below which no film falls [m].
    pub least: f64,
    /// Entrainment speed of rolling without slip [m/s].
    pub speed: f64,
}
