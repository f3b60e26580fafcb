//! Contact forces over time (the paper's Fig. 8), and their sum against the load.

use super::{mark, sampled, transient};
use crate::plot::{Axis, Colour, Figure, Level, Series};
use stribeck_analysis::findings::{CrossingForce, Findings};
use stribeck_analysis::record::Record;
use stribeck_analysis::summary::Event;

/// Rollers whose force is drawn: the paper's three. All others are in the table.
pub(crate) const DRAWN: usize = 3;

/// Largest relative increase that is shown: beyond it the force before was next to nothing.
const MOST_GAIN: f64 = 10.0;

/// A record of more roller spacings is drawn about each passage only.
const LONG_SPACINGS: f64 = 6.0;

/// Force of the raceway on each roller that crosses its spall.
pub(in super::super) fn crossings(findings: &Findings) -> Vec<Figure> {
    let crossings = findings.crossings.iter().zip(&findings.summary.events);
    crossings.enumerate().map(|(at, (crossing, event))| force(findings, crossing, event, at)).collect()
}

fn force(findings: &Findings, crossing: &CrossingForce, event: &Event, at: usize) -> Figure {
    let direction = if crossing.vertical { "Vertical force" } else { "Normal force" };
    let force = Axis::si(&format!("{direction}, compression positive"), "N");
    let raceway = event.ring.name();
    let title =
        format!("{}{} raceway on roller {}", raceway[..1].to_uppercase(), &raceway[1..], crossing.roller);
    let mut figure = Figure::new(&format!("force-{}", at + 1), &title, Axis::si("Time", "s"), force)
        .synced("time")
        .tabbed("forces", format!("Roller {}", crossing.roller))
        .with(sampled(findings, "raw", Colour::Grey, &crossing.raw_n));
    if !crossing.filtered_n.is_empty() {
        figure = figure.with(sampled(findings, "notched", Colour::Blue, &crossing.filtered_n));
    }
    figure.bands = transient(findings);
    // A long record shows the passage, not the whole turn.
    let spacing_s = 1.0 / findings.prediction.kinematics.bpfo_hz;
    let end_s = findings.start_s + crossing.raw_n.len() as f64 * findings.interval_s;
    if end_s > LONG_SPACINGS * spacing_s {
        let middle_s = 0.5e-3 * (event.expected_entry_ms + event.expected_exit_ms);
        let from = (middle_s - 1.5 * spacing_s).max(findings.start_s);
        figure.x = figure.x.over(from, from + 3.0 * spacing_s);
        // A figure of its own span shares no cursor with the others.
        figure.sync = None;
    }
    for (ms, label) in [(event.expected_entry_ms, "leading edge"), (event.expected_exit_ms, "trailing edge")]
    {
        figure.marks.push(mark(1e-3 * ms, label, Colour::Orange, true));
    }
    let events = [
        (event.entry_ms, "#1 unloads"),
        (event.floor_ms, "#2 strikes the floor"),
        (event.compensation_ms, "#3 carries for a neighbour"),
        (event.exit_ms, "#4 loaded again"),
    ];
    for (ms, label) in events {
        if let Some(ms) = ms {
            figure.marks.push(mark(1e-3 * ms, label, Colour::Green, false));
        }
    }
    let time = |ms: Option<f64>| ms.map_or("not at all".into(), |t| format!("at {t:.2} ms"));
    let touch = event.floor_ms.zip(event.floor_n).zip(event.floor_by);
    let floor = touch.map_or("does not touch the floor (#2)".into(), |((t, n), by)| {
        format!("strikes the floor at {t:.2} ms with {n:.0} N {} (#2)", by.in_words())
    });
    let help = event.compensation_gain.zip(event.compensation_n).map_or(String::new(), |(gain, force_n)| {
        // A share of a force that is next to nothing has no meaning.
        let more = if gain < MOST_GAIN {
            format!("{:.0} % more", 100.0 * (gain - 1.0))
        } else {
            format!("{force_n:.0} N, and next to nothing before")
        };
        format!(" While a neighbour is in the defect it carries {more} (#3).")
    });
    figure
        .caption(format!(
            "The roller unloads {} (#1), {floor} and is loaded again {} (#4).{help}",
            time(event.entry_ms),
            time(event.exit_ms)
        ))
        .note(
            "Events follow the rule of THEORY §7.4; edges are drawn where the roller's centre passes them \
            without slip.",
        )
}

/// Sum of the forces on all rollers [N], sample by sample.
pub(super) fn sums(record: &Record<'_>, findings: &Findings) -> Option<Figure> {
    let sum = &findings.support_n;
    if sum.is_empty() {
        return None;
    }
    let supported = findings.summary.load.expected_n;
    let off = |n: f64| 100.0 * (n / supported - 1.0);
    let count = sum.len() as f64;
    let mean = sum.iter().sum::<f64>() / count;
    let rms = (sum.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / count).sqrt();
    let (low, high) = sum.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &s| (l.min(s), h.max(s)));
    let time = record.time_s();
    let mut figure = Figure::new(
        "load-sum",
        "What all rollers carry together",
        Axis::si("Time", "s"),
        Axis::si("Sum of the forces along the load", "N"),
    )
    .synced("time")
    .with(Series::sampled("sum, each sample", Colour::Blue, time[0], record.interval_s(), sum.clone()))
    .caption(format!(
        "On average the rollers carry load and weight to {:+.3} %; from sample to sample the sum swings by \
         {:.1} % (RMS), between {:+.0} and {:+.0} %, because {}ring and housing have mass.",
        off(mean),
        100.0 * rms / supported,
        off(low),
        off(high),
        if record.run().scene.written.operation.load_varies() { "the load changes and " } else { "" }
    ).replace('-', "−"))
    .note("The difference accelerates the outer ring and its housing. Load plus their weight is the dashed \
        line.");
    figure.levels = vec![Level { y: supported, label: "load and weight".into(), colour: Colour::Orange }];
    Some(figure)
}
