//! What a user writes and what a run leaves: scenes of rolling element bearings, their kinematics, run folders and traces.
//!
//! Nothing here meshes or simulates, so that whoever only reads a run links neither.

pub mod error;
pub mod frames;
pub mod kinematics;
pub mod run_dir;
pub mod run_info;
pub mod scene;
pub mod scene_file;
pub mod static_load;
pub mod trace;

pub use error::Error;
pub use scene::Scene;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
