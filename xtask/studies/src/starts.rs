//! `cargo xtask study starts`: the paper's run from many starts. What its numbers scatter by is kept with the analysis,
//! which sets it beside those of each run.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use stribeck_analysis::ensemble::EnsembleFindings;
use stribeck_analysis::paper;

use crate::{Answer, Flags, Host, root, write};

const SCENE: &str = "fixtures/scenes/singh2014.ron";
const STARTS: usize = 16;
const TABLE: &str = "crates/results/analysis/src/paper/starts.csv";

/// Flags of `study starts`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
    /// Takes the starts of this finished ensemble instead
    #[arg(long, value_name = "DIR")]
    run: Option<PathBuf>,
}

pub(crate) fn measure(options: &Options, host: &Host) -> Result<Answer> {
    let folder = match &options.run {
        Some(run) => run.clone(),
        None => run(&options.flags, host)?,
    };
    let all = EnsembleFindings::of(&folder)?;
    let numbers = all.complete.iter().filter_map(|(_, findings)| {
        let sensor = paper::sensor(&all.scene.written, &findings.summary.levels.sensors)?;
        Some(paper::shown(&findings.summary, sensor))
    });
    let starts: Vec<_> = numbers.collect();
    ensure!(starts.len() > 1, "{} has no two complete starts", folder.display());
    write(&root().join(TABLE), &paper::starts_csv(&starts))?;
    let beside = paper::beside(&starts);
    let met = beside.iter().filter(|number| !number.differs()).count();
    let said =
        format!("{met} of {} numbers of the paper are met by {} starts; {TABLE}", beside.len(), starts.len());
    Ok(Answer { said: Some(said), ..Answer::default() })
}

/// Runs the starts that are missing.
fn run(flags: &Flags, host: &Host) -> Result<PathBuf> {
    let folder = root().join("runs/study/starts");
    if !flags.runs_nothing() {
        let mut command = host.stribeck()?;
        command.arg("simulate").args(flags.of_a_command());
        if folder.exists() {
            command.arg("--resume").arg(&folder);
        } else {
            command.arg(host.root().join(SCENE)).arg(format!("--starts={STARTS}")).arg("--out").arg(&folder);
        }
        let status = command.status().context("`stribeck simulate` does not start")?;
        ensure!(status.success(), "the starts did not come to their end; the same command goes on from here");
    }
    Ok(folder)
}
