//! `cargo xtask study long`: the bearing for 0.35 s, the first spectrum of this model that resolves 3 Hz, and
//! the defect's family in an envelope spectrum.

mod pictures;
mod tables;

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_store::run_dir::Run;

use crate::{Answer, Flags, Host, Runner, Sheet, Variant};

/// Overrides of the run.
const LONG: &str = "fixtures/scenes/long.ron";

/// Flags of `study long`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
    /// Makes the page from this finished run instead: a folder, or a name below runs/
    #[arg(long, value_name = "DIR")]
    run: Option<PathBuf>,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let folder = match &options.run {
        Some(run) if run.exists() => run.clone(),
        Some(name) => host.root().join("runs").join(name),
        None => {
            let runs = Runner::new("long", &options.flags, host).run(&[Variant::new("long", LONG, &[])])?;
            let Some(finished) = runs.into_iter().next() else {
                bail!(
                    "`{LONG}` has not been run: leave out `--tables-only`, or name a finished run with \
                     `--run DIR`"
                );
            };
            if let Err(why) = &finished.summary {
                bail!("`{LONG}` yields no numbers: {why}");
            }
            finished.folder
        }
    };
    let run = Run::read(&folder).with_context(|| format!("cannot read the run in {}", folder.display()))?;
    let findings = Findings::of(&Record::new(&run)?)?;
    let mut sheet = Sheet::new(host.root(), "long", "A long record: 0.35 s");
    tables::cost(&mut sheet, &run, &findings.summary);
    tables::resolution(&mut sheet, &findings);
    pictures::spectra(&mut sheet, &findings)?;
    tables::lines(&mut sheet, &findings);
    tables::envelope(&mut sheet, &findings);
    pictures::envelope(&mut sheet, &findings)?;
    tables::passages(&mut sheet, &findings.summary);
    Ok(Answer::on(sheet.write()?))
}
