//! `cargo xtask study paper`: which reading of the paper agrees with it best, and whether its hypothesis,
//! that polygonised rollers make the tone, holds for other facets, speeds, loads and orientations.

use anyhow::Result;
use stribeck_analysis::load::support;
use stribeck_analysis::lumped::{Lumped, pattern_hz};
use stribeck_analysis::paper as theirs;
use stribeck_analysis::record::Record;
use stribeck_analysis::signal::{self, Line};
use stribeck_analysis::tones::{self, LEAST_PROMINENCE_DB, Tone};

use crate::plan::Kernel;
use crate::{Finished, Plan, Rows, Runner, figure};

/// Level of the paper's tone [g]: removed by the notch between ± 50 g and ± 20 g.
const TONE_G: f64 = theirs::BETWEEN_G - theirs::FILTERED_G;

/// Loaded rollers that turn this much slower than rolling ones slide.
const ROLLS: f64 = 0.97;

const KERNELS: &[Kernel] = &[
    ("tone_hz", |run| tone(run)?.measured_hz),
    ("tone_g", |run| tone(run)?.level_g),
    ("off_octaves", misfit),
    ("instant_g", instant_g),
    ("heat_j", |run| run.trace()?.energy.channel("damping_j").ok()??.last().copied()),
    ("facet_hz", |run| lumped(run).map(|l| l.frequency_hz)),
    ("friction_to_roll", |run| lumped(run).map(|l| l.friction_to_roll)),
    ("rolling", rolling),
    ("line_hz", |run| line(run).map(|l| l.hz)),
    ("off", |run| Some((line(run)?.hz - lumped(run)?.frequency_hz) / resolution(run)?)),
    ("pattern_hz", pattern),
    ("off_pattern", |run| Some((line(run)?.hz - pattern(run)?) / resolution(run)?)),
    ("above_db", |run| clearest(run).map(|l| l.above_db)),
    ("side_g", |run| peak_at(run, "side").filter(is_line).map(|l| l.amplitude)),
    ("clearest_g", |run| line(run).map(|l| l.amplitude)),
    ("force_line_n", force_line),
    ("lumped_g", |run| lumped(run).map(|l| l.level_g)),
    ("phases", |run| lumped(run).map(|l| l.phases)),
];

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<()> {
    let plan = Plan::read(runner.study)?;
    let groups = plan.run(runner, KERNELS, rows)?;
    if let Some(run) = groups.iter().flatten().find(|run| run.variant.name == "base-default") {
        sensors(rows, run);
    }
    plan.figures.iter().try_for_each(|drawing| figure::draw(runner.study, &drawing.of(rows)))
}

/// Levels of one run at every sensor.
fn sensors(rows: &mut Rows, run: &Finished) {
    let Some(summary) = run.numbers() else { return };
    for s in &summary.levels.sensors {
        let tone = tones::dominant(&summary.tones, &s.sensor);
        let values = [
            ("tone Hz", tone.and_then(|t| t.measured_hz)),
            ("tone g", tone.and_then(|t| t.level_g)),
            ("impulse g", s.impulse_g),
            ("between g", s.between_g),
            ("notched g", s.between_filtered_g),
        ];
        rows.values("sensors", &s.sensor, values);
    }
}

/// The strongest facet line at the leading sensor.
fn tone(run: &Finished) -> Option<&Tone> {
    let summary = run.numbers()?;
    tones::dominant(&summary.tones, summary.levels.sensor.as_deref()?)
}

/// Mean distance of tone, impulse, between and notched level from the paper's, in octaves: 1 is a factor of
/// two. A tone that does not stand out has no level; it counts one octave.
fn misfit(run: &Finished) -> Option<f64> {
    let levels = &run.numbers()?.levels;
    let octaves = |ours: f64, paper: f64| (ours / paper).log2().abs();
    let tone = tone(run).and_then(|t| t.level_g).map_or(1.0, |g| octaves(g, TONE_G));
    let sum = tone
        + octaves(levels.impulse_g?, theirs::IMPULSE_G)
        + octaves(levels.between_g?, theirs::BETWEEN_G)
        + octaves(levels.between_filtered_g?, theirs::FILTERED_G);
    Some(sum / 4.0)
}

/// Root mean square of a_y of single steps at the leading sensor from 7 to 11.4 ms [g]: after the exit and
/// its ringing.
fn instant_g(run: &Finished) -> Option<f64> {
    let read = run.trace()?;
    let record = Record::whole(&read).ok()?;
    let at = |s: f64| record.time_s().partition_point(|&t| t < s);
    let all = record.acceleration_g(&run.written.output.sensors.first()?.name, "ay_instant")?;
    let quiet = all.get(at(7e-3)..at(11.4e-3))?;
    Some((quiet.iter().map(|a| a * a).sum::<f64>() / quiet.len() as f64).sqrt())
}

fn is_line(line: &Line) -> bool {
    line.above_db >= LEAST_PROMINENCE_DB
}

/// The line of the roller vertices at the sensor where it stands out most, when it is one.
fn line(run: &Finished) -> Option<Line> {
    clearest(run).filter(is_line)
}

/// The highest peak where that line belongs, line or not.
fn clearest(run: &Finished) -> Option<Line> {
    let sensors = run.written.output.sensors.iter();
    sensors.filter_map(|s| peak_at(run, &s.name)).max_by(|a, b| a.above_db.total_cmp(&b.above_db))
}

/// The highest peak within a resolution of N_v × spin or of the pattern's line.
fn peak_at(run: &Finished, sensor: &str) -> Option<Line> {
    let read = run.trace()?;
    let record = Record::whole(&read).ok()?;
    let (free, reach) = (lumped(run)?.frequency_hz, resolution(run)?);
    let pattern = pattern(run).unwrap_or(free);
    let signal = record.acceleration_g(sensor, "ay")?;
    let (from, to) = (free.min(pattern) - reach, free.max(pattern) + reach);
    signal::line_between(&signal, record.sample_rate_hz(), from, to)
}

/// One over the length of the record [Hz].
fn resolution(run: &Finished) -> Option<f64> {
    Some(run.numbers()?.spectrum.as_ref()?.resolution_hz)
}

/// Where the pattern of all rollers has its strongest line by the recorded motion [Hz]; sliding rollers have
/// none.
fn pattern(run: &Finished) -> Option<f64> {
    let motion = &run.numbers()?.kinematics;
    rolling(run).filter(|r| *r >= ROLLS)?;
    Some(pattern_hz(&run.scene, motion.roller_spin_hz?, motion.cage_hz?))
}

/// Spin of the loaded rollers relative to the cage over that of rolling ones.
fn rolling(run: &Finished) -> Option<f64> {
    let motion = &run.numbers()?.kinematics;
    Some(motion.roller_spin_hz? / motion.expected_roller_spin_hz)
}

fn lumped(run: &Finished) -> Option<Lumped> {
    Lumped::of(&run.scene).ok()
}

/// Amplitude of the roller line in the vertical force of all rollers [N].
fn force_line(run: &Finished) -> Option<f64> {
    let read = run.trace()?;
    let record = Record::whole(&read).ok()?;
    let force = support(&record, run.written.load_direction());
    signal::amplitude(&force, record.sample_rate_hz(), lumped(run)?.frequency_hz)
}
