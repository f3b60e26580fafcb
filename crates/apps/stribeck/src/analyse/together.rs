//! `analyse --together`: several channels of one machine, recorded at one time, and one verdict on them.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use stribeck_diagnosis::Analysis;
use stribeck_diagnosis::joint::Joint;
use stribeck_formats::{Recording, says_time};
use stribeck_report::{SeriesRecord, write_joint, write_measured};
use stribeck_store::run_dir::{check_folder, write_atomic};

use super::reading::{located, moves};
use super::{Options, Reading, Speed, examine};
use crate::out::say;
use crate::place::{Place, shown};

/// The joint verdict as a file.
const JOINT: &str = "joint.json";
/// Relative difference within which two channels agree on the speed.
const SAME_SPEED: f64 = 0.01;

struct Source {
    file: PathBuf,
    /// `None` for the one that the file's reading picks.
    channel: Option<String>,
    name: String,
}

pub(super) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let sources = sources(&options.files, &options.reading, place)?;
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("joint-analysis"));
    check_folder(&out, &[JOINT])?;
    std::fs::create_dir_all(&out).with_context(|| format!("cannot make `{}`", shown(&out)))?;
    // Until the verdict is written, an empty one marks the folder as this command's.
    if !out.join(JOINT).exists() {
        write_atomic(&out.join(JOINT), b"{}")?;
    }
    let analyses = analyses(&sources, &options.reading, place)?;
    let names = sources.iter().map(|source| source.name.clone());
    let channels: Vec<(String, &Analysis)> = names.zip(&analyses).collect();
    let joint = Joint::of(&channels).context("two channels at least make a joint verdict")?;
    let digits = sources.len().to_string().len();
    let mut entries = Vec::new();
    for (at, (source, analysis)) in sources.iter().zip(&analyses).enumerate() {
        let folder = format!("{:0digits$}-{}", at + 1, source.name.replace(['/', '\\', ' ', ':'], "_"));
        write_measured(&out.join(&folder), &source.name, analysis, None)?;
        entries.push(SeriesRecord {
            file: source.name.clone(),
            folder: Some(folder),
            findings: Some(analysis.findings.clone()),
            error: None,
            alarms: Vec::new(),
        });
    }
    write_joint(&out, &joint, &entries)?;
    if options.json {
        say!("{}", serde_json::to_string_pretty(&joint)?);
        return Ok(ExitCode::SUCCESS);
    }
    say!("{}", joint.verdict);
    for entry in &entries {
        let verdict = entry.findings.as_ref().map_or("", |findings| &findings.verdict);
        say!("  {}: {verdict}", entry.file);
    }
    joint.notes.iter().for_each(|note| say!("  note: {note}"));
    say!("report: {}", shown(&out.join("joint.html")));
    Ok(ExitCode::SUCCESS)
}

/// All signals of one file, or one of each of several.
fn sources(files: &[PathBuf], reading: &Reading, place: &Place) -> Result<Vec<Source>> {
    let [file] = files else {
        let stem =
            |file: &PathBuf| file.file_stem().map_or("record".into(), |n| n.to_string_lossy()).into_owned();
        let of = |file: &PathBuf| Source {
            file: file.clone(),
            channel: reading.channel.clone(),
            name: stem(file),
        };
        return Ok(files.iter().map(of).collect());
    };
    let signals = signals(file, place)?;
    ensure!(
        signals.len() > 1,
        "`{}` holds {} signal of its greatest length: `--together` takes two at least, of one file or \
         of several",
        file.display(),
        signals.len()
    );
    let of = |name: String| Source { file: file.clone(), channel: Some(name.clone()), name };
    Ok(signals.into_iter().map(of).collect())
}

/// Names of the signals of a file: the longest channels that move and are no time; of a run the
/// accelerations.
fn signals(file: &Path, place: &Place) -> Result<Vec<String>> {
    let (path, scene) = located(file, place)?;
    let recording = Recording::open(&path)?;
    let is_signal = |name: &str| match scene {
        Some(_) => name.starts_with("sensor.") && name.ends_with("_m_s2"),
        None => !says_time(name),
    };
    let longest = recording.channels.iter().filter(|c| !c.is_time).map(|c| c.len).max().unwrap_or(0);
    let found = recording
        .channels
        .iter()
        .filter(|c| !c.is_time && c.len == longest && is_signal(&c.name) && moves(c));
    Ok(found.map(|c| c.name.clone()).collect())
}

/// Analyses every channel. A speed found in one of them is used for those that have none.
fn analyses(sources: &[Source], reading: &Reading, place: &Place) -> Result<Vec<Analysis>> {
    let one = |source: &Source, speed_rpm: Option<Speed>| {
        let reading = Reading { channel: source.channel.clone(), speed_rpm, ..reading.clone() };
        examine(&source.file, &reading, place).with_context(|| format!("channel `{}`", source.name))
    };
    let first = sources.iter().map(|source| one(source, reading.speed_rpm));
    let mut analyses = first.collect::<Result<Vec<_>>>()?;
    let told: Vec<f64> = analyses.iter().filter_map(|analysis| analysis.findings.speed_rpm).collect();
    let Some(rpm) = told.first().copied().filter(|_| told.len() < sources.len()) else { return Ok(analyses) };
    ensure!(
        told.iter().all(|other| (other / rpm - 1.0).abs() < SAME_SPEED),
        "the channels have different speeds, {} rpm: give `--speed-rpm`",
        told.iter().map(|rpm| format!("{rpm:.0}")).collect::<Vec<_>>().join(" and ")
    );
    for (analysis, source) in analyses.iter_mut().zip(sources) {
        if analysis.findings.speed_rpm.is_none() {
            *analysis = one(source, Some(Speed::Of(rpm)))?;
            analysis
                .findings
                .notes
                .insert(0, format!("the speed of {rpm:.1} rpm is that of another channel"));
        }
    }
    Ok(analyses)
}
