//! The diagnosis of the leading sensor alone, without knowledge of the scene.

use maud::{Markup, html};
use stribeck_analysis::diagnosis::DiagnosedFamily;
use stribeck_analysis::summary::Summary;

use crate::page::{cell, minus, wide_table};

pub(super) fn table(summary: &Summary) -> Markup {
    let Some(diagnosis) = &summary.diagnosis else { return html! {} };
    let number = |hz: Option<f64>| cell(hz.map(|hz| format!("{hz:.2}")));
    let head = html! {
        th { "Family" } th { "In the scene" } th { "Claimed" } th class="n" { "No slip Hz" } th class="n" { "By motion Hz" }
        th class="n" { "Measured Hz" } th class="n" { "Height dB" } th { "Sidebands" } th { "Why" }
    };
    let row = |family: &DiagnosedFamily| {
        html! {
            td { (family.name) }
            td { (if family.present { "yes" } else { "no" }) }
            td { (if family.claimed { "yes" } else { "no" }) }
            td class="n" { (format!("{:.2}", family.expected_hz)) }
            (number(family.from_motion_hz))
            (number(family.measured_hz))
            (cell(family.level_db.map(|db| minus(format!("{db:.1}")))))
            td {
                @if let Some(sides) = &family.sidebands {
                    (sides.seen) " of 6 at ±" (format!("{:.2} Hz", sides.spacing_hz)) " (" (sides.of) ")"
                } @else { "–" }
            }
            td { (family.reason) }
        }
    };
    html! {
        h3 #diagnosis { "What the record shows by itself" }
        p { "Sensor channel " code { (diagnosis.channel) } ", judged as a measured record is, without the \
            scene: " (diagnosis.verdict) }
        @if diagnosis.families.iter().any(|family| family.claimed && !family.present) {
            p { "What is claimed and is no defect of the scene may be the rattle of elements that come under \
                the load: a run has no noise "
                "but its bearing's, so that this alone can swing its power as impacts do. In a machine's \
                 noise such claims go "
                "(`stribeck export` with `--sensor`, `noise_density`)." }
        }
        (wide_table(None, &head, diagnosis.families.iter().map(row)))
        p class="hint" {
            "The envelope spectra resolve " (format!("{:.2} Hz", diagnosis.resolution_hz)) ". BSF is the \
                spin of a rolling element, which strikes twice a turn; sidebands are those of the first \
                three harmonics."
            @if summary.kinematics.outer_ring_hz > 0.0 { " FTF is the cage as seen from the outer ring." }
        }
    }
}
