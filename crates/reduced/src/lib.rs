//! Rolling element bearings in a few modes: a simulated second in a few seconds.
//!
//! Outer ring and housing are reduced, from the very mesh and elements of the full model at its preload, to their natural
//! modes below a frequency ([`reduction`]); what contacts press in locally is a curve from a small static problem
//! ([`compliance`]). Rollers and cage are rigid, with the facets that they are meshed with; what overlaps is integrated exactly
//! ([`overlap`]). [`simulation`] runs the model that a scene asks for, into the same folder as the full one.
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | What does a program call? | `simulation.rs` |
//! | What is kept of the finite elements? | `reduction.rs`, `structure.rs`, `compliance.rs`; of an earlier run, `cache.rs` |
//! | What is a bearing in a few modes, and how does it start? | `bearing.rs`, `cage.rs`, `start.rs` |
//! | What changes in time? | `state.rs` |
//! | What is one step? | `step.rs`; eight rollers as it takes them: `block.rs`, in rows of `row.rs`; its parts: `modes.rs`, `touch.rs`, `raceway.rs`, `lift.rs`, `pocket.rs` with `polygon.rs`, `flat.rs` and `corner.rs` |
//! | What does oil do? | `oil.rs`; to rollers, modes and rings, `lift.rs` |
//! | How deep does a polygon sink into a raceway? | `overlap.rs`, seen as in `outline.rs` and, in vectors, `window.rs` |
//! | What is recorded, and what is watched? | `recorder.rs`, `guards.rs`; both in the time loop, `motion.rs` |

pub mod bearing;
pub mod start;
pub mod state;

pub mod step;

mod cage;
pub mod contact;
mod modes;
pub mod oil;
mod plane;
pub mod roller_force;
mod rollers;
pub mod seat;
mod sensors;

pub mod motion;
pub mod readings;

pub mod error;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
