//! The numbers of a rolling element bearing in a few modes: plain data in SI, which `stribeck-simulation`
//! makes from finite elements and this crate steps in time.
//!
//! All lengths are in metres, forces in newtons, angles in radians, counter-clockwise positive; modes are
//! normalised to unit modal mass, so that their coordinates have the unit √kg m and their shapes 1/√kg.
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | What does one mesh under one load become? | `reduction.rs`; the seat of its outer ring, `seat.rs` |
//! | What does a scene add? | `parameters.rs` |
//! | How much do bodies give way beside a contact? | `compliance.rs` |
//! | Which facets of an outline are walls? | `outline.rs` |

pub mod reduction;
pub mod seat;

pub mod compliance;
pub mod outline;
pub mod parameters;

use serde::{Deserialize, Serialize};

pub use parameters::Parameters;
pub use reduction::Reduction;
pub use seat::Seat;

/// A bearing in a few modes: all that its steps depend on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModalBearing {
    /// The reduced mesh, with the tables of a step rounded to single precision.
    pub reduction: Reduction,
    /// Numbers of the scene.
    pub parameters: Parameters,
}

/// Modes and rollers are padded with zeros to groups of as many: the longest vector of any processor.
pub const GROUP: usize = 8;

/// Tangential over normal stiffness of contact, as in the full model (THEORY §4.3).
pub const STICKING: f64 = 0.8;

/// Local contact problems are solved up to this multiple of the largest roller load between rigid rings.
pub const OVERLOAD: f64 = 4.0;
