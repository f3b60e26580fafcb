//! Simulates the bearing of a scene by the model that the scene names, into a run directory.
//!
//! [`simulate`] begins a run, [`resume`] and [`extend`] continue one. Both models go through the same steps
//! (`model.rs`): they are prepared, set in motion and driven by the time loop of [`stribeck_run`]; channels,
//! files and guards are the same.
//!
//! | Question | File |
//! |---|---|
//! | **What does a program call?** | `simulate.rs` |
//! | What must a model be able to do? | `model.rs` |
//! | How are finite elements driven and sampled? | `full.rs`; `full/guards.rs`, `full/recorder.rs`, `full/frames.rs` |
//! | How is the reduced bearing? | `reduced.rs`; `reduced/motion.rs`, `reduced/guards.rs` |
//! | Which nodes does `mesh.vtu` have, and where? | `mesh_file.rs` |

pub mod error;
pub mod full;
mod mesh_file;
mod model;
pub mod reduced;
mod simulate;

pub use error::Error;
pub use reduced::make_modes;
pub use simulate::{Watch, extend, follow, resume, saved_until, simulate};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
