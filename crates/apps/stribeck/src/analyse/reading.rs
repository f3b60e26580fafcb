//! One record and its machine: file, channel, rate, speed or tachometer, bearing and load, and its analysis.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::record;
use stribeck_diagnosis::{
    AccelerationUnit, Analysis, Machine, Pressed, SPEEDS_RPM, over_angle,
    record::quality::{self, Quality},
    speed::{ridge, tacho},
};
use stribeck_formats::{Channel, Recording, says_time};
use stribeck_scene::catalogue;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::RunDir;

use super::{clocks, gaps, turning, windows};
use crate::limits::Limits;
use crate::out::tell;
use crate::place::Place;

/// Flags of every command that reads records: how they are read, and their machine.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Reading {
    #[command(flatten)]
    pub(crate) limits: Limits,
    /// Samples a second [Hz], when the file does not say it
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) rate_hz: Option<f64>,
    /// Take the rate of `--rate-hz` where the file says another one, with a note
    #[arg(long, requires = "rate_hz")]
    pub(super) force_rate: bool,
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
    /// Channel of a tachometer, one pulse a turn unless `--pulses-per-turn` says otherwise; of the angle of
    /// the shaft in rad, its name ending in `_rad`; or of its speed over time, in a unit such as `rpm`; a
    /// record whose speed varies is analysed over the angle
    #[arg(long)]
    pub(crate) tacho: Option<String>,
    /// Pulses of the tachometer a turn, such as the teeth of its wheel; 1.5 of one on a shaft that is geared up
    /// to this one
    #[arg(long, value_name = "N", default_value_t = 1.0, requires = "tacho", value_parser = pulses_per_turn)]
    pub(super) pulses_per_turn: f64,
    /// The outer ring turns at --speed-rpm and the shaft stands still, as in hubs, idlers and planets
    #[arg(long)]
    pub(super) outer_ring_turns: bool,
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
    pub(super) housing_um_per_kn: Option<(f64, f64)>,
    /// How far an element is pressed together over a spall, as a scene of `--simulate` says.
    #[arg(skip)]
    pub(super) pressed: Option<Pressed>,
    /// Scores of records of the healthy machine [dB], and their combs that are no family's [Hz].
    #[arg(skip)]
    pub(super) sound_db: Vec<f64>,
    #[arg(skip)]
    pub(super) shared_hz: Vec<f64>,
    /// Factor of every sample, for example 1/sensitivity
    #[arg(long, default_value_t = 1.0, value_parser = scale, allow_hyphen_values = true)]
    pub(super) scale: f64,
    /// Unit of the samples after that
    #[arg(long)]
    pub(super) unit: Option<String>,
}

/// The user's statement of the speed [1/min].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Speed {
    Of(f64),
    Between(f64, f64),
}

impl Speed {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        // A shaft that turns the other way has the same lines.
        let number = |text: &str| {
            let rpm = text.trim().parse::<f64>().ok().filter(|rpm| rpm.is_finite() && *rpm != 0.0);
            let rpm =
                rpm.ok_or_else(|| format!("`{text}` is no speed in 1/min, and no range such as 1400..1600"))?;
            if SPEEDS_RPM.contains(&rpm.abs()) {
                Ok(rpm)
            } else {
                Err(format!(
                    "`{text}`: shafts turn {} to {} times a minute; is it in another unit?",
                    SPEEDS_RPM.start(),
                    SPEEDS_RPM.end()
                ))
            }
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

fn pulses_per_turn(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|n| (1e-3..=1e5).contains(n));
    number.ok_or_else(|| format!("`{text}`: must be a number from 0.001 to 100000, such as 1, 60 or 1.5"))
}

fn scale(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|x| x.is_normal());
    number.ok_or_else(|| format!("`{text}`: must be a number above 0 or below 0, such as 9.81"))
}

/// Rates that differ by less than this part are one: files round theirs.
const SAME_RATE: f64 = 1e-3;

/// A record that was read, and its machine as far as known.
pub(super) struct Read {
    /// The samples, over the angle of the shaft where its speed varies.
    pub(super) signal: Channel,
    /// Their rate [Hz].
    pub(super) rate_hz: f64,
    pub(super) machine: Machine,
    /// Notes on reading.
    pub(super) notes: Vec<String>,
    /// Whether it is a run's.
    pub(super) of_run: bool,
    /// Where the speed varies: the samples over time.
    pub(super) turning: Option<Turning>,
    /// That of the samples as they were measured, where the signal is made of them; nothing for a run.
    pub(super) quality: Option<Vec<Quality>>,
}

/// A record whose shaft changes its speed, over time.
pub(super) struct Turning {
    pub(super) signal: Channel,
    pub(super) rate_hz: f64,
    /// Times of whole turns, in samples.
    pub(super) pulses: Vec<f64>,
}

pub(crate) fn examine(asked: &Path, options: &Reading, place: &Place) -> Result<Analysis> {
    let Read { signal, rate_hz, machine, mut notes, of_run, turning, quality } = read(asked, options, place)?;
    let mut analysis = Analysis::of_inspected(&signal, rate_hz, &machine, quality)?;
    if let Some(Turning { signal, rate_hz, pulses }) = &turning {
        analysis.varying = turning::varying(&analysis, signal, *rate_hz, pulses)?;
    }
    let claims = analysis.findings.families.iter().any(|family| family.claimed);
    if claims && of_run {
        notes.push(
            "a run has no noise but its bearing's: what elements rattle as they come under the load can make \
             a claim of its own, in a healthy bearing, too. Its report says what is in the scene; `export` \
             with `--sensor` and a `noise_density` gives it a machine's noise"
                .to_owned(),
        );
    }
    analysis.findings.notes.splice(0..0, notes);
    Ok(analysis)
}

/// Accelerations of a record [m/s²], and what is known of it.
pub(crate) struct Accelerations {
    pub(crate) samples: Vec<f64>,
    pub(crate) rate_hz: f64,
    pub(crate) machine: Machine,
}

pub(crate) fn accelerations(asked: &Path, options: &Reading, place: &Place) -> Result<Accelerations> {
    let Read { signal, rate_hz, machine, turning, .. } = read(asked, options, place)?;
    ensure!(turning.is_none(), "the speed of `{}` varies: take a record at a steady speed", asked.display());
    let in_m_s2 = in_m_s2(signal.unit.as_deref(), asked)?;
    Ok(Accelerations { samples: signal.scaled(in_m_s2).read()?, rate_hz, machine })
}

/// The unit of a record's accelerations [m/s²].
pub(crate) fn in_m_s2(unit: Option<&str>, file: &Path) -> Result<f64> {
    let unit = unit.and_then(AccelerationUnit::parse).with_context(|| {
        format!(
            "`{}` does not say that its samples are accelerations: give `--unit g` or `--unit m/s^2`, with \
             `--scale` for a voltage",
            file.display()
        )
    })?;
    Ok(unit.in_m_s2())
}

pub(super) fn read(asked: &Path, options: &Reading, place: &Place) -> Result<Read> {
    let (mut file, scene) = located(asked, place)?;
    // What its machine's sensor records is a signal as a measured one.
    let at_sensor = file.with_file_name("machine.npy");
    let of_machine = scene.is_some() && options.channel.is_none() && at_sensor.is_file();
    if of_machine {
        file = at_sensor;
    }
    let recording = Recording::open(&file)?;
    let channel = pick(&recording, options.channel.as_deref(), scene.is_some())?;
    let Some(rate_hz) = options.rate_hz.or(channel.rate_hz) else {
        let notes: String = recording.notes.iter().map(|note| format!("; {note}")).collect();
        bail!("`{}` does not say how fast it was sampled: give `--rate-hz`{notes}", file.display());
    };
    let mut notes = recording.notes.clone();
    if let (Some(given), Some(said)) = (options.rate_hz, channel.rate_hz) {
        let same = (given / said - 1.0).abs() <= SAME_RATE;
        ensure!(
            same || options.force_rate,
            "`{}` says that channel `{}` was sampled at {said} Hz, and `--rate-hz` says {given} Hz: leave \
             the option out, or add `--force-rate` if the file is wrong",
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
    // Of a run, or of a table that was written of one.
    let is_ours = scene.is_some() || channel.name.ends_with("_m_s2");
    let of_run = || crate::export::unit(&channel.name).filter(|_| is_ours).map(str::to_owned);
    let unit = options.unit.clone().or_else(|| channel.unit.clone()).or_else(of_run);
    let scaled = channel.scaled(options.scale).in_unit(unit);
    let (mut machine, pulses) = machine(options, &recording, &scaled, rate_hz, scene.as_ref(), &mut notes)?;
    let pulses = pulses.map(|all| {
        // They count from the beginning of the file, and a tachometer may go on behind the end of the record.
        let last = scaled.len.saturating_sub(1) as f64;
        let moved = all.iter().map(|at| at - from as f64).filter(|at| (0.0..=last).contains(at));
        let kept: Vec<f64> = moved.collect();
        // The mean speed is that of the record.
        if let (Some(of_all), Some(of_kept)) = (mean_gap(&all), mean_gap(&kept)) {
            machine.speed_rpm = machine.speed_rpm.map(|rpm| rpm * of_all / of_kept);
        }
        kept
    });
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
    let of_run = scene.is_some() && !of_machine;
    let quality = match &over_angle {
        _ if of_run => Some(Vec::new()),
        None => None,
        Some(_) => Some(quality::of(channel, rate_hz, None)?),
    };
    let Some((even, even_hz)) = over_angle else {
        return Ok(Read { signal: scaled, rate_hz, machine, notes, of_run, turning: None, quality });
    };
    notes.push(
        "the record was taken over the angle of the shaft: frequencies are those at its mean speed"
            .to_owned(),
    );
    let turning = pulses.map(|pulses| Turning { signal: scaled, rate_hz, pulses });
    Ok(Read { signal: even, rate_hz: even_hz, machine, notes, of_run, turning, quality })
}

/// Mean distance of pulses.
fn mean_gap(pulses: &[f64]) -> Option<f64> {
    let [first, .., last] = pulses else { return None };
    Some((last - first) / (pulses.len() - 1) as f64)
}

/// The file of a record, and the scene where it is that of a run.
pub(super) fn located(asked: &Path, place: &Place) -> Result<(PathBuf, Option<Scene>)> {
    let mut file = place.locate(asked);
    if !file.exists() || file.extension().is_some_and(|end| end == "ron") {
        file = place.locate_run(asked);
        place.refuse_scene(&file)?;
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
    let signals: Vec<&Channel> = recording.channels.iter().filter(|c| c.len != 1 && !is_time(c)).collect();
    // Of a run the one that its report judges.
    let found =
        signals.iter().find(|c| of_run && c.name.starts_with("sensor.") && c.name.ends_with(".ay_m_s2"));
    let longest = signals.iter().map(|c| c.len).max().unwrap_or(0);
    let of_longest: Vec<&Channel> = signals.iter().filter(|c| c.len == longest).copied().collect();
    windows::refuse(recording, &of_longest)?;
    // An hour, a count of turns or a switch is no vibration: those that move come first.
    let first = match &of_longest[..] {
        [] | [_] => of_longest.first(),
        all => all.iter().find(|c| moves(c)).or_else(|| all.first()),
    };
    let Some(channel) = found.or(first) else {
        let times = recording.channels.iter().filter(|c| is_time(c) && c.len > 1);
        let even = times.map(|c| format!("; `{}` rises evenly, as times or a count do", c.name));
        let notes: String = recording.notes.iter().map(|note| format!("; {note}")).chain(even).collect();
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
/// reported later.
pub(super) fn moves(channel: &Channel) -> bool {
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

/// The speeds that the file says [1/min], each with its name there: that of `rpm`, or all that differ. One that does not
/// say its unit is noted.
fn speed_in_file(recording: &Recording, notes: &mut Vec<String>) -> Result<Vec<(f64, String)>> {
    let mut said: Vec<(f64, String)> = Vec::new();
    for channel in recording.channels.iter().filter(|c| c.len == 1) {
        let (name, value) =
            (channel.name.to_lowercase(), channel.read()?.first().copied().unwrap_or(f64::NAN));
        let of_name = name.contains("rpm").then_some((1.0, false));
        // Neither a line of the mains nor what a filter or the sampling has.
        let is_speed =
            ["rpm", "speed", "shaft", "omega", "rotat", "drehzahl"].iter().any(|word| name.contains(word))
                && !["line", "resol", "std", "max", "toler", "_fs", "cutoff", "sampl"]
                    .iter()
                    .any(|word| name.contains(word));
        let turns = tacho::turns_a_minute(channel).or(of_name).filter(|_| is_speed);
        let Some((factor, _)) = turns else {
            if ["speed", "drehzahl", "omega"].contains(&name.rsplit('.').next().unwrap_or(&name)) {
                notes.push(format!(
                    "`{}` is {value} and does not say its unit: no speed follows",
                    channel.name
                ));
            }
            continue;
        };
        let rpm = factor * value.abs();
        if !(rpm.is_finite() && rpm > 0.0) {
            continue;
        }
        if name == "rpm" {
            return Ok(vec![(rpm, channel.name.clone())]);
        }
        if said.iter().all(|(other, _)| (other / rpm - 1.0).abs() > STEADY) {
            said.push((rpm, channel.name.clone()));
        }
    }
    Ok(said)
}

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
        (Some(text), _) => Some(catalogue::parse(text).map_err(anyhow::Error::msg)?),
        (None, Some(scene)) => Some(catalogue::of_scene(scene)),
        (None, None) => None,
    };
    let said = speed_in_file(recording, notes)?;
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
        let (signal, channel) = (channel, recording.channel(name)?);
        // A tachometer may have a rate of its own.
        let own_hz =
            channel.rate_hz.filter(|_| !options.force_rate || channel.len != samples).unwrap_or(rate_hz);
        let mut turns = tacho::of(channel, own_hz, options.pulses_per_turn)?;
        turns.pulses.iter_mut().for_each(|at| *at *= rate_hz / own_hz);
        notes.append(&mut turns.notes);
        let later_s = clocks::later_s(signal, channel, (rate_hz, own_hz), notes)?;
        turns.pulses.iter_mut().for_each(|at| *at += later_s * rate_hz);
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
    } else {
        match &said[..] {
            [] => None,
            [(rpm, name)] => {
                notes.push(format!("the speed of {rpm} rpm is that of `{name}` in the file"));
                Some(*rpm)
            }
            [(rpm, name), others @ ..] => {
                let other = &others[0];
                notes.push(format!(
                    "`{name}` is {rpm} and `{}` is {}: neither is taken for the speed; give `--speed-rpm`",
                    other.1, other.0
                ));
                None
            }
        }
    };
    // A shaft that stands turns backwards against its outer ring.
    let of_outer = speed_rpm.filter(|_| options.outer_ring_turns).map_or(0.0, |rpm| -rpm);
    let outer_speed_rpm = scene.map_or(of_outer, stribeck_analysis::diagnosis::outer_speed_rpm);
    // A measured speed, or that of a run, needs no correction.
    let nominal =
        matches!(options.speed_rpm, Some(Speed::Of(_))) || (options.speed_rpm.is_none() && said.len() == 1);
    let speed_is_exact = scene.is_some() || options.tacho.is_some() || !nominal;
    let machine = Machine {
        speed_rpm,
        outer_speed_rpm,
        bearing,
        speed_is_exact,
        load_n: options.load_n,
        clearance_um: options.clearance_um,
        housing_um_per_kn: options.housing_um_per_kn,
        sound_db: options.sound_db.clone(),
        shared_hz: options.shared_hz.clone(),
        pressed: options.pressed,
        ..Machine::default()
    };
    Ok((machine, pulses))
}
