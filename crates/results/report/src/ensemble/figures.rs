//! Charts of an ensemble: one start over the range of all.

use super::strips;
use crate::plot::{Axis, Colour, Figure, Level, Mark, Series};
use crate::run::paper::PaperCase;
use crate::run::spectrum::about_the_tone;
use stribeck_analysis::ensemble::{EnsembleFindings, Merged};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::paper;
use stribeck_analysis::statistic::band;
use stribeck_analysis::summary::Event;

/// How far below its highest value a spectrum is drawn [dB].
const DEPTH_DB: f64 = 120.0;
/// Most rollers whose forces are drawn.
const ROLLERS: usize = 3;
/// Time before the entry and after the exit that is drawn of a force [s].
const AROUND_S: f64 = 1e-3;

/// The paper beside all complete starts, of which the typical one is drawn.
pub(super) fn paper_case(findings: &EnsembleFindings) -> Option<PaperCase<'_>> {
    let (number, drawn) = typical(findings)?;
    let starts = findings.complete.iter().map(|(_, start)| start).collect();
    PaperCase::of_starts(&findings.scene.written, starts, (*number, drawn))
}

/// Mean of curves, point by point.
fn mean(curves: &[&[f64]]) -> Vec<f64> {
    let length = curves.iter().map(|curve| curve.len()).min().unwrap_or(0);
    (0..length).map(|n| curves.iter().map(|curve| curve[n]).sum::<f64>() / curves.len() as f64).collect()
}

/// The start whose peak at exits is the median: neither the tamest nor the wildest.
fn typical(findings: &EnsembleFindings) -> Option<&(usize, Findings)> {
    let level = |f: &Findings| {
        let phases = &f.summary.levels.phases;
        phases.exit_g.or(phases.gap_g).unwrap_or(0.0)
    };
    let mut all: Vec<&(usize, Findings)> = findings.complete.iter().collect();
    all.sort_by(|a, b| level(&a.1).total_cmp(&level(&b.1)));
    all.get(all.len().saturating_sub(1) / 2).copied()
}

/// One start in front of the band of all.
pub(super) fn acceleration(findings: &EnsembleFindings) -> Option<Figure> {
    let (number, start) = typical(findings)?;
    let leading = start.sensors.first().filter(|s| !s.raw_g.is_empty())?;
    let curves: Vec<&[f64]> =
        findings.complete.iter().filter_map(|(_, f)| f.sensors.first()).map(|s| s.raw_g.as_slice()).collect();
    let [low, high] = band(&curves);
    let sampled = |name: &str, colour, values: Vec<f64>| {
        Series::sampled(name, colour, start.start_s, start.interval_s, values)
    };
    let title = format!("Acceleration a_y at sensor “{}”", leading.name);
    let mut figure = Figure::new("acceleration", &title, Axis::si("Time", "s"), Axis::plain("a_y", "g"))
        .with(sampled("90 % of starts below", Colour::Orange, high).as_edge())
        .with(sampled("10 % of starts below", Colour::Orange, low).as_edge())
        .with(sampled(&format!("start {number}"), Colour::Blue, leading.raw_g.clone()))
        .caption(format!(
            "Start {number}, whose peak at exits is the median, in front of what 80 % of the starts do at \
             the same time."
        ))
        .note(
            "Upright: mean entries (orange) and exits (green) by the contact forces. Start angles move them \
             by up to a facet. A single start leaves the band wherever it strikes at its own moment.",
        );
    figure.marks = passages(findings);
    if start.of_paper {
        let line = |y: f64, label: String| Level { y, label, colour: Colour::Red };
        figure.levels = [(paper::IMPULSE_G, "impulses"), (paper::BETWEEN_G, "between")]
            .iter()
            .flat_map(|&(g, what)| [line(g, format!("paper, {what}: ± {g:.0} g")), line(-g, String::new())])
            .collect();
    }
    Some(figure)
}

/// Mean times of entries and exits.
fn passages(findings: &EnsembleFindings) -> Vec<Mark> {
    let Some((_, first)) = findings.complete.first() else { return Vec::new() };
    let mut marks = Vec::new();
    for event in first.summary.first_passages().into_iter().take(2 * ROLLERS) {
        let roller = event.roller.to_string();
        let mut add = |what: &str, colour, of: fn(&Event) -> Option<f64>| {
            let time = findings.over_events(&roller, of);
            marks.extend(time.map(|t| Mark::new(1e-3 * t.mean, format!("{what} {roller}"), colour, false)));
        };
        add("entry", Colour::Orange, |e| e.entry_ms);
        add("exit", Colour::Green, |e| e.exit_ms);
    }
    marks
}

/// Mean power and band of the leading sensor, whole and about the tone; means of all sensors.
pub(super) fn spectra(findings: &EnsembleFindings) -> Vec<Figure> {
    let Some((_, first)) = findings.complete.first() else { return Vec::new() };
    let Some(density) = first.sensors.first().and_then(|s| s.raw_density.as_ref()) else { return Vec::new() };
    let (half, grid) = (0.5 * density.sample_rate_hz(), density.resolution().grid_hz);
    let decibels = |power: Vec<f64>| -> Vec<f64> {
        let decibels: Vec<f64> = power.iter().map(|p| 10.0 * p.log10()).collect();
        let highest = decibels.iter().copied().filter(|d| d.is_finite()).fold(f64::NEG_INFINITY, f64::max);
        decibels.iter().map(|d| d.max(highest - DEPTH_DB)).collect()
    };
    let series =
        |name: &str, colour, power: Vec<f64>| Series::sampled(name, colour, 0.0, grid, decibels(power));
    let powers = |of: usize| -> Vec<&[f64]> {
        let starts = findings.complete.iter();
        starts.filter_map(|(_, f)| Some(f.sensors.get(of)?.raw_density.as_ref()?.values())).collect()
    };
    let leading = powers(0);
    let over = |id: &str, title: &str, (from, to): (f64, f64)| {
        let unit = Axis::plain("Power spectral density", "dB re 1 g²/Hz");
        Figure::new(id, title, Axis::si("Frequency", "Hz").over(from, to), unit).note(format!(
            "Each start by itself, Welch: {}. The mean is that of the powers.",
            density.resolution()
        ))
    };
    let banded = |figure: Figure| {
        let [low, high] = band(&leading);
        figure
            .with(series("90 % of starts below", Colour::Orange, high).as_edge())
            .with(series("10 % of starts below", Colour::Orange, low).as_edge())
            .with(series("mean", Colour::Blue, mean(&leading)))
    };
    let sensor = &first.sensors[0].name;
    let marks = families(findings, first);
    let title =
        format!("Power spectral density of a_y at sensor “{sensor}”, mean of {} starts", leading.len());
    let mut whole = banded(over("spectrum", &title, (0.0, half))).caption(
        "Lines that stand in the mean repeat from start to start; the band says how much a single \
            start differs.",
    );
    let zoom = about_the_tone(findings.summary.number("notch.centre_hz").map(|s| s.median), &marks, half);
    let title = format!("The same, {:.0} to {:.0} Hz", zoom.0, zoom.1);
    let mut close = banded(over("spectrum-zoom", &title, zoom)).caption(
        "Upright: carriers of families of facet lines, full where most starts hold them, dashed \
            where they belong otherwise.",
    );
    (whole.marks, close.marks) = (marks.clone(), marks.clone());
    let mut figures = vec![whole, close];
    if first.sensors.len() > 1 {
        let colours =
            [Colour::Blue, Colour::Orange, Colour::Green, Colour::Purple, Colour::Red, Colour::Teal];
        let mut all = over("spectrum-sensors", "All sensors, means", zoom)
            .caption("What repeats at every sensor is the bearing's; what differs is the place.");
        for (n, (sensor, colour)) in first.sensors.iter().zip(colours.into_iter().cycle()).enumerate() {
            all = all.with(series(&sensor.name, colour, mean(&powers(n))));
        }
        all.marks = marks;
        figures.push(all);
    }
    figures
}

/// Carriers of the families: fitted where most starts hold them, by the motion where most do not; where the
/// records are too short to judge, by geometry.
fn families(findings: &EnsembleFindings, first: &Findings) -> Vec<Mark> {
    let items = findings.summary.ensemble.items("families");
    let colours = [Colour::Green, Colour::Purple, Colour::Teal];
    let carrier = |((family, (name, geometry_hz)), colour): ((&Merged, &(String, f64)), Colour)| {
        let name = name.replace('_', " ");
        let found = family.number("carrier_hz").filter(|s| 2 * s.count > s.of);
        let by_motion = family.number("predicted_hz").filter(|_| family.number("lead").is_some());
        let (hz, word) = match (found, by_motion) {
            (Some(s), _) => (s.mean, format!("{:.0} Hz", s.mean)),
            (None, Some(s)) => (s.mean, "absent".to_owned()),
            (None, None) => (*geometry_hz, "by geometry".to_owned()),
        };
        Mark::new(hz, format!("{name} {word}"), colour, found.is_none())
    };
    items.iter().zip(&first.prediction.facet_lines).zip(colours.into_iter().cycle()).map(carrier).collect()
}

/// Force of the raceway on each of the first rollers, from before its entry to after its exit.
pub(super) fn forces(findings: &EnsembleFindings) -> Vec<Figure> {
    let Some((_, first)) = findings.complete.first() else { return Vec::new() };
    let passages = first.summary.first_passages().into_iter().take(ROLLERS);
    passages.map(|e| e.roller).filter_map(|roller| force(findings, first, roller)).collect()
}

fn force(findings: &EnsembleFindings, first: &Findings, roller: usize) -> Option<Figure> {
    let event = |f: &Findings| f.summary.first_passages().into_iter().find(|e| e.roller == roller).cloned();
    let traverse_s = event(first).map(|e| 1e-3 * (e.expected_exit_ms - e.expected_entry_ms))?;
    let step = first.interval_s;
    let from = -AROUND_S.min(1e-3 * event(first)?.expected_entry_ms - first.start_s);
    let samples = ((traverse_s + AROUND_S - from) / step) as usize;
    // Every start on a clock of its own, which is zero at its entry without slip.
    let shifted = |f: &Findings| -> Option<Vec<f64>> {
        let entry_s = 1e-3 * event(f)?.expected_entry_ms;
        let raw = &f.crossings.iter().find(|c| c.roller == roller && c.spall == 1)?.raw_n;
        let at = |n: usize| {
            let place = (from + step * n as f64 + entry_s - f.start_s) / f.interval_s;
            let below = place.floor();
            let value =
                |n: f64| if n < 0.0 { f64::NAN } else { raw.get(n as usize).copied().unwrap_or(f64::NAN) };
            value(below) + (place - below) * (value(below + 1.0) - value(below))
        };
        Some((0..samples).map(at).collect())
    };
    let curves: Vec<Vec<f64>> = findings.complete.iter().filter_map(|(_, f)| shifted(f)).collect();
    let curves: Vec<&[f64]> = curves.iter().map(Vec::as_slice).collect();
    let [low, high] = band(&curves);
    let series = |name: &str, colour, values| Series::sampled(name, colour, from, step, values);
    let time = Axis::si("Time after the entry without slip", "s");
    let mut figure = Figure::new(
        &format!("force-{roller}"),
        &format!("Force of the {} raceway on roller {roller}", event(first)?.ring.name()),
        time,
        Axis::si("Force", "N"),
    )
    .with(series("90 % of starts below", Colour::Orange, high).as_edge())
    .with(series("10 % of starts below", Colour::Orange, low).as_edge())
    .with(series("mean", Colour::Blue, mean(&curves)))
    .caption(strips::story(findings, roller))
    .note("Upright: the centre over the edges of the defect without slip.");
    figure.marks = vec![
        Mark::new(0.0, "leading edge", Colour::Orange, true),
        Mark::new(traverse_s, "trailing edge", Colour::Green, true),
    ];
    Some(figure)
}
