//! Several processes that run one model together, over MPI: what the solver asks of
//! [`Ranks`](stribeck_solver::ranks::Ranks).
//!
//! Without the feature `mpi` the crate is empty.

#![cfg(feature = "mpi")]

mod world;

pub use world::{Mpi, World};
