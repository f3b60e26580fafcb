//! Rolling element bearings: dimensions, kinematics, defects, scenes and runs.

pub mod run_info;
pub mod scene;
pub mod trace;
