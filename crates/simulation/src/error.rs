//! The error type of this crate.

/// Everything that can go wrong between a scene and a finished run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene cannot be read.
    #[error(transparent)]
    Scene(#[from] stribeck_scene::scene_file::SceneError),

    /// The scene has no static load distribution.
    #[error(transparent)]
    Theory(#[from] stribeck_theory::Error),

    /// The folder of the run cannot be written or read.
    #[error(transparent)]
    Store(stribeck_store::Error),

    /// The bearing cannot be assembled or preloaded.
    #[error(transparent)]
    Bearing(crate::bearing::error::Error),

    /// The bearing cannot be reduced.
    #[error(transparent)]
    Reduction(crate::reduction::error::Error),

    /// The reduced bearing has no equilibrium.
    #[error(transparent)]
    Reduced(#[from] stribeck_reduced::error::Error),

    /// The run cannot start, continue or be written.
    #[error(transparent)]
    Run(crate::run::error::Error),
}

impl From<stribeck_store::Error> for Error {
    fn from(error: stribeck_store::Error) -> Self {
        match error {
            stribeck_store::Error::Scene(error) => error.into(),
            other => Self::Store(other),
        }
    }
}

impl From<crate::bearing::error::Error> for Error {
    fn from(error: crate::bearing::error::Error) -> Self {
        match error {
            crate::bearing::error::Error::Scene(error) => Self::Scene(error),
            crate::bearing::error::Error::Theory(error) => Self::Theory(error),
            other => Self::Bearing(other),
        }
    }
}

impl From<crate::reduction::error::Error> for Error {
    fn from(error: crate::reduction::error::Error) -> Self {
        match error {
            crate::reduction::error::Error::Bearing(error) => error.into(),
            other => Self::Reduction(other),
        }
    }
}

impl From<crate::run::error::Error> for Error {
    fn from(error: crate::run::error::Error) -> Self {
        match error {
            crate::run::error::Error::Scene(error) => Self::Scene(error),
            crate::run::error::Error::Theory(error) => Self::Theory(error),
            crate::run::error::Error::Store(error) => error.into(),
            other => Self::Run(other),
        }
    }
}

impl From<stribeck_system::Error> for Error {
    fn from(error: stribeck_system::Error) -> Self {
        Self::Bearing(error.into())
    }
}

impl From<stribeck_solver::Error> for Error {
    fn from(error: stribeck_solver::Error) -> Self {
        Self::Bearing(error.into())
    }
}
