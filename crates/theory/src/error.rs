//! The error type of this crate.

/// Everything that can go wrong between numbers of a bearing and its loads.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number given to a function of this crate lies outside its range.
    #[error("`{field}` is {value}; allowed: {allowed}. {suggestion}")]
    Input {
        /// Name of the argument.
        field: &'static str,
        /// Its value.
        value: f64,
        /// The valid range, with unit.
        allowed: String,
        /// Remedy.
        suggestion: &'static str,
    },

    /// The rigid-ring load distribution was not found.
    #[error(
        "no static load distribution found: after {iterations} iterations {residual_n:.3e} N of {load_n:.4} \
         N are unbalanced. Check `load_n` against `thickness_mm`: the approach must stay far below the \
         roller's radius"
    )]
    NoEquilibrium {
        /// Iterations done.
        iterations: usize,
        /// Unbalanced force [N].
        residual_n: f64,
        /// Load [N].
        load_n: f64,
    },
}
