//! From the finite elements of a preloaded rolling bearing to a few modes: once a mesh, what
//! `stribeck-reduced` steps.
//!
//! The full model of a scene is meshed and brought to equilibrium under its load. Outer ring and housing are
//! reduced there to their natural modes below a frequency and a residual flexibility; the seat between them
//! to the springs of some panels; what bodies give way by beside a contact to curves of small static
//! problems. The result, [`ReducedMesh`], is kept in a file for later runs. A scene then adds its numbers:
//! outlines, damping, cage, oil and speeds ([`modal_bearing`]).
//!
//! ```
//! use stribeck_scene::Scene;
//! use stribeck_simulation::reduction::{ReducedMesh, modal_bearing};
//!
//! let text = "(bearing: \"NU 203\", model: reduced(modes_khz: 8), film: None, defect: None, \
//!     operation: (load_n: 500), housing: rigid(mass_kg: 1), mesh: (size_mm: 1, roller_facets: 32))";
//! let scene = Scene::parse(text, "here")?.resolve();
//! let mesh = ReducedMesh::new(&scene)?;
//! let bearing = modal_bearing(&scene, mesh.reduction)?;
//! // A ring in a rigid housing moves as one piece.
//! assert_eq!(bearing.reduction.modes, 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | In which order is a scene reduced? | `reduce.rs` |
//! | Which nodes and forces are taken from the preloaded bearing? | `extraction.rs` |
//! | Which modes are kept, and which flexibility do the others have? | `structure.rs` |
//! | How is the seat divided, and what do its springs hold? | `seat.rs` |
//! | What do raceway, sensors and loads become? | `raceway.rs`, `sensors.rs`, `loads.rs` |
//! | How do bodies give way beside a contact? | `compliances.rs`, `local_contact.rs` |
//! | What does a scene add? | `parameters.rs` |
//! | How is a dense system solved, for the equilibrium at the start? | `dense.rs` |
//! | Which reductions are kept, and for which scenes do they serve? | `cache.rs` |

mod reduce;

mod compliances;
mod extraction;
mod loads;
pub mod local_contact;
mod raceway;
mod seat;
mod sensors;
mod structure;

pub mod cache;
pub mod dense;
mod parameters;

pub use parameters::modal_bearing;
pub use reduce::ReducedMesh;

/// Unit vector from the origin towards a place.
fn direction([x, y]: [f64; 2]) -> [f64; 2] {
    [x / libm::hypot(x, y), y / libm::hypot(x, y)]
}
