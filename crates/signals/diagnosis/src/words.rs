//! Conclusions, evidence and numbers in words.

pub mod beneath;
pub mod evidence;
pub mod numbers;
pub(crate) mod sentence;
