//! `stribeck analyse`: verdict, families and levels of a measured record.

mod baseline;
mod components;
mod gaps;
mod together;
mod turning;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::measured::alarm::{Judged, LEAST_RECORDS, Limit, Quantity, State};
use stribeck_analysis::measured::sources::Component;
use stribeck_analysis::measured::zone::{Foundation, Group, Zoned};
use stribeck_analysis::measured::{Analysis, Machine, over_angle, ridge, tacho};
use stribeck_analysis::record;
use stribeck_formats::{Channel, Recording, says_time};
use stribeck_report::{TrendEntry, write_measured, write_trend};
use stribeck_scene::catalogue::CatalogueBearing;
use stribeck_scene::run_dir::{RunDir, check_folder, write_atomic};
use stribeck_scene::scene::Scene;

use crate::causes;
use crate::out::{say, tell};
use crate::place::{Place, shown};
use crate::transfer::Transfer;

/// Flags of `analyse`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// A file of signals (CSV, .npy, .npz, .mat, .h5, .uff, .tdms, .mf4, .parquet, .wav, .flac), or the
    /// folder of a run; several are set side by side, in their order
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// A record of the same machine when it was sound, or before: its spectra and levels are drawn behind. It
    /// is read with the same flags and changes no verdict
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Its speed of the shaft [1/min] where that was another one
    #[arg(long, value_name = "RPM", requires = "baseline", value_parser = Speed::parse, allow_hyphen_values = true)]
    baseline_rpm: Option<Speed>,
    /// A bearing or a gear of the machine and the speed of its shaft over that of --speed-rpm, "bearing=NU
    /// 205, ratio=2.5" or "gear=23, ratio=1"; may be repeated, and takes the place of --bearing
    #[arg(long = "component", value_name = "COMPONENT", value_parser = Component::parse,
        conflicts_with_all = ["bearing", "alarms", "reference", "baseline", "together"])]
    components: Vec<Component>,
    /// Group of the machine by ISO 20816-3, for the zone of the velocity level: 1 above 300 kW, 2 from 15 to
    /// 300 kW
    #[arg(long, value_name = "GROUP", requires = "foundation", value_parser = clap::value_parser!(u8).range(1..=2))]
    iso_group: Option<u8>,
    /// What the machine stands on, for the zone of the velocity level
    #[arg(long, value_enum, requires = "iso_group")]
    foundation: Option<Standing>,
    /// Limit of a level, NAME=WARNING..ALARM, for example rms=0.5..1.2; names are rms, velocity (mm/s, 10 to
    /// 1000 Hz), kurtosis, crest, BPFO, BPFI, BSF, FTF (dB); may be repeated
    #[arg(long = "alarm", value_name = "LIMIT", value_parser = Limit::parse)]
    alarms: Vec<Limit>,
    /// The first N files are of the sound machine: limits of all levels follow from their scatter, but for
    /// those given
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
    /// Writes the findings to standard output as JSON: those of one record, or a list of several
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

/// Flags of every command that reads records: how they are read, and their machine.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Reading {
    /// Samples a second [Hz], when the file does not say it
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) rate_hz: Option<f64>,
    /// Take the rate of `--rate-hz` where the file says another one, with a note
    #[arg(long, requires = "rate_hz")]
    force_rate: bool,
    /// Channel, or a part of its name that no other has [default: the only one, or the first of the longest
    /// that moves]
    #[arg(long)]
    pub(crate) channel: Option<String>,
    /// Bearing: its name, or its numbers, for example "elements=9, diameter_mm=7.94, pitch_mm=39.04,
    /// angle_deg=0"
    #[arg(long)]
    pub(crate) bearing: Option<String>,
    /// Speed of the shaft [1/min], or a range such as 1400..1600: then the line of the shaft that stands out
    /// there is followed over the record, and a record whose speed varies is analysed over the angle
    #[arg(long, conflicts_with = "tacho", value_parser = Speed::parse, allow_hyphen_values = true)]
    pub(crate) speed_rpm: Option<Speed>,
    /// Channel of a tachometer, one pulse a turn unless `--pulses-per-turn` says otherwise, or of the angle
    /// of the shaft in rad, its name ending in `_rad`; a record whose speed varies is analysed over the angle
    #[arg(long)]
    pub(crate) tacho: Option<String>,
    /// Pulses of the tachometer a turn, such as the teeth of its wheel
    #[arg(long, value_name = "N", default_value_t = 1, requires = "tacho", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pulses_per_turn: u32,
    /// Radial load of the bearing [N], a number or a range such as 50..150: how far it presses an element
    /// together belongs to the length of a spall [default: 0.2 to 10 % of the static rating]
    #[arg(long, value_name = "RANGE", value_parser = range)]
    pub(crate) load_n: Option<(f64, f64)>,
    /// Radial internal clearance in operation [µm], a number or a range [default: 0]
    #[arg(long, value_name = "RANGE", value_parser = range)]
    pub(crate) clearance_um: Option<(f64, f64)>,
    /// Compliance of the outer ring and its housing at the loaded place [µm/kN], a number or a range: a
    /// compliant seat presses an element farther into a defect [default: 0]
    #[arg(long, value_name = "RANGE", value_parser = range)]
    housing_um_per_kn: Option<(f64, f64)>,
    /// Factor of every sample, for example 1/sensitivity
    #[arg(long, default_value_t = 1.0, value_parser = scale, allow_hyphen_values = true)]
    scale: f64,
    /// Unit of the samples after that
    #[arg(long)]
    unit: Option<String>,
    /// Path from the bearing to the sensor: a frequency response, FILE.uff, or "mass=12, stiffness=2e8,
    /// damping=0.02", several modes with `;` between them. It is divided out of a record, which is then the
    /// force at the bearing; the force of a run goes through it
    #[arg(long, value_name = "PATH")]
    path: Option<String>,
}

impl Reading {
    /// Whether the flags state anything of a machine, or of a file.
    pub(crate) fn is_given(&self) -> bool {
        let numbers = self.rate_hz.is_some() || self.load_n.is_some() || self.clearance_um.is_some();
        let words = [&self.channel, &self.bearing, &self.tacho, &self.unit].iter().any(|word| word.is_some());
        numbers || words || self.speed_rpm.is_some()
    }

    /// The same machine, for a file of one channel with its rate.
    pub(crate) fn of_one_channel(&self) -> Self {
        Self {
            rate_hz: None,
            force_rate: false,
            channel: None,
            tacho: None,
            scale: 1.0,
            unit: None,
            path: None,
            ..self.clone()
        }
    }
}

/// The user's statement of the speed [1/min].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Speed {
    Of(f64),
    Between(f64, f64),
}

impl Speed {
    fn parse(text: &str) -> Result<Self, String> {
        // A shaft that turns the other way has the same lines.
        let number = |text: &str| {
            let rpm = text.trim().parse::<f64>().ok().filter(|rpm| rpm.is_finite() && *rpm != 0.0);
            rpm.ok_or_else(|| format!("`{text}` is no speed in 1/min, and no range such as 1400..1600"))
        };
        match text.split_once("..") {
            None => Ok(Self::Of(number(text)?.abs())),
            Some((low, high)) => {
                let (low, high) = (number(low)?, number(high)?);
                match (low.abs().min(high.abs()), low.abs().max(high.abs())) {
                    _ if low >= high => Err(format!("`{text}`: speeds must ascend")),
                    _ if low < 0.0 && high > 0.0 => {
                        Err(format!("`{text}`: a shaft that stops has no lines to follow"))
                    }
                    (least, most) => Ok(Self::Between(least, most)),
                }
            }
        }
    }
}

/// A number that is not negative, or a range of them.
fn range(text: &str) -> Result<(f64, f64), String> {
    let number = |text: &str| {
        let number = text.trim().parse::<f64>().ok().filter(|x| x.is_finite() && *x >= 0.0);
        number.ok_or_else(|| format!("`{text}` is no number of 0 or more, and no range such as 50..150"))
    };
    let (low, high) = match text.split_once("..") {
        None => (number(text)?, number(text)?),
        Some((low, high)) => (number(low)?, number(high)?),
    };
    if low > high { Err(format!("`{text}`: a range must ascend, as 50..150 does")) } else { Ok((low, high)) }
}

fn scale(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|x| x.is_normal());
    number.ok_or_else(|| format!("`{text}`: must be a number above 0 or below 0, such as 9.81"))
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    if let Some(count) = options.reference {
        ensure!(
            (LEAST_RECORDS..options.files.len()).contains(&count),
            "`--reference {count}`: {} files were given; at least {LEAST_RECORDS} must be of the sound \
             machine, and one more",
            options.files.len()
        );
    }
    if options.together {
        return together::run(options, place);
    }
    if !options.components.is_empty() {
        return components::run(options, place);
    }
    if let [file] = &options.files[..] {
        let out = options.out.clone().unwrap_or_else(|| default_folder(file));
        check_folder(&out, &["findings.json"])?;
        let analysis = analyse(file, &out, options, place)?;
        if options.json {
            say!("{}", serde_json::to_string_pretty(&analysis.findings)?);
            return Ok(ExitCode::SUCCESS);
        }
        print(&analysis);
        for limit in &options.alarms {
            match limit.judge(&analysis.findings) {
                Some(judged) => say!("  {}", passed(&judged)),
                None => say!("  {}: {}", limit.quantity.name(), limit.quantity.missing(&analysis.findings)),
            }
        }
        say!("report: {}", shown(&out.join("report.html")));
        return Ok(ExitCode::SUCCESS);
    }
    let out = options.out.clone().unwrap_or_else(|| PathBuf::from("trend-analysis"));
    let folders = folders(&options.files);
    check_folder(&out, &[TREND])?;
    // The table of all is written last; until then an empty one marks the folder as this command's.
    if !out.join(TREND).exists() {
        std::fs::create_dir_all(&out).with_context(|| format!("cannot make `{}`", shown(&out)))?;
        write_atomic(&out.join(TREND), b"[]")?;
    }
    let mut entries = Vec::new();
    for (file, folder) in options.files.iter().zip(folders) {
        let done = analyse(file, &out.join(&folder), options, place);
        let (findings, error) = match done {
            Ok(analysis) => (Some(analysis.findings), None),
            Err(why) => (None, Some([vec![why.to_string()], causes(&why)].concat().join(": "))),
        };
        let file = file.display().to_string();
        let verdict = findings.as_ref().map_or_else(|| error.as_deref().unwrap_or(""), |f| &f.verdict);
        if !options.json {
            say!("{file}: {verdict}");
        }
        entries.push(TrendEntry { file, folder, findings, error, alarms: Vec::new() });
    }
    let limits = limits(options, &entries);
    for limit in &limits {
        let mut records = entries.iter().filter_map(|e| e.findings.as_ref()).peekable();
        let why = records.peek().map(|first| limit.quantity.missing(first));
        if let (Some(why), false) = (why, records.any(|f| limit.judge(f).is_some())) {
            tell!("note: no record has a level for the limit of {}: {why}", limit.quantity.name());
        }
    }
    for entry in &mut entries {
        let Some(findings) = &entry.findings else { continue };
        entry.alarms = limits.iter().filter_map(|limit| limit.judge(findings)).collect();
        for judged in entry.alarms.iter().filter(|judged| judged.state != State::Good && !options.json) {
            say!("{}: {}", entry.file, passed(judged));
        }
    }
    write_trend(&out, &entries, &limits)?;
    if options.json {
        say!("{}", serde_json::to_string_pretty(&entries)?);
    } else {
        say!("side by side: {}", shown(&out.join("trend.html")));
    }
    let failed = entries.iter().filter(|entry| entry.findings.is_none()).count();
    ensure!(failed == 0, "{failed} of {} records could not be analysed", entries.len());
    Ok(ExitCode::SUCCESS)
}

/// A folder for each of several files: those of one name in several places keep apart.
fn folders(files: &[PathBuf]) -> Vec<String> {
    let digits = files.len().to_string().len();
    let name = |(at, file): (usize, &PathBuf)| {
        let stem = file.file_stem().map_or_else(|| "record".into(), |n| n.to_string_lossy());
        format!("{:0digits$}-{stem}", at + 1)
    };
    files.iter().enumerate().map(name).collect()
}

/// Limits that were given, and those that follow from the reference records.
fn limits(options: &Options, entries: &[TrendEntry]) -> Vec<Limit> {
    let mut limits = options.alarms.clone();
    let reference = &entries[..options.reference.unwrap_or(0)];
    for quantity in Quantity::ALL {
        if limits.iter().any(|limit| limit.quantity == quantity) {
            continue;
        }
        let values: Vec<f64> = reference.iter().filter_map(|e| quantity.of(e.findings.as_ref()?)).collect();
        limits.extend(Limit::from_reference(quantity, &values));
    }
    limits
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

/// The levels of several records side by side.
const TREND: &str = "trend.json";

/// Rates that differ by less than this part are one: files round theirs.
const SAME_RATE: f64 = 1e-3;

/// Analyses one record and writes its findings and its page into `out`.
fn analyse(asked: &Path, out: &Path, options: &Options, place: &Place) -> Result<Analysis> {
    let mut analysis = examine(asked, &options.reading, place)?;
    analysis.findings.zone = zoned(options, &analysis);
    let name = asked.file_name().map_or_else(|| "record".into(), |n| n.to_string_lossy());
    let baseline = options.baseline.as_deref().map(|file| baseline::of(file, options, &mut analysis, place));
    let baseline = baseline.transpose()?;
    write_measured(out, &name, &analysis, baseline.as_ref())?;
    Ok(analysis)
}

/// The zone of the velocity level, where it is requested and can be determined.
fn zoned(options: &Options, analysis: &Analysis) -> Option<Zoned> {
    let group = if options.iso_group? == 1 { Group::Large } else { Group::Medium };
    let foundation = match options.foundation? {
        Standing::Rigid => Foundation::Rigid,
        Standing::Flexible => Foundation::Flexible,
    };
    let velocity = analysis.findings.velocity_mm_s;
    if velocity.is_none() {
        tell!(
            "note: no zone: the velocity level needs an acceleration in g or m/s² (`--unit g`), sampled at \
             2000 Hz or faster for a second"
        );
    }
    Some(Zoned::of(velocity?, group, foundation))
}

/// A record that was read, and its machine as far as known.
struct Read {
    /// The samples, over the angle of the shaft where its speed varies.
    signal: Channel,
    /// Their rate [Hz].
    rate_hz: f64,
    machine: Machine,
    /// Notes on reading.
    notes: Vec<String>,
    /// Whether it is a run's.
    of_run: bool,
    /// Where the speed varies: the samples over time.
    turning: Option<Turning>,
}

/// A record whose shaft changes its speed, over time.
struct Turning {
    signal: Channel,
    rate_hz: f64,
    /// Times of whole turns, in samples.
    pulses: Vec<f64>,
}

/// Reads and analyses one record.
pub(crate) fn examine(asked: &Path, options: &Reading, place: &Place) -> Result<Analysis> {
    let Read { signal, rate_hz, machine, mut notes, of_run, turning } = read(asked, options, place)?;
    let mut analysis = Analysis::of(&signal, rate_hz, &machine)?;
    if let Some(Turning { signal, rate_hz, pulses }) = &turning {
        analysis.varying = turning::varying(&analysis, signal, *rate_hz, pulses)?;
    }
    let claims = analysis.findings.families.iter().any(|family| family.claimed);
    if claims && of_run {
        notes.push(
            "a run has no noise but its bearing's: what elements rattle as they come under the load can make \
             a claim of its own, in a sound \
             bearing, too. Its report says what is in the scene; `export` with `--sensor` and a \
             `noise_density` gives it a machine's noise"
                .to_owned(),
        );
    }
    analysis.findings.notes.splice(0..0, notes);
    Ok(analysis)
}

/// Reads one record.
fn read(asked: &Path, options: &Reading, place: &Place) -> Result<Read> {
    let (file, scene) = located(asked, place)?;
    let recording = Recording::open(&file)?;
    let picked = pick(&recording, options.channel.as_deref(), scene.is_some())?;
    let path = options.path.as_deref().map(|text| Transfer::read(text, place)).transpose()?;
    let at_sensor = match (&path, &scene) {
        (Some(path), Some(_)) => Some(path.of_run(&recording, picked)?),
        _ => None,
    };
    let channel = at_sensor.as_ref().map_or(picked, |(channel, _)| channel);
    let Some(rate_hz) = options.rate_hz.or(channel.rate_hz) else {
        let notes: String = recording.notes.iter().map(|note| format!("; {note}")).collect();
        bail!("`{}` does not say how fast it was sampled: give `--rate-hz`{notes}", file.display());
    };
    let mut notes = recording.notes.clone();
    notes.extend(at_sensor.iter().map(|(_, note)| note.clone()));
    if let (Some(given), Some(said)) = (options.rate_hz, channel.rate_hz) {
        let same = (given / said - 1.0).abs() <= SAME_RATE;
        ensure!(
            same || options.force_rate,
            "`{}` says that channel `{}` was sampled at {said} Hz, and `--rate-hz` says {given} Hz: leave \
             the option out, or add \
             `--force-rate` if the file is wrong",
            file.display(),
            channel.name
        );
        if !same {
            notes.push(format!(
                "the file says {said} Hz; the {given} Hz of `--rate-hz` are taken, by `--force-rate`"
            ));
        }
    }
    let whole = gaps::without(channel, &mut notes)?;
    let (channel, from) = (&whole.channel, whole.from);
    let of_run = || scene.as_ref().and_then(|_| crate::export::unit(&channel.name)).map(str::to_owned);
    let unit = options.unit.clone().or_else(|| channel.unit.clone()).or_else(of_run);
    let mut scaled = channel.scaled(options.scale).in_unit(unit);
    if let (Some(path), None) = (&path, &scene) {
        let (before, note) = path.before(&scaled, rate_hz)?;
        scaled = before;
        notes.push(note);
    }
    let (machine, pulses) = machine(options, &recording, &scaled, rate_hz, scene.as_ref(), &mut notes)?;
    // Pulses count from the beginning of the file.
    let moved = |all: Vec<f64>| all.into_iter().map(|at| at - from as f64).filter(|at| *at >= 0.0).collect();
    let pulses: Option<Vec<f64>> = pulses.map(moved);
    let over_angle = match &pulses {
        Some(pulses) => {
            let even = over_angle(&scaled, rate_hz, pulses)?;
            if even.is_none() {
                notes.push(
                    "the record is too long to be taken over the angle: its lines are smeared".to_owned(),
                );
            }
            even
        }
        None => None,
    };
    let of_run = scene.is_some();
    let Some((even, even_hz)) = over_angle else {
        return Ok(Read { signal: scaled, rate_hz, machine, notes, of_run, turning: None });
    };
    notes.push(
        "the record was taken over the angle of the shaft: frequencies are those at its mean speed"
            .to_owned(),
    );
    let turning = pulses.map(|pulses| Turning { signal: scaled, rate_hz, pulses });
    Ok(Read { signal: even, rate_hz: even_hz, machine, notes, of_run, turning })
}

/// The file of a record, and the scene where it is that of a run.
fn located(asked: &Path, place: &Place) -> Result<(PathBuf, Option<Scene>)> {
    let mut file = place.locate(asked);
    if !file.exists() {
        file = place.locate_run(asked);
    }
    if RunDir::is_ensemble(&file) {
        RunDir::open(&file)?;
    }
    if !file.is_dir() {
        return Ok((file, None));
    }
    let scene = Scene::read(file.join("scene.ron"))
        .with_context(|| format!("`{}` is a folder, and no run", file.display()))?;
    Ok((file.join("trace.npy"), Some(scene)))
}

/// The requested channel; otherwise that of the leading sensor of a run, or the first of the longest.
fn pick<'a>(recording: &'a Recording, asked: Option<&str>, of_run: bool) -> Result<&'a Channel> {
    if let Some(name) = asked {
        let channel = recording.channel(name)?;
        ensure!(
            !channel.is_time,
            "channel `{}` of `{}` rises evenly from sample to sample, as the time does: it is no signal; \
             there are {}",
            channel.name,
            recording.path.display(),
            recording.names()
        );
        return Ok(channel);
    }
    // Times that are damaged do not rise.
    let alone = recording.channels.iter().filter(|c| c.len > 1).count() < 2;
    let is_time = |c: &Channel| c.is_time || says_time(&c.name) && !alone;
    let signals: Vec<&Channel> = recording.channels.iter().filter(|c| !is_time(c)).collect();
    // Of a run the one that its report judges.
    let found =
        signals.iter().find(|c| of_run && c.name.starts_with("sensor.") && c.name.ends_with(".ay_m_s2"));
    let longest = signals.iter().map(|c| c.len).max().unwrap_or(0);
    let of_longest: Vec<&Channel> = signals.iter().filter(|c| c.len == longest).copied().collect();
    // An hour, a count of turns or a switch is no vibration: those that move come first.
    let first = match &of_longest[..] {
        [] | [_] => of_longest.first(),
        all => all.iter().find(|c| moves(c)).or_else(|| all.first()),
    };
    let Some(channel) = found.or(first) else {
        let notes: String = recording.notes.iter().map(|note| format!("; {note}")).collect();
        bail!(
            "`{}` holds no signal; its channels are {}{notes}",
            recording.path.display(),
            recording.names()
        );
    };
    if found.is_none() && signals.iter().filter(|c| c.len == longest).count() > 1 {
        tell!("note: channel `{}`; there are {}", channel.name, recording.names());
    }
    Ok(channel)
}

/// Whether at least one sample in a hundred differs from the one before it; a channel that cannot be read is
/// told later.
fn moves(channel: &Channel) -> bool {
    let (mut before, mut changes) = (f64::NAN, 0_u64);
    let read = channel.for_each_block(|block| {
        for &x in block {
            changes += u64::from(x.is_finite() && x != before);
            before = if x.is_finite() { x } else { before };
        }
        true
    });
    read.is_err() || changes > 1 + channel.len / 100
}

/// Speeds that vary by more than this part smear the fifth harmonic of a family over several lines.
const STEADY: f64 = 0.01;

/// The machine by the flags, and the times of whole turns, in samples, where the speed varies.
fn machine(
    options: &Reading,
    recording: &Recording,
    channel: &Channel,
    rate_hz: f64,
    scene: Option<&Scene>,
    notes: &mut Vec<String>,
) -> Result<(Machine, Option<Vec<f64>>)> {
    let bearing = match (&options.bearing, scene) {
        (Some(text), _) => Some(CatalogueBearing::parse(text).map_err(anyhow::Error::msg)?),
        (None, Some(scene)) => Some(CatalogueBearing::of_scene(scene)),
        (None, None) => None,
    };
    let said = recording.channels.iter().find(|c| c.len == 1 && c.name.to_lowercase().contains("rpm"));
    let mut pulses = None;
    let samples = channel.len;
    let speed_rpm = if let Some(Speed::Of(rpm)) = options.speed_rpm {
        Some(rpm)
    } else if let Some(Speed::Between(low, high)) = options.speed_rpm {
        let found = ridge::speed(channel, rate_hz, low, high)?;
        notes.push(format!(
            "the speed is that of the line that stands out between {low} and {high} rpm, {:.0} dB up: it \
             goes by {:.1} % of its mean",
            found.height_db,
            100.0 * found.variation()
        ));
        if found.variation() > STEADY {
            let samples = usize::try_from(channel.len).unwrap_or(usize::MAX);
            pulses = Some(
                found.turns(rate_hz, samples, 1.0).context("the speed was found, and its turns were not")?,
            );
        }
        Some(60.0 * found.mean_hz())
    } else if let Some(name) = &options.tacho {
        let channel = recording.channel(name)?;
        // A tachometer may have a rate of its own.
        let own_hz =
            channel.rate_hz.filter(|_| !options.force_rate || channel.len != samples).unwrap_or(rate_hz);
        let mut turns = if channel.name.ends_with("_rad") {
            tacho::of_angle(channel, own_hz)?
        } else {
            tacho::pulses(channel, own_hz, options.pulses_per_turn)?
        };
        turns.pulses.iter_mut().for_each(|at| *at *= rate_hz / own_hz);
        notes.append(&mut turns.notes);
        if turns.variation > STEADY {
            notes.push(format!("the speed varies by {:.1} % over the record", 100.0 * turns.variation));
            pulses = Some(turns.pulses);
        }
        Some(turns.rpm)
    } else if let Some(scene) = scene.filter(|scene| scene.operation.speed_varies()) {
        let mut angle = recording.channel("shaft.angle_rad")?;
        let against;
        if scene.operation.outer_turns() {
            // Families go with the difference of both speeds.
            let outer = recording.channel("outer_ring.angle_rad")?.read()?;
            let values = record::against(&angle.read()?, Some(&outer)).into_owned();
            against = Channel::held(angle.name.clone(), values);
            angle = &against;
        }
        let turns = tacho::of_angle(angle, rate_hz)
            .with_context(|| format!("the speed of `{}` changes", scene.name))?;
        notes.push(format!(
            "the speed varies by {:.1} % over the record, by the recorded angle of the shaft{}",
            100.0 * turns.variation,
            if scene.operation.outer_turns() { " against the outer ring" } else { "" }
        ));
        pulses = Some(turns.pulses);
        Some(turns.rpm)
    } else if let Some(scene) = scene {
        Some((scene.operation.speed_rpm - scene.operation.outer_speed_rpm).abs())
    } else if let Some(channel) = said {
        let rpm = channel.read()?.first().copied();
        notes.extend(
            rpm.map(|rpm| format!("the speed of {rpm} rpm is that of `{}` in the file", channel.name)),
        );
        rpm
    } else {
        None
    };
    let outer_speed_rpm = scene.map_or(0.0, Machine::outer_speed_rpm);
    // A measured speed, or that of a run, needs no correction.
    let nominal =
        matches!(options.speed_rpm, Some(Speed::Of(_))) || (options.speed_rpm.is_none() && said.is_some());
    let speed_is_exact = scene.is_some() || options.tacho.is_some() || !nominal;
    let machine = Machine {
        speed_rpm,
        outer_speed_rpm,
        bearing,
        speed_is_exact,
        load_n: options.load_n,
        clearance_um: options.clearance_um,
        housing_um_per_kn: options.housing_um_per_kn,
        ..Machine::default()
    };
    Ok((machine, pulses))
}

fn default_folder(file: &Path) -> PathBuf {
    let stem = file.file_stem().map_or_else(|| "record".into(), |n| n.to_string_lossy());
    PathBuf::from(format!("{stem}-analysis"))
}

fn print(analysis: &Analysis) {
    let findings = &analysis.findings;
    say!("{}", findings.verdict);
    print_families(analysis);
    if let Some(spall) = findings.spall_mm {
        say!("  spall: {:.2} mm long, 90 % between {:.2} and {:.2} mm", spall.value, spall.low, spall.high);
    }
    if let Some(below_mm) = findings.spall_below_mm {
        say!("  spall: shorter than {below_mm:.2} mm if entry and exit both knock");
    }
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
