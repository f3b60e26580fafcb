//! Rolling element bearings: dimensions, kinematics, defects, scenes and runs.

pub mod assembly;
pub mod error;
mod grading;
pub mod kinematics;
mod recorder;
pub mod run_dir;
pub mod run_info;
pub mod scene;
pub mod scene_file;
pub mod simulation;
mod start;
pub mod static_load;
pub mod trace;
