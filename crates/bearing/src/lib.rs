//! Rolling element bearings: from a scene to bodies in motion, and to a run.

pub mod assembly;
mod checkpoint;
pub mod error;
mod frames;
mod grading;
mod guards;
mod host;
mod recorder;
pub mod simulation;
mod start;
mod time_loop;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
