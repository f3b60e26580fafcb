//! Conclusions, evidence and numbers in words.

pub mod brief;
pub mod evidence;
pub mod numbers;
pub(crate) mod sentence;
