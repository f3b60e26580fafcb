//! Scenes of rolling element bearings: the input of a simulation, read strictly, and in SI.
//!
//! It is a crate because input is read in many places that neither mesh nor solve nor open the folder of a
//! run.
//!
//! # A scene: its speeds and its load distribution
//!
//! A scene is a text in [RON](https://docs.rs/ron); fields that it omits have defaults. Numbers carry their
//! unit in their name there, and are SI in a [`ResolvedScene`](resolved::ResolvedScene).
//!
//! ```
//! use stribeck_scene::Scene;
//!
//! let text = "(bearing: (rollers: 20), operation: (load_n: 30000, speed_rpm: 1200))";
//! let scene = Scene::parse(text, "my bearing")?;
//! let resolved = scene.resolve();
//! assert_eq!(resolved.rollers, 20);
//!
//! let kinematics = scene.kinematics();
//! println!("rollers pass the outer raceway at {:.1} Hz", kinematics.bpfo_hz);
//! assert!((kinematics.bpfo_hz - 180.2).abs() < 0.1);
//!
//! let load = resolved.static_load()?;
//! println!("{} rollers carry, one {:.0} N", load.loaded_rollers(), load.max_roller_n());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Impossible values are refused with their place and the allowed range:
//!
//! ```
//! # use stribeck_scene::Scene;
//! let message = Scene::parse("(bearing: (rolers: 20))", "my bearing").unwrap_err().to_string();
//! assert!(message.contains("rollers"));
//! ```
//!
//! # Where to look
//!
//! | question | module |
//! |---|---|
//! | What is a field, and how is one declared? | [`field`] |
//! | Which fields has a scene? | [`scene`], in the table of [`fields`] |
//! | What is checked when a scene is read? | [`scene_file`] |
//! | Which spalls are cut into the mesh? | [`Scene::grooves`] |
//! | What is that in SI? | [`resolved`]; surfaces that are not round [`deviation`] |
//! | Which speeds, tones and loads follow from it? | [`Scene::kinematics`], [`ResolvedScene::static_load`](resolved::ResolvedScene::static_load) |
//! | How do speed and load vary over time? | [`duty`] |
//! | What is drawn when a scene is run from many starts? | [`ensemble`], [`dice`] |

pub mod advice;
pub mod catalogue;
mod contact_formula;
pub mod dice;
pub mod duty;
pub mod ensemble;
mod faults;
pub mod field;
pub mod fields;
pub mod mesh_text;
mod narrow;
pub mod paper;
mod quality;
mod reading;
pub mod resolved;
pub mod scene;
pub mod scene_file;
mod theory;

pub use scene::{Scene, deviation, housing, machine};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
