//! What can go wrong between a run directory and its report.

use std::path::PathBuf;

/// Why an analysis or a report cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The run cannot be read, or its scene has no static equilibrium.
    #[error(transparent)]
    Run(#[from] stribeck_scene::Error),
    /// A signal cannot be processed.
    #[error("a recorded signal cannot be processed: {0}")]
    Signal(#[source] stribeck_dsp::Error),
    /// A file of signals cannot be read.
    #[error(transparent)]
    File(#[from] stribeck_formats::Error),
    /// There is nothing to analyse.
    #[error("nothing to analyse: {0}")]
    NoSignal(String),
    /// A figure cannot be drawn.
    #[error("figure `{figure}` cannot be drawn: {why}")]
    Drawing {
        /// Name of the figure.
        figure: String,
        /// What the drawing library said.
        why: String,
    },
    /// The numbers cannot be written as JSON.
    #[error("summary.json cannot be made: {0}")]
    Summary(#[source] serde_json::Error),
    /// A file of the report cannot be written.
    #[error("{} cannot be written: {why}; check that the folder is writable and the disk is not full", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        why: std::io::Error,
    },
}
