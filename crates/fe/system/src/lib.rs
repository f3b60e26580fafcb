//! Bodies in motion with contact, loads and the ledger of their energy, in node numbers and surface names.
//!
//! It is a crate because it knows no machine: models of any bodies are built with it.
//!
//! A [`Plan`] has the bodies, materials, constraints, contact pairs and loads. [`Plan::build`] makes it a
//! [`System`], which finds equilibrium, takes steps, balances its energy and says when something goes wrong.
//! Where nodes lie in the solver's memory concerns this crate alone.
//!
//! # Conventions
//!
//! SI units: m, kg, s, N, J, Pa, rad; angles and spins are counter-clockwise positive. Forces are those of
//! the whole thickness. Time is leapfrog: positions at [`System::time`], velocities half a step earlier, the
//! ledger at the positions before the last step.
//!
//! Only nodes that a force has announced are pushed: surfaces of contact pairs and loads announce theirs by
//! themselves, [`Plan::force`] asks for those of a law of your own.
//!
//! # Example: a block falls on another
//!
//! ```
//! use stribeck_contact::Law;
//! use stribeck_mesh::Rectangle;
//! use stribeck_solver::{Elastic, NodeMotion};
//! use stribeck_system::{Pair, Plan};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let block = Rectangle { x0: 0.0, y0: 0.0, width: 0.02, height: 0.01, columns: 8, rows: 4 }.part()?;
//! let steel = Elastic::new(208e9, 0.3, 7800.0)?;
//! let mut plan = Plan::new(0.01);
//! plan.add("ground", &block, steel)?;
//! plan.add("block", &block.translated(0.0, 0.01), steel)?;
//! plan.constrain("ground.bottom", NodeMotion::Held)?;
//! plan.contact(Pair::new("block.bottom", "ground.top", Law::penalty(5e13)?))?;
//!
//! let mut system = plan.build(1)?;
//! system.set_time_step_factor(0.9)?;
//! let block = system.body("block")?;
//! system.launch(block, [0.0, -0.5], 0.0);
//! // Energies after every tenth step, under guards.
//! let findings = system.run(1000, 10, |_, _| ())?;
//! assert!(findings.iter().all(|finding| !finding.stops));
//! assert!(system.motion_of(block).velocity[1] > 0.0, "it has bounced");
//! # Ok(())
//! # }
//! ```
//!
//! `examples/` has four problems with a closed form: a bar's impact, a pressed disc, a block that slides to
//! rest, a ring's bending mode.
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | What does a user give? | `plan.rs` |
//! | How does it become numbers of the solver? | `build.rs`, `names.rs` |
//! | What is one step, what are its energies? | `system.rs`, `ledger.rs` |
//! | What pushes, besides the elements? | `forces.rs`, `load.rs` |
//! | Where are nodes and bodies? | `places.rs` |
//! | How does it start? | `preload.rs` |
//! | What is watched? | `guards.rs` |
//! | What does it take to continue? | `snapshot.rs` |
//! | Which threads do the work? | `workers.rs` |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod build;
mod error;
mod forces;
mod guards;
mod ledger;
mod load;
mod names;
mod places;
mod plan;
mod preload;
mod snapshot;
mod system;
mod workers;

pub use error::Error;
pub use guards::{Finding, Limits, Seen, Watched, Words};
pub use ledger::{Balance, Ledger, Scale};
pub use plan::{Film, Pair, Plan};
pub use preload::{Preload, Settled, UndecidedMotion};
pub use snapshot::Snapshot;
pub use system::{Parts, System};
pub use workers::Workers;
