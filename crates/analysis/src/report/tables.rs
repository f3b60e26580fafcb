//! The tables of the report.

use maud::{Markup, html};
use stribeck_scene::run_info::RunInfo;

use super::figures::spoken;
use crate::film::FilmFinding;
use crate::summary::Summary;

/// Measured events of every passage.
pub(super) fn events(summary: &Summary) -> Markup {
    if summary.events.is_empty() {
        return html! { p { "No roller crosses a defect within the record." } };
    }
    let ms = |t: Option<f64>| t.map(|t| format!("{t:.3}"));
    html! {
        div class="scroll" {
            table {
                thead {
                    tr {
                        th { "Roller" } th class="n" { "Unloaded ms" } th class="n" { "Expected ms" } th class="n" { "Path ms" }
                        th class="n" { "Loaded again ms" } th class="n" { "Expected ms" } th class="n" { "Path ms" }
                        th class="n" { "Load before kN" } th class="n" { "Impulse g" }
                    }
                }
                tbody {
                    @for event in &summary.events {
                        tr {
                            td { (event.roller) }
                            (cell(ms(event.entry_ms)))
                            td class="n" { (format!("{:.3}", event.expected_entry_ms)) }
                            (cell(ms(event.path_entry_ms)))
                            (cell(ms(event.exit_ms)))
                            td class="n" { (format!("{:.3}", event.expected_exit_ms)) }
                            (cell(ms(event.path_exit_ms)))
                            (cell(event.level_n.map(|n| format!("{:.2}", 1e-3 * n))))
                            (cell(event.impulse_g.map(|g| format!("{g:.0}"))))
                        }
                    }
                }
            }
        }
        p class="hint" {
            "Unloaded and loaded again: the normal force, a running median over one facet period or a tenth of the \
             traverse, falls below or rises above \
             half its level before the defect. Expected: a roller's centre over the edge without slip. Path: the recorded \
             centre over the edge."
        }
    }
}

/// Predicted and measured lines: every line at the leading sensor, fundamentals at the others.
pub(super) fn tones(summary: &Summary) -> Markup {
    let leading = summary.levels.sensor.as_deref().unwrap_or_default();
    let shown = summary.tones.iter().filter(|t| t.sensor == leading || t.harmonic == 1);
    html! {
        div class="scroll" {
            table class="close" {
                thead {
                    tr {
                        th { "Sensor" } th { "Line" } th class="n" { "No slip Hz" } th class="n" { "From motion Hz" } th class="n" { "Measured Hz" }
                        th class="n" { "Off by %" } th class="n" { "Amplitude g" } th class="n" { "Stands out dB" }
                        th { "Merged with" }
                    }
                }
                tbody {
                    @for tone in shown {
                        @let off = tone.measured_hz.map(|hz| 100.0 * (hz / tone.predicted_hz - 1.0));
                        tr {
                            td { (tone.sensor) }
                            td { (spoken(&tone.name)) " ×" (tone.harmonic) }
                            td class="n" { (format!("{:.1}", tone.predicted_hz)) }
                            (cell(tone.from_motion_hz.map(|hz| format!("{hz:.1}"))))
                            (cell(tone.measured_hz.map(|hz| format!("{hz:.1}"))))
                            (cell(off.map(|p| format!("{p:+.2}").replace('-', "−"))))
                            (cell(tone.level_g.map(|g| format!("{g:.2}"))))
                            (cell(tone.prominence_db.map(|db| format!("{db:.1}").replace('-', "−"))))
                            td { (short_names(&tone.unresolved_from)) }
                        }
                    }
                }
            }
        }
        p class="hint" {
            "Predicted from the facet counts of this mesh, without slip and from the recorded motion of cage and loaded rollers. \
             A line counts as found when the spectrum has a peak within 0.5 % of either (or half a resolution) and 10 dB above \
             its surroundings; where this record cannot tell lines apart, the peak goes to those within reach of it. Off by: \
             from the value without slip."
        }
    }
}

/// Lines of the same harmonic by the first word of their names, which tells them apart.
fn short_names(lines: &[String]) -> String {
    let first = |line: &String| spoken(line).split(' ').next().unwrap_or_default().to_owned();
    lines.iter().map(first).collect::<Vec<_>>().join(", ")
}

/// The notch in numbers.
pub(super) fn notch(summary: &Summary) -> Markup {
    let Some(notch) = &summary.notch else { return html! {} };
    let db = |v: Option<f64>| v.map(|v| format!("{v:.1} dB"));
    let rows = [
        ("Centre", Some(format!("{:.1} Hz (paper: {:.0} Hz)", notch.centre_hz, notch.paper_centre_hz))),
        ("Quality factor", Some(format!("{:.0}", notch.q))),
        ("Width at −3 dB", Some(format!("{:.0} Hz", notch.width_hz))),
        ("Transient (60 dB)", Some(format!("{:.2} ms", 1e3 * notch.transient_s))),
        ("Taken from the tone: Hann, whole record", db(notch.attenuation_db)),
        ("Hann, without the transient", db(notch.attenuation_settled_db)),
        ("Boxcar, whole record", db(notch.attenuation_boxcar_db)),
        ("Boxcar, without the transient", db(notch.attenuation_boxcar_settled_db)),
        ("Taken at 4545 Hz, transfer function", db(notch.attenuation_4545_db)),
    ];
    html! {
        h3 id="notch" { "The notch" }
        table class="pairs" { tbody { @for (name, value) in rows { tr { td { (name) } (cell(value)) } } } }
        p class="hint" {
            "How much a notch takes from a line depends on the window and on whether its own start is counted, so the paper's \
             25 dB is a figure to set beside these four, not a mark to hit."
        }
    }
}

/// Forces in numbers.
pub(super) fn loads(summary: &Summary) -> Markup {
    let load = &summary.load;
    let kilo = |n: Option<f64>| n.map(|n| format!("{:.3} kN", 1e-3 * n));
    let rows = [
        ("Vertical force, rollers on outer ring, mean", kilo(load.mean_n)),
        ("Load and weight above the rollers", kilo(Some(load.expected_n))),
        ("Difference", load.relative_error.map(|e| format!("{:+.3} %", 100.0 * e).replace('-', "−"))),
        ("Vertical force, rollers on inner ring, mean", kilo(load.inner_mean_n)),
        ("Adapter on outer ring, mean", kilo(load.seat_mean_n)),
        ("Largest roller force, mean over a facet period", kilo(load.max_roller_n)),
        ("Largest roller force, single sample", kilo(load.max_roller_peak_n)),
        ("Static, rigid rings, sound raceway", kilo(load.static_max_roller_n)),
        ("Static, rigid rings, roller over the defect left out", kilo(load.static_max_roller_defect_n)),
        ("Rollers loaded at rest", load.static_loaded_rollers.map(|n| n.to_string())),
    ];
    let oil = summary.film.iter().flat_map(films);
    let rows = rows.into_iter().chain(oil);
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
        ("Largest force of an oil film on a roller", both(film.largest_n, 0, "N")),
        ("Heat of the oil films", film.heat_j.map(|heat| format!("{:.1} mJ", 1e3 * heat))),
    ]
}

/// Frequencies of the bearing, and every roller's own.
pub(super) fn kinematics(summary: &Summary) -> Markup {
    let motion = &summary.kinematics;
    let rows = [
        ("Shaft", None, motion.shaft_hz, 4),
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
    html! {
        table {
            thead { tr { th { "Frequency" } th class="n" { "Measured" } th class="n" { "Without slip" } th class="n" { "Difference" } } }
            tbody {
                @for (name, measured, expected, digits) in rows {
                    tr {
                        td { (name) }
                        (cell(hertz(measured, digits)))
                        td class="n" { (format!("{expected:.digits$} Hz")) }
                        (cell(measured.map(|hz| format!("{:+.2} %", 100.0 * (hz / expected - 1.0)).replace('-', "−"))))
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

/// Levels at every sensor.
pub(super) fn levels(summary: &Summary) -> Markup {
    let g = |v: Option<f64>| v.map(|v| format!("{v:.1}"));
    html! {
        div class="scroll" {
            table {
                thead {
                    tr {
                        th { "Sensor" } th class="n" { "Impulse peak g" } th class="n" { "Between peak g" } th class="n" { "Between RMS g" }
                        th class="n" { "Notched peak g" } th class="n" { "Notched RMS g" }
                    }
                }
                tbody {
                    @for sensor in &summary.levels.sensors {
                        tr {
                            td { (sensor.sensor) }
                            (cell(g(sensor.impulse_g)))
                            (cell(g(sensor.between_g)))
                            (cell(g(sensor.between_rms_g)))
                            (cell(g(sensor.between_filtered_g)))
                            (cell(g(sensor.between_filtered_rms_g)))
                        }
                    }
                }
            }
        }
        p class="hint" {
            "a_y, mean over each sampling interval. Impulse: within 1 ms of an exit. Between: from 2 ms after an exit to 0.5 ms \
             before the next entry; notched values leave out the filter's transient."
        }
    }
}

/// Where the run comes from and what it cost.
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
