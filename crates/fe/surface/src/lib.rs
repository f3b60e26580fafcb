//! Oriented polylines in the plane, the smooth curves that they stand for, and the closest points on them.
//!
//! It is a crate because contact between finite elements and the reduced model share it, and the latter
//! links neither mesher nor solver.
//!
//! 1. A [`Surface`] is a polyline of nodes. It may stand for a smooth curve ([`Surface::smoothed`]), which
//!    follows its nodes facet by facet or as a spline ([`Surface::splined`]).
//! 2. [`project`] gives the foot of a point on a surface in present positions: the signed gap, its gradient,
//!    and where.
//! 3. A [`Law`] holds the numbers of contact between two surfaces: penalty, damping, Coulomb friction.
//! 4. [`film`] has the oil between two of them.
//!
//! Positions are arrays by slot, which the caller owns and moves. The crate has neither elements nor a time
//! loop; contact evaluates surfaces in its kernels through the modules below, whose mathematics stands once,
//! over a [`Number`](stribeck_simd::lanes::Number): `f64` for single points, a vector for many.
//!
//! # Conventions
//!
//! SI units. Along a surface the solid lies on the left and the outward normal points to the right. A gap [m]
//! is a signed distance: positive apart, negative in penetration. A place on a facet runs from 0 at its first
//! node to 1 at its second.
//!
//! # Example: a polygon that stands for a circle
//!
//! ```
//! use std::f64::consts::TAU;
//! use stribeck_surface::{Smoothing, Surface, project};
//!
//! # fn main() -> Result<(), stribeck_surface::Error> {
//! let (radius, n) = (0.01, 36);
//! let angle = |i: u32| TAU * f64::from(i) / f64::from(n);
//! let (x, y): (Vec<f64>, Vec<f64>) = (0..n).map(|i| (radius * angle(i).cos(), radius * angle(i).sin())).unzip();
//! let polygon = Surface::new("wheel", (0..n).collect(), true, &x, &y)?;
//! let circle = polygon.clone().smoothed(Smoothing::Arc { centre: [0.0; 2] }, &x, &y)?;
//!
//! // Above the middle of the first facet, 1 mm off the circle.
//! let half = 0.5 * angle(1);
//! let p = [(radius + 1e-3) * half.cos(), (radius + 1e-3) * half.sin()];
//! let gap = |surface| project(surface, &x, &y, p, 0).map(|found| found.gap);
//! assert!(gap(&circle).is_some_and(|gap| (gap - 1e-3).abs() < 1e-9));
//! // The chord lies lower by its sagitta, R (1 − cos (π/n)).
//! assert!(gap(&polygon).is_some_and(|gap| (gap - 1e-3 - radius * (1.0 - half.cos())).abs() < 1e-12));
//! # Ok(())
//! # }
//! ```
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | What is a surface? | `surface.rs`, `polyline.rs` |
//! | Which curve does a polyline stand for, and how does it move? | `smooth.rs`, `spline.rs`, `splined.rs` |
//! | What is the gap, at corners and ends too? | `narrow_phase.rs` |
//! | What is a facet? | `facet.rs`, and two kinds: `chord.rs`; `spline_facet.rs` with `patch.rs` |
//! | How do points move with facets, what do forces on them do to facets? | `foot.rs`, `plane.rs`, `polynomial.rs` |
//! | Which numbers has the law of contact? | `law.rs` |
//! | And oil between two surfaces? | `film.rs`, `film/` |

// Units stand in brackets, as in "gap [m]", and are no links.
#![allow(rustdoc::broken_intra_doc_links)]
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod chord;
mod error;
pub mod facet;
pub mod film;
pub mod foot;
pub mod law;
pub mod narrow_phase;
pub mod patch;
pub mod plane;
pub mod polyline;
pub mod polynomial;
pub mod smooth;
pub mod spline;
pub mod spline_facet;
mod splined;
mod surface;

pub use error::Error;
pub use law::Law;
pub use narrow_phase::{Projection, project};
pub use smooth::Smoothing;
pub use surface::Surface;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
