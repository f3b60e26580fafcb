//! The theory of rolling bearings over plain numbers: speeds, loads, films and stiffness of a bearing between
//! rigid rings, its duty, and a catalogue of bearings.
//!
//! Nothing here reads files or knows scenes, so that it serves programs of any kind, and pages: it compiles for
//! `wasm32-unknown-unknown`.
//!
//! ```
//! use stribeck_theory::{catalogue::CatalogueBearing, kinematics::Kinematics, bearing::Dimensions};
//!
//! let orders = CatalogueBearing::parse("6205")?.orders()?;
//! assert!((orders.bpfo - 3.5848).abs() < 2e-3);
//!
//! let bearing = Dimensions { outer_race_mm: 200.0, inner_race_mm: 163.96, roller_mm: 18.0, rollers: 24 };
//! let kinematics = Kinematics::new(bearing, 500.0);
//! assert!((kinematics.bpfo_hz - 90.11).abs() < 0.01);
//! # Ok::<(), String>(())
//! ```
//!
//! # Where to look
//!
//! | question | module |
//! |---|---|
//! | Which bearings are there, and which frequencies have their defects? | [`catalogue`] |
//! | How fast do rollers and cage turn, and when do rollers cross a spall? | [`kinematics`] |
//! | How do speed and load vary over time? | [`duty`] |
//! | What does a fit take of the clearance? | [`fits`] |
//! | How is the load shared, and how stiff is the bearing? | [`static_load`], [`ring_stiffness`] |
//! | How far do raceways approach each other? | [`contact_law`], [`line_contact`], [`point_contact`] |
//! | How thick is the oil, how much may a bearing carry? | [`lubrication`], [`load_rating`] |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod bearing;
pub mod catalogue;
pub mod duty;
pub mod fits;
pub mod kinematics;
pub mod material;

pub mod contact_law;
pub mod line_contact;
pub mod load_rating;
pub mod lubrication;
pub mod point_contact;
pub mod ring_stiffness;
pub mod static_load;

mod error;

pub use error::Error;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
