//! The error type of this crate.

use std::path::PathBuf;

/// Everything that can go wrong in an FMU.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file with the bearing cannot be read.
    #[error("the FMU has no bearing: cannot read `{}`: {error}", path.display())]
    Resource {
        /// The file.
        path: PathBuf,
        /// Why not.
        error: std::io::Error,
    },

    /// Bytes that are not what they should be.
    #[error("not a bearing of this FMU, or a state of it: {0}")]
    Content(postcard::Error),

    /// A step before the initialisation.
    #[error("the bearing has not been started: leave the initialization mode first")]
    NotStarted,

    /// The bearing refuses, or has gone wrong.
    #[error(transparent)]
    Bearing(#[from] stribeck_reduced::error::Error),
}
