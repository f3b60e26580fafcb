//! Several processes that run one model together, over MPI: the solver's trait
//! [`Ranks`](stribeck_solver::ranks::Ranks).
//!
//! Without the feature `mpi` the crate is empty.

#![cfg(feature = "mpi")]

mod world;

pub use world::{Mpi, World};
