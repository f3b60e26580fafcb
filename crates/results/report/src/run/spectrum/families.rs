//! Families of facet lines: in words, verdict by verdict and line by line.

use maud::{Markup, html};
use stribeck_analysis::families::{FamilyFinding, FamilyLine};
use stribeck_analysis::summary::Summary;
use stribeck_diagnosis::words::numbers::{gravities, significant};

use crate::page::{self, cell, minus, said_once, spoken, term, wide_table};

const FACET_LINES: &str = "Rollers and raceways are polygons in the model; their corners pass the contacts \
    and make tones that a real bearing does not have";
const CARRIER: &str = "The carrier: the line in the middle of a family, at the rate at which facets pass";
pub(crate) const OFF: &str = "How far the middle line lies from where the recorded motion puts it, in \
    widths that the spectrum resolves: within ±1 it is at its place";
const SCATTER: &str = "By how much that differs between components of sensors and forces of rollers, in the \
    same widths";

/// The families of facet lines in full.
pub(in super::super) fn in_words(summary: &Summary) -> String {
    if let Some(duty) = summary.unsteady() {
        let (least, most) = duty.relative_speed_rpm;
        return format!(
            "The speed of the {} goes from {least:.0} to {most:.0} rpm, so facet lines have no frequency and \
             are not looked for.",
            duty.over()
        )
        .replace('-', "−");
    }
    let families = &summary.families;
    if summary.kinematics.relative_hz == 0.0 {
        return "Nothing turns, so that no facets pass a contact.".into();
    }
    if families.iter().all(|f| f.lead.is_none()) {
        return "This record is too short, or sampled too slowly, to tell a family of facet lines from \
            anything else."
            .into();
    }
    let spacing_hz = summary.kinematics.bpfo_hz.unwrap_or(summary.kinematics.expected_bpfo_hz);
    let resolution_hz = summary.spectrum.as_ref().map_or(0.0, |s| 1.0 / s.record_s);
    // Of families that are there, which have a carrier.
    let place = |f: &FamilyFinding| {
        let level = f.level_g.map_or(String::new(), |g| format!(", up to {}", gravities(g)));
        let off_hz = f.offset_resolutions.unwrap_or(0.0) * resolution_hz;
        format!(
            "a carrier at {:.0} Hz ({off_hz:+.0} Hz from where the recorded motion puts it) with sidebands \
             every {spacing_hz:.1} Hz{level}",
            f.carrier_hz.unwrap_or(f64::NAN)
        )
        .replace('-', "−")
    };
    let mut said: Vec<String> = families
        .iter()
        .filter(|f| f.found)
        .map(|f| format!("The {} make {}.", f.spoken(), place(f)))
        .collect();
    if let Some(first) = families.iter().find(|f| !f.not_told_apart_from.is_empty()) {
        said.push(format!("The {} make {}; this record does not tell which.", first.spoken(), place(first)));
    }
    let is_named = !said.is_empty();
    for family in families.iter().filter(|f| f.is_open()) {
        said.push(format!(
            "Whether the {} make lines stays open: one stands {:.0} dB above its surroundings at {:.0} Hz, \
             where they would, and their comb explains no more than others.",
            family.spoken(),
            family.standing_db.unwrap_or(f64::NAN),
            family.predicted_hz.unwrap_or(f64::NAN)
        ));
    }
    let absent: Vec<String> = families
        .iter()
        .filter(|f| f.carrier_hz.is_none() && !f.is_open())
        .map(FamilyFinding::spoken)
        .collect();
    if said.is_empty() {
        return "No family of facet lines is there, neither in the accelerations nor in the roller forces."
            .into();
    }
    if !absent.is_empty() {
        said.push(format!("No lines of the {} are found.", absent.join(" or the ")));
    }
    if !is_named {
        return said.join(" ");
    }
    format!(
        "{} Facet lines are artefacts: a real bearing has none, and another mesh moves them.",
        said.join(" ")
    )
}

/// Text in place of the table of lines where the speed changes.
pub(in super::super) fn no_lines() -> Markup {
    html! { p class="hint" { "The speed changes, so that no line of the mesh or of the defect has a place \
    here: see " a href="#duty" { "Speed and load" } "." } }
}

/// Verdicts on the families, and their lines.
pub(super) fn table(summary: &Summary) -> Markup {
    if summary.unsteady().is_some() {
        return no_lines();
    }
    // A record too short for any of them has one reason, and no numbers.
    if let [first, others @ ..] = &summary.families[..]
        && summary.families.iter().all(|f| f.predicted_hz.is_none() && f.carrier_hz.is_none())
        && others.iter().all(|f| f.verdict == first.verdict)
    {
        return html! { p class="hint" { (first.verdict) "." } };
    }
    let hz = |v: Option<f64>| v.map(|v| format!("{v:.1}"));
    let verdicts = said_once(&summary.families, |f| &f.verdict);
    let head = html! {
        th { "Family of " (term("facet lines", FACET_LINES)) } th class="n" { "Predicted Hz" }
        th class="n" { (term("Middle line Hz", CARRIER)) } th class="n" { (term("Off its place", OFF)) }
        th class="n" { (term("± over channels", SCATTER)) } th class="n" { "Largest g" } th { "Verdict" }
    };
    let row = |(f, verdict): (&FamilyFinding, Markup)| {
        html! {
            td { (spoken(&f.name)) }
            (cell(hz(f.predicted_hz)))
            (cell(hz(f.carrier_hz)))
            (cell(f.offset_resolutions.map(|v| minus(format!("{v:+.1}")))))
            (cell(f.offset_scatter_resolutions.map(|v| format!("{v:.1}"))))
            (cell(f.level_g.map(|g| significant(g, 3))))
            (verdict)
        }
    };
    html! {
        (wide_table(Some("ledger"), &head, summary.families.iter().zip(verdicts).map(row)))
        p class="hint" {
            "Each family is a middle line (the carrier) with sidebands at multiples of BPFO on both sides. \
             These equally spaced lines (the comb) are fitted with the recorded motion of the rollers to \
             both components of every sensor and to the force on every loaded roller, and must explain them \
             clearly better than combs that are off their place and than the other families (THEORY §7.7)."
        }
        @if summary.families.iter().any(|f| f.carrier_hz.is_some()) {
            details {
                summary { "Lines of the families" }
                (lines(summary))
            }
        }
    }
}

/// Every line of the families that was found.
fn lines(summary: &Summary) -> Markup {
    let head = html! {
        th { "Sensor" } th { "Component" } th class="n" { "Sideband" } th class="n" { "Predicted Hz" }
        th class="n" { "Measured Hz" } th class="n" { "Level g" }
    };
    let row = |l: &FamilyLine| {
        html! {
            td { (l.sensor) } td { (l.component) }
            td class="n" { (minus(format!("{:+}", l.sideband))) }
            td class="n" { (format!("{:.1}", l.predicted_hz)) }
            (cell(l.measured_hz.map(|hz| format!("{hz:.1}"))))
            (cell(l.level_g.map(|g| significant(g, 3))))
        }
    };
    let lines = summary.families.iter().flat_map(|f| &f.lines).filter(|l| l.measured_hz.is_some());
    page::table(Some("close"), &head, lines.map(row))
}
