//! Bayesian inference of a simulation's inputs from its outputs: which points of the unit cube reproduce the
//! measured numbers, with which probability, and which numbers no point reproduces.
//!
//! The crate is independent of the simulation. Its input are runs, a row each: a point of the unit cube and
//! the outputs of the run there. It learns every output as a function of the point, with the scatter of
//! starts ([`Emulator`]), and draws from the posterior of points given targets ([`Posterior`]). Priors turn
//! coordinates into values ([`Prior`]). Everything follows from seeds: the same runs give the same answer on
//! any number of threads.
//!
//! # Where to look
//!
//! | Question | Where |
//! |---|---|
//! | Where shall the first runs be? | [`sobol`] |
//! | Where shall the next be, and how much would they add? | [`next`], [`expected_gain`] |
//! | What does a run at a point give? | [`Emulator::predict`], [`Emulator::interval`] |
//! | How good are these predictions? | [`Emulator::quality`] |
//! | Which points make the targets? | [`Posterior::of`] |
//! | Which target moves which field? | [`pulls`] |
//! | Do runs at these points make the targets? | [`Predictive::of`] |
//! | What can no point make? | [`Conflict::of`] |
//! | Can the intervals be trusted? | [`Calibration::of`] |
//! | How wide must they be where they cannot? | [`Levels::of`] |
//! | A whole curve is the target | [`Curves`] |

mod error;

mod prior;
mod runs;

mod design;
mod emulator;
mod likelihood;
mod posterior;

mod conflict;
mod next;
mod predictive;
mod pulls;

mod calibration;
mod interval;
mod levels;

mod curve;

mod random;

pub use calibration::{BINS, Calibration, FieldCalibration, Share, Truth};
pub use conflict::{Conflict, Exclusion, LIMIT, Reach};
pub use curve::Curves;
pub use design::{MOST_DIMENSIONS, MOST_POINTS, sobol};
pub use emulator::{Emulator, Prediction, Quality};
pub use error::Error;
pub use interval::{interval, moments, quantile, rank};
pub use levels::{FieldLevels, Levels};
pub use next::{Gain, NextOptions, expected_gain, next};
pub use posterior::{Posterior, PosteriorOptions};
pub use predictive::Predictive;
pub use prior::{Prior, snapped};
pub use pulls::{Pull, pulls};
pub use runs::{Output, Runs, Scale, Target};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
