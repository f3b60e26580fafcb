//! The samples of a record: whether they are sound, how strong they are, and how they change with time.

pub mod alarm;
pub(crate) mod bands;
pub mod course;
pub mod enhanced;
pub(crate) mod pass;
pub mod quality;
pub mod screening;
pub mod unit;
pub mod velocity;
pub mod zone;
