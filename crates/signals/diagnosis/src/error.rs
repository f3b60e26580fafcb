//! The error type of this crate.

/// Why a record cannot be diagnosed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error("a recorded signal cannot be processed: {0}")]
    Signal(#[source] stribeck_dsp::Error),
    #[error(transparent)]
    File(#[from] stribeck_dsp::channel::Error),
    #[error("nothing to analyse: {0}")]
    NoSignal(String),
}
