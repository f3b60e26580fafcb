//! The head of the page: key numbers beside what theory expects and what the paper reports.

use maud::{Markup, html};

use super::tables::{cell, hertz};
use crate::findings::Findings;
use crate::summary::Summary;
use crate::tones;

/// One line of the comparison at the head of the page.
struct Row {
    quantity: String,
    ours: Option<String>,
    expected: String,
    paper: &'static str,
}

/// Key numbers beside what theory expects and what the paper reports.
pub(super) fn table(summary: &Summary, findings: &Findings) -> Markup {
    let rows = motion_rows(summary).into_iter().chain(noise_rows(summary, findings)).chain(sum_rows(summary));
    html! {
        div class="scroll" {
            table {
                thead { tr { th { "Quantity" } th class="n" { "This run" } th class="n" { "Expected" } th class="n" { "Paper" } } }
                tbody {
                    @for row in rows {
                        tr {
                            td { (row.quantity) }
                            (cell(row.ours))
                            td class="n" { (row.expected) }
                            td class="n wrap" { (row.paper) }
                        }
                    }
                }
            }
        }
    }
}

fn motion_rows(summary: &Summary) -> Vec<Row> {
    let motion = &summary.kinematics;
    let mut rows = vec![
        Row {
            quantity: "Cage frequency".into(),
            ours: hertz(motion.cage_hz, 4),
            expected: format!("{:.4} Hz", motion.expected_cage_hz),
            paper: "",
        },
        Row {
            quantity: "Ball pass frequency, outer raceway".into(),
            ours: hertz(motion.bpfo_hz, 2),
            expected: format!("{:.2} Hz", motion.expected_bpfo_hz),
            paper: "90.91 Hz read, 90.07 Hz computed",
        },
    ];
    let papers = ["≈ 5 ms", "16–17 ms", "≈ 28 ms"];
    for (at, event) in summary.events.iter().enumerate().take(3) {
        rows.push(Row {
            quantity: format!("Roller {} is loaded again behind the defect", event.roller),
            ours: event.exit_ms.map(|t| format!("{t:.2} ms")),
            expected: format!("{:.2} ms", event.expected_exit_ms),
            paper: papers[at],
        });
    }
    rows
}

fn noise_rows(summary: &Summary, findings: &Findings) -> Vec<Row> {
    let leading = summary.levels.sensor.as_deref().unwrap_or_default();
    let tone = tones::dominant(&summary.tones, leading);
    let clearest = tones::clearest(&summary.tones);
    let sensor = clearest.map_or("any sensor", |t| t.sensor.as_str());
    let place = format!("Facet tone where it is clearest ({sensor})");
    let first = findings.prediction.facet_lines.first().map_or(String::new(), |l| format!("{:.0} Hz", l.1));
    let notch = summary.notch.as_ref();
    let gravities = |g: Option<f64>| g.map(|g| format!("{g:.0} g"));
    let decibels = |db: Option<f64>| db.map(|db| format!("{db:.1} dB"));
    let row = |quantity: &str, ours: Option<String>, expected: String, paper| Row {
        quantity: quantity.into(),
        ours,
        expected,
        paper,
    };
    vec![
        row(
            &format!("Facet tone at the leading sensor ({leading})"),
            tone.and_then(|t| hertz(t.measured_hz, 1)),
            first.clone(),
            "4671 Hz",
        ),
        row(&place, clearest.and_then(|t| hertz(t.measured_hz, 1)), first, ""),
        row(
            "The same above its surroundings",
            decibels(clearest.and_then(|t| t.prominence_db)),
            String::new(),
            "",
        ),
        row("Impulse at an exit, peak", gravities(summary.levels.impulse_g), String::new(), "± 180 g"),
        row("Between impulses, peak", gravities(summary.levels.between_g), String::new(), "± 50 g"),
        row(
            "Between impulses, notched, peak",
            gravities(summary.levels.between_filtered_g),
            String::new(),
            "± 20 g",
        ),
        row(
            "Notch takes from the tone",
            decibels(notch.and_then(|n| n.attenuation_db)),
            String::new(),
            "25 dB",
        ),
        row(
            "Notch takes at 4545 Hz",
            decibels(notch.and_then(|n| n.attenuation_4545_db)),
            String::new(),
            "4 dB",
        ),
    ]
}

fn sum_rows(summary: &Summary) -> Vec<Row> {
    let load = &summary.load;
    let kilo = |n: f64| format!("{:.2} kN", 1e-3 * n);
    vec![
        Row {
            quantity: "Vertical force through the rollers, mean".into(),
            ours: load.mean_n.map(kilo),
            expected: kilo(load.expected_n),
            paper: "50 kN load",
        },
        Row {
            quantity: "Largest roller force, facet-period mean".into(),
            ours: load.max_roller_n.map(kilo),
            expected: load
                .static_max_roller_defect_n
                .map_or(String::new(), |n| format!("{} static", kilo(n))),
            paper: "",
        },
        Row {
            quantity: "Energy imbalance / peak strain energy".into(),
            ours: Some(format!("{:.3} %", 100.0 * summary.energy.max_relative_error)),
            expected: "0".into(),
            paper: "",
        },
    ]
}
