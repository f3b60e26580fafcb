//! Choices that the paper leaves open, one at a time, against the levels that it states.

use std::f64::consts::PI;

use anyhow::Result;
use stribeck_analysis::paper as theirs;
use stribeck_analysis::record::Record;
use stribeck_report::plot::{Axis, Colour, Figure, Level, Series};
use stribeck_store::run_dir::Run;

use super::{LEAN, LONG, SHORT, tone};
use crate::table::{number, quantity_by};
use crate::{Column, Finished, Sheet, Variant};

/// Level of the paper's tone [g]: removed by the notch between ± 50 g and ± 20 g.
const TONE_G: f64 = theirs::BETWEEN_G - theirs::FILTERED_G;

/// Reference of the variants: the first default scene.
const KEPT: &str = "mesh.roller_copies=translated";

/// Sensors all around the ring; the paper says "a node on its outer surface".
const SENSORS: [i32; 9] = [0, 22, 40, 90, 140, 158, 180, 225, 270];

/// How the names of runs of three passages begin.
const THIRTY: &str = "base-30ms";

/// The variants: a group, a name, overrides of the default scene.
pub(super) fn variants() -> Vec<Variant> {
    let sensors: Vec<String> =
        SENSORS.iter().map(|a| format!("(name: \"at{a}\", angle_deg: {a}.0)")).collect();
    let sensors = format!("output.sensors=[{}]", sensors.join(", "));
    let of = |name: &str, length: &[&str], set: &[&str]| {
        let variant = Variant::new(format!("base-{name}"), LEAN, length).with(sensors.clone()).with(KEPT);
        set.iter().fold(variant, |variant, s| variant.with(*s))
    };
    let short = |name: &str, set: &[&str]| of(name, &SHORT, set);
    let (turned, step) = ("mesh.roller_copies=rotated", "solver.time_step_factor=0.9");
    vec![
        short("default", &[]),
        short("thickness-5", &["bearing.thickness_mm=5.0"]),
        short("thickness-10", &["bearing.thickness_mm=10.0"]),
        short("thickness-20", &["bearing.thickness_mm=20.0"]),
        short("thickness-50", &["bearing.thickness_mm=50.0"]),
        short("penalty-0_03", &["contact.penalty_scale=0.03"]),
        short("penalty-0_1", &["contact.penalty_scale=0.1"]),
        short("penalty-0_3", &["contact.penalty_scale=0.3"]),
        short("penalty-1", &["contact.penalty_scale=1.0"]),
        short("points-4", &["contact.points_per_facet=4"]),
        short("points-8", &["contact.points_per_facet=8"]),
        short("collocated", &["contact.method=collocated"]),
        short("collocated-penalty-1", &["contact.method=collocated", "contact.penalty_scale=1.0"]),
        short("contact-damping-0", &["contact.damping_ratio=0.0"]),
        short("contact-damping-0_5", &["contact.damping_ratio=0.5"]),
        short("mass-damping-1174", &["solver.mass_damping_per_s=1174.0"]),
        short("mass-damping-20000", &["solver.mass_damping_per_s=20000.0"]),
        short("rotated", &["mesh.roller_copies=rotated"]),
        short("facets-113", &["mesh.roller_facets=113"]),
        short("sudden", &["solver.start=sudden"]),
        short("stiffness-damping-5", &["solver.stiffness_damping_ns=5.0"]),
        short("stiffness-damping-20", &["solver.stiffness_damping_ns=20.0"]),
        short("stiffness-damping-60", &["solver.stiffness_damping_ns=60.0"]),
        of("30ms", &LONG, &[]),
        of("30ms-rotated", &LONG, &[turned]),
        of("30ms-again", &LONG, &[step]),
        of("30ms-rotated-again", &LONG, &[turned, step]),
    ]
}

const COLUMNS: [Column; 8] = [
    Column { name: "tone Hz", decimals: 0, of: |run| tone(run).and_then(|t| t.measured_hz) },
    Column { name: "tone g", decimals: 1, of: |run| tone(run).and_then(|t| t.level_g) },
    Column { name: "impulse g", decimals: 0, of: |run| run.numbers()?.levels.impulse_g },
    Column { name: "between g", decimals: 0, of: |run| run.numbers()?.levels.between_g },
    Column { name: "notched g", decimals: 0, of: |run| run.numbers()?.levels.between_filtered_g },
    Column { name: "notch dB", decimals: 0, of: |run| run.numbers()?.notch.as_ref()?.attenuation_db },
    Column { name: "spall mm", decimals: 2, of: |run| run.numbers()?.events.first()?.spall_mm },
    Column { name: "off, octaves", decimals: 2, of: misfit },
];

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

/// Table, picture and verdict.
pub(super) fn write(sheet: &mut Sheet, runs: &[Finished]) -> Result<()> {
    sheet.heading("What the paper leaves open");
    sheet.say(&format!(
        "The paper's levels are ± {:.0} g at the exits, ± {:.0} g between them and ± {:.0} g behind the \
         notch; its tone stands at {:.0} Hz and \
         is about {TONE_G:.0} g strong, what the notch takes. *Off* is the mean distance of these four \
         levels from the paper's in \
         octaves, so 1 is a factor of two. Each variant changes one choice of `base-default`, the default \
         scene with copies in \
         one orientation.",
        theirs::IMPULSE_G,
        theirs::BETWEEN_G,
        theirs::FILTERED_G,
        theirs::TONE_HZ
    ));
    let (long, short): (Vec<&Finished>, Vec<&Finished>) =
        runs.iter().partition(|r| r.variant.name.starts_with(THIRTY));
    sheet.runs("base", &short, &COLUMNS);
    verdict(sheet, &short);
    dissipation(sheet, &short);
    thirty(sheet, &long);
    if let Some(default) = runs.iter().find(|r| r.variant.name == "base-default") {
        sensors(sheet, default)?;
    }
    let swept = |name: &str| -> Vec<(f64, &Finished)> {
        let value = |run: &Finished| match name {
            "thickness" => run.scene.written.bearing.thickness_mm,
            _ => run.scene.written.contact.penalty_scale,
        };
        let of_sweep = |run: &&Finished| {
            run.variant.name.starts_with(&format!("base-{name}-")) || run.variant.name == "base-default"
        };
        let mut found: Vec<(f64, &Finished)> = runs.iter().filter(of_sweep).map(|r| (value(r), r)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    };
    for (name, title, axis, unit) in [
        ("penalty", "Levels against contact stiffness", "log₁₀ of the penalty stiffness over E/h", ""),
        ("thickness", "Levels against thickness", "Thickness", "mm"),
    ] {
        let runs = swept(name);
        if runs.len() < 2 {
            continue;
        }
        let place = |v: f64| if name == "penalty" { v.log10() } else { v };
        let x: Vec<f64> = runs.iter().map(|r| place(r.0)).collect();
        let mut figure = Figure::new(name, title, Axis::plain(axis, unit), Axis::plain("Level", "g"));
        let of =
            [("impulse", Colour::Blue, 2), ("between", Colour::Orange, 3), ("notched", Colour::Green, 4)];
        for (words, colour, column) in of {
            let y = runs.iter().map(|r| quantity_by(&COLUMNS[column], r.1)).collect();
            figure = figure.with(Series::listed(words, colour, x.clone(), y));
        }
        for (g, words, colour) in [
            (theirs::IMPULSE_G, "paper, impulses", Colour::Blue),
            (theirs::BETWEEN_G, "paper, between", Colour::Orange),
            (theirs::FILTERED_G, "paper, notched", Colour::Green),
        ] {
            figure.levels.push(Level { y: g, label: format!("{words}: {g:.0} g"), colour });
        }
        sheet.picture(&figure)?;
    }
    Ok(())
}

/// The nearest variant, and whether it is the default.
fn verdict(sheet: &mut Sheet, runs: &[&Finished]) {
    let mut scored: Vec<(f64, &Finished)> = runs.iter().filter_map(|r| Some((misfit(r)?, *r))).collect();
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some((best, run)) = scored.first() else { return };
    let default = scored.iter().find(|s| s.1.variant.name == "base-default");
    sheet.say(&format!(
        "Nearest to the paper: `{}`, {} octaves off{}.",
        run.variant.name,
        number(*best, 2),
        default.map_or(String::new(), |d| format!("; `base-default`: {}", number(d.0, 2)))
    ));
}

/// Effect and cost of dissipation at high frequencies.
fn dissipation(sheet: &mut Sheet, runs: &[&Finished]) {
    let damped = |run: &&&Finished| {
        run.scene.written.solver.stiffness_damping_ns > 0.0 || run.variant.name == "base-default"
    };
    let mut rows: Vec<&Finished> = runs.iter().filter(damped).copied().collect();
    rows.sort_by(|a, b| {
        a.scene.written.solver.stiffness_damping_ns.total_cmp(&b.scene.written.solver.stiffness_damping_ns)
    });
    if rows.len() < 2 {
        return;
    }
    sheet.heading("High-frequency dissipation");
    sheet.say(
        "Stiffness-proportional damping β (THEORY §2.7) has the damping ratio βω/2. 5 ns are what the linear \
         bulk viscosity of 0.06, \
         usual in explicit codes, does to elements of 0.5 mm. *Instant* is the root mean square of the nodal \
         acceleration of \
         single steps at the side sensor between the impulses, where the mesh rings in the MHz range; \
         *between* is the peak of the \
         mean over 10 µs, which is what a record of 100 kHz should hold.",
    );
    sheet.runs("dissipation", &rows, &DISSIPATION);
}

const DISSIPATION: [Column; 8] = [
    Column { name: "β ns", decimals: 0, of: |run| Some(run.scene.written.solver.stiffness_damping_ns) },
    Column {
        name: "ζ at 50 kHz %",
        decimals: 2,
        of: |run| Some(PI * 5e4 * 1e-7 * run.scene.written.solver.stiffness_damping_ns),
    },
    Column { name: "time step ns", decimals: 1, of: |run| run.info.as_ref().map(|i| 1e9 * i.time_step_s) },
    Column { name: "instant g", decimals: 0, of: instant_g },
    Column { name: "impulse g", decimals: 0, of: |run| run.numbers()?.levels.impulse_g },
    Column { name: "between g", decimals: 0, of: |run| run.numbers()?.levels.between_g },
    Column { name: "heat J", decimals: 3, of: heat_j },
    Column {
        name: "energy error %",
        decimals: 3,
        of: |run| run.info.as_ref().map(|i| 100.0 * i.energy.max_relative_error),
    },
];

/// Root mean square of a_y of single steps at the leading sensor from 7 ms on [g]: after the exit and its
/// ringing.
fn instant_g(run: &Finished) -> Option<f64> {
    let read = Run::read(&run.folder).ok()?;
    let record = Record::whole(&read).ok()?;
    let from = record.time_s().partition_point(|&t| t < 7e-3);
    let until = record.time_s().partition_point(|&t| t < 11.4e-3);
    let all = record.acceleration_g(&run.scene.written.output.sensors.first()?.name, "ay_instant")?;
    let quiet = all.get(from..until)?;
    Some((quiet.iter().map(|a| a * a).sum::<f64>() / quiet.len() as f64).sqrt())
}

/// Heat of mass and stiffness damping [J].
fn heat_j(run: &Finished) -> Option<f64> {
    Run::read(&run.folder).ok()?.energy.channel("damping_j").ok()??.last().copied()
}

/// Copies in one orientation against copies turned with the pattern, over three passages, each run twice: the
/// second with another time step, so that their difference is the scatter of one scene.
fn thirty(sheet: &mut Sheet, runs: &[&Finished]) {
    if runs.is_empty() {
        return;
    }
    sheet.heading("Translated or rotated copies, 30 ms");
    sheet.say(
        "Three passages. The runs called *again* differ from the others by a time step five per cent shorter \
         and by nothing else: \
         what differs between them is the scatter of one scene, whose idle rollers rattle by chance.",
    );
    sheet.runs("thirty", runs, &COLUMNS);
    let off = |name: &str| runs.iter().find(|r| r.variant.name == name).and_then(|r| misfit(r));
    let all = [THIRTY, "base-30ms-again", "base-30ms-rotated", "base-30ms-rotated-again"].map(off);
    if let [Some(a), Some(b), Some(c), Some(d)] = all {
        let (difference, scatter) = (0.5 * (a + b) - 0.5 * (c + d), (a - b).abs().max((c - d).abs()));
        sheet.say(&format!(
            "Translated copies are {} octaves off on average, rotated ones {}; runs of one scene differ by \
             up to {}. {}",
            number(0.5 * (a + b), 2),
            number(0.5 * (c + d), 2),
            number(scatter, 2),
            if difference.abs() > scatter {
                "The difference is larger than the scatter."
            } else {
                "The difference is within the scatter: the levels do not decide between them."
            }
        ));
    }
}

/// Levels of one run at every sensor.
fn sensors(sheet: &mut Sheet, run: &Finished) -> Result<()> {
    let Some(summary) = run.numbers() else { return Ok(()) };
    sheet.heading("Where the sensor is");
    sheet.say(
        "`base-default`, at sensors all around the outer ring; the adapter's seat reaches from 43° to 137°.",
    );
    let cell = |v: Option<f64>, decimals| v.map_or("–".to_owned(), |v| number(v, decimals));
    let rows: Vec<Vec<String>> = summary
        .levels
        .sensors
        .iter()
        .map(|s| {
            let tone = stribeck_analysis::tones::dominant(&summary.tones, &s.sensor);
            vec![
                format!("{}°", s.sensor.trim_start_matches("at")),
                cell(tone.and_then(|t| t.measured_hz), 0),
                cell(tone.and_then(|t| t.level_g), 1),
                cell(s.impulse_g, 0),
                cell(s.between_g, 0),
                cell(s.between_filtered_g, 0),
            ]
        })
        .collect();
    sheet.table(&["angle", "tone Hz", "tone g", "impulse g", "between g", "notched g"], &rows);
    Ok(())
}
