//! The hot loop: one evaluation of a pass, from facets that may touch to forces on nodes.
//!
//! [`evaluate`] goes through the facets. Vectors of points come first: [`chord_row`] and [`patch_row`] take
//! the points of one facet, [`chord_band`] a facet in each lane. [`single_points`] takes the remaining
//! points. The mathematics stands once, over any [`Number`](stribeck_simd::lanes::Number): the law in
//! [`law`], two chords in [`chord_pair`], and outside of this folder, because a search and the static preload
//! use them too, [`foot`](crate::foot), [`patch`](crate::patch) and [`polynomial`](crate::polynomial). This
//! folder uses the rest of the crate; of the rest, only [`pass`](crate::pass) and
//! [`contacts`](crate::contacts) use it.

mod chord_band;
mod chord_lanes;
mod chord_pair;
mod chord_row;
pub(crate) mod evaluate;
mod law;
pub(crate) mod nearest_chord;
mod patch_row;
mod row;
mod single_points;
