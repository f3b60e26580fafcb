//! Load and slip: how the load is shared, what the rollers carry together, and how far they roll.

mod polar;
mod slip;

use maud::{Markup, html};
use stribeck_analysis::film::FilmFinding;
use stribeck_analysis::findings::Findings;
use stribeck_analysis::kinematics::RollerMotion;
use stribeck_analysis::summary::Summary;
use stribeck_scene::resolved::ResolvedScene;

use super::Subject;
use crate::Error;
use crate::page::{Section, cell, charts, drawn, minus, pairs, table};
use crate::plot::{Axis, Band, Colour, Figure, Level, Series};

pub(super) fn section(of: &Subject<'_>) -> Result<Section, Error> {
    let (scene, findings) = (&of.run.scene, of.findings);
    let charts = charts(distribution(scene, findings).into_iter().chain(sums(of)).chain(slip::figures(of)?));
    let over_spall = findings.prediction.standing_spalls().next().is_some();
    Ok(Section::new("bearing", "Load and slip")
        .folded("How is the load shared, and do rolling elements and cage slip?")
        .before(kinematics(&findings.summary))
        .figures(drawn(polar::picture(scene, findings)).chain(charts), "No roller was recorded.")
        .after(loads(&findings.summary, over_spall)))
}

/// Mean force by the place of a roller; `None` without recorded rollers.
fn distribution(scene: &ResolvedScene, findings: &Findings) -> Option<Figure> {
    let dynamic = &findings.distribution;
    if dynamic.mean_n.iter().all(|f| f.is_nan()) {
        return None;
    }
    let spalled = findings.prediction.standing_spalls().next().is_some();
    let mut figure = Figure::new(
        "load-distribution",
        "Load distribution",
        Axis::angle("Angle from the x axis, counter-clockwise"),
        Axis::si("Outer-raceway force", "N"),
    )
    .with(Series::listed(
        "dynamic, mean by angle",
        Colour::Blue,
        dynamic.angle_deg.clone(),
        dynamic.mean_n.clone(),
    ))
    .caption(format!(
        "Mean force on a roller by its place{} beside rigid rings at rest.",
        if spalled {
            ": over the defect it carries less, its neighbours take over, and elsewhere it can be set"
        } else {
            ","
        }
    ))
    .note(format!(
        "Dynamic: mean over all rollers and samples in bins of one degree. Static: rigid rings{}, mean over \
         {} of cage positions{}.{}",
        if scene.written.operation.load_varies() { " under the mean load" } else { "" },
        if scene.written.rollers_in_place().count() < scene.written.bearing.rollers {
            "a whole turn"
        } else {
            "one roller spacing"
        },
        if spalled { "; a roller over the defect is left out" } else { "" },
        if scene.written.housing.is_rigid() { "" } else { " An elastic outer ring differs by 10 to 20 %." }
    ));
    if let Some(curve) = &findings.static_curve {
        let (angle_deg, force_n) = (curve.angle_deg.clone(), curve.force_n.clone());
        figure = figure.with(Series::listed("static, rigid rings", Colour::Orange, angle_deg, force_n));
    }
    for edges in findings.prediction.standing_spalls() {
        let label = "defect".into();
        let (one, other) = (edges.trailing_deg, edges.leading_deg);
        figure.bands.push(Band { from: one.min(other), to: one.max(other), label });
    }
    Some(figure)
}

/// Sum of the forces on all rollers [N], sample by sample.
fn sums(of: &Subject<'_>) -> Option<Figure> {
    let (record, findings) = (of.record, of.findings);
    let sum = &findings.support_n;
    if sum.is_empty() {
        return None;
    }
    let supported = findings.summary.load.expected_n;
    let off = |n: f64| 100.0 * (n / supported - 1.0);
    let count = sum.len() as f64;
    let mean = sum.iter().sum::<f64>() / count;
    let rms = (sum.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / count).sqrt();
    let (low, high) = sum.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &s| (l.min(s), h.max(s)));
    let time = record.time_s();
    let mut figure = Figure::new(
        "load-sum",
        "What all rollers carry together",
        Axis::si("Time", "s"),
        Axis::si("Sum of the forces along the load", "N"),
    )
    .synced("time")
    .with(Series::sampled("sum, each sample", Colour::Blue, time[0], record.interval_s(), sum.clone()))
    .caption(format!(
        "On average the rollers carry load and weight to {:+.3} %; from sample to sample the sum swings by \
         {:.1} % (RMS), between {:+.0} and {:+.0} %, because {}ring and housing have mass.",
        off(mean),
        100.0 * rms / supported,
        off(low),
        off(high),
        if of.run.scene.written.operation.load_varies() { "the load changes and " } else { "" }
    ).replace('-', "−"))
    .note("The difference accelerates the outer ring and its housing. Load plus their weight is the dashed \
        line.");
    figure.levels = vec![Level { y: supported, label: "load and weight".into(), colour: Colour::Orange }];
    Some(figure)
}

/// Quantities left out of the table: the loads of a roller's neighbours.
const LEFT_OUT: &str = "Static, rigid rings, roller over the defect left out";

/// Forces in numbers; `over_spall` where a spall stands that rollers come over.
fn loads(summary: &Summary, over_spall: bool) -> Markup {
    let load = &summary.load;
    let kilo = |n: Option<f64>| n.map(|n| format!("{:.3} kN", 1e-3 * n));
    let rows = [
        ("Rollers on outer ring along the load, mean", kilo(load.mean_n)),
        ("Load and weight on the rollers", kilo(Some(load.expected_n))),
        ("Difference", load.relative_error.map(|e| minus(format!("{:+.3} %", 100.0 * e)))),
        ("Rollers on inner ring along the load, mean", kilo(load.inner_mean_n)),
        ("Housing on outer ring along the load, mean", kilo(load.seat_mean_n)),
        ("Largest roller force, mean over a facet period", kilo(load.max_roller_n)),
        ("Largest roller force, single sample", kilo(load.max_roller_peak_n)),
        ("Static, rigid rings, healthy raceway", kilo(load.static_max_roller_n)),
        (LEFT_OUT, kilo(load.static_max_roller_defect_n)),
        ("Rollers loaded at rest", load.static_loaded_rollers.map(|n| n.to_string())),
    ];
    let oil = summary.film.iter().flat_map(films);
    let rows = rows.into_iter().filter(|(name, _)| over_spall || *name != LEFT_OUT).chain(oil);
    pairs(rows)
}

/// Oil on both raceways in numbers.
fn films(film: &FilmFinding) -> [(&'static str, Option<String>); 4] {
    let both = |values: [Option<f64>; 2], digits: usize, unit: &str| match values {
        [Some(outer), Some(inner)] => Some(format!("{outer:.digits$} and {inner:.digits$} {unit}")),
        _ => None,
    };
    let [outer, inner] = film.lambda;
    let loaded = both(film.loaded_um.map(Some), 2, "µm");
    [
        (
            "Oil film under the most loaded roller, outer and inner raceway (Dowson and Higginson)",
            loaded.map(|films| format!("{films}, {outer:.1} and {inner:.1} times the roughness")),
        ),
        ("Oil film of rollers without load, median", both(film.floating_um, 1, "µm")),
        ("Largest force through the oil film of a roller without load", both(film.largest_n, 1, "N")),
        ("Heat of the oil films", film.heat_j.map(|heat| format!("{:.1} mJ", 1e3 * heat))),
    ]
}

/// Frequencies of the bearing, and every roller's own.
fn kinematics(summary: &Summary) -> Markup {
    let motion = &summary.kinematics;
    let rows = [
        ("Shaft", None, motion.shaft_hz, 4),
        ("Outer ring", None, motion.outer_ring_hz, 4),
        ("Cage (FTF)", motion.cage_hz, motion.expected_cage_hz, 4),
        ("Rollers pass the outer raceway (BPFO)", motion.bpfo_hz, motion.expected_bpfo_hz, 2),
        (
            "Spin relative to the cage, loaded rollers",
            motion.roller_spin_hz,
            motion.expected_roller_spin_hz,
            3,
        ),
        (
            "Spin relative to the cage, all rollers",
            motion.roller_spin_all_hz,
            motion.expected_roller_spin_hz,
            3,
        ),
    ];
    // A ring that stands still is no row.
    let rows = rows.into_iter().filter(|(name, _, hz, _)| *name != "Outer ring" || *hz > 0.0);
    let head = html! { th { "Frequency" } th class="n" { "Measured" } th class="n" { "Without slip" } th class="n" { "Difference" } };
    let row = |(name, measured, expected, digits): (&str, Option<f64>, f64, usize)| {
        let hertz = |hz: f64| format!("{hz:.digits$} Hz");
        let off = |hz: f64| minus(format!("{:+.2} %", 100.0 * (hz / expected - 1.0)));
        html! {
            td { (name) }
            (cell(measured.map(hertz)))
            (cell(Some(hertz(expected))))
            (cell(measured.filter(|_| expected > 0.0).map(off)))
        }
    };
    let of_rollers = html! { th { "Roller" } th class="n" { "Orbit Hz" } th class="n" { "Spin relative to the cage Hz" } th { "Load" } };
    let roller = |roller: &RollerMotion| {
        html! {
            td { (roller.roller) }
            td class="n" { (format!("{:.4}", roller.orbit_hz)) }
            td class="n" { (format!("{:.3}", roller.spin_hz)) }
            td { @if roller.loaded { "loaded" } @else { "free" } }
        }
    };
    html! {
        (table(None, &head, rows.map(row)))
        details {
            summary { "Every roller" }
            (table(None, &of_rollers, motion.rollers.iter().map(roller)))
        }
    }
}
