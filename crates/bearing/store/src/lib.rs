//! The folder of a run: its scene, provenance, sampled channels, mesh and frames, written as a run goes on and
//! read again, also after a kill.
//!
//! It is a crate because analyses and pages read runs, and link nothing of what makes them.
//!
//! [`campaign`] reads the file that plans many runs; mistakes in it are shown as those of a scene.
//!
//! The head of [`run_dir`] lists all files. [`run_dir::Run::read`] reads scene, provenance and sampled
//! channels of a run; [`mesh_file::RunMesh`] its mesh, [`frames`] the positions of nodes about the defect.
//!
//! ```no_run
//! let run = stribeck_store::run_dir::Run::read("runs/singh2014")?;
//! println!("{} samples of {:?}", run.trace.len(), run.trace.names());
//! # Ok::<(), stribeck_store::Error>(())
//! ```

pub mod run_dir;
pub mod run_info;

pub mod frames;
pub mod mesh_file;
pub mod trace;

pub mod campaign;

mod error;

pub use error::Error;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
