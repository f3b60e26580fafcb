//! Questions that are answered by many runs: one question, many runs, one table, one page.
//!
//! A study is an entry of [`Study`] and a file here, which measures what a summary of a run does not hold.
//! `plans/STUDY.ron` has its scenes with their overrides, the numbers of its table and its pictures, where it
//! has a list of scenes; `pages/STUDY.md` its words, into which the numbers are put. Runs are kept in
//! `runs/study/STUDY/VARIANT`; those that are finished are not repeated, and one that was interrupted is
//! continued. The answer goes to `docs/results/STUDY.csv`, `.md` and pictures beside them; `--page-only`
//! writes the page from the kept table.
//!
//! `cargo xtask study` is the command. Nothing that simulates depends on this crate; elements, precisions and
//! integrators that no run uses live here ([`reference`], [`integrators`]).

pub mod integrators;
pub mod reference;

mod analyse;
mod atlas;
mod families;
mod figure;
mod host;
mod impulse;
mod kills;
mod long;
mod machine;
mod measured_loop;
mod noise;
mod own;
mod page;
mod paper;
mod plan;
mod reduced;
mod rig;
mod rows;
mod run_time;
mod runner;
mod sample;
mod skidding;
mod spall_size;
mod spalls;
mod stability;
mod verdicts;
mod work_precision;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

pub use host::{Host, package, root};
pub use rows::Rows;
pub use runner::Flags;

pub(crate) use plan::Plan;

pub(crate) use runner::{Finished, Runner, Variant};

/// The questions.
#[derive(Debug, clap::Subcommand)]
pub enum Study {
    /// Which reading of the paper agrees with it best, and whether its hypothesis holds
    Paper(Flags),
    /// The bearing for 0.35 s: lines resolved to 3 Hz, the defect in the envelope
    Long(long::Options),
    /// Runs killed at random moments and continued: the same bytes
    Kills(kills::Options),
    /// Stiff and extreme cases: energy balance, and whether the program stopped or warned
    Stability(Flags),
    /// Error against run time of the whole bearing
    #[command(name = "run_time")]
    RunTime(run_time::Options),
    /// Error against work: problems with a known answer, by elements, integrators and contacts
    #[command(name = "work_precision")]
    WorkPrecision,
    /// Sources of contact noise, and the effect of each cure
    Noise(Flags),
    /// Whether the family of lines of any facet count is named rightly, and false ones are not
    Families(Flags),
    /// Many bearings, many defects: whether each is diagnosed correctly
    Atlas(Flags),
    /// Lengths of measured spalls, and whether simulated ones of these lengths knock alike
    Loop(measured_loop::Options),
    /// Simulated spalls of known length through `stribeck analyse`: whether it finds their lengths
    Spalls(Flags),
    /// Whether the force at the exit of a spall grows with its depth and its width
    #[command(name = "spall_size")]
    SpallSize(Flags),
    /// How far cage and rollers of a lightly loaded bearing lag behind, over load, speed, oil and clearance
    Skidding(Flags),
    /// How far the reduced bearing is from the full one, scene by scene
    Reduced(Flags),
    /// Whether the impulse at the exit is that of a finer mesh, over many starts
    Impulse(impulse::Options),
    /// Bearings by their own fields, at the first try, by both models
    Own(Flags),
    /// Records of machines fitted on one record a rig, beside the measured ones
    Machine(machine::Options),
    /// Measured records of known state through the verdict of `analyse`, beside plainer methods
    Verdicts(verdicts::Options),
}

impl Study {
    fn name(&self) -> &'static str {
        match self {
            Self::Paper(_) => "paper",
            Self::Long(_) => "long",
            Self::Kills(_) => "kills",
            Self::Stability(_) => "stability",
            Self::RunTime(_) => "run_time",
            Self::WorkPrecision => "work_precision",
            Self::Noise(_) => "noise",
            Self::Families(_) => "families",
            Self::Atlas(_) => "atlas",
            Self::Loop(_) => "loop",
            Self::Spalls(_) => "spalls",
            Self::Skidding(_) => "skidding",
            Self::SpallSize(_) => "spall_size",
            Self::Reduced(_) => "reduced",
            Self::Impulse(_) => "impulse",
            Self::Own(_) => "own",
            Self::Machine(_) => "machine",
            Self::Verdicts(_) => "verdicts",
        }
    }

    /// Runs the outstanding variants and puts what they yield into rows.
    fn measure(&self, host: &Host, rows: &mut Rows) -> Result<Answer> {
        let runner = |flags: &Flags| Runner::new(self.name(), flags, host);
        match self {
            Self::Paper(flags) => paper::measure(&runner(flags), rows)?,
            Self::Long(options) => long::measure(options, host, rows)?,
            Self::Kills(options) => return kills::measure(options, host, rows),
            Self::Stability(flags) => return stability::measure(&runner(flags), rows),
            Self::RunTime(options) => run_time::measure(options, host, rows)?,
            Self::WorkPrecision => work_precision::measure(host, rows)?,
            Self::Noise(flags) => noise::measure(&runner(flags), rows)?,
            Self::Families(flags) => families::measure(&runner(flags), rows)?,
            Self::Atlas(flags) => atlas::measure(&runner(flags), rows)?,
            Self::Loop(options) => measured_loop::measure(options, host, rows)?,
            Self::Spalls(flags) => spalls::measure(&runner(flags), rows)?,
            Self::Skidding(flags) => skidding::measure(&runner(flags), rows)?,
            Self::SpallSize(flags) => spall_size::measure(&runner(flags), rows)?,
            Self::Reduced(flags) => reduced::measure(&runner(flags), rows)?,
            Self::Impulse(options) => impulse::measure(options, host, rows)?,
            Self::Own(flags) => return own::measure(&runner(flags), rows),
            Self::Machine(options) => machine::measure(options, host, rows)?,
            Self::Verdicts(options) => verdicts::measure(options, host, rows)?,
        }
        Ok(Answer::default())
    }

    /// Runs the outstanding variants and writes the answer; with `page_only` only its page, from the kept
    /// table.
    pub fn run(&self, host: &Host, page_only: bool) -> Result<Answer> {
        let mut answer = Answer::default();
        if !page_only {
            let mut rows = Rows::default();
            answer = self.measure(host, &mut rows)?;
            if matches!(self, Self::Kills(options) if options.no_page) {
                return Ok(answer);
            }
            write(&results().join(format!("{}.csv", self.name())), &rows.to_csv())?;
        }
        let (file, missing) = write_page(self.name())?;
        for path in missing {
            host.say(&format!("the page has a gap: {path}"));
        }
        Ok(Answer { page: Some(file), ..answer })
    }
}

/// Result of a study.
#[derive(Debug, Clone, Default)]
pub struct Answer {
    /// The answer in a sentence, for studies that have one.
    pub said: Option<String>,
    /// The page that was written.
    pub page: Option<PathBuf>,
    /// Errors in the studied cases that are failures of the program.
    pub failure: Option<String>,
}

/// Where tables, pages and pictures are.
fn results() -> PathBuf {
    root().join("docs/results")
}

/// Writes the table of a study and its page, whose path it returns.
pub fn publish(study: &str, rows: &Rows) -> Result<PathBuf> {
    write(&results().join(format!("{study}.csv")), &rows.to_csv())?;
    Ok(write_page(study)?.0)
}

fn write_page(study: &str) -> Result<(PathBuf, Vec<String>)> {
    let (page, missing) = page_of(study)?;
    let file = results().join(format!("{study}.md"));
    write(&file, &page)?;
    Ok((file, missing))
}

/// The page of a study from its template and the kept table, and what the table lacks for it.
pub(crate) fn page_of(study: &str) -> Result<(String, Vec<String>)> {
    let path = package().join("pages").join(format!("{study}.md"));
    let template =
        std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let mut rows = Rows::read(&results().join(format!("{study}.csv")))?;
    match study {
        "atlas" => atlas::derive(&mut rows),
        "impulse" => impulse::derive(&mut rows),
        "reduced" => reduced::derive(&mut rows),
        "run_time" => run_time::derive(&mut rows),
        "spall_size" => spall_size::derive(&mut rows),
        "spalls" | "loop" => analyse::derive(&mut rows),
        "stability" => stability::derive(&mut rows),
        "verdicts" => verdicts::derive(&mut rows),
        "work_precision" => work_precision::derive(&mut rows),
        _ => {}
    }
    let (page, missing) = page::render(&template, &rows);
    let command =
        if study == "readers" { "fuzz --peers python3".to_owned() } else { format!("study {study}") };
    let source =
        format!("\nWritten by `cargo xtask {command}`; all numbers are in [{study}.csv]({study}.csv).\n");
    Ok((page + &source, missing))
}

pub(crate) fn write(path: &Path, text: &str) -> Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
    }
    std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
