//! The page of a validation: the reduced model beside the full one, and the sentence in the report of a
//! reduced run that cites it.

use std::fs;
use std::path::Path;

use maud::{Markup, html};
use stribeck_scene::fields;
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_store::run_dir::write_atomic;

use crate::Error;
use crate::page::{Section, document, json, sentence};
use crate::plot::{Axis, Colour, Figure, Series};
use stribeck_analysis::agreement::{Agreement, Octaves, Row};

/// Name of the file in the folder of a validation.
const FILE: &str = "validation.json";
/// Fields by which a scene differs from a validated one that are listed by name.
const MOST_LISTED: usize = 6;

/// Writes `validation.json` and `report.html` into `folder`.
pub fn write_agreement(folder: &Path, agreement: &Agreement) -> Result<(), Error> {
    write_atomic(&folder.join(FILE), json(agreement)?.as_bytes())?;
    let figures = agreement.sensors.iter().map(|s| octaves(s).to_html()).collect::<Result<Vec<_>, _>>()?;
    let title = format!("{}: the reduced model beside the full one", agreement.scene);
    let page = document(
        &title,
        html! {
            h1 { (title) }
            p class="lead" { (lead(agreement)) }
            p { strong { (verdict(agreement)) } }
            (table(agreement))
            @for note in &agreement.notes { p class="hint" { (sentence(note)) } }
            @for figure in figures { (figure) }
        },
    );
    write_atomic(&folder.join("report.html"), page.into_string().as_bytes())?;
    Ok(())
}

fn lead(agreement: &Agreement) -> String {
    let [full, reduced, times] = agreement.cost();
    format!(
        "{} by both models, {:.0} ms each. A simulated millisecond takes {full} of processor time by the \
         full model and {reduced} by the reduced one: {times}.",
        starts(agreement.starts),
        agreement.simulated_ms
    )
}

fn starts(count: usize) -> String {
    if count == 1 { "One start".to_owned() } else { format!("{count} starts") }
}

fn verdict(agreement: &Agreement) -> String {
    let failures: Vec<&str> = agreement.failures().map(|row| row.quantity.as_str()).collect();
    let (all, open) = (agreement.rows.len(), agreement.open().count());
    let cannot = match open {
        0 => String::new(),
        _ => format!(" For {open} there are too few starts: the scatter may be larger than the limit."),
    };
    match failures.len() {
        0 if open == 0 => format!("All {all} quantities are within their limits."),
        0 => format!("{} of {all} quantities are within their limits, none is outside.{cannot}", all - open),
        n => format!("{n} of {all} quantities are not within their limits: {}.{cannot}", failures.join("; ")),
    }
}

fn table(agreement: &Agreement) -> Markup {
    html! {
        table {
            tr { th { "Quantity" } th { "Reduced less full" } th { "95 % interval, or range" } th { "Limit" } th { "Kept" } }
            @for row in &agreement.rows {
                tr {
                    td { (row.quantity) }
                    td { (format!("{:+.3} {}", row.difference.mean, row.scale.unit())) @if row.over_bands() { ", mean of the bands" } }
                    td { (interval(row)) }
                    td { (format!("{} {}", row.limit, row.scale.unit())) }
                    td { @if row.decided && !row.within { strong { "no" } } @else { (row.verdict(agreement.starts)) } }
                }
            }
        }
        p class="hint" {
            "Pairs of runs have the same start. Third octaves are levels of the mean power over the starts, \
             both components together, and their range is that of the bands. A limit is kept or not where \
             the interval, or twice the standard error of each band, leaves no other answer."
        }
        @if !agreement.correlations.is_empty() {
            p class="hint" { (alike(agreement)) }
        }
        (peaks(agreement))
    }
}

/// Largest accelerations, which have no limit.
fn peaks(agreement: &Agreement) -> Markup {
    let Some(first) = agreement.peaks.first() else { return html! {} };
    html! {
        table {
            tr { th { "Largest acceleration" } th { "Full, g" } th { "Reduced, g" } th { "Reduced less full" } }
            @for peak in &agreement.peaks {
                tr {
                    td { (peak.sensor) }
                    @for level in peak.levels() { td { (level) } }
                    td { (peak.difference()) }
                }
            }
        }
        p class="hint" {
            (format!(
                "Magnitude of both components below {:.0} kHz, as a recorder shows it: means of the largest \
                 of each start with their 95 % intervals, and how far the means are apart with one standard \
                 error. It has no limit, because it is that of a single impact. Above that the modes of the \
                 reduced model end, and peaks of raw samples do not compare.",
                1e-3 * first.below_hz
            ))
        }
    }
}

/// How alike waveforms are.
fn alike(agreement: &Agreement) -> String {
    let each = agreement
        .correlations
        .iter()
        .map(|c| format!("{:.2} below {:.1} kHz", c.value.mean, 1e-3 * c.below_hz));
    format!(
        "Waveforms of the first sensor, a_y, correlate by {}; above a few kilohertz the waveform of one \
         impact is chaotic in both models.",
        each.collect::<Vec<_>>().join(" and ")
    )
}

fn interval(row: &Row) -> String {
    row.range().map_or("one start".to_owned(), |[low, high]| format!("{low:+.3} to {high:+.3}"))
}

fn octaves(octaves: &Octaves) -> Figure {
    let hz: Vec<f64> = octaves.centres_hz.iter().map(|hz| hz.log10()).collect();
    let line = |name: &str, colour, y: &[f64]| Series::listed(name, colour, hz.clone(), y.to_vec());
    let id = format!(
        "octaves-{}",
        octaves.sensor.to_lowercase().replace(|c: char| !c.is_ascii_alphanumeric(), "-")
    );
    let mut figure = Figure::new(
        &id,
        &format!("Third octaves at {}", octaves.sensor),
        Axis::decades("Frequency", "Hz"),
        Axis::plain("Level", "dB re 1 g"),
    )
    .caption("Power of both components in third octaves, mean over the starts.")
    .with(line("full", Colour::Grey, &octaves.full_db))
    .with(line("reduced", Colour::Blue, &octaves.reduced_db));
    if let Some(largest) = octaves.error_db.iter().copied().reduce(f64::max) {
        figure = figure.note(format!(
            "By the scatter of the starts the difference is known to {largest:.1} dB at worst (one standard \
             error)."
        ));
    }
    figure
}

/// Error of a reduced run as far as it is known: from the validation in a neighbouring folder whose scene
/// differs least.
pub(super) fn section(scene: &Scene, run_dir: &Path) -> Option<Section> {
    if scene.model == ModelScene::Full {
        return None;
    }
    // The folder of a name alone is the present one.
    let beside = run_dir.parent().map(|p| if p.as_os_str().is_empty() { Path::new(".") } else { p });
    let found = beside.into_iter().flat_map(fs::read_dir).flatten().flatten().filter_map(|entry| {
        let agreement: Agreement = serde_json::from_slice(&fs::read(entry.path().join(FILE)).ok()?).ok()?;
        let other = Scene::read(entry.path().join("reduced/start-001/scene.ron")).ok()?;
        Some((differences(scene, &other), agreement))
    });
    let nearest = found.min_by_key(|(differences, agreement)| (differences.len(), agreement.scene.clone()));
    Some(Section::new("model", "Beside the full model").linked("The full model").folded("Do its forces agree with the full model?").after(html! {
        @match nearest {
            None => p {
                "This is a reduced model, and no validation of a scene like it lies beside the run. "
                code { "stribeck validate SCENE" } " runs both models from the same starts and says how far \
                    apart they are."
            },
            Some((differences, agreement)) => {
                p { (distance(&differences, &agreement)) " " (lead(&agreement)) " " strong { (verdict(&agreement)) } }
                (table(&agreement))
            }
        }
    }))
}

fn distance(differences: &[String], agreement: &Agreement) -> String {
    if differences.is_empty() {
        return format!("The nearest scene that was validated is this one ({}).", agreement.scene);
    }
    let listed = differences.iter().take(MOST_LISTED).cloned().collect::<Vec<_>>().join(", ");
    let more = differences.len().saturating_sub(MOST_LISTED);
    let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("The nearest scene that was validated, {}, differs in {listed}{rest}.", agreement.scene)
}

/// Fields in which two scenes differ, with this scene's value and the other's. Fields drawn for each start,
/// names, durations and guards do not count: they leave the model the same.
fn differences(scene: &Scene, other: &Scene) -> Vec<String> {
    const SAME_MODEL: [&str; 7] = [
        "name",
        "bearing.first_roller_deg",
        "mesh.roller_phase_deg",
        "cage.roller_offsets_um",
        "solver.duration_ms",
        "guards.",
        "output.",
    ];
    let counts = |field: &str| !SAME_MODEL.iter().any(|same| field.starts_with(same));
    let value = |value: Option<&Option<String>>| value.cloned().flatten().unwrap_or_default();
    fields::differences(&[Some(scene), Some(other)])
        .into_iter()
        .filter(|(field, _)| counts(field))
        .map(|(field, of)| format!("{field} ({} here, {} there)", value(of.first()), value(of.get(1))))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_scenes_differ_by_what_makes_another_model() {
        let scene = Scene::default();
        let mut other = scene.clone();
        other.name = "other".to_owned();
        other.solver.duration_ms *= 2.0;
        other.bearing.first_roller_deg += 0.1;
        assert!(differences(&scene, &other).is_empty());
        other.operation.load_n = 30_000.0;
        assert_eq!(differences(&scene, &other), ["operation.load_n (50000 here, 30000 there)"]);
        other.defect = None;
        assert_eq!(differences(&scene, &other).len(), 2);
    }
}
