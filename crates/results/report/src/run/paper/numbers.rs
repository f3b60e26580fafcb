//! Every number of the paper's text beside ours, and the two readings that its own numbers do not carry.

use maud::{Markup, html};
use stribeck_analysis::artefacts::Origin;
use stribeck_analysis::summary::Summary;

use crate::page::{cell, grouped};

/// Text of a row of the paper's numbers for which the record has none.
const CANNOT_TELL: &str = "this record cannot tell";

/// Quantity, paper, ours, difference, why.
pub(super) fn table(summary: &Summary) -> Markup {
    let rows = grouped(&summary.paper, |a, b| a.part == b.part);
    html! {
        div class="scroll" {
            table class="numbers" {
                thead { tr { th { "Quantity" } th class="n" { "Paper" } th class="n" { "Ours" } th class="n" { "Difference" } th { "Why" } } }
                tbody {
                    @for (first, row) in rows {
                        @if first { tr class="group" { td colspan="5" { (row.part) } } }
                        tr {
                            td { (row.quantity) }
                            td class="n" { (row.paper) }
                            td class="n wrap" { @if row.ours == CANNOT_TELL { "–" } @else { (row.ours) } }
                            td class="n" { (row.difference) }
                            td class="why" { (row.why) }
                        }
                    }
                }
            }
        }
        @if summary.paper.iter().any(|row| row.ours == CANNOT_TELL) {
            p class="hint" { "–: this record is too short to tell." }
        }
    }
}

/// The two readings of the paper that its own numbers do not carry.
pub(super) fn readings(summary: &Summary) -> Markup {
    let line = |name: &str| {
        summary
            .artefacts
            .iter()
            .find(|a| a.family == Origin::Mesh && a.name == name && a.harmonic == 1)
            .map(|a| a.predicted_hz)
    };
    let hz = |v: Option<f64>| v.map(|v| format!("{v:.0} Hz"));
    let (vertices, inner) = (line("roller_vertices"), line("inner_race_nodes"));
    let printed = stribeck_analysis::paper::EQUATION_2_HZ.1;
    let near = summary.tones.iter().filter(|t| t.harmonic == 1).filter_map(|t| t.measured_hz);
    let nearest = near.min_by(|a, b| (a - printed).abs().total_cmp(&(b - printed).abs()));
    html! {
        h3 { "The inner raceway: two formulas" }
        table {
            thead { tr { th { "Formula" } th class="n" { "Gives" } th { "Evidence in this run" } } }
            tbody {
                tr {
                    td { "Paper, equation (2): π f_c D_i / ℓ, the cage's speed" }
                    td class="n" { (format!("{printed:.0} Hz")) }
                    td {
                        "the measured facet line nearest to it, at any sensor: "
                        (hz(nearest).unwrap_or("none".into()))
                    }
                }
                tr {
                    td { "Speed of the contact along the ring: π (f_s − f_c) D_i / ℓ" } (cell(hz(inner)))
                    td { "vertices pass the inner raceway at the spin's rate, as at the outer \
                        one: " (hz(vertices).unwrap_or("–".into())) }
                }
            }
        }
        @if let Some(r) = &summary.cursor {
            h3 { "4545 Hz" }
            p {
                "A cursor between two sampled peaks reads a whole number of samples: " (format!("{:.0}, {:.0} or {:.0} Hz", r.neighbours_hz.0, r.reads_hz, r.neighbours_hz.1))
                ". " (format!("{:.0} %", 100.0 * r.share_in_tone)) " of the periods of a pure 4671 Hz tone \
                 are " (r.samples) " samples long, so the reading needs no second tone. The paper's own sum \
                 of two tones swells on a carrier of " (format!("{:.0} Hz", r.equation_3_carrier_hz)) "; "
                (format!("{:.0} %", 100.0 * r.equation_3_common.1)) " of its gaps are " (r.equation_3_common.0) " samples, "
                (format!("{:.0} %", 100.0 * r.share_in_equation_3)) " read 4545 Hz."
            }
        }
    }
}
