//! Penalty contact between oriented surfaces.

mod contacts;
mod error;
mod law;
mod pass;
mod points;
mod projection;
mod search;
mod surface;

pub use contacts::{ContactState, Contacts, PairSpec, Resultant};
pub use error::Error;
pub use law::Law;
pub use points::Method;
pub use projection::{Projection, project};
pub use surface::Surface;
