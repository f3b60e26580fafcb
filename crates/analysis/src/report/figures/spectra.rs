//! Spectra: the paper's Figs. 3 and 7, the other sensors, low frequencies, the envelope.
//!
//! Colours say where a line comes from: green, purple and teal are the mesh, red is the defect, brown is the ring.

use stribeck_dsp::Spectrum;

use super::{mark, spoken};
use crate::artefacts;
use crate::findings::Findings;
use crate::paper;
use crate::plot::{Axis, Colour, Figure, Mark, Series};
use crate::tones;

/// How far below its highest value a spectrum is drawn [dB]; rounding noise lies lower.
const DEPTH_DB: f64 = 120.0;
/// Upper end of the low frequencies [Hz].
const LOW_HZ: f64 = 2_500.0;
/// Multiples of the defect's frequency that are marked.
const FAMILY: usize = 10;
/// Where each colour of the marks comes from.
const LEGEND: &str = "Dashed: green where roller vertices belong, purple nodes of the outer and teal of the inner raceway, red the                       defect, brown the free outer ring.";

/// Fig. 3: the leading sensor, as recorded.
pub(super) fn raw(findings: &Findings) -> Option<Figure> {
    let raw = findings.sensors.first()?.raw_density.as_ref()?;
    let mut figure = over_frequency("spectrum", "Fig. 3: power spectral density of a_y", (0.0, 0.5 * raw.sample_rate_hz()))
        .with(density("raw", Colour::Blue, raw))
        .caption(match tone(findings) {
            Some(hz) => format!(
                "The facet tone stands out at {hz:.0} Hz (paper: {:.0} Hz); dashed lines mark where it and its harmonics belong.",
                paper::TONE_HZ
            ),
            None => "No facet tone stands 10 dB above the background at this sensor; dashed lines mark where it and its \
                     harmonics belong."
                .into(),
        })
        .note(format!("{LEGEND} {}", stated(raw)));
    figure.marks = harmonic_marks(findings);
    Some(figure)
}

/// Figs. 7a and 7b: raw and notched, whole and about the tone.
pub(super) fn notched(findings: &Findings) -> Vec<Figure> {
    let Some(leading) = findings.sensors.first() else { return Vec::new() };
    let Some(raw) = &leading.raw_density else { return Vec::new() };
    let overlay = |id: &str, title: &str, range: (f64, f64)| {
        let mut figure = over_frequency(id, title, range).with(density("raw", Colour::Blue, raw));
        if let Some(filtered) = &leading.filtered_density {
            figure = figure.with(density("notched", Colour::Orange, filtered));
        }
        figure
    };
    let attenuation = findings.summary.notch.as_ref().and_then(|n| n.attenuation_db);
    let mut whole =
        overlay("spectrum-notched", "Fig. 7a: unfiltered and notched", (0.0, 0.5 * raw.sample_rate_hz()))
            .caption("The notch takes the tone and leaves everything else, its harmonics included.")
            .note(stated(raw));
    whole.marks = harmonic_marks(findings);
    let zoom = zoom(findings, raw);
    let title = format!("Fig. 7b: the same, {:.0} to {:.0} Hz", zoom.0, zoom.1);
    let mut zoomed = overlay("spectrum-zoom", &title, zoom)
        .caption(match (tone(findings), attenuation) {
            (Some(_), Some(db)) => format!(
                "The notch takes {db:.0} dB from the tone (paper: 25 dB), and at 4545 Hz what its transfer function says, {} dB \
                 (paper: 4 dB), whether there is a tone or not.",
                findings.summary.notch.as_ref().and_then(|n| n.attenuation_4545_db).map_or("–".into(), |db| format!("{db:.2}"))
            ),
            _ => "The notch stands where a tone is predicted, but at this sensor none stands out.".into(),
        })
        .note(format!(
            "{LEGEND} {} Lines closer than {:.0} Hz merge. How much is taken from the tone depends on the window and on the \
             filter's transient: see the notch in numbers.",
            stated(raw),
            raw.resolution().width_6db_hz
        ));
    zoomed.marks = line_marks(findings);
    zoomed.marks.push(mark(paper::CURSOR_HZ, "4545 Hz = 100 kHz/22", Colour::Grey, true));
    if let Some(hz) = tone(findings) {
        zoomed.marks.push(mark(hz, &format!("measured {hz:.0} Hz"), Colour::Blue, false));
    }
    vec![whole, zoomed]
}

/// All sensors about the tone, the low frequencies of the leading one, its envelope.
pub(super) fn others(findings: &Findings) -> Vec<Figure> {
    let Some(raw) = findings.sensors.first().and_then(|s| s.raw_density.as_ref()) else { return Vec::new() };
    let mut figures = Vec::new();
    if findings.sensors.len() > 1 {
        figures.push(all_sensors(findings, zoom(findings, raw), raw));
    }
    figures.push(low(findings, raw));
    figures.extend(envelope(findings));
    figures
}

/// Frequency of the dominant tone at the leading sensor [Hz].
fn tone(findings: &Findings) -> Option<f64> {
    let leading = findings.sensors.first()?;
    tones::dominant(&findings.summary.tones, &leading.name)?.measured_hz
}

/// The paper zooms to 4–6 kHz; a coarser mesh has its tone elsewhere.
fn zoom(findings: &Findings, raw: &Spectrum) -> (f64, f64) {
    let half = 0.5 * raw.sample_rate_hz();
    let centre = findings.summary.notch.as_ref().map_or(5000.0, |n| n.centre_hz);
    if (4000.0..6000.0).contains(&centre) && half >= 6000.0 {
        (4000.0, 6000.0)
    } else {
        ((centre - 1000.0).max(0.0), (centre + 1000.0).min(half))
    }
}

/// What a spectrum can tell apart, in one sentence.
fn stated(spectrum: &Spectrum) -> String {
    format!("Welch: {}.", spectrum.resolution())
}

fn low(findings: &Findings, raw: &Spectrum) -> Figure {
    let top = LOW_HZ.min(0.5 * raw.sample_rate_hz());
    let mut figure = over_frequency("spectrum-low", "Low frequencies: the defect and the ring", (0.0, top))
        .with(density("raw", Colour::Blue, raw));
    let split = artefacts::shows_family(raw, findings.prediction.kinematics.bpfo_hz);
    figure = figure
        .caption(if split {
            "Rollers pass the defect at BPFO, and its multiples stand apart."
        } else {
            "BPFO and its multiples belong at the red lines, but this record is too short to show them."
        })
        .note(format!("{LEGEND} {}", stated(raw)));
    figure.marks = physics_marks(findings, top);
    figure
}

fn envelope(findings: &Findings) -> Option<Figure> {
    let (spectrum, finding) = findings.envelope.as_ref().zip(findings.summary.envelope.as_ref())?;
    let bpfo = findings.prediction.kinematics.bpfo_hz;
    let top = (FAMILY as f64 + 1.0) * bpfo;
    let power = Axis::plain("Squared envelope spectrum", "dB re 1 g⁴");
    let mut figure =
        Figure::new("envelope", "Envelope spectrum", Axis::si("Frequency", "Hz").over(0.0, top), power)
            .with(density("squared envelope", Colour::Blue, spectrum));
    let seen: Vec<String> = finding
        .lines
        .iter()
        .filter(|l| l.measured_hz.is_some())
        .map(|l| format!("×{}", l.harmonic))
        .collect();
    let seen = if seen.is_empty() { "none".to_owned() } else { seen.join(", ") };
    figure = figure
        .caption(format!(
            "Knocks come at BPFO: of its multiples {seen} stand 10 dB above their surroundings."
        ))
        .note(format!(
            "Envelope of {:.0} to {:.0} Hz, {:.1} periods of BPFO on record. {}",
            finding.band_hz.0,
            finding.band_hz.1,
            finding.periods,
            stated(spectrum)
        ));
    figure.marks = physics_marks(findings, top);
    Some(figure)
}

/// The defect's family and the ring's modes below `top`.
fn physics_marks(findings: &Findings, top: f64) -> Vec<Mark> {
    let mut marks = Vec::new();
    if findings.prediction.defect.is_some() {
        let bpfo = findings.prediction.kinematics.bpfo_hz;
        let text = |n: usize| if n == 1 { format!("BPFO {bpfo:.1} Hz") } else { format!("×{n}") };
        marks.extend((1..=FAMILY).map(|n| mark(n as f64 * bpfo, &text(n), Colour::Red, true)));
    }
    marks.extend(
        findings
            .modes
            .iter()
            .filter(|m| m.1 < top)
            .map(|(n, hz)| mark(*hz, &format!("ring n = {n}, {hz:.0} Hz"), Colour::Brown, true)),
    );
    marks
}

fn all_sensors(findings: &Findings, zoom: (f64, f64), raw: &Spectrum) -> Figure {
    let colours = [Colour::Blue, Colour::Orange, Colour::Green, Colour::Purple, Colour::Red, Colour::Teal];
    let mut figure = over_frequency("spectrum-sensors", "All sensors, raw", zoom)
        .caption("The tone belongs to the contacts, so it stands at the same frequency wherever it is heard.")
        .note(format!("{LEGEND} {}", stated(raw)));
    for (sensor, colour) in findings.sensors.iter().zip(colours.into_iter().cycle()) {
        if let Some(spectrum) = &sensor.raw_density {
            figure = figure.with(density(&sensor.name, colour, spectrum));
        }
    }
    figure.marks = line_marks(findings);
    figure
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

/// The harmonics of every facet line. The raceway's stand so close to the rollers' that they carry no label at this scale.
fn harmonic_marks(findings: &Findings) -> Vec<Mark> {
    let colours = [Colour::Green, Colour::Purple, Colour::Teal];
    let label = |index: usize, harmonic: usize| match (index, harmonic) {
        (0, 1) => "roller vertices ×1".to_owned(),
        (0, more) => format!("×{more}"),
        _ => String::new(),
    };
    let mut marks = Vec::new();
    for (index, (name, _)) in findings.prediction.facet_lines.iter().enumerate().rev() {
        let of_name = findings.lines.iter().filter(|l| l.name == *name);
        marks.extend(
            of_name.map(|l| mark(l.predicted_hz, &label(index, l.harmonic), colours[index % 3], true)),
        );
    }
    let ring = findings.modes.iter().filter(|m| m.1 > LOW_HZ);
    marks.extend(ring.map(|(n, hz)| mark(*hz, &format!("ring n = {n}"), Colour::Brown, true)));
    marks
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
    let mut marks: Vec<Mark> = findings
        .lines
        .iter()
        .map(|l| mark(l.predicted_hz, &text(&l.name, l.harmonic, l.predicted_hz), colour_of(&l.name), true))
        .collect();
    marks.extend(
        findings.modes.iter().map(|(n, hz)| mark(*hz, &format!("ring n = {n}"), Colour::Brown, true)),
    );
    marks
}
