//! The error type of this crate.

/// Everything that can go wrong in a lab.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error(
        "the numbers of the bearing cannot be read ({0}): the file is damaged, or of another \
         version. Make it anew with `stribeck lab`"
    )]
    Content(#[from] postcard::Error),
    #[error("handle no. {0} is unknown")]
    UnknownHandle(usize),
    #[error("{name} = {value} {unit}: must be between {least} and {most}")]
    Range { name: &'static str, value: f64, unit: &'static str, least: f64, most: f64 },
    #[error("the spall: {0}")]
    Spall(&'static str),
    #[error("{0}")]
    Bearing(#[from] stribeck_reduced::error::Error),
    #[error("{0}")]
    Diverged(String),
    #[cfg(not(target_arch = "wasm32"))]
    #[error("{0}")]
    Simulation(#[from] stribeck_simulation::Error),
    #[cfg(not(target_arch = "wasm32"))]
    #[error("{0}")]
    Unsuited(String),
}
