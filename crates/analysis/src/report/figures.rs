//! The figures of the report, in the order in which the page shows them.

use stribeck_bearing::run_dir::Run;

use super::signals::{acceleration, spectra};
use crate::findings::{CrossingForce, Findings};
use crate::plot::{Axis, Band, Colour, Figure, Mark, Series};
use crate::summary::Event;

/// Rollers whose force is drawn: the paper's three. All others are in the table.
const DRAWN_CROSSINGS: usize = 3;

/// All figures that the run can yield, grouped by section.
#[derive(Debug, Default)]
pub(super) struct Figures {
    pub(super) acceleration: Vec<Figure>,
    pub(super) spectra: Vec<Figure>,
    pub(super) forces: Vec<Figure>,
    pub(super) load: Vec<Figure>,
    pub(super) energy: Vec<Figure>,
}

impl Figures {
    pub(super) fn of(run: &Run, findings: &Findings) -> Self {
        Self {
            acceleration: acceleration(findings),
            spectra: spectra(findings),
            forces: forces(findings),
            load: load(findings),
            energy: energy(run),
        }
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &Figure> {
        [&self.acceleration, &self.spectra, &self.forces, &self.load, &self.energy].into_iter().flatten()
    }
}

fn forces(findings: &Findings) -> Vec<Figure> {
    let crossings = findings.crossings.iter().zip(&findings.summary.events).take(DRAWN_CROSSINGS);
    crossings.enumerate().map(|(at, (crossing, event))| force(findings, crossing, event, at)).collect()
}

fn force(findings: &Findings, crossing: &CrossingForce, event: &Event, at: usize) -> Figure {
    let vertical = Axis::si("Vertical force, compression positive", "N");
    let mut figure = Figure::new(
        &format!("force-{}", at + 1),
        &format!("Outer raceway on roller {}", crossing.roller),
        Axis::si("Time", "s"),
        vertical,
    )
    .synced("time")
    .with(sampled(findings, "raw", Colour::Grey, &crossing.raw_n));
    if !crossing.filtered_n.is_empty() {
        figure = figure.with(sampled(findings, "notched", Colour::Blue, &crossing.filtered_n));
    }
    let time = |ms: Option<f64>| ms.map_or("not at all".into(), |t| format!("at {t:.2} ms"));
    figure.bands = transient(findings);
    for (ms, label) in
        [(event.expected_entry_ms, "expected entry"), (event.expected_exit_ms, "expected exit")]
    {
        figure.marks.push(mark(1e-3 * ms, label, Colour::Orange, true));
    }
    for (ms, label) in [(event.entry_ms, "unloaded"), (event.exit_ms, "loaded again")] {
        if let Some(ms) = ms {
            figure.marks.push(mark(1e-3 * ms, label, Colour::Green, false));
        }
    }
    figure
        .caption(format!(
            "The roller loses its load {} (expected over the leading edge at {:.2} ms) and takes it up again {} (trailing \
             edge at {:.2} ms).",
            time(event.entry_ms),
            event.expected_entry_ms,
            time(event.exit_ms),
            event.expected_exit_ms
        ))
        .note(format!(
            "Compare the paper's Fig. 8{}. A roller of finite stiffness unloads after its centre has passed the leading \
             edge and is loaded before it reaches the trailing one.",
            char::from(b'a' + at as u8)
        ))
}

fn load(findings: &Findings) -> Vec<Figure> {
    let dynamic = &findings.distribution;
    if dynamic.mean_n.iter().all(|f| f.is_nan()) {
        return Vec::new();
    }
    let mut figure = Figure::new(
        "load-distribution",
        "Load distribution",
        Axis::plain("Angle from the x axis, counter-clockwise", "°").over(0.0, 360.0),
        Axis::si("Outer-raceway force", "N"),
    )
    .with(Series::listed(
        "dynamic, mean by angle",
        Colour::Blue,
        dynamic.angle_deg.clone(),
        dynamic.mean_n.clone(),
    ))
    .caption(
        "Mean force on a roller by its place: over the defect it carries nothing, its neighbours take over, and elsewhere it \
         can be set beside rigid rings at rest.",
    )
    .note(
        "Dynamic: mean over all rollers and samples in bins of one degree. Static: rigid rings over one roller spacing of \
         cage positions; a roller over the defect is left out. An elastic outer ring differs by 10 to 20 %.",
    );
    if let Some(curve) = &findings.static_curve {
        let (angle_deg, force_n) = (curve.angle_deg.clone(), curve.force_n.clone());
        figure = figure.with(Series::listed("static, rigid rings", Colour::Orange, angle_deg, force_n));
    }
    if let Some(edges) = findings.prediction.defect {
        let label = "defect".into();
        figure.bands.push(Band { from: edges.trailing_deg, to: edges.leading_deg, label });
    }
    vec![figure]
}

fn energy(run: &Run) -> Vec<Figure> {
    let Some(time) = run.energy.get("time_s").filter(|t| !t.is_empty()) else { return Vec::new() };
    let parts = [
        ("kinetic_j", "kinetic", Colour::Blue),
        ("strain_j", "strain", Colour::Orange),
        ("hourglass_j", "hourglass", Colour::Brown),
        ("contact_j", "contact", Colour::Green),
        ("friction_j", "friction", Colour::Red),
        ("damping_j", "damping", Colour::Purple),
        ("contact_damping_j", "contact damping", Colour::Teal),
        ("external_j", "supplied by load", Colour::Grey),
        ("drive_j", "supplied by drive", Colour::Black),
    ];
    let mut ledger = Figure::new(
        "energy",
        "Energy ledger, change since the start",
        Axis::si("Time", "s"),
        Axis::si("Energy", "J"),
    )
    .synced("time")
    .caption(format!(
        "What load and drive supply is found again as motion, strain and heat, within {:.2} % of the peak strain energy.",
        100.0 * run.info.energy.max_relative_error
    ))
    .note("Friction, damping and contact damping only grow; kinetic and strain energy go up and down.");
    for (channel, name, colour) in parts {
        if let Some(values) = run.energy.get(channel).filter(|v| v.iter().any(|&e| e != 0.0)) {
            let first = values.first().copied().unwrap_or(0.0);
            let change = values.iter().map(|e| e - first).collect();
            ledger = ledger.with(Series::listed(name, colour, time.to_vec(), change));
        }
    }
    let mut figures = vec![ledger];
    if let Some(error) = run.energy.get("relative_error") {
        let percent = error.iter().map(|e| 100.0 * e).collect();
        figures.push(
            Figure::new(
                "energy-error",
                "Energy imbalance",
                Axis::si("Time", "s"),
                Axis::plain("Imbalance / peak strain energy", "%"),
            )
            .synced("time")
            .with(Series::listed("imbalance", Colour::Red, time.to_vec(), percent))
            .caption(format!(
                "The largest imbalance is {:.3} % of the peak strain energy; a run stops when its limit is passed.",
                100.0 * run.info.energy.max_relative_error
            )),
        );
    }
    figures
}

pub(super) fn sampled(findings: &Findings, name: &str, colour: Colour, values: &[f64]) -> Series {
    Series::sampled(name, colour, findings.start_s, findings.interval_s, values.to_vec())
}

pub(super) fn mark(x: f64, label: &str, colour: Colour, dashed: bool) -> Mark {
    Mark { x, label: label.into(), colour, dashed }
}

pub(super) fn transient(findings: &Findings) -> Vec<Band> {
    let length = findings.transient_s();
    if length == 0.0 {
        return Vec::new();
    }
    let label = format!("transient of the notch, {:.1} ms", 1e3 * length);
    vec![Band { from: findings.start_s, to: findings.start_s + length, label }]
}

/// A stable name as words.
pub(super) fn spoken(name: &str) -> String {
    name.replace('_', " ")
}
