//! The error type of this crate.

use std::path::PathBuf;

/// Why a run cannot start, continue or be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene cannot be read, or the folder of the run cannot be read or written.
    #[error(transparent)]
    Scene(#[from] stribeck_scene::scene_file::SceneError),

    /// The scene has no static load distribution.
    #[error(transparent)]
    Theory(#[from] stribeck_theory::Error),

    /// The folder of the run cannot be written or read.
    #[error(transparent)]
    Store(#[from] stribeck_store::Error),

    /// The bodies cannot take steps.
    #[error("{0}")]
    System(#[from] stribeck_system::Error),

    /// A run cannot be continued.
    #[error("the run in `{}` cannot be continued: {reason}", path.display())]
    Resume {
        /// The folder of the run.
        path: PathBuf,
        /// Why, and what to try.
        reason: String,
    },
}
