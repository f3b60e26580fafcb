//! The error type of this crate.

/// Everything that an inference refuses.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error("prior {field} = {value}: {expected}")]
    Prior { field: &'static str, value: f64, expected: &'static str },

    #[error(
        "{points} different points in {dimensions} dimensions: an emulator needs at least {least}; \
         make more runs, or hold some fields"
    )]
    FewRuns { points: usize, dimensions: usize, least: usize },

    #[error("{what} {number} has {found} numbers, expected {expected}")]
    Shape { what: &'static str, number: usize, found: usize, expected: usize },

    #[error("{what} {number} of row {row} = {value}: {expected}")]
    Value { what: String, number: usize, row: usize, value: f64, expected: &'static str },

    #[error("target {number} of output `{output}`: {why}")]
    Target { number: usize, output: String, why: String },

    #[error("{option} = {value}: must be {expected}")]
    Option { option: &'static str, value: f64, expected: &'static str },

    #[error(
        "{0}: the matrix cannot be factorised; are there points or curves with numbers that are not finite?"
    )]
    Factorisation(&'static str),
}
