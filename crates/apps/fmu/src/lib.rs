//! The reduced bearing as an FMU: co-simulation by FMI 3.0, the shaft's motion in, forces out.
//!
//! `stribeck fmu SCENE` reduces the bearing of a scene and packs it with this library, which `cargo xtask fmu`
//! builds before it, and which the programs of a release carry. The library
//! reads the bearing from the resources of its archive and steps it by [`stribeck_reduced::shaft`]; it meshes
//! nothing.
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | What happens between two communication points? | `session.rs` |
//! | Which variables are there? | `variables.rs` of `stribeck_reduced::shaft` |
//! | What does an importer call? | `export.rs` |

pub mod session;

pub mod error;

mod export;
