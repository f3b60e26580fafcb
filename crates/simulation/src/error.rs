//! The error type of this crate.

use std::path::PathBuf;

/// Everything that can go wrong between a scene and a finished run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene cannot be read, or is impossible.
    #[error(transparent)]
    Scene(#[from] stribeck_scene::scene_file::SceneError),

    /// The scene has no static load distribution.
    #[error(transparent)]
    Theory(#[from] stribeck_theory::Error),

    /// The folder of the run cannot be written or read.
    #[error(transparent)]
    Store(stribeck_store::Error),

    /// The bodies cannot be meshed.
    #[error("mesh: {0}")]
    Mesh(#[from] stribeck_mesh::Error),

    /// The file of a housing or a ring is not one that the bearing fits.
    #[error("`{field}` `{file}`: {what}")]
    MeshFile {
        /// The field that names it.
        field: String,
        /// Its name in the scene.
        file: String,
        /// Problem, and the names that exist.
        what: String,
    },

    /// The model cannot be solved, or its modes cannot be found.
    #[error("solver: {0}")]
    Solver(#[from] stribeck_solver::Error),

    /// Contact cannot be set up.
    #[error("contact: {0}")]
    Contact(#[from] stribeck_contact::Error),

    /// The bodies cannot be set in motion or take steps.
    #[error(transparent)]
    System(stribeck_system::Error),

    /// The operating system provides no threads.
    #[error("cannot start {threads} worker threads: {source}. Try fewer with --threads")]
    Threads {
        /// Number of threads requested.
        threads: usize,
        /// The system's answer.
        source: std::io::Error,
    },

    /// Modes cannot be turned into those of a seat that holds.
    #[error("the modes of outer ring and housing cannot be found: their stiffness is no finite number")]
    NoModes,

    /// The reduced bearing has no equilibrium.
    #[error(transparent)]
    Reduced(#[from] stribeck_reduced::error::Error),

    /// A run cannot be continued.
    #[error("the run in `{}` cannot be continued: {reason}", path.display())]
    Resume {
        /// The folder of the run.
        path: PathBuf,
        /// Why, and what to try.
        reason: String,
    },
}

impl From<stribeck_store::Error> for Error {
    fn from(error: stribeck_store::Error) -> Self {
        match error {
            stribeck_store::Error::Scene(error) => error.into(),
            other => Self::Store(other),
        }
    }
}

impl From<stribeck_system::Error> for Error {
    fn from(error: stribeck_system::Error) -> Self {
        match error {
            stribeck_system::Error::Threads { threads, source } => Self::Threads { threads, source },
            other => Self::System(other),
        }
    }
}
