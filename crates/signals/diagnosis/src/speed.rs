//! The speed of the shaft: given, measured by a tachometer, or found in the record.

pub mod angular;
pub(crate) mod by_verdict;
pub(crate) mod estimate;
pub(crate) mod half_speed;
pub mod ridge;
pub(crate) mod settled;
pub(crate) mod shaft;
pub mod tacho;
pub mod varying;
