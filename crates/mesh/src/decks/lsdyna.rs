//! LS-DYNA keyword files: as LS-PrePost and others write them.

mod columns;
mod read;
mod sets;
mod write;

pub(super) use read::read;
pub(super) use write::{write, write_model};
