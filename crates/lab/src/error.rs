//! The error type of this crate.

/// Everything that can go wrong in a lab.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The numbers of a bearing in the page cannot be read.
    #[error(
        "the numbers of the bearing cannot be read ({0}): the file is damaged, or of another \
         version. Make it anew with `stribeck lab`"
    )]
    Content(#[from] postcard::Error),
    /// There is no such handle.
    #[error("handle no. {0} is unknown")]
    UnknownHandle(usize),
    /// A handle beyond its range.
    #[error("{name} = {value} {unit}: must be between {least} and {most}")]
    Range {
        /// The handle in words.
        name: &'static str,
        /// The requested value.
        value: f64,
        /// Unit.
        unit: &'static str,
        /// Least value.
        least: f64,
        /// Largest value.
        most: f64,
    },
    /// A spall that the raceway has no room for.
    #[error("the spall: {0}")]
    Spall(&'static str),
    /// The reduced bearing cannot be made or has no equilibrium.
    #[error("{0}")]
    Bearing(#[from] stribeck_reduced::error::Error),
    /// The run has diverged.
    #[error("{0}")]
    Diverged(String),
    /// A scene cannot be reduced.
    #[cfg(not(target_arch = "wasm32"))]
    #[error("{0}")]
    Simulation(#[from] stribeck_simulation::Error),
    /// A scene that a lab cannot show.
    #[cfg(not(target_arch = "wasm32"))]
    #[error("{0}")]
    Unsuited(String),
}
