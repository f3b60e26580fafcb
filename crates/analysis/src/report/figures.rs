//! The figures of the report, in the order in which the page shows them.

use stribeck_bearing::run_dir::Run;
use stribeck_dsp::Spectrum;

use crate::findings::{CrossingForce, Findings, SensorSignal};
use crate::plot::{Axis, Band, Colour, Figure, Mark, Series};
use crate::summary::Event;

/// How far below its highest value a spectrum is drawn [dB]; rounding noise lies lower.
const DEPTH_DB: f64 = 120.0;
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

fn acceleration(findings: &Findings) -> Vec<Figure> {
    let Some(leading) = findings.sensors.first().filter(|s| !s.raw_g.is_empty()) else { return Vec::new() };
    let summary = &findings.summary;
    let mut figures = Vec::new();
    let mut raw = over_time("acceleration", &format!("Acceleration a_y at sensor “{}”", leading.name), "a_y")
        .with(sampled(findings, "mean over each interval", Colour::Blue, &leading.raw_g))
        .caption(format!(
            "Each roller that leaves the defect gives an impulse ({} here, about 180 g in the paper); between them stands \
             the noise of the facets ({} here, about 50 g in the paper).",
            gravities(summary.levels.impulse_g),
            gravities(summary.levels.between_g),
        ))
        .note("Compare the paper's Fig. 2. Dashed: a roller over the trailing edge without slip.");
    raw.marks = exits(&summary.events);
    figures.push(raw);

    if !leading.filtered_g.is_empty() {
        let mut notched = over_time("acceleration-notched", "The same behind the notch", "a_y")
            .with(sampled(findings, "raw", Colour::Grey, &leading.raw_g))
            .with(sampled(findings, "notched", Colour::Orange, &leading.filtered_g))
            .caption(format!(
                "Without the facet tone the level between the impulses is {1} instead of {0} (paper: 20 instead of 50 g), and \
                 the impulses stay.",
                gravities(summary.levels.between_g),
                gravities(summary.levels.between_filtered_g),
            ))
            .note(format!("Compare the paper's Fig. 6. {}", transient_note(findings)));
        notched.marks = exits(&summary.events);
        notched.bands = transient(findings);
        figures.push(notched);
    }
    for sensor in &findings.sensors[1..] {
        let mut figure =
            over_time(&format!("acceleration-{}", sensor.name), &format!("Sensor “{}”", sensor.name), "a_y")
                .with(sampled(findings, "raw", Colour::Grey, &sensor.raw_g));
        if !sensor.filtered_g.is_empty() {
            figure = figure.with(sampled(findings, "notched", Colour::Orange, &sensor.filtered_g));
        }
        figure.bands = transient(findings);
        figure.marks = exits(&summary.events);
        let of_sensor = summary.levels.sensors.iter().find(|l| l.sensor == sensor.name);
        figures.push(figure.caption(format!(
            "The same events from another place on the ring: impulses of {}, {} between them.",
            gravities(of_sensor.and_then(|l| l.impulse_g)),
            gravities(of_sensor.and_then(|l| l.between_g)),
        )));
    }
    figures.extend(instantaneous(findings, leading));
    figures
}

fn instantaneous(findings: &Findings, leading: &SensorSignal) -> Option<Figure> {
    if leading.instant_g.is_empty() {
        return None;
    }
    let figure = over_time("acceleration-instant", "Instantaneous nodal acceleration", "a_y")
        .with(sampled(findings, "instantaneous", Colour::Grey, &leading.instant_g))
        .with(sampled(findings, "mean over each interval", Colour::Blue, &leading.raw_g));
    Some(
        figure
            .caption("A node rings with the mesh far above half the sampling rate; its instantaneous acceleration aliases, \
                      so every other figure uses the mean over each sampling interval.")
            .note("The mean is the change of velocity over one interval divided by the interval."),
    )
}

fn spectra(findings: &Findings) -> Vec<Figure> {
    let Some(leading) = findings.sensors.first() else { return Vec::new() };
    let Some(raw) = &leading.raw_density else { return Vec::new() };
    let half = 0.5 * raw.sample_rate_hz();
    let centre = findings.summary.notch.as_ref().map_or(5000.0, |n| n.centre_hz);
    // The paper zooms to 4–6 kHz; a coarser mesh has its tone elsewhere.
    let zoom = if (4000.0..6000.0).contains(&centre) && half >= 6000.0 {
        (4000.0, 6000.0)
    } else {
        ((centre - 1000.0).max(0.0), (centre + 1000.0).min(half))
    };
    let overlay = |id: &str, title: &str, range: (f64, f64)| {
        let mut figure = over_frequency(id, title, range).with(density("raw", Colour::Blue, raw));
        if let Some(filtered) = &leading.filtered_density {
            figure = figure.with(density("notched", Colour::Orange, filtered));
        }
        figure
    };
    let attenuation = findings.summary.notch.as_ref().and_then(|n| n.attenuation_db);
    let mut whole = overlay("spectrum", "Power spectral density of a_y, whole", (0.0, half))
        .caption(format!(
            "Facet lines stand above a broad background, at the marked harmonics of the roller's vertices; the strongest \
             fundamental is at {} (paper: 4671 Hz).",
            strongest(findings)
        ))
        .note(format!("Compare the paper's Figs. 3 and 7a. Welch: {}.", raw.resolution()));
    whole.marks = harmonic_marks(findings);
    let mut zoomed = overlay("spectrum-zoom", &format!("The same, {:.0} to {:.0} Hz", zoom.0, zoom.1), zoom)
        .caption(format!(
            "The notch takes {} from the tone (paper: 25 dB) and nothing from what lies a few hundred hertz away.",
            attenuation.map_or("an unknown amount".into(), |a| format!("{a:.0} dB")),
        ))
        .note(format!(
            "Compare the paper's Fig. 7b. Dashed: predicted from the facet counts. Welch: {}; lines closer than {:.0} Hz merge.",
            raw.resolution(),
            raw.resolution().width_6db_hz
        ));
    zoomed.marks = line_marks(findings);
    let mut figures = vec![whole, zoomed];
    if findings.sensors.len() > 1 {
        figures.push(all_sensors(findings, zoom, raw));
    }
    figures
}

fn all_sensors(findings: &Findings, zoom: (f64, f64), raw: &Spectrum) -> Figure {
    let colours = [Colour::Blue, Colour::Orange, Colour::Green, Colour::Purple, Colour::Red, Colour::Teal];
    let mut figure = over_frequency("spectrum-sensors", "All sensors, raw", zoom)
        .caption("The tone belongs to the contacts, so it stands at the same frequency wherever it is heard.")
        .note(format!("Welch: {}.", raw.resolution()));
    for (sensor, colour) in findings.sensors.iter().zip(colours.into_iter().cycle()) {
        if let Some(spectrum) = &sensor.raw_density {
            figure = figure.with(density(&sensor.name, colour, spectrum));
        }
    }
    figure.marks = line_marks(findings);
    figure
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
    if dynamic.angle_deg.is_empty() {
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

fn over_time(id: &str, title: &str, quantity: &str) -> Figure {
    Figure::new(id, title, Axis::si("Time", "s"), Axis::plain(quantity, "g")).synced("time")
}

fn over_frequency(id: &str, title: &str, (from, to): (f64, f64)) -> Figure {
    let density = Axis::plain("Power spectral density", "dB re 1 g²/Hz");
    Figure::new(id, title, Axis::si("Frequency", "Hz").over(from, to), density)
}

fn sampled(findings: &Findings, name: &str, colour: Colour, values: &[f64]) -> Series {
    Series::sampled(name, colour, findings.start_s, findings.interval_s, values.to_vec())
}

/// A spectrum in decibels, cut [`DEPTH_DB`] below its highest value.
fn density(name: &str, colour: Colour, spectrum: &Spectrum) -> Series {
    let decibels: Vec<f64> = spectrum.values().iter().map(|p| 10.0 * p.log10()).collect();
    let highest = decibels.iter().copied().filter(|d| d.is_finite()).fold(f64::NEG_INFINITY, f64::max);
    let floored = decibels.iter().map(|d| d.max(highest - DEPTH_DB)).collect();
    Series::sampled(name, colour, 0.0, spectrum.resolution().grid_hz, floored)
}

fn mark(x: f64, label: &str, colour: Colour, dashed: bool) -> Mark {
    Mark { x, label: label.into(), colour, dashed }
}

fn exits(events: &[Event]) -> Vec<Mark> {
    let label = |e: &Event| format!("exit of roller {}", e.roller);
    events.iter().map(|e| mark(1e-3 * e.expected_exit_ms, &label(e), Colour::Green, true)).collect()
}

/// One mark for each harmonic of the roller vertices: the raceway lines stand too close to be told apart at this scale.
fn harmonic_marks(findings: &Findings) -> Vec<Mark> {
    let Some(first) = findings.lines.first() else { return Vec::new() };
    let of_rollers = findings.lines.iter().filter(|l| l.name == first.name);
    of_rollers.map(|l| mark(l.predicted_hz, &format!("×{}", l.harmonic), Colour::Green, true)).collect()
}

/// Every predicted line with its name and frequency.
fn line_marks(findings: &Findings) -> Vec<Mark> {
    let colours = [Colour::Green, Colour::Purple, Colour::Teal];
    let fundamentals = &findings.prediction.facet_lines;
    let colour_of =
        |name: &str| fundamentals.iter().position(|f| f.0 == name).map_or(Colour::Grey, |i| colours[i % 3]);
    let text = |name: &str, harmonic: usize, hz: f64| match harmonic {
        1 => format!("{} {hz:.0} Hz", spoken(name)),
        more => format!("{} ×{more} {hz:.0} Hz", spoken(name)),
    };
    findings
        .lines
        .iter()
        .map(|l| mark(l.predicted_hz, &text(&l.name, l.harmonic, l.predicted_hz), colour_of(&l.name), true))
        .collect()
}

fn transient(findings: &Findings) -> Vec<Band> {
    let length = findings.transient_s();
    if length == 0.0 {
        return Vec::new();
    }
    let label = format!("transient of the notch, {:.1} ms", 1e3 * length);
    vec![Band { from: findings.start_s, to: findings.start_s + length, label }]
}

fn transient_note(findings: &Findings) -> String {
    findings.summary.notch.as_ref().map_or(String::new(), |n| {
        format!(
            "Second-order notch at {:.1} Hz, Q = {}, one pass. In the shaded time the filter still answers to the start \
             (60 dB of its ringing, time constant {:.2} ms).",
            n.centre_hz,
            n.q,
            1e3 * n.time_constant_s
        )
    })
}

fn strongest(findings: &Findings) -> String {
    let leading = findings.sensors.first().map(|s| s.name.clone());
    let here =
        findings.summary.tones.iter().filter(|t| Some(&t.sensor) == leading.as_ref() && t.harmonic == 1);
    let best = here
        .filter(|t| t.measured_hz.is_some())
        .max_by(|a, b| a.level_g.unwrap_or(0.0).total_cmp(&b.level_g.unwrap_or(0.0)));
    best.and_then(|t| t.measured_hz).map_or("no measurable frequency".into(), |hz| format!("{hz:.0} Hz"))
}

fn gravities(level: Option<f64>) -> String {
    level.map_or("not measurable".into(), |g| format!("{g:.0} g"))
}

/// A stable name as words.
pub(super) fn spoken(name: &str) -> String {
    name.replace('_', " ")
}
