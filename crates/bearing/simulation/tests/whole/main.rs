//! Whole runs and what they begin with, one subject a module.

mod common;

mod catalogue;
mod channels;
mod defects;
mod duty;
mod film;
mod forces_across_meshes;
mod frame;
mod housings;
mod lean;
mod moving_shaft;
mod own;
mod reduced_housings;
mod reduced_oil;
mod reduced_runs;
mod resume;
mod rings;
mod runs;
