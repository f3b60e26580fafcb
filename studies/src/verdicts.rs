//! `cargo xtask study verdicts`: measured records of known state through the verdict of `stribeck analyse`:
//! how often it is right, wrong, undecided, or raises an alarm over a sound bearing, beside a plain envelope
//! and a kurtogram.

mod baseline;
mod both_ends;
mod records;
mod speeds;
mod tables;
mod trial;

use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Result, ensure};

use crate::{Answer, Host, Sheet};
use records::Labelled;
use tables::Judged;
use trial::{CHANGES, Change};

/// Flags of `study verdicts`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Folder of the records: `hit-sm`, `cwru`, `cwru-more`, `uestc` and `mfpt`, those that are there
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// The records as they are, without the changes of the table of robustness
    #[arg(long)]
    unchanged: bool,
    /// Change every N-th record only
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    changed_every: u32,
    /// Only changes whose name contains this; may be repeated
    #[arg(long, value_name = "TEXT")]
    change: Vec<String>,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let records = records::read(&options.folder)?;
    host.say(&format!("{} records", records.len()));
    let mut sheet = Sheet::new(host.root(), "verdicts", "Verdicts on measured records of known state");
    let judged = of_all(&records, host, |record| Judged {
        outcome: trial::judge(record, Change::None),
        fixed: baseline::fixed_band(record),
        kurtogram: baseline::kurtogram_band(record),
    })?;
    tables::introduction(&mut sheet, &records);
    tables::verdicts(&mut sheet, &records, &judged);
    tables::choices(&mut sheet, &records, &judged);
    tables::sound(&mut sheet, &records, &judged)?;
    let ends = both_ends::pairs(&records);
    both_ends::table(&mut sheet, &ends, &of_all(&ends, host, both_ends::judge)?);
    tables::lengths(&mut sheet, &records, &judged);
    if !options.unchanged {
        let every = options.changed_every as usize;
        let some: Vec<Labelled> = records.iter().step_by(every).cloned().collect();
        let mut changed = Vec::new();
        let asked = |name: &str| {
            options.change.is_empty() || options.change.iter().any(|text| name.contains(text.as_str()))
        };
        for (name, change) in CHANGES.into_iter().filter(|(name, _)| asked(name)) {
            host.say(name);
            changed.push((name, of_all(&some, host, |record| trial::judge(record, change))?));
        }
        tables::robustness(&mut sheet, &some, every, &changed);
        speeds::table(&mut sheet, &some, &changed);
    }
    tables::bounds(&mut sheet);
    tables::numbers(&mut sheet);
    tables::every_record(&mut sheet, &records, &judged);
    Ok(Answer::on(sheet.write()?))
}

/// The same for each record, on all cores, in their order.
fn of_all<R: Sync, T: Send>(
    records: &[R],
    host: &dyn Host,
    judge: impl Fn(&R) -> T + Sync,
) -> Result<Vec<T>> {
    let next = AtomicUsize::new(0);
    let done: Vec<Mutex<Option<T>>> = records.iter().map(|_| Mutex::new(None)).collect();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..cores.min(records.len()) {
            scope.spawn(|| {
                loop {
                    let at = next.fetch_add(1, Ordering::Relaxed);
                    let Some(record) = records.get(at).filter(|_| !host.is_interrupted()) else { break };
                    let answer = judge(record);
                    if let Ok(mut place) = done[at].lock() {
                        *place = Some(answer);
                    }
                }
            });
        }
    });
    let all: Vec<T> = done.into_iter().filter_map(|place| place.into_inner().ok().flatten()).collect();
    ensure!(all.len() == records.len(), "interrupted; nothing was written");
    Ok(all)
}
