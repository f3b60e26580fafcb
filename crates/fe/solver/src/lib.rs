//! Explicit dynamics of plane-strain finite elements, and the static equilibrium to start from.
//!
//! It is a crate because bodies without contact need nothing else.
//!
//! The crate is about bodies, not machines: a [`Model`] is a mesh with materials, elastic or rigid bodies,
//! and the motion of nodes. [`Dynamics`] lays it out in memory and takes steps; anything else that pushes on
//! nodes (loads, contact) is a [`Force`], given to each step as a list. A model pays only for the forces in
//! its list.
//!
//! # Conventions
//!
//! SI units: m, kg, s, N, J, Pa, rad. Angles and spins are counter-clockwise positive. Forces and masses are
//! those of the whole thickness. Strains and stresses are of plane strain, tension positive.
//!
//! Time is leapfrog: positions at `time`, velocities half a step earlier. Energies that balance exactly
//! belong to the positions before the last step ([`Dynamics::kinetic_energy`]).
//!
//! Meshes number *nodes*; fields of the state are arrays over *slots*, places in memory
//! ([`layout::Layout::slot_of_node`]). Forces push on slots.
//!
//! # Example: a bar struck at one end
//!
//! A steel bar of half a metre is hit at its left end for ten microseconds. The stress wave arrives at the
//! other, free end after L/c and doubles the particle velocity there.
//!
//! ```
//! use stribeck_mesh::{Mesh, Rectangle};
//! use stribeck_solver::{Dynamics, Elastic, Force, Model, NodeMotion, force::NodalLoad};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let length = 0.5;
//! let bar = Rectangle { x0: 0.0, y0: 0.0, width: length, height: 0.01, columns: 250, rows: 5 }.part()?;
//! let mut mesh = Mesh::new();
//! let placed = mesh.add("bar", &bar);
//! let steel = Elastic::new(208e9, 0.3, 7800.0)?;
//! let mut model = Model::new(mesh, steel, 0.02)?;
//! // Its sides are held, so that the wave runs at the speed √((λ + 2µ)/ρ) of a confined bar.
//! model.motion.fill(NodeMotion::HeldY);
//!
//! let struck = &placed.surface("left").ok_or("no left side")?.nodes;
//! let mut loaded = vec![false; model.mesh.x.len()];
//! struck.iter().for_each(|&n| loaded[n as usize] = true);
//! let mut dynamics = Dynamics::new(&model, &loaded, 1)?;
//! let critical = dynamics.critical_time_step(&[], 0.0);
//! dynamics.set_time_step(0.9 * critical.time_step)?;
//!
//! // 2 kN over the end, a half at each of its corners.
//! let slot = |n: u32| dynamics.layout().slot_of_node[n as usize];
//! let share = |i: usize| if i == 0 || i + 1 == struck.len() { 0.5 } else { 1.0 };
//! let push = |(i, &n): (usize, &u32)| (slot(n), 2000.0 * share(i) / 5.0, 0.0);
//! let mut blow = NodalLoad::new(struck.iter().enumerate().map(push).collect());
//!
//! let far_end = slot(placed.surface("right").ok_or("no right side")?.nodes[0]) as usize;
//! let mut arrival = None;
//! let mut fastest = 0.0_f64;
//! while dynamics.state.time < 1.5 * length / steel.dilatational_speed() {
//!     if dynamics.state.time < 10e-6 {
//!         dynamics.step(&mut [&mut blow as &mut dyn Force]);
//!     } else {
//!         dynamics.step(&mut []);
//!     }
//!     let speed = dynamics.state.vx[far_end];
//!     fastest = fastest.max(speed);
//!     // v = F/(ρ c A) in the wave; its front passes the middle of its rise when the doubled end has reached v.
//!     let wave = 2000.0 / (steel.density() * steel.dilatational_speed() * 0.01 * 0.02);
//!     if arrival.is_none() && speed > wave {
//!         arrival = Some(dynamics.state.time);
//!     }
//! }
//! let expected = length / steel.dilatational_speed();
//! let arrival = arrival.ok_or("the wave never arrived")?;
//! assert!((arrival / expected - 1.0).abs() < 0.01, "{arrival} s, expected {expected} s");
//! # Ok(())
//! # }
//! ```
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | What does a user give? | `model.rs`, `material.rs` |
//! | What changes in time? | `state.rs`; all of it in one piece, to continue a run from, `snapshot.rs` |
//! | What pushes on nodes? | `force.rs` |
//! | What force does an element make? | `element.rs`; all elements at any positions, `internal_forces.rs` |
//! | What is one step? | `dynamics.rs` |
//! | How are vibrations damped? | `damping.rs` by mass; by stiffness `kernel/stiffness_damping.rs`; over a band of frequencies `structural_damping.rs`, in motion `springs.rs` |
//! | How do bodies move that do not deform? | `rigid.rs` |
//! | How is equilibrium found? | `statics.rs`, `statics/`, under the feature `statics` |
//! | How stressed is an element? | `stress.rs` |
//! | How long may a step be? | `critical.rs` |
//! | What energies are there? | `energies.rs` |
//! | How distorted are the elements? | `distortion.rs` |
//! | What is refused? | `error.rs` |
//! | Which loops do the work of a step, and how do nodes lie in memory for them? | `kernel.rs`, `kernel/` |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod material;
pub mod model;

pub mod force;
pub mod snapshot;
pub mod state;

pub mod element;
mod internal_forces;

pub mod damping;
pub mod dynamics;
pub mod rigid;
pub mod springs;
pub mod structural_damping;

pub mod critical;
#[cfg(feature = "statics")]
pub mod statics;
pub mod stress;

pub mod distortion;
pub mod energies;

mod error;

mod kernel;

pub use dynamics::Dynamics;
pub use energies::Velocities;
pub use error::Error;
pub use force::Force;
pub use kernel::layout;
pub use material::Elastic;
pub use model::{Behaviour, Model, NodeMotion};
pub use stress::Stress;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
