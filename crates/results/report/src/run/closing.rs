//! The end of the page: notes, and where the run comes from.

use std::fs;

use maud::{Markup, html};
use stribeck_analysis::summary::Summary;
use stribeck_store::run_info::{RunInfo, Topic};

use super::Subject;
use crate::page::{Section, sentence, with_code};

/// Notes of the analysis, and warnings of the run that concern its pictures.
pub(super) fn notes(of: &Subject<'_>) -> Section {
    let of_pictures = of.run.info.warned().filter(|(topic, _)| *topic == Some(Topic::Pictures));
    let of_pictures = of_pictures.map(|(_, words)| words);
    Section::new("notes", "Notes").folded("What else was noted on the way, and how to use the figures").after(html! {
        p class="hint" {
            "Figures: drag to zoom, double-click to reset; the wheel zooms with Ctrl or Shift. A click on a \
             name in a legend hides its curve."
        }
        ul class="notes" {
            @for note in of.findings.summary.notes.iter().chain(of_pictures) { li { (with_code(&sentence(note))) } }
        }
        p { "What limits the numbers stands beside the " a href="#summary" { "answer" } "." }
    })
}

/// Program, scene, machine and cost.
pub(super) fn provenance(of: &Subject<'_>) -> Section {
    // The scene as written, comments and all; a run without it has no report.
    let scene = fs::read_to_string(of.folder.join("scene.ron")).unwrap_or_default();
    Section::new("provenance", "Provenance")
        .folded("With which scene, program and machine was it made?")
        .after(html! {
            (table(&of.run.info, &of.findings.summary))
            details {
                summary { "The scene, with every default" }
                pre { (scene) }
            }
        })
}

/// Origin of the run, and its computing time.
fn table(info: &RunInfo, summary: &Summary) -> Markup {
    let run = &summary.run;
    let mesh = &info.mesh;
    let rows = [
        ("Program", format!("Stribeck {} ({})", info.version, info.commit)),
        ("Scene", format!("{}, hash {}", summary.scene, info.scene_hash)),
        ("Machine", format!("{}, {} threads", info.machine, info.threads)),
        (
            "Mesh",
            format!("{} nodes, {} quadrilaterals, {} triangles", mesh.nodes, mesh.quads, mesh.triangles),
        ),
        (
            "Facets",
            format!(
                "{} a roller, {} outer raceway, {} inner raceway",
                mesh.roller_facets, mesh.outer_facets, mesh.inner_facets
            ),
        ),
        (
            "Steps",
            format!(
                "{} of {} at {:.2} ns (critical {:.2} ns)",
                run.steps,
                run.steps_planned,
                run.time_step_ns,
                1e9 * info.critical_time_step_s
            ),
        ),
        (
            "On record",
            format!(
                "{} samples every {:.3} µs, {:.3} ms",
                run.samples,
                1e6 * info.interval_s,
                run.simulated_ms
            ),
        ),
        (
            "Cost",
            format!(
                "{:.1} s for the steps, {:.1} s to set up, {:.1} s of processor time{}",
                run.wall_s,
                run.setup_s,
                run.cpu_s,
                run.ns_per_element_step
                    .map_or(String::new(), |ns| format!("; {ns:.2} ns per element and step"))
            ),
        ),
    ];
    html! { table { tbody { @for (name, value) in rows { tr { th { (name) } td { (value) } } } } } }
}
