//! The tables of an ensemble's page.

use maud::{Markup, html};

use crate::page::{capital, cell, spoken, term, wide_table};
use crate::run::spectrum::families::OFF;
use stribeck_analysis::ensemble::{Ended, EnsembleFindings, EnsembleSummary, Merged, StartSummary};
use stribeck_analysis::quantity::Quantity;
use stribeck_analysis::statistic::{CONFIDENCE, Statistic};
use stribeck_analysis::summary::{Event, Summary};
use stribeck_diagnosis::words::numbers;

/// Relative width of its interval up to which a mean is shown with fewer decimals.
const WORTH: f64 = 0.1;

/// Phases of a record, as fields of `levels`, and in words.
pub(super) const PHASES: [(&str, &str); 5] = [
    ("start", "start-up"),
    ("entry", "entries"),
    ("defect", "in the defect"),
    ("exit", "exits"),
    ("gap", "gaps"),
];

/// How a number of a unit is shown: in which unit, times which factor, with how many decimals.
fn scale(unit: &'static str) -> (&'static str, f64, usize) {
    match unit {
        "N" => ("kN", 1e-3, 2),
        // Parts of one.
        "" => ("%", 100.0, 3),
        "s" => ("s", 1.0, 1),
        "g" => ("g", 1.0, 0),
        unit => (unit, 1.0, 3),
    }
}

/// `value` with a true minus sign.
pub(super) fn shown(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}").replace('-', "−")
}

/// `136 ± 8`: the mean and the half width of its interval.
pub(super) fn mean(s: &Statistic, factor: f64, decimals: usize) -> String {
    let mean = shown(factor * s.mean, decimals);
    match s.high {
        Some(high) => format!("{mean} ± {}", shown(factor.abs() * (high - s.mean), decimals)),
        None => mean,
    }
}

/// Decimals of a level: as many as given, or more where the interval of its mean, of a single start a tenth
/// of the level, is smaller than those show.
pub(super) fn decimals(s: &Statistic, least: usize) -> usize {
    const MOST: usize = 6;
    let half = s.high.map(|high| high - s.mean).filter(|half| *half > 1e-9 * s.mean.abs());
    let first = -half.unwrap_or(0.1 * s.mean.abs()).log10().floor();
    // Of zero there is no first digit.
    if first.is_finite() { (first.max(0.0) as usize).clamp(least, MOST) } else { least }
}

/// A level [g] with as many decimals.
pub(super) fn level(s: &Statistic, least: usize) -> String {
    mean(s, 1.0, decimals(s, least))
}

/// The numbers that an engineer asks for first.
pub(super) fn main(summary: &EnsembleSummary) -> Markup {
    if summary.count(Ended::Complete) == 0 {
        return html! {};
    }
    let sensor = summary.ensemble.text("levels.sensor").unwrap_or("none");
    let named = Summary::quantities().into_iter().filter(|of| of.words.is_some() && !of.is_listed);
    let named: Vec<Quantity> = named.collect();
    html! {
        div class="scroll" {
            table class="numbers" {
                thead {
                    tr {
                        th { "Quantity" } th class="n" { "Mean ± " (format!("{:.0} %", 100.0 * CONFIDENCE)) }
                        th class="n" { "10 % to 90 % of starts" } th class="n" { "Least to most" } th class="n" { "Scatter" }
                        th class="n" { "Starts for ±10 %" } th class="n" { "In" }
                    }
                }
                tbody {
                    (group(&format!("Acceleration a_y at sensor “{sensor}”"), summary, &named, "levels."))
                    (group("Forces", summary, &named, "load."))
                    (group("Motion", summary, &named, "kinematics."))
                    (group("Energy", summary, &named, "energy."))
                    (group("Cost", summary, &named, "run."))
                }
            }
        }
        p class="hint" {
            "± is the 95 % interval of the mean by Student's t: it narrows with more starts. 10 % to 90 % is \
             what a single start does. Scatter: standard deviation over mean. Every other number of the \
             summary is in summary.json, likewise."
        }
    }
}

/// The named numbers of a section of the summary.
fn group(name: &str, summary: &EnsembleSummary, named: &[Quantity], section: &str) -> Markup {
    let of_section = named.iter().filter(|quantity| quantity.path.starts_with(section));
    let known: Vec<(&Quantity, &Statistic)> =
        of_section.filter_map(|quantity| Some((quantity, summary.number(&quantity.path)?))).collect();
    html! {
        @if !known.is_empty() { tr class="group" { td colspan="7" { (name) } } }
        @for (quantity, s) in known {
            @let scatters = quantity.scatters();
            @let (unit, factor, least) = scale(quantity.unit());
            @let decimals = if scatters { decimals(s, least) } else { least };
            tr {
                td { (capital(quantity.words.unwrap_or_default())) " [" (unit) "]" }
                td class="n" { (mean(s, factor, decimals)) }
                td class="n" { (span(s.q10, s.q90, factor, decimals)) }
                td class="n" { (span(s.least, s.most, factor, decimals)) }
                (cell(s.deviation.filter(|_| scatters).map(|d| format!("{:.0} %", 100.0 * d / s.mean.abs()))))
                (cell(s.starts_for(WORTH).filter(|_| scatters).map(|n| n.to_string())))
                td class="n" { (s.count) "/" (s.of) }
            }
        }
    }
}

fn span(low: f64, high: f64, factor: f64, decimals: usize) -> String {
    format!("{} to {}", shown(factor * low, decimals), shown(factor * high, decimals))
}

/// Peaks by phase at every sensor.
pub(super) fn sensors(summary: &EnsembleSummary) -> Markup {
    let sensors = summary.ensemble.items("levels.sensors");
    if sensors.is_empty() {
        return html! {};
    }
    let of = |sensor: &Merged, component: Option<&str>, field: &str| {
        let path = format!("{field}_g");
        let found = match component {
            None => sensor.number(&path),
            Some(component) => sensor
                .items("components")
                .iter()
                .find(|c| c.text("component") == Some(component))
                .and_then(|c| c.number(&path)),
        };
        found.map(|s| level(s, 0))
    };
    let head =
        html! { th { "Sensor" } th { "Component" } @for (_, words) in PHASES { th class="n" { (words) } } };
    let components = [(None, "a_y"), (Some("radial"), "radial"), (Some("tangential"), "tangential")];
    let rows =
        sensors.iter().flat_map(|sensor| components.map(|(component, name)| (sensor, component, name)));
    let row = |(sensor, component, name): (&Merged, Option<&str>, &str)| {
        html! {
            td { (sensor.text("sensor").unwrap_or("–")) } td { (name) }
            @for (field, _) in PHASES { (cell(of(sensor, component, field))) }
        }
    };
    html! {
        h3 { "Peaks by phase at every sensor [g], mean ± 95 %" }
        (wide_table(None, &head, rows.map(row)))
    }
}

/// Verdicts on the families of facet lines.
pub(super) fn families(summary: &EnsembleSummary) -> Markup {
    let families = summary.ensemble.items("families");
    if families.is_empty() {
        return html! {};
    }
    let head = html! {
        th { "Family of facet lines" } th class="n" { "Found in" } th class="n" { "Predicted Hz" } th class="n" { "Carrier Hz" }
        th class="n" { (term("Off its place", OFF)) } th class="n" { "Largest g" }
    };
    let row = |family: &Merged| {
        html! {
            td { (spoken(family.text("name").unwrap_or("–"))) }
            (cell(share(family)))
            (cell(family.number("predicted_hz").map(|s| mean(s, 1.0, 1))))
            (cell(family.number("carrier_hz").map(|s| mean(s, 1.0, 1))))
            (cell(family.number("offset_resolutions").map(|s| mean(s, 1.0, 2))))
            (cell(family.number("level_g").map(|s| level(s, 1))))
        }
    };
    html! {
        (wide_table(Some("ledger"), &head, families.iter().map(row)))
        p class="hint" { "Each start is judged by itself, against its own recorded motion (THEORY §7.7); \
            shares with their 95 % interval." }
    }
}

/// `7/12 (32–81 %)` of the starts hold a family.
fn share(family: &Merged) -> Option<String> {
    let Some(Merged::Share(s)) = family.get("found") else { return None };
    if family.number("lead").is_none() {
        return Some("not judged".to_owned());
    }
    Some(format!("{}/{} ({:.0}–{:.0} %)", s.count, s.of, 100.0 * s.low, 100.0 * s.high))
}

/// The events of every roller that crosses the defect.
pub(super) fn events(findings: &EnsembleFindings) -> Markup {
    let summary = &findings.summary;
    let events = summary.ensemble.items("events");
    if events.is_empty() {
        return html! {};
    }
    let count = |event: &Merged, path: &str| event.number(path).map_or(0, |s| s.count);
    let first = |event: &Merged, of: fn(&Event) -> Option<f64>| {
        findings.over_events(&roller(event), of).map_or(0, |s| s.count)
    };
    let of = summary.count(Ended::Complete);
    let off = |event: &Merged, of: fn(&Event) -> Option<f64>| {
        findings.over_events(&roller(event), of).map(|s| mean(&s, 1.0, 3))
    };
    let head = html! {
        th { "Roller" } th class="n" { "#1 unloads" } th class="n" { "off ms" } th class="n" { "#2 floor" } th class="n" { "on oil" }
        th class="n" { "at ms" } th class="n" { "N" } th class="n" { "#3 neighbour" } th class="n" { "gain" } th class="n" { "#4 loaded" }
        th class="n" { "off ms" } th class="n" { "Impulse g" }
    };
    let row = |event: &Merged| {
        html! {
            td { (roller(event)) }
            td class="n" { (count(event, "entry_ms")) "/" (of) }
            (cell(off(event, Event::entry_off_ms)))
            td class="n" { (first(event, Event::impact_ms)) "/" (of) }
            td class="n" { (first(event, Event::landing_ms)) "/" (of) }
            (cell(event.number("floor_ms").map(|s| mean(s, 1.0, 2))))
            (cell(event.number("floor_n").map(|s| mean(s, 1.0, 0))))
            td class="n" { (count(event, "compensation_ms")) "/" (of) }
            (cell(event.number("compensation_gain").map(|s| mean(s, 1.0, 2))))
            td class="n" { (count(event, "exit_ms")) "/" (of) }
            (cell(off(event, Event::exit_off_ms)))
            (cell(event.number("impulse_g").map(|s| level(s, 0))))
        }
    };
    html! {
        (wide_table(None, &head, events.iter().map(row)))
        p class="hint" {
            "Starts that show the event, and means ± 95 % of those. On oil: the film stops the roller before \
             it reaches the floor. Off: after the centre would stand over the edge without slip. #3: what the \
             roller carries while a neighbour is in the defect, over what it carried before."
        }
    }
}

pub(super) fn roller(event: &Merged) -> String {
    match event.get("roller") {
        Some(Merged::Same(number)) => number.to_string(),
        _ => "–".to_owned(),
    }
}

/// The paper's measured numbers beside ours over the starts. Numbers that the paper prescribes are on the
/// page of any start.
pub(super) fn paper(summary: &EnsembleSummary) -> Markup {
    let measured = |row: &&Merged| row.text("part") != Some("Model") && row.number("ours_value").is_some();
    let mut part = "";
    let rows: Vec<(bool, &Merged)> = summary
        .ensemble
        .items("paper")
        .iter()
        .filter(measured)
        .map(|row| {
            let of = row.text("part").unwrap_or_default();
            (std::mem::replace(&mut part, of) != of, row)
        })
        .collect();
    html! {
        p class="hint" {
            "Singh et al. (2014), Numerical noise generation in modelled bearing vibration signals. It \
             prints neither thickness, cage pockets, damping nor the place of its sensor, so its levels are \
             no test of this model. Where a number is the same in every start, the page of any of them says \
             more."
        }
        div class="scroll" {
            table class="numbers" {
                thead {
                    tr {
                        th { "Quantity" } th class="n" { "Paper" } th class="n" { "Mean ± 95 %" } th class="n" { "10 % to 90 % of starts" } th class="n" { "In" }
                        th { "The paper's number lies" }
                    }
                }
                tbody {
                    @for (first, row) in rows {
                        @if first { tr class="group" { td colspan="6" { (row.text("part").unwrap_or_default()) } } }
                        (paper_row(row))
                    }
                }
            }
        }
    }
}

fn paper_row(row: &Merged) -> Markup {
    let Some(s) = row.number("ours_value") else { return html! {} };
    let unit = row.text("unit").unwrap_or_default();
    let decimals = match s.mean.abs() {
        m if m >= 100.0 => 0,
        m if m >= 1.0 => 2,
        _ => 4,
    };
    let place = row.number("paper_value").map(|paper| place(paper.mean, s));
    html! {
        tr {
            td { (row.text("quantity").unwrap_or_default()) }
            td class="n" { (row.text("paper").unwrap_or("–")) }
            td class="n" { (mean(s, 1.0, decimals)) " " (unit) }
            td class="n" { (shown(s.q10, decimals)) " to " (shown(s.q90, decimals)) }
            td class="n" { (s.count) "/" (s.of) }
            td class="why" { (place.unwrap_or("–")) }
        }
    }
}

/// Where a number lies among the starts.
fn place(number: f64, s: &Statistic) -> &'static str {
    // Values that agree to rounding in all starts are shown as one number.
    let same = (number - s.mean).abs() <= 1e-9 * s.mean.abs();
    match (s.low, s.high) {
        _ if same => "at ours",
        (Some(low), Some(high)) if (low..=high).contains(&number) => "in the interval of the mean",
        _ if (s.q10..=s.q90).contains(&number) => "among single starts, not at their mean",
        _ if (s.least..=s.most).contains(&number) => "at the edge of the starts",
        _ if number > s.most => "above every start",
        _ => "below every start",
    }
}

/// Every start: its drawn values, and how it ended.
pub(super) fn starts(summary: &EnsembleSummary) -> Markup {
    let ended = |ended: Ended| match ended {
        Ended::Complete => "complete",
        Ended::Diverged => "diverged",
        Ended::Early => "ended early",
        Ended::Failed => "failed",
        Ended::Missing => "not begun",
    };
    let head = html! {
        th { "Folder" } th class="n" { "Roller 1 at °" } th class="n" { "Phase °" } th { "Ended" } th class="n" { "Exit g" }
        th class="n" { "Gap g" } th class="n" { "Energy %" } th class="n" { "Wall s" } th class="n" { "Warnings" }
    };
    let row = |start: &StartSummary| {
        html! {
            td { a href={ (start.folder) "/scene.ron" } { (start.folder) } }
            (cell(start.first_roller_deg.map(|deg| shown(deg, 4))))
            (cell(start.roller_phase_deg.map(|deg| shown(deg, 4))))
            td { (ended(start.ended)) }
            (cell(start.exit_g.map(numbers::level)))
            (cell(start.gap_g.map(numbers::level)))
            (cell(start.energy_error.map(|e| shown(100.0 * e, 3))))
            (cell(start.wall_s.map(|s| shown(s, 1))))
            td class="n" { (start.warnings.len()) }
        }
    };
    html! {
        (wide_table(None, &head, summary.starts.iter().map(row)))
        p class="hint" {
            "A start is a run of its own: `stribeck report` in its folder makes its page, and `stribeck \
             simulate` with its scene.ron gives the same samples again. Places in the pockets stand in its \
             scene as `cage.roller_offsets_um`."
        }
    }
}

pub(super) fn provenance(findings: &EnsembleFindings) -> Markup {
    let ensemble = &findings.ensemble;
    let rows = [
        ("Program", format!("stribeck {} ({})", ensemble.version, ensemble.commit)),
        ("Seed", ensemble.seed.to_string()),
        ("Scene", ensemble.scene_hash.clone()),
        ("Starts asked for", ensemble.starts.to_string()),
        ("Complete", findings.complete.len().to_string()),
    ];
    html! { table class="pairs" { tbody { @for (name, value) in rows { tr { td { (name) } td { (value) } } } } } }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The page of a quiet ensemble said "gaps 0 ± 0 g".
    #[test]
    fn issue_quiet_levels_have_as_many_digits_as_their_scatter() {
        let of = |values: &[f64]| level(&Statistic::of(values, values.len()).expect("some"), 0);
        assert_eq!(of(&[130.0, 136.0, 142.0]), "136 ± 15");
        assert_eq!(of(&[0.030, 0.031, 0.032]), "0.031 ± 0.002");
        assert_eq!(of(&[0.031]), "0.031");
        assert_eq!((of(&[2.0, 2.0]), of(&[0.0, 0.0])), ("2.0 ± 0.0".into(), "0 ± 0".into()));
    }
}
