//! `cargo xtask study noise`: sources of contact noise, and the effect of each cure.

mod converged;
pub(super) mod variants;

use anyhow::Result;
use stribeck_analysis::filtering::Filter;
use stribeck_analysis::noise::{Noise, force_ripple, measure, spectrum_g};
use stribeck_analysis::prediction::Prediction;
use stribeck_analysis::record::Record;
use stribeck_report::plot::{Axis, Colour, Figure, Series};
use stribeck_store::run_dir::Run;

use crate::table::number;
use crate::{Answer, Column, Finished, Flags, Host, Runner, Sheet, Variant};

/// Flags of `study noise`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let runner = Runner::new("noise", &options.flags, host);
    let mut sheet = Sheet::new(host.root(), "noise", "Contact noise: its causes, one by one");
    sheet.say(
        "Runs of 12 ms: roller 1 leaves the defect at 5.1 ms. *Line* is the amplitude of the roller \
         vertices\u{2019} line (4671 Hz \
         with 112 facets) and *between* the root mean square, both of the acceleration vector between 7.1 \
         and 11.4 ms, where no \
         roller meets the defect: 4.3 ms resolve 230 Hz, so the line holds the race nodes\u{2019} too. \
         *Background* is what the \
         same measure gives at four neighbouring frequencies, 0.7 and 1.4 kHz away on either side, where the \
         mesh has no line \
         (root of the mean square): a line that does not stand above it is not there. *Ringing* is the root \
         mean square \
         above 20 kHz, *start* that of the first 0.3 ms. *Ripple* is the rms of the force on the most loaded \
         roller about a \
         cubic in time over its mean, 2.4 to 4.3 ms. Impulses need more starts: [impulse](impulse.md). What \
         a step of the cure costs is measured by itself: [PERFORMANCE](../PERFORMANCE.md), §6.",
    );
    let mut ends = Vec::new();
    for (table, title, list) in [
        ("soft", "The default scene\u{2019}s contact, graded mesh", variants::ablation()),
        ("rest", "What the cure needs and what it leaves", variants::remainder()),
        ("stiff", "A contact as stiff as elements (penalty scale 0.7), graded mesh", variants::stiff()),
        ("uniform", "The paper\u{2019}s uniform mesh of 0.5 mm", variants::uniform()),
    ] {
        let (list, shows): (Vec<Variant>, Vec<&str>) = list.into_iter().map(|s| (s.variant, s.shows)).unzip();
        let shown: Vec<Vec<String>> =
            list.iter().zip(shows).map(|(v, shows)| vec![v.name.clone(), shows.to_owned()]).collect();
        let runs = runner.run(&list)?;
        sheet.heading(title);
        sheet.table(&["variant", "what it shows"], &shown);
        let rows: Vec<&Finished> = runs.iter().collect();
        sheet.say(
            "Each row is one start; idle rollers that rattle can double a quiet level from one start to the \
             next. \
             Line, background and level between the impulses [g] at each sensor:",
        );
        sheet.runs(table, &rows, &LEVELS);
        sheet.say(
            "Effects, forces and cost; *points* is the line of the contact points, their number on a \
            facet times the vertices\u{2019} line:",
        );
        sheet.runs(&format!("{table}-effects"), &rows, &EFFECTS);
        ends.extend(runs);
    }
    let long = runner.run(&variants::long())?;
    background(&mut sheet, &long, &ends);
    let names = ["chords", "cured", "fine"];
    let mut groups = Vec::new();
    for (name, list) in names.into_iter().zip(variants::converged()) {
        groups.push((name, runner.run(&list)?));
    }
    converged::write(&mut sheet, &groups);
    let find =
        |name: &str| ends.iter().find(|r| r.variant.name == name).and_then(|r| Run::read(&r.folder).ok());
    for (id, first, last) in [
        ("soft", "paper", "smooth"),
        ("stiff", "stiff", "stiff-smooth"),
        ("uniform", "uniform-paper", "uniform-smooth"),
    ] {
        if let (Some(first), Some(last)) = (find(first), find(last)) {
            pictures(&mut sheet, id, &first, &last)?;
        }
    }
    Ok(Answer::on(sheet.write()?))
}

/// Whether the level at the line's frequency is a line above the background.
fn background(sheet: &mut Sheet, long: &[Finished], ends: &[Finished]) {
    let named = |name: &str| ends.iter().find(|r| r.variant.name == name);
    let rows: Vec<&Finished> =
        long.iter().chain(["paper", "smooth", "smooth-124"].into_iter().filter_map(named)).collect();
    sheet.heading("Is the residue a line?");
    sheet.say(
        "All four sensors together (root of the sum of squares). The long runs have two quiet stretches of \
         4.3 ms, whose powers are averaged. \
         In `smooth-124` the line is predicted at 5172 Hz; what stands at 4671 Hz there is no line of the \
         mesh.",
    );
    sheet.runs("background", &rows, &RESIDUE);
    for run in rows {
        let find = |of: fn(&Noise) -> f64| together(run, None, of);
        let (Some(line), Some(low), Some(high)) =
            (find(|n| n.line_g), find(|n| n.background_range_g[0]), find(|n| n.background_range_g[1]))
        else {
            continue;
        };
        let verdict = if line > high { "a line above its neighbours" } else { "no more than its neighbours" };
        let [line, low, high] = [line, low, high].map(|g| number(g, 2));
        sheet.say(&format!("`{}`: {line} g between {low} and {high} g: {verdict}.", run.variant.name));
    }
}

/// Spectra and forces of the first and the last row of a table, and the paper's filter applied to the first.
fn pictures(sheet: &mut Sheet, id: &str, first: &Run, last: &Run) -> Result<()> {
    let (a, b) = (Record::whole(first)?, Record::whole(last)?);
    let prediction = Prediction::of(&first.scene, &first.info.mesh);
    let Some(line) = prediction.facet_lines.first() else { return Ok(()) };
    let notch = Filter::new(a.sample_rate_hz(), line.1)?;
    let sensor = &first.scene.written.output.sensors[0].name;
    let channel = format!("sensor.{sensor}.ay_m_s2");
    let (Some(raw), Some(cured)) = (a.channel(&channel), b.channel(&channel)) else { return Ok(()) };
    let filtered = notch.acceleration(raw)?;
    let hz: Vec<f64> = (0..400).map(|i| 50.0 * i as f64).collect();
    let spectrum = |signal: &[f64], record: &Record<'_>| {
        spectrum_g(&signal[quiet(record.time_s())], record.sample_rate_hz(), &hz)
    };
    let mut figure = Figure::new(
        &format!("{id}-spectra"),
        "Spectra between the impulses",
        Axis::si("Frequency", "Hz"),
        Axis::plain("Amplitude", "g"),
    );
    for (words, colour, values) in [
        (first.scene.written.name.as_str(), Colour::Grey, spectrum(raw, &a)),
        ("the same behind a notch", Colour::Orange, spectrum(&filtered, &a)),
        (last.scene.written.name.as_str(), Colour::Blue, spectrum(cured, &b)),
    ] {
        figure = figure.with(Series::sampled(words, colour, 0.0, 50.0, values));
    }
    sheet.picture(&figure.caption(format!(
        "a_y at {sensor}, 7.1 to 11.4 ms, Hann window: lines closer than 460 Hz merge. The notch rings \
             with a \
             time constant of Q/\u{3c0}f = 1 ms, also from the impulse at 5.1 ms: what stands at the line \
             behind it is partly its own."
    )))?;
    let mut figure = Figure::new(
        &format!("{id}-forces"),
        "Force of roller 2 on the outer ring",
        Axis::si("Time", "s"),
        Axis::plain("Force", "N"),
    );
    for (record, words, colour) in
        [(&a, &first.scene.written.name, Colour::Grey), (&b, &last.scene.written.name, Colour::Blue)]
    {
        let Some(roller) = record.roller(2) else { return Ok(()) };
        let from = record.time_s().first().copied().unwrap_or(0.0);
        figure =
            figure.with(Series::sampled(words, colour, from, record.interval_s(), roller.outer_normal()));
    }
    sheet.picture(&figure)
}

fn noise(run: &Finished, sensor: usize) -> Option<Noise> {
    noise_at(run, sensor, None)
}

/// About the line of the roller vertices, or about another frequency [Hz].
fn noise_at(run: &Finished, sensor: usize, hz: Option<f64>) -> Option<Noise> {
    let read = Run::read(&run.folder).ok()?;
    let prediction = Prediction::of(&read.scene, &read.info.mesh);
    let passages: Vec<(f64, f64)> = prediction.passages().iter().map(|p| (p.entry_s, p.exit_s)).collect();
    let name = read.scene.written.output.sensors.get(sensor)?.name.clone();
    let line = prediction.facet_lines.first()?.1;
    measure(&Record::whole(&read).ok()?, &name, &passages, hz.unwrap_or(line))
}

/// Amplitude at the seat of the line that the points of the facets make [g]; `None` when samples are too far
/// apart for it.
fn points_line_g(run: &Finished) -> Option<f64> {
    const SEAT: usize = 2;
    let read = Run::read(&run.folder).ok()?;
    let record = Record::whole(&read).ok()?;
    let line = Prediction::of(&read.scene, &read.info.mesh).facet_lines.first()?.1;
    let hz = line * read.scene.written.contact.points_per_facet as f64;
    let rate = record.sample_rate_hz();
    let name = &read.scene.written.output.sensors.get(SEAT)?.name;
    let span = quiet(record.time_s());
    let along = |axis: &str| {
        let signal = record.channel(&format!("sensor.{name}.{axis}_m_s2"))?;
        spectrum_g(&signal[span.clone()], rate, &[hz]).first().copied()
    };
    if hz < 0.5 * rate { Some(along("ax")?.hypot(along("ay")?)) } else { None }
}

/// Samples between two passages, where spectra are taken.
fn quiet(time_s: &[f64]) -> std::ops::Range<usize> {
    time_s.partition_point(|&t| t < 7.1e-3)..time_s.partition_point(|&t| t < 11.4e-3)
}

/// Root of the sum of squares over the sensors.
fn together(run: &Finished, hz: Option<f64>, of: impl Fn(&Noise) -> f64) -> Option<f64> {
    let all: Vec<Noise> = (0..4).map(|sensor| noise_at(run, sensor, hz)).collect::<Option<_>>()?;
    Some(all.iter().map(|n| of(n).powi(2)).sum::<f64>().sqrt())
}

/// Ripple of the most loaded roller's force while roller 1 is over the defect [%].
fn ripple_percent(run: &Finished) -> Option<f64> {
    let read = Run::read(&run.folder).ok()?;
    let record = Record::whole(&read).ok()?;
    let time = record.time_s();
    let at = |s: f64| time.partition_point(|&t| t < s);
    let span = at(converged::UNLOADED_S.start)..at(converged::UNLOADED_S.end);
    let forces = record.rollers().into_iter().map(|r| r.outer_normal()[span.clone()].to_vec());
    let mean = |f: &Vec<f64>| f.iter().sum::<f64>().abs();
    let most = forces.max_by(|a, b| mean(a).total_cmp(&mean(b)))?;
    force_ripple(&most).map(|r| 100.0 * r)
}

const LEVELS: [Column; 12] = [
    Column { name: "side line", decimals: 2, of: |r| noise(r, 0).map(|n| n.line_g) },
    Column { name: "background", decimals: 2, of: |r| noise(r, 0).map(|n| n.background_g) },
    Column { name: "between", decimals: 1, of: |r| noise(r, 0).map(|n| n.quiet_rms_g) },
    Column { name: "shoulder line", decimals: 2, of: |r| noise(r, 1).map(|n| n.line_g) },
    Column { name: "background", decimals: 2, of: |r| noise(r, 1).map(|n| n.background_g) },
    Column { name: "between", decimals: 1, of: |r| noise(r, 1).map(|n| n.quiet_rms_g) },
    Column { name: "seat line", decimals: 2, of: |r| noise(r, 2).map(|n| n.line_g) },
    Column { name: "background", decimals: 2, of: |r| noise(r, 2).map(|n| n.background_g) },
    Column { name: "between", decimals: 1, of: |r| noise(r, 2).map(|n| n.quiet_rms_g) },
    Column { name: "bottom line", decimals: 2, of: |r| noise(r, 3).map(|n| n.line_g) },
    Column { name: "background", decimals: 2, of: |r| noise(r, 3).map(|n| n.background_g) },
    Column { name: "between", decimals: 1, of: |r| noise(r, 3).map(|n| n.quiet_rms_g) },
];

const RESIDUE: [Column; 6] = [
    Column { name: "line g", decimals: 2, of: |r| together(r, None, |n| n.line_g) },
    Column { name: "background g", decimals: 2, of: |r| together(r, None, |n| n.background_g) },
    Column { name: "neighbours from g", decimals: 2, of: |r| together(r, None, |n| n.background_range_g[0]) },
    Column { name: "to g", decimals: 2, of: |r| together(r, None, |n| n.background_range_g[1]) },
    Column {
        name: "line over background dB",
        decimals: 1,
        of: |r| {
            let [line, background] =
                [together(r, None, |n| n.line_g)?, together(r, None, |n| n.background_g)?];
            Some(20.0 * (line / background).log10())
        },
    },
    Column { name: "at 4671 Hz g", decimals: 2, of: |r| together(r, Some(4671.0), |n| n.line_g) },
];

const EFFECTS: [Column; 8] = [
    Column { name: "second harmonic g", decimals: 2, of: |r| noise(r, 0).map(|n| n.second_g) },
    Column { name: "ringing g", decimals: 2, of: |r| noise(r, 0).map(|n| n.ringing_g) },
    Column { name: "points at the seat g", decimals: 2, of: points_line_g },
    Column { name: "start g", decimals: 1, of: |r| noise(r, 0).map(|n| n.start_g) },
    Column { name: "spall mm", decimals: 2, of: |r| r.numbers()?.events.first()?.spall_mm },
    Column { name: "ripple %", decimals: 3, of: ripple_percent },
    Column {
        name: "energy error %",
        decimals: 3,
        of: |r| r.info.as_ref().map(|i| 100.0 * i.energy.max_relative_error),
    },
    Column { name: "time step ns", decimals: 1, of: |r| r.info.as_ref().map(|i| 1e9 * i.time_step_s) },
];
