//! The error type of this crate.

use std::path::PathBuf;

/// Everything that can go wrong between a scene and a finished run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error(transparent)]
    Scene(#[from] stribeck_scene::scene_file::SceneError),

    #[error(transparent)]
    Theory(#[from] stribeck_theory::Error),

    #[error(transparent)]
    Store(stribeck_store::Error),

    #[error("mesh: {0}")]
    Mesh(#[from] stribeck_mesh::Error),

    #[error("`{field}` `{file}`: {what}")]
    MeshFile { field: String, file: String, what: String },

    #[error("solver: {0}")]
    Solver(#[from] stribeck_solver::Error),

    #[error("contact: {0}")]
    Contact(#[from] stribeck_contact::Error),

    #[error(transparent)]
    System(stribeck_system::Error),

    #[error("cannot start {threads} worker threads: {source}. Try fewer with --threads")]
    Threads { threads: usize, source: std::io::Error },

    #[error("the modes of outer ring and housing cannot be found: their stiffness is no finite number")]
    NoModes,

    #[error(transparent)]
    Reduced(#[from] stribeck_reduced::error::Error),

    #[error("the run in `{}` cannot be continued: {reason}", path.display())]
    Resume { path: PathBuf, reason: String },
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
