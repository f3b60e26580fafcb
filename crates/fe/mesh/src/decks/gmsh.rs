//! Gmsh files.

mod elements;
mod read;
mod source;
mod write;

pub(super) use read::read;
pub(super) use write::write;

/// Types of elements: three nodes, four nodes.
const TRIANGLE: i64 = 2;
const QUADRILATERAL: i64 = 3;
