//! The data set of a campaign: a table with a row for each run, one with a row for each event, one with the
//! sampled signals. Columns are those that `stribeck_analysis::runs` declares.

mod records;
mod signals;

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::Path;

use anyhow::{Context, Result};
use serde_json::Value;
use stribeck_analysis::quantity::columns;
use stribeck_analysis::runs::{EventRow, OneOfMany, RunRow, Truth};
use stribeck_analysis::summary::Summary;
use stribeck_diagnosis::quantity::{Entry, Kind, Part};
use stribeck_formats::parquet::{Column, Values, Writer, write_table};
use stribeck_scene::scene_file::unknown_field;
use stribeck_store::campaign::{Campaign, Label, Variant};
use stribeck_store::run_dir::{Keep, RunDir};
use stribeck_store::trace::TraceFile;

use super::Folder;
use crate::many_runs::{Stage, summary_of};
use crate::place::shown;

pub(super) const RUNS: &str = "runs.parquet";
pub(super) const EVENTS: &str = "events.parquet";
pub(super) const SIGNALS: &str = "signals.parquet";
/// Folder of the records of a data set.
pub(super) const RECORDS: &str = "records";

/// Events that are written at a time: of many short runs, or of one long run with its predecessors.
const GROUP: usize = 1 << 16;

/// Columns of the tables, by their names; of a table that is not written none.
pub(super) struct Written {
    pub(super) runs: Vec<String>,
    pub(super) events: Vec<String>,
    pub(super) signals: Vec<String>,
    /// Files of the records of a data set.
    pub(super) records: Vec<String>,
}

pub(super) fn rows(folder: &Folder, campaign: &Campaign, stages: &[Stage]) -> Result<Vec<OneOfMany>> {
    let quantities = Summary::quantities();
    let row = |(variant, stage): (&Variant, &Stage)| -> Result<OneOfMany> {
        let scene = variant.scene.as_ref().ok();
        let (status, reason) = match stage {
            Stage::Done => ("complete", None),
            Stage::Failed(why) => ("failed", Some(why.clone())),
            Stage::Refused(why) => ("refused", Some(why.clone())),
            Stage::Due | Stage::Ended => ("not run", None),
        };
        let row = RunRow {
            run: variant.number,
            variant: variant.variant,
            start: variant.start,
            split: variant.split.to_owned(),
            status: status.to_owned(),
            reason,
            warnings: None,
            claimed: None,
            n_samples: None,
            truth: scene.map(|scene| Truth::of(scene, Label::of(scene).fault, scene.kinematics())),
        };
        let mut one = OneOfMany {
            row,
            values: variant.values.clone(),
            numbers: Default::default(),
            scene: scene.cloned(),
            program: None,
            folder: None,
        };
        if let (Stage::Done, Some(scene)) = (stage, scene) {
            let path = folder.0.run(scene);
            let dir = RunDir::open(&path)?;
            let info = dir.read_info()?;
            let of_machine = Some(dir.machine()).filter(|file| file.exists());
            let samples =
                of_machine.map(TraceFile::open).transpose()?.map_or(info.samples, |file| file.len());
            one.row.n_samples = Some(samples);
            one.folder = Some(format!("runs/{}", scene.hash()));
            let taken = summary_of(&path).and_then(|summary| Ok(one.take(&info, &summary, &quantities)?));
            taken.with_context(|| {
                format!(
                    "run {} has no numbers: remove `{}`, and the same command makes it again",
                    variant.number,
                    shown(&path)
                )
            })?;
        }
        Ok(one)
    };
    campaign.runs.iter().zip(stages).map(row).collect()
}

/// Writes the tables, each whole or not at all. That of the signals needs those of the runs.
pub(super) fn write(folder: &Folder, campaign: &Campaign, rows: &[OneOfMany]) -> Result<Written> {
    let notes = vec![
        ("campaign".to_owned(), campaign.text.clone()),
        ("stribeck".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
    ];
    let names = |columns: &[Column]| columns.iter().map(|column| column.name.clone()).collect();
    let of_runs = of_runs(campaign, rows);
    replace(&folder.path().join(RUNS), |path| Ok(write_table(path, &of_runs, &notes)?))?;
    replace(&folder.path().join(EVENTS), |path| events(folder.path(), path, rows, &notes))?;
    let events = declared::<EventRow>(std::iter::empty());
    let mut written =
        Written { runs: names(&of_runs), events: names(&events), signals: Vec::new(), records: Vec::new() };
    if let Some(data_set) = &campaign.data_set {
        written.records = records::write(folder.path(), rows, data_set.parts, &notes)?;
    } else if campaign.keep != Keep::Numbers {
        let signals = signals::names(folder.path(), rows)?;
        replace(&folder.path().join(SIGNALS), |path| {
            signals::write((folder.path(), path), rows, &signals, &notes)
        })?;
        written.signals = signals::columns(&signals);
    }
    Ok(written)
}

/// The columns of a type's entries, of rows as files have them.
fn declared<T: Part>(rows: impl Iterator<Item = Value>) -> Vec<Column> {
    let empty = |kind: Kind| match kind.single() {
        Kind::Text => Values::Text(Vec::new()),
        Kind::Whole => Values::Count(Vec::new()),
        Kind::Flag => Values::Flag(Vec::new()),
        _ => Values::Number(Vec::new()),
    };
    let column = |entry: &Entry| Column { name: entry.name.to_owned(), values: empty(entry.kind) };
    let mut all: Vec<Column> = columns::<T>().into_iter().map(column).collect();
    for row in rows {
        for column in &mut all {
            let cell = row.get(&column.name);
            match &mut column.values {
                Values::Text(of) => of.push(cell.and_then(Value::as_str).map(str::to_owned)),
                Values::Count(of) => of.push(cell.and_then(Value::as_i64)),
                Values::Flag(of) => of.push(cell.and_then(Value::as_bool)),
                Values::Number(of) => of.push(cell.and_then(Value::as_f64)),
                Values::Series(_) => {}
            }
        }
    }
    all
}

/// The table of the runs: declared entries, fields that vary, numbers of the summaries.
fn of_runs(campaign: &Campaign, rows: &[OneOfMany]) -> Vec<Column> {
    let row = |one: &OneOfMany| serde_json::to_value(&one.row).expect("names and numbers alone");
    let mut all = declared::<RunRow>(rows.iter().map(row));
    for (at, field) in campaign.fields.iter().enumerate() {
        let numbers: Option<Vec<f64>> = rows.iter().map(|one| one.value(&campaign.fields, at)).collect();
        let text = |one: &OneOfMany| one.values.get(at).map(|value| value.trim_matches('"').to_owned());
        let values = match numbers {
            Some(numbers) => Values::Number(numbers.into_iter().map(Some).collect()),
            None => Values::Text(rows.iter().map(text).collect()),
        };
        // A name that is no field is drawn.
        let of = if unknown_field(field).is_some() { "drawn" } else { "scene" };
        all.push(Column { name: format!("{of}.{field}"), values });
    }
    let names: BTreeSet<&String> = rows.iter().flat_map(|one| one.numbers.keys()).collect();
    all.extend(names.into_iter().map(|name| Column {
        name: format!("summary.{name}"),
        values: Values::Number(rows.iter().map(|one| one.numbers.get(name).copied()).collect()),
    }));
    all
}

/// Writes the events run by run, those of a run in the order of its summary.
fn events(folder: &Path, to: &Path, rows: &[OneOfMany], notes: &[(String, String)]) -> Result<()> {
    let mut writer = Writer::create(to, &declared::<EventRow>(std::iter::empty()), notes)?;
    let mut waiting: Vec<Value> = Vec::new();
    for one in rows {
        let Some(run) = &one.folder else { continue };
        let mut summary = summary_of(&folder.join(run))?;
        let of_run = summary.get_mut("events").and_then(Value::as_array_mut).map(std::mem::take);
        waiting.extend(of_run.unwrap_or_default().into_iter().map(|mut event| {
            event["run"] = one.row.run.into();
            event["split"] = one.row.split.as_str().into();
            event
        }));
        if waiting.len() >= GROUP {
            writer.add(declared::<EventRow>(waiting.drain(..)))?;
        }
    }
    if !waiting.is_empty() {
        writer.add(declared::<EventRow>(waiting.into_iter()))?;
    }
    Ok(writer.finish()?)
}

/// End of the name of a file that is not yet whole.
const HALF_WRITTEN: &str = ".new";

/// Whether a file of this name is one that [`replace`] was making.
pub(super) fn is_half_written(name: &OsStr) -> bool {
    let mut parts =
        name.to_str().and_then(|name| name.strip_suffix(HALF_WRITTEN)).unwrap_or_default().rsplit('.');
    parts.next().is_some_and(|process| process.parse::<u32>().is_ok()) && parts.next().is_some()
}

/// Writes a file beside `path` by `write`, then renames it to `path`. Parts that write the same file at once
/// do not conflict: each has a name of its own until then.
pub(super) fn replace(path: &Path, write: impl FnOnce(&Path) -> Result<()>) -> Result<()> {
    let beside = path.with_extension(format!("{}{HALF_WRITTEN}", std::process::id()));
    let written = write(&beside).and_then(|()| {
        // The name must not reach the disk before the content.
        std::fs::File::open(&beside)?.sync_data()?;
        Ok(std::fs::rename(&beside, path)?)
    });
    if written.is_err() {
        std::fs::remove_file(&beside).ok();
    }
    written.with_context(|| format!("cannot write `{}`", path.display()))
}
