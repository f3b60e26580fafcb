//! Rolling element bearings in a few modes: a simulated second in a few seconds.
//!
//! Outer ring and housing move in their natural modes, made from the mesh and elements of the full model by
//! `stribeck-simulation` and handed over as plain data ([`modal`]). Rollers and cage are rigid, with
//! the facets that they are meshed with. Contact is integrated exactly over these facets
//! ([`contact::penetration`]), in series with curves for the local compliance of the bodies. A program drives
//! a [`BearingInMotion`](motion::BearingInMotion) from one sampling interval to the next, and reads it in
//! between.
//!
//! It is a crate because it links neither mesher nor solver, and uses no files, threads or clock: so it runs
//! in a browser (`wasm32-unknown-unknown`) and in other programs.
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | What does a time loop drive, and what is read of it? | `motion.rs`, `motion/readings.rs` |
//! | Which numbers does a bearing consist of? | `modal.rs`, `modal/` |
//! | What is a bearing, and how does it start? | `bearing.rs`, in parts; `start.rs` |
//! | What changes in time? | `state.rs` |
//! | How is the shaft moved, and which force has it? | `shaft.rs`, `shaft/`; `housing.rs`, `frame.rs` |
//! | What is one step? | `step.rs`, a page of stages in files of `step/` |
//! | How do rings and housing move? | `modes.rs` |
//! | How do rollers press on raceways? | `contact/`, the geometry; `law/`, the forces |
//! | What do cage, seat and oil do? | `cage/`, `seat/`, `oil/` with `film_forces.rs` and `resistance.rs` |
//! | How are eight rollers taken at once? | `rollers/`, in rows of `row.rs` |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod modal;

pub mod bearing;
pub mod start;
pub mod state;

pub mod step;

mod cage;
pub mod contact;
pub mod dense;
mod drive;
mod film_forces;
mod frame;
mod housing;
mod law;
mod modes;
pub mod oil;
mod plane;
mod ragged;
mod resistance;
pub mod roller_force;
mod rollers;
mod row;
pub mod seat;
mod sensors;
mod tally;

pub mod motion;
pub use motion::readings;
pub mod shaft;

pub mod error;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
