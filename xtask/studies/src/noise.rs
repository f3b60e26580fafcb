//! `cargo xtask study noise`: sources of contact noise, and the effect of each cure.

use anyhow::Result;
use stribeck_analysis::filtering::Filter;
use stribeck_analysis::noise::{Noise, force_ripple, measure as noise_of, spectrum_g};
use stribeck_analysis::prediction::Prediction;
use stribeck_analysis::record::Record;
use stribeck_report::plot::{Axis, Colour, Figure, Series};
use stribeck_store::run_dir::Run;

use crate::plan::Kernel;
use crate::{Finished, Plan, Rows, Runner, figure};

/// While roller 1 is over the defect and touches neither edge nor floor [s].
const UNLOADED_S: std::ops::Range<f64> = 2.4e-3..4.3e-3;
/// Between two passages, where spectra are taken [s].
const QUIET_S: std::ops::Range<f64> = 7.1e-3..11.4e-3;
/// Rollers that carry more than this are compared [N].
const CARRIES_N: f64 = 1000.0;
/// Frequency of the line with 112 facets [Hz], where no line of another number of facets stands.
const LINE_HZ: f64 = 4671.0;

const KERNELS: &[Kernel] = &[
    ("side_line_g", |r| noise(r, 0, None).map(|n| n.line_g)),
    ("side_background_g", |r| noise(r, 0, None).map(|n| n.background_g)),
    ("side_between_g", |r| noise(r, 0, None).map(|n| n.quiet_rms_g)),
    ("shoulder_line_g", |r| noise(r, 1, None).map(|n| n.line_g)),
    ("shoulder_background_g", |r| noise(r, 1, None).map(|n| n.background_g)),
    ("shoulder_between_g", |r| noise(r, 1, None).map(|n| n.quiet_rms_g)),
    ("seat_line_g", |r| noise(r, 2, None).map(|n| n.line_g)),
    ("seat_background_g", |r| noise(r, 2, None).map(|n| n.background_g)),
    ("seat_between_g", |r| noise(r, 2, None).map(|n| n.quiet_rms_g)),
    ("bottom_line_g", |r| noise(r, 3, None).map(|n| n.line_g)),
    ("bottom_background_g", |r| noise(r, 3, None).map(|n| n.background_g)),
    ("bottom_between_g", |r| noise(r, 3, None).map(|n| n.quiet_rms_g)),
    ("second_g", |r| noise(r, 0, None).map(|n| n.second_g)),
    ("ringing_g", |r| noise(r, 0, None).map(|n| n.ringing_g)),
    ("start_g", |r| noise(r, 0, None).map(|n| n.start_g)),
    ("points_line_g", points_line_g),
    ("ripple_percent", ripple_percent),
    ("line_g", |r| together(r, None, |n| n.line_g)),
    ("background_g", |r| together(r, None, |n| n.background_g)),
    ("neighbours_from_g", |r| together(r, None, |n| n.background_range_g[0])),
    ("neighbours_to_g", |r| together(r, None, |n| n.background_range_g[1])),
    ("over_background_db", |r| {
        let ratio = together(r, None, |n| n.line_g)? / together(r, None, |n| n.background_g)?;
        Some(20.0 * ratio.log10())
    }),
    ("at_4671_hz_g", |r| together(r, Some(LINE_HZ), |n| n.line_g)),
    ("force_2_n", |r| forces(r).get(1).copied()),
    ("force_24_n", |r| forces(r).get(23).copied()),
];

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<()> {
    let plan = Plan::read(runner.study)?;
    let groups = plan.run(runner, KERNELS, rows)?;
    let of_table = |table: &str| -> Vec<&Vec<Finished>> {
        plan.groups
            .iter()
            .zip(&groups)
            .filter(|(group, _)| group.table == table)
            .map(|(_, runs)| runs)
            .collect()
    };
    converged(rows, &of_table("converged"));
    let find =
        |name: &str| groups.iter().flatten().find(|r| r.variant.name == name).and_then(Finished::trace);
    for (id, first, last) in [
        ("soft", "paper", "smooth"),
        ("stiff", "stiff", "stiff-smooth"),
        ("uniform", "uniform-paper", "uniform-smooth"),
    ] {
        if let (Some(first), Some(last)) = (find(first), find(last)) {
            pictures(runner, id, &first, &last)?;
        }
    }
    Ok(())
}

/// How far the cure is off elements of half the size, and the forces of both and of chords off theirs.
fn converged(rows: &mut Rows, groups: &[&Vec<Finished>]) {
    let [chords, cured, fine] = groups else { return };
    let quantities: Vec<String> = rows.quantities("converged", "fine");
    for name in quantities.iter().filter_map(|q| q.strip_suffix(", mean")) {
        let mean = |group: &str| rows.number("converged", group, &format!("{name}, mean"));
        let off = mean("cured").zip(mean("fine")).map(|(cured, fine)| 100.0 * (cured / fine - 1.0));
        rows.value("converged", "cured", &format!("{name}, off fine %"), off);
    }
    let mean = |group: &[Finished]| -> Vec<f64> {
        let all: Vec<Vec<f64>> = group.iter().map(forces).filter(|f| !f.is_empty()).collect();
        let rollers = all.first().map_or(0, Vec::len);
        (0..rollers).map(|i| all.iter().map(|f| f[i]).sum::<f64>() / all.len() as f64).collect()
    };
    let reference = mean(fine);
    for (name, group) in [("chords", chords), ("cured", cured), ("fine", fine)] {
        let of = mean(group);
        let carrying = of.iter().zip(&reference).filter(|(_, b)| **b > CARRIES_N);
        let largest = carrying.map(|(a, b)| 100.0 * (a / b - 1.0).abs()).max_by(f64::total_cmp);
        rows.value("converged", name, "largest difference of a force %", largest);
    }
}

/// Spectra and forces of the first and the last row of a table, and the paper's filter applied to the first.
fn pictures(runner: &Runner<'_>, id: &str, first: &Run, last: &Run) -> Result<()> {
    let (a, b) = (Record::whole(first)?, Record::whole(last)?);
    let Some(line) = Prediction::of(&first.scene, &first.info.mesh).facet_lines.first().cloned() else {
        return Ok(());
    };
    let sensor = &first.scene.written.output.sensors[0].name;
    let channel = format!("sensor.{sensor}.ay_m_s2");
    let (Some(raw), Some(cured)) = (a.channel(&channel), b.channel(&channel)) else { return Ok(()) };
    let filtered = Filter::new(a.sample_rate_hz(), line.1)?.acceleration(raw)?;
    let hz: Vec<f64> = (0..400).map(|i| 50.0 * i as f64).collect();
    let spectrum = |signal: &[f64], record: &Record<'_>| {
        spectrum_g(&signal[within(record, &QUIET_S)], record.sample_rate_hz(), &hz)
    };
    let names = [first, last].map(|run| run.scene.written.name.as_str());
    let (x, y) = (Axis::si("Frequency", "Hz"), Axis::plain("Amplitude", "g"));
    let mut spectra = Figure::new(&format!("{id}-spectra"), "Spectra between the impulses", x, y);
    for (words, colour, values) in [
        (names[0], Colour::Grey, spectrum(raw, &a)),
        ("the same behind a notch", Colour::Orange, spectrum(&filtered, &a)),
        (names[1], Colour::Blue, spectrum(cured, &b)),
    ] {
        spectra = spectra.with(Series::sampled(words, colour, 0.0, 50.0, values));
    }
    figure::draw(runner.study, &spectra)?;
    let (x, y) = (Axis::si("Time", "s"), Axis::plain("Force", "N"));
    let mut force = Figure::new(&format!("{id}-forces"), "Force of roller 2 on the outer ring", x, y);
    for (record, words, colour) in [(&a, names[0], Colour::Grey), (&b, names[1], Colour::Blue)] {
        let Some(roller) = record.roller(2) else { return Ok(()) };
        let from = record.time_s().first().copied().unwrap_or(0.0);
        force = force.with(Series::sampled(words, colour, from, record.interval_s(), roller.outer_normal()));
    }
    figure::draw(runner.study, &force)
}

/// Samples of a span of time.
fn within(record: &Record<'_>, span: &std::ops::Range<f64>) -> std::ops::Range<usize> {
    let at = |s: f64| record.time_s().partition_point(|&t| t < s);
    at(span.start)..at(span.end)
}

/// About the line of the roller vertices, or about another frequency [Hz].
fn noise(run: &Finished, sensor: usize, hz: Option<f64>) -> Option<Noise> {
    let read = run.trace()?;
    let prediction = Prediction::of(&read.scene, &read.info.mesh);
    let passages: Vec<(f64, f64)> = prediction.passages().iter().map(|p| (p.entry_s, p.exit_s)).collect();
    let name = &run.written.output.sensors.get(sensor)?.name;
    let line = prediction.facet_lines.first()?.1;
    noise_of(&Record::whole(&read).ok()?, name, &passages, hz.unwrap_or(line))
}

/// Root of the sum of squares over the sensors.
fn together(run: &Finished, hz: Option<f64>, of: impl Fn(&Noise) -> f64) -> Option<f64> {
    let all: Vec<Noise> = (0..4).map(|sensor| noise(run, sensor, hz)).collect::<Option<_>>()?;
    Some(all.iter().map(|n| of(n).powi(2)).sum::<f64>().sqrt())
}

/// Amplitude at the seat of the line that the points of the facets make [g]; `None` when samples are too far
/// apart for it.
fn points_line_g(run: &Finished) -> Option<f64> {
    const SEAT: usize = 2;
    let read = run.trace()?;
    let record = Record::whole(&read).ok()?;
    let line = Prediction::of(&read.scene, &read.info.mesh).facet_lines.first()?.1;
    let hz = line * run.written.contact.points_per_facet as f64;
    let rate = record.sample_rate_hz();
    let name = &run.written.output.sensors.get(SEAT)?.name;
    let along = |axis: &str| {
        let signal = record.channel(&format!("sensor.{name}.{axis}_m_s2"))?;
        spectrum_g(&signal[within(&record, &QUIET_S)], rate, &[hz]).first().copied()
    };
    if hz < 0.5 * rate { Some(along("ax")?.hypot(along("ay")?)) } else { None }
}

/// Ripple of the most loaded roller's force while roller 1 is over the defect [%].
fn ripple_percent(run: &Finished) -> Option<f64> {
    let read = run.trace()?;
    let record = Record::whole(&read).ok()?;
    let span = within(&record, &UNLOADED_S);
    let forces = record.rollers().into_iter().map(|r| r.outer_normal()[span.clone()].to_vec());
    let mean = |f: &Vec<f64>| f.iter().sum::<f64>().abs();
    let most = forces.max_by(|a, b| mean(a).total_cmp(&mean(b)))?;
    force_ripple(&most).map(|r| 100.0 * r)
}

/// Mean of each roller's force on the outer ring while roller 1 is over the defect [N].
fn forces(run: &Finished) -> Vec<f64> {
    let Some(read) = run.trace() else { return Vec::new() };
    let Ok(record) = Record::whole(&read) else { return Vec::new() };
    let span = within(&record, &UNLOADED_S);
    let mean = |force: Vec<f64>| force[span.clone()].iter().sum::<f64>() / span.len() as f64;
    record.rollers().into_iter().map(|r| mean(r.outer_normal())).collect()
}
