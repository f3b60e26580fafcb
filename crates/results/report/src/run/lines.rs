//! Every line of the leading sensor's spectrum with what makes it, and the notch.

use maud::{Markup, html};
use stribeck_analysis::artefacts::{Artefact, Origin};
use stribeck_analysis::summary::Summary;
use stribeck_diagnosis::words::numbers::significant;

use super::spectrum::families::no_lines;
use crate::page::{Section, cell, grouped, pairs, said_once, spoken};

pub(super) fn section(summary: &Summary) -> Section {
    Section::new("artefacts", "All lines of the leading sensor")
        .linked("All lines")
        .folded("Which lines are predicted, and which of them stand in the spectrum?")
        .after(html! {
            (table(summary))
            (notch(summary))
        })
}

/// Every line of the leading sensor's spectrum.
fn table(summary: &Summary) -> Markup {
    if summary.unsteady().is_some() {
        return no_lines();
    }
    if summary.artefacts.is_empty() {
        return html! { p { "The record is too short for a spectrum." } };
    }
    let hz = |v: Option<f64>| v.map(|v| format!("{v:.1}"));
    // A heading between two groups ends a cell that spans rows.
    let verdicts = summary.artefacts.chunk_by(|a, b| group(a) == group(b));
    let verdicts = verdicts.flat_map(|lines| said_once(lines, |a| &a.verdict));
    let rows = grouped(&summary.artefacts, |a, b| a.family == b.family).zip(verdicts);
    html! {
        p {
            "Sensor “" (summary.levels.sensor.as_deref().unwrap_or("none")) "”, a_y. Facet lines are claimed \
                by a family that was found, never by their place alone."
        }
        div class="scroll" {
            table class="ledger" {
                thead {
                    tr {
                        th { "Line" } th class="n" { "Predicted Hz" } th class="n" { "From the motion Hz" } th class="n" { "Measured Hz" }
                        th class="n" { "Level g" } th { "Verdict" }
                    }
                }
                tbody {
                    @for ((first, a), verdict) in rows {
                        @if first { tr class={ "group " (group(a).0) } { td colspan="6" { (group(a).1) } } }
                        tr {
                            td { (spoken(&a.name)) @if matches!(a.family, Origin::Mesh | Origin::Defect) { " ×" (a.harmonic) } }
                            td class="n" { (format!("{:.1}", a.predicted_hz)) }
                            (cell(hz(a.from_motion_hz)))
                            (cell(hz(a.measured_hz)))
                            (cell(a.level_g.map(|g| significant(g, 3))))
                            (verdict)
                        }
                    }
                }
            }
        }
    }
}

/// Class and heading of the group that a line stands in.
fn group(line: &Artefact) -> (&'static str, &'static str) {
    match line.family {
        Origin::Mesh => ("mesh", "Facets passing contacts: artefacts of the mesh"),
        Origin::Beat => ("mesh", "Beats of the facet lines: artefacts too"),
        Origin::Defect => ("defect", "Rollers passing the defect: physics"),
        Origin::Ring => ("ring", "Bending modes of the free outer ring: places to look at"),
    }
}

/// The notch in numbers.
fn notch(summary: &Summary) -> Markup {
    let Some(notch) = &summary.notch else { return html! {} };
    let db = |v: Option<f64>| v.map(|v| format!("{v:.1} dB"));
    let rows = [
        ("Centre", Some(format!("{:.1} Hz", notch.centre_hz))),
        ("Quality factor", Some(format!("{:.0}", notch.q))),
        ("Width at −3 dB", Some(format!("{:.0} Hz", notch.width_hz))),
        ("Transient (60 dB)", Some(format!("{:.2} ms", 1e3 * notch.transient_s))),
        ("Attenuation at the centre: Hann, whole record", db(notch.attenuation_db)),
        ("Hann, without the transient", db(notch.attenuation_settled_db)),
        ("Boxcar, whole record", db(notch.attenuation_boxcar_db)),
        ("Boxcar, without the transient", db(notch.attenuation_boxcar_settled_db)),
        ("Attenuation at 4545 Hz, transfer function", db(notch.attenuation_4545_db)),
    ];
    // The last is a frequency of the paper's.
    let shown = rows.len() - usize::from(summary.paper.is_empty());
    html! {
        h3 id="notch" { "The notch" }
        (pairs(rows.into_iter().take(shown)))
    }
}
