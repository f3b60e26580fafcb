//! Errors of this crate.

/// Errors of contact.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number is outside its range.
    #[error("{field} = {value}: must be {allowed}")]
    OutOfRange {
        /// Name of the quantity.
        field: &'static str,
        /// The value given.
        value: f64,
        /// The values allowed, in words.
        allowed: &'static str,
    },
    /// Two surfaces cannot be a pair.
    #[error("contact pair {pair}: {reason}")]
    BadPair {
        /// Its place in the list.
        pair: usize,
        /// Problem.
        reason: &'static str,
    },
    /// A surface has too few facets or one of no length.
    #[error("contact surface `{name}`: {reason}")]
    BadSurface {
        /// Name of the surface.
        name: String,
        /// Problem.
        reason: &'static str,
    },
}
