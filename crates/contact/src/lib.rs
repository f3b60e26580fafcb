//! Contact between oriented surfaces: search, closest-point projection, penalty, damping and Coulomb friction.
//!
//! To the solver, contact is one more force on nodes: [`Contacts`] implements [`Force`](stribeck_solver::Force).
//! A [`Surface`] is a boundary polyline of a body, a [`PairSpec`] says which two may touch, by which [`Law`], and where
//! the law acts ([`Method`]): at nodes, or at points on every facet. Each pair is evaluated in two passes of half the
//! stiffness, the points of either surface against the facets of the other.
//!
//! # Conventions
//!
//! SI units. Along a surface the solid lies on the left and the outward normal points to the right. A gap [m] is a
//! signed distance: positive apart, negative in penetration. Stiffness and damping are per area: pressure a metre of
//! penetration [Pa/m], and a metre a second of approach [Pa s/m]. The resultant of a pair is the force on its *first*
//! surface's body.
//!
//! # Example: two blocks collide
//!
//! A block at 2 m/s hits an equal one at rest. The compression wave runs to the far end of each and back, so they part
//! after 2L/c; the momentum goes over whole.
//!
//! ```
//! use stribeck_contact::{Contacts, Law, Method, PairSpec, Sides, Surface};
//! use stribeck_mesh::{Mesh, Rectangle};
//! use stribeck_solver::{Dynamics, Elastic, Model, Motion};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (length, height, thickness, columns) = (0.1, 0.01, 0.02, 100);
//! let block = Rectangle { x0: 0.0, y0: 0.0, width: length, height, columns, rows: 10 }.part()?;
//! let mut mesh = Mesh::new();
//! let moving = mesh.add("moving block", &block.translated(-length - 1e-6, 0.0));
//! let resting = mesh.add("resting block", &block);
//! let steel = Elastic::new(208e9, 0.3, 7800.0)?;
//! let mut model = Model::new(mesh, steel, thickness)?;
//! // Sides held: plane waves, whose speed is √((λ + 2µ)/ρ).
//! model.motion.fill(Motion::HeldY);
//!
//! // Contact pushes on the two faces that meet.
//! let faces = [moving.surface("right"), resting.surface("left")].map(|face| face.expect("a rectangle has sides"));
//! let mut loaded = vec![false; model.mesh.x.len()];
//! faces.iter().flat_map(|face| &face.nodes).for_each(|&n| loaded[n as usize] = true);
//! let mut dynamics = Dynamics::new(&model, &loaded, 1)?;
//! let slots = |nodes: &[u32]| nodes.iter().map(|&n| dynamics.layout().slot_of_node[n as usize]).collect::<Vec<_>>();
//! let (x, y) = (&dynamics.state.x, &dynamics.state.y);
//! let surfaces = vec![
//!     Surface::new("right face", slots(&faces[0].nodes), false, x, y)?,
//!     Surface::new("left face", slots(&faces[1].nodes), false, x, y)?,
//! ];
//! // As stiff as one cell.
//! let law = Law::penalty(steel.plane_strain_modulus() * columns as f64 / length)?;
//! let pair = PairSpec { first: 0, second: 1, law, method: Method::Collocated, sides: Sides::Both };
//! let mut contacts = Contacts::new(surfaces, &[pair], thickness, x, y)?;
//!
//! let critical = dynamics.critical_time_step(&[&contacts], 0.0);
//! dynamics.set_time_step(0.5 * critical.time_step)?;
//! let bodies = [0, 1].map(|b| model.mesh.bodies[b].nodes.clone().map(|n| dynamics.layout().slot_of_node[n]));
//! let [moving, resting] = bodies.map(|slots| slots.collect::<Vec<u32>>());
//! moving.iter().for_each(|&n| dynamics.state.vx[n as usize] = 2.0);
//! let before = dynamics.rigid_motion(&moving);
//!
//! let c = steel.dilatational_speed();
//! let mut touching = 0.0;
//! while dynamics.state.time < 3.0 * length / c {
//!     dynamics.step(&mut [&mut contacts]);
//!     if contacts.resultants().any(|pair| pair.force[0] < 0.0) {
//!         touching += dynamics.time_step();
//!     }
//! }
//! let after = [dynamics.rigid_motion(&moving), dynamics.rigid_motion(&resting)];
//! let momentum: f64 = after.iter().map(|body| body.mass * body.velocity[0]).sum();
//! assert!((momentum / (before.mass * 2.0) - 1.0).abs() < 1e-12);
//! assert!((touching / (2.0 * length / c) - 1.0).abs() < 0.03);
//! assert!(after[0].velocity[0].abs() < 0.02 && (after[1].velocity[0] - 2.0).abs() < 0.02);
//! # Ok(())
//! # }
//! ```
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | What is a surface, what acts between two? | `surface.rs`, `law.rs` |
//! | What is the gap, at corners and ends too? | `projection.rs` |
//! | Which curve does a polyline stand for? | `smooth.rs` |
//! | Where does the law act? | `points.rs` |
//! | What does one pass do, in contact and out of it? | `pass.rs`, `evaluation.rs`, `touch.rs` |
//! | How are many points done at a time? | `row.rs`, `meeting.rs`, `spline_row.rs`, `patch_row.rs`, `touch_row.rs`, `band.rs` |
//! | Who is near whom? | `search.rs`, `nearest.rs` |
//! | How does it all become one force? | `contacts.rs` |

// Units stand in brackets, as in "gap [m]", and are no links.
#![allow(rustdoc::broken_intra_doc_links)]

mod band;
mod contacts;
mod error;
mod evaluation;
mod law;
mod meeting;
mod nearest;
mod pass;
mod patch_row;
mod points;
mod projection;
mod row;
mod search;
mod shape;
mod smooth;
mod spline;
mod spline_row;
mod surface;
mod touch;
mod touch_row;

pub use contacts::{ContactState, Contacts, PairSpec, Resultant, Sides};
pub use error::Error;
pub use law::Law;
pub use points::Method;
pub use projection::{Projection, project};
pub use smooth::Smoothing;
pub use surface::Surface;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
