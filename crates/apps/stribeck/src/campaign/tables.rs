//! The data set of a campaign: a table with a row for each run, one with a row for each event, one with the
//! sampled signals.

mod events;
mod signals;
mod truth;

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde_json::Value;
use stribeck_analysis::summary::Summary;
use stribeck_formats::parquet::{Column, Values, write_table};
use stribeck_scene::scene::Scene;
use stribeck_store::campaign::{Campaign, Variant};
use stribeck_store::run_dir::{Keep, RunDir};
use stribeck_store::run_info::{Status, Topic};
use stribeck_store::trace::TraceFile;
use stribeck_theory::kinematics::Kinematics;

use super::Folder;
use crate::many_runs::{Stage, summary_of};
pub(super) use truth::{Truth, model};

pub(super) const RUNS: &str = "runs.parquet";
pub(super) const EVENTS: &str = "events.parquet";
pub(super) const SIGNALS: &str = "signals.parquet";

/// One run in the table. Values that depend on the computer or on interruptions, such as seconds, stay in its
/// folder.
pub(super) struct Row {
    pub(super) number: usize,
    pub(super) split: &'static str,
    pub(super) status: &'static str,
    pub(super) reason: Option<String>,
    pub(super) warnings: Option<String>,
    variant: usize,
    pub(super) start: usize,
    pub(super) values: Vec<String>,
    pub(super) scene: Option<Scene>,
    /// Families that are claimed in its record, joined by `+`; `none` where it shows none, `None` where it
    /// is not judged.
    pub(super) claimed: Option<String>,
    /// Version and commit of the program that ran it.
    pub(super) program: Option<String>,
    pub(super) folder: Option<PathBuf>,
    pub(super) numbers: BTreeMap<String, f64>,
    samples: Option<i64>,
}

impl Row {
    pub(super) fn is_complete(&self) -> bool {
        self.status == "complete"
    }
}

/// Columns of the tables, by their names; of a table that is not written none.
pub(super) struct Written {
    pub(super) runs: Vec<String>,
    pub(super) events: Vec<String>,
    pub(super) signals: Vec<String>,
}

pub(super) fn rows(folder: &Folder, campaign: &Campaign, stages: &[Stage]) -> Result<Vec<Row>> {
    let quantities = Summary::quantities();
    let row = |(variant, stage): (&Variant, &Stage)| -> Result<Row> {
        let mut row = Row {
            number: variant.number,
            split: variant.split,
            status: "complete",
            reason: None,
            warnings: None,
            variant: variant.variant,
            start: variant.start,
            values: variant.values.clone(),
            scene: variant.scene.clone().ok(),
            claimed: None,
            program: None,
            folder: None,
            numbers: BTreeMap::new(),
            samples: None,
        };
        match (stage, &variant.scene) {
            (Stage::Done, Ok(scene)) => {
                let path = folder.0.run(scene);
                let info = RunDir::open(&path)?.read_info()?;
                if info.status == Status::Diverged {
                    (row.status, row.reason) = ("diverged", info.stop_reason.clone());
                }
                let summary = summary_of(&path)?;
                // Those outside of lists, without clocks.
                let of_table = quantities.iter().filter(|q| !q.is_listed && !q.path.starts_with("run."));
                row.numbers.extend(of_table.filter_map(|q| Some((q.path.clone(), q.number(&summary)?))));
                row.claimed = diagnosed(&summary, &mut row.numbers);
                row.numbers.insert("energy.max_relative_error".into(), info.energy.max_relative_error);
                // An overflow is no number, and a column without numbers is none.
                row.numbers.retain(|_, number| number.is_finite());
                // What a disk refused is no property of the run.
                let of_run = info.warned().filter(|(topic, _)| *topic != Some(Topic::Checkpoint));
                let warnings: Vec<&str> = of_run.map(|(_, words)| words.as_str()).collect();
                row.warnings = (!warnings.is_empty()).then(|| warnings.join("\n"));
                row.program = Some(format!("{} ({})", info.version, info.commit));
                let machine = RunDir::open(&path)?.machine();
                let samples = if machine.exists() { TraceFile::open(machine)?.len() } else { info.samples };
                row.samples = i64::try_from(samples).ok();
                row.folder = Some(path);
            }
            (Stage::Failed(why), _) => (row.status, row.reason) = ("failed", Some(why.clone())),
            (Stage::Refused(why), _) => (row.status, row.reason) = ("refused", Some(why.clone())),
            _ => row.status = "not run",
        }
        Ok(row)
    };
    campaign.runs.iter().zip(stages).map(row).collect()
}

/// Families without a verdict on which a record has none.
const RACEWAYS: [&str; 2] = ["BPFO", "BPFI"];

/// The families that are claimed, `none`, or `undecided` where the machine's own lines hide a raceway's; the
/// levels of all go to the numbers.
fn diagnosed(summary: &Value, to: &mut BTreeMap<String, f64>) -> Option<String> {
    let families = summary.pointer("/diagnosis/families")?.as_array()?;
    let (mut claimed, mut is_open) = (Vec::new(), false);
    for family in families {
        let name = family.get("name")?.as_str()?;
        if let Some(level_db) = family.get("level_db").and_then(Value::as_f64) {
            to.insert(format!("diagnosis.{}_level_db", name.to_lowercase()), level_db);
        }
        if family.get("claimed").and_then(Value::as_bool) == Some(true) {
            claimed.push(name);
        }
        let is_undecided = family.get("undecided").and_then(Value::as_bool) == Some(true);
        is_open |= is_undecided && RACEWAYS.contains(&name);
    }
    Some(match (claimed.as_slice(), is_open) {
        ([], true) => "undecided".to_owned(),
        ([], false) => "none".to_owned(),
        (claimed, _) => claimed.join("+"),
    })
}

/// Writes the tables, each whole or not at all. That of the signals needs those of the runs.
pub(super) fn write(folder: &Folder, campaign: &Campaign, rows: &[Row]) -> Result<Written> {
    let notes = vec![
        ("campaign".to_owned(), campaign.text.clone()),
        ("stribeck".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
    ];
    let names = |columns: Vec<Column>| columns.into_iter().map(|column| column.name).collect();
    let columns = columns(campaign, rows);
    replace(&folder.path().join(RUNS), |path| Ok(write_table(path, &columns, &notes)?))?;
    replace(&folder.path().join(EVENTS), |path| events::write(path, rows, &notes))?;
    let mut written =
        Written { runs: names(columns), events: names(events::columns(&[])), signals: Vec::new() };
    if campaign.keep != Keep::Numbers {
        let signals = signals::names(rows)?;
        replace(&folder.path().join(SIGNALS), |path| signals::write(path, rows, &signals, &notes))?;
        written.signals = signals::columns(&signals);
    }
    Ok(written)
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

fn columns(campaign: &Campaign, rows: &[Row]) -> Vec<Column> {
    let text = |name: &str, of: &dyn Fn(&Row) -> Option<String>| Column {
        name: name.to_owned(),
        values: Values::Text(rows.iter().map(of).collect()),
    };
    let count = |name: &str, of: &dyn Fn(&Row) -> Option<i64>| Column {
        name: name.to_owned(),
        values: Values::Count(rows.iter().map(of).collect()),
    };
    let number = |name: &str, of: &dyn Fn(&Row) -> Option<f64>| Column {
        name: name.to_owned(),
        values: Values::Number(rows.iter().map(of).collect()),
    };
    let of_scene = |name: &str, of: &dyn Fn(&Scene) -> f64| number(name, &|row| row.scene.as_ref().map(of));
    let kinematic = |name: &str, of: &dyn Fn(&Kinematics) -> f64| of_scene(name, &|s| of(&s.kinematics()));
    let as_count = |n: usize| i64::try_from(n).ok();
    let truth = |row: &Row| row.scene.as_ref().map(Truth::of);
    let mut columns = vec![
        count("run", &|row| as_count(row.number)),
        count("variant", &|row| as_count(row.variant)),
        count("start", &|row| as_count(row.start)),
        text("split", &|row| Some(row.split.to_owned())),
        text("status", &|row| Some(row.status.to_owned())),
        text("reason", &|row| row.reason.clone()),
        text("warnings", &|row| row.warnings.clone()),
        text("scene_hash", &|row| row.scene.as_ref().map(Scene::hash)),
        text("bearing", &|row| row.scene.as_ref().map(|s| s.bearing.designation.clone())),
        text("model", &|row| row.scene.as_ref().map(|s| model(s).to_owned())),
        text("fault_location", &|row| truth(row).map(|t| t.location)),
        text("fault_type", &|row| truth(row)?.form),
        count("fault_count", &|row| as_count(truth(row)?.count)),
        number("fault_size_mm", &|row| Some(truth(row)?.first?.length_mm)),
        number("fault_depth_mm", &|row| Some(truth(row)?.first?.depth_mm)),
        number("fault_angle_deg", &|row| Some(truth(row)?.first?.angle_deg)),
        text("deviation_type", &|row| truth(row)?.deviations),
        text("claimed", &|row| row.claimed.clone()),
        of_scene("shaft_speed_rpm", &|s| s.operation.speed_rpm),
        of_scene("load_n", &|s| s.operation.load_n),
        of_scene("sampling_rate_hz", &sampling_rate_hz),
        count("n_samples", &|row| row.samples),
        kinematic("bpfo_hz", &|k| k.bpfo_hz),
        kinematic("bpfi_hz", &|k| k.bpfi_hz),
        kinematic("bsf_hz", &|k| k.bsf_hz),
        kinematic("ftf_hz", &|k| k.cage_hz),
    ];
    for (at, field) in campaign.fields.iter().enumerate() {
        let name = format!("scene.{field}");
        let numbers: Option<Vec<f64>> = rows.iter().map(|row| row.values.get(at)?.parse().ok()).collect();
        columns.push(match numbers {
            Some(numbers) => Column::numbers(name, numbers),
            None => text(&name, &|row| row.values.get(at).map(|value| value.trim_matches('"').to_owned())),
        });
    }
    let names: BTreeSet<&String> = rows.iter().flat_map(|row| row.numbers.keys()).collect();
    columns.extend(
        names
            .into_iter()
            .map(|name| number(&format!("summary.{name}"), &|row| row.numbers.get(name).copied())),
    );
    columns
}

/// Samples of its signals a second, to a thousandth.
pub(super) fn sampling_rate_hz(scene: &Scene) -> f64 {
    let of_run = 1e6 / scene.output.interval_us;
    let rate_hz = scene.housing.machine().map_or(of_run, |machine| machine.sensor.rate_hz);
    (rate_hz * 1e3).round() / 1e3
}
