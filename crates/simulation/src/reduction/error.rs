//! The error type of this crate.

/// Everything that can go wrong between a scene and the numbers of its reduced bearing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The full model, from which the reduced one is made, cannot be made or preloaded.
    #[error(transparent)]
    Bearing(#[from] crate::bearing::error::Error),

    /// Modes cannot be found.
    #[error("solver: {0}")]
    Solver(#[from] stribeck_solver::Error),

    /// Modes cannot be turned into those of a seat that holds.
    #[error("the modes of outer ring and housing cannot be found: their stiffness is no finite number")]
    NoModes,

    /// Contact's law has impossible numbers.
    #[error("contact: {0}")]
    Contact(#[from] stribeck_surface::Error),
}

impl From<stribeck_theory::Error> for Error {
    fn from(error: stribeck_theory::Error) -> Self {
        Self::Bearing(error.into())
    }
}
