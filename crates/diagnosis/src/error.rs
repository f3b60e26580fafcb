//! The error type of this crate.

/// Why a record cannot be diagnosed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A signal cannot be processed.
    #[error("a recorded signal cannot be processed: {0}")]
    Signal(#[source] stribeck_dsp::Error),
    /// A file of signals cannot be read.
    #[error(transparent)]
    File(#[from] stribeck_dsp::channel::Error),
    /// There is nothing to analyse.
    #[error("nothing to analyse: {0}")]
    NoSignal(String),
}
