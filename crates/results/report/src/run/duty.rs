//! Speed and load over time, and the order spectrum of the envelope.

use std::f64::consts::TAU;

use maud::{Markup, html};
use stribeck_analysis::duty::{DutyFinding, LOAD, OrderLine};
use stribeck_analysis::findings::Findings;

use super::Subject;
use crate::page::{Section, cell, charts, minus, table};
use crate::plot::{Axis, Colour, Figure, Mark, Series};

/// Multiples of the family that the spectrum of orders shows.
const FAMILY: usize = 6;
/// Depth of the spectrum below its highest value [dB].
const DEPTH_DB: f64 = 80.0;

/// The section of a run whose speed or load changes.
pub(super) fn section(of: &Subject<'_>) -> Option<Section> {
    let duty = of.findings.summary.duty.as_ref()?;
    let figures = charts(figures(of, duty));
    Some(
        Section::new("duty", "Speed and load")
            .figures(figures, "The angle of the shaft was not recorded.")
            .after(numbers(duty)),
    )
}

/// Speed, load and orders, as far as they change.
fn figures(of: &Subject<'_>, duty: &DutyFinding) -> Vec<Figure> {
    let record = of.record;
    let interval_s = record.interval_s();
    let mut figures = Vec::new();
    if let Some(angle) = record.channel("shaft.angle_rad").filter(|angle| angle.len() > 2)
        && of.run.scene.written.operation.speed_varies()
    {
        let rpm = |name: &str, colour: Colour, angle: &[f64]| {
            let rates = angle.windows(2).map(|pair| -60.0 / TAU * (pair[1] - pair[0]) / interval_s);
            Series::sampled(name, colour, 1.5 * interval_s, interval_s, rates.collect())
        };
        let outer = record.channel("outer_ring.angle_rad");
        let mut figure = Figure::new(
            "speed",
            if outer.is_some() { "Speeds of the rings" } else { "Speed of the shaft" },
            Axis::si("Time", "s"),
            Axis::plain("Clockwise", "rpm"),
        )
        .synced("time")
        .with(rpm("shaft", Colour::Blue, angle));
        if let Some(outer) = outer {
            figure = figure.with(rpm("outer ring", Colour::Orange, outer));
        }
        figures.push(figure.caption(format!(
            "From the recorded angle of the {}, which every passage follows.",
            duty.over()
        )));
    }
    if let Some(load) = record.channel(LOAD).filter(|load| load.len() > 1) {
        let kilo = load.iter().map(|n| 1e-3 * n).collect();
        figures.push(
            Figure::new(
                "load",
                "Load on the housing",
                Axis::si("Time", "s"),
                Axis::plain("Along its direction", "kN"),
            )
            .synced("time")
            .with(Series::sampled("load", Colour::Blue, interval_s, interval_s, kilo))
            .caption("As prescribed."),
        );
    }
    figures.extend(orders(of.findings, duty));
    figures
}

fn orders(findings: &Findings, duty: &DutyFinding) -> Option<Figure> {
    let spectrum = findings.orders.as_ref()?;
    let envelope = duty.envelope.as_ref()?;
    let order = envelope.lines.first()?.predicted;
    let top = (FAMILY as f64 + 1.0) * order;
    let decibels: Vec<f64> = spectrum.values().iter().map(|p| 10.0 * p.log10()).collect();
    let highest = decibels.iter().copied().filter(|d| d.is_finite()).fold(f64::NEG_INFINITY, f64::max);
    let floored = decibels.iter().map(|d| d.max(highest - DEPTH_DB)).collect();
    let mut figure = Figure::new(
        "orders",
        &format!("Envelope spectrum over the angle of the {}", duty.over()),
        Axis::plain("Order", "a turn").over(0.0, top),
        Axis::plain("Squared envelope spectrum", "dB re 1 g⁴"),
    )
    .with(Series::sampled("squared envelope", Colour::Blue, 0.0, spectrum.resolution().grid_hz, floored))
    .caption(format!("Where the speed changes, {} stands at its order.", envelope.family))
    .note(format!(
        "Envelope of {:.0} to {:.0} Hz, averaged over equal steps of the angle; {:.1} periods of {}, \
         resolution {:.3} orders.",
        envelope.band_hz.0, envelope.band_hz.1, envelope.periods, envelope.family, envelope.resolution
    ));
    figure.marks = envelope
        .lines
        .iter()
        .filter(|line| line.predicted < top)
        .map(|line| mark(&envelope.family, line.harmonic, line.predicted))
        .collect();
    Some(figure)
}

/// Range of speed and load, and the families in orders of the shaft.
fn numbers(duty: &DutyFinding) -> Markup {
    let (speed, load) = (duty.speed_rpm, duty.load_n);
    let head = html! {
        th { "Envelope line over the angle" } th class="n" { "Predicted order" } th class="n" { "From the motion" }
        th class="n" { "Measured order" } th class="n" { "Above surroundings dB" }
    };
    html! {
        table {
            thead { tr { th { "Over the record" } th class="n" { "From" } th class="n" { "To" } } }
            tbody {
                tr { td { "Speed, clockwise positive, rpm" } td class="n" { (minus(format!("{:.1}", speed.0))) } td class="n" { (minus(format!("{:.1}", speed.1))) } }
                @if duty.outer_turns() {
                    tr { td { "Speed of the outer ring, rpm" } td class="n" { (minus(format!("{:.1}", duty.outer_speed_rpm.0))) } td class="n" { (minus(format!("{:.1}", duty.outer_speed_rpm.1))) } }
                }
                tr { td { "Load, kN" } td class="n" { (format!("{:.2}", 1e-3 * load.0)) } td class="n" { (format!("{:.2}", 1e-3 * load.1)) } }
                tr { td { "Turns of the " (duty.over()) } td class="n" { "" } td class="n" { (format!("{:.2}", duty.turns)) } }
            }
        }
        @if duty.is_unsteady() {
            p class="hint" {
                "Families come so often in a turn of the " (duty.over()) ", without slip: "
                @for (n, (name, order)) in duty.orders.iter().enumerate() { @if n > 0 { ", " } (name) " " (format!("{order:.4}")) }
                "."
                @if duty.envelope.is_some() {
                    " The squared envelope of the leading sensor was averaged over equal steps of that angle \
                     (THEORY §7.11)."
                }
            }
        }
        @if let Some(envelope) = &duty.envelope {
            @let line = |line: &OrderLine| html! {
                td { (envelope.family) " ×" (line.harmonic) }
                td class="n" { (format!("{:.3}", line.predicted)) }
                (cell(line.from_motion.map(|order| format!("{order:.3}"))))
                (cell(line.measured.map(|order| format!("{order:.3}"))))
                (cell(line.prominence_db.map(|db| minus(format!("{db:.1}")))))
            };
            (table(Some("pairs"), &head, envelope.lines.iter().map(line)))
            p class="hint" { (format!("{:.1} periods of {}; resolution {:.3} orders, one over the turns on \
                record.", envelope.periods, envelope.family, envelope.resolution)) }
        }
    }
}

fn mark(family: &str, harmonic: usize, at: f64) -> Mark {
    let label = if harmonic == 1 { format!("{family} {at:.2}") } else { format!("×{harmonic}") };
    Mark::new(at, label, Colour::Red, true)
}
