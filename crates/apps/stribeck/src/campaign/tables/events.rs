//! The events of all runs: a row for each passage of a roller over a spall, as the summaries of the runs have
//! them.

use std::path::Path;

use anyhow::{Context, Result};
use stribeck_analysis::summary::Event;
use stribeck_formats::parquet::{Column, Values, Writer};

use super::Row;
use crate::many_runs::summary_of;

/// Rows that are written at a time: of many short runs, or of one long run with its predecessors.
const GROUP: usize = 1 << 16;

/// The name of a number of an event, and where it stands.
type Field = (&'static str, fn(&Event) -> Option<f64>);

/// Numbers of an event, under the names of `summary.json`.
const NUMBERS: [Field; 15] = [
    ("expected_entry_ms", |e| Some(e.expected_entry_ms)),
    ("expected_exit_ms", |e| Some(e.expected_exit_ms)),
    ("path_entry_ms", |e| e.path_entry_ms),
    ("path_exit_ms", |e| e.path_exit_ms),
    ("entry_ms", |e| e.entry_ms),
    ("exit_ms", |e| e.exit_ms),
    ("free_ms", |e| e.free_ms),
    ("level_n", |e| e.level_n),
    ("floor_ms", |e| e.floor_ms),
    ("floor_n", |e| e.floor_n),
    ("compensation_ms", |e| e.compensation_ms),
    ("compensation_n", |e| e.compensation_n),
    ("compensation_gain", |e| e.compensation_gain),
    ("impulse_g", |e| e.impulse_g),
    ("spall_mm", |e| e.spall_mm),
];

/// An event and the run that it is of.
pub(super) type Found<'a> = (&'a Row, Event);

/// The table of some events.
pub(super) fn columns(events: &[Found<'_>]) -> Vec<Column> {
    let column = |name: &str, values| Column { name: name.to_owned(), values };
    let count = |name: &str, of: &dyn Fn(&Found<'_>) -> usize| {
        column(name, Values::Count(events.iter().map(|event| i64::try_from(of(event)).ok()).collect()))
    };
    let text = |name: &str, of: &dyn Fn(&Found<'_>) -> &'static str| {
        column(name, Values::Text(events.iter().map(|event| Some(of(event).to_owned())).collect()))
    };
    let mut columns = vec![
        count("run", &|(row, _)| row.number),
        text("split", &|(row, _)| row.split),
        count("roller", &|(_, event)| event.roller),
        count("spall", &|(_, event)| event.spall),
        text("ring", &|(_, event)| event.ring.name()),
    ];
    columns.extend(NUMBERS.iter().map(|(name, of)| {
        let finite = |event: &Event| of(event).filter(|number| number.is_finite());
        column(name, Values::Number(events.iter().map(|(_, event)| finite(event)).collect()))
    }));
    let by = |(_, event): &Found<'_>| event.floor_by.map(|by| by.name().to_owned());
    columns.push(column("floor_by", Values::Text(events.iter().map(by).collect())));
    columns
}

/// Writes them run by run, those of a run in the order of its summary.
pub(super) fn write(path: &Path, rows: &[Row], notes: &[(String, String)]) -> Result<()> {
    let mut writer = Writer::create(path, &columns(&[]), notes)?;
    let mut waiting: Vec<Found<'_>> = Vec::new();
    for row in rows {
        let Some(folder) = &row.folder else { continue };
        let of_run = summary_of(folder)?.get_mut("events").map(serde_json::Value::take).unwrap_or_default();
        let of_run: Vec<Event> = serde_json::from_value(of_run)
            .with_context(|| format!("`{}` has other events than this program writes", folder.display()))?;
        waiting.extend(of_run.into_iter().map(|event| (row, event)));
        if waiting.len() >= GROUP {
            writer.add(columns(&waiting))?;
            waiting.clear();
        }
    }
    if !waiting.is_empty() {
        writer.add(columns(&waiting))?;
    }
    Ok(writer.finish()?)
}
