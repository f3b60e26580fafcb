//! Rollers and raceways: their outlines, how deep they sink into each other, and the forces that follow
//! (THEORY §9.3, §9.4).

pub mod outline;

pub mod eight_facets;
pub mod penetration;
pub(crate) mod segments;

pub(crate) mod force;
pub(crate) mod normal_force;
mod raceway_forces;
