//! The geometry of contact: outlines of rollers and raceways, and their penetration (THEORY §9.3).

pub mod outline;

pub mod eight_facets;
pub mod penetration;
pub(crate) mod segments;

pub(crate) mod raceway;
pub(crate) mod round;
pub(crate) mod traction;
