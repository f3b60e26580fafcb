//! The length of a spall, from two events a passage.

pub mod estimate;
pub mod pressed;
