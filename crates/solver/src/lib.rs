//! Explicit plane-strain finite element dynamics.

pub mod critical;
pub mod damping;
pub mod dynamics;
pub mod element;
mod error;
pub mod force;
pub mod layout;
pub mod material;
pub mod model;
pub mod rigid;
pub mod state;
pub mod statics;
mod sweep;
mod tile;

pub use dynamics::Dynamics;
pub use error::Error;
pub use force::Force;
pub use material::Elastic;
pub use model::{Behaviour, Model, Motion};
