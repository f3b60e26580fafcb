//! The error type of this crate.

/// Everything that can go wrong between numbers of a bearing and its loads.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error("`{field}` is {value}; allowed: {allowed}. {suggestion}")]
    Input { field: &'static str, value: f64, allowed: String, suggestion: &'static str },

    #[error(
        "no static load distribution found: after {iterations} iterations {residual_n:.3e} N of {load_n:.4} \
         N are unbalanced. Check `load_n` against `thickness_mm`: the approach must stay far below the \
         roller's radius"
    )]
    NoEquilibrium {
        iterations: usize,
        /// Unbalanced force [N].
        residual_n: f64,
        /// Load [N].
        load_n: f64,
    },
}
