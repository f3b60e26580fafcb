//! The page of a run: from a run directory to `report.html`, `summary.json` and figures. Nothing here
//! simulates: the same directory gives the same bytes.
//!
//! The sections stand in the order of the page; each is a file or a folder that makes its figures, tables
//! and words.

mod answer;
pub(crate) mod lead;

mod motion;

pub(crate) mod paper;

mod acceleration;

mod duty;

pub(crate) mod spectrum;

mod forces;

mod load;

mod stress;

mod energy;

mod lines;

mod closing;

mod drawing;

use std::ops::Range;
use std::path::Path;

use maud::{Markup, html};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_analysis::summary::Summary;
use stribeck_scene::scene::ModelScene;
use stribeck_store::run_dir::{LAB, Run, RunDir, write_atomic};
use stribeck_store::run_info::Status;

use crate::element_words::ElementWords;
use crate::page::{Item, Section, contents, document, json, write_figures};
use crate::{Error, agreement};
use paper::PaperCase;

/// A run, and what is known of it.
struct Subject<'a> {
    run: &'a Run,
    folder: &'a Path,
    record: &'a Record<'a>,
    findings: &'a Findings,
    /// Where it is the paper's bearing.
    paper: Option<PaperCase<'a>>,
}

/// Writes the report of the run in `run_dir` into that directory and returns its numbers.
///
/// An interrupted or diverged run gives a report of what exists, with a banner.
///
/// # Errors
/// [`Error::Run`] when the directory is not a run, its scene was changed, a file cannot be understood or the
/// report cannot be written, [`Error::Write`] when a figure cannot be written, [`Error::Signal`] and
/// [`Error::Drawing`] when a recorded signal cannot be processed or drawn.
pub fn write(run_dir: &Path) -> Result<Summary, Error> {
    write_between(run_dir, f64::NEG_INFINITY..f64::INFINITY)
}

/// The same of a stretch of time [s].
pub fn write_between(run_dir: &Path, time_s: Range<f64>) -> Result<Summary, Error> {
    let run = Run::read(run_dir)?;
    run.check_scene(run_dir)?;
    let record = Record::between(&run, time_s)?;
    let mut findings = Findings::of(&record)?.with_crossings(&record, forces::DRAWN)?;
    findings.summary.notes.splice(0..0, run.damage());
    let (stress, mut missing) = stress::section(&record, &findings, run_dir)?;
    findings.summary.notes.append(&mut missing);
    let paper = PaperCase::of_run(&run.scene.written, &findings);
    let subject = Subject { run: &run, folder: run_dir, record: &record, findings: &findings, paper };
    let sections = sections(&subject, stress)?;
    let figures: Vec<&Item> = sections.iter().flat_map(|section| &section.figures).collect();
    let words = ElementWords::of(&run.scene.written);
    let (numbers, page) = (json(&findings.summary)?, page(&subject, &sections)?.into_string());
    let dir = RunDir::open(run_dir)?;
    dir.begin_report()?;
    write_figures(&figures, &dir.figures(), words)?;
    write_atomic(&dir.report(), words.markup(page).as_bytes())?;
    // The last of its files: with it the run is reported.
    write_atomic(&dir.summary(), numbers.as_bytes())?;
    Ok(findings.summary)
}

/// All sections that the run has, in the order of the page.
fn sections(of: &Subject<'_>, stress: Section) -> Result<Vec<Section>, Error> {
    let sections = [
        motion::section(of)?,
        lab(of),
        of.paper.as_ref().map(|case| paper::section(case, &of.findings.summary)),
        Some(acceleration::section(of)?),
        duty::section(of),
        Some(spectrum::section(of)?),
        Some(forces::section(of)),
        Some(load::section(of)?),
        Some(stress),
        Some(energy::section(of.run)?),
        Some(lines::section(&of.findings.summary)),
        agreement::section(&of.run.scene.written, of.folder),
        Some(closing::notes(of)),
        Some(closing::provenance(of)),
    ];
    Ok(sections.into_iter().flatten().collect())
}

fn page(of: &Subject<'_>, sections: &[Section]) -> Result<Markup, Error> {
    let summary = &of.findings.summary;
    let drawn = sections.iter().map(Section::markup).collect::<Result<Vec<_>, _>>()?;
    Ok(document(
        &summary.scene,
        html! {
            h1 { (summary.scene) }
            p class="lead" { (lead::lead(&of.run.scene, summary.duty.as_ref(), summary.run.simulated_ms)) }
            (banner(of.run))
            (answer::first_screen(of, sections)?)
            (contents(sections))
            @for section in drawn { (section) }
        },
    ))
}

/// Links to the interactive page of a reduced run, or names the command that makes it.
fn lab(of: &Subject<'_>) -> Option<Section> {
    if of.run.scene.written.model == ModelScene::Full {
        return None;
    }
    Some(Section::text(html! {
        p #lab {
            @if of.folder.join(LAB).is_file() {
                "This bearing runs in the " a href=(LAB) { "lab" } ": load, speed, spall, facets or arcs are \
                 turned there while it runs, in the browser."
            } @else {
                code { "stribeck report --lab " (of.folder.file_name().unwrap_or_default().display()) }
                " makes a page beside this one in which the bearing runs, with handles for load, speed, \
                 spall, facets or arcs."
            }
        }
    }))
}

/// A banner for a run that did not complete.
fn banner(run: &Run) -> Markup {
    let what = match run.info.status {
        Status::Complete => return html! {},
        Status::Running => "This run is still going, or was killed.",
        Status::Interrupted => "This run was interrupted.",
        Status::Diverged => "This run diverged and was stopped.",
    };
    let why = run.info.stop_reason.as_deref().unwrap_or_default();
    html! {
        div class="banner" role="alert" {
            strong { (what) } " " (why) @if !why.is_empty() { ". " } "The report shows what exists: "
            (run.info.steps) " of " (run.info.steps_planned) " steps."
        }
    }
}
