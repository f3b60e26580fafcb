//! Rolling element bearings of finite elements: from a scene to bodies in equilibrium under load, set
//! rolling.

pub mod assembly;
pub mod error;
mod grading;
mod housing;
pub mod own_mesh;
pub mod start;
mod suspension;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
