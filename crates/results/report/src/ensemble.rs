//! The page of an ensemble: the results of many starts of one scene.

mod answer;
mod figures;
mod strips;
mod tables;

use std::path::Path;

use maud::{Markup, html};
use stribeck_store::run_dir::{RunDir, write_atomic};

use crate::element_words::ElementWords;
use crate::page::{Item, Section, banner, charts, contents, document, drawn, json, sentence, write_figures};
use crate::run::lead::lead;
use crate::{Error, agreement};
use stribeck_analysis::ensemble::{Ended, EnsembleFindings, EnsembleSummary};

/// Writes the report of the ensemble in `folder` into that folder and returns its numbers.
///
/// Starts that are not complete are named and do not count.
pub fn write_ensemble(folder: &Path) -> Result<EnsembleSummary, Error> {
    let findings = EnsembleFindings::of(folder)?;
    let dir = RunDir::open_ensemble(folder)?;
    let sections = sections(&findings, &dir);
    let figures: Vec<&Item> = sections.iter().flat_map(|section| &section.figures).collect();
    let words = ElementWords::of(&findings.scene.written);
    let (numbers, page) = (json(&findings.summary)?, page(&findings, &sections)?.into_string());
    dir.begin_report()?;
    write_figures(&figures, &dir.figures(), words)?;
    write_atomic(&dir.report(), words.markup(page).as_bytes())?;
    // The last of its files: with it the ensemble is reported.
    write_atomic(&dir.summary(), numbers.as_bytes())?;
    Ok(findings.summary)
}

fn page(findings: &EnsembleFindings, sections: &[Section]) -> Result<Markup, Error> {
    let summary = &findings.summary;
    let (complete, asked) = (summary.count(Ended::Complete), summary.starts.len());
    let simulated_ms = findings.scene.written.solver.duration_ms;
    let first = findings.complete.first().map(|(_, first)| first);
    let duty = first.and_then(|first| first.summary.duty.as_ref());
    let drawn = sections.iter().map(Section::markup).collect::<Result<Vec<_>, _>>()?;
    Ok(document(
        &summary.scene,
        html! {
            h1 { (summary.scene) ", " (asked) " starts" }
            p class="lead" { (lead(&findings.scene, duty, simulated_ms)) }
            @if complete < asked { (incomplete(summary, complete)) }
            (answer::paragraphs(findings))
            (contents(sections))
            @for section in drawn { (section) }
        },
    ))
}

fn sections(findings: &EnsembleFindings, dir: &RunDir) -> Vec<Section> {
    let summary = &findings.summary;
    // The scene as written, comments and all; an ensemble without it was refused above.
    let scene = std::fs::read_to_string(dir.scene()).unwrap_or_default();
    let notes = html! {
        @if summary.notes.is_empty() { p { "None." } }
        ul class="notes" { @for note in &summary.notes { li { (sentence(note)) } } }
    };
    let provenance = html! {
        (tables::provenance(findings))
        details {
            summary { "The scene, with every default" }
            pre { (scene) }
        }
    };
    let forces = drawn(strips::events(findings)).chain(charts(figures::forces(findings)));
    let sections = [
        figures::paper_case(findings).map(|case| case.section(tables::paper(summary))),
        Some(
            Section::new("levels", "Levels")
                .before(tables::main(summary))
                .figures(drawn(strips::levels(findings)), "No start is complete.")
                .after(tables::sensors(summary)),
        ),
        Some(
            Section::new("acceleration", "Acceleration")
                .figures(charts(figures::acceleration(findings)), "No sensor was recorded."),
        ),
        Some(
            Section::new("spectra", "Spectrum")
                .before(tables::families(summary))
                .figures(charts(figures::spectra(findings)), "The records are too short for a spectrum."),
        ),
        Some(
            Section::new("forces", "Contact forces and events")
                .linked("Forces and events")
                .before(tables::events(findings))
                .figures(forces, "No roller crosses a defect."),
        ),
        agreement::section(&findings.scene.written, dir.path()).map(|section| section.linked("")),
        Some(Section::new("starts", "Starts").after(tables::starts(summary))),
        Some(Section::new("notes", "Notes").after(notes)),
        Some(Section::new("provenance", "Provenance").after(provenance)),
    ];
    sections.into_iter().flatten().collect()
}

fn incomplete(summary: &EnsembleSummary, complete: usize) -> Markup {
    let ends = [
        (Ended::Diverged, "diverged"),
        (Ended::Failed, "failed"),
        (Ended::Early, "ended early"),
        (Ended::Missing, "not begun"),
    ];
    let others = ends.map(|(ended, words)| (words, summary.count(ended)));
    banner((complete, summary.starts.len()), "starts", others, "The numbers are those of complete starts.")
}
