//! Acceleration over time: the paper's Figs. 2 and 6, the other sensors, the instantaneous one; levels by
//! phase.

use maud::{Markup, html};
use stribeck_analysis::findings::{Findings, SensorSignal};
use stribeck_analysis::paper;
use stribeck_analysis::record::Record;
use stribeck_analysis::summary::{Event, PhaseLevels, Summary};
use stribeck_diagnosis::words::numbers::{gravities, level, significant};

use super::Subject;
use super::drawing::{sampled, transient};
use crate::Error;
use crate::page::{Section, cell, charts, wide_table};
use crate::plot::{Axis, Band, Colour, Figure, Level, Mark};

/// All of them stand behind tabs.
const TABS: &str = "acceleration";
/// Most exits that are named in full.
const NAMED: usize = 6;

pub(super) fn section(of: &Subject<'_>) -> Result<Section, Error> {
    let findings = of.findings;
    let figures = raw(findings).into_iter().chain(others(of.record, findings)?).chain(notched(findings));
    let after = levels(&findings.summary);
    Ok(Section::new("acceleration", "Acceleration")
        .figures(charts(figures), "No sensor was recorded.")
        .after(after))
}

/// As recorded (the paper's Fig. 2).
fn raw(findings: &Findings) -> Option<Figure> {
    let leading = findings.sensors.first().filter(|s| !s.raw_g.is_empty())?;
    let levels = &findings.summary.levels;
    let title = format!("Acceleration a_y at sensor “{}”", leading.name);
    let mut figure = over_time("acceleration", &title)
        .tabbed(TABS, format!("“{}”", leading.name))
        .with(sampled(findings, "mean over each interval", Colour::Blue, &leading.raw_g))
        .caption(format!("Peaks: {}.", peaks(Some(&levels.phases))));
    figure.marks = passages(&findings.summary.events);
    figure = match findings.summary.events.len() {
        0 => figure,
        1..=DRAWN => figure.note(
            "Upright: entries (orange) and exits (green), read from the contact forces; dashed where the \
             forces show none and the place of the roller on its way is drawn.",
        ),
        _ => figure.note(
            "Entries and exits are too many to be drawn here; they stand in the table of the \
            contact forces.",
        ),
    };
    figure.bands = start_up(findings);
    if findings.of_paper {
        figure.levels = both_signs(&[(paper::IMPULSE_G, "impulses"), (paper::BETWEEN_G, "between")]);
    }
    Some(figure)
}

/// Behind the notch, over the raw trace (the paper's Fig. 6).
fn notched(findings: &Findings) -> Option<Figure> {
    let leading = findings.sensors.first().filter(|s| !s.filtered_g.is_empty())?;
    let levels = &findings.summary.levels;
    let title = format!("The same at “{}” with the tone filtered out", leading.name);
    let mut figure = over_time("acceleration-notched", &title)
        .tabbed(TABS, "tone filtered out")
        .with(sampled(findings, "raw", Colour::Grey, &leading.raw_g))
        .with(sampled(findings, "notched", Colour::Orange, &leading.filtered_g))
        .caption(match (levels.between_g, levels.between_filtered_g) {
            (None, _) => "No gap between passages is long enough for a level.".to_owned(),
            (Some(raw), Some(filtered)) if filtered < raw => format!(
                "Between passages the peak falls from {} to {}{}.",
                gravities(raw),
                gravities(filtered),
                if levels.impulse_g.is_some() { "; the impulses stay" } else { "" }
            ),
            (Some(raw), filtered) => {
                format!(
                    "Between passages the peak is {} before the notch and {} behind it.",
                    gravities(raw),
                    known(filtered)
                )
            }
        })
        .note(transient_note(findings));
    figure.marks = passages(&findings.summary.events);
    figure.bands = transient(findings);
    if findings.of_paper {
        figure.levels = both_signs(&[(paper::FILTERED_G, "between, filtered")]);
    }
    Some(figure)
}

/// Every other sensor, and the instantaneous acceleration beside the mean over an interval.
fn others(record: &Record<'_>, findings: &Findings) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for sensor in findings.sensors.iter().skip(1) {
        let mut figure = over_time(
            &format!("acceleration-{}", sensor.name),
            &format!("Acceleration a_y at sensor “{}”", sensor.name),
        )
        .tabbed(TABS, format!("“{}”", sensor.name))
        .with(sampled(findings, "raw", Colour::Grey, &sensor.raw_g));
        if !sensor.filtered_g.is_empty() {
            figure = figure.with(sampled(findings, "notched", Colour::Orange, &sensor.filtered_g));
        }
        figure.bands = transient(findings);
        figure.marks = passages(&findings.summary.events);
        let of_sensor = findings.summary.levels.sensors.iter().find(|l| l.sensor == sensor.name);
        figures.push(figure.caption(format!("a_y: {}.", peaks(of_sensor.map(|l| &l.phases)))));
    }
    if let Some(leading) = findings.sensors.first() {
        figures.extend(instantaneous(record, findings, leading)?);
    }
    Ok(figures)
}

fn instantaneous(
    record: &Record<'_>,
    findings: &Findings,
    leading: &SensorSignal,
) -> Result<Option<Figure>, Error> {
    let channel = format!("sensor.{}.ay_instant_m_s2", leading.name);
    let recorded = record.part(0..record.len(), |name| name == channel)?;
    let Some(instant_g) = recorded.acceleration_g(&leading.name, "ay_instant").filter(|g| !g.is_empty())
    else {
        return Ok(None);
    };
    let title = format!("Instantaneous nodal acceleration at “{}”", leading.name);
    let figure = over_time("acceleration-instant", &title)
        .tabbed(TABS, "instantaneous")
        .with(sampled(findings, "instantaneous", Colour::Grey, &instant_g))
        .with(sampled(findings, "mean over each interval", Colour::Blue, &leading.raw_g));
    Ok(Some(
        figure
            .caption(
                "The sensor\u{2019}s acceleration changes within a sampling interval, with every contact \
                 that opens or closes; an instantaneous one aliases what is faster than half the sampling \
                 rate, so every other figure uses the mean over each interval.",
            )
            .note("The mean is the change of velocity over one interval divided by the interval."),
    ))
}

/// Levels by phase at every sensor, as the paper takes them and along and across the radius.
fn levels(summary: &Summary) -> Markup {
    let both = |peak: Option<f64>, rms: Option<f64>| {
        cell(peak.zip(rms).map(|(p, r)| format!("{} / {}", level(p), significant(r, 3))))
    };
    let row = |sensor: &str, component: &str, l: &PhaseLevels| {
        html! {
            td { (sensor) } td { (component) }
            (both(l.start_g, l.start_rms_g))
            (both(l.entry_g, l.entry_rms_g))
            (both(l.defect_g, l.defect_rms_g))
            (both(l.exit_g, l.exit_rms_g))
            (both(l.gap_g, l.gap_rms_g))
        }
    };
    let head = html! {
        th { "Sensor" } th { "Component" } th class="n" { "Start-up" } th class="n" { "Entry" } th class="n" { "In the defect" }
        th class="n" { "Exit" } th class="n" { "Gap" }
    };
    let rows = summary.levels.sensors.iter().flat_map(|sensor| {
        let others = sensor.components.iter().map(|c| row("", &c.component, &c.phases));
        std::iter::once(row(&sensor.sensor, "a_y", &sensor.phases)).chain(others)
    });
    html! {
        details {
            summary { "Levels of every sensor at entries, at exits and between passages" }
            h3 { "Peak / RMS in g" }
            (wide_table(None, &head, rows))
            p class="hint" {
                "Mean acceleration of each sampling interval. Start-up: to the first entry, 2 ms at most. \
                 Entry: from 0.5 ms before the edge to 1 ms after unloading. Exit: from 1 ms before loading \
                 to 2 ms after the edge. Gap: between passages."
            }
        }
    }
}

fn over_time(id: &str, title: &str) -> Figure {
    Figure::new(id, title, Axis::si("Time", "s"), Axis::plain("a_y", "g")).synced("time")
}

/// Most passages that are drawn: the lines of more would hide the signal.
const DRAWN: usize = 40;

/// Entries and exits by the forces, dashed by rolling without slip where the forces show none; of many only
/// the first is named in full, of very many none is drawn.
fn passages(events: &[Event]) -> Vec<Mark> {
    let mut marks = Vec::new();
    if events.len() > DRAWN {
        return marks;
    }
    for (n, e) in events.iter().enumerate() {
        let full = events.len() <= NAMED || n == 0;
        let label = |what: &str| if full { format!("{what} {}", e.roller) } else { e.roller.to_string() };
        let visit = e.visit();
        marks.push(Mark::new(visit.entry_s, label("entry"), Colour::Orange, e.entry_ms.is_none()));
        marks.push(Mark::new(visit.exit_s, label("exit"), Colour::Green, e.exit_ms.is_none()));
    }
    marks
}

/// The start-up, which no level of events or gaps contains.
fn start_up(findings: &Findings) -> Vec<Band> {
    let to = findings.start_up_end_s;
    if to <= findings.start_s {
        return Vec::new();
    }
    vec![Band {
        from: findings.start_s,
        to,
        label: format!("start-up, {:.2} ms", 1e3 * (to - findings.start_s)),
    }]
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
            "Second-order notch at {:.1} Hz, Q = {}, one pass. In the shaded time the filter still answers \
             to the start (60 dB of its ringing, time constant {:.2} ms).{}",
            n.centre_hz,
            n.q,
            1e3 * n.time_constant_s,
            if findings.of_paper { " Dashed across: the paper's level." } else { "" }
        )
    })
}

/// Peaks about the passages of a spall and in the gaps; where nothing passes one, all of the record is a gap.
fn peaks(phases: Option<&PhaseLevels>) -> String {
    let [exit, entry, gap] = phases.map_or([None; 3], |p| [p.exit_g, p.entry_g, p.gap_g]);
    if exit.or(entry).is_none() && gap.is_some() {
        return known(gap);
    }
    format!("{} at exits, {} at entries, {} between passages", known(exit), known(entry), known(gap))
}

fn known(level: Option<f64>) -> String {
    level.map_or("not measurable".into(), gravities)
}
