//! The error type of this crate.

/// Everything that can go wrong before a reduced bearing takes its first step.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error("contact: {0}")]
    Surface(#[from] stribeck_surface::Error),

    #[error(
        "the reduced bearing has no equilibrium to start from: {residual_n:.2e} N are left after \
         {iterations} iterations. Look at `operation.load_n` and the clearance, take a larger \
         `model.modes_khz`, or run `model: full`"
    )]
    NoEquilibrium {
        /// Unbalanced force [N].
        residual_n: f64,
        iterations: usize,
    },

    #[error(
        "the shaft cannot be moved in this housing: it is guided along its edge and carries the ring on the \
         side of the load only. Take `housing: rigid()` or `housing: springs(…)`, which stand still in every \
         direction"
    )]
    HousingNotFree,

    #[error("the shaft cannot be moved where the outer ring turns: take `operation.outer_speed_rpm: 0`")]
    OuterRingTurns,

    #[error(
        "the shaft is {um:.1} µm from the centre of its housing: at most {most_um:.0} µm, half the radius of \
         a roller. Displacements are in metres; a coupled rotor may be unstable, with communication steps that \
         are too long"
    )]
    ShaftTooFar {
        /// Displacement [µm].
        um: f64,
        /// Largest one [µm].
        most_um: f64,
    },

    #[error(
        "the communication step is {us:.3} µs: at least {least_us:.3} µs, two steps of the bearing. Take a \
         longer one, or a smaller `model.step_us` in the scene"
    )]
    ShortStep {
        /// Its length [µs].
        us: f64,
        /// Shortest one [µs].
        least_us: f64,
    },

    #[error("the state belongs to another bearing than this one")]
    OtherBearing,

    #[error(
        "the bearing diverged at {time:.6} s: take a smaller `model.step_us`, or shorter communication steps"
    )]
    Diverged {
        /// Time of the bearing [s].
        time: f64,
    },
}
