//! The sampled signals of all runs: a row for each sample.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::Result;
use stribeck_analysis::runs::OneOfMany;
use stribeck_formats::parquet::{Column, Values, Writer};
use stribeck_store::run_dir::{RunDir, SENSOR};
use stribeck_store::trace::{Trace, TraceFile};

/// Runs that have signals to their end, and the file of each, that of the machine's sensor where there is one: the
/// record of a diverged run is not a signal of a bearing.
fn recorded<'a>(
    folder: &'a Path,
    rows: &'a [OneOfMany],
) -> impl Iterator<Item = (&'a OneOfMany, PathBuf)> + 'a {
    rows.iter().filter(|one| one.is_complete()).filter_map(move |one| {
        let dir = RunDir::open(folder.join(one.folder.as_ref()?)).ok()?;
        let files = [dir.machine(), dir.signals()];
        Some((one, files.into_iter().find(|file| file.exists()).unwrap_or_else(|| dir.trace())))
    })
}

pub(super) fn names(folder: &Path, rows: &[OneOfMany]) -> Result<BTreeSet<String>> {
    let mut names = BTreeSet::new();
    for (_, file) in recorded(folder, rows) {
        names.extend(TraceFile::open(file)?.names().iter().filter(|name| name.starts_with(SENSOR)).cloned());
    }
    Ok(names)
}

/// One group of rows for each run that has signals. The signals of one run are in memory at a time.
pub(super) fn write(
    (folder, path): (&Path, &Path),
    rows: &[OneOfMany],
    names: &BTreeSet<String>,
    notes: &[(String, String)],
) -> Result<()> {
    let schema: Vec<Column> = group(None, names, Trace::default()).collect();
    let mut writer = Writer::create(path, &schema, notes)?;
    for (one, file) in recorded(folder, rows) {
        let file = TraceFile::open(file)?;
        let trace = file.read(0..file.len(), |name| name == "time_s" || name.starts_with(SENSOR))?;
        writer.add(group(Some(one), names, trace))?;
    }
    writer.finish()?;
    Ok(())
}

pub(super) fn columns(names: &BTreeSet<String>) -> Vec<String> {
    group(None, names, Trace::default()).map(|column| column.name).collect()
}

/// The columns of a run's signals; one that it has not recorded is empty.
fn group<'a>(
    one: Option<&'a OneOfMany>,
    names: &'a BTreeSet<String>,
    mut trace: Trace,
) -> impl Iterator<Item = Column> + use<'a> {
    let all = trace.len();
    let column = |name: &str, values| Column { name: name.to_owned(), values };
    let run = move || one.and_then(|one| i64::try_from(one.row.run).ok());
    let split = move || one.map(|one| one.row.split.clone());
    let run = std::iter::once_with(move || column("run", Values::Count(vec![run(); all])));
    let split = std::iter::once_with(move || column("split", Values::Text(vec![split(); all])));
    let time = trace.take("time_s").unwrap_or_default();
    let time = std::iter::once_with(move || Column::numbers("time_s", time));
    let signals = names.iter().map(move |name| match trace.take(name) {
        Some(values) => Column::numbers(name.clone(), values),
        None => column(name, Values::Number(vec![None; all])),
    });
    run.chain(split).chain(time).chain(signals)
}
