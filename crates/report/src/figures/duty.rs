//! Speed and load over time, and the order spectrum of the envelope.

use std::f64::consts::TAU;

use crate::plot::{Axis, Colour, Figure, Mark, Series};
use stribeck_analysis::duty::LOAD;
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;

/// Multiples of the family that the spectrum of orders shows.
const FAMILY: usize = 6;
/// Depth of the spectrum below its highest value [dB].
const DEPTH_DB: f64 = 80.0;

/// Speed, load and orders, as far as they change.
pub(super) fn figures(record: &Record<'_>, findings: &Findings) -> Vec<Figure> {
    let Some(duty) = &findings.summary.duty else { return Vec::new() };
    let interval_s = record.interval_s();
    let mut figures = Vec::new();
    if let Some(angle) = record.channel("shaft.angle_rad").filter(|angle| angle.len() > 2)
        && record.run().scene.written.operation.speed_varies()
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
    figures.extend(orders(findings));
    figures
}

fn orders(findings: &Findings) -> Option<Figure> {
    let spectrum = findings.orders.as_ref()?;
    let duty = findings.summary.duty.as_ref()?;
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

fn mark(family: &str, harmonic: usize, at: f64) -> Mark {
    let label = if harmonic == 1 { format!("{family} {at:.2}") } else { format!("×{harmonic}") };
    Mark { x: at, label, colour: Colour::Red, dashed: true }
}
