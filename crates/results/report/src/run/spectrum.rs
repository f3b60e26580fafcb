//! Spectra: the paper's Figs. 3 and 7, the other sensors, low frequencies, the envelope, and their lines.
//!
//! Colours say where a line comes from: green, purple and teal are the mesh, red is the defect, brown is the
//! ring.

mod diagnosis;
mod envelope;
pub(crate) mod families;
mod over_time;

use std::f64::consts::SQRT_2;

use maud::html;
use stribeck_analysis::artefacts;
use stribeck_analysis::families::{FamilyFinding, SIDEBANDS};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::loudest::loudest;
use stribeck_analysis::tones;
use stribeck_diagnosis::words::numbers::significant;
use stribeck_dsp::Spectrum;

use super::Subject;
use crate::Error;
use crate::page::{Section, charts, drawn, minus, sentence, spoken};
use crate::plot::{Axis, Colour, Cursor, Figure, Mark, Series};

/// How far below its highest value a spectrum is drawn [dB]; rounding noise lies lower.
const DEPTH_DB: f64 = 120.0;
/// Upper end of the low frequencies [Hz].
const LOW_HZ: f64 = 2_500.0;
/// Upper end of the initial view of a spectrum [Hz]; a click shows the whole band.
const FIRST_HZ: f64 = 10_000.0;
/// Spectra behind tabs.
const TABS: &str = "spectra";
/// Multiples of the defect's frequency that are marked.
const FAMILY: usize = 10;

pub(super) fn section(of: &Subject<'_>) -> Result<Section, Error> {
    let (findings, summary) = (of.findings, &of.findings.summary);
    let charts = charts(raw(findings).into_iter().chain(notched(findings)).chain(others(findings)));
    let figures = charts.chain(drawn(over_time::pictures(of.record, findings)?));
    let after = html! {
        (envelope::table(findings))
        (diagnosis::table(summary))
        h3 { "Lines of the mesh" }
        p { (families::in_words(summary)) }
        details { summary { "Where its lines were sought" } (families::table(summary)) }
    };
    Ok(Section::new("spectra", "Spectrum")
        .figures(figures, "The record is too short for a spectrum.")
        .after(after))
}

/// The legend of the colours that are drawn.
fn legend(findings: &Findings) -> String {
    let mesh = "families of facet lines that were found (full), and absent or open (dashed); green roller vertices, \
        purple nodes of the outer and teal of the inner raceway";
    let kinds = [
        (findings.summary.unsteady().is_none(), mesh),
        (findings.prediction.shocks.is_some(), "red: the defect"),
        (!findings.modes.is_empty(), "brown: modes of the free outer ring"),
    ];
    let drawn: Vec<&str> = kinds.into_iter().filter(|(drawn, _)| *drawn).map(|(_, words)| words).collect();
    if drawn.is_empty() { String::new() } else { format!("Upright: {}. ", drawn.join("; ")) }
}

/// The leading sensor, as recorded (the paper's Fig. 3).
fn raw(findings: &Findings) -> Option<Figure> {
    let leading = findings.sensors.first()?;
    let raw = leading.raw_density.as_ref()?;
    let title = format!("Power spectral density of a_y at sensor “{}”", leading.name);
    let mut figure = whole_band("spectrum", &title, raw)
        .tabbed(TABS, "as recorded")
        .with(density("raw", Colour::Blue, raw))
        .caption(match loudest_in_words(findings) {
            Some(words) => format!("{} {words}", found(findings)),
            None => found(findings),
        })
        .note(legend(findings) + &stated(raw));
    figure.marks = harmonic_marks(findings);
    figure.cursor = Some(cursor(findings));
    Some(figure)
}

/// Which families were found, in one sentence.
fn found(findings: &Findings) -> String {
    if findings.summary.unsteady().is_some() {
        return "The speed changes: what stands here are resonances, and lines are smeared.".into();
    }
    let name = |f: &FamilyFinding| Some(format!("{} at {:.0} Hz", f.spoken(), f.carrier_hz?));
    let all: Vec<String> = findings.summary.families.iter().filter_map(name).collect();
    let judged = |f: &FamilyFinding| f.predicted_hz.is_some();
    if all.is_empty() && !findings.summary.families.iter().any(judged) {
        "The record is too short to judge families of facet lines.".into()
    } else if all.is_empty() {
        "No family of facet lines is there.".into()
    } else {
        format!("Mesh: {}, with sidebands at multiples of BPFO.", all.join(", "))
    }
}

/// Raw and notched, whole and about the tone (the paper's Figs. 7a and 7b).
fn notched(findings: &Findings) -> Vec<Figure> {
    let Some(leading) = findings.sensors.first().filter(|_| findings.summary.unsteady().is_none()) else {
        return Vec::new();
    };
    let (Some(raw), Some(filtered)) = (&leading.raw_density, &leading.filtered_density) else {
        return Vec::new();
    };
    // Drawn first, so that the raw curve stays visible where both agree.
    let overlaid = |figure: Figure| {
        figure.with(density("notched", Colour::Orange, filtered)).with(density("raw", Colour::Blue, raw))
    };
    let attenuation = findings.summary.notch.as_ref().and_then(|n| n.attenuation_db);
    let mut whole = overlaid(whole_band("spectrum-notched", "Raw and notched", raw))
        .tabbed(TABS, "tone filtered out")
        .caption("The notch removes the carrier and leaves its sidebands and harmonics.")
        .note(legend(findings) + &stated(raw));
    whole.marks = harmonic_marks(findings);
    let zoom = zoom(findings, raw);
    let title = format!("The same, {:.0} to {:.0} Hz", zoom.0, zoom.1);
    let mut zoomed = overlaid(over_frequency("spectrum-zoom", &title, zoom))
        .tabbed(TABS, "about the tone")
        .caption(match (tone(findings), attenuation) {
            (Some(_), Some(db)) => format!("At its centre the notch lowers the density by {db:.0} dB."),
            _ => "The notch stands where a tone is predicted; none stands out at this sensor.".into(),
        })
        .note(format!(
            "{}{} Lines closer than {:.0} Hz merge.",
            legend(findings),
            stated(raw),
            raw.resolution().width_6db_hz
        ));
    zoomed.marks = line_marks(findings);
    zoomed.cursor = Some(cursor(findings));
    vec![whole, zoomed]
}

/// All sensors about the tone, the low frequencies of the leading one, its envelope.
fn others(findings: &Findings) -> Vec<Figure> {
    let Some(raw) = findings.sensors.first().and_then(|s| s.raw_density.as_ref()) else { return Vec::new() };
    let mut figures = Vec::new();
    if findings.sensors.len() > 1 && findings.summary.unsteady().is_none() {
        figures.push(all_sensors(findings, zoom(findings, raw), raw));
    }
    figures.push(low(findings, raw));
    figures.extend(envelope::figure(findings));
    figures
}

/// Frequency of the dominant tone at the leading sensor [Hz].
fn tone(findings: &Findings) -> Option<f64> {
    let leading = findings.sensors.first()?;
    tones::dominant(&findings.summary.tones, &leading.name)?.measured_hz
}

fn zoom(findings: &Findings, raw: &Spectrum) -> (f64, f64) {
    let notch_hz = findings.summary.notch.as_ref().map(|n| n.centre_hz);
    about_the_tone(notch_hz, &line_marks(findings), 0.5 * raw.sample_rate_hz())
}

/// Where a spectrum is drawn close: about the notch, or without one about the carriers among `marks`, those
/// that are there first. The paper zooms to 4–6 kHz; a coarser mesh has its tone elsewhere.
pub(crate) fn about_the_tone(notch_hz: Option<f64>, marks: &[Mark], half_hz: f64) -> (f64, f64) {
    const PAPER_HZ: (f64, f64) = (4000.0, 6000.0);
    const AROUND_HZ: f64 = 1000.0;
    let dashed = marks.iter().all(|mark| mark.dashed);
    let carriers = marks.iter().filter(|mark| mark.dashed == dashed && (0.0..half_hz).contains(&mark.x));
    let [low, high] = match notch_hz {
        Some(hz) => [hz, hz],
        None => carriers.fold([f64::INFINITY, 0.0], |[low, high], mark| [mark.x.min(low), mark.x.max(high)]),
    };
    if half_hz >= PAPER_HZ.1 && (low > high || PAPER_HZ.0 <= low && high < PAPER_HZ.1) {
        return PAPER_HZ;
    }
    // Without any, half the sample rate.
    let low = low.min(half_hz);
    ((low - AROUND_HZ).max(0.0), (high.max(low) + AROUND_HZ).min(half_hz))
}

/// Resolution of a spectrum, in one sentence.
fn stated(spectrum: &Spectrum) -> String {
    format!("Welch: {}.", spectrum.resolution())
}

fn low(findings: &Findings, raw: &Spectrum) -> Figure {
    // The lines of a slow bearing stand in the spectrum of the whole record alone.
    let raw = findings.fine.as_ref().unwrap_or(raw);
    let top = LOW_HZ.min(0.5 * raw.sample_rate_hz());
    let drawn = (top / raw.resolution().grid_hz) as usize + 2;
    let shown =
        [(findings.prediction.shocks.is_some(), "the defect"), (!findings.modes.is_empty(), "the ring")];
    let shown: Vec<&str> = shown.into_iter().filter(|(shown, _)| *shown).map(|(_, what)| what).collect();
    let title = match shown.join(" and ") {
        none if none.is_empty() => "Low frequencies".to_owned(),
        shown => format!("Low frequencies: {shown}"),
    };
    let mut figure = over_frequency("spectrum-low", &title, (0.0, top))
        .tabbed(TABS, "low frequencies")
        .with(decibels("raw", Colour::Blue, raw, drawn));
    let unsteady = findings.summary.unsteady().is_some();
    let caption = match findings.prediction.shocks.map(|shocks| (shocks.name(), shocks.hz)) {
        None if unsteady => {
            "The speed changes: what comes once a passage is smeared here, and stands over the angle."
                .to_owned()
        }
        None => "There is no defect whose lines could stand here.".to_owned(),
        Some((name, hz)) if artefacts::shows_family(raw, hz) => {
            format!("The record is long enough to separate the multiples of {name}.")
        }
        Some((name, hz)) => format!(
            "{name} and its multiples belong at the red lines; this record holds {:.1} of its periods, too \
             few to show them.",
            raw.resolution().record_s * hz
        ),
    };
    figure = figure.caption(caption).note(legend(findings) + &stated(raw));
    figure.marks = physics_marks(findings, top);
    figure.cursor = Some(cursor(findings));
    figure
}

/// The defect's family and the ring's modes below `top`.
fn physics_marks(findings: &Findings, top: f64) -> Vec<Mark> {
    let mut marks = Vec::new();
    if let Some(shocks) = findings.prediction.shocks {
        let name = shocks.name();
        let diagnosis = findings.summary.diagnosis.as_ref();
        let family = diagnosis.and_then(|found| found.families.iter().find(|f| f.name == shocks.defect));
        let moved = family.and_then(|f| f.from_motion_hz).map(|hz| shocks.defect.shocks_per_period() * hz);
        // Where the cage lags, multiples of rolling without slip run off the lines.
        let hz = moved.unwrap_or(shocks.hz);
        let text = |n: usize| if n == 1 { format!("{name} {hz:.1} Hz") } else { format!("×{n}") };
        marks.extend((1..=FAMILY).map(|n| Mark::new(n as f64 * hz, text(n), Colour::Red, true)));
    }
    marks.extend(
        findings
            .modes
            .iter()
            .filter(|m| m.1 < top)
            .map(|(n, hz)| Mark::new(*hz, format!("ring n = {n}, {hz:.0} Hz"), Colour::Brown, true)),
    );
    marks
}

fn all_sensors(findings: &Findings, zoom: (f64, f64), raw: &Spectrum) -> Figure {
    let colours = [Colour::Blue, Colour::Orange, Colour::Green, Colour::Purple, Colour::Red, Colour::Teal];
    let mut figure = over_frequency("spectrum-sensors", "All sensors, raw", zoom)
        .tabbed(TABS, "all sensors")
        .caption(
            "The comb has the same spacing everywhere; which of its lines is strongest depends on the place.",
        )
        .note(legend(findings) + &stated(raw));
    for (sensor, colour) in findings.sensors.iter().zip(colours.into_iter().cycle()) {
        if let Some(spectrum) = &sensor.raw_density {
            figure = figure.with(density(&sensor.name, colour, spectrum));
        }
    }
    figure.marks = line_marks(findings);
    figure
}

/// Over the whole band of a spectrum, of which its lower part is shown at first.
fn whole_band(id: &str, title: &str, spectrum: &Spectrum) -> Figure {
    let half_hz = 0.5 * spectrum.sample_rate_hz();
    let mut figure = over_frequency(id, title, (0.0, half_hz.min(FIRST_HZ)));
    figure.wide = (half_hz > FIRST_HZ).then_some((0.0, half_hz));
    figure
}

/// Where most of the signal lies, and what makes it, in words.
pub(crate) fn loudest_in_words(findings: &Findings) -> Option<String> {
    Some(loudest_sentences(findings)?.join(" "))
}

/// Where most of the signal lies, beside the strongest facet tone, and what is predicted there.
pub(crate) fn loudest_sentences(findings: &Findings) -> Option<[String; 2]> {
    let leading = findings.sensors.first()?;
    let found = loudest(leading.raw_density.as_ref()?)?;
    let (low, high) = found.band_hz;
    let kilo = |hz: f64| significant(1e-3 * hz, 3);
    let inside = |hz: f64| (low..high).contains(&hz);
    let share = 100.0 * (found.rms / found.total_rms).powi(2);
    let tone = tones::dominant(&findings.summary.tones, &leading.name);
    let tone = tone.and_then(|tone| {
        let (hz, level_g) = (tone.measured_hz?, tone.level_g? / SQRT_2);
        Some(format!(
            "; the strongest tone of corners of the mesh, {hz:.0} Hz, has {} g",
            significant(level_g, 3)
        ))
    });
    let mut there: Vec<String> = Vec::new();
    let harmonics: Vec<String> = findings
        .lines
        .iter()
        .filter(|line| Some(&line.name) == findings.prediction.facet_lines.first().map(|(name, _)| name))
        .filter(|line| line.harmonic > 1 && inside(line.predicted_hz))
        .map(|line| format!("×{}", line.harmonic))
        .collect();
    if !harmonics.is_empty() {
        there.push(format!("{} of the tone of the mesh\u{2019}s corners", harmonics.join(", ")));
    }
    let modes: Vec<String> =
        findings.modes.iter().filter(|m| inside(m.1)).map(|(n, _)| format!("n = {n}")).collect();
    if !modes.is_empty() {
        there.push(format!("bending of the free ring with {}", modes.join(", ")));
    }
    let why = if there.is_empty() {
        "no line of the mesh, the defect or the free ring is predicted there: ringing of rings and housing \
         on their contacts, struck by entries, exits and facets, is the likely cause"
            .to_owned()
    } else {
        format!(
            "predicted there: {}; ringing of rings and housing on their contacts adds to it",
            there.join("; ")
        )
    };
    let place = format!(
        "{share:.0} % of its power ({} of {} g RMS) lies between {} and {} kHz{}.",
        significant(found.rms, 3),
        significant(found.total_rms, 3),
        kilo(low),
        kilo(high),
        tone.unwrap_or_default(),
    );
    Some([place, sentence(&why)])
}

fn over_frequency(id: &str, title: &str, (from, to): (f64, f64)) -> Figure {
    let density = Axis::plain("Power spectral density", "dB re 1 g²/Hz");
    Figure::new(id, title, Axis::si("Frequency", "Hz").over(from, to), density)
}

/// Frequencies to which the cursor of a run can be set: the families of defects, the shaft, the facets.
fn cursor(findings: &Findings) -> Cursor {
    let k = &findings.prediction.kinematics;
    let mut known = vec![
        ("BPFO".to_owned(), k.bpfo_hz),
        ("BPFI".to_owned(), k.bpfi_hz),
        ("2×BSF".to_owned(), 2.0 * k.bsf_hz),
        ("FTF".to_owned(), k.cage_hz),
        ("shaft".to_owned(), k.shaft_hz),
    ];
    known.extend(findings.prediction.facet_lines.iter().map(|(name, hz)| (spoken(name), *hz)));
    known.retain(|(_, hz)| *hz > 0.0);
    Cursor { known }
}

/// A spectrum in decibels, cut [`DEPTH_DB`] below its highest value.
pub(crate) fn density(name: &str, colour: Colour, spectrum: &Spectrum) -> Series {
    decibels(name, colour, spectrum, spectrum.values().len())
}

/// Its first `most` values.
fn decibels(name: &str, colour: Colour, spectrum: &Spectrum, most: usize) -> Series {
    let decibels: Vec<f64> = spectrum.values().iter().take(most).map(|p| 10.0 * p.log10()).collect();
    let highest = decibels.iter().copied().filter(|d| d.is_finite()).fold(f64::NEG_INFINITY, f64::max);
    let floored = decibels.iter().map(|d| d.max(highest - DEPTH_DB)).collect();
    Series::sampled(name, colour, 0.0, spectrum.resolution().grid_hz, floored)
}

/// The harmonics of every facet line. The raceway's stand so close to the rollers' that they carry no label
/// at this scale.
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
            of_name.map(|l| Mark::new(l.predicted_hz, label(index, l.harmonic), colours[index % 3], true)),
        );
    }
    let ring = findings.modes.iter().filter(|m| m.1 > LOW_HZ);
    marks.extend(ring.map(|(n, hz)| Mark::new(*hz, format!("ring n = {n}"), Colour::Brown, true)));
    marks
}

/// Carrier and sidebands of every family that was found; the predicted carrier of those that were not, by
/// geometry where the recorded motion does not yield it.
fn line_marks(findings: &Findings) -> Vec<Mark> {
    let bpfo = findings.summary.kinematics.bpfo_hz.unwrap_or(findings.prediction.kinematics.bpfo_hz);
    let mut marks = Vec::new();
    let families = findings.summary.families.iter().zip(&findings.prediction.facet_lines);
    for ((family, (_, geometry_hz)), colour) in families.zip([Colour::Green, Colour::Purple, Colour::Teal]) {
        let Some(carrier) = family.carrier_hz else {
            let word = if family.is_open() { "open" } else { "absent" };
            let (hz, word) = family.predicted_hz.map_or((*geometry_hz, "by geometry"), |hz| (hz, word));
            marks.push(Mark::new(hz, format!("{} {word}", spoken(&family.name)), colour, true));
            continue;
        };
        for m in -SIDEBANDS..=SIDEBANDS {
            let label = match m {
                0 => format!("{} {carrier:.0} Hz", family.spoken()),
                _ => minus(format!("{m:+}")),
            };
            marks.push(Mark::new(carrier + f64::from(m) * bpfo, label, colour, false));
        }
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without a notch the zoom was 4 to 6 kHz, whose marks lay elsewhere.
    #[test]
    fn issue_the_close_spectrum_is_about_the_carriers() {
        let at = |hz: f64, dashed: bool| Mark::new(hz, "", Colour::Green, dashed);
        let zoom = |notch_hz, marks: &[Mark]| about_the_tone(notch_hz, marks, 50_000.0);
        assert_eq!(zoom(None, &[at(1500.0, true), at(1800.0, true)]), (500.0, 2800.0));
        assert_eq!(zoom(None, &[at(1500.0, true), at(9000.0, false)]), (8000.0, 10_000.0));
        assert_eq!(zoom(Some(1700.0), &[at(9000.0, false)]), (700.0, 2700.0));
        // The paper's carriers lie where it looks, and so does a record without any.
        assert_eq!(zoom(None, &[at(4545.0, true), at(4671.0, true)]), (4000.0, 6000.0));
        assert_eq!(zoom(None, &[]), (4000.0, 6000.0));
        assert_eq!(about_the_tone(None, &[], 5000.0), (4000.0, 5000.0));
    }
}
