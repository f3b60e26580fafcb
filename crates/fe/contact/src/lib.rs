//! Contact between oriented surfaces in the plane: search, closest points, penalty, damping and Coulomb
//! friction, for explicit dynamics.
//!
//! It is a crate because the solver knows nothing of contact, and models without it link neither search nor
//! law.
//!
//! To the solver, contact is one more force on nodes: [`Contacts`] implements
//! [`Force`](stribeck_solver::Force). Three things make it up, in this order:
//!
//! 1. a [`Surface`] for each boundary that may touch: a polyline of nodes, which may stand for a smooth curve
//!    ([`Surface::smoothed`]) and move as a spline of its nodes ([`Surface::splined`]);
//! 2. a [`PairSpec`] for each two surfaces that may touch, with a [`Law`] and a [`Method`], for the points at
//!    which the law acts: nodes, or points on every facet;
//! 3. [`Contacts::new`] with all of them; the result goes into the list of forces of every step.
//!
//! Each pair is evaluated in two passes of half the stiffness, the points of either surface against the
//! facets of the other. A pass searches at intervals (broad phase: bounding-volume trees of
//! [parry2d](https://parry.rs)), tracks closest points from step to step (narrow phase), and skips points
//! that cannot touch yet. [`project`] projects a single point: its gap to a surface, and the foot.
//!
//! # Conventions
//!
//! SI units. Along a surface the solid lies on the left and the outward normal points to the right. A gap [m]
//! is a signed distance: positive apart, negative in penetration. Stiffness and damping are per area:
//! pressure a metre of penetration [Pa/m], and a metre a second of approach [Pa s/m]. The resultant of a pair
//! is the force on its *first* surface's body.
//!
//! # Example: two blocks collide
//!
//! A block at 2 m/s hits an equal one at rest. The compression wave runs to the far end of each and back, so
//! they part after 2L/c; the whole momentum is transferred.
//!
//! ```
//! use stribeck_contact::{Contacts, Law, Method, PairSpec, Sides, Surface};
//! use stribeck_mesh::{Mesh, Rectangle};
//! use stribeck_solver::{Dynamics, Elastic, Model, NodeMotion};
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
//! model.motion.fill(NodeMotion::HeldY);
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
//! | What is a surface, which curve does it stand for, what is the gap to it? | the crate [`stribeck_surface`] |
//! | Which law acts between two surfaces? | `law.rs` of the same crate, the numbers; `pass_law.rs` |
//! | Where does the law act? | `points.rs` |
//! | Which facets are near each other? | `broad_phase.rs` |
//! | How does a facet move, and gather forces? | `moving_facet.rs` |
//! | What does a pass do, and what is its state from step to step? | `pass.rs`, `memory.rs` |
//! | How do all pairs become one force? | `contacts.rs` |
//! | And oil between surfaces? | `film.rs`, by the law of [`stribeck_surface::film`] |
//!
//! The hot loop is in `kernel/`:
//!
//! | Question | File |
//! |---|---|
//! | What is the law at a point in contact? | `law.rs` |
//! | What does one evaluation of a pass do? | `evaluate.rs` |
//! | How are the points of a facet done in vectors? | `row.rs`, on chords `chord_row.rs`, on splines `patch_row.rs` |
//! | And those of facets with few points, a facet in each lane? | `chord_band.rs`, `chord_lanes.rs` |
//! | How do points of one chord meet another chord? | `chord_pair.rs` |
//! | What about points near ends and corners? | `single_points.rs` |
//! | At which facet does a point start after a search? | `nearest_chord.rs` |
//!
//! The mathematics stands once, over a [`Number`](stribeck_simd::lanes::Number): `f64` for single points, a
//! vector for rows and bands of them.

// Units stand in brackets, as in "gap [m]", and are no links.
#![allow(rustdoc::broken_intra_doc_links)]
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod broad_phase;
mod contacts;
mod film;
mod kernel;
mod memory;
mod moving_facet;
mod pass;
mod pass_law;
mod points;

pub use contacts::{ContactState, Contacts, PairSpec, Resultant, Sides};
pub use film::{FilmResultant, FilmSpec, FilmState, Films};
pub use points::Method;
pub use stribeck_surface::film::{Bed, FilmLaw, Land, Layer, Oil, Place, Point, Pushed, Spring, WIDEST};
pub use stribeck_surface::{Error, Law, Projection, Smoothing, Surface, project};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
