//! Oil films between rolling surfaces in the plane: squeeze and entrainment, without suction.
//!
//! Between two rounded surfaces that roll, oil is drawn into the narrowing gap and carries load. Reynolds'
//! equation has a closed form there (THEORY §4.6). The film lies in series with a [`Spring`]: the gap between
//! the undeformed surfaces is the film's thickness less the deflection of the surfaces under its pressure. So
//! the force depends on positions, is never tensile and is no stiffer than the spring.
//!
//! The module has neither nodes in motion nor a time loop. A time loop uses
//!
//! 1. a [`Land`], the part of a surface between two corners, for the [`Point`] nearest to a body, and how far
//!    off the land ends;
//! 2. a [`FilmLaw`] for the film in a time step ([`FilmLaw::flow`]) or in steady rolling
//!    ([`FilmLaw::settled`]), with its state, a [`Layer`].
//!
//! # Conventions
//!
//! SI units. A gap [m] is positive when the surfaces are apart; forces [N] drive them apart. The entrainment
//! speed [m/s] is half the sum of the speeds at which both surfaces move through the contact.
//!
//! # Example: how thick is the oil under a load?
//!
//! H. M. Martin (Engineering 102 (1916) 119): a film of steady rolling carries W = 4.895 ηuRL/h.
//!
//! ```
//! use stribeck_surface::film::{Bed, FilmLaw, Oil};
//!
//! // A cylinder of 9 mm radius, 30 mm long, on a plane, in an oil of 50 mPa s at an entrainment speed of 2.4 m/s.
//! let (radius, length, viscosity, speed) = (9e-3, 30e-3, 0.05, 2.4);
//! let oil = Oil { viscosity, least: 0.5e-6 };
//! let law = FilmLaw::new(oil, radius, length, Bed::new(2e13 * length, radius));
//! let (layer, pushed) = law.settled(20e-6, speed, 1.0);
//! let martin = 4.895 * viscosity * speed * radius * length / law.thickness(&layer);
//! assert!((pushed.force / martin - 1.0).abs() < 1e-3, "{} N, not {martin} N", pushed.force);
//! ```
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | Where does a film lie? | `track.rs` |
//! | What are its thickness, force and heat? | `law.rs` |
//! | How are eight films computed at once? | `side_by_side.rs` |
//! | Which forces and speeds of opening does Reynolds' equation give? | `reynolds.rs` |
//! | What is the deflection of the surfaces under it? | `spring.rs` |

mod law;
mod reynolds;
pub mod side_by_side;
mod spring;
mod track;

pub use law::{FilmLaw, Layer, Oil, Pushed, WIDEST};
pub use spring::{Bed, Spring, SpringInLanes};
pub use track::{FacetCurve, Land, Place, Point};
