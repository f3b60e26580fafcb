//! `stribeck analyse`: what a measured record shows.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::measured::{Analysis, Machine, tacho};
use stribeck_analysis::report::{TrendEntry, write_measured, write_trend};
use stribeck_formats::{Channel, Recording};
use stribeck_scene::catalogue::{CatalogueBearing, Element};
use stribeck_scene::scene::Scene;

use crate::place::{Place, shown};

/// Flags of `analyse`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// A file of signals (CSV, .npy, .npz, .mat, .uff, .tdms, .parquet, .wav), or the folder of a run; several are set side by
    /// side, in their order
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Samples a second [Hz], when the file does not say it
    #[arg(long)]
    rate_hz: Option<f64>,
    /// Channel, or a part of its name that no other has [default: the only one, or the first of the longest]
    #[arg(long)]
    channel: Option<String>,
    /// Bearing: its name, or its numbers, for example "elements=9, diameter_mm=7.94, pitch_mm=39.04, angle_deg=0"
    #[arg(long)]
    bearing: Option<String>,
    /// Speed of the shaft [1/min]
    #[arg(long, conflicts_with = "tacho")]
    speed_rpm: Option<f64>,
    /// Channel of a tachometer, one pulse a turn
    #[arg(long)]
    tacho: Option<String>,
    /// What a sample is multiplied by, for example 1/sensitivity
    #[arg(long, default_value_t = 1.0)]
    scale: f64,
    /// Unit of the samples after that
    #[arg(long)]
    unit: Option<String>,
    /// Folder for findings.json and report.html [default: beside the working folder, the file's name and -analysis]
    #[arg(long)]
    out: Option<PathBuf>,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    if let [file] = &options.files[..] {
        let out = options.out.clone().unwrap_or_else(|| default_folder(file));
        print(&analyse(file, &out, options, place)?);
        println!("report: {}", shown(&out.join("report.html")));
        return Ok(ExitCode::SUCCESS);
    }
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("trend-analysis"));
    let digits = options.files.len().to_string().len();
    let mut entries = Vec::new();
    for (at, file) in options.files.iter().enumerate() {
        // Files of one name in several folders keep apart.
        let stem = file.file_stem().map_or_else(|| "record".into(), |n| n.to_string_lossy());
        let folder = format!("{:0digits$}-{stem}", at + 1);
        let done = analyse(file, &out.join(&folder), options, place);
        let (findings, error) = match done {
            Ok(analysis) => (Some(analysis.findings), None),
            Err(why) => (None, Some(format!("{why:#}"))),
        };
        let file = file.display().to_string();
        println!(
            "{file}: {}",
            findings.as_ref().map_or_else(|| error.as_deref().unwrap_or(""), |f| &f.verdict)
        );
        entries.push(TrendEntry { file, folder, findings, error });
    }
    std::fs::create_dir_all(&out).with_context(|| format!("cannot make `{}`", shown(&out)))?;
    write_trend(&out, &entries)?;
    println!("side by side: {}", shown(&out.join("trend.html")));
    let any = entries.iter().any(|entry| entry.findings.is_some());
    Ok(if any { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Analyses one record and writes its findings and its page into `out`.
fn analyse(asked: &Path, out: &Path, options: &Options, place: &Place) -> Result<Analysis> {
    let mut file = place.locate(asked);
    let mut scene = None;
    if !file.exists() {
        file = place.locate_run(asked);
    }
    if file.is_dir() {
        scene = Some(
            Scene::read(file.join("scene.ron"))
                .with_context(|| format!("`{}` is a folder, and no run", file.display()))?,
        );
        file = file.join("trace.npy");
    }
    let recording = Recording::open(&file)?;
    let channel = pick(&recording, options.channel.as_deref(), scene.is_some())?;
    let Some(rate_hz) = options.rate_hz.or(channel.rate_hz) else {
        bail!("`{}` does not say how fast it was sampled: give `--rate-hz`", file.display());
    };
    let mut notes = recording.notes.clone();
    let machine = machine(options, &recording, rate_hz, scene.as_ref(), &mut notes)?;
    let of_run = || scene.as_ref().and_then(|_| crate::export::unit(&channel.name)).map(str::to_owned);
    let unit = options.unit.clone().or_else(|| channel.unit.clone()).or_else(of_run);
    let scaled = channel.scaled(options.scale).in_unit(unit);
    let mut analysis = Analysis::of(&scaled, rate_hz, &machine)?;
    analysis.findings.notes.splice(0..0, notes);
    let name = asked.file_name().map_or_else(|| "record".into(), |n| n.to_string_lossy());
    write_measured(out, &name, &analysis)?;
    Ok(analysis)
}

/// The channel that was asked for; otherwise that of the leading sensor of a run, or the first of the longest.
fn pick<'a>(recording: &'a Recording, asked: Option<&str>, of_run: bool) -> Result<&'a Channel> {
    if let Some(name) = asked {
        return Ok(recording.channel(name)?);
    }
    let is_time = |c: &Channel| c.name.to_lowercase().starts_with("time");
    let signals: Vec<&Channel> = recording.channels.iter().filter(|c| !is_time(c)).collect();
    let found = if of_run {
        signals.iter().find(|c| c.name.starts_with("sensor.") && c.name.ends_with("_m_s2"))
    } else {
        None
    };
    let longest = signals.iter().map(|c| c.len).max().unwrap_or(0);
    let Some(channel) = found.or_else(|| signals.iter().find(|c| c.len == longest)) else {
        bail!("`{}` holds no channel", recording.path.display());
    };
    if found.is_none() && signals.iter().filter(|c| c.len == longest).count() > 1 {
        eprintln!("note: channel `{}`; there are {}", channel.name, recording.names());
    }
    Ok(channel)
}

fn machine(
    options: &Options,
    recording: &Recording,
    rate_hz: f64,
    scene: Option<&Scene>,
    notes: &mut Vec<String>,
) -> Result<Machine> {
    let bearing = match (&options.bearing, scene) {
        (Some(text), _) => Some(CatalogueBearing::parse(text).map_err(anyhow::Error::msg)?),
        (None, Some(scene)) => Some(of_scene(scene)),
        (None, None) => None,
    };
    let said = recording.channels.iter().find(|c| c.len == 1 && c.name.to_lowercase().contains("rpm"));
    let speed_rpm = if let Some(rpm) = options.speed_rpm {
        ensure!(rpm.is_finite() && rpm > 0.0, "`--speed-rpm {rpm}`: it must be above 0");
        Some(rpm)
    } else if let Some(name) = &options.tacho {
        let turns = tacho::turns(recording.channel(name)?, rate_hz)?;
        if turns.variation > 0.01 {
            notes.push(format!(
                "the speed varies by {:.1} % over the record: lines are smeared",
                100.0 * turns.variation
            ));
        }
        Some(turns.rpm)
    } else if let Some(scene) = scene {
        Some(scene.operation.speed_rpm)
    } else if let Some(channel) = said {
        let rpm = channel.read()?.first().copied();
        notes.extend(
            rpm.map(|rpm| format!("the speed of {rpm} rpm is that of `{}` in the file", channel.name)),
        );
        rpm
    } else {
        None
    };
    Ok(Machine { speed_rpm, bearing })
}

fn of_scene(scene: &Scene) -> CatalogueBearing {
    let b = &scene.bearing;
    CatalogueBearing {
        name: scene.name.clone(),
        element: Element::Roller,
        elements: u32::try_from(b.rollers).ok(),
        diameter_mm: b.roller_diameter_mm,
        pitch_mm: 0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm),
        angle_deg: 0.0,
        boundary: None,
        source: "scene.ron of the run".to_owned(),
    }
}

fn default_folder(file: &Path) -> PathBuf {
    let stem = file.file_stem().map_or_else(|| "record".into(), |n| n.to_string_lossy());
    PathBuf::from(format!("{stem}-analysis"))
}

fn print(analysis: &Analysis) {
    let findings = &analysis.findings;
    println!("{}", findings.verdict);
    for f in &findings.families {
        let measured = f.measured_hz.map_or("        –".to_owned(), |hz| format!("{hz:9.3}"));
        let level = f.level_db.map_or("    –".to_owned(), |db| format!("{db:5.1}"));
        println!(
            "  {:4} expected {:9.3} Hz, measured {measured} Hz, {level} dB, {} of 5 harmonics, false alarm {}: {}",
            f.name,
            f.expected_hz,
            f.harmonics,
            f.false_alarm(),
            f.reason
        );
    }
    for note in &findings.notes {
        println!("  note: {note}");
    }
}
