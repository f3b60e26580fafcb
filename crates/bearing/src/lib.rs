//! Rolling element bearings: from a scene to bodies in motion, and to a run.

pub mod assembly;
pub mod checkpoint;
pub mod error;
mod frames;
mod full;
mod grading;
mod guards;
mod host;
mod housing;
pub mod own_mesh;
pub mod ranks;
pub mod recorder;
pub mod simulation;
pub mod start;
mod suspension;
pub mod time_loop;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
