//! Curves of all sides over each other.

use stribeck_analysis::comparison::{Comparison, Member, Sampled, Side};
use stribeck_diagnosis::Defect;

use crate::plot::{Axis, Colour, Figure, Mark, Series};

/// How far below its highest value a spectrum is drawn [dB]; rounding noise lies lower.
const DEPTH_DB: f64 = 120.0;
/// Where people look first [Hz].
const LOW_HZ: f64 = 10_000.0;
/// Lowest cyclic frequency drawn [Hz].
const LOWEST_CYCLIC_HZ: f64 = 2.0;
/// Harmonics of the inner raceway's frequency up to which an envelope spectrum is drawn.
const HARMONICS: f64 = 3.2;
/// Lines of an envelope spectrum between two harmonics at least: of fewer none stands out.
const LINES: f64 = 10.0;
/// Upper end of an envelope spectrum where no family is known [Hz].
const UNKNOWN_HZ: f64 = 500.0;

pub(super) struct Figures {
    pub(super) trace: Vec<Figure>,
    pub(super) spectra: Vec<Figure>,
    pub(super) envelope: Vec<Figure>,
    pub(super) forces: Vec<Figure>,
}

impl Figures {
    pub(super) fn of(comparison: &Comparison) -> Self {
        let sides: Vec<(&Side, Colour)> = comparison.sides.iter().zip(Colour::FOREGROUNDS).collect();
        let one_unit = sides.windows(2).all(|pair| pair[0].0.unit == pair[1].0.unit);
        Self {
            trace: traces(&sides, one_unit).into_iter().collect(),
            spectra: spectra(&sides, one_unit),
            envelope: envelopes(comparison, &sides).into_iter().collect(),
            forces: distribution(&sides).into_iter().chain(support(&sides)).collect(),
        }
    }
}

/// Sides with their first signal, the strongest first, so that the weaker are drawn over it.
fn loudest_first<'a>(sides: &[(&'a Side, Colour)]) -> Vec<(&'a Side, &'a Member, Colour)> {
    let member = |(side, colour): &(&'a Side, Colour)| Some((*side, side.members.first()?, *colour));
    let mut all: Vec<_> = sides.iter().filter_map(member).collect();
    let rms = |member: &Member| member.shape.map_or(0.0, |shape| shape.rms);
    all.sort_by(|a, b| rms(b.1).total_cmp(&rms(a.1)));
    all
}

/// The beginning of every signal; in units that do not compare, each over its own root mean square.
fn traces(sides: &[(&Side, Colour)], one_unit: bool) -> Option<Figure> {
    let axis = match sides.first()?.0.unit.as_str() {
        _ if !one_unit => Axis::plain("Signal over its root mean square", ""),
        unit => Axis::plain("Signal", unit),
    };
    let end_s = |side: &Side| {
        side.members.first().map_or(0.0, |m| m.trace.start + m.trace.step * m.trace.values.len() as f64)
    };
    let shortest_s = sides.iter().map(|(side, _)| end_s(side)).fold(f64::INFINITY, f64::min);
    let mut figure = Figure::new(
        "trace",
        "Signals over time",
        Axis::si("Time", "s").over(0.0, shortest_s),
        axis,
    )
    .caption("From the beginning of each; the loudest lies behind the others.")
    .note(
        "Of several starts the first is drawn. Records and runs begin at their own moment: equal times \
             are not equal places of the shaft. A click on a name in the legend hides its curve.",
    );
    for (side, member, colour) in loudest_first(sides) {
        let factor = if one_unit { 1.0 } else { member.shape.map_or(1.0, |shape| 1.0 / shape.rms) };
        figure = figure.with(sampled(&side.label, colour, &member.trace, |x| factor * x));
    }
    Some(figure)
}

/// Densities up to 10 kHz, and over the whole band where there is more.
fn spectra(sides: &[(&Side, Colour)], one_unit: bool) -> Vec<Figure> {
    let densities: Vec<(&Side, Colour, Sampled)> =
        sides.iter().filter_map(|(side, colour)| Some((*side, *colour, side.density()?))).collect();
    let half_hz = densities.iter().map(|(_, _, d)| d.step * d.values.len() as f64).fold(0.0, f64::max);
    if half_hz == 0.0 {
        return Vec::new();
    }
    let unit = match densities[0].0.unit.as_str() {
        _ if !one_unit => "dB re 1 unit²/Hz".to_owned(),
        "" => "dB re 1/Hz".to_owned(),
        unit => format!("dB re 1 {unit}²/Hz"),
    };
    let draw = |id: &str, title: &str, to_hz: f64| {
        let mut figure = Figure::new(
            id,
            title,
            Axis::si("Frequency", "Hz").over(0.0, to_hz),
            Axis::plain("Power spectral density", &unit),
        );
        for (side, colour, density) in &densities {
            if let Some([low, high]) = side.density_band() {
                for (edge, name) in [(high, "90 %"), (low, "10 %")] {
                    let edge = Sampled { values: edge, ..density.clone() };
                    let name = format!("{}, {name} of starts below", side.label);
                    figure = figure.with(sampled(&name, *colour, &edge, decibel_of(density)).as_edge());
                }
            }
            figure = figure.with(sampled(&side.label, *colour, density, decibel_of(density)));
        }
        let resolutions = densities.iter().map(|(side, _, d)| format!("{} {:.2} Hz", side.label, d.step));
        figure.note(format!(
            "Welch\u{2019}s average, Hann window; of several starts the mean of the powers, with the middle \
             80 % of them shaded. Distance of the lines: {}. A line stands lower where the distance is larger.",
            resolutions.collect::<Vec<_>>().join(", ")
        ))
    };
    let low = draw("spectrum", "Spectra", LOW_HZ.min(half_hz)).caption(levels(&densities));
    let whole = (half_hz > 1.2 * LOW_HZ).then(|| {
        draw("spectrum-whole", "The whole band", half_hz)
            .caption("Resonances and contact above what an accelerometer is usually read for.")
    });
    std::iter::once(low).chain(whole).collect()
}

/// How strong each is below 10 kHz, in a sentence.
fn levels(densities: &[(&Side, Colour, Sampled)]) -> String {
    let rms = |density: &Sampled| {
        let lines = ((LOW_HZ / density.step) as usize + 1).min(density.values.len());
        density.values[..lines].iter().map(|p| p * density.step).sum::<f64>().sqrt()
    };
    let each = densities.iter().map(|(side, _, density)| {
        let level = stribeck_diagnosis::words::numbers::significant(rms(density), 3);
        format!("{} {level} {}", side.label, side.unit).trim_end().to_owned()
    });
    format!("Root mean square below 10 kHz: {}.", each.collect::<Vec<_>>().join(", "))
}

fn decibel_of(density: &Sampled) -> impl Fn(f64) -> f64 + use<> {
    let highest = density.values.iter().copied().filter(|p| p.is_finite()).fold(0.0, f64::max);
    let floor = 10.0 * highest.max(f64::MIN_POSITIVE).log10() - DEPTH_DB;
    move |power: f64| (10.0 * power.max(f64::MIN_POSITIVE).log10()).max(floor)
}

/// Envelope spectra of one band: over the frequency, or over orders of the shaft where the speeds differ.
fn envelopes(comparison: &Comparison, sides: &[(&Side, Colour)]) -> Option<Figure> {
    let band_hz = comparison.band_hz()?;
    let orders = !comparison.is_of_one_speed();
    // Orders for all, or frequencies for all.
    let unit_of = |side: &Side| if orders { side.shaft_hz.unwrap_or(1.0) } else { 1.0 };
    let fastest = |side: &Side| {
        let families = side.members.iter().flat_map(|member| &member.families);
        families.map(|f| f.expected_hz).fold(0.0, f64::max) / unit_of(side)
    };
    let highest = sides.iter().map(|(side, _)| fastest(side)).fold(0.0, f64::max);
    let end = if highest > 0.0 { HARMONICS * highest } else { UNKNOWN_HZ / unit_of(sides[0].0) };
    let axis = if orders { Axis::plain("Order of the shaft", "") } else { Axis::si("Frequency", "Hz") };
    let mut figure = Figure::new(
        "envelope",
        "Squared envelope spectra",
        axis.over(0.0, end),
        Axis::plain("Power over the mean power²", "dB"),
    );
    let (mut bands, mut short) = (Vec::new(), Vec::new());
    for (side, colour) in sides {
        let Some((spectrum, (low_hz, high_hz))) = side.envelope(band_hz) else { continue };
        if end * unit_of(side) < LINES * HARMONICS * spectrum.step {
            short.push(side.label.as_str());
            continue;
        }
        let first = ((LOWEST_CYCLIC_HZ / spectrum.step) as usize).max(1).min(spectrum.values.len());
        let shown = Sampled {
            start: first as f64 * spectrum.step / unit_of(side),
            step: spectrum.step / unit_of(side),
            values: spectrum.values[first..].to_vec(),
        };
        let decibel = |power: f64| 10.0 * power.max(1e-30).log10();
        figure = figure.with(sampled(&side.label, *colour, &shown, decibel));
        bands.push(format!(
            "{} {:.0} to {:.0} Hz, lines {:.2} Hz apart",
            side.label, low_hz, high_hz, spectrum.step
        ));
    }
    if figure.series.is_empty() {
        return None;
    }
    figure.marks = marks(sides, unit_of);
    let claimed = |side: &Side| {
        let claimed = Defect::ALL
            .into_iter()
            .filter(|d| side.members.iter().any(|member| member.claimed().any(|family| family.name == *d)));
        let names: Vec<&str> = claimed.map(Defect::name).collect();
        if names.is_empty() { "none".to_owned() } else { names.join(" and ") }
    };
    let each = sides.iter().map(|(side, _)| format!("{} {}", side.label, claimed(side)));
    Some(figure.caption(format!("Claimed as defects: {}.", each.collect::<Vec<_>>().join(", "))).note(
        format!(
            "Dashed: where the families are expected without slip. Bands: {}.{}{}",
            bands.join("; "),
            if short.is_empty() {
                String::new()
            } else {
                format!(" Too short for one: {}.", short.join(", "))
            },
            if orders { " The speeds differ, so frequencies are divided by that of the shaft." } else { "" }
        ),
    ))
}

/// Expected families: of the first side, and of those of others that stand elsewhere.
fn marks(sides: &[(&Side, Colour)], unit_of: impl Fn(&Side) -> f64) -> Vec<Mark> {
    /// Marks nearer than this part are one.
    const SAME: f64 = 2e-3;
    let mut marks: Vec<Mark> = Vec::new();
    for (number, (side, colour)) in sides.iter().enumerate() {
        let Some(member) = side.members.first() else { continue };
        for family in &member.families {
            let x = family.expected_hz * family.name.shocks_per_period() / unit_of(side);
            if marks.iter().any(|mark| (mark.x / x - 1.0).abs() < SAME) {
                continue;
            }
            let label = match number {
                0 => family.name.shocks_name().to_owned(),
                _ => format!("{} of {}", family.name.shocks_name(), side.label),
            };
            let colour = if number == 0 { Colour::Black } else { *colour };
            marks.push(Mark { x, label, colour, dashed: true });
        }
    }
    marks
}

/// Mean force on a roller by its place.
fn distribution(sides: &[(&Side, Colour)]) -> Option<Figure> {
    let mut figure = Figure::new(
        "load-distribution",
        "Load distribution",
        Axis::angle("Angle from the x axis, counter-clockwise"),
        Axis::si("Outer-raceway force", "N"),
    );
    for (side, colour) in sides {
        if let Some((angle_deg, mean_n)) = side.load_distribution() {
            figure = figure.with(Series::listed(&side.label, *colour, angle_deg, mean_n));
        }
    }
    (!figure.series.is_empty()).then(|| {
        figure
            .caption("Mean force on a roller by its place, over all rollers, samples and starts.")
            .note("In bins of one degree.")
    })
}

/// Force of all rollers on the outer ring.
fn support(sides: &[(&Side, Colour)]) -> Option<Figure> {
    let mut figure = Figure::new(
        "support",
        "Force of all rollers on the outer ring",
        Axis::si("Time", "s"),
        Axis::si("Force", "N"),
    );
    for (side, member, colour) in loudest_first(sides) {
        if !member.support_n.values.is_empty() {
            figure = figure.with(sampled(&side.label, colour, &member.support_n, |x| x));
        }
    }
    (!figure.series.is_empty()).then(|| {
        figure.caption("Against the load, which it carries in the mean.").note("Of several starts the first.")
    })
}

fn sampled(name: &str, colour: Colour, curve: &Sampled, of: impl Fn(f64) -> f64) -> Series {
    let values = curve.values.iter().map(|x| of(*x)).collect();
    Series::sampled(name, colour, curve.start, curve.step, values)
}
