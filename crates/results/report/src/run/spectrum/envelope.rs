//! The spectrum of the squared envelope, and the defect's family in it.

use maud::{Markup, html};
use stribeck_analysis::defect::Shocks;
use stribeck_analysis::enveloping::EnvelopeLine;
use stribeck_analysis::findings::Findings;
use stribeck_diagnosis::Defect;

use super::{FAMILY, cursor, density, physics_marks, stated};
use crate::page::{self, cell, minus};
use crate::plot::{Axis, Colour, Figure};

pub(super) fn figure(findings: &Findings) -> Option<Figure> {
    let (spectrum, finding) = findings.envelope.as_ref().zip(findings.summary.envelope.as_ref())?;
    let shocks = findings.prediction.shocks?;
    let (name, hz) = (shocks.name(), shocks.hz);
    let top = (FAMILY as f64 + 1.0) * hz;
    let power = Axis::plain("Squared envelope spectrum", "dB re 1 g⁴");
    let mut figure =
        Figure::new("envelope", "Envelope spectrum", Axis::si("Frequency", "Hz").over(0.0, top), power)
            .with(density("squared envelope", Colour::Blue, spectrum));
    let seen: Vec<String> = finding
        .lines
        .iter()
        .filter(|l| l.measured_hz.is_some())
        .map(|l| format!("×{}", l.harmonic))
        .collect();
    figure = figure
        .caption(if seen.is_empty() {
            format!("No multiple of {name} stands 10 dB above its surroundings.")
        } else {
            format!(
                "Impacts come at {name}: of its multiples {} stand 10 dB above their surroundings.",
                seen.join(", ")
            )
        })
        .note(format!(
            "Envelope of {:.0} to {:.0} Hz, {:.1} periods of {name} on record. {}",
            finding.band_hz.0,
            finding.band_hz.1,
            finding.periods,
            stated(spectrum)
        ));
    figure.marks = physics_marks(findings, top);
    figure.cursor = Some(cursor(findings));
    Some(figure)
}

/// The defect's family in the envelope.
pub(super) fn table(findings: &Findings) -> Markup {
    let summary = &findings.summary;
    if summary.unsteady().is_some() {
        return html! {};
    }
    let Some(envelope) = &summary.envelope else {
        let why = findings.no_envelope.as_deref().unwrap_or("no envelope spectrum was made");
        return html! { p class="hint" { (why) "." } };
    };
    let name = findings.prediction.shocks.map_or(Defect::Bpfo.name(), Shocks::name);
    let head = html! {
        th { "Envelope line" } th class="n" { "Predicted Hz" } th class="n" { "Measured Hz" }
        th class="n" { "Above surroundings dB" }
    };
    let line = |line: &EnvelopeLine| {
        html! {
            td { (name) " ×" (line.harmonic) }
            td class="n" { (format!("{:.2}", line.predicted_hz)) }
            (cell(line.measured_hz.map(|hz| format!("{hz:.2}"))))
            (cell(line.prominence_db.map(|db| minus(format!("{db:.1}")))))
        }
    };
    page::table(Some("pairs"), &head, envelope.lines.iter().map(line))
}
