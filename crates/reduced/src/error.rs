//! The error type of this crate.

/// Everything that can go wrong before a reduced bearing takes its first step.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Oil finds no smooth surface to lie on.
    #[error("contact: {0}")]
    Surface(#[from] stribeck_surface::Error),

    /// Start positions in equilibrium cannot be found.
    #[error(
        "the reduced bearing has no equilibrium to start from: {residual_n:.2e} N are left after \
         {iterations} iterations. Look at \
         `operation.load_n` and the clearance, take a larger `model.modes_khz`, or run `model: full`"
    )]
    NoEquilibrium {
        /// Unbalanced force [N].
        residual_n: f64,
        /// Newton iterations.
        iterations: usize,
    },
}
