//! Bodies in motion with contact, loads and the ledger of their energy, in node numbers and surface names.
//!
//! A [`Plan`] says what there is: bodies, materials, constraints, which surfaces may touch, what pushes. [`Plan::build`]
//! makes it a [`System`], which takes steps. Where nodes lie in the solver's memory is nobody's business but this crate's.
//!
//! Units are SI. Examples: a bar's impact, a pressed disc, a sliding block, a ring that rings (`examples/`).

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
pub use plan::{Pair, Plan};
pub use preload::{Preload, Settled, UndecidedMotion};
pub use snapshot::Snapshot;
pub use system::{Parts, System};
pub use workers::Workers;
