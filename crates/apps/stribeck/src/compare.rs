//! `stribeck compare`: runs, ensembles and measured records beside each other.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::Error as AnalysisError;
use stribeck_analysis::comparison::{Comparison, Row, Side};
use stribeck_report::{MOST_COMPARED, by_chance, comparison_in_words, difference, mean, write_comparison};
use stribeck_store::run_dir::{RunDir, check_folder};

use crate::analyse::{Reading, Speed, examine};
use crate::out::{say, tell};
use crate::place::{Place, shown};

/// Flags of `compare`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Two or more of: the folder of a run or of an ensemble, its name below runs/, a file of a measured
    /// record. The first is the reference
    #[arg(required = true, num_args = 2.., value_name = "RUN_OR_FILE")]
    sides: Vec<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// Folder for compare.json and report.html [default: A-and-B-compared in the working folder]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// File that marks the folder of a comparison.
const MARK: &str = "compare.json";

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    options.reading.limits.apply();
    let out = options.out.clone().unwrap_or_else(|| default_folder(&labels(&options.sides)));
    let comparison = write(&options.sides, &options.reading, &out, place)?;
    print(&comparison);
    say!("page: {}", shown(&out.join("report.html")));
    Ok(ExitCode::SUCCESS)
}

/// Compares sides and writes their page into `out`.
pub(crate) fn write(asked: &[PathBuf], reading: &Reading, out: &Path, place: &Place) -> Result<Comparison> {
    ensure!(
        asked.len() <= MOST_COMPARED,
        "{} sides were given, and the curves of {MOST_COMPARED} stay apart at most: compare fewer, or see \
         the course of many records by `{} analyse`",
        asked.len(),
        place.program
    );
    let labels = labels(asked);
    check_folder(out, &[MARK])?;
    let mut sides: Vec<Option<Side>> = Vec::new();
    let folders: Vec<Option<PathBuf>> =
        asked.iter().map(|asked| folder(asked, place)).collect::<Result<_>>()?;
    // Runs first: a record may be of the same machine.
    let mixed = folders.iter().any(Option::is_none);
    for (folder, label) in folders.iter().zip(&labels) {
        let channel = reading.channel.as_deref();
        sides.push(folder.as_ref().map(|folder| of_folder(label, folder, channel, mixed)).transpose()?);
    }
    let reading = completed(reading, &sides);
    for ((asked, label), side) in asked.iter().zip(&labels).zip(&mut sides) {
        if side.is_none() {
            tell!("{label} …");
            let examined = examine(asked, &reading.0, place);
            let analysis = examined.with_context(|| format!("`{}` cannot be compared", asked.display()))?;
            let mut record = Side::of_record(label, &analysis);
            record.notes.extend(reading.1.iter().cloned());
            *side = Some(record);
        }
    }
    let comparison = Comparison::of(sides.into_iter().flatten().collect())?;
    write_comparison(out, &comparison)?;
    Ok(comparison)
}

/// The folder of a run or ensemble; `None` for a file.
fn folder(asked: &Path, place: &Place) -> Result<Option<PathBuf>> {
    let path = place.locate_run(asked);
    place.refuse_scene(&path)?;
    if path.is_file() {
        return Ok(None);
    }
    if !path.exists() {
        let known = known(place);
        let known = if known.is_empty() {
            format!(
                "`{}` holds no runs. `{} simulate` makes one; a measured record is given by its file",
                shown(&place.runs()),
                place.program
            )
        } else {
            format!("`{}` holds {known}", shown(&place.runs()))
        };
        bail!("`{}` is no file and no run: {known}", asked.display());
    }
    let of_trace = |name: &str| path.join(name).exists();
    ensure!(
        RunDir::is_ensemble(&path) || of_trace("run.json"),
        "`{}` is a folder, and no run: {}",
        asked.display(),
        if of_trace("runs.parquet") || of_trace("campaign.ron") {
            "it holds a campaign; name runs below its `runs/`"
        } else {
            "give the folder of a run, of an ensemble, or a file of signals"
        }
    );
    Ok(Some(path))
}

/// Names of some runs below `runs/`.
fn known(place: &Place) -> String {
    const MOST: usize = 8;
    let entries = std::fs::read_dir(place.runs()).into_iter().flatten().flatten();
    let runs =
        entries.filter(|entry| RunDir::is_ensemble(entry.path()) || entry.path().join("run.json").exists());
    let names: BTreeSet<String> =
        runs.map(|entry| format!("`{}`", entry.file_name().to_string_lossy())).collect();
    let more = names.len().saturating_sub(MOST);
    let shown = names.into_iter().take(MOST).collect::<Vec<_>>().join(", ");
    if more > 0 { format!("{shown} and {more} more") } else { shown }
}

/// The side of a run or ensemble. Beside records, a channel that only they have is theirs, and the run's is
/// its leading sensor.
fn of_folder(label: &str, folder: &Path, channel: Option<&str>, mixed: bool) -> Result<Side> {
    tell!("{label} …");
    let side = match Side::of_folder(label, folder, channel) {
        Err(AnalysisError::NoSignal(_)) if mixed && channel.is_some() => Side::of_folder(label, folder, None),
        side => side,
    };
    side.with_context(|| format!("`{}` cannot be compared", shown(folder)))
}

/// Bearing and speed of a record, taken from a run beside it where the record has none, with a note.
fn completed(reading: &Reading, sides: &[Option<Side>]) -> (Reading, Option<String>) {
    let mut reading = reading.clone();
    let run = sides.iter().flatten().find(|side| side.scene.is_some());
    let Some((run, scene)) = run.and_then(|run| Some((run, run.scene.as_ref()?))) else {
        return (reading, None);
    };
    // The requested channel applies to runs, too.
    let mut taken = Vec::new();
    if reading.bearing.is_none() {
        let b = &scene.bearing;
        let pitch_mm = 0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm);
        reading.bearing = Some(format!(
            "elements={}, diameter_mm={}, pitch_mm={pitch_mm}, angle_deg=0",
            b.rollers, b.roller_diameter_mm
        ));
        taken.push("bearing");
    }
    if reading.speed_rpm.is_none()
        && reading.tacho.is_none()
        && let Some(hz) = run.shaft_hz
    {
        reading.speed_rpm = Some(Speed::Of(60.0 * hz));
        taken.push("speed");
    }
    let note = format!(
        "its {} taken from `{}`; `--bearing` and `--speed-rpm` say another",
        if taken.len() == 2 { "bearing and speed are".to_owned() } else { format!("{} is", taken.join("")) },
        run.label
    );
    (reading, (!taken.is_empty()).then_some(note))
}

/// Names of the sides: those of their folders or files, or where two are the same, as they were given.
fn labels(sides: &[PathBuf]) -> Vec<String> {
    let name = |path: &PathBuf| {
        let name = if path.is_dir() { path.file_name() } else { path.file_stem() };
        name.map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
    };
    let names: Vec<String> = sides.iter().map(name).collect();
    let label = |(at, name): (usize, &String)| {
        let unique = names.iter().filter(|other| *other == name).count() == 1;
        let path = sides[at].display().to_string();
        let same = sides.iter().filter(|other| **other == sides[at]).count() > 1;
        match (unique, same) {
            (true, _) => name.clone(),
            (false, false) => path,
            (false, true) => format!("{path} ({})", at + 1),
        }
    };
    names.iter().enumerate().map(label).collect()
}

fn default_folder(labels: &[String]) -> PathBuf {
    let name = |label: &String| label.replace(|c: char| !(c.is_alphanumeric() || "-_.".contains(c)), "-");
    let named = labels.iter().take(2).map(name).collect::<Vec<_>>().join("-and-");
    let more = labels.len().saturating_sub(2);
    let rest = if more > 0 { format!("-and-{more}-more") } else { String::new() };
    PathBuf::from(format!("{named}{rest}-compared"))
}

fn print(comparison: &Comparison) {
    for line in comparison_in_words(comparison) {
        say!("{line}");
    }
    for field in &comparison.fields {
        let values: Vec<&str> = field.values.iter().map(|value| value.as_deref().unwrap_or("–")).collect();
        say!("  {:<36} {}", field.field, values.join("  |  "));
    }
    for row in &comparison.rows {
        say!("  {}", in_line(row, &comparison.sides));
    }
    for note in &comparison.notes {
        say!("  note: {note}");
    }
}

fn in_line(row: &Row, sides: &[Side]) -> String {
    let unit = if row.unit.is_empty() { String::new() } else { format!(" [{}]", row.unit) };
    let values: Vec<String> =
        row.values.iter().map(|value| value.as_ref().map_or("–".to_owned(), mean)).collect();
    let contrasts: Vec<String> = row
        .against_first
        .iter()
        .flatten()
        .map(|contrast| format!("{}, {}", difference(contrast), by_chance(contrast, sides)))
        .collect();
    let what = format!("{}{unit}", row.quantity);
    format!("{what:<44} {}  {}", values.join("  |  "), contrasts.join("  |  ")).trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_equal_names_keep_their_paths_apart() {
        let of = |paths: &[&str]| labels(&paths.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(of(&["a/x.csv", "b/y.csv"]), ["x", "y"]);
        assert_eq!(of(&["a/x.csv", "b/x.csv", "y.mat"]), ["a/x.csv", "b/x.csv", "y"]);
        assert_eq!(of(&["x.csv", "x.csv"]), ["x.csv (1)", "x.csv (2)"]);
        assert_eq!(
            default_folder(&of(&["a/x.csv", "b/x.csv", "y.mat"])),
            PathBuf::from("a-x.csv-and-b-x.csv-and-1-more-compared")
        );
    }
}
