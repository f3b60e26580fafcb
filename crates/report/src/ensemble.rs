//! The page of an ensemble: the results of many starts of one scene.

mod answer;
mod figures;
mod strips;
mod tables;

use std::path::Path;

use maud::{DOCTYPE, Markup, html};
use stribeck_store::run_dir::{RunDir, write_atomic};

use crate::element_words::ElementWords;
use crate::figures::Item;
use crate::lead::lead;
use crate::page::{head, json, section, sentence, write_figures};
use crate::{Error, agreement};
use figures::Figures;
use stribeck_analysis::ensemble::{Ended, EnsembleFindings, EnsembleSummary};

/// Writes the report of the ensemble in `folder` into that folder and returns its numbers.
///
/// Starts that are not complete are named and do not count.
///
/// # Errors
/// As [`write`](super::write).
pub fn write_ensemble(folder: &Path) -> Result<EnsembleSummary, Error> {
    let findings = EnsembleFindings::of(folder)?;
    let dir = RunDir::open_ensemble(folder)?;
    write_atomic(&dir.summary(), json(&findings.summary)?.as_bytes())?;
    let figures = Figures::of(&findings);
    let all: Vec<&Item> = figures.all().collect();
    let words = ElementWords::of(&findings.scene.written);
    write_figures(&all, &dir.figures(), words)?;
    // The scene as written, comments and all; an ensemble without it was refused above.
    let scene = std::fs::read_to_string(dir.scene()).unwrap_or_default();
    let page = page(&findings, &figures, &scene, dir.path())?.into_string();
    write_atomic(&dir.report(), words.markup(page).as_bytes())?;
    Ok(findings.summary)
}

fn page(findings: &EnsembleFindings, figures: &Figures, scene: &str, folder: &Path) -> Result<Markup, Error> {
    let summary = &findings.summary;
    let (complete, asked) = (summary.count(Ended::Complete), summary.starts.len());
    let simulated_ms = findings.scene.written.solver.duration_ms;
    let first = findings.complete.first().map(|(_, first)| first);
    let paper = figures::paper_case(findings);
    let duty = first.and_then(|first| first.summary.duty.as_ref());
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            (head(&summary.scene))
            body {
                h1 { (summary.scene) ", " (asked) " starts" }
                p class="lead" { (lead(&findings.scene, duty, simulated_ms)) }
                @if complete < asked { (banner(summary, complete)) }
                (answer::paragraphs(findings))
                (contents(paper.is_some()))
                @if let Some(case) = &paper { (case.section(&figures.paper, all_numbers(summary))?) }
                (section("levels", "Levels", tables::main(summary), &figures.levels, tables::sensors(summary), "No start is complete.")?)
                (section("acceleration", "Acceleration", html! {}, &figures.acceleration, html! {}, "No sensor was recorded.")?)
                (section("spectra", "Spectrum", tables::families(summary), &figures.spectra, html! {}, "The records are too short for a spectrum.")?)
                (section("forces", "Contact forces and events", tables::events(findings), &figures.forces, html! {}, "No roller crosses a defect.")?)
                (agreement::of_run(&findings.scene.written, folder))
                h2 #starts { "Starts" }
                (tables::starts(summary))
                h2 #notes { "Notes" }
                @if summary.notes.is_empty() { p { "None." } }
                ul class="notes" { @for note in &summary.notes { li { (sentence(note)) } } }
                h2 #provenance { "Provenance" }
                (tables::provenance(findings))
                details {
                    summary { "The scene, with every default" }
                    pre { (scene) }
                }
            }
        }
    })
}

/// Every number of the paper's text, folded up.
fn all_numbers(summary: &EnsembleSummary) -> Markup {
    html! {
        details {
            summary { "Each number of the paper, and ours" }
            (tables::paper(summary))
        }
    }
}

fn banner(summary: &EnsembleSummary, complete: usize) -> Markup {
    let words = |(ended, words): &(Ended, &str)| match summary.count(*ended) {
        0 => None,
        count => Some(format!("{count} {words}")),
    };
    let others: Vec<String> = [
        (Ended::Diverged, "diverged"),
        (Ended::Failed, "failed"),
        (Ended::Early, "ended early"),
        (Ended::Missing, "not begun"),
    ]
    .iter()
    .filter_map(words)
    .collect();
    html! {
        div class="banner" role="alert" {
            strong { (complete) " of " (summary.starts.len()) " starts are complete" } ": " (others.join(", "))
            ". The numbers are those of complete starts."
        }
    }
}

fn contents(of_paper: bool) -> Markup {
    let entries = [
        ("summary", "Summary"),
        ("numbers", "The paper"),
        ("levels", "Levels"),
        ("acceleration", "Acceleration"),
        ("spectra", "Spectrum"),
        ("forces", "Forces and events"),
        ("starts", "Starts"),
        ("notes", "Notes"),
        ("provenance", "Provenance"),
    ];
    let shown = entries.into_iter().filter(|(id, _)| of_paper || *id != "numbers");
    html! { nav aria-label="Contents" { @for (id, name) in shown { a href={ "#" (id) } { (name) } } } }
}
