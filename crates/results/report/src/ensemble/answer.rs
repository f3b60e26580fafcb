//! The summary at the head of the page: calibrated values, predictions, and the scatter between starts.

use maud::{Markup, html};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::ModelScene;

use super::strips::Time;
use super::tables::{decimals, mean, shown};
use stribeck_analysis::ensemble::{Ended, EnsembleFindings, EnsembleSummary, Merged};
use stribeck_analysis::quantity::Quantity;
use stribeck_analysis::summary::{Event, Summary};

/// The first paragraphs of the page.
pub(super) fn paragraphs(findings: &EnsembleFindings) -> Markup {
    let summary = &findings.summary;
    let of_paper = findings.complete.first().is_some_and(|(_, first)| first.of_paper);
    html! {
        div #summary class="answer" {
            p { strong { "Calibrated. " } (calibrated(&findings.scene, of_paper)) }
            p { strong { "Predicted. " } (predicted(summary)) }
            p { strong { "Scatter of starts. " } (scatter(summary)) }
            p { strong { "Events. " } (events(findings)) }
        }
    }
}

/// Values that were calibrated.
fn calibrated(scene: &ResolvedScene, of_paper: bool) -> String {
    let (contact, solver) = (&scene.written.contact, &scene.written.solver);
    let mut chosen = vec![
        format!("an out-of-plane thickness of {} mm", scene.written.bearing.thickness_mm),
        format!("a contact stiffness of {} E over the element size", contact.penalty_scale),
        format!("a contact damping of {} % of critical", 100.0 * contact.damping_ratio),
    ];
    if let ModelScene::Reduced(reduced) = &scene.written.model {
        chosen.push(format!("modes up to {} kHz in steps of {} µs", reduced.modes_khz, reduced.step_us));
    }
    if solver.mass_damping_per_s > 0.0 {
        chosen.push(format!("a mass damping of {} per second", solver.mass_damping_per_s));
    }
    if let Some(damping) = &solver.structural_damping {
        let (from, to) = (damping.from_khz, damping.to_khz);
        chosen.push(format!("a structural damping of {} % from {from} to {to} kHz", damping.ratio_percent));
    }
    if let Some(film) = &scene.written.film {
        chosen.push(format!("oil of {} Pa s", film.viscosity_pa_s));
    }
    if solver.stiffness_damping_ns > 0.0 {
        chosen.push(format!("a stiffness damping of {} ns", solver.stiffness_damping_ns));
    }
    if let Some(cage) = &scene.written.cage {
        chosen.push(format!("{} µm of room in the pockets", cage.pocket_clearance_um));
    }
    let last = chosen.pop().unwrap_or_default();
    let source = if of_paper {
        "The paper prints none of them; a level in g that meets the paper's is agreement by choice, and no \
         test"
    } else {
        "Levels in g depend on all of them"
    };
    format!("The scene chooses {} and {last}. {source}.", chosen.join(", "))
}

/// Results that nothing was calibrated to.
fn predicted(summary: &EnsembleSummary) -> String {
    let beside = |path: &str, factor: f64, decimals: usize, words: &str| {
        summary
            .number(path)
            .map_or(String::new(), |s| format!(" ({} {words})", shown(factor * s.mean, decimals)))
    };
    let families = summary.ensemble.items("families");
    let mut said = Vec::new();
    for family in families {
        let Some((carrier, found)) = family.number("carrier_hz").zip(yes(family.get("found"))) else {
            continue;
        };
        let name = family.text("name").unwrap_or_default().replace('_', " ");
        let expected = family.number("predicted_hz").map_or(f64::NAN, |s| s.mean);
        said.push(format!(
            "{name} sound at {} Hz in {found} starts ({} by the recorded motion)",
            mean(carrier, 1.0, 0),
            shown(expected, 0)
        ));
    }
    if let Some(bpfo) = summary.number("kinematics.bpfo_hz") {
        let without_slip = beside("kinematics.expected_bpfo_hz", 1.0, 2, "without slip");
        said.push(format!("rollers pass at {} Hz{without_slip}", mean(bpfo, 1.0, 2)));
    }
    if let Some(force) = summary.number("load.max_roller_n") {
        let at_rest = beside("load.static_max_roller_defect_n", 1e-3, 2, "between rigid rings at rest");
        said.push(format!("the most loaded roller carries {} kN{at_rest}", mean(force, 1e-3, 2)));
    }
    if said.is_empty() {
        return "There is no complete start.".into();
    }
    let short = !families.is_empty() && families.iter().all(|f| f.number("lead").is_none());
    let tone = if short { " The records are too short to tell families of facet lines." } else { "" };
    let energy = summary.number("energy.share_of_contacts").map_or(String::new(), |s| {
        format!(" Energy is off by {:.2} % of what contacts dissipate in the worst start.", 100.0 * s.most)
    });
    format!("Adjusted to nothing: {}.{tone}{energy}", said.join("; "))
}

/// Uncertainty of a single start, and of the mean.
fn scatter(summary: &EnsembleSummary) -> String {
    let complete = summary.count(Ended::Complete);
    if complete < 2 {
        return "It takes two complete starts to tell.".into();
    }
    let of = |quantity: Quantity| {
        let s = summary.number(&quantity.path)?;
        let needed = s.starts_for(0.1).map_or(String::new(), |n| format!("; {n} starts for ±10 %"));
        let decimals = decimals(s, 0);
        Some(format!(
            "{} {} g (one start: {} to {} g, {:.0} % scatter{needed})",
            quantity.words?,
            mean(s, 1.0, decimals),
            shown(s.q10, decimals),
            shown(s.q90, decimals),
            100.0 * s.deviation? / s.mean
        ))
    };
    let sensor = summary.ensemble.text("levels.sensor").unwrap_or("none");
    let levels: Vec<String> =
        Summary::main_quantities().into_iter().filter(Quantity::scatters).filter_map(of).collect();
    let carrier = summary.ensemble.items("families").iter().find_map(|f| f.number("carrier_hz"));
    let line = carrier
        .and_then(|s| s.deviation)
        .map_or(String::new(), |d| format!(" The tone's frequency scatters by {} Hz.", shown(d, 1)));
    format!(
        "Levels of a_y at sensor “{sensor}”, mean of {complete} starts ± 95 %: {}.{line} What differs by less \
         than the intervals is no difference.",
        levels.join("; ")
    )
}

/// The share of starts that have each event, by roller.
fn events(findings: &EnsembleFindings) -> String {
    let summary = &findings.summary;
    let events = summary.ensemble.items("events");
    if events.is_empty() {
        return "No roller crosses a defect.".into();
    }
    let complete = summary.count(Ended::Complete);
    let kinds: [(Time, &str); 5] = [
        (|e| e.entry_ms, "unloads (#1)"),
        (Event::impact_ms, "strikes the floor (#2)"),
        (Event::landing_ms, "lands on oil there"),
        (|e| e.compensation_ms, "carries for a neighbour (#3)"),
        (|e| e.exit_ms, "is loaded again (#4)"),
    ];
    let of_roller = |event: &Merged| {
        let roller = super::tables::roller(event);
        let count = |of| findings.over_events(&roller, of).map_or(0, |s| s.count);
        let said: Vec<String> =
            kinds.iter().map(|(of, words)| format!("{words} in {}", count(*of))).collect();
        format!("roller {roller} {}", said.join(", "))
    };
    let rollers: Vec<String> = events.iter().take(3).map(of_roller).collect();
    format!("Of {complete} starts: {}.", rollers.join("; "))
}

/// `11 of 12`.
fn yes(found: Option<&Merged>) -> Option<String> {
    match found {
        Some(Merged::Share(s)) if s.count > 0 => Some(format!("{} of {}", s.count, s.of)),
        _ => None,
    }
}
