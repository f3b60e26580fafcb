//! The data set of a campaign: one table with a row for each run, one with the sampled signals.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde_json::Value;
use stribeck_formats::parquet::{Column, Values, Writer, write_table};
use stribeck_scene::campaign::Campaign;
use stribeck_scene::deviation::RollingSurface;
use stribeck_scene::kinematics::Kinematics;
use stribeck_scene::run_dir::{Keep, RunDir, SENSOR};
use stribeck_scene::run_info::Status;
use stribeck_scene::scene::Scene;
use stribeck_scene::trace::{Trace, TraceFile};

use super::{Folder, Stage, summary_of};

/// Names of the two tables.
pub(super) const RUNS: &str = "runs.parquet";
pub(super) const SIGNALS: &str = "signals.parquet";

/// One run in the table. What depends on the machine or on interruptions, such as seconds, stays in its folder.
pub(super) struct Row {
    pub(super) number: usize,
    pub(super) split: &'static str,
    pub(super) status: &'static str,
    pub(super) reason: Option<String>,
    variant: usize,
    start: usize,
    values: Vec<String>,
    scene: Option<Scene>,
    folder: Option<PathBuf>,
    /// Numbers of the summary by their path.
    numbers: BTreeMap<String, f64>,
    samples: Option<i64>,
}

/// Reads what the runs left.
pub(super) fn rows(folder: &Folder, campaign: &Campaign, stages: &[Stage]) -> Result<Vec<Row>> {
    let row = |(variant, stage): (&stribeck_scene::campaign::Variant, &Stage)| -> Result<Row> {
        let mut row = Row {
            number: variant.number,
            split: variant.split,
            status: "complete",
            reason: None,
            variant: variant.variant,
            start: variant.start,
            values: variant.values.clone(),
            scene: variant.scene.clone().ok(),
            folder: None,
            numbers: BTreeMap::new(),
            samples: None,
        };
        match (stage, &variant.scene) {
            (Stage::Done, Ok(scene)) => {
                let path = folder.run(scene);
                let info = RunDir::open(&path)?.read_info()?;
                if info.status == Status::Diverged {
                    (row.status, row.reason) = ("diverged", info.stop_reason);
                }
                flatten(&summary_of(&path)?, "", &mut row.numbers);
                row.numbers.insert("energy.max_relative_error".into(), info.energy.max_relative_error);
                row.samples = i64::try_from(info.samples).ok();
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

/// All numbers of a summary that stand alone, by their path; lists are left to the run's folder, clocks as well.
fn flatten(value: &Value, path: &str, to: &mut BTreeMap<String, f64>) {
    match value {
        Value::Object(fields) => {
            for (name, inner) in fields.iter().filter(|(name, _)| !(path.is_empty() && *name == "run")) {
                let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
                flatten(inner, &path, to);
            }
        }
        Value::Number(number) => drop(number.as_f64().map(|number| to.insert(path.to_owned(), number))),
        _ => {}
    }
}

/// Writes both tables, each whole or not at all; gives the columns of the first. The second needs the runs' signals.
pub(super) fn write(folder: &Folder, campaign: &Campaign, rows: &[Row]) -> Result<Vec<String>> {
    let columns = columns(campaign, rows);
    let notes = vec![
        ("campaign".to_owned(), campaign.text.clone()),
        ("stribeck".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
    ];
    replace(&folder.0.join(RUNS), |path| Ok(write_table(path, &columns, &notes)?))?;
    if campaign.keep != Keep::Numbers {
        replace(&folder.0.join(SIGNALS), |path| signals(path, rows, &notes))?;
    }
    Ok(columns.into_iter().map(|column| column.name).collect())
}

/// Lets `write` make a file beside `path`, then puts it in its place. Parts that write the same file at once do not meet: each has
/// a name of its own until then.
pub(super) fn replace(path: &Path, write: impl FnOnce(&Path) -> Result<()>) -> Result<()> {
    let beside = path.with_extension(format!("{}.new", std::process::id()));
    write(&beside)?;
    std::fs::rename(&beside, path).with_context(|| format!("cannot replace `{}`", path.display()))
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
    let kinematic = |name: &str, of: &dyn Fn(&Kinematics) -> f64| of_scene(name, &|s| of(&Kinematics::of(s)));
    let as_count = |n: usize| i64::try_from(n).ok();
    let mut columns = vec![
        count("run", &|row| as_count(row.number)),
        count("variant", &|row| as_count(row.variant)),
        count("start", &|row| as_count(row.start)),
        text("split", &|row| Some(row.split.to_owned())),
        text("status", &|row| Some(row.status.to_owned())),
        text("reason", &|row| row.reason.clone()),
        text("scene_hash", &|row| row.scene.as_ref().map(Scene::hash)),
        text("bearing", &|row| row.scene.as_ref().map(|s| s.bearing.designation.clone())),
        text("fault_location", &|row| row.scene.as_ref().map(fault)),
        number("fault_size_mm", &|row| row.scene.as_ref().and_then(fault_size_mm)),
        of_scene("shaft_speed_rpm", &|s| s.operation.speed_rpm),
        of_scene("load_n", &|s| s.operation.load_n),
        of_scene("sampling_rate_hz", &|s| (1e6 / s.output.interval_us * 1e3).round() / 1e3),
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
    columns.extend(names.into_iter().map(|name| {
        number(&format!("summary.{name}"), &|row| row.numbers.get(name).copied().filter(|n| n.is_finite()))
    }));
    columns
}

/// Where the defect is, in the words of data sets.
fn fault(scene: &Scene) -> String {
    let name = |on: &RollingSurface| match on {
        RollingSurface::Outer => "outer_race",
        RollingSurface::Inner => "inner_race",
        RollingSurface::Roller(_) => "rolling_element",
    };
    // In their order: rollers come last, one beside the other.
    let mut names: Vec<&str> = scene.faults().iter().map(name).collect();
    names.dedup();
    if scene.rollers_in_place().count() < scene.bearing.rollers {
        names.push("missing_rolling_element");
    }
    if names.is_empty() { "healthy".to_owned() } else { names.join("+") }
}

/// Length of the first defect along its surface [mm].
fn fault_size_mm(scene: &Scene) -> Option<f64> {
    let of_defect = scene.defect.as_ref().map(|defect| defect.length_mm);
    of_defect.or_else(|| scene.defects.iter().find_map(|deviation| deviation.form.length_mm()))
}

/// One group of rows for each run that has signals: a row a sample. The signals of one run are in memory at a time.
fn signals(path: &Path, rows: &[Row], notes: &[(String, String)]) -> Result<()> {
    let recorded = || {
        rows.iter().filter_map(|row| {
            let dir = RunDir::open(row.folder.as_ref()?).ok()?;
            Some((row, if dir.signals().exists() { dir.signals() } else { dir.trace() }))
        })
    };
    let mut names = BTreeSet::new();
    for (_, file) in recorded() {
        names.extend(TraceFile::open(file)?.names().iter().filter(|name| name.starts_with(SENSOR)).cloned());
    }
    let schema: Vec<Column> = group(None, &names, Trace::default()).collect();
    let mut writer = Writer::create(path, &schema, notes)?;
    for (row, file) in recorded() {
        let file = TraceFile::open(file)?;
        let trace = file.read(0..file.len(), |name| name == "time_s" || name.starts_with(SENSOR))?;
        writer.add(group(Some(row), &names, trace))?;
    }
    writer.finish()?;
    Ok(())
}

/// The columns of a run's signals; one that it has not recorded is empty.
fn group<'a>(
    row: Option<&'a Row>,
    names: &'a BTreeSet<String>,
    mut trace: Trace,
) -> impl Iterator<Item = Column> + use<'a> {
    let all = trace.len();
    let column = |name: &str, values| Column { name: name.to_owned(), values };
    let run = move || row.and_then(|row| i64::try_from(row.number).ok());
    let split = move || row.map(|row| row.split.to_owned());
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
