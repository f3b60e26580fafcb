//! From a run directory to `report.html`, `summary.json` and figures. Nothing here simulates: the same
//! directory gives the same bytes.

mod agreement;
mod answer;
mod course;
mod ensemble;
mod figures;
mod measured;
mod pictures;
mod sections;
mod tables;
mod trend;

use std::fs;
use std::ops::Range;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::thread;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde::Serialize;
use stribeck_scene::deviation::DeviationScene;
use stribeck_scene::housing::HousingScene;
use stribeck_scene::ring_mesh::RingMeshScene;
use stribeck_scene::run_dir::{Run, write_atomic};
use stribeck_scene::run_info::Status;
use stribeck_scene::scene::{DefectRing, ModelScene, Scene};

pub use agreement::write_agreement;
pub use ensemble::write_ensemble;
pub use measured::write_measured;
pub use trend::{TrendEntry, write_trend};

use crate::duty::DutyFinding;
use crate::findings::Findings;
use crate::plot;
use crate::record::Record;
use crate::summary::Summary;
use crate::words::{kilonewtons, significant};
use crate::{
    Error,
    report::{
        figures::{Figures, Item},
        pictures::Pictures,
    },
};

/// Writes the report of the run in `run_dir` into that directory and returns its numbers.
///
/// An interrupted or diverged run gives a report of what exists, with a banner.
///
/// # Errors
/// [`Error::Run`] when the directory is not a run, its scene was changed, a file cannot be understood or the report cannot be written,
/// [`Error::Write`] when a figure cannot be written, [`Error::Signal`] and [`Error::Drawing`] when a recorded signal cannot be processed or drawn.
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
    let figures = Figures::of(&record, &findings, pictures)?;
    let all: Vec<&Item> = figures.all().collect();
    write_figures(&all, &run_dir.join("figures"))?;
    // The scene as written, comments and all; a run without it was refused above.
    let scene = fs::read_to_string(run_dir.join("scene.ron")).unwrap_or_default();
    let page = page(&run, run_dir, &findings, &figures, &scene)?.into_string();
    write_atomic(&run_dir.join("report.html"), page.as_bytes())?;
    Ok(findings.summary)
}

/// Writes every figure, on all cores.
fn write_figures(figures: &[&Item], folder: &Path) -> Result<(), Error> {
    fs::create_dir_all(folder).map_err(|why| Error::Write { path: folder.to_owned(), why })?;
    let figures = Mutex::new(figures.iter());
    let next = || figures.lock().unwrap_or_else(PoisonError::into_inner).next();
    let write_some = || std::iter::from_fn(next).try_for_each(|figure| write_figure(figure, folder));
    let cores = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        let others: Vec<_> = (1..cores).map(|_| scope.spawn(write_some)).collect();
        let mine = write_some();
        let of_others = others.into_iter().map(|other| other.join().unwrap_or_else(|why| resume_unwind(why)));
        of_others.fold(mine, Result::and)
    })
}

/// A figure as SVG and as PNG; one that moves as GIF too.
fn write_figure(figure: &Item, folder: &Path) -> Result<(), Error> {
    let write = |form: &str, bytes: &[u8]| {
        let path = folder.join(format!("{}.{form}", figure.id()));
        fs::write(&path, bytes).map_err(|why| Error::Write { path, why })
    };
    let svg = figure.to_svg()?;
    write("svg", svg.as_bytes())?;
    write("png", &plot::png(figure.id(), &svg)?)?;
    figure.animation().map_or(Ok(()), |gif| write("gif", gif))
}

/// `summary.json` with a final line end.
fn json(summary: &impl Serialize) -> Result<String, Error> {
    let text = serde_json::to_string_pretty(summary).map_err(Error::Summary)?;
    Ok(text + "\n")
}

fn page(
    run: &Run,
    run_dir: &Path,
    findings: &Findings,
    figures: &Figures,
    scene: &str,
) -> Result<Markup, Error> {
    let summary = &findings.summary;
    let family = findings.prediction.family.map_or("BPFO", |(name, _)| name);
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            (head(&summary.scene))
            body {
                h1 { (summary.scene) }
                p class="lead" { (lead(&run.scene, summary.duty.as_ref(), summary.run.simulated_ms)) }
                (banner(run))
                (answer::paragraphs(run, summary))
                (contents(findings.of_paper, run.scene.model != ModelScene::Full, summary.duty.is_some()))
                (section("acceleration", "Acceleration", html! {}, &figures.acceleration, tables::levels(summary), "No sensor was recorded.")?)
                @if summary.duty.is_some() { (section("duty", "Speed and load", html! {}, &figures.duty, sections::duty(summary), "The angle of the shaft was not recorded.")?) }
                (section("spectra", "Spectrum", sections::families(summary), &figures.spectra, html! { (sections::envelope(summary, family)) (sections::diagnosis(summary)) }, "The record is too short for a spectrum.")?)
                (section("forces", "Contact forces and events", tables::events(summary), &figures.forces, sections::spall(run, summary), "No roller crosses a defect.")?)
                (section("bearing", "Load and slip", tables::kinematics(summary), &figures.bearing, tables::loads(summary, findings.prediction.standing_spalls().next().is_some()), "No roller was recorded.")?)
                (section("stress", "Mesh and stress", html! {}, &figures.stress, html! {}, "No frames were kept: see the notes.")?)
                (section("energy", "Energy", html! {}, &figures.energy, html! {}, "No energy was recorded.")?)
                h2 #artefacts { "All lines of the leading sensor" }
                details {
                    summary { "Each line, and what makes it" }
                    (sections::artefacts(summary))
                    (tables::notch(summary))
                }
                (agreement::of_run(&run.scene, run_dir))
                @if findings.of_paper { (appendix(summary, figures)?) }
                (closing(run, summary, scene))
            }
        }
    })
}

/// What a page needs before its first word.
fn head(name: &str) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            // An empty picture keeps browsers from asking a server for an icon.
            link rel="icon" href="data:,";
            title { (name) " – Stribeck" }
            (plot::script())
            style { (PreEscaped(include_str!("../assets/report.css"))) }
        }
    }
}

fn contents(of_paper: bool, reduced: bool, varies: bool) -> Markup {
    let entries = [
        ("summary", "Summary"),
        ("acceleration", "Acceleration"),
        ("duty", "Speed and load"),
        ("spectra", "Spectrum"),
        ("forces", "Forces"),
        ("bearing", "Load and slip"),
        ("stress", "Mesh and stress"),
        ("energy", "Energy"),
        ("artefacts", "All lines"),
        ("model", "The full model"),
        ("numbers", "Appendix: the paper"),
        ("notes", "Notes"),
        ("provenance", "Provenance"),
    ];
    let shown = entries.into_iter().filter(|(id, _)| match *id {
        "numbers" => of_paper,
        "duty" => varies,
        "model" => reduced,
        _ => true,
    });
    html! { nav aria-label="Contents" { @for (id, name) in shown { a href={ "#" (id) } { (name) } } } }
}

/// The paper's numbers and the figures that only it needs, for a scene of its dimensions.
fn appendix(summary: &Summary, figures: &Figures) -> Result<Markup, Error> {
    let drawn = figures.paper.iter().map(Item::to_html).collect::<Result<Vec<_>, _>>()?;
    Ok(html! {
        h2 #numbers { "Appendix: the paper beside this run" }
        p class="hint" {
            "Singh et al. (2014), Numerical noise generation in modelled bearing vibration signals. It prints neither thickness, cage \
             pockets, damping nor the place of its sensor, so its levels are no test of this model."
        }
        details {
            summary { "Each number of the paper, and ours" }
            (sections::paper(summary))
            (sections::readings(summary))
        }
        @for figure in drawn { (figure) }
    })
}

/// The sentence under the title.
fn lead(scene: &Scene, duty: Option<&DutyFinding>, simulated_ms: f64) -> String {
    let of_defect = scene.defect.as_ref().map(|d| {
        let ring = match d.ring {
            DefectRing::Outer => "outer",
            DefectRing::Inner => "inner",
        };
        format!("a spall of {} × {} mm on the {ring} raceway", d.length_mm, d.depth_mm)
    });
    let all: Vec<String> =
        of_defect.into_iter().chain(scene.defects.iter().map(DeviationScene::spoken)).collect();
    let defect = match all.len() {
        0 => "sound raceways".to_owned(),
        1..=3 => all.join(", "),
        more => format!("{} and {} more deviations", all[..2].join(", "), more - 2),
    };
    let name = match scene.bearing.designation.as_str() {
        "" => String::new(),
        name => format!("{name}: "),
    };
    format!(
        "{name}{} rollers{} under {} at {}, {defect}; {:.1} ms on record.",
        scene.rollers_in_place().count(),
        own_rings(scene) + &housing(scene),
        load(scene, duty),
        speed(scene, duty),
        simulated_ms
    )
}

/// Rings from files, in words.
fn own_rings(scene: &Scene) -> String {
    let rings = [("outer", &scene.outer_ring_mesh), ("inner", &scene.inner_ring_mesh)];
    let of_file = |(ring, mesh): (&str, &Option<RingMeshScene>)| {
        let file = Path::new(&mesh.as_ref()?.file).file_stem().unwrap_or_default().display().to_string();
        Some(format!(" with an {ring} ring from a file ({file})"))
    };
    rings.into_iter().filter_map(of_file).collect()
}

/// What holds the outer ring, in words, where it is not the adapter.
fn housing(scene: &Scene) -> String {
    match &scene.housing {
        HousingScene::Adapter => String::new(),
        HousingScene::Pedestal(_) => " in a pedestal".to_owned(),
        HousingScene::Mesh(housing) => {
            format!(" in a housing ({})", Path::new(&housing.file).file_stem().unwrap_or_default().display())
        }
        HousingScene::Rigid(_) => " in a rigid housing".to_owned(),
        HousingScene::Springs(springs) => {
            format!(" in a housing on springs of {} N/µm", springs.stiffness_n_um)
        }
    }
}

/// The load in words, with its range on record where it changes.
fn load(scene: &Scene, duty: Option<&DutyFinding>) -> String {
    match duty {
        Some(duty) if duty.load_n.0 != duty.load_n.1 => {
            format!("{} to {}", significant(1e-3 * duty.load_n.0, 4), kilonewtons(duty.load_n.1))
        }
        _ => kilonewtons(scene.operation.load_n),
    }
}

/// The speed in words, with its range on record where it changes, and the sense where it is not the usual one.
fn speed(scene: &Scene, duty: Option<&DutyFinding>) -> String {
    let o = &scene.operation;
    let [inner, outer] = match duty {
        Some(duty) if o.speed_varies() => [duty.speed_rpm, duty.outer_speed_rpm],
        _ => [(o.speed_rpm, o.speed_rpm), (o.outer_speed_rpm, o.outer_speed_rpm)],
    };
    let inner = of_ring(inner);
    if !o.outer_turns() {
        return inner;
    }
    format!("{inner} of the inner and {} of the outer ring", of_ring(outer))
}

/// Least and largest speed of one ring in words.
fn of_ring((least, most): (f64, f64)) -> String {
    let varies = least != most;
    let rpm = |rpm: f64| if varies { significant(rpm, 4) } else { rpm.to_string() };
    let span = |a: f64, b: f64| {
        if varies { format!("{} to {} rpm", rpm(a), rpm(b)) } else { format!("{} rpm", rpm(a)) }
    };
    if most <= 0.0 && least < 0.0 {
        format!("{} counter-clockwise", span(-most, -least))
    } else if least < 0.0 {
        format!("{} (negative: counter-clockwise)", span(least, most).replace('-', "−"))
    } else {
        span(least, most)
    }
}

/// Says loudly when a run did not complete.
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

/// A heading, what stands before the figures, the figures (`otherwise` when there are none) and what stands after them.
fn section(
    id: &str,
    name: &str,
    before: Markup,
    items: &[Item],
    after: Markup,
    otherwise: &str,
) -> Result<Markup, Error> {
    let drawn = items.iter().map(Item::to_html).collect::<Result<Vec<_>, _>>()?;
    Ok(html! {
        h2 id=(id) { (name) }
        (before)
        @if drawn.is_empty() { p { (otherwise) } }
        @for figure in drawn { (figure) }
        (after)
    })
}

fn closing(run: &Run, summary: &Summary, scene: &str) -> Markup {
    html! {
        h2 #notes { "Notes" }
        p class="hint" {
            "Figures: drag to zoom, double-click to reset; the wheel zooms with Ctrl or Shift. A click on a name in a legend hides its \
             curve."
        }
        @if summary.notes.is_empty() && run.info.warnings.is_empty() { p { "None." } }
        ul class="notes" {
            @for note in &summary.notes { li { (sentence(note)) } }
            @for warning in &run.info.warnings { li { "Warning of the run: " (warning) } }
        }
        h2 #provenance { "Provenance" }
        (tables::provenance(&run.info, summary))
        details {
            summary { "The scene, with every default" }
            pre { (scene) }
        }
    }
}

/// A note with a capital and a full stop.
fn sentence(note: &str) -> String {
    let mut letters = note.chars();
    let first: String = letters.next().map(|c| c.to_uppercase().collect()).unwrap_or_default();
    let stop = if note.ends_with('.') { "" } else { "." };
    format!("{first}{}{stop}", letters.as_str())
}
