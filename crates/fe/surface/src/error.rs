//! Errors of this crate.

/// Errors of contact.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error("{field} = {value}: must be {allowed}")]
    OutOfRange { field: &'static str, value: f64, allowed: &'static str },
    #[error("contact pair {pair}: {reason}")]
    BadPair { pair: usize, reason: &'static str },
    #[error("contact surface `{name}`: {reason}")]
    BadSurface { name: String, reason: &'static str },
}
