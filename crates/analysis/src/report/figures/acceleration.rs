//! Acceleration over time: the paper's Figs. 2 and 6, the other sensors, the instantaneous one.

use super::{mark, sampled, transient};
use crate::findings::{Findings, SensorSignal};
use crate::paper;
use crate::plot::{Axis, Colour, Figure, Level, Mark};
use crate::summary::Event;

/// Most exits that are named in full.
const NAMED: usize = 6;

/// Fig. 2: as recorded.
pub(super) fn raw(findings: &Findings) -> Option<Figure> {
    let leading = findings.sensors.first().filter(|s| !s.raw_g.is_empty())?;
    let levels = &findings.summary.levels;
    let title = format!("Fig. 2: acceleration a_y at sensor “{}”, unfiltered", leading.name);
    let mut figure = over_time("acceleration", &title)
        .with(sampled(findings, "mean over each interval", Colour::Blue, &leading.raw_g))
        .caption(format!(
            "Each roller that leaves the defect gives an impulse ({} here, ± 180 g in the paper); between them the noise \
             reaches {} (± 50 g in the paper).",
            gravities(levels.impulse_g),
            gravities(levels.between_g),
        ))
        .note(
            "Dashed across: the paper's levels, read from its text. Dashed upright: a roller's centre over the trailing edge, by \
             its recorded path. The paper's exits are near 5, 16–17 and 28 ms.",
        );
    figure.marks = exits(&findings.summary.events);
    figure.levels = both_signs(&[(paper::IMPULSE_G, "impulses"), (paper::BETWEEN_G, "between")]);
    Some(figure)
}

/// Fig. 6: behind the notch, over the raw trace.
pub(super) fn notched(findings: &Findings) -> Option<Figure> {
    let leading = findings.sensors.first().filter(|s| !s.filtered_g.is_empty())?;
    let levels = &findings.summary.levels;
    let mut figure = over_time("acceleration-notched", "Fig. 6: the same behind the notch, over the unfiltered trace")
        .with(sampled(findings, "raw", Colour::Grey, &leading.raw_g))
        .with(sampled(findings, "notched", Colour::Orange, &leading.filtered_g))
        .caption(format!(
            "Without the facet tone the level between the impulses is {1} instead of {0} (paper: 20 instead of 50 g), and the \
             impulses stay.",
            gravities(levels.between_g),
            gravities(levels.between_filtered_g),
        ))
        .note(transient_note(findings));
    figure.marks = exits(&findings.summary.events);
    figure.bands = transient(findings);
    figure.levels = both_signs(&[(paper::FILTERED_G, "between, filtered")]);
    Some(figure)
}

/// Every other sensor, and what the mean over an interval leaves out.
pub(super) fn others(findings: &Findings) -> Vec<Figure> {
    let mut figures = Vec::new();
    for sensor in findings.sensors.iter().skip(1) {
        let mut figure =
            over_time(&format!("acceleration-{}", sensor.name), &format!("Sensor “{}”", sensor.name))
                .with(sampled(findings, "raw", Colour::Grey, &sensor.raw_g));
        if !sensor.filtered_g.is_empty() {
            figure = figure.with(sampled(findings, "notched", Colour::Orange, &sensor.filtered_g));
        }
        figure.bands = transient(findings);
        figure.marks = exits(&findings.summary.events);
        let of_sensor = findings.summary.levels.sensors.iter().find(|l| l.sensor == sensor.name);
        figures.push(figure.caption(format!(
            "The same events from another place on the ring: impulses of {}, {} between them.",
            gravities(of_sensor.and_then(|l| l.impulse_g)),
            gravities(of_sensor.and_then(|l| l.between_g)),
        )));
    }
    figures.extend(findings.sensors.first().and_then(|leading| instantaneous(findings, leading)));
    figures
}

fn instantaneous(findings: &Findings, leading: &SensorSignal) -> Option<Figure> {
    if leading.instant_g.is_empty() {
        return None;
    }
    let figure = over_time("acceleration-instant", "Instantaneous nodal acceleration")
        .with(sampled(findings, "instantaneous", Colour::Grey, &leading.instant_g))
        .with(sampled(findings, "mean over each interval", Colour::Blue, &leading.raw_g));
    Some(
        figure
            .caption(
                "A node rings with the mesh far above half the sampling rate; its instantaneous acceleration aliases, so \
                 every other figure uses the mean over each sampling interval.",
            )
            .note("The mean is the change of velocity over one interval divided by the interval."),
    )
}

fn over_time(id: &str, title: &str) -> Figure {
    Figure::new(id, title, Axis::si("Time", "s"), Axis::plain("a_y", "g")).synced("time")
}

/// Exits by the recorded path where there is one; of many only the first is named in full.
fn exits(events: &[Event]) -> Vec<Mark> {
    let label = |(n, e): (usize, &Event)| match n {
        _ if events.len() <= NAMED => format!("exit of roller {}", e.roller),
        0 => format!("exit of roller {}", e.roller),
        _ => e.roller.to_string(),
    };
    let at = |e: &Event| 1e-3 * e.path_exit_ms.unwrap_or(e.expected_exit_ms);
    events.iter().enumerate().map(|(n, e)| mark(at(e), &label((n, e)), Colour::Green, true)).collect()
}

/// The paper's levels on either side of zero.
fn both_signs(levels: &[(f64, &str)]) -> Vec<Level> {
    let line = |y: f64, label: String| Level { y, label, colour: Colour::Red };
    levels
        .iter()
        .flat_map(|&(g, what)| [line(g, format!("paper, {what}: ± {g:.0} g")), line(-g, String::new())])
        .collect()
}

fn transient_note(findings: &Findings) -> String {
    findings.summary.notch.as_ref().map_or(String::new(), |n| {
        format!(
            "Second-order notch at {:.1} Hz, Q = {}, one pass. In the shaded time the filter still answers to the start (60 dB \
             of its ringing, time constant {:.2} ms). Dashed across: the paper's level.",
            n.centre_hz,
            n.q,
            1e3 * n.time_constant_s
        )
    })
}

fn gravities(level: Option<f64>) -> String {
    level.map_or("not measurable".into(), |g| format!("{g:.0} g"))
}
