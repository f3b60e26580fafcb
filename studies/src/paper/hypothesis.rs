//! Consequences of the paper's hypothesis that polygonised rollers make the tone: its frequency and level
//! when facets, speed, load and orientation change. A bearing without a defect, so without impacts.

use anyhow::Result;
use stribeck_analysis::load::support;
use stribeck_analysis::lumped::{Lumped, pattern_hz};
use stribeck_analysis::record::Record;
use stribeck_analysis::signal::{self, Line};
use stribeck_analysis::tones::LEAST_PROMINENCE_DB;
use stribeck_report::plot::{Axis, Colour, Figure, Series};
use stribeck_store::run_dir::Run;

use super::{LEAN, LONG};
use crate::table::{number, quantity_by};
use crate::{Column, Finished, Sheet, Variant};

/// Raceways with counts of their own, so that their lines stand 900 Hz and more away from those of the
/// rollers.
const RACES: [&str; 2] = ["mesh.outer_facets=1000", "mesh.inner_facets=820"];
/// The stiff contact: it smooths the facets least, so the line is clearest.
const STIFF: &str = "contact.penalty_scale=1.0";
/// Nothing to knock against.
const SOUND: &str = "defect=None";
/// Loaded rollers that turn this much slower than rolling ones slide.
const ROLLS: f64 = 0.97;

pub(super) fn variants() -> Vec<Variant> {
    experiments("sound", &[LONG[0], LONG[1], SOUND])
}

/// Every experiment, all under the overrides `set`; their names begin with `prefix`.
pub(super) fn experiments(prefix: &str, set: &[&str]) -> Vec<Variant> {
    let variant = |name: &str, own: &[&str]| {
        let all = set.iter().chain(&RACES).chain([&STIFF, &TRANSLATED]).chain(own);
        Variant::new(format!("{prefix}-{name}"), LEAN, &all.copied().collect::<Vec<_>>())
    };
    let mut all: Vec<Variant> =
        FACETS.iter().map(|n| variant(n, &[&format!("mesh.roller_facets={n}")])).collect();
    all.extend([
        variant("56-friction", &["mesh.roller_facets=56", "contact.friction=0.1"]),
        variant("112-rotated", &["mesh.roller_copies=rotated"]),
        variant("113-rotated", &["mesh.roller_facets=113", "mesh.roller_copies=rotated"]),
        variant("112-250rpm", &["operation.speed_rpm=250.0"]),
        variant("112-1000rpm", &["operation.speed_rpm=1000.0"]),
    ]);
    let load = |kn: &u32| variant(&format!("112-{kn}kN"), &[&format!("operation.load_n={kn}000.0")]);
    all.extend(LOADS_KN.iter().map(load));
    all
}

/// Unless an experiment says otherwise.
const TRANSLATED: &str = "mesh.roller_copies=translated";

/// Facets of a roller.
const FACETS: [&str; 5] = ["56", "112", "113", "120", "224"];
/// Loads besides the paper's 50 kN.
const LOADS_KN: [u32; 4] = [25, 35, 70, 100];

const COLUMNS: [Column; 14] = [
    Column { name: "N_v", decimals: 0, of: |run| Some(run.scene.written.mesh.roller_facets as f64) },
    Column { name: "N_v × spin Hz", decimals: 0, of: |run| lumped(run).map(|l| l.frequency_hz) },
    Column { name: "friction to roll", decimals: 4, of: |run| lumped(run).map(|l| l.friction_to_roll) },
    Column { name: "rolling", decimals: 3, of: rolling },
    Column { name: "measured Hz", decimals: 1, of: |run| line(run).map(|l| l.hz) },
    Column { name: "off, resolutions", decimals: 2, of: off },
    Column { name: "pattern Hz", decimals: 1, of: pattern },
    Column { name: "off pattern, resolutions", decimals: 2, of: off_pattern },
    Column { name: "above background dB", decimals: 0, of: above },
    Column { name: "side g", decimals: 1, of: |run| line_at(run, "side").map(|l| l.amplitude) },
    Column { name: "clearest g", decimals: 1, of: |run| line(run).map(|l| l.amplitude) },
    Column { name: "sum of forces N", decimals: 0, of: force_line },
    Column { name: "lumped g", decimals: 1, of: |run| lumped(run).map(|l| l.level_g) },
    Column { name: "phases", decimals: 2, of: |run| lumped(run).map(|l| l.phases) },
];

/// The line of the roller vertices at the sensor where it stands out most, when it is one.
pub(super) fn line(run: &Finished) -> Option<Line> {
    clearest(run).filter(|l| l.above_db >= LEAST_PROMINENCE_DB)
}

/// Height of the roller line above its surroundings at the sensor where it is highest [dB], line or not.
pub(super) fn above(run: &Finished) -> Option<f64> {
    clearest(run).map(|l| l.above_db)
}

fn clearest(run: &Finished) -> Option<Line> {
    let sensors = run.scene.written.output.sensors.iter();
    sensors.filter_map(|s| peak_at(run, &s.name)).max_by(|a, b| a.above_db.total_cmp(&b.above_db))
}

fn line_at(run: &Finished, sensor: &str) -> Option<Line> {
    peak_at(run, sensor).filter(|l| l.above_db >= LEAST_PROMINENCE_DB)
}

/// The highest peak within a resolution of N_v × spin or of the pattern's line.
fn peak_at(run: &Finished, sensor: &str) -> Option<Line> {
    let read = Run::read(&run.folder).ok()?;
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

fn off_pattern(run: &Finished) -> Option<f64> {
    Some((line(run)?.hz - pattern(run)?) / resolution(run)?)
}

/// Spin of the loaded rollers relative to the cage over that of rolling ones.
pub(super) fn rolling(run: &Finished) -> Option<f64> {
    let motion = &run.numbers()?.kinematics;
    Some(motion.roller_spin_hz? / motion.expected_roller_spin_hz)
}

fn lumped(run: &Finished) -> Option<Lumped> {
    Lumped::of(&run.scene).ok()
}

/// Distance of the measured line from N_v × spin without slip, in resolutions.
fn off(run: &Finished) -> Option<f64> {
    Some((line(run)?.hz - lumped(run)?.frequency_hz) / resolution(run)?)
}

/// Amplitude of the roller line in the vertical force of all rollers [N].
fn force_line(run: &Finished) -> Option<f64> {
    let read = Run::read(&run.folder).ok()?;
    let record = Record::whole(&read).ok()?;
    signal::amplitude(
        &support(&record, run.scene.written.load_direction()),
        record.sample_rate_hz(),
        lumped(run)?.frequency_hz,
    )
}

/// Table, pictures, conclusions.
pub(super) fn write(sheet: &mut Sheet, runs: &[Finished]) -> Result<()> {
    sheet.heading("Experiments on the hypothesis");
    sheet.say(
        "A bearing without a defect, 30 ms: 33 Hz are resolved, and nothing knocks. The raceways have 1000 \
         and 820 facets, \
         whose lines stand near 3754 Hz, so that what stands at N_v × spin comes from the rollers alone, and \
         the contact is stiff \
         (E/h), which smooths the facets least. *Friction to roll* is what the most loaded roller needs to \
         be turned over its own vertices \
         by traction (THEORY §5.4); the scene has 0.005. *Rolling* is the spin of the loaded rollers \
         relative to the cage over that \
         of rolling without slip. *Off* is measured against N_v × spin without slip, in resolutions of the \
         record; \
         *pattern* is where copies in one orientation have their line by the recorded motion (THEORY §5.5). \
         *Lumped* is the \
         acceleration of a rigid ring on springs that follow the polygons (`crates/analysis/src/lumped.rs`): \
         its phases and its \
         smoothing by the contact\u{2019}s width, without the ring\u{2019}s own dynamics. *Sum of forces* is \
         the line in the \
         vertical force of all rollers, which knows no transfer path. A line counts when it stands 10 dB \
         above its surroundings.",
    );
    sheet.runs("hypothesis", &runs.iter().collect::<Vec<_>>(), &COLUMNS);
    conclusions(sheet, runs);
    if runs.len() > 2 {
        sheet.picture(&frequencies(runs))?;
        sheet.picture(&levels(runs))?;
    }
    Ok(())
}

/// Conclusions from the numbers of the table.
fn conclusions(sheet: &mut Sheet, runs: &[Finished]) {
    let found: Vec<(&Finished, f64)> = runs.iter().filter_map(|r| Some((r, off(r)?))).collect();
    let inside = found.iter().filter(|f| f.1.abs() <= 1.0).count();
    let worst = found.iter().map(|f| f.1.abs()).fold(0.0, f64::max);
    let near_pattern = |run: &Finished| off_pattern(run).is_some_and(|o| o.abs() <= 1.0);
    let of_pattern = found.iter().filter(|(run, _)| near_pattern(run)).count();
    let nearer =
        found.iter().filter(|(run, off)| off_pattern(run).is_some_and(|o| o.abs() < off.abs())).count();
    let silent: Vec<&Finished> = runs.iter().filter(|r| r.numbers().is_some() && off(r).is_none()).collect();
    let sliding = silent.iter().filter(|r| rolling(r).is_some_and(|r| r < ROLLS)).count();
    sheet.say(&format!(
        "Of {} runs, {} show the line: {inside} have it within one resolution of N_v × spin (the farthest is \
         {} off) and {of_pattern} within \
         one resolution of the pattern\u{2019}s line.",
        found.len() + silent.len(),
        found.len(),
        number(worst, 2)
    ));
    if !silent.is_empty() {
        sheet.say(&format!(
            "Runs without the line: {}, of which with rollers that slide instead of rolling: {sliding}.",
            silent.len()
        ));
    }
    sheet.say(&format!(
        "{nearer} of {} lines are nearer to the pattern\u{2019}s line than to N_v × spin.",
        found.len()
    ));
    load(sheet, runs);
    let by = |name: &str| runs.iter().find(|r| r.variant.name == format!("sound-{name}"));
    let ratio = |a: &str, b: &str, of: fn(&Finished) -> Option<f64>| Some(of(by(a)?)? / of(by(b)?)?);
    let says = [
        ("rotated against translated copies, N_v = 112", "112-rotated", "112"),
        ("N_v = 113 against 112, translated", "113", "112"),
        ("N_v = 113 against 112, rotated", "113-rotated", "112-rotated"),
        ("N_v = 120 against 112, translated", "120", "112"),
        ("N_v = 56 against 112", "56", "112"),
        ("N_v = 224 against 112", "224", "112"),
        ("1000 against 500 rpm", "112-1000rpm", "112"),
        ("250 against 500 rpm", "112-250rpm", "112"),
        ("25 against 50 kN", "112-25kN", "112"),
        ("35 against 50 kN", "112-35kN", "112"),
        ("70 against 50 kN", "112-70kN", "112"),
        ("100 against 50 kN", "112-100kN", "112"),
    ];
    let cell = |v: Option<f64>| v.map_or("–".to_owned(), |v| format!("× {v:.2}"));
    let rows: Vec<Vec<String>> = says
        .iter()
        .filter(|(_, a, b)| by(a).is_some() && by(b).is_some())
        .map(|(words, a, b)| {
            vec![
                (*words).to_owned(),
                cell(ratio(a, b, force_line)),
                cell(ratio(a, b, |r| line(r).map(|l| l.amplitude))),
                cell(ratio(a, b, |r| lumped(r).map(|l| l.level_g))),
            ]
        })
        .collect();
    sheet.table(&["level of", "sum of forces", "clearest sensor", "lumped"], &rows);
}

/// Whether load moves the line.
fn load(sheet: &mut Sheet, runs: &[Finished]) {
    let names: Vec<String> =
        LOADS_KN.iter().map(|kn| format!("sound-112-{kn}kN")).chain(["sound-112".to_owned()]).collect();
    let loaded: Vec<&Finished> = runs.iter().filter(|r| names.contains(&r.variant.name)).collect();
    let range = |of: fn(&Finished) -> Option<f64>| {
        let all: Vec<f64> = loaded.iter().filter_map(|r| of(r)).collect();
        let low = all.iter().copied().reduce(f64::min)?;
        Some((all.len(), low, all.into_iter().reduce(f64::max)?))
    };
    let resolution = loaded.iter().find_map(|r| resolution(r));
    let line = range(|r| line(r).map(|l| l.hz));
    if let (Some((count, low, high)), Some((_, slow, fast)), Some(resolution)) =
        (line, range(rolling), resolution)
    {
        sheet.say(&format!(
            "Load: at {count} of {} loads between 25 and 100 kN the line stands out, between {} and {} Hz, \
             {} % apart, {} than one \
             resolution of {} Hz; the spin of the rollers differs by {} %.",
            loaded.len(),
            number(low, 1),
            number(high, 1),
            number(100.0 * (high / low - 1.0), 2),
            if high - low < resolution { "less" } else { "more" },
            number(resolution, 0),
            number(100.0 * (fast / slow - 1.0), 2)
        ));
    }
}

fn frequencies(runs: &[Finished]) -> Figure {
    let mut points: Vec<(f64, f64)> =
        runs.iter().filter_map(|r| Some((lumped(r)?.frequency_hz, quantity_by(&COLUMNS[4], r)))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
    let axis = |label: &str| Axis::si(label, "Hz");
    Figure::new(
        "frequency",
        "The roller line follows N_v × spin",
        axis("N_v × spin, without slip"),
        axis("Measured"),
    )
    .with(Series::listed("equal", Colour::Grey, x.clone(), x.clone()))
    .with(Series::listed("measured, clearest sensor", Colour::Blue, x, y).as_points())
    .caption(
        "Measured against predicted frequency over facets, speed, load and orientation; the grey \
            line is no fit.",
    )
}

fn levels(runs: &[Finished]) -> Figure {
    let decibels = |v: f64| 20.0 * v.log10();
    let mut points: Vec<(f64, f64, f64)> = runs
        .iter()
        .filter_map(|r| Some((lumped(r)?.level_g, force_line(r)?, line(r).map_or(f64::NAN, |l| l.amplitude))))
        .filter(|p| p.0 > 0.01)
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let x: Vec<f64> = points.iter().map(|p| decibels(p.0)).collect();
    let sensor = points.iter().map(|p| decibels(p.2)).collect();
    let force = points.iter().map(|p| decibels(p.1 / 1000.0)).collect();
    Figure::new(
        "level",
        "Its level against the lumped prediction",
        Axis::plain("Lumped prediction", "dB re 1 g"),
        Axis::plain("Measured", "dB re 1 g; dB re 1 kN"),
    )
    .with(Series::listed("equal", Colour::Grey, x.clone(), x.clone()))
    .with(Series::listed("clearest sensor", Colour::Blue, x.clone(), sensor).as_points())
    .with(Series::listed("sum of forces", Colour::Orange, x, force).as_points())
    .caption(
        "A slope of one means that phases, speed and contact width act as the lumped model says; odd \
        counts, for which it predicts nothing, are left out.",
    )
}
