//! The error type of this crate.

/// Everything that can go wrong between a scene and a finished reduced run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The full model, from which the reduced one is made, cannot be made or preloaded, or a run not be written.
    #[error(transparent)]
    Bearing(#[from] stribeck_bearing::error::Error),

    /// The bearing cannot be reduced.
    #[error(transparent)]
    Reduction(#[from] stribeck_reduction::error::Error),

    /// Oil finds no smooth surface to lie on.
    #[error("contact: {0}")]
    Surface(#[from] stribeck_surface::Error),

    /// Start positions in equilibrium cannot be found.
    #[error(
        "the reduced bearing has no equilibrium to start from: {residual_n:.2e} N are left after {iterations} iterations. Look at \
         `operation.load_n` and the clearance, take a larger `model.modes_khz`, or run `model: full`"
    )]
    NoEquilibrium {
        /// Unbalanced force [N].
        residual_n: f64,
        /// Newton iterations.
        iterations: usize,
    },
}

impl From<stribeck_scene::Error> for Error {
    fn from(error: stribeck_scene::Error) -> Self {
        Self::Bearing(error.into())
    }
}

impl From<stribeck_scene::scene_file::SceneError> for Error {
    fn from(error: stribeck_scene::scene_file::SceneError) -> Self {
        Self::Bearing(error.into())
    }
}
