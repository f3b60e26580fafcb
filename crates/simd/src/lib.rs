//! What the hot loops of the solver and of contact are written with.
//!
//! | Question | File |
//! |---|---|
//! | How is a kernel written once and compiled for every instruction set? | `lanes.rs` |
//! | Where do values lie so that eight of them fill a line of cache? | `field.rs` |
//! | How is work shared out over threads? | `threads.rs` |

pub mod field;
pub mod lanes;
pub mod threads;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
