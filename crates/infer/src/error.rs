//! The error type of this crate.

/// Everything that an inference refuses.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A prior has impossible numbers.
    #[error("prior {field} = {value}: {expected}")]
    Prior {
        /// Which number of the prior.
        field: &'static str,
        /// Value.
        value: f64,
        /// Allowed values.
        expected: &'static str,
    },

    /// Fewer runs than an emulator can be fitted to.
    #[error(
        "{points} different points in {dimensions} dimensions: an emulator needs at least {least}; \
         make more runs, or hold some fields"
    )]
    FewRuns {
        /// Different points among the runs.
        points: usize,
        /// Dimensions of a point.
        dimensions: usize,
        /// Points that are needed.
        least: usize,
    },

    /// Rows or columns that do not fit together.
    #[error("{what} {number} has {found} numbers, expected {expected}")]
    Shape {
        /// Argument of the wrong length.
        what: &'static str,
        /// Which of them, from 0.
        number: usize,
        /// Its length.
        found: usize,
        /// The length that the others have.
        expected: usize,
    },

    /// A number that is not finite, or outside its range.
    #[error("{what} {number} of row {row} = {value}: {expected}")]
    Value {
        /// Name of the number.
        what: String,
        /// Its column, from 0.
        number: usize,
        /// Its row, from 0.
        row: usize,
        /// The number.
        value: f64,
        /// Allowed values.
        expected: &'static str,
    },

    /// An invalid target.
    #[error("target {number} of output `{output}`: {why}")]
    Target {
        /// Which target, from 0.
        number: usize,
        /// Name of the output, or its number where there is none such.
        output: String,
        /// Problem and remedy.
        why: String,
    },

    /// A count or share outside its range.
    #[error("{option} = {value}: must be {expected}")]
    Option {
        /// Name of the option.
        option: &'static str,
        /// Value.
        value: f64,
        /// Allowed values.
        expected: &'static str,
    },

    /// A factorisation failed.
    #[error(
        "{0}: the matrix cannot be factorised; are there points or curves with numbers that are not finite?"
    )]
    Factorisation(&'static str),
}
