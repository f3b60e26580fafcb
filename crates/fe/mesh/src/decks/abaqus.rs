//! Abaqus input files: as Abaqus/CAE, CalculiX, Gmsh and meshio write them.

mod cards;
mod elements;
mod read;
mod scope;
mod write;

pub(super) use read::read;
pub(super) use write::{write, write_model};
