//! Errors of the analysis.

/// Why an analysis cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The run cannot be read, or its scene has no static equilibrium.
    #[error(transparent)]
    Run(#[from] stribeck_store::Error),
    /// The loads of the scene cannot be found.
    #[error(transparent)]
    Theory(#[from] stribeck_theory::Error),
    /// The leading signal cannot be diagnosed.
    #[error(transparent)]
    Diagnosis(#[from] stribeck_diagnosis::Error),
    /// A signal cannot be processed.
    #[error("a recorded signal cannot be processed: {0}")]
    Signal(#[source] stribeck_dsp::Error),
    /// A file of signals cannot be read.
    #[error(transparent)]
    File(#[from] stribeck_dsp::channel::Error),
    /// There is nothing to analyse.
    #[error("nothing to analyse: {0}")]
    NoSignal(String),
    /// The summaries of an ensemble cannot be merged.
    #[error("summary.json cannot be made: {0}")]
    Summary(#[source] serde_json::Error),
}
