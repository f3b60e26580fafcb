//! `cargo xtask study paper`: which reading of the paper agrees with it best, and whether its hypothesis
//! holds.

mod hypothesis;
mod knocks;
mod open_choices;

use anyhow::Result;
use stribeck_analysis::summary::Summary;
use stribeck_analysis::tones::{self, Tone};

use crate::{Answer, Finished, Flags, Host, Runner, Sheet};

/// Scene of the variants: the paper's facets, larger elements away from the raceways.
const LEAN: &str = "fixtures/scenes/studies/lean.ron";
/// Overrides of every variant: one exit and the time to the next entry, no pictures.
const SHORT: [&str; 2] = ["solver.duration_ms=12.0", "output.frames=None"];

/// Overrides of variants with three passages.
const LONG: [&str; 2] = ["solver.duration_ms=30.0", "output.frames=None"];

/// Flags of `study paper`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
    /// Only one half of the study
    #[arg(long, value_enum)]
    part: Option<Part>,
}

/// The halves of the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Part {
    /// Choices that the paper leaves open
    Base,
    /// Consequences of its hypothesis
    Hypothesis,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let runner = Runner::new("paper", &options.flags, host);
    let wanted = |part| options.part.is_none_or(|only| only == part);
    let mut sheet = Sheet::new(host.root(), "paper", "The paper's choices and its hypothesis");
    sheet.say(
        "All runs are of the graded mesh `fixtures/scenes/studies/lean.ron`, which has the paper's facets on \
         raceways and rollers, and \
         last 12 ms unless stated: one exit at 5 ms and the quiet time until the next entry at 11.9 ms. They \
         resolve 83 Hz; lines \
         closer than 167 Hz merge. Accelerations are means over 10 µs of a_y at the sensor on the ring's \
         side (0°), unless stated.",
    );
    // The other half is shown as far as it has been run.
    let base = runner.run_if(wanted(Part::Base), &open_choices::variants())?;
    open_choices::write(&mut sheet, &base)?;
    let hypothesis = runner.run_if(wanted(Part::Hypothesis), &hypothesis::variants())?;
    hypothesis::write(&mut sheet, &hypothesis)?;
    let knocking = runner.run_if(wanted(Part::Hypothesis), &knocks::variants())?;
    knocks::write(&mut sheet, &knocking, &hypothesis);
    cost(&mut sheet, &base.iter().chain(&hypothesis).chain(&knocking).collect::<Vec<_>>());
    Ok(Answer::on(sheet.write()?))
}

/// Cost of all runs, and the versions that ran them.
fn cost(sheet: &mut Sheet, runs: &[&Finished]) {
    let infos: Vec<_> = runs.iter().filter_map(|r| r.info.as_ref()).collect();
    let minutes = infos.iter().map(|i| i.wall_s + i.setup_s).sum::<f64>() / 60.0;
    let mut commits: Vec<&str> = infos.iter().map(|i| i.commit.as_str()).collect();
    commits.sort_unstable();
    commits.dedup();
    sheet.heading("Cost");
    sheet.say(&format!(
        "{} runs, {minutes:.0} min together on {}, commit {}.",
        infos.len(),
        infos.first().map_or("no machine", |i| i.machine.as_str()),
        commits.join(", ")
    ));
}

/// The strongest facet line at the leading sensor.
fn tone(run: &Finished) -> Option<&Tone> {
    let summary = run.numbers()?;
    tones::dominant(&summary.tones, leading(summary)?)
}

fn leading(summary: &Summary) -> Option<&str> {
    summary.levels.sensor.as_deref()
}
