//! Rolling element bearings in a few modes.
pub mod bearing;
pub mod compliance;
pub mod error;
pub mod lanczos;
pub mod overlap;
pub mod recorder;
pub mod reduction;
pub mod run;
pub mod start;
pub mod state;
pub mod step;
