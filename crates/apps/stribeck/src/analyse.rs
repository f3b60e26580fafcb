//! `stribeck analyse`: verdict, families and levels of a measured record.

mod baseline;
mod clocks;
mod components;
mod gaps;
mod reading;
mod series;
mod simulated;
mod together;
mod turning;
mod windows;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use stribeck_diagnosis::Analysis;
use stribeck_diagnosis::record::alarm::{Judged, LEAST_RECORDS, Limit, State};
use stribeck_diagnosis::record::velocity;
use stribeck_diagnosis::record::zone::{Foundation, Group, Zoned};
use stribeck_diagnosis::sources::Component;
use stribeck_diagnosis::words::brief::Brief;
use stribeck_report::{Baseline, SHEET, write_brief, write_measured};
use stribeck_scene::catalogue;
use stribeck_store::run_dir::check_folder;

use crate::interrupt::Interrupt;
use crate::out::say;
use crate::pdf;
use crate::place::{Place, shown};
pub(crate) use reading::{Accelerations, Reading, Speed, accelerations, examine};
use simulated::Simulation;

/// Flags of `analyse`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// A file of signals (CSV, .npy, .npz, .mat, .h5, .uff, .tdms, .mf4, .parquet, .wav, .flac), or the
    /// folder of a run; several, or a folder of files in the order of their names, are a series of one machine
    /// in the order of time
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// A record of the same machine when it was healthy, read with the same flags: its spectra and levels are
    /// drawn behind. May be repeated, the first is drawn; two or more, of several bearings where there are,
    /// calibrate the verdict, and combs of theirs that are no family's are set aside
    #[arg(long, value_name = "FILE")]
    baseline: Vec<PathBuf>,
    /// Its speed of the shaft [1/min] where that was another one
    #[arg(long, value_name = "RPM", requires = "baseline", value_parser = Speed::parse, allow_hyphen_values = true)]
    baseline_rpm: Option<Speed>,
    /// A scene of the bearing in its housing, by the reduced model: how far it presses an element together
    /// over a spall is simulated, for three lengths at either end of --load-n and --clearance-um, instead of
    /// computed for rings that do not bend
    #[arg(long, value_name = "SCENE", conflicts_with_all = ["components", "together", "housing_um_per_kn"])]
    simulate: Option<PathBuf>,
    /// A bearing or a gear of the machine and the speed of its shaft over that of --speed-rpm, "bearing=NU
    /// 205, ratio=2.5" or "gear=23, ratio=1"; may be repeated, and takes the place of --bearing
    #[arg(long = "component", value_name = "COMPONENT", value_parser = component,
        conflicts_with_all = ["bearing", "alarms", "reference", "baseline", "together"])]
    components: Vec<Component>,
    /// Group of the machine by ISO 20816-3, for the zone of the velocity level: 1 above 300 kW, 2 from 15 to
    /// 300 kW
    #[arg(long, value_name = "GROUP", requires = "foundation", value_parser = clap::value_parser!(u8).range(1..=2))]
    iso_group: Option<u8>,
    /// Support of the machine, for the zone of the velocity level
    #[arg(long, value_enum, requires = "iso_group")]
    foundation: Option<Standing>,
    /// Limit of a level, NAME=WARNING..ALARM, for example rms=0.5..1.2; names are rms, velocity (mm/s, 10 to
    /// 1000 Hz), kurtosis, crest, BPFO, BPFI, BSF, FTF (dB); may be repeated
    #[arg(long = "alarm", value_name = "LIMIT", value_parser = Limit::parse)]
    alarms: Vec<Limit>,
    /// The first N records of a series are of the healthy machine: limits of all levels follow from their
    /// scatter, but for those given, and seven or more calibrate the verdict on the others
    #[arg(long, value_name = "N")]
    reference: Option<usize>,
    /// One verdict on several channels that were recorded together: all signals of a file, or one of each of
    /// several files, such as axes, or both ends of a shaft; names the damaged part by each channel, and the
    /// channel nearest to it
    #[arg(long, conflicts_with_all = ["alarms", "reference", "components"])]
    together: bool,
    /// Folder for findings.json and report.html [default: beside the working folder, the file's name and
    /// -analysis]
    #[arg(long)]
    out: Option<PathBuf>,
    /// The verdict on one page, too, as verdict.pdf, A4, through Chromium, Chrome or Edge where one is installed
    #[arg(long, conflicts_with_all = ["components", "together"])]
    pdf: bool,
    /// Writes the findings to standard output as JSON
    #[arg(long)]
    json: bool,
}

/// Foundations.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Standing {
    /// Its lowest natural frequency with the machine lies 25 % above the main excitation, or more
    Rigid,
    /// Everything else
    Flexible,
}

/// A component of the machine; its bearing may be one of the user's own.
fn component(text: &str) -> Result<Component, String> {
    Component::parse(text, catalogue::parse)
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    options.reading.limits.apply();
    let files = series::files(&options.files, place)?;
    if let Some(count) = options.reference {
        ensure!(
            (LEAST_RECORDS..files.len()).contains(&count),
            "`--reference {count}`: {} files were given; at least {LEAST_RECORDS} must be of the sound \
             machine, and one more",
            files.len()
        );
    }
    // Once a process, however many records are simulated.
    let simulation = match &options.simulate {
        Some(scene) => Some(Simulation { scene: place.locate(scene), interrupt: Interrupt::listen()? }),
        None => None,
    };
    if options.together {
        return together::run(options, place);
    }
    if !options.components.is_empty() {
        return components::run(options, place);
    }
    let sound = baseline::read(options, place)?;
    let reading = Reading {
        sound_db: baseline::scores(&sound),
        shared_hz: baseline::shared_hz(&sound),
        ..options.reading.clone()
    };
    let asked = Asked { options, sound: &sound, simulation: simulation.as_ref(), place };
    if let [file] = &files[..] {
        let out = options.out.clone().unwrap_or_else(|| default_folder(file));
        check_folder(&out, &["findings.json"])?;
        remove_sheet(&out)?;
        let analysis = analyse(file, Some(&out), &asked, &reading)?;
        if options.pdf {
            write_brief(&out, &name_of(file), &analysis, sound.first())?;
        }
        if options.json {
            say!("{}", serde_json::to_string_pretty(&analysis.findings)?);
            return print_sheet(options, &out);
        }
        print(&analysis);
        for limit in &options.alarms {
            match limit.judge(&analysis.findings) {
                Some(judged) => say!("  {}", passed(&judged)),
                None => say!("  {}: {}", limit.quantity.name(), limit.quantity.missing(&analysis.findings)),
            }
        }
        say!("report: {}", shown(&out.join("report.html")));
        return print_sheet(options, &out);
    }
    series::run(&files, &asked, reading)
}

/// Removes the verdict on one page of an earlier analysis, which must not pass for that of this one.
fn remove_sheet(out: &Path) -> Result<()> {
    for sheet in [out.join(SHEET), out.join(SHEET).with_extension("pdf")].iter().filter(|file| file.exists())
    {
        std::fs::remove_file(sheet).with_context(|| format!("cannot replace {}", shown(sheet)))?;
    }
    Ok(())
}

/// Prints the verdict on one page, where it is requested.
fn print_sheet(options: &Options, out: &Path) -> Result<ExitCode> {
    if options.pdf {
        let pdf = pdf::print(&out.join(SHEET))?;
        if !options.json {
            say!("pdf: {}", shown(&pdf));
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn name_of(file: &Path) -> String {
    file.file_name().map_or_else(|| "record".into(), |n| n.to_string_lossy()).into_owned()
}

/// A level and its limits in words.
fn passed(judged: &Judged) -> String {
    let Judged { limit, value, state } = judged;
    let name = limit.quantity.name();
    match state {
        State::Good => format!("{name} {value:.4}: good, warning from {:.4}", limit.warning),
        State::Warning => {
            format!("{name} {value:.4}: WARNING, from {:.4}; alarm from {:.4}", limit.warning, limit.alarm)
        }
        State::Alarm => format!("{name} {value:.4}: ALARM, from {:.4}", limit.alarm),
    }
}

/// What is asked of every record.
struct Asked<'a> {
    options: &'a Options,
    /// Records of the healthy machine, of which the first is drawn behind.
    sound: &'a [Baseline],
    simulation: Option<&'a Simulation>,
    place: &'a Place,
}

/// Analyses one record and writes its findings and its page into `out`, if there is one.
fn analyse(asked: &Path, out: Option<&Path>, of: &Asked<'_>, reading: &Reading) -> Result<Analysis> {
    let Asked { options, sound, simulation, place } = *of;
    let mut analysis = examine(asked, reading, place)?;
    let name = name_of(asked);
    if let (Some(simulation), Some(out)) = (simulation, out) {
        // What is known without it stays when the simulation is interrupted.
        write_measured(out, &name, &analysis, None)?;
        analysis = simulation.again(analysis, asked, reading, out, place)?;
    }
    add_zone(options, &mut analysis);
    baseline::beside(&mut analysis, sound)?;
    if let Some(out) = out {
        write_measured(out, &name, &analysis, sound.first())?;
    }
    Ok(analysis)
}

/// Adds the zone of the velocity level, where it is requested, or a note why there is none.
fn add_zone(options: &Options, analysis: &mut Analysis) {
    let (Some(group), Some(foundation)) = (options.iso_group, options.foundation) else { return };
    let group = if group == 1 { Group::Large } else { Group::Medium };
    let foundation = match foundation {
        Standing::Rigid => Foundation::Rigid,
        Standing::Flexible => Foundation::Flexible,
    };
    let findings = &mut analysis.findings;
    findings.zone = findings.velocity_mm_s.map(|level| Zoned::of(level, group, foundation));
    if findings.zone.is_none() {
        let why = velocity::missing(findings.unit.as_deref(), findings.rate_hz, findings.duration_s);
        let why = why.unwrap_or_else(|| "the record has no velocity level".to_owned());
        findings.notes.push(format!("no zone of ISO 20816-3: {why}"));
    }
}

fn default_folder(file: &Path) -> PathBuf {
    let stem = file.file_stem().map_or_else(|| "record".into(), |n| n.to_string_lossy());
    PathBuf::from(format!("{stem}-analysis"))
}

fn print(analysis: &Analysis) {
    let findings = &analysis.findings;
    say!("{}", findings.verdict);
    let Brief { sure, length, unseen, .. } = Brief::of(findings);
    say!("  {sure}");
    length.iter().for_each(|length| say!("  length of the spall: {length}"));
    say!("  not seen: {unseen}");
    print_families(analysis);
    for note in &findings.notes {
        say!("  note: {note}");
    }
}

fn print_families(analysis: &Analysis) {
    let findings = &analysis.findings;
    for f in &findings.families {
        let measured = f.measured_hz.map_or("        –".to_owned(), |hz| format!("{hz:9.3}"));
        let level = f.level_db.map_or("    –".to_owned(), |db| format!("{db:5.1}"));
        say!(
            "  {:4} expected {:9.3} Hz, measured {measured} Hz, {level} dB, {} of 5 harmonics, false alarm \
             {}: {}",
            f.name,
            f.expected_hz,
            f.harmonics,
            f.false_alarm(),
            f.reason
        );
    }
    if let Some(zone) = &findings.zone {
        say!("  velocity: {zone}");
    }
}
