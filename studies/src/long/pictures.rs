//! Spectra of a long record, beside those of its first 30 ms.

use anyhow::Result;
use stribeck_analysis::findings::Findings;
use stribeck_analysis::signal::density_of_start;
use stribeck_report::plot::{Axis, Colour, Figure, Mark, Series};

use crate::Sheet;

/// The paper's record [s] and its grid [Hz].
const PAPER_RECORD_S: f64 = 0.03;
const GRID_HZ: f64 = 3.0;
/// Half the range of the picture of the facet lines [Hz].
const ABOUT_HZ: f64 = 250.0;
/// Upper end of the pictures of the defect's family [Hz].
const FAMILY_TOP_HZ: f64 = 1000.0;

/// Adds three pictures of the leading sensor's spectrum to the sheet: whole, about the facet lines, and at
/// low frequencies.
///
/// # Errors
/// When a picture cannot be written.
pub(super) fn spectra(sheet: &mut Sheet, findings: &Findings) -> Result<()> {
    let Some(leading) = findings.sensors.first() else { return Ok(()) };
    let Some(long) = &leading.raw_density else { return Ok(()) };
    let rate = long.sample_rate_hz();
    let short = density_of_start(&leading.raw_g, rate, PAPER_RECORD_S, GRID_HZ)?;
    let figure = |id: &str, title: &str, range: (f64, f64), ringing: bool| {
        let mut figure = over(id, title, range, "Power spectral density", "dB re 1 g²/Hz");
        if let Some(short) = short.as_ref().filter(|_| ringing) {
            let points = (short.frequencies_hz(), short.values());
            figure = figure.with(curve("first 30 ms, zero-padded to 3 Hz", Colour::Grey, points, range));
        }
        figure.with(curve("whole record", Colour::Blue, (long.frequencies_hz(), long.values()), range))
    };
    let stated = format!("a_y at `{}`, Welch: {}.", leading.name, long.resolution());
    let mut whole = figure("spectrum", "Spectrum of the whole record", (0.0, 0.5 * rate), false)
        .caption(format!("{stated} Green: where roller vertices and their harmonics belong."));
    whole.marks = vertices(findings);
    sheet.picture(&whole)?;

    let lines = &findings.prediction.facet_lines;
    let lowest = lines.iter().map(|l| l.1).fold(0.5 * rate, f64::min);
    let highest = lines.iter().map(|l| l.1).fold(0.0, f64::max);
    let range = ((lowest - ABOUT_HZ).max(0.0), highest + ABOUT_HZ);
    let mut zoom = figure("lines", "The facet lines, resolved", range, true).caption(
        "Grey, the paper\u{2019}s record length on the paper\u{2019}s grid of 3 Hz: one hump 67 Hz wide. \
         Blue, a record that resolves 3 Hz. \
         Dashed: roller vertices (green), nodes of the outer (purple) and of the inner raceway (teal) by \
         rolling without slip; solid: \
         by the recorded motion.",
    );
    let colours = [Colour::Green, Colour::Purple, Colour::Teal];
    for ((name, hz), colour) in lines.iter().zip(colours) {
        zoom.marks.push(mark(*hz, &name.replace('_', " "), colour, true));
        if let Some(ratio) = findings.summary.kinematics.ratio(name) {
            zoom.marks.push(mark(ratio * hz, "", colour, false));
        }
    }
    sheet.picture(&zoom)?;

    let mut low = figure("low", "Low frequencies", (0.0, FAMILY_TOP_HZ), true)
        .caption("Red: BPFO and its multiples. Brown: bending modes of the free outer ring.");
    low.marks = family(findings);
    let modes = findings.modes.iter().filter(|m| m.1 < FAMILY_TOP_HZ);
    low.marks.extend(modes.map(|(n, hz)| mark(*hz, &format!("ring n = {n}"), Colour::Brown, true)));
    sheet.picture(&low)
}

/// The envelope spectrum with the defect's family.
///
/// # Errors
/// When the picture cannot be written.
pub(super) fn envelope(sheet: &mut Sheet, findings: &Findings) -> Result<()> {
    let Some(spectrum) = &findings.envelope else { return Ok(()) };
    let range = (0.0, FAMILY_TOP_HZ);
    let mut figure = over("envelope", "Squared envelope spectrum", range, "Squared envelope", "dB re 1 g⁴")
        .with(curve("squared envelope", Colour::Blue, (spectrum.frequencies_hz(), spectrum.values()), range))
        .caption(format!("Red: BPFO and its multiples. Hann window: {}.", spectrum.resolution()));
    figure.marks = family(findings);
    sheet.picture(&figure)
}

fn over(id: &str, title: &str, (from, to): (f64, f64), quantity: &str, unit: &str) -> Figure {
    let axis = Axis::si("Frequency", "Hz").over(from, to);
    Figure::new(id, title, axis, Axis::plain(quantity, unit))
}

/// The part of a spectrum, frequencies [Hz] and powers, that lies in a range, in decibels.
fn curve(name: &str, colour: Colour, (hz, power): (&[f64], &[f64]), (from, to): (f64, f64)) -> Series {
    // The mean is taken out of every segment: zero frequency would be a pit of rounding.
    let points = hz.iter().zip(power).skip(1).filter(|p| (from..=to).contains(p.0));
    let (x, y): (Vec<f64>, Vec<f64>) = points.map(|(hz, p)| (*hz, 10.0 * p.log10())).unzip();
    Series::listed(name, colour, x, y)
}

fn mark(x: f64, label: &str, colour: Colour, dashed: bool) -> Mark {
    Mark { x, label: label.to_owned(), colour, dashed }
}

fn vertices(findings: &Findings) -> Vec<Mark> {
    let of_rollers = findings.lines.iter().filter(|l| l.name == "roller_vertices");
    of_rollers.map(|l| mark(l.predicted_hz, &format!("×{}", l.harmonic), Colour::Green, true)).collect()
}

fn family(findings: &Findings) -> Vec<Mark> {
    let bpfo = findings.prediction.kinematics.bpfo_hz;
    if findings.prediction.standing().is_none() || bpfo <= 0.0 {
        return Vec::new();
    }
    let multiples = (1..).take_while(|n| f64::from(*n) * bpfo < FAMILY_TOP_HZ);
    let label = |n: i32| if n == 1 { format!("BPFO {bpfo:.1} Hz") } else { format!("×{n}") };
    multiples.map(|n| mark(f64::from(n) * bpfo, &label(n), Colour::Red, true)).collect()
}
