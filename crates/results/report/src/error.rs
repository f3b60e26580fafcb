//! Errors while a page is made from an analysis.

use std::path::PathBuf;

/// Why a report cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error(transparent)]
    Analysis(#[from] stribeck_analysis::Error),
    #[error(transparent)]
    Diagnosis(#[from] stribeck_diagnosis::Error),
    #[error(transparent)]
    Run(#[from] stribeck_store::Error),
    #[error(transparent)]
    Theory(#[from] stribeck_theory::Error),
    #[error("figure `{figure}` cannot be drawn: {why}")]
    Drawing { figure: String, why: String },
    #[error("summary.json cannot be made: {0}")]
    Summary(#[source] serde_json::Error),
    #[error("{} cannot be written: {why}; check that the folder is writable and the disk is not \
        full", .path.display())]
    Write { path: PathBuf, why: std::io::Error },
}
