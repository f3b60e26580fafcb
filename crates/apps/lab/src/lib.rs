//! A rolling element bearing that runs in the browser.
//!
//! It is a crate because the module in the page and the program that makes the page share its types.
//!
//! The crate is compiled twice. For `wasm32-unknown-unknown` it is the module in the page: an [`Engine`]
//! that steps the reduced bearing of [`stribeck_reduced`], with handles for load, speed, spall, facets and
//! more, and `exports.rs`, the names that the page calls. For the machine that makes the page it is
//! [`page`]: a scene is meshed and reduced, and its numbers, the module and the scripts in `assets/` become
//! one HTML file that needs no network.
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | What does the page hold of a bearing? | `content.rs` |
//! | What can be turned, and how far? | `handles.rs` |
//! | How does a bearing follow its handles? | `engine.rs`, `parameters.rs` |
//! | When does a run stop? | `limits.rs` |
//! | How does a raceway get another spall? | `spall.rs` |
//! | What does the page read of it? | `readings.rs` |
//! | What does the page call? | `exports.rs` |
//! | How is the page made? | `page.rs`, from `bundle.rs` and `assets/` |

pub mod content;
pub mod handles;
pub mod limits;

pub mod engine;
mod parameters;
pub mod readings;
pub mod spall;

pub mod error;

#[cfg(target_arch = "wasm32")]
mod exports;

#[cfg(not(target_arch = "wasm32"))]
mod bundle;
#[cfg(not(target_arch = "wasm32"))]
pub mod page;

pub use engine::Engine;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
