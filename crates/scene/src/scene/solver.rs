//! Time integration: duration, time step, damping, and how a run starts.

use serde::{Deserialize, Serialize};

/// Time integration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SolverScene {
    /// Simulated time [ms].
    pub duration_ms: f64,
    /// Time step over the critical one [-]; above 1 a run diverges, and the guards stop it.
    pub time_step_factor: f64,
    /// Hourglass stiffness as a multiple of the exact bending stiffness of a square [-].
    pub hourglass_scale: f64,
    /// Mass-proportional damping [1/s]; 2·ζ·ω for a damping ratio ζ at ω.
    pub mass_damping_per_s: f64,
    /// Motion relative to which the mass damping acts.
    pub damping_frame: DampingFrame,
    /// Stiffness-proportional damping β [ns]; 2·ζ/ω for a damping ratio ζ at ω. Each nanosecond costs time
    /// step.
    pub stiffness_damping_ns: f64,
    /// Damping of chosen bodies at nearly one ratio over a band of frequencies.
    pub structural_damping: Option<StructuralDampingScene>,
    /// How the run starts.
    pub start: Start,
}

/// Structural damping: the loss of a body's material and joints, which hardly depends on frequency. Each
/// branch costs memory traffic, all of them about 5 % of the time step for 2 %.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StructuralDampingScene {
    /// Damping ratio in the band, a share of critical [%].
    pub ratio_percent: f64,
    /// Lower end of the band [kHz]; below it the ratio falls in proportion to the frequency.
    pub from_khz: f64,
    /// Upper end of the band [kHz]; above it the ratio falls as one over the frequency.
    pub to_khz: f64,
    /// Maxwell branches beside every element, 1 to 3: over a factor of 20 in frequency the ratio is within
    /// −49 and +25 % with one, −8 and +4 % with two, 1 % with three.
    pub branches: usize,
    /// Which bodies.
    pub bodies: Vec<DampedBody>,
}

/// A body, or bodies of a kind, with structural damping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DampedBody {
    /// The outer ring.
    OuterRing,
    /// The inner ring.
    InnerRing,
    /// The adapter.
    Adapter,
    /// All rollers.
    Rollers,
}

/// Motion that mass-proportional damping does not affect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DampingFrame {
    /// A roller's motion along the raceways and its spin: rolling is driven and braked by friction alone,
    /// while rattling across the clearance is damped, as by oil. Outer ring and adapter: rest.
    Rolling,
    /// The rigid motion of each body: only its vibration is damped.
    RigidMotion,
    /// Rest (what LS-DYNA's global damping does): brakes rolling.
    Absolute,
}

/// How the run starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// Static equilibrium under load, then the kinematic rolling velocities.
    Preloaded,
    /// Undeformed, kinematic velocities, the load applied at once.
    Sudden,
}

impl Default for SolverScene {
    fn default() -> Self {
        Self {
            duration_ms: 30.0,
            time_step_factor: 0.98,
            hourglass_scale: 1.0,
            mass_damping_per_s: 0.0,
            damping_frame: DampingFrame::Rolling,
            stiffness_damping_ns: 0.0,
            structural_damping: Some(StructuralDampingScene::default()),
            start: Start::Preloaded,
        }
    }
}

impl Default for StructuralDampingScene {
    fn default() -> Self {
        Self {
            ratio_percent: 2.0,
            from_khz: 2.0,
            to_khz: 40.0,
            branches: 1,
            bodies: vec![DampedBody::OuterRing, DampedBody::InnerRing, DampedBody::Adapter],
        }
    }
}
