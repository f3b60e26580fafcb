//! A measured signal: is it valid, which defect families does it hold, and what may be concluded?
//!
//! It is a crate because it serves any measured record: it knows neither scenes nor runs.
//!
//! [`Analysis::of`] goes through stages, each of which takes what the one before it yields: the record, from
//! one pass over its samples, so that hours take no more memory than seconds; the speed; the candidates, a
//! comb for each family with its controls; the rules of `families/rules.rs`, which claim a candidate or refuse
//! it; the verdict, with its sentence of `words/sentence.rs`. Source: THEORY §7.9.
//!
//! ```
//! use stribeck_diagnosis::{Analysis, Defect, Machine};
//! use stribeck_dsp::channel::Channel;
//! use stribeck_theory::catalogue::CatalogueBearing;
//!
//! // Impacts at 3.585 times 20 Hz that ring at 3 kHz, in noise.
//! let rate_hz = 12_800.0;
//! let mut seed = 1_u64;
//! let samples: Vec<f64> = (0..65_536)
//!     .map(|n| {
//!         seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
//!         let noise = (seed >> 40) as f64 / (1_u64 << 24) as f64 - 0.5;
//!         let since = (n as f64 / rate_hz).rem_euclid(1.0 / 71.7);
//!         noise + 2.0 * (-since / 1e-3).exp() * (std::f64::consts::TAU * 3_000.0 * since).sin()
//!     })
//!     .collect();
//! let machine = Machine {
//!     speed_rpm: Some(1200.0),
//!     bearing: Some(CatalogueBearing::parse("6205")?),
//!     ..Machine::default()
//! };
//! let analysis = Analysis::of(&Channel::held("housing", samples), rate_hz, &machine)?;
//! let families = analysis.findings.families.iter();
//! let claimed: Vec<Defect> = families.filter(|f| f.claimed).map(|f| f.name).collect();
//! assert_eq!(claimed, [Defect::Bpfo]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod quantity;

mod analysis;
mod conclusion;
pub mod families;
mod findings;
pub mod joint;
mod judged;
pub mod length;
mod machine;
pub mod pool;
pub mod record;
pub mod series;
pub mod sources;
pub mod speed;
pub mod words;

mod error;

pub use analysis::Analysis;
pub use conclusion::{Answer, Concluded, Conclusion, FOUND, OF_A_SPALL};
pub use error::Error;
pub use families::defect::Defect;
pub use families::family::{Family, Reason};
pub use families::power::Limit;
pub use families::sidebands::sidebands_seen;
pub use families::unexplained::Unexplained;
pub use findings::{Interval, MeasuredFindings, SoundAsHigh};
pub use length::pressed::{Pressed, usual_load_n};
pub use machine::{Machine, SPEEDS_RPM};
pub use record::course::Course;
pub use record::enhanced::Enhanced;
pub use record::screening::Health;
pub use record::unit::{AccelerationUnit, STANDARD_GRAVITY};
pub use speed::angular::over_angle;
pub use speed::varying::Varying;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
