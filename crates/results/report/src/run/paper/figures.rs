//! The paper's figures 2, 3, 6, 7 and 8 over its axes: our curves, its numbers red and dashed, ours blue.

use stribeck_analysis::findings::{Findings, SensorSignal};
use stribeck_analysis::paper::{BETWEEN_G, CURSOR_HZ, FILTERED_G, IMPULSE_G, TONE_HZ};
use stribeck_analysis::statistic::band;
use stribeck_dsp::Spectrum;

use super::super::drawing::{sampled, transient};
use super::super::{forces::crossings, spectrum::density};
use super::{PaperCase, number, ours, printed};
use crate::plot::{Axis, Colour, Figure, Level, Mark, Series};

/// The paper's record [s].
pub(super) const RECORD_S: (f64, f64) = (0.0, 0.03);
/// Least half height of an acceleration [g]: the paper's impulses have room.
const LEAST_G: f64 = 200.0;
/// Spectra as far as the fifth harmonic [Hz].
const SPECTRUM_HZ: (f64, f64) = (0.0, 25e3);
/// The zoom of its Fig. 7b [Hz].
const ZOOM_HZ: (f64, f64) = (4e3, 6e3);
/// Its fifth harmonic, "approximately" [Hz].
const FIFTH_HZ: f64 = 23e3;
const PANELS: [&str; 3] = ["a", "b", "c"];

type Signal = fn(&SensorSignal) -> &[f64];
type Density = fn(&SensorSignal) -> Option<&Spectrum>;

/// All figures in the paper's order.
pub(super) fn all(case: &PaperCase<'_>) -> Vec<Figure> {
    let mut spectra = spectra(case).into_iter();
    let mut figures = vec![acceleration(case)];
    // Its Fig. 3 stands between the accelerations.
    figures.extend(spectra.next());
    figures.push(notched(case));
    figures.extend(spectra);
    figures.extend(forces(case));
    figures
}

/// Fig. 2: a_y as recorded.
fn acceleration(case: &PaperCase<'_>) -> Figure {
    let figure = over_time(case, "2", "Unfiltered acceleration a_y", |s| &s.raw_g);
    let figure =
        figure.with(sampled(case.drawn, &drawn(case, "unfiltered"), Colour::Blue, &case.sensor.raw_g));
    let mut figure = figure.caption(numbers(case, "2"));
    figure.levels = levels(&[(IMPULSE_G, "impulses"), (BETWEEN_G, "between")], case, &[0, 1], "2");
    let times = case.beside.iter().filter(|b| b.shown.figure == "2" && b.shown.unit == "ms");
    figure.marks = times.flat_map(|b| both(b.shown.paper * 1e-3, b.ours.map(|s| 1e-3 * s.mean))).collect();
    figure
}

/// Fig. 6: the same behind the notch.
fn notched(case: &PaperCase<'_>) -> Figure {
    let figure = over_time(case, "6", "Unfiltered and notch filtered acceleration a_y", |s| &s.filtered_g);
    let figure = figure
        .with(sampled(case.drawn, &drawn(case, "unfiltered"), Colour::Grey, &case.sensor.raw_g))
        .with(sampled(case.drawn, "notch filtered", Colour::Blue, &case.sensor.filtered_g));
    let mut figure = figure.caption(numbers(case, "6"));
    figure.levels = levels(&[(BETWEEN_G, "between"), (FILTERED_G, "notched")], case, &[0], "6");
    figure.bands = transient(case.drawn);
    figure
}

/// An acceleration over the paper's 30 ms, with the band of all starts where there are several.
fn over_time(case: &PaperCase<'_>, number: &str, title: &str, signal: Signal) -> Figure {
    let peak = case.sensor.raw_g.iter().fold(LEAST_G, |most, g| most.max(g.abs()));
    let top = 50.0 * (1.05 * peak / 50.0).ceil();
    let figure = Figure::new(
        &format!("paper-{number}"),
        &format!("Fig. {number}: {title}"),
        Axis::si("Time", "s").over(RECORD_S.0, RECORD_S.1),
        Axis::plain("a_y", "g").over(-top, top),
    )
    .synced("paper-time")
    .note(format!(
        "Sensor “{}” at {:.0}°, mean over each interval of {:.0} µs.{} Dashed, red: the paper; blue: ours.",
        case.levels.sensor,
        case.levels.angle_deg,
        1e6 * case.drawn.interval_s,
        band_words(case)
    ));
    banded(case, figure, signal, |values| {
        Series::sampled("", Colour::Orange, case.drawn.start_s, case.drawn.interval_s, values)
    })
}

/// Figs. 3, 7a and 7b: power spectral densities.
fn spectra(case: &PaperCase<'_>) -> Vec<Figure> {
    let (Some(raw), filtered) = (&case.sensor.raw_density, &case.sensor.filtered_density) else {
        return Vec::new();
    };
    let half = 0.5 * raw.sample_rate_hz();
    let chart = |id: &str, title: &str, (from, to): (f64, f64), of: Density| {
        let unit = Axis::plain("Power spectral density", "dB re 1 g²/Hz");
        let frequency = Axis::si("Frequency", "Hz").over(from, to.min(half));
        let figure = Figure::new(&format!("paper-{id}"), &format!("Fig. {id}: {title}"), frequency, unit)
            .note(format!(
                "Welch: {}.{} Dashed, red: the paper; blue: ours.",
                raw.resolution(),
                band_words(case)
            ));
        let decibels = |values: Vec<f64>| {
            let values = values.iter().map(|power| 10.0 * power.log10()).collect();
            Series::sampled("", Colour::Orange, 0.0, raw.resolution().grid_hz, values)
        };
        let powers = |start: &Findings| {
            let sensor = start.sensors.iter().find(|sensor| sensor.name == case.sensor.name)?;
            of(sensor).map(|density| density.values().to_vec())
        };
        with_band(case, figure, powers, decibels)
    };
    let (tone, fifth) = (case.levels.tone_hz, case.levels.fifth_hz);
    let mut whole = chart("3", "Power spectral density of a_y", SPECTRUM_HZ, |s| s.raw_density.as_ref())
        .with(density(&drawn(case, "unfiltered"), Colour::Blue, raw))
        .caption(numbers(case, "3"));
    whole.marks = both(TONE_HZ, tone).into_iter().chain(both(FIFTH_HZ, fifth)).collect();
    let Some(filtered) = filtered else { return vec![whole] };
    let overlay = |id: &str, title: &str, range| {
        chart(id, title, range, |s| s.filtered_density.as_ref())
            .with(density("notch filtered", Colour::Orange, filtered))
            .with(density(&drawn(case, "unfiltered"), Colour::Blue, raw))
    };
    let mut both_of = overlay("7a", "Unfiltered and notch filtered", SPECTRUM_HZ)
        .caption("The notch takes the fundamental tone out and leaves the rest.");
    both_of.marks = both(TONE_HZ, tone);
    let mut zoom = overlay("7b", "The same from 4 to 6 kHz", ZOOM_HZ).caption(numbers(case, "7"));
    zoom.marks = both(TONE_HZ, tone);
    zoom.marks.push(Mark::new(CURSOR_HZ, "paper 4545 Hz", Colour::Red, true));
    vec![whole, both_of.tabbed("paper-7", "Fig. 7a"), zoom.tabbed("paper-7", "Fig. 7b")]
}

/// Fig. 8: vertical force of the outer raceway on the three rollers that cross the defect.
fn forces(case: &PaperCase<'_>) -> Vec<Figure> {
    let panel = |(figure, letter): (Figure, &str)| {
        let mut figure = figure;
        figure.id = format!("paper-8{letter}");
        figure.title = format!("Fig. 8{letter}: {}", figure.title);
        figure.x = figure.x.over(RECORD_S.0, RECORD_S.1);
        figure.sync = Some("paper-time".into());
        figure.tabbed("paper-8", format!("Fig. 8{letter}"))
    };
    crossings(case.drawn).into_iter().zip(PANELS).map(panel).collect()
}

/// Name of the unfiltered curve, with the number of the start that is drawn.
fn drawn(case: &PaperCase<'_>, what: &str) -> String {
    case.number.map_or(what.to_owned(), |number| format!("{what}, start {number}"))
}

/// Meaning of the shaded band.
fn band_words(case: &PaperCase<'_>) -> String {
    match case.starts.len() {
        1 => String::new(),
        starts => format!(" Shaded: what 80 % of {starts} starts do there."),
    }
}

/// With the band of a signal of all starts, drawn by `series`.
fn banded(
    case: &PaperCase<'_>,
    figure: Figure,
    signal: Signal,
    series: impl Fn(Vec<f64>) -> Series,
) -> Figure {
    let values = |start: &Findings| {
        let sensor = start.sensors.iter().find(|sensor| sensor.name == case.sensor.name)?;
        Some(signal(sensor).to_vec())
    };
    with_band(case, figure, values, series)
}

/// With the band of `values` of all starts.
fn with_band(
    case: &PaperCase<'_>,
    figure: Figure,
    values: impl Fn(&Findings) -> Option<Vec<f64>>,
    series: impl Fn(Vec<f64>) -> Series,
) -> Figure {
    let curves: Vec<Vec<f64>> =
        case.starts.iter().filter(|_| case.starts.len() > 1).filter_map(|start| values(start)).collect();
    if curves.is_empty() {
        return figure;
    }
    let [low, high] = band(&curves.iter().map(Vec::as_slice).collect::<Vec<_>>());
    let edge = |name: &str, values| Series { name: name.into(), ..series(values) }.as_edge();
    figure.with(edge("90 % of starts below", high)).with(edge("10 % of starts below", low))
}

/// The paper's levels on either side of zero, and ours: of `paper`, those at `of` the numbers of a figure.
fn levels(paper: &[(f64, &str)], case: &PaperCase<'_>, of: &[usize], figure: &str) -> Vec<Level> {
    let level = |y: f64, label: String, colour| {
        [Level { y, label, colour }, Level { y: -y, label: String::new(), colour }]
    };
    let theirs =
        paper.iter().flat_map(|&(g, what)| level(g, format!("paper, {what}: ± {g:.0} g"), Colour::Red));
    let here: Vec<_> = case.beside.iter().filter(|b| b.shown.figure == figure).collect();
    let mine = of.iter().filter_map(|&at| here.get(at)).filter_map(|b| {
        let mean = b.ours?.mean;
        let quantity = b.shown.quantity.to_lowercase();
        Some(level(mean, format!("ours, {quantity}: ± {}", ours(b)?), Colour::Blue))
    });
    theirs.chain(mine.flatten()).collect()
}

/// A place on the abscissa in the paper, and ours.
fn both(paper: f64, ours: Option<f64>) -> Vec<Mark> {
    let label = |x: f64| if x < 1.0 { format!("{} ms", number(1e3 * x)) } else { format!("{x:.0} Hz") };
    let mut marks = vec![Mark::new(paper, format!("paper {}", label(paper)), Colour::Red, true)];
    marks.extend(ours.map(|x| Mark::new(x, format!("ours {}", label(x)), Colour::Blue, false)));
    marks
}

/// The numbers of a figure in one sentence: ours, and the paper's in brackets.
fn numbers(case: &PaperCase<'_>, figure: &str) -> String {
    let of_figure = case.beside.iter().filter(|b| b.shown.figure == figure);
    let said: Vec<String> = of_figure
        .map(|b| {
            let missing = if case.is_behind_the_end(b) { "not on record" } else { "not found" };
            let ours = ours(b).unwrap_or_else(|| missing.to_owned());
            format!("{} {ours} (paper {})", b.shown.quantity, printed(b))
        })
        .collect();
    format!("{}.", said.join("; "))
}
