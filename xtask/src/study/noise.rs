//! `cargo xtask study noise`: where contact noise comes from and what each cure takes away.

use std::process::ExitCode;

use anyhow::Result;
use stribeck_analysis::filtering::Filter;
use stribeck_analysis::noise::{Noise, force_ripple, measure, spectrum_g};
use stribeck_analysis::plot::{Axis, Colour, Figure, Series};
use stribeck_analysis::prediction::Prediction;
use stribeck_analysis::record::Record;
use stribeck_bearing::run_dir::Run;

use super::{Column, Finished, Flags, Runner, Sheet, Variant};
use crate::workspace;

/// Flags of `study noise`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(flatten)]
    flags: Flags,
}

const LEAN: &str = "fixtures/scenes/lean.ron";
const UNIFORM: &str = "fixtures/scenes/singh2014.ron";
/// One exit and the quiet time until the next entry, no pictures.
const SHORT: [&str; 2] = ["solver.duration_ms=12.0", "output.frames=None"];
const ARC: &str = "contact.surface=arc";
const NAGATA: &str = "contact.surface=nagata";
const SPLINE: &str = "contact.interpolation=spline";
const POINTS: &str = "contact.points_per_facet=12";
const ONSET: &str = "contact.onset_um=3.0";
const STIFF: &str = "contact.penalty_scale=0.7";
/// A stiffer contact sinks in less.
const STIFF_ONSET: &str = "contact.onset_um=0.5";

/// Until the first impulse is over.
const IMPULSE: [&str; 2] = ["solver.duration_ms=6.6", "output.frames=None"];
/// Elements of half the size under the same contact: stiffness and damping over an area, and points over a length, stay.
const FINE: [&str; 6] = [
    "mesh.size_mm=0.25",
    "mesh.roller_facets=224",
    "mesh.grading.fine_layers=4",
    "contact.penalty_scale=0.025",
    "contact.damping_ratio=0.141421356",
    "contact.points_per_facet=6",
];
/// The first roller a little ahead or behind: the same bearing another ten microseconds before or after its impulse.
const STARTS: [(&str, &str); 3] = [("", "94.0"), ("-ahead", "93.99"), ("-behind", "94.01")];

/// The same bearing by the paper's method, cured, and converged, each from several starts.
fn converged() -> Vec<Variant> {
    let smooth = [ARC, SPLINE, POINTS, ONSET];
    let fine = [ARC, SPLINE, ONSET].into_iter().chain(FINE).collect::<Vec<_>>();
    let of = |name: &str, set: &[&str]| {
        STARTS.map(|(start, degrees)| {
            let variant = Variant::new(format!("{name}{start}"), LEAN, set);
            let variant = IMPULSE.iter().fold(variant, |variant, s| variant.with(*s));
            variant.with(format!("bearing.first_roller_deg={degrees}"))
        })
    };
    [of("chords", &[]), of("cured", &smooth), of("fine", &fine)].concat()
}

/// The ablation: the paper's method, then one step more in each row; then the same for a contact as stiff as elements.
fn variants() -> [Vec<Variant>; 3] {
    let of = |scene, list: &[(&str, &[&str])]| {
        let variant = |(name, set): &(&str, &[&str])| {
            SHORT.iter().fold(Variant::new(*name, scene, set), |variant, s| variant.with(*s))
        };
        list.iter().map(variant).collect()
    };
    [
        of(
            LEAN,
            &[
                ("collocated", &["contact.method=collocated"]),
                ("paper", &[]),
                ("arc", &[ARC]),
                ("arc-spline", &[ARC, SPLINE]),
                ("smooth", &[ARC, SPLINE, POINTS, ONSET]),
                ("nagata-smooth", &[NAGATA, SPLINE, POINTS, ONSET]),
            ],
        ),
        of(
            LEAN,
            &[
                ("stiff", &[STIFF]),
                ("stiff-arc", &[ARC, STIFF]),
                ("stiff-spline", &[ARC, STIFF, SPLINE]),
                ("stiff-smooth", &[ARC, STIFF, SPLINE, POINTS, STIFF_ONSET]),
            ],
        ),
        of(UNIFORM, &[("uniform-paper", &[]), ("uniform-smooth", &[ARC, SPLINE, POINTS, ONSET])]),
    ]
}

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let runner = Runner::new("noise", &options.flags)?;
    let mut sheet = Sheet::new("noise", "Contact noise: its causes, one by one");
    sheet.say(
        "Runs of 12 ms: roller 1 leaves the defect at 5.1 ms. *Line* is the amplitude of the roller vertices\u{2019} line at 4671 Hz and \
         *between* the root mean square, both of the acceleration vector between 7.1 and 11.4 ms, where no roller meets the \
         defect: 4.3 ms resolve 230 Hz, so the line holds the race nodes\u{2019} too. *Impulse* and its energy are of a_y within \
         1 ms of the exit. *Ripple* is the rms of the force on the most loaded roller about a cubic in time over its mean, 2.4 to 4.3 ms. \
         Cost is processor time of the whole run, set-up included, for one element and one step, on a machine that others used: \
         compare roughly.",
    );
    let [soft, stiff, uniform] = variants();
    let mut ends = Vec::new();
    for (table, title, list) in [
        ("soft", "The default scene\u{2019}s contact, graded mesh", soft),
        ("stiff", "A contact as stiff as elements (penalty scale 0.7), graded mesh", stiff),
        ("uniform", "The paper\u{2019}s uniform mesh of 0.5 mm", uniform),
    ] {
        let runs = runner.run(&list)?;
        sheet.heading(title);
        let rows: Vec<&Finished> = runs.iter().collect();
        sheet.say("Line [g] and level between the impulses [g] at each sensor:");
        sheet.runs(table, &rows, &LEVELS);
        sheet.say("Impulse at the leading sensor, forces and cost:");
        sheet.runs(&format!("{table}-effects"), &rows, &EFFECTS);
        ends.extend(runs);
    }
    let _ = runner.run(&converged())?;
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
    println!("{}", workspace::shown(&sheet.write()?));
    Ok(ExitCode::SUCCESS)
}

/// Spectra and forces of the first and the last row of a table, and the paper's filter applied to the first.
fn pictures(sheet: &mut Sheet, id: &str, first: &Run, last: &Run) -> Result<()> {
    let (a, b) = (Record::new(first), Record::new(last));
    let prediction = Prediction::of(&first.scene, &first.info.mesh);
    let Some(line) = prediction.facet_lines.first() else { return Ok(()) };
    let notch = Filter::new(a.sample_rate_hz(), line.1)?;
    let sensor = &first.scene.output.sensors[0].name;
    let channel = format!("sensor.{sensor}.ay_m_s2");
    let (Some(raw), Some(cured)) = (a.channel(&channel), b.channel(&channel)) else { return Ok(()) };
    let filtered = notch.acceleration(raw)?;
    let quiet = |time: &[f64]| time.partition_point(|&t| t < 7.1e-3)..time.partition_point(|&t| t < 11.4e-3);
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
        (first.scene.name.as_str(), Colour::Grey, spectrum(raw, &a)),
        ("the same behind a notch", Colour::Orange, spectrum(&filtered, &a)),
        (last.scene.name.as_str(), Colour::Blue, spectrum(cured, &b)),
    ] {
        figure = figure.with(Series::sampled(words, colour, 0.0, 50.0, values));
    }
    sheet.picture(
        &figure.caption(format!(
            "a_y at {sensor}, 7.1 to 11.4 ms, Hann window: lines closer than 460 Hz merge."
        )),
    )?;
    let mut figure = Figure::new(
        &format!("{id}-forces"),
        "Force of roller 2 on the outer ring",
        Axis::si("Time", "s"),
        Axis::plain("Force", "N"),
    );
    for (record, words, colour) in
        [(&a, &first.scene.name, Colour::Grey), (&b, &last.scene.name, Colour::Blue)]
    {
        let Some(roller) = record.roller(2) else { return Ok(()) };
        let from = record.time_s().first().copied().unwrap_or(0.0);
        figure =
            figure.with(Series::sampled(words, colour, from, record.interval_s(), roller.outer_normal()));
    }
    sheet.picture(&figure)
}

fn noise(run: &Finished, sensor: usize) -> Option<Noise> {
    let read = Run::read(&run.folder).ok()?;
    let prediction = Prediction::of(&read.scene, &read.info.mesh);
    let passages: Vec<(f64, f64)> = prediction.passages.iter().map(|p| (p.entry_s, p.exit_s)).collect();
    let name = read.scene.output.sensors.get(sensor)?.name.clone();
    measure(&Record::new(&read), &name, &passages, prediction.facet_lines.first()?.1)
}

/// Ripple of the most loaded roller's force while roller 1 is over the defect [%].
fn ripple_percent(run: &Finished) -> Option<f64> {
    let read = Run::read(&run.folder).ok()?;
    let record = Record::new(&read);
    let time = record.time_s();
    let span = time.partition_point(|&t| t < 2.4e-3)..time.partition_point(|&t| t < 4.3e-3);
    let forces = record.rollers().into_iter().map(|r| r.outer_normal()[span.clone()].to_vec());
    let mean = |f: &Vec<f64>| f.iter().sum::<f64>().abs();
    let most = forces.max_by(|a, b| mean(a).total_cmp(&mean(b)))?;
    force_ripple(&most).map(|r| 100.0 * r)
}

const LEVELS: [Column; 8] = [
    Column { name: "side line", decimals: 2, of: |r| noise(r, 0).map(|n| n.line_g) },
    Column { name: "between", decimals: 1, of: |r| noise(r, 0).map(|n| n.quiet_rms_g) },
    Column { name: "shoulder line", decimals: 2, of: |r| noise(r, 1).map(|n| n.line_g) },
    Column { name: "between", decimals: 1, of: |r| noise(r, 1).map(|n| n.quiet_rms_g) },
    Column { name: "seat line", decimals: 2, of: |r| noise(r, 2).map(|n| n.line_g) },
    Column { name: "between", decimals: 1, of: |r| noise(r, 2).map(|n| n.quiet_rms_g) },
    Column { name: "bottom line", decimals: 2, of: |r| noise(r, 3).map(|n| n.line_g) },
    Column { name: "between", decimals: 1, of: |r| noise(r, 3).map(|n| n.quiet_rms_g) },
];

const EFFECTS: [Column; 8] = [
    Column { name: "second harmonic g", decimals: 2, of: |r| noise(r, 0).map(|n| n.second_g) },
    Column { name: "impulse g", decimals: 0, of: |r| noise(r, 0).map(|n| n.impulse_g) },
    Column { name: "impulse g² ms", decimals: 0, of: |r| noise(r, 0).map(|n| n.impulse_g2_ms) },
    Column { name: "spall mm", decimals: 2, of: |r| r.numbers()?.events.first()?.spall_mm },
    Column { name: "ripple %", decimals: 3, of: ripple_percent },
    Column {
        name: "energy error %",
        decimals: 3,
        of: |r| r.info.as_ref().map(|i| 100.0 * i.energy.max_relative_error),
    },
    Column { name: "time step ns", decimals: 1, of: |r| r.info.as_ref().map(|i| 1e9 * i.time_step_s) },
    Column {
        name: "cpu ns",
        decimals: 1,
        of: |r| {
            let i = r.info.as_ref()?;
            Some(1e9 * i.cpu_s / i.steps as f64 / (i.mesh.quads + i.mesh.triangles) as f64)
        },
    },
];
