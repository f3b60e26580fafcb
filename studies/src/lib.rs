//! Questions that are answered by many runs: one question, many runs, one table.
//!
//! A study is a list of variants: a scene with overrides. Runs are kept in `runs/study/STUDY/VARIANT`; those
//! that are finished are not repeated, and one that was interrupted is continued. The answer goes to
//! `docs/results/STUDY.md` with a `.csv` and pictures beside it.
//!
//! `cargo xtask study` is the command. Nothing that simulates depends on this crate; elements, precisions and
//! integrators that no run uses live here ([`reference`], [`integrators`]). Like every library here it prints
//! nothing and reads no clock: all access to the program that runs it is through its [`Host`].

pub mod integrators;
pub mod reference;

mod atlas;
mod closed_loop;
mod families;
mod host;
mod impulse;
mod kills;
mod long;
mod noise;
mod own_bearings;
mod paper;
mod reduced;
mod rig;
mod run_time;
mod runner;
mod spall_size;
mod spalls;
mod stability;
mod table;
mod verdicts;
mod work_precision;

use anyhow::Result;

pub use host::{Answer, Host, Job};
pub use runner::Flags;

pub(crate) use runner::{Finished, Runner, Variant};
pub(crate) use table::{Column, Sheet};

/// The questions.
#[derive(Debug, clap::Subcommand)]
pub enum Study {
    /// Which reading of the paper agrees with it best, and whether its hypothesis holds
    Paper(paper::Options),
    /// The bearing for 0.35 s: lines resolved to 3 Hz, the defect in the envelope
    Long(long::Options),
    /// Runs killed at random moments and continued: the same bytes
    Kills(kills::Options),
    /// Stiff and extreme cases: energy balance, and whether the program stopped or warned
    Stability(stability::Options),
    /// Error against run time of the whole bearing
    #[command(name = "run_time")]
    RunTime(run_time::Options),
    /// Error against work: problems with a known answer, by elements, integrators and contacts
    #[command(name = "work_precision")]
    WorkPrecision,
    /// Sources of contact noise, and the effect of each cure
    Noise(noise::Options),
    /// Whether the family of lines of any facet count is named rightly, and false ones are not
    Families(families::Options),
    /// Many bearings, many defects: whether each is diagnosed correctly
    Atlas(atlas::Options),
    /// Lengths of measured spalls, and whether simulated ones of these lengths knock alike
    Loop(closed_loop::Options),
    /// Simulated spalls of known length through `stribeck analyse`: whether it finds their lengths
    Spalls(spalls::Options),
    /// Whether the force at the exit of a spall grows with its depth and its width
    #[command(name = "spall_size")]
    SpallSize(spall_size::Options),
    /// How far the reduced bearing is from the full one, scene by scene
    Reduced(reduced::Options),
    /// Whether the impulse at the exit is that of a finer mesh, over many starts
    Impulse(impulse::Options),
    /// Bearings by their own fields, at the first try, by both models
    Own(own_bearings::Options),
    /// Measured records of known state through the verdict of `analyse`, beside plainer methods
    Verdicts(verdicts::Options),
}

impl Study {
    /// Runs the outstanding variants and writes the answer.
    ///
    /// # Errors
    /// When a variant is not a valid scene, a page cannot be written, or at an interruption; finished runs
    /// are kept.
    pub fn run(&self, host: &dyn Host) -> Result<Answer> {
        match self {
            Self::Paper(options) => paper::run(options, host),
            Self::Long(options) => long::run(options, host),
            Self::Kills(options) => kills::run(options, host),
            Self::Stability(options) => stability::run(options, host),
            Self::RunTime(options) => run_time::run(options, host),
            Self::WorkPrecision => work_precision::run(host),
            Self::Noise(options) => noise::run(options, host),
            Self::Families(options) => families::run(options, host),
            Self::Atlas(options) => atlas::run(options, host),
            Self::Loop(options) => closed_loop::run(options, host),
            Self::Spalls(options) => spalls::run(options, host),
            Self::SpallSize(options) => spall_size::run(options, host),
            Self::Reduced(options) => reduced::run(options, host),
            Self::Impulse(options) => impulse::run(options, host),
            Self::Own(options) => own_bearings::run(options, host),
            Self::Verdicts(options) => verdicts::run(options, host),
        }
    }
}
