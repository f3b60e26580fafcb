//! `cargo xtask study verdicts`: measured records of known state through the verdict of `stribeck analyse`:
//! how often it is right, wrong, undecided, raises an alarm over a healthy bearing or says "no defect" of a damaged one,
//! beside a plain envelope and a kurtogram.

mod baseline;
mod both_ends;
mod counts;
mod reassurance;
mod records;
mod trial;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::{Host, Rows, figure};
use counts::Judged;
use records::Labelled;
use trial::{CHANGES, Change};

pub(crate) use counts::derive;

/// Flags of `study verdicts`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Folder of the records: `hit-sm`, `cwru`, `cwru-more`, `uestc`, `mfpt`, `paderborn`, `ims` and `femto`, those that
    /// are there
    #[arg(value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// The records as they are, without the changes of the table of robustness
    #[arg(long)]
    unchanged: bool,
    /// The changes alone, beside the numbers that the kept table has of the records as they are
    #[arg(long, conflicts_with = "unchanged")]
    changes_only: bool,
    /// Change every N-th record only
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    changed_every: u32,
    /// Only changes whose name contains this; may be repeated
    #[arg(long, value_name = "TEXT")]
    change: Vec<String>,
}

pub(crate) fn measure(options: &Options, host: &Host, rows: &mut Rows) -> Result<()> {
    let folder = options.folder.as_ref().context("give the folder of the records")?;
    let records = records::read(folder)?;
    host.say(&format!("{} records", records.len()));
    if options.changes_only {
        *rows = Rows::read(&crate::results().join("verdicts.csv"))?;
    } else {
        as_they_are(folder, &records, host, rows)?;
    }
    if options.unchanged { Ok(()) } else { changes(options, &records, host, rows) }
}

/// The records as they are, and the series of short ones.
fn as_they_are(folder: &Path, records: &[Labelled], host: &Host, rows: &mut Rows) -> Result<()> {
    let cores = stribeck::host::cores();
    let judged = host.each(records, cores, |record| Judged {
        outcome: trial::judge(record, Change::None),
        fixed: baseline::fixed_band(record),
        kurtogram: baseline::kurtogram_band(record),
    })?;
    counts::verdicts(rows, records, &judged);
    reassurance::conclusions(rows, records, &judged);
    let series = records::read_series(folder)?;
    reassurance::count_series(rows, &series, &host.each(&series, cores, reassurance::judge_series)?);
    reassurance::ablation(rows, records, &judged);
    reassurance::levels(rows, records, &judged);
    let beside = counts::sound_of_the_rig(records, &judged);
    counts::beside_sound(
        rows,
        &beside,
        &host
            .each(&beside, cores, |(record, sound_db)| trial::judge_beside(record, Change::None, sound_db))?,
    );
    counts::choices(rows, records, &judged);
    figure::draw("verdicts", &counts::false_alarms(rows, records, &judged))?;
    let ends = both_ends::pairs(records);
    both_ends::count(rows, &ends, &host.each(&ends, cores, both_ends::judge)?);
    counts::lengths(rows, records, &judged);
    counts::every_record(rows, records, &judged);
    Ok(())
}

/// Every N-th record after each change, in place of what `rows` have of that.
fn changes(options: &Options, records: &[Labelled], host: &Host, rows: &mut Rows) -> Result<()> {
    rows.clear(&["changed", "robustness", "speeds"]);
    rows.value("changed", "changed", "every", f64::from(options.changed_every));
    let some: Vec<Labelled> = records.iter().step_by(options.changed_every as usize).cloned().collect();
    let asked = |name: &str| {
        options.change.is_empty() || options.change.iter().any(|text| name.contains(text.as_str()))
    };
    let mut changed = Vec::new();
    for (name, change) in CHANGES.into_iter().filter(|(name, _)| asked(name)) {
        host.say(name);
        let outcomes = host.each(&some, stribeck::host::cores(), |record| trial::judge(record, change))?;
        changed.push((name, outcomes));
    }
    counts::robustness(rows, &some, &changed);
    counts::speeds(rows, &some, &changed);
    Ok(())
}
