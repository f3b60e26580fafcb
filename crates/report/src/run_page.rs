//! From a run directory to `report.html`, `summary.json` and figures. Nothing here simulates: the same
//! directory gives the same bytes.

use std::fs;
use std::ops::Range;
use std::path::Path;

use maud::{DOCTYPE, Markup, html};
use stribeck_analysis::defect::{Defect, Shocks};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_analysis::summary::Summary;
use stribeck_scene::scene::ModelScene;
use stribeck_store::run_dir::{LAB, Run, write_atomic};
use stribeck_store::run_info::Status;

use crate::element_words::ElementWords;
use crate::figures::{self, Figures, Item};
use crate::lead::lead;
use crate::page::{head, json, section, sentence, with_code, write_figures};
use crate::paper::PaperCase;
use crate::pictures::Pictures;
use crate::{Error, agreement, answer, moving, sections, sound, tables};

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
///
/// # Errors
/// As [`write`].
pub fn write_between(run_dir: &Path, time_s: Range<f64>) -> Result<Summary, Error> {
    let run = Run::read(run_dir)?;
    run.check_scene(run_dir)?;
    let record = Record::between(&run, time_s)?;
    let mut findings = Findings::of(&record)?.with_crossings(&record, figures::CROSSINGS)?;
    findings.summary.notes.splice(0..0, run.damage());
    let pictures = Pictures::of(&record, &findings, run_dir)?;
    findings.summary.notes.append(&mut pictures.notes.clone());
    write_atomic(&run_dir.join("summary.json"), json(&findings.summary)?.as_bytes())?;
    let mut figures = Figures::of(&record, &findings, pictures)?;
    if let Some(case) = PaperCase::of_run(&run.scene.written, &findings) {
        figures.paper = case.figures(figures.paper);
        // The same forces are its Fig. 8.
        figures.forces.clear();
    }
    let all: Vec<&Item> = figures.all().collect();
    let words = ElementWords::of(&run.scene.written);
    write_figures(&all, &run_dir.join("figures"), words)?;
    // The scene as written, comments and all; a run without it was refused above.
    let scene = fs::read_to_string(run_dir.join("scene.ron")).unwrap_or_default();
    let moving = moving::figure(&record, &findings)?;
    let page = page(&run, run_dir, &findings, &figures, moving.as_ref(), &scene)?.into_string();
    write_atomic(&run_dir.join("report.html"), words.markup(page).as_bytes())?;
    Ok(findings.summary)
}

fn page(
    run: &Run,
    run_dir: &Path,
    findings: &Findings,
    figures: &Figures,
    moving: Option<&Markup>,
    scene: &str,
) -> Result<Markup, Error> {
    let summary = &findings.summary;
    let family = findings.prediction.shocks.map_or(Defect::Bpfo.name(), Shocks::name);
    let paper = PaperCase::of_run(&run.scene.written, findings);
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            (head(&summary.scene))
            body {
                h1 { (summary.scene) }
                p class="lead" { (lead(&run.scene, summary.duty.as_ref(), summary.run.simulated_ms)) }
                (banner(run))
                (answer::paragraphs(run, findings))
                (contents([
                    moving.is_some(),
                    paper.is_some(),
                    summary.duty.is_some(),
                    run.scene.written.model != ModelScene::Full,
                ]))
                @if let Some(moving) = moving { h2 #motion { "The bearing in motion" } (moving) }
                (lab(run, run_dir))
                @if let Some(case) = &paper { (case.section(&figures.paper, all_numbers(summary))?) }
                (section("acceleration", "Acceleration", html! {}, &figures.acceleration, tables::levels(summary), "No sensor was recorded.")?)
                (sound::of_run(findings))
                @if summary.duty.is_some() { (section("duty", "Speed and load", html! {}, &figures.duty, sections::duty(summary), "The angle of the shaft was not recorded.")?) }
                (section("spectra", "Spectrum", html! {}, &figures.spectra, html! { (sections::envelope(summary, family)) (sections::diagnosis(summary)) h3 { "Lines of the mesh" } p { (answer::mesh(summary)) } (sections::families(summary)) }, "The record is too short for a spectrum.")?)
                (section("forces", "Contact forces and events", tables::events(summary), &figures.forces, sections::spall(run, summary), if paper.is_some() && !findings.crossings.is_empty() { "The forces over time stand above, as the paper's Fig. 8." } else { "No roller crosses a defect." })?)
                (section("bearing", "Load and slip", tables::kinematics(summary), &figures.bearing, tables::loads(summary, findings.prediction.standing_spalls().next().is_some()), "No roller was recorded.")?)
                (section("stress", "Mesh and stress", html! {}, &figures.stress, html! {}, "No frames were kept: see the notes.")?)
                (section("energy", "Energy", html! {}, &figures.energy, html! {}, "No energy was recorded.")?)
                h2 #artefacts { "All lines of the leading sensor" }
                details {
                    summary { "Each line, and what makes it" }
                    (sections::artefacts(summary))
                    (tables::notch(summary))
                }
                (agreement::of_run(&run.scene.written, run_dir))
                (closing(run, summary, scene))
            }
        }
    })
}

/// Links to all sections; those in motion, of the paper, of the duty and of the full model where there are
/// any.
fn contents([moving, of_paper, varies, reduced]: [bool; 4]) -> Markup {
    let entries = [
        ("summary", "Summary"),
        ("motion", "In motion"),
        ("numbers", "The paper"),
        ("acceleration", "Acceleration"),
        ("duty", "Speed and load"),
        ("spectra", "Spectrum"),
        ("forces", "Forces"),
        ("bearing", "Load and slip"),
        ("stress", "Mesh and stress"),
        ("energy", "Energy"),
        ("artefacts", "All lines"),
        ("model", "The full model"),
        ("notes", "Notes"),
        ("provenance", "Provenance"),
    ];
    let shown = entries.into_iter().filter(|(id, _)| match *id {
        "motion" => moving,
        "numbers" => of_paper,
        "duty" => varies,
        "model" => reduced,
        _ => true,
    });
    html! { nav aria-label="Contents" { @for (id, name) in shown { a href={ "#" (id) } { (name) } } } }
}

/// Every number of the paper's text, folded up.
fn all_numbers(summary: &Summary) -> Markup {
    html! {
        details {
            summary { "Each number of the paper, and ours" }
            (sections::paper(summary))
            (sections::readings(summary))
        }
    }
}

/// Links to the interactive page of a reduced run, or names the command that makes it.
fn lab(run: &Run, run_dir: &Path) -> Markup {
    if run.scene.written.model == ModelScene::Full {
        return html! {};
    }
    html! {
        p #lab {
            @if run_dir.join(LAB).is_file() {
                "This bearing runs in the " a href=(LAB) { "lab" } ": load, speed, spall, facets or arcs are \
                 turned there while it runs, in the browser."
            } @else {
                code { "stribeck report --lab " (run_dir.file_name().unwrap_or_default().display()) }
                " makes a page beside this one in which the bearing runs, with handles for load, speed, \
                 spall, facets or arcs."
            }
        }
    }
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

fn closing(run: &Run, summary: &Summary, scene: &str) -> Markup {
    html! {
        h2 #notes { "Notes" }
        p class="hint" {
            "Figures: drag to zoom, double-click to reset; the wheel zooms with Ctrl or Shift. A click on a \
             name in a legend hides its \
             curve."
        }
        ul class="notes" {
            @for note in &summary.notes { li { (with_code(&sentence(note))) } }
            @for note in run.info.warnings.iter().filter(|words| answer::is_of_pictures(words)) { li { (with_code(&sentence(note))) } }
        }
        p { "What limits the numbers stands beside the " a href="#summary" { "answer" } "." }
        h2 #provenance { "Provenance" }
        (tables::provenance(&run.info, summary))
        details {
            summary { "The scene, with every default" }
            pre { (scene) }
        }
    }
}
