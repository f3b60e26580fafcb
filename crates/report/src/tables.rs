//! The tables of the report.

use maud::{Markup, html};
use stribeck_store::run_info::RunInfo;

use stribeck_analysis::film::FilmFinding;
use stribeck_analysis::floor::FloorContact;
use stribeck_analysis::summary::{Event, PhaseLevels, Summary};
use stribeck_analysis::words::{level, significant};

/// Measured events of every passage.
pub(super) fn events(summary: &Summary) -> Markup {
    if summary.events.is_empty() {
        return html! {};
    }
    let ms = |t: Option<f64>| t.map(|t| format!("{t:.2}"));
    let kilo = |n: Option<f64>| n.map(|n| format!("{:.2}", 1e-3 * n));
    let floor = |event: &Event| {
        let by = |by: FloorContact| format!(", {}", by.name());
        event.floor_n.map(|n| format!("{n:.0}{}", event.floor_by.map_or(String::new(), by)))
    };
    let several = summary.events.iter().any(|event| event.spall > 1);
    let table = html! {
        div class="scroll" {
            table {
                thead {
                    tr {
                        @if several { th { "Spall" } }
                        th { "Roller" } th class="n" { "Load before kN" } th class="n" { "#1 unloads ms" } th class="n" { "no slip ms" }
                        th class="n" { "#2 floor ms" } th class="n" { "floor N" }
                        th class="n" { "#3 neighbour in the defect ms" } th class="n" { "carries kN" }
                        th class="n" { "#4 loaded ms" } th class="n" { "no slip ms" } th class="n" { "Impulse g" }
                    }
                }
                tbody {
                    @for event in &summary.events {
                        tr {
                            @if several { td { (event.spall) ", " (event.ring.name()) } }
                            td { (event.roller) }
                            (cell(kilo(event.level_n)))
                            (cell(ms(event.entry_ms)))
                            td class="n" { (format!("{:.2}", event.expected_entry_ms)) }
                            (cell(ms(event.floor_ms)))
                            (cell(floor(event)))
                            (cell(ms(event.compensation_ms)))
                            (cell(kilo(event.compensation_n)))
                            (cell(ms(event.exit_ms)))
                            td class="n" { (format!("{:.2}", event.expected_exit_ms)) }
                            (cell(event.impulse_g.map(level)))
                        }
                    }
                }
            }
        }
    };
    folded(table, summary.events.len(), "passages over the defect, one by one")
}

/// A table, folded up where its rows would fill the page.
pub(super) fn folded(table: Markup, rows: usize, what: &str) -> Markup {
    const OPEN: usize = 24;
    if rows <= OPEN {
        return table;
    }
    html! { details { summary { (rows) " " (what) } (table) } }
}

/// The notch in numbers.
pub(super) fn notch(summary: &Summary) -> Markup {
    let Some(notch) = &summary.notch else { return html! {} };
    let db = |v: Option<f64>| v.map(|v| format!("{v:.1} dB"));
    let rows = [
        ("Centre", Some(format!("{:.1} Hz", notch.centre_hz))),
        ("Quality factor", Some(format!("{:.0}", notch.q))),
        ("Width at −3 dB", Some(format!("{:.0} Hz", notch.width_hz))),
        ("Transient (60 dB)", Some(format!("{:.2} ms", 1e3 * notch.transient_s))),
        ("Attenuation at the centre: Hann, whole record", db(notch.attenuation_db)),
        ("Hann, without the transient", db(notch.attenuation_settled_db)),
        ("Boxcar, whole record", db(notch.attenuation_boxcar_db)),
        ("Boxcar, without the transient", db(notch.attenuation_boxcar_settled_db)),
        ("Attenuation at 4545 Hz, transfer function", db(notch.attenuation_4545_db)),
    ];
    // The last is a frequency of the paper's.
    let shown = if summary.paper.is_empty() { &rows[..rows.len() - 1] } else { &rows };
    html! {
        h3 id="notch" { "The notch" }
        table class="pairs" { tbody { @for (name, value) in shown { tr { td { (name) } (cell(value.clone())) } } } }
    }
}

/// Quantities left out of the table: the loads of a roller's neighbours.
const LEFT_OUT: &str = "Static, rigid rings, roller over the defect left out";

/// Forces in numbers; `over_spall` where a spall stands that rollers come over.
pub(super) fn loads(summary: &Summary, over_spall: bool) -> Markup {
    let load = &summary.load;
    let kilo = |n: Option<f64>| n.map(|n| format!("{:.3} kN", 1e-3 * n));
    let rows = [
        ("Rollers on outer ring along the load, mean", kilo(load.mean_n)),
        ("Load and weight on the rollers", kilo(Some(load.expected_n))),
        ("Difference", load.relative_error.map(|e| format!("{:+.3} %", 100.0 * e).replace('-', "−"))),
        ("Rollers on inner ring along the load, mean", kilo(load.inner_mean_n)),
        ("Housing on outer ring along the load, mean", kilo(load.seat_mean_n)),
        ("Largest roller force, mean over a facet period", kilo(load.max_roller_n)),
        ("Largest roller force, single sample", kilo(load.max_roller_peak_n)),
        ("Static, rigid rings, sound raceway", kilo(load.static_max_roller_n)),
        (LEFT_OUT, kilo(load.static_max_roller_defect_n)),
        ("Rollers loaded at rest", load.static_loaded_rollers.map(|n| n.to_string())),
    ];
    let oil = summary.film.iter().flat_map(films);
    let rows = rows.into_iter().filter(|(name, _)| over_spall || *name != LEFT_OUT).chain(oil);
    html! { table class="pairs" { tbody { @for (name, value) in rows { tr { td { (name) } (cell(value)) } } } } }
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
pub(super) fn kinematics(summary: &Summary) -> Markup {
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
    html! {
        table {
            thead { tr { th { "Frequency" } th class="n" { "Measured" } th class="n" { "Without slip" } th class="n" { "Difference" } } }
            tbody {
                @for (name, measured, expected, digits) in rows {
                    tr {
                        td { (name) }
                        (cell(hertz(measured, digits)))
                        td class="n" { (format!("{expected:.digits$} Hz")) }
                        (cell(measured.filter(|_| expected > 0.0).map(|hz| format!("{:+.2} %", 100.0 * (hz / expected - 1.0)).replace('-', "−"))))
                    }
                }
            }
        }
        details {
            summary { "Every roller" }
            table {
                thead { tr { th { "Roller" } th class="n" { "Orbit Hz" } th class="n" { "Spin relative to the cage Hz" } th { "Load" } } }
                tbody {
                    @for roller in &motion.rollers {
                        tr {
                            td { (roller.roller) }
                            td class="n" { (format!("{:.4}", roller.orbit_hz)) }
                            td class="n" { (format!("{:.3}", roller.spin_hz)) }
                            td { @if roller.loaded { "loaded" } @else { "free" } }
                        }
                    }
                }
            }
        }
    }
}

/// Levels by phase at every sensor, as the paper takes them and along and across the radius.
pub(super) fn levels(summary: &Summary) -> Markup {
    let both = |peak: Option<f64>, rms: Option<f64>| {
        peak.zip(rms).map(|(p, r)| format!("{} / {}", level(p), significant(r, 3)))
    };
    let row = |sensor: &str, component: &str, l: &PhaseLevels| {
        html! {
            tr {
                td { (sensor) } td { (component) }
                (cell(both(l.start_g, l.start_rms_g)))
                (cell(both(l.entry_g, l.entry_rms_g)))
                (cell(both(l.defect_g, l.defect_rms_g)))
                (cell(both(l.exit_g, l.exit_rms_g)))
                (cell(both(l.gap_g, l.gap_rms_g)))
            }
        }
    };
    html! {
        h3 { "Levels by phase, peak / RMS in g" }
        div class="scroll" {
            table {
                thead {
                    tr {
                        th { "Sensor" } th { "Component" } th class="n" { "Start-up" } th class="n" { "Entry" } th class="n" { "In the defect" }
                        th class="n" { "Exit" } th class="n" { "Gap" }
                    }
                }
                tbody {
                    @for sensor in &summary.levels.sensors {
                        (row(&sensor.sensor, "a_y", &sensor.phases))
                        @for c in &sensor.components { (row("", &c.component, &c.phases)) }
                    }
                }
            }
        }
        p class="hint" {
            "Mean acceleration of each sampling interval. Start-up: to the first entry, 2 ms at most. Entry: \
             from 0.5 ms before the edge to \
             1 ms after unloading. Exit: from 1 ms before loading to 2 ms after the edge."
        }
    }
}

/// Origin of the run, and its computing time.
pub(super) fn provenance(info: &RunInfo, summary: &Summary) -> Markup {
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

pub(super) fn hertz(value: Option<f64>, digits: usize) -> Option<String> {
    value.map(|hz| format!("{hz:.digits$} Hz"))
}

/// A right-aligned cell; a dash when there is no value.
pub(super) fn cell(value: Option<String>) -> Markup {
    match value {
        Some(text) => html! { td class="n" { (text) } },
        None => html! { td class="n absent" { "–" } },
    }
}
