//! Time integration: duration, time step, damping, and how a run starts.

use crate::{group, words};

/// Longest run that a scene may ask for [s].
pub const LONGEST_RUN_S: f64 = 3600.0;

/// Longest run [ms].
pub(super) const LONGEST_MS: f64 = 1e3 * LONGEST_RUN_S;

group! {
    /// Time integration.
    pub struct SolverScene {
        /// Simulated time [ms].
        pub duration_ms: f64 = 30.0, positive(LONGEST_MS);
        /// Time step over the critical one [-]; above 1 a run diverges, and the guards stop it.
        pub time_step_factor: f64 = 0.98, positive(1.5);
        /// Hourglass stiffness as a multiple of the exact bending stiffness of a square [-].
        pub hourglass_scale: f64 = 1.0, positive(10.0);
        /// Mass-proportional damping [1/s]; 2·ζ·ω for a damping ratio ζ at ω.
        pub mass_damping_per_s: f64 = 0.0, within(0.0, 1e6);
        /// Motion relative to which the mass damping acts.
        pub damping_frame: DampingFrame = DampingFrame::Rolling;
        /// Stiffness-proportional damping β [ns]; 2·ζ/ω for a damping ratio ζ at ω. Each nanosecond costs
        /// time step.
        pub stiffness_damping_ns: f64 = 0.0, within(0.0, 1e4), before("0.0");
        /// Damping of chosen bodies at nearly one ratio over a band of frequencies.
        pub structural_damping: Option<StructuralDampingScene> =
            Some(StructuralDampingScene::default()), before("None");
        /// How the run starts.
        pub start: Start = Start::Preloaded;
    }
}

group! {
    /// Structural damping: the loss of a body's material and joints, which hardly depends on frequency. It
    /// costs about 5 % of the time step for 2 %.
    pub struct StructuralDampingScene {
        /// Damping ratio in the band, a share of critical [%].
        pub ratio_percent: f64 = 2.0, positive(10.0);
        /// Lower end of the band [kHz]; below it the ratio falls in proportion to the frequency.
        pub from_khz: f64 = 2.0, positive(1e4);
        /// Upper end of the band [kHz]; above it the ratio falls as one over the frequency.
        pub to_khz: f64 = 40.0, positive(1e5);
        /// Maxwell branches beside every element: one, with which the ratio is within −49 and +25 % over a
        /// factor of 20 in frequency. Scenes with more are not computed.
        pub branches: usize = 1, within(1.0, 1.0);
        /// Which bodies.
        pub bodies: Vec<DampedBody> = vec![DampedBody::OuterRing, DampedBody::InnerRing, DampedBody::Adapter];
    }
}

words! {
    /// A body, or bodies of a kind, with structural damping.
    pub enum DampedBody: Copy, Eq {
        /// The outer ring.
        OuterRing = "outer_ring",
        /// The inner ring.
        InnerRing = "inner_ring",
        /// The adapter.
        Adapter = "adapter",
        /// All rollers.
        Rollers = "rollers",
    }
}

words! {
    /// Motion that mass-proportional damping does not affect.
    pub enum DampingFrame: Copy, Eq {
        /// A roller's motion along the raceways and its spin: rolling is driven and braked by friction alone,
        /// while rattling across the clearance is damped, as by oil. Outer ring and adapter: rest.
        Rolling = "rolling",
        /// As `rolling`, but rollers are not damped at all: outer ring and adapter alone, relative to rest.
        Standing = "standing",
        /// The rigid motion of each body: only its vibration is damped.
        RigidMotion = "rigid_motion",
        /// Rest (what LS-DYNA's global damping does): brakes rolling.
        Absolute = "absolute",
    }
}

words! {
    /// How the run starts.
    pub enum Start: Copy, Eq {
        /// Static equilibrium under load, then the kinematic rolling velocities.
        Preloaded = "preloaded",
        /// Undeformed, kinematic velocities, the load applied at once.
        Sudden = "sudden",
    }
}
