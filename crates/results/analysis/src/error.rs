//! Errors of the analysis.

/// Why an analysis cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error(transparent)]
    Run(#[from] stribeck_store::Error),
    #[error(transparent)]
    Theory(#[from] stribeck_theory::Error),
    #[error(transparent)]
    Diagnosis(#[from] stribeck_diagnosis::Error),
    #[error("a recorded signal cannot be processed: {0}")]
    Signal(#[source] stribeck_dsp::Error),
    #[error(transparent)]
    File(#[from] stribeck_dsp::channel::Error),
    #[error("nothing to analyse: {0}")]
    NoSignal(String),
    #[error("summary.json cannot be made: {0}")]
    Summary(#[source] serde_json::Error),
}
