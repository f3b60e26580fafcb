//! The reduced bearing as an FMU.

pub mod error;
pub mod session;
