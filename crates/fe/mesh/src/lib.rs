//! Plane finite element meshes made of quadrilaterals and triangles: annuli, discs, blocks, their oriented
//! surfaces, their quality, and files that ParaView opens.
//!
//! The crate knows geometry only, so that programs that mesh, or read and write decks, link no solver. A
//! generator ([`Annulus`], [`Disc`], [`Rectangle`], [`SeatedBlock`], [`ArcBlock`]) describes one shape and
//! makes a [`Part`]; parts are moved, turned and added to a [`Mesh`], which numbers the nodes of all bodies
//! in one pair of coordinate arrays.
//!
//! Three conventions hold everywhere. Lengths are metres and angles radians, counter-clockwise from the x
//! axis. Elements are counter-clockwise. Along a [`Surface`] the solid lies on the left and the outward
//! normal points to the right.
//!
//! Nodes are numbered in rows, so that the quadrilaterals of a row form a [`Strip`]: all four corners advance
//! by one from each to the next, and a kernel may load consecutive values instead of gathering them.
//!
//! # Example: a pipe on two supports
//!
//! ```
//! use stribeck_mesh::{Annulus, Mesh, Quality, Rectangle, find_strips, vtu};
//!
//! # fn main() -> Result<(), stribeck_mesh::Error> {
//! let pipe = Annulus {
//!     inner_radius: 0.25,
//!     outer_radius: 0.30,
//!     facets: 180,
//!     layers: 5,
//!     start_angle: 0.0,
//!     grooves: Vec::new(),
//! };
//! let support = Rectangle { x0: -0.02, y0: -0.4, width: 0.04, height: 0.1, columns: 4, rows: 10 };
//!
//! let mut mesh = Mesh::new();
//! let placed = mesh.add("pipe", &pipe.part()?);
//! mesh.add("left support", &support.part()?.translated(-0.1, 0.0));
//! mesh.add("right support", &support.part()?.translated(0.1, 0.0));
//! assert_eq!(placed.surface("outer").map(|s| s.facets()), Some(180));
//!
//! // Two strips in each row of the pipe, because the row closes on itself; one in each row of a support.
//! assert_eq!(find_strips(&mesh.quads).len(), 2 * 5 + 10 + 10);
//!
//! // Steel: Poisson's ratio 0.3, pressure waves at 5857 m/s.
//! let quality = Quality::of(&mesh, 0.3, 5857.0);
//! assert!(quality.overall.critical_time_step > 1e-6);
//! println!("{quality}");
//!
//! let height: Vec<f64> = mesh.y.clone();
//! let mut file = Vec::new();
//! vtu::write(&mut file, &mesh, &[vtu::Field::scalar("height", &height)], &[])?;
//! # Ok(())
//! # }
//! ```
//!
//! # What to use
//!
//! | To … | use |
//! |---|---|
//! | make a ring, cut a groove into it, make it coarser away from one circle | [`Annulus`], [`Groove`], [`Grading`] |
//! | make a disc with a given number of facets | [`Disc`] |
//! | make a block: plain, with a seat for a ring, with a bore, between two arcs | [`Rectangle`], [`SeatedBlock`], [`BoredBlock`], [`ArcBlock`] |
//! | turn a body, move it, ask for its area, its surfaces, its centre | [`Part`] |
//! | put bodies together, know where their nodes went | [`Mesh::add`], [`Placed`] |
//! | judge elements, know the critical time step that they allow | [`Quality`], [`characteristic_length`] |
//! | see it in ParaView | [`vtu::write`] |
//! | load nodes as they lie in memory | [`find_strips`] |
//!
//! Bodies from another mesher need no generator: the fields of [`Part`] are public.
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | How are bodies and surfaces stored? | `part.rs`, `mesh.rs` |
//! | How is a ring divided? | `annulus.rs`, on the columns and rows of `polar_grid.rs`; with fine and coarse cells `grading.rs`; with a groove `groove.rs` |
//! | How is a surface made not round? | `form.rs` |
//! | How are the cells at the walls of both shaped? | `walls.rs` |
//! | How is a disc divided? | `disc.rs`: squares inside (`core_grid.rs`), rows outside, triangles between them (`gap.rs`) |
//! | How are blocks divided? | `rectangle.rs`, `seated_block.rs`, `bored_block.rs`, `arc_block.rs` |
//! | Where is the boundary of a mesh from a file? | `outline.rs` |
//! | How are rows numbered, and strips found? | `rows.rs`, `strips.rs` |
//! | How large and how well shaped are elements? | `characteristic.rs`, `quality.rs` |
//! | How are badly shaped cells improved? | one by one `smoothing.rs`; all at once `shape_optimisation.rs`, by the natural frequencies of a `submesh.rs` (`tridiagonal.rs`) |
//! | How does a mesh become a file? | `vtu.rs` |
//! | How do other programs get a mesh, or we theirs? | `vtu.rs`, `decks.rs` |
//! | What is refused? | `error.rs` |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod mesh;
mod outline;
mod part;

mod annulus;
mod form;
mod grading;
mod groove;
mod polar_grid;
mod rows;

mod core_grid;
mod disc;
mod gap;

mod arc_block;
mod bored_block;
mod rectangle;
mod seated_block;

pub mod strips;

mod characteristic;
pub mod quality;
mod shape_optimisation;
pub mod smoothing;
mod submesh;
mod tridiagonal;
mod walls;

pub mod decks;
pub mod vtu;

mod error;

pub use annulus::Annulus;
pub use arc_block::ArcBlock;
pub use bored_block::BoredBlock;
pub use characteristic::characteristic_length;
pub use disc::Disc;
pub use error::Error;
pub use form::FormDeviation;
pub use grading::Grading;
pub use groove::Groove;
pub use mesh::{Body, Mesh, Placed};
pub use part::{Part, Surface};
pub use polar_grid::Circle;
pub use quality::{BodyQuality, Quality};
pub use rectangle::Rectangle;
pub use seated_block::SeatedBlock;
pub use strips::{Strip, find_strips};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
