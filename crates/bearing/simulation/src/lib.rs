//! Simulates the bearing of a scene by the model that the scene names, into a run directory.
//!
//! [`simulate`] begins a run, [`resume`] and [`extend`] continue one. Both models go through the same steps
//! (`model.rs`): they are prepared, set in motion and driven by the time loop of [`run`]; channels, files and
//! guards are the same. It is a crate because it alone knows both a scene and a solver: what reads runs or
//! steps a reduced bearing links none of it.
//!
//! | Question | File |
//! |---|---|
//! | **What does a program call?** | `simulate.rs` |
//! | What must a model be able to do? | `model.rs` |
//! | How does a scene become bodies under load? | `bearing.rs`, `bearing/` |
//! | How do these become a few modes? | `reduction.rs`, `reduction/` |
//! | How does any model run: samples, ledger, guards, checkpoints? | `run.rs`, `run/` |
//! | How are finite elements driven and sampled? | `full.rs`; `full/guards.rs`, `full/recorder.rs`, `full/frames.rs` |
//! | How is the reduced bearing? | `reduced.rs`; `reduced/motion.rs`, `reduced/guards.rs` |
//! | Which nodes does `mesh.vtu` have, and where? | `mesh_file.rs` |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod bearing;
pub mod error;
pub mod full;
mod mesh_file;
mod model;
pub mod reduced;
pub mod reduction;
pub mod run;
mod simulate;

pub use error::Error;
pub use reduced::make_modes;
pub use simulate::{Watch, extend, resume, saved_until, simulate};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
