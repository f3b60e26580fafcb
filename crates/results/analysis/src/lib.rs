//! Analysis of a bearing's vibration: kinematics, events, loads, tones, levels and defect families.
//!
//! It is a crate because programs that need the numbers of a run alone link no plotting library.
//!
//! [`findings::Findings::of`] analyses a run directory; the crate `stribeck-diagnosis` a measured record. The
//! steps on the way are public and take plain slices. Nothing here meshes, simulates or draws: the crate
//! `stribeck-report` makes pages of it.
//!
//! ```no_run
//! use stribeck_analysis::{findings::Findings, record::Record};
//! use stribeck_store::run_dir::Run;
//!
//! let run = Run::read("runs/singh2014")?;
//! let summary = Findings::of(&Record::whole(&run)?)?.summary;
//! for tone in summary.tones.iter().filter(|tone| tone.level_g.is_some()) {
//!     println!("{}: {} no. {} at {:?} Hz", tone.sensor, tone.name, tone.harmonic, tone.measured_hz);
//! }
//! # Ok::<(), stribeck_analysis::Error>(())
//! ```
//!
//! # Where to look
//!
//! | question | module |
//! |---|---|
//! | Which channels has a run, and what does geometry predict? | [`record`], [`prediction`], [`plan`] |
//! | How do speed and load change, and which orders has a defect? | [`duty`] |
//! | Which lines are there, and from which source? | [`families`], [`tones`], [`artefacts`], [`enveloping`], [`lumped`], [`ring`] |
//! | When does a roller unload and strike, how long is the defect? | [`events`], [`floor`], [`spall_length`] |
//! | How large is a signal, before and behind the notch, and where in the spectrum? | [`levels`], [`loudest`], [`filtering`], [`signal`], [`noise`] |
//! | How is the load shared, how fast do rollers and cage turn, do rollers slide? | [`load`], [`kinematics`], [`rolling`], [`stress`] |
//! | How far is the reduced model from the full one? | [`agreement`] |
//! | What differs between runs or records, and is it more than scatter? | [`comparison`] |
//! | What does the verdict on a record say of a run? | [`diagnosis`] |
//! | What does the sensor of a machine about the bearing record, and which machine made a record? | [`machine`] |
//! | What are the results of a run? | [`findings`], [`summary`], [`paper`] |
//! | What is a row of the table of many runs? | [`runs`] |
//! | How is a number of a summary declared? | [`quantity`] |
//!
//! # A measured gearbox
//!
//! A pinion with 37 teeth turns at 24.9 Hz, so its teeth mesh at 921.3 Hz. Is that line in an accelerometer's
//! record, how strong is it, and is it resolved from the harmonics of the 50 Hz mains?
//!
//! ```
//! use std::f64::consts::TAU;
//! use stribeck_analysis::tones::{harmonics, measure};
//! use stribeck_dsp::Welch;
//!
//! let sample_rate_hz = 10_000.0;
//! let measured_g: Vec<f64> = (0..10_000)
//!     .map(|n| n as f64 / sample_rate_hz)
//!     .map(|t| 2.0 * (TAU * 922.0 * t).sin() + 0.5 * (TAU * 50.0 * t).sin() + 0.01 * (9e6 * t * t).sin())
//!     .collect();
//! let density = Welch::for_grid(sample_rate_hz, measured_g.len(), 1.0)?.estimate(&measured_g)?;
//!
//! let lines = harmonics(&[("teeth".into(), 37.0 * 24.9), ("mains".into(), 50.0)], 1, 5_000.0);
//! let found = measure("housing", &lines, &density)?;
//! assert!((found[0].measured_hz.unwrap() - 922.0).abs() < 0.1);
//! assert!((found[0].level_g.unwrap() - 2.0).abs() < 0.05);
//! assert!(found[0].unresolved_from.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod summary;

pub mod quantity;

pub mod prediction;
pub mod record;

pub mod defect;
pub mod duty;
pub mod enveloping;
pub mod events;
pub mod families;
pub mod film;
pub mod filtering;
pub mod floor;
pub mod kinematics;
pub mod levels;
pub mod load;
pub mod loudest;
pub mod lumped;
pub mod noise;
pub mod plan;
pub mod reading;
pub mod ring;
pub mod rolling;
pub mod signal;
pub mod spall_length;
pub mod tones;

pub mod artefacts;
pub mod detection;
pub mod diagnosis;
pub mod machine;
pub mod stiffness;
pub mod stress;

pub mod agreement;
pub mod comparison;
pub mod ensemble;
pub mod findings;
pub mod paper;
pub mod runs;
pub mod statistic;

mod error;

pub use error::Error;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
