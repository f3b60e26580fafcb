//! The program `stribeck`: its commands, for the binary and for `cargo xtask`, which has the same ones.
//!
//! It is a crate with a library because `xtask`, the studies and the Python module offer the same commands.
//!
//! Glue only: paths, flags, progress and exit codes. All computation is in the crates below.

pub mod command_line;
pub mod host;
pub mod interrupt;
pub mod place;
pub mod progress;

#[cfg(feature = "full")]
mod analyse;
mod bearings;
mod board;
#[cfg(feature = "full")]
mod campaign;
#[cfg(feature = "full")]
mod compare;
#[cfg(feature = "full")]
mod demo;
#[cfg(feature = "full")]
mod detect;
mod disk;
#[cfg(not(feature = "full"))]
mod elsewhere;
#[cfg(feature = "full")]
mod emit;
#[cfg(feature = "full")]
mod export;
mod fields;
pub mod fmu;
mod help;
pub mod lab;
#[cfg(feature = "full")]
mod limits;
mod list;
mod machine;
#[cfg(feature = "full")]
mod machine_fit;
#[cfg(feature = "full")]
mod many_runs;
#[cfg(feature = "full")]
mod memory;
pub mod new;
mod open;
mod out;
mod own_files;
mod pdf;
mod plan;
mod remove;
mod report;
mod shelf;
mod shell;
mod side_by_side;
mod simulate;
mod stiffness;
#[cfg(feature = "full")]
mod sweep;
mod validate;

use std::process::ExitCode;

use anyhow::Result;
#[cfg(not(feature = "full"))]
use elsewhere::{
    self as analyse, self as compare, self as demo, self as detect, self as export, self as machine_fit,
    self as sweep,
};
pub use out::Loudness;
pub use place::Place;

/// Stribeck: explicit dynamics of rolling element bearings.
///
/// Reads a scene (a short text), simulates the bearing, and leaves a folder with traces, energies and a
/// report.
#[derive(Debug, clap::Parser)]
#[command(
    name = "stribeck",
    version = host::VERSION,
    max_term_width = 100,
    arg_required_else_help = true,
    help_template = help::template()
)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    loudness: Loudness,
}

impl Cli {
    /// Executes the command line.
    pub fn run(&self) -> Result<ExitCode> {
        self.loudness.apply();
        #[cfg(feature = "full")]
        limits::Limits::default().apply();
        interrupt::outlive_full_files();
        self.command.run(&match std::env::var_os(place::REPOSITORY) {
            Some(root) => Place::repository("cargo xtask", root.into()),
            None => Place::here(),
        })
    }
}

/// Commands of the program.
#[derive(Debug, clap::Subcommand)]
pub enum Command {
    /// Shows what it does, in ten seconds: a spall, its page, its sound, and the verdict
    #[command(after_help = "Example: stribeck demo")]
    Demo(demo::Options),
    /// Writes a scene of your own, by six questions or by flags, that runs as it is
    #[command(
        after_help = "Example: stribeck new mine.ron --bearing \"NU 205\" --load-n 3000 --defect inner"
    )]
    New(new::Options),
    /// Runs a scene and writes its report
    #[command(alias = "run", after_help = "Example: stribeck simulate mine.ron --set operation.load_n=2000")]
    Simulate(simulate::Options),
    /// Writes the report of a run again
    #[command(after_help = "Example: stribeck report mine --pdf")]
    Report(report::Options),
    /// Runs a scene with several values of some fields, or a campaign file; also `campaign`
    #[command(
        visible_alias = "campaign",
        after_help = "Example: stribeck sweep mine.ron --set operation.load_n=1000,2000,4000"
    )]
    Sweep(sweep::Options),
    /// Fits path to the sensor and background of a machine to records of known state
    #[command(
        after_help = "Example: stribeck machine sound.mat spalled.mat --defect none --defect outer:0.53 --bearing 6205 --unit g"
    )]
    Machine(machine_fit::Options),
    /// Finds the smallest spall that nine of ten records of a machine show
    #[command(after_help = "Example: stribeck detect mine.ron --lengths 0.3..5")]
    Detect(detect::Options),
    /// Runs a scene by the full and by the reduced model, and compares them
    #[command(after_help = "Example: stribeck validate mine.ron")]
    Validate(validate::Options),
    /// Predicts a run before it is made: lines, levels, steps, cost, advice
    #[command(after_help = "Example: stribeck plan mine.ron --set mesh.size_mm=1")]
    Plan(plan::Options),
    /// Stiffness and damping over load, speed and cage angle, for rotor dynamics
    #[command(after_help = "Example: stribeck stiffness mine.ron")]
    Stiffness(stiffness::Options),
    /// Makes a page in which bearings run, with handles and instruments
    #[command(after_help = "Example: stribeck lab mine.ron --out mine.html --open")]
    Lab(lab::Options),
    /// Packs a bearing as an FMU for rotor programs: the shaft's motion in, forces out
    #[command(after_help = "Example: stribeck fmu mine.ron --set 'model=reduced()'")]
    Fmu(fmu::Options),
    /// Lists bearings by name: dimensions, defect frequencies, sources
    #[command(alias = "bearing", after_help = "Example: stribeck bearings \"NU 205\"")]
    Bearings(bearings::Options),
    /// Lists the fields of a scene: defaults, ranges, units
    #[command(after_help = "Example: stribeck fields operation")]
    Fields(fields::Options),
    /// Analyses measured records: which defects, how certain, and what is open
    #[command(
        visible_alias = "analyze",
        after_help = "Example: stribeck analyse record.mat --bearing 6205 --speed-rpm 1797"
    )]
    Analyse(analyse::Options),
    /// Compares runs, ensembles and records: changed fields, changed results
    #[command(alias = "diff", after_help = "Example: stribeck compare mine other record.mat")]
    Compare(compare::Options),
    /// Writes the signals of a run or record, or a run's frames, for other programs
    #[command(after_help = "Example: stribeck export mine --to wav --slow 10")]
    Export(export::Options),
    /// Lists the runs and other results
    #[command(alias = "ls", after_help = "Example: stribeck list")]
    List(list::Options),
    /// Opens the page of a run in a browser
    #[command(aliases = ["plot", "show", "view"], after_help = "Example: stribeck open mine")]
    Open(open::Options),
    /// Removes runs, after asking
    #[command(aliases = ["delete", "remove"], after_help = "Example: stribeck rm mine other")]
    Rm(remove::Options),
    /// Writes the completions of commands and flags for a shell
    #[command(after_help = "Example: stribeck completions bash > stribeck.bash")]
    Completions(shell::Completions),
}

impl Command {
    /// Whether the program needs the feature `full` for it: it reads records, makes tables of many runs, or
    /// lists the flags of all commands.
    pub fn needs_full(&self) -> bool {
        matches!(
            self,
            Self::Demo(_)
                | Self::Sweep(_)
                | Self::Machine(_)
                | Self::Detect(_)
                | Self::Analyse(_)
                | Self::Compare(_)
                | Self::Export(_)
                | Self::Completions(_)
        )
    }

    /// Executes the command, with paths and words of `place`.
    pub fn run(&self, place: &Place) -> Result<ExitCode> {
        match self {
            Self::Demo(options) => demo::run(options, place),
            Self::New(options) => new::run(options, place),
            Self::Simulate(options) => simulate::run(options, place),
            Self::Report(options) => report::run(options, place),
            Self::Sweep(options) => sweep::run(options, place),
            Self::Machine(options) => machine_fit::run(options, place),
            Self::Detect(options) => detect::run(options, place),
            Self::Validate(options) => validate::run(options, place),
            Self::Plan(options) => plan::run(options, place),
            Self::Stiffness(options) => stiffness::run(options, place),
            Self::Lab(options) => lab::run(options, place),
            Self::Fmu(options) => fmu::run(options, place),
            Self::Bearings(options) => bearings::run(options),
            Self::Fields(options) => fields::run(options),
            Self::Analyse(options) => analyse::run(options, place),
            Self::Compare(options) => compare::run(options, place),
            Self::Export(options) => export::run(options, place),
            Self::List(options) => list::run(options, place),
            Self::Open(options) => open::run(options, place),
            Self::Rm(options) => remove::run(options, place),
            Self::Completions(options) => shell::completions(options),
        }
    }
}

/// The exit code of a command; prints its error on stderr.
pub fn conclude(done: Result<ExitCode>) -> ExitCode {
    let done = done.and_then(|code| match out::trouble() {
        Some(trouble) if code == ExitCode::SUCCESS => Err(anyhow::Error::msg(trouble)),
        _ => Ok(code),
    });
    done.unwrap_or_else(|error| {
        out::error(&error, &causes(&error));
        let interrupted = error.is::<interrupt::Interrupted>();
        if interrupted { ExitCode::from(interrupt::EXIT_CODE) } else { ExitCode::FAILURE }
    })
}

/// The causes of an error that its message does not contain already, as many of those of the crates do.
fn causes(error: &anyhow::Error) -> Vec<String> {
    let told = error.to_string();
    error.chain().skip(1).map(ToString::to_string).filter(|cause| !told.contains(cause)).collect()
}
