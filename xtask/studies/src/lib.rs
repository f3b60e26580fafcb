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

mod atlas;
mod figure;
mod host;
mod kills;
mod long;
mod machine;
mod noise;
mod page;
mod paper;
mod plan;
mod reduced;
mod rig;
mod rows;
mod run_time;
mod runner;
mod sample;
mod stability;
mod starts;
mod verdicts;
mod work_precision;

use std::path::{Path, PathBuf};
use std::process::Command;

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
    /// The paper's run from sixteen starts: the scatter that stands beside each of its numbers
    Starts(starts::Options),
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
    /// Many bearings, many defects: whether each is diagnosed correctly
    Atlas(Flags),
    /// How far the reduced bearing is from the full one, scene by scene
    Reduced(Flags),
    /// Records of machines fitted on one record a rig, beside the measured ones
    Machine(machine::Options),
    /// Measured records of known state through the verdict of `analyse`, beside plainer methods
    Verdicts(verdicts::Options),
}

impl Study {
    fn name(&self) -> &'static str {
        match self {
            Self::Paper(_) => "paper",
            Self::Starts(_) => "starts",
            Self::Long(_) => "long",
            Self::Kills(_) => "kills",
            Self::Stability(_) => "stability",
            Self::RunTime(_) => "run_time",
            Self::WorkPrecision => "work_precision",
            Self::Noise(_) => "noise",
            Self::Atlas(_) => "atlas",
            Self::Reduced(_) => "reduced",
            Self::Machine(_) => "machine",
            Self::Verdicts(_) => "verdicts",
        }
    }

    /// Runs the outstanding variants and puts what they yield into rows.
    fn measure(&self, host: &Host, rows: &mut Rows) -> Result<Answer> {
        let runner = |flags: &Flags| Runner::new(self.name(), flags, host);
        match self {
            Self::Paper(flags) => paper::measure(&runner(flags), rows)?,
            Self::Starts(options) => return starts::measure(options, host),
            Self::Long(options) => long::measure(options, host, rows)?,
            Self::Kills(options) => return kills::measure(options, host),
            Self::Stability(flags) => return stability::measure(&runner(flags), rows),
            Self::RunTime(options) => run_time::measure(options, host, rows)?,
            Self::WorkPrecision => work_precision::measure(host, rows)?,
            Self::Noise(flags) => noise::measure(&runner(flags), rows)?,
            Self::Atlas(flags) => atlas::measure(&runner(flags), rows)?,
            Self::Reduced(flags) => reduced::measure(&runner(flags), rows)?,
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
            if rows == Rows::default() {
                return Ok(answer);
            }
            write(&results().join(format!("{}.csv", self.name())), &rows.to_csv())?;
            made_by(self.name(), host)?;
        }
        let (file, missing) = write_page(self.name(), page_only)?;
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

fn write_page(study: &str, keeps_mark: bool) -> Result<(PathBuf, Vec<String>)> {
    let (page, missing) = page_of(study)?;
    let file = results().join(format!("{study}.md"));
    let kept = std::fs::read_to_string(&file).unwrap_or_default();
    let mark = if keeps_mark { mark_of(&kept) } else { "" };
    write(&file, &(mark.to_owned() + &page))?;
    Ok((file, missing))
}

/// The line that an older program made a page, as `cargo xtask ci --mark` writes it before the page of a study.
pub(crate) fn mark_of(page: &str) -> &str {
    let end = page.find("\n\n").map_or(0, |at| at + 2);
    if page.starts_with("Made by an older program") { &page[..end] } else { "" }
}

/// Notes that this program made the page of a study, and for how long it was at it.
fn made_by(study: &str, host: &Host) -> Result<()> {
    let file = results().join("made_by.csv");
    let read = |path: &Path| {
        std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
    };
    let digest = read(&root().join("fixtures/golden/digest"))?;
    let output = Command::new("git").args(["log", "-1", "--format=%h,%cs"]).current_dir(root()).output();
    let commit = output.map(|o| String::from_utf8_lossy(&o.stdout).trim().to_owned()).unwrap_or_default();
    let commit = if commit.is_empty() { "," } else { &commit };
    let text = read(&file)?;
    let of_study = |line: &&str| line.split(',').next() == Some(study);
    // Runs that were kept take no time: the longest is what it takes from the beginning.
    let before = text.lines().find(of_study).and_then(|line| line.split(',').nth(4)?.parse().ok());
    let minutes = (host.seconds() / 60.0).ceil().max(before.unwrap_or(0.0));
    let mut lines: Vec<&str> = text.lines().skip(1).filter(|line| !of_study(line)).collect();
    let line = format!("{study},{},{commit},{minutes},cargo xtask study {study}", digest.trim());
    lines.push(&line);
    lines.sort_unstable();
    let head = text.lines().next().unwrap_or_default();
    write(&file, &format!("{head}\n{}\n", lines.join("\n")))
}

/// The page of a study from its template and the kept table, and what the table lacks for it.
pub(crate) fn page_of(study: &str) -> Result<(String, Vec<String>)> {
    let path = package().join("pages").join(format!("{study}.md"));
    let template =
        std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let mut rows = Rows::read(&results().join(format!("{study}.csv")))?;
    match study {
        "atlas" => atlas::derive(&mut rows),
        "reduced" => reduced::derive(&mut rows),
        "run_time" => run_time::derive(&mut rows),
        "stability" => stability::derive(&mut rows),
        "verdicts" => verdicts::derive(&mut rows),
        "work_precision" => work_precision::derive(&mut rows),
        _ => {}
    }
    let (page, missing) = page::render(&template, &rows);
    let source =
        format!("\nWritten by `cargo xtask study {study}`; all numbers are in [{study}.csv]({study}.csv).\n");
    Ok((page + &source, missing))
}

pub(crate) fn write(path: &Path, text: &str) -> Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
    }
    std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
