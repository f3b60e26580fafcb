//! Figures of the sensors' signals: over time and over frequency.

use stribeck_dsp::Spectrum;

use super::figures::{mark, sampled, spoken, transient};
use crate::findings::{Findings, SensorSignal};
use crate::plot::{Axis, Colour, Figure, Mark, Series};
use crate::summary::Event;
use crate::tones;

/// How far below its highest value a spectrum is drawn [dB]; rounding noise lies lower.
const DEPTH_DB: f64 = 120.0;

/// Raw and notched acceleration of the leading sensor, then the other sensors, then the instantaneous one.
pub(super) fn acceleration(findings: &Findings) -> Vec<Figure> {
    let Some(leading) = findings.sensors.first().filter(|s| !s.raw_g.is_empty()) else { return Vec::new() };
    let summary = &findings.summary;
    let mut figures = Vec::new();
    let mut raw = over_time("acceleration", &format!("Acceleration a_y at sensor “{}”", leading.name), "a_y")
        .with(sampled(findings, "mean over each interval", Colour::Blue, &leading.raw_g))
        .caption(format!(
            "Each roller that leaves the defect gives an impulse ({} here, about 180 g in the paper); between \
             them the noise reaches {} (about 50 g in the paper).",
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

/// Spectra of the leading sensor, whole and about the tone, and of all sensors.
pub(super) fn spectra(findings: &Findings) -> Vec<Figure> {
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
    let tone = tones::dominant(&findings.summary.tones, &leading.name).and_then(|t| t.measured_hz);
    let attenuation = findings.summary.notch.as_ref().and_then(|n| n.attenuation_db);
    let mut whole = overlay("spectrum", "Power spectral density of a_y, whole", (0.0, half))
        .caption(match tone {
            Some(hz) => format!(
                "The facet tone stands out at {hz:.0} Hz (paper: 4671 Hz); dashed lines mark where the harmonics of the \
                 rollers' vertices belong."
            ),
            None => "No facet tone stands 10 dB above the background at this sensor; dashed lines mark where the \
                     harmonics of the rollers' vertices belong."
                .into(),
        })
        .note(format!("Compare the paper's Figs. 3 and 7a. Welch: {}.", raw.resolution()));
    whole.marks = harmonic_marks(findings);
    let mut zoomed = overlay("spectrum-zoom", &format!("The same, {:.0} to {:.0} Hz", zoom.0, zoom.1), zoom)
        .caption(match (tone, attenuation) {
            (Some(_), Some(db)) => format!(
                "The notch takes {db:.0} dB from the tone (paper: 25 dB) and nothing from what lies a few hundred hertz away."
            ),
            _ => "The notch stands where a tone is predicted, but at this sensor none stands out.".into(),
        })
        .note(format!(
            "Compare the paper's Fig. 7b. Dashed: predicted from the facet counts. Welch: {}; lines closer than {:.0} Hz merge.",
            raw.resolution(),
            raw.resolution().width_6db_hz
        ));
    zoomed.marks = line_marks(findings);
    if let Some(hz) = tone {
        zoomed.marks.push(mark(hz, &format!("measured {hz:.0} Hz"), Colour::Blue, false));
    }
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

fn over_time(id: &str, title: &str, quantity: &str) -> Figure {
    Figure::new(id, title, Axis::si("Time", "s"), Axis::plain(quantity, "g")).synced("time")
}

fn over_frequency(id: &str, title: &str, (from, to): (f64, f64)) -> Figure {
    let density = Axis::plain("Power spectral density", "dB re 1 g²/Hz");
    Figure::new(id, title, Axis::si("Frequency", "Hz").over(from, to), density)
}

/// A spectrum in decibels, cut [`DEPTH_DB`] below its highest value.
fn density(name: &str, colour: Colour, spectrum: &Spectrum) -> Series {
    let decibels: Vec<f64> = spectrum.values().iter().map(|p| 10.0 * p.log10()).collect();
    let highest = decibels.iter().copied().filter(|d| d.is_finite()).fold(f64::NEG_INFINITY, f64::max);
    let floored = decibels.iter().map(|d| d.max(highest - DEPTH_DB)).collect();
    Series::sampled(name, colour, 0.0, spectrum.resolution().grid_hz, floored)
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

fn gravities(level: Option<f64>) -> String {
    level.map_or("not measurable".into(), |g| format!("{g:.0} g"))
}
