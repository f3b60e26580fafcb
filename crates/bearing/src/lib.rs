//! Rolling element bearings: dimensions, kinematics, defects, scenes and runs.

pub mod assembly;
mod checkpoint;
pub mod error;
pub mod frames;
mod grading;
mod guards;
pub mod kinematics;
mod ledger;
mod recorder;
pub mod run_dir;
pub mod run_info;
pub mod scene;
pub mod scene_file;
pub mod simulation;
mod start;
pub mod static_load;
mod time_loop;
pub mod trace;
