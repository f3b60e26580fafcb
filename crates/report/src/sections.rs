//! Sections that are tables with a conclusion: the paper's numbers, the ledger of lines, readings, the spall.

use maud::{Markup, html};
use stribeck_store::run_dir::Run;

use super::figures::spoken;
use super::page::term;
use super::tables::{cell, folded};
use stribeck_analysis::artefacts::Origin;
use stribeck_analysis::duty::DutyFinding;
use stribeck_analysis::summary::{Event, Summary};
use stribeck_analysis::words::significant;

/// Quantity, paper, ours, difference, why.
pub(super) fn paper(summary: &Summary) -> Markup {
    let mut part = "";
    let rows: Vec<(bool, &stribeck_analysis::summary::PaperRow)> = summary
        .paper
        .iter()
        .map(|row| {
            let first = row.part != part;
            part = &row.part;
            (first, row)
        })
        .collect();
    html! {
        div class="scroll" {
            table class="numbers" {
                thead { tr { th { "Quantity" } th class="n" { "Paper" } th class="n" { "Ours" } th class="n" { "Difference" } th { "Why" } } }
                tbody {
                    @for (first, row) in rows {
                        @if first { tr class="group" { td colspan="5" { (row.part) } } }
                        tr {
                            td { (row.quantity) }
                            td class="n" { (row.paper) }
                            td class="n wrap" { @if row.ours == CANNOT_TELL { "–" } @else { (row.ours) } }
                            td class="n" { (row.difference) }
                            td class="why" { (row.why) }
                        }
                    }
                }
            }
        }
        @if summary.paper.iter().any(|row| row.ours == CANNOT_TELL) {
            p class="hint" { "–: this record is too short to tell." }
        }
    }
}

const FACET_LINES: &str = "Rollers and raceways are polygons in the model; their corners pass the contacts \
    and make tones that a real bearing does not have";
const CARRIER: &str = "The carrier: the line in the middle of a family, at the rate at which facets pass";
pub(super) const OFF: &str = "How far the middle line lies from where the recorded motion puts it, in \
    widths that the spectrum resolves: within ±1 it is at its place";
const SCATTER: &str = "By how much that differs between components of sensors and forces of rollers, in the \
    same widths";

/// Text of a row of the paper's numbers for which the record has none.
const CANNOT_TELL: &str = "this record cannot tell";

fn family(family: Origin) -> (&'static str, &'static str) {
    match family {
        Origin::Mesh => ("mesh", "Facets passing contacts: artefacts of the mesh"),
        Origin::Beat => ("mesh", "Beats of the facet lines: artefacts too"),
        Origin::Defect => ("defect", "Rollers passing the defect: physics"),
        Origin::Ring => ("ring", "Bending modes of the free outer ring: places to look at"),
    }
}

/// Range of speed and load, and the families in orders of the shaft.
pub(super) fn duty(summary: &Summary) -> Markup {
    let Some(duty) = &summary.duty else { return html! {} };
    let minus = |text: String| text.replace('-', "−");
    let (speed, load) = (duty.speed_rpm, duty.load_n);
    html! {
        table {
            thead { tr { th { "Over the record" } th class="n" { "From" } th class="n" { "To" } } }
            tbody {
                tr { td { "Speed, clockwise positive, rpm" } td class="n" { (minus(format!("{:.1}", speed.0))) } td class="n" { (minus(format!("{:.1}", speed.1))) } }
                @if duty.outer_turns() {
                    tr { td { "Speed of the outer ring, rpm" } td class="n" { (minus(format!("{:.1}", duty.outer_speed_rpm.0))) } td class="n" { (minus(format!("{:.1}", duty.outer_speed_rpm.1))) } }
                }
                tr { td { "Load, kN" } td class="n" { (format!("{:.2}", 1e-3 * load.0)) } td class="n" { (format!("{:.2}", 1e-3 * load.1)) } }
                tr { td { "Turns of the " (duty.over()) } td class="n" { "" } td class="n" { (format!("{:.2}", duty.turns)) } }
            }
        }
        @if duty.is_unsteady() {
            p class="hint" {
                "Families come so often in a turn of the " (duty.over()) ", without slip: "
                @for (n, (name, order)) in duty.orders.iter().enumerate() { @if n > 0 { ", " } (name) " " (format!("{order:.4}")) }
                "."
                @if duty.envelope.is_some() {
                    " The squared envelope of the leading sensor was averaged over equal steps of that angle \
                     (THEORY §7.11)."
                }
            }
        }
        @if let Some(envelope) = &duty.envelope {
            table class="pairs" {
                thead { tr { th { "Envelope line over the angle" } th class="n" { "Predicted order" } th class="n" { "From the motion" } th class="n" { "Measured order" } th class="n" { "Above surroundings dB" } } }
                tbody {
                    @for line in &envelope.lines {
                        tr {
                            td { (envelope.family) " ×" (line.harmonic) }
                            td class="n" { (format!("{:.3}", line.predicted)) }
                            (cell(line.from_motion.map(|order| format!("{order:.3}"))))
                            (cell(line.measured.map(|order| format!("{order:.3}"))))
                            (cell(line.prominence_db.map(|db| minus(format!("{db:.1}")))))
                        }
                    }
                }
            }
            p class="hint" { (format!("{:.1} periods of {}; resolution {:.3} orders, one over the turns on \
                record.", envelope.periods, envelope.family, envelope.resolution)) }
        }
    }
}

/// Whether the speed of a run changes, so that nothing has a frequency.
fn unsteady(summary: &Summary) -> bool {
    summary.duty.as_ref().is_some_and(DutyFinding::is_unsteady)
}

/// Text in place of the table of lines where the speed changes.
fn no_lines() -> Markup {
    html! { p class="hint" { "The speed changes, so that no line of the mesh or of the defect has a place \
    here: see " a href="#duty" { "Speed and load" } "." } }
}

/// For each item how many from it on are equal to it; `None` for one that is equal to that before.
fn runs_of_equal<T: PartialEq>(items: impl Iterator<Item = T>) -> Vec<Option<usize>> {
    let items: Vec<T> = items.collect();
    let counted = |at: usize| {
        let begins = at == 0 || items[at] != items[at - 1];
        begins.then(|| items[at..].iter().take_while(|item| **item == items[at]).count())
    };
    (0..items.len()).map(counted).collect()
}

/// A verdict, beside all rows that share it.
fn said_once(verdict: &str, rows: Option<usize>) -> Markup {
    html! { @if let Some(rows) = rows { td class="why" rowspan=(rows) { (verdict) } } }
}

/// Verdicts on the families, and their lines.
pub(super) fn families(summary: &Summary) -> Markup {
    if unsteady(summary) {
        return no_lines();
    }
    // A record too short for any of them has one reason, and no numbers.
    if let [first, others @ ..] = &summary.families[..]
        && summary.families.iter().all(|f| f.predicted_hz.is_none() && f.carrier_hz.is_none())
        && others.iter().all(|f| f.verdict == first.verdict)
    {
        return html! { p class="hint" { (first.verdict) "." } };
    }
    let hz = |v: Option<f64>| v.map(|v| format!("{v:.1}"));
    let signed = |v: Option<f64>| v.map(|v| format!("{v:+.1}").replace('-', "−"));
    let lines = summary.families.iter().flat_map(|f| &f.lines).filter(|l| l.measured_hz.is_some());
    let verdicts = runs_of_equal(summary.families.iter().map(|f| f.verdict.as_str()));
    html! {
        div class="scroll" {
            table class="ledger" {
                thead {
                    tr {
                        th { "Family of " (term("facet lines", FACET_LINES)) } th class="n" { "Predicted Hz" }
                        th class="n" { (term("Middle line Hz", CARRIER)) } th class="n" { (term("Off its place", OFF)) }
                        th class="n" { (term("± over channels", SCATTER)) } th class="n" { "Largest g" } th { "Verdict" }
                    }
                }
                tbody {
                    @for (f, of) in summary.families.iter().zip(&verdicts) {
                        tr {
                            td { (spoken(&f.name)) }
                            (cell(hz(f.predicted_hz)))
                            (cell(hz(f.carrier_hz)))
                            (cell(signed(f.offset_resolutions)))
                            (cell(f.offset_scatter_resolutions.map(|v| format!("{v:.1}"))))
                            (cell(f.level_g.map(|g| significant(g, 3))))
                            (said_once(&f.verdict, *of))
                        }
                    }
                }
            }
        }
        p class="hint" {
            "Each family is a middle line (the carrier) with sidebands at multiples of BPFO on both sides. \
             These equally spaced lines (the comb) are fitted with the recorded motion of the rollers to \
             both components of every sensor and to the force on every loaded roller, and must explain them \
             clearly better than combs \
             that are off their place and than the other families (THEORY §7.7)."
        }
        @if summary.families.iter().any(|f| f.carrier_hz.is_some()) {
            details {
                summary { "Lines of the families" }
                table class="close" {
                    thead { tr { th { "Sensor" } th { "Component" } th class="n" { "Sideband" } th class="n" { "Predicted Hz" } th class="n" { "Measured Hz" } th class="n" { "Level g" } } }
                    tbody {
                        @for l in lines {
                            tr {
                                td { (l.sensor) } td { (l.component) }
                                td class="n" { (format!("{:+}", l.sideband).replace('-', "−")) }
                                td class="n" { (format!("{:.1}", l.predicted_hz)) }
                                (cell(hz(l.measured_hz)))
                                (cell(l.level_g.map(|g| significant(g, 3))))
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Every line of the leading sensor's spectrum.
pub(super) fn artefacts(summary: &Summary) -> Markup {
    if unsteady(summary) {
        return no_lines();
    }
    if summary.artefacts.is_empty() {
        return html! { p { "The record is too short for a spectrum." } };
    }
    let mut last = None;
    let rows: Vec<_> = summary
        .artefacts
        .iter()
        .map(|a| {
            let first = last != Some(a.family);
            last = Some(a.family);
            (first, a)
        })
        .collect();
    let hz = |v: Option<f64>| v.map(|v| format!("{v:.1}"));
    // A heading between two groups ends a cell that spans rows.
    let verdicts = runs_of_equal(summary.artefacts.iter().map(|a| (family(a.family).1, a.verdict.as_str())));
    html! {
        p {
            "Sensor “" (summary.levels.sensor.as_deref().unwrap_or("none")) "”, a_y. Facet lines are claimed \
             by a family that was found, never by \
             their place alone."
        }
        div class="scroll" {
            table class="ledger" {
                thead {
                    tr {
                        th { "Line" } th class="n" { "Predicted Hz" } th class="n" { "From the motion Hz" } th class="n" { "Measured Hz" }
                        th class="n" { "Level g" } th { "Verdict" }
                    }
                }
                tbody {
                    @for ((first, a), of) in rows.into_iter().zip(verdicts) {
                        @if first { tr class={ "group " (family(a.family).0) } { td colspan="6" { (family(a.family).1) } } }
                        tr {
                            td { (spoken(&a.name)) @if matches!(a.family, Origin::Mesh | Origin::Defect) { " ×" (a.harmonic) } }
                            td class="n" { (format!("{:.1}", a.predicted_hz)) }
                            (cell(hz(a.from_motion_hz)))
                            (cell(hz(a.measured_hz)))
                            (cell(a.level_g.map(|g| significant(g, 3))))
                            (said_once(&a.verdict, of))
                        }
                    }
                }
            }
        }
    }
}

/// The two readings of the paper that its own numbers do not carry.
pub(super) fn readings(summary: &Summary) -> Markup {
    let line = |name: &str| {
        summary
            .artefacts
            .iter()
            .find(|a| a.family == Origin::Mesh && a.name == name && a.harmonic == 1)
            .map(|a| a.predicted_hz)
    };
    let hz = |v: Option<f64>| v.map(|v| format!("{v:.0} Hz"));
    let (vertices, inner) = (line("roller_vertices"), line("inner_race_nodes"));
    let printed = stribeck_analysis::paper::EQUATION_2_HZ.1;
    let near = summary.tones.iter().filter(|t| t.harmonic == 1).filter_map(|t| t.measured_hz);
    let nearest = near.min_by(|a, b| (a - printed).abs().total_cmp(&(b - printed).abs()));
    html! {
        h3 { "The inner raceway: two formulas" }
        table {
            thead { tr { th { "Formula" } th class="n" { "Gives" } th { "Evidence in this run" } } }
            tbody {
                tr {
                    td { "Paper, equation (2): π f_c D_i / ℓ, the cage's \
                        speed" } td class="n" { (format!("{printed:.0} Hz")) }
                    td { "the measured facet line nearest to it, at any \
                        sensor: " (hz(nearest).unwrap_or("none".into())) }
                }
                tr {
                    td { "Speed of the contact along the ring: π (f_s − f_c) D_i / ℓ" } (cell(hz(inner)))
                    td { "vertices pass the inner raceway at the spin's rate, as at the outer \
                        one: " (hz(vertices).unwrap_or("–".into())) }
                }
            }
        }
        @if let Some(r) = &summary.cursor {
            h3 { "4545 Hz" }
            p {
                "A cursor between two sampled peaks reads a whole number of samples: " (format!("{:.0}, {:.0} or {:.0} Hz", r.neighbours_hz.0, r.reads_hz, r.neighbours_hz.1))
                ". " (format!("{:.0} %", 100.0 * r.share_in_tone)) " of the periods of a pure 4671 Hz tone \
                 are " (r.samples) " samples long, so the reading \
                 needs no second tone. The paper's own sum of two tones swells on a carrier \
                 of " (format!("{:.0} Hz", r.equation_3_carrier_hz)) "; "
                (format!("{:.0} %", 100.0 * r.equation_3_common.1)) " of its gaps are " (r.equation_3_common.0) " samples, "
                (format!("{:.0} %", 100.0 * r.share_in_equation_3)) " read 4545 Hz."
            }
        }
    }
}

/// The defect's family in the envelope.
pub(super) fn envelope(summary: &Summary, name: &str) -> Markup {
    if unsteady(summary) {
        return html! {};
    }
    let Some(envelope) = &summary.envelope else {
        let why = summary.notes.iter().find(|n| n.starts_with("no envelope spectrum"));
        return html! { p class="hint" { (why.map_or("No envelope spectrum was made.", String::as_str)) "." } };
    };
    html! {
        table class="pairs" {
            thead { tr { th { "Envelope line" } th class="n" { "Predicted Hz" } th class="n" { "Measured Hz" } th class="n" { "Above surroundings dB" } } }
            tbody {
                @for line in &envelope.lines {
                    tr {
                        td { (name) " ×" (line.harmonic) }
                        td class="n" { (format!("{:.2}", line.predicted_hz)) }
                        (cell(line.measured_hz.map(|hz| format!("{hz:.2}"))))
                        (cell(line.prominence_db.map(|db| format!("{db:.1}").replace('-', "−"))))
                    }
                }
            }
        }
    }
}

/// Diagnosis from the leading sensor alone, without knowledge of the scene.
pub(super) fn diagnosis(summary: &Summary) -> Markup {
    let Some(diagnosis) = &summary.diagnosis else { return html! {} };
    let number = |hz: Option<f64>| cell(hz.map(|hz| format!("{hz:.2}")));
    html! {
        h3 #diagnosis { "What the record shows by itself" }
        p { "Sensor channel " code { (diagnosis.channel) } ", judged as a measured record is, without the \
            scene: " (diagnosis.verdict) }
        @if diagnosis.families.iter().any(|family| family.claimed && !family.present) {
            p { "What is claimed and is no defect of the scene may be the rattle of elements that come under \
                the load: a run has no noise "
                "but its bearing's, so that this alone can swing its power as knocks do. In a machine's \
                 noise such claims go "
                "(`stribeck export` with `--sensor`, `noise_density`)." }
        }
        div class="scroll" {
            table {
                thead {
                    tr {
                        th { "Family" } th { "In the scene" } th { "Claimed" } th class="n" { "No slip Hz" } th class="n" { "By motion Hz" }
                        th class="n" { "Measured Hz" } th class="n" { "Height dB" } th { "Sidebands" } th { "Why" }
                    }
                }
                tbody {
                    @for family in &diagnosis.families {
                        tr {
                            td { (family.name) }
                            td { (if family.present { "yes" } else { "no" }) }
                            td { (if family.claimed { "yes" } else { "no" }) }
                            td class="n" { (format!("{:.2}", family.expected_hz)) }
                            (number(family.from_motion_hz))
                            (number(family.measured_hz))
                            (cell(family.level_db.map(|db| format!("{db:.1}").replace('-', "−"))))
                            td {
                                @if let Some(sides) = &family.sidebands {
                                    (sides.seen) " of 6 at ±" (format!("{:.2} Hz", sides.spacing_hz)) " (" (sides.of) ")"
                                } @else { "–" }
                            }
                            td { (family.reason) }
                        }
                    }
                }
            }
        }
        p class="hint" {
            "The envelope spectra resolve " (format!("{:.2} Hz", diagnosis.resolution_hz)) ". BSF is the \
             spin of a rolling element, which strikes \
             twice a turn; sidebands are those of the first three harmonics."
            @if summary.kinematics.outer_ring_hz > 0.0 { " FTF is the cage as seen from the outer ring." }
        }
    }
}

/// Length of the defect from the event times, beside the truth.
pub(super) fn spall(run: &Run, summary: &Summary) -> Markup {
    let spalls = run.scene.written.spalls();
    if spalls.is_empty() {
        return html! { p { "No spall lies on a raceway." } };
    }
    let truth = |event: &Event| Some(spalls.get(event.spall.checked_sub(1)?)?.length_mm);
    let several = spalls.len() > 1;
    let off = |found: Option<f64>, truth: f64| found.map(|t| format!("{:+.3}", t - truth).replace('-', "−"));
    let table = html! {
        div class="scroll" {
            table {
                thead {
                    tr {
                        @if several { th { "Spall" } }
                        th { "Roller" } th class="n" { "#1 off ms" } th class="n" { "#4 off ms" } th class="n" { "Estimated mm" } th class="n" { "True mm" }
                        th class="n" { "Difference" }
                    }
                }
                tbody {
                    @for e in &summary.events {
                        tr {
                            @if several { td { (e.spall) ", " (e.ring.name()) } }
                            td { (e.roller) }
                            (cell(off(e.entry_ms, e.expected_entry_ms)))
                            (cell(off(e.exit_ms, e.expected_exit_ms)))
                            (cell(e.spall_mm.map(|mm| format!("{mm:.2}"))))
                            (cell(truth(e).map(|mm| mm.to_string())))
                            (cell(e.spall_mm.zip(truth(e)).map(|(mm, truth)| format!("{:+.1} %", 100.0 * (mm / truth - 1.0)).replace('-', "−"))))
                        }
                    }
                }
            }
        }
    };
    html! {
        h3 { "Length of the defect, from the events" }
        (folded(table, summary.events.len(), "lengths, passage by passage"))
        p class="hint" {
            "Off: event against the roller's centre over the edge without slip. The estimate allows for the \
             load that a roller still carries \
             behind an edge (THEORY §7.5)."
        }
    }
}
