//! Contact forces over time (the paper's Fig. 8), the events of each passage, and the length of the spall.

use maud::{Markup, html};
use stribeck_analysis::findings::{CrossingForce, Findings};
use stribeck_analysis::floor::FloorContact;
use stribeck_analysis::summary::Event;
use stribeck_diagnosis::words::numbers::level;
use stribeck_scene::scene::DefectScene;

use super::Subject;
use super::drawing::{sampled, transient};
use crate::page::{Section, cell, charts, folded, minus, wide_table};
use crate::plot::{Axis, Colour, Figure, Mark};

/// Rollers whose force is drawn: the paper's three. All others are in the table.
pub(super) const DRAWN: usize = 3;

/// Largest relative increase that is shown: beyond it the force before was next to nothing.
const MOST_GAIN: f64 = 10.0;

/// A record of more roller spacings is drawn about each passage only.
const LONG_SPACINGS: f64 = 6.0;

/// The section. A page of the paper's bearing has the forces among the paper's figures.
pub(super) fn section(of: &Subject<'_>) -> Section {
    let events = &of.findings.summary.events;
    let drawn = if of.paper.is_some() { Vec::new() } else { crossings(of.findings) };
    let otherwise = if of.paper.is_some() && !of.findings.crossings.is_empty() {
        "The forces over time stand above, as the paper's Fig. 8."
    } else {
        "No roller crosses a defect."
    };
    Section::new("forces", "Contact forces and events")
        .linked("Forces")
        .folded("When does each roller lose and take its load, and how long is the spall by that?")
        .before(passages(events))
        .figures(charts(drawn), otherwise)
        .after(lengths(events, &of.run.scene.written.spalls()))
}

/// Force of the raceway on each roller that crosses its spall.
pub(super) fn crossings(findings: &Findings) -> Vec<Figure> {
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
        figure.marks.push(Mark::new(1e-3 * ms, label, Colour::Orange, true));
    }
    let events = [
        (event.entry_ms, "#1 unloads"),
        (event.impact_ms(), "#2 strikes the floor"),
        (event.landing_ms(), "lands on oil"),
        (event.compensation_ms, "#3 carries for a neighbour"),
        (event.exit_ms, "#4 loaded again"),
    ];
    for (ms, label) in events {
        if let Some(ms) = ms {
            figure.marks.push(Mark::new(1e-3 * ms, label, Colour::Green, false));
        }
    }
    let time = |ms: Option<f64>| ms.map_or("not at all".into(), |t| format!("at {t:.2} ms"));
    let touch = event.floor_ms.zip(event.floor_n).zip(event.floor_by);
    let floor = touch.map_or("does not touch the floor (#2)".into(), |((t, n), by)| {
        let number = if by == FloorContact::Metal { " (#2)" } else { "" };
        format!("{} at {t:.2} ms with {n:.0} N{number}", by.in_words())
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

/// Measured events of every passage.
fn passages(events: &[Event]) -> Markup {
    if events.is_empty() {
        return html! {};
    }
    let ms = |t: Option<f64>| cell(t.map(|t| format!("{t:.2}")));
    let kilo = |n: Option<f64>| cell(n.map(|n| format!("{:.2}", 1e-3 * n)));
    let floor = |event: &Event| {
        let by = |by: FloorContact| format!(", {}", by.name());
        cell(event.floor_n.map(|n| format!("{n:.0}{}", event.floor_by.map_or(String::new(), by))))
    };
    let several = events.iter().any(|event| event.spall > 1);
    let head = html! {
        @if several { th { "Spall" } }
        th { "Roller" } th class="n" { "Load before kN" } th class="n" { "#1 unloads ms" } th class="n" { "no slip ms" }
        th class="n" { "#2 floor ms" } th class="n" { "floor N" }
        th class="n" { "#3 neighbour in the defect ms" } th class="n" { "carries kN" }
        th class="n" { "#4 loaded ms" } th class="n" { "no slip ms" } th class="n" { "Impulse g" }
    };
    let row = |event: &Event| {
        html! {
            @if several { td { (event.spall) ", " (event.ring.name()) } }
            td { (event.roller) }
            (kilo(event.level_n))
            (ms(event.entry_ms))
            (ms(Some(event.expected_entry_ms)))
            (ms(event.floor_ms))
            (floor(event))
            (ms(event.compensation_ms))
            (kilo(event.compensation_n))
            (ms(event.exit_ms))
            (ms(Some(event.expected_exit_ms)))
            (cell(event.impulse_g.map(level)))
        }
    };
    let table = wide_table(None, &head, events.iter().map(row));
    folded(table, events.len(), "passages over the defect, one by one")
}

/// Length of the defect from the event times, beside the truth.
fn lengths(events: &[Event], spalls: &[DefectScene]) -> Markup {
    if spalls.is_empty() {
        return html! { p { "No spall lies on a raceway." } };
    }
    let truth = |event: &Event| Some(spalls.get(event.spall.checked_sub(1)?)?.length_mm);
    let several = spalls.len() > 1;
    let scatter = |e: &Event| e.spall_scatter_mm.map_or(String::new(), |mm| format!(" ± {mm:.2}"));
    let off = |found: Option<f64>, truth: f64| cell(found.map(|t| minus(format!("{:+.3}", t - truth))));
    let head = html! {
        @if several { th { "Spall" } }
        th { "Roller" } th class="n" { "#1 off ms" } th class="n" { "#4 off ms" } th class="n" { "Estimated mm" } th class="n" { "True mm" }
        th class="n" { "Difference" }
    };
    let row = |e: &Event| {
        html! {
            @if several { td { (e.spall) ", " (e.ring.name()) } }
            td { (e.roller) }
            (off(e.entry_ms, e.expected_entry_ms))
            (off(e.exit_ms, e.expected_exit_ms))
            (cell(e.spall_mm.map(|mm| format!("{mm:.2}{}", scatter(e)))))
            (cell(truth(e).map(|mm| mm.to_string())))
            (cell(e.spall_mm.zip(truth(e)).map(|(mm, truth)| minus(format!("{:+.1} %", 100.0 * (mm / truth - 1.0))))))
        }
    };
    let table = wide_table(None, &head, events.iter().map(row));
    html! {
        h3 { "Length of the defect, from the events" }
        (folded(table, events.len(), "lengths, passage by passage"))
        p class="hint" {
            "Off: event against the roller's centre over the edge without slip. The estimate allows for the \
             load that a roller still carries behind an edge (THEORY §7.5); ±: how far that of a further \
             passage over the spall lies from their mean at most, at 95 %, by their scatter."
        }
    }
}
