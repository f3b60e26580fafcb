//! Errors while a page is made from an analysis.

use std::path::PathBuf;

/// Why a report cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The run cannot be analysed.
    #[error(transparent)]
    Analysis(#[from] stribeck_analysis::Error),
    /// A record cannot be diagnosed.
    #[error(transparent)]
    Diagnosis(#[from] stribeck_diagnosis::Error),
    /// The run cannot be read, or a file of its folder cannot be written.
    #[error(transparent)]
    Run(#[from] stribeck_store::Error),
    /// The loads of the scene cannot be found.
    #[error(transparent)]
    Theory(#[from] stribeck_theory::Error),
    /// A figure cannot be drawn.
    #[error("figure `{figure}` cannot be drawn: {why}")]
    Drawing {
        /// Name of the figure.
        figure: String,
        /// Message of the drawing library.
        why: String,
    },
    /// The numbers cannot be written as JSON.
    #[error("summary.json cannot be made: {0}")]
    Summary(#[source] serde_json::Error),
    /// A file of the report cannot be written.
    #[error("{} cannot be written: {why}; check that the folder is writable and the disk is not \
        full", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Message of the operating system.
        why: std::io::Error,
    },
}
