//! Files that plan many runs: a campaign varies fields of a scene.
//!
//! It is a crate because a single run needs none of it.
//!
//! Mistakes in such a file are shown as those of a scene, with line, field, allowed values and remedy.
//!
//! ```
//! use std::path::Path;
//! use stribeck_plans::campaign::Campaign;
//!
//! let text = "(name: \"loads\", variants: grid([(field: \"operation.load_n\", values: [10000, 20000])]))";
//! let campaign = Campaign::parse(text, "loads.ron", Path::new("."))?;
//! assert_eq!(campaign.name, "loads");
//! # Ok::<(), stribeck_scene::scene_file::SceneError>(())
//! ```

pub mod campaign;

mod document;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
