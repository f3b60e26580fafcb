//! `cargo xtask study long`: the bearing for 0.35 s, the first spectrum of this model that resolves 3 Hz, and
//! the defect's family in an envelope spectrum.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use stribeck_analysis::artefacts::Origin;
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_analysis::signal::density_of_start;
use stribeck_analysis::summary::{Event, Summary};
use stribeck_report::plot::{Axis, Colour, Figure, Mark, Series};
use stribeck_store::run_dir::Run;

use crate::{Flags, Host, Rows, Runner, Variant, figure};

const SCENE: &str = "fixtures/scenes/long.ron";
/// The paper's record [s] and its grid [Hz].
const PAPER_RECORD_S: f64 = 0.03;
const GRID_HZ: f64 = 3.0;
/// Half the range of the picture of the facet lines [Hz].
const ABOUT_HZ: f64 = 250.0;
/// Upper end of the pictures of the defect's family [Hz].
const FAMILY_TOP_HZ: f64 = 1000.0;
/// Above this a length estimate belongs to another event [mm].
const ODD_SPALL_MM: f64 = 15.0;

/// Flags of `study long`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
    /// Makes the page from this finished run instead: a folder, or a name below runs/
    #[arg(long, value_name = "DIR")]
    run: Option<PathBuf>,
}

pub(crate) fn measure(options: &Options, host: &Host, rows: &mut Rows) -> Result<()> {
    let folder = match &options.run {
        Some(run) if run.exists() => run.clone(),
        Some(name) => host.root().join("runs").join(name),
        None => {
            let runs = Runner::new("long", &options.flags, host).run(&[Variant::new("long", SCENE, &[])])?;
            let Some(finished) = runs.into_iter().next() else {
                bail!(
                    "`{SCENE}` has not been run: leave out `--tables-only`, or name a finished run with \
                     `--run DIR`"
                );
            };
            if let Err(why) = &finished.summary {
                bail!("`{SCENE}` yields no numbers: {why}");
            }
            finished.folder
        }
    };
    let run = Run::read(&folder).with_context(|| format!("cannot read the run in {}", folder.display()))?;
    let findings = Findings::of(&Record::new(&run)?)?;
    cost(rows, &run, &findings.summary);
    lines(rows, &findings);
    passages(rows, &findings.summary);
    pictures(&findings)
}

fn cost(rows: &mut Rows, run: &Run, summary: &Summary) {
    let (info, cost) = (&run.info, &summary.run);
    let gained = |column: &str| {
        let values = run.energy.channel(column).ok()??;
        Some(values.last()? - values.first()?)
    };
    let supplied = gained("external_j").zip(gained("drive_j")).map(|(load, drive)| load + drive);
    let values = [
        ("elements", Some((info.mesh.quads + info.mesh.triangles) as f64)),
        ("steps", Some(info.steps as f64)),
        ("time step ns", Some(cost.time_step_ns)),
        ("simulated ms", Some(cost.simulated_ms)),
        ("threads", Some(info.threads as f64)),
        ("wall s", Some(info.wall_s)),
        ("setup s", Some(info.setup_s)),
        ("cpu s", Some(info.cpu_s)),
        ("energy error", Some(summary.energy.max_relative_error)),
        ("peak strain energy J", Some(summary.energy.peak_strain_j)),
        ("supplied J", supplied),
    ];
    rows.values("cost", &summary.scene, values);
    for (n, warning) in info.warnings.iter().enumerate() {
        rows.word("warnings", &(n + 1).to_string(), "warning", &warning.to_string());
    }
}

/// Resolution, lines at the leading sensor, fundamentals at every sensor, and the defect's family in the
/// envelope.
fn lines(rows: &mut Rows, findings: &Findings) {
    let summary = &findings.summary;
    if let Some(spectrum) = findings.sensors.first().and_then(|s| s.raw_density.as_ref()) {
        let resolution = spectrum.resolution();
        let values = [("resolution Hz", resolution.resolution_hz), ("grid Hz", resolution.grid_hz)];
        rows.values("resolution", &summary.scene, values);
    }
    for a in &summary.artefacts {
        let name = format!("{} ×{}", a.name, a.harmonic);
        let values = [
            ("predicted Hz", Some(a.predicted_hz)),
            ("by motion Hz", a.from_motion_hz),
            ("measured Hz", a.measured_hz),
            ("g", a.level_g),
        ];
        rows.values("lines", &name, values);
        let origin = match a.family {
            Origin::Mesh | Origin::Beat => "mesh",
            Origin::Defect => "defect",
            Origin::Ring => "ring",
        };
        rows.word("lines", &name, "origin", origin);
        rows.word("lines", &name, "verdict", &a.verdict);
    }
    for t in summary.tones.iter().filter(|t| t.harmonic == 1) {
        let values =
            [("measured Hz", t.measured_hz), ("g", t.level_g), ("above surroundings dB", t.prominence_db)];
        let name = format!("{}, {}", t.sensor, t.name);
        rows.values("fundamentals", &name, values);
        rows.word("fundamentals", &name, "merged with", &t.unresolved_from.join(", "));
    }
    let Some(finding) = &summary.envelope else { return };
    let values = [
        ("from Hz", Some(finding.band_hz.0)),
        ("to Hz", Some(finding.band_hz.1)),
        ("resolution Hz", Some(finding.resolution_hz)),
        ("periods", Some(finding.periods)),
        ("BPFO without slip Hz", Some(summary.kinematics.expected_bpfo_hz)),
        ("BPFO by the cage Hz", summary.kinematics.bpfo_hz),
    ];
    rows.values("envelope", "all", values);
    for l in &finding.lines {
        let values = [
            ("predicted Hz", Some(l.predicted_hz)),
            ("measured Hz", l.measured_hz),
            ("above background dB", l.prominence_db),
        ];
        rows.values("envelope", &format!("BPFO ×{}", l.harmonic), values);
    }
}

/// Every passage over the defect, in mean and spread.
fn passages(rows: &mut Rows, summary: &Summary) {
    let of = |value: fn(&Event) -> Option<f64>| summary.events.iter().filter_map(value).collect::<Vec<f64>>();
    for (name, values) in [
        ("impulse g", of(|e| e.impulse_g)),
        ("spall mm", of(|e| e.spall_mm.filter(|s| *s < ODD_SPALL_MM))),
        ("exit picked after the centre has passed the edge, ms", of(|e| Some(e.exit_ms? - e.path_exit_ms?))),
        ("exit picked after the exit without slip, ms", of(|e| Some(e.exit_ms? - e.expected_exit_ms))),
    ] {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let spread = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt();
        let end = |end: fn(f64, f64) -> f64| values.iter().copied().reduce(end).unwrap_or(f64::NAN);
        let [least, most] = [end(f64::min), end(f64::max)];
        let words = ["passages", "mean", "standard deviation", "least", "most"];
        rows.values("passages", name, words.into_iter().zip([n, mean, spread, least, most]));
    }
}

/// The leading sensor's spectrum, whole, about the facet lines and at low frequencies, beside that of its
/// first 30 ms; and its envelope spectrum.
fn pictures(findings: &Findings) -> Result<()> {
    let Some(leading) = findings.sensors.first() else { return Ok(()) };
    let Some(long) = &leading.raw_density else { return Ok(()) };
    let draw = |figure: &Figure| figure::draw("long", figure);
    let rate = long.sample_rate_hz();
    let short = density_of_start(&leading.raw_g, rate, PAPER_RECORD_S, GRID_HZ)?;
    let figure = |id: &str, title: &str, range: (f64, f64), with_short: bool| {
        let mut figure = over(id, title, range, "Power spectral density", "dB re 1 g²/Hz");
        if let Some(short) = short.as_ref().filter(|_| with_short) {
            let points = (short.frequencies_hz(), short.values());
            figure = figure.with(curve("first 30 ms, zero-padded to 3 Hz", Colour::Grey, points, range));
        }
        figure.with(curve("whole record", Colour::Blue, (long.frequencies_hz(), long.values()), range))
    };
    let mut whole = figure("spectrum", "Spectrum of the whole record", (0.0, 0.5 * rate), false);
    let of_rollers = findings.lines.iter().filter(|l| l.name == "roller_vertices");
    let vertex = |harmonic: &str, hz| mark(hz, &format!("×{harmonic}"), Colour::Green, true);
    whole.marks = of_rollers.map(|l| vertex(&l.harmonic.to_string(), l.predicted_hz)).collect();
    draw(&whole)?;

    let lines = &findings.prediction.facet_lines;
    let lowest = lines.iter().map(|l| l.1).fold(0.5 * rate, f64::min);
    let highest = lines.iter().map(|l| l.1).fold(0.0, f64::max);
    let range = ((lowest - ABOUT_HZ).max(0.0), highest + ABOUT_HZ);
    let mut zoom = figure("lines", "The facet lines, resolved", range, true);
    for ((name, hz), colour) in lines.iter().zip([Colour::Green, Colour::Purple, Colour::Teal]) {
        zoom.marks.push(mark(*hz, &name.replace('_', " "), colour, true));
        if let Some(ratio) = findings.summary.kinematics.ratio(name) {
            zoom.marks.push(mark(ratio * hz, "", colour, false));
        }
    }
    draw(&zoom)?;

    let range = (0.0, FAMILY_TOP_HZ);
    let mut low = figure("low", "Low frequencies", range, true);
    low.marks = family(findings);
    let modes = findings.modes.iter().filter(|m| m.1 < FAMILY_TOP_HZ);
    low.marks.extend(modes.map(|(n, hz)| mark(*hz, &format!("ring n = {n}"), Colour::Brown, true)));
    draw(&low)?;

    let Some(spectrum) = &findings.envelope else { return Ok(()) };
    let points = (spectrum.frequencies_hz(), spectrum.values());
    let mut envelope = over("envelope", "Squared envelope spectrum", range, "Squared envelope", "dB re 1 g⁴")
        .with(curve("squared envelope", Colour::Blue, points, range));
    envelope.marks = family(findings);
    draw(&envelope)
}

fn over(id: &str, title: &str, (from, to): (f64, f64), quantity: &str, unit: &str) -> Figure {
    Figure::new(id, title, Axis::si("Frequency", "Hz").over(from, to), Axis::plain(quantity, unit))
}

/// The part of a spectrum, frequencies [Hz] and powers, that lies in a range, in decibels.
fn curve(name: &str, colour: Colour, (hz, power): (&[f64], &[f64]), (from, to): (f64, f64)) -> Series {
    // The mean is taken out of every segment: zero frequency would be a pit of rounding.
    let points = hz.iter().zip(power).skip(1).filter(|p| (from..=to).contains(p.0));
    let (x, y): (Vec<f64>, Vec<f64>) = points.map(|(hz, p)| (*hz, 10.0 * p.log10())).unzip();
    Series::listed(name, colour, x, y)
}

fn mark(x: f64, label: &str, colour: Colour, dashed: bool) -> Mark {
    Mark { x, label: label.to_owned(), colour, dashed }
}

/// BPFO and its multiples.
fn family(findings: &Findings) -> Vec<Mark> {
    let bpfo = findings.prediction.kinematics.bpfo_hz;
    if findings.prediction.standing().is_none() || bpfo <= 0.0 {
        return Vec::new();
    }
    let multiples = (1..).take_while(|n| f64::from(*n) * bpfo < FAMILY_TOP_HZ);
    let label = |n: i32| if n == 1 { format!("BPFO {bpfo:.1} Hz") } else { format!("×{n}") };
    multiples.map(|n| mark(f64::from(n) * bpfo, &label(n), Colour::Red, true)).collect()
}
