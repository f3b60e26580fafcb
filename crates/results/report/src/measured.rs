//! The page of a measured record: verdict, families, and the spectra that show them.

use std::path::Path;

use maud::{Markup, html};
use serde_json::{Value, json};
use stribeck_analysis::quantity::schema;
use stribeck_dsp::BandEnvelope;
use stribeck_store::run_dir::write_atomic;

use crate::brief::answers;
use crate::page::{self, charts, document, drawn, sentence};
use crate::plot::{Axis, Colour, Cursor, Figure, Level, Mark, Picture, Series};
use crate::{Error, SeriesFindings, SourcesFindings, course, kurtogram, sound};
use stribeck_diagnosis::record::quality::Quality;
use stribeck_diagnosis::words::brief::Brief;
use stribeck_diagnosis::words::evidence::{SynchronousMean, synchronous, what_would_change};
use stribeck_diagnosis::words::numbers::significant;
use stribeck_diagnosis::{Analysis, Defect, Enhanced, Family, MeasuredFindings, OF_A_SPALL};

/// Lowest cyclic frequency drawn [Hz].
const LOWEST_CYCLIC_HZ: f64 = 2.0;

/// A record of the same machine when it was healthy, drawn behind another one.
#[derive(Debug, Clone)]
pub struct Baseline {
    /// Name of its file.
    pub name: String,
    /// Findings of the analysis.
    pub analysis: Analysis,
}

/// The schema of a `findings.json` that this version writes: of a record, of a series of them, or of a record
/// with several components.
pub fn findings_schema() -> Value {
    let kinds =
        [schema::of::<MeasuredFindings>(), schema::of::<SeriesFindings>(), schema::of::<SourcesFindings>()];
    schema::titled("Findings of a measured record", json!({ "anyOf": kinds }))
}

/// Writes `findings.json` and `report.html` of the record in `file` into `folder`, which is made; over a
/// `baseline` where there is one.
pub fn write_measured(
    folder: &Path,
    file: &str,
    analysis: &Analysis,
    baseline: Option<&Baseline>,
) -> Result<(), Error> {
    std::fs::create_dir_all(folder).map_err(|why| Error::Write { path: folder.to_owned(), why })?;
    write_atomic(&folder.join("findings.json"), page::json(&analysis.findings)?.as_bytes())?;
    let page = page(file, analysis, baseline)?.into_string();
    write_atomic(&folder.join("report.html"), page.as_bytes())?;
    Ok(())
}

fn page(file: &str, analysis: &Analysis, baseline: Option<&Baseline>) -> Result<Markup, Error> {
    let findings = &analysis.findings;
    let unit = findings.unit.as_deref().unwrap_or("unit");
    let evidence = page::figures(&charts(evidence(analysis, baseline)?).collect::<Vec<_>>())?;
    let figures = page::figures(&charts(figures(analysis, unit, baseline)).collect::<Vec<_>>())?;
    let pictures = page::figures(&drawn(pictures(analysis, unit)).collect::<Vec<_>>())?;
    let title = format!("{file}, {}", findings.channel);
    let number = |x: f64| format!("{x:.4}");
    let health = &findings.health;
    Ok(document(
        &title,
        html! {
            h1 { (title) }
            p class="lead" {
                (format!("{:.2} s at {} Hz", findings.duration_s, significant(findings.rate_hz, 7)))
                @if let Some(rpm) = findings.speed_rpm { (turning(rpm, analysis)) }
                @if let Some(bearing) = &findings.bearing { "; " (bearing) }
                "."
                @if let Some(baseline) = baseline { " In grey behind it: " (baseline.name) "." }
            }
            p class="headline" { (findings.verdict) }
            (answers(&Brief::of(findings)))
            @if let Some(zone) = &findings.zone { p { "Velocity: " (zone.to_string()) "." } }
            h2 #evidence { "What the verdict rests on" }
            (evidence)
            h3 { "What would change it" }
            ul { @for words in what_would_change(findings) { li { (words) } } }
            @if !findings.quality.is_empty() { (quality(&findings.quality)) }
            h2 #families { "Defect families" }
            @if findings.families.is_empty() { p { "None was looked for: see the notes." } } @else { (families(&findings.families)) }
            h2 #signal { "Signal" }
            table {
                tr { @if baseline.is_some() { th { "" } } th { "Mean" } th { "RMS" } th { "Peak" } th { "Crest factor" } th { "Kurtosis" } th { "Skewness" } th { "Impulse factor" } th { "Spectral entropy" } @if findings.velocity_mm_s.is_some() { th { "Velocity, 10–1000 Hz (mm/s)" } } }
                tr {
                    @if baseline.is_some() { td { "this record" } }
                    td { (number(health.mean)) } td { (number(health.rms)) } td { (number(health.peak)) } td { (number(health.crest_factor)) }
                    td { (number(health.kurtosis)) } td { (number(health.skewness)) } td { (number(health.impulse_factor)) }
                    td { (number(health.spectral_entropy)) } @if let Some(level) = findings.velocity_mm_s { td { (number(level)) } }
                }
                @if let Some(baseline) = baseline { (levels_of(baseline, findings.velocity_mm_s.is_some())) }
            }
            (sound::player(&findings.channel, &analysis.beginning, findings.rate_hz, findings.unit.as_deref().unwrap_or("")))
            (figures)
            h2 #course { "Bands and course" }
            (pictures)
            h2 #notes { "Notes" }
            ul class="notes" { @for note in &findings.notes { li { (page::with_code(&sentence(note))) } } }
        },
    ))
}

/// What sensor and recorder did to the samples, one finding a row.
fn quality(found: &[Quality]) -> Markup {
    html! {
        h2 #quality { "Quality of the record" }
        table {
            tr { th { "Finding" } th { "Share of the samples (%)" } th { "First (s)" } th { "" } }
            @for of in found {
                tr {
                    td { (of.kind.name()) }
                    td { (format!("{:.2}", 100.0 * of.share)) }
                    td { (format!("{:.3}", of.first_s)) }
                    td { (sentence(&of.words)) }
                }
            }
        }
    }
}

/// The levels of the baseline as a row of the table.
fn levels_of(baseline: &Baseline, with_velocity: bool) -> Markup {
    let findings = &baseline.analysis.findings;
    let health = &findings.health;
    let numbers = [
        health.mean,
        health.rms,
        health.peak,
        health.crest_factor,
        health.kurtosis,
        health.skewness,
        health.impulse_factor,
        health.spectral_entropy,
    ];
    html! {
        tr {
            td { (baseline.name) }
            @for number in numbers { td { (format!("{number:.4}")) } }
            @if with_velocity { td { (findings.velocity_mm_s.map_or("–".to_owned(), |v| format!("{v:.4}"))) } }
        }
    }
}

/// The speed of the shaft, and its range where it varies.
fn turning(rpm: f64, analysis: &Analysis) -> String {
    let speeds = analysis.varying.iter().flat_map(|varying| &varying.speeds_rpm).copied();
    let (least, most) = speeds.fold((rpm, rpm), |(least, most), speed| (least.min(speed), most.max(speed)));
    if least == most {
        return format!("; the shaft turns at {rpm:.1} rpm");
    }
    format!(
        "; the shaft turns at {least:.0} to {most:.0} rpm, {rpm:.1} rpm on average; samples are taken \
         over its angle, and frequencies are those at the mean speed"
    )
}

/// The kurtogram; the record over time, and where the speed varies over speed and angle.
fn pictures(analysis: &Analysis, unit: &str) -> Vec<Picture> {
    const TABS: &str = "course";
    let findings = &analysis.findings;
    let outlined = shown(&findings.families).into_iter().filter(|f| f.over.is_none()).filter_map(|f| {
        let why = format!("where {} stands highest", f.name.shocks_name());
        Some(kurtogram::Chosen { band_hz: f.band_hz?, why })
    });
    let mut pictures: Vec<Picture> =
        kurtogram::picture(&analysis.bands, &outlined.collect::<Vec<_>>()).into_iter().collect();
    match &analysis.varying {
        Some(varying) => {
            pictures.push(course::picture(&varying.course, unit).tabbed(TABS, "over time"));
            let waterfall = course::waterfall(&varying.course, unit, Some(&varying.speeds_rpm));
            pictures.extend(waterfall.map(|picture| picture.tabbed(TABS, "over speed")));
            let orders: Vec<(String, f64)> = match findings.speed_rpm {
                Some(rpm) => orders_of(&findings.families, rpm / 60.0),
                None => Vec::new(),
            };
            pictures.extend(
                varying.orders.as_ref().map(|map| {
                    course::order_map(map, varying.band_hz, &orders).tabbed(TABS, "over the angle")
                }),
            );
        }
        None => {
            pictures.push(course::picture(&analysis.course, unit).tabbed(TABS, "spectrogram"));
            let waterfall = course::waterfall(&analysis.course, unit, None);
            pictures.extend(waterfall.map(|picture| picture.tabbed(TABS, "waterfall")));
        }
    }
    pictures
}

/// Impacts of each family in a turn of the shaft.
fn orders_of(families: &[Family], shaft_hz: f64) -> Vec<(String, f64)> {
    let order = |f: &Family| {
        let hz = f.measured_hz.unwrap_or(f.expected_hz);
        (f.name.shocks_name().to_owned(), f.name.shocks_per_period() * hz / shaft_hz)
    };
    families.iter().map(order).collect()
}

/// A cursor with the families and the shaft of a record.
fn cursor(findings: &MeasuredFindings) -> Cursor {
    let family = |f: &Family| {
        let hz = f.name.shocks_per_period() * f.measured_hz.unwrap_or(f.expected_hz);
        (f.name.shocks_name().to_owned(), hz)
    };
    let mut known: Vec<(String, f64)> = findings.families.iter().map(family).collect();
    known.extend(findings.speed_rpm.map(|rpm| ("shaft".to_owned(), rpm / 60.0)));
    Cursor { known }
}

fn families(families: &[Family]) -> Markup {
    let hz = |value: Option<f64>| value.map_or("–".to_owned(), |hz| format!("{hz:.2}"));
    html! {
        table {
            tr {
                th { "Family" } th { "Expected (Hz)" } th { "Measured (Hz)" } th { "Harmonics of 5" } th { "Level (dB)" }
                th { "Depth" } th { "False alarm" } th { "Band (Hz)" } th { "Defect" } th { "Why" }
            }
            @for f in families {
                tr {
                    td { (f.name.name()) }
                    td { (format!("{:.2}", f.expected_hz)) }
                    td { (hz(f.measured_hz)) }
                    td { (f.harmonics) }
                    td { (f.level_db.map_or("–".to_owned(), |db| format!("{db:.1}"))) }
                    td { (f.depth.map_or("–".to_owned(), |d| format!("{d:.2}"))) }
                    td { (f.false_alarm()) }
                    td { (f.band_hz.map_or("–".to_owned(), |(low, high)| format!("{low:.0}–{high:.0}"))) }
                    td { @if f.claimed { strong { "yes" } } @else { "no" } }
                    td { (f.reason.to_string()) }
                }
            }
        }
    }
}

fn figures(analysis: &Analysis, unit: &str, baseline: Option<&Baseline>) -> Vec<Figure> {
    let findings = &analysis.findings;
    let waveform = Figure::new("waveform", "Signal", Axis::si("Time", "s"), Axis::plain("Level", unit))
        .caption("The beginning of the record.")
        .with(Series::sampled(
            "signal",
            Colour::Blue,
            0.0,
            1.0 / findings.rate_hz,
            analysis.beginning.clone(),
        ));
    let (frequencies, density) = &analysis.density;
    let step = frequencies.get(1).copied().unwrap_or(1.0);
    let mut spectrum = Figure::new(
        "density",
        "Power spectral density",
        Axis::si("Frequency", "Hz"),
        Axis::plain("Density", &format!("dB re 1 ({unit})²/Hz")),
    )
    .caption(match baseline {
        Some(baseline) => format!("What stands above the grey curve is new since {}.", baseline.name),
        None => "Steady lines are narrow peaks, resonances wide humps.".to_owned(),
    })
    .note("Welch's average over the whole record, Hann window.");
    if let Some(Baseline { name, analysis }) = baseline {
        let (frequencies, density) = &analysis.density;
        let step = frequencies.get(1).copied().unwrap_or(1.0);
        let values = density.iter().map(|p| decibel(*p)).collect();
        spectrum = spectrum.with(Series::sampled(name, Colour::Grey, 0.0, step, values));
    }
    spectrum = spectrum.with(Series::sampled(
        "density",
        Colour::Blue,
        0.0,
        step,
        density.iter().map(|p| decibel(*p)).collect(),
    ));
    spectrum.cursor = Some(cursor(findings));
    let mut figures = vec![waveform, spectrum];
    figures.extend(analysis.enhanced.as_ref().map(|spectrum| {
        let mut figure = enhanced(spectrum, &findings.families);
        figure.cursor = Some(cursor(findings));
        figure
    }));
    figures
}

/// The families that are shown: those that are claimed, otherwise those that are there, otherwise the one
/// that is nearest to it.
fn shown(families: &[Family]) -> Vec<&Family> {
    let all = |of: fn(&Family) -> bool| families.iter().filter(|f| of(f)).collect::<Vec<_>>();
    let (claimed, there) = (all(|f| f.claimed), all(Family::is_there));
    if !claimed.is_empty() {
        return claimed;
    }
    if !there.is_empty() {
        return there;
    }
    let nearest = families.iter().filter(|f| f.band_hz.is_some());
    nearest.min_by(|a, b| a.p_value.total_cmp(&b.p_value)).into_iter().collect()
}

/// Of each family that is shown its envelope spectrum, the combs that it is compared with and the mean over
/// its period; without a family the envelope of the band that has the strongest impacts.
pub(crate) fn evidence(analysis: &Analysis, baseline: Option<&Baseline>) -> Result<Vec<Figure>, Error> {
    let findings = &analysis.findings;
    let mut figures = Vec::new();
    for family in shown(&findings.families) {
        figures.extend(
            analysis
                .band_of(family)
                .map(|band| behind(envelope(band, family, findings), band, findings, baseline)),
        );
        figures.extend(combs(family));
        figures.extend(synchronous(analysis, family)?.map(|means| period(family, &means)));
    }
    figures.extend(foreign(analysis, baseline));
    if figures.is_empty() {
        let most = analysis.bands.iter().max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis));
        figures.extend(most.map(|band| {
            let mut figure = spectrum_of(band, "envelope", "Squared envelope spectrum", 500.0);
            figure.cursor = Some(cursor(findings));
            behind(figure, band, findings, baseline)
        }));
    }
    figures.extend(limits(findings));
    Ok(figures)
}

/// The weakest impacts of each family that the record would have shown, beside those that it shows.
fn limits(findings: &MeasuredFindings) -> Option<Figure> {
    let hz = |f: &Family| f.name.shocks_per_period() * f.measured_hz.unwrap_or(f.expected_hz);
    let mut families: Vec<&Family> = findings.families.iter().collect();
    families.sort_by(|a, b| hz(a).total_cmp(&hz(b)));
    let points = |of: fn(&Family) -> Option<f64>| -> (Vec<f64>, Vec<f64>) {
        families.iter().filter_map(|f| Some((hz(f), of(f).filter(|x| *x > 0.0)?.log10()))).unzip()
    };
    let (limit_hz, limit) = points(|f| Some(f.limit?.over_rms));
    let highest_hz = *limit_hz.last()?;
    let (shown_hz, shown) = points(|f| f.shown_over_rms.filter(|_| f.is_there() || f.claimed));
    let mut figure = Figure::new(
        "limits",
        "Impacts that would show, and those that do",
        Axis::si("Frequency of the impacts", "Hz").over(0.0, 1.2 * highest_hz),
        Axis::decades("Peak over the RMS of the record", ""),
    )
    .with(Series::listed("would be claimed from here on", Colour::Grey, limit_hz, limit).as_points())
    .with(Series::listed("what stands there", Colour::Red, shown_hz, shown).as_points())
    .caption("Impacts of a family that are weaker than its grey point could be in this record without a claim.")
    .note(format!(
        "Peaks in the band in which they would be claimed first. Four in five damaged raceways of measured records \
         exceed {OF_A_SPALL} times the RMS. What stands there is claimed only if its place, its depth and its \
         neighbours allow it."
    ));
    figure.levels.push(Level { y: OF_A_SPALL.log10(), label: "spalls".into(), colour: Colour::Orange });
    figure.marks = families
        .iter()
        .filter(|f| f.limit.is_some())
        .map(|f| Mark::new(hz(f), f.name.shocks_name(), Colour::Grey, true))
        .collect();
    figure.series.retain(|series| !series.y.is_empty());
    Some(figure)
}

/// Name of the figure of a comb that is no family's.
pub(crate) const FOREIGN: &str = "envelope-unexplained";

/// The envelope spectrum in which a comb stands that is no family's, with its harmonics.
fn foreign(analysis: &Analysis, baseline: Option<&Baseline>) -> Option<Figure> {
    let findings = &analysis.findings;
    let other = findings.unexplained.as_ref()?;
    let band = analysis.bands.iter().find(|band| (band.low_hz, band.high_hz) == other.band_hz)?;
    let title = format!("Squared envelope spectrum about {:.2} Hz, no family's", other.hz);
    let mut figure = spectrum_of(band, FOREIGN, &title, 5.6 * other.hz).caption(format!(
        "A comb at {:.3} times the shaft, {:.1} dB above its background, is no family of this bearing.",
        other.order, other.height_db
    ));
    figure.marks.extend(
        (1..=5).map(f64::from).map(|n| Mark::new(n * other.hz, format!("{n}×"), Colour::Purple, false)),
    );
    figure.cursor = Some(cursor(findings));
    figure.note += " Purple: its harmonics.";
    Some(behind(figure, band, findings, baseline))
}

/// An envelope spectrum over that of the same band of a baseline, at the speed of the record.
fn behind(
    mut figure: Figure,
    band: &BandEnvelope,
    findings: &MeasuredFindings,
    baseline: Option<&Baseline>,
) -> Figure {
    let Some(Baseline { name, analysis }) = baseline else { return figure };
    let close = |a: f64, b: f64| (a - b).abs() <= 0.02 * band.high_hz;
    let same = |b: &&BandEnvelope| close(b.low_hz, band.low_hz) && close(b.high_hz, band.high_hz);
    let Some(theirs) = analysis.bands.iter().find(same) else {
        figure.note += &format!(" {name} has no such band: it was sampled at another rate.");
        return figure;
    };
    let speeds = findings.speed_rpm.zip(analysis.findings.speed_rpm);
    let stretch = speeds.map_or(1.0, |(here, there)| here / there);
    let end_hz = figure.x_range().1;
    let lines = ((end_hz / (stretch * theirs.grid_hz)) as usize + 1).min(theirs.values.len());
    let values: Vec<f64> = theirs.values.iter().take(lines).skip(1).map(|v| decibel(*v)).collect();
    let step = stretch * theirs.grid_hz;
    figure.series.insert(0, Series::sampled(name, Colour::Grey, step, step, values));
    figure.note += &format!(
        " Grey: the same band of {name}{}.",
        if (stretch - 1.0).abs() > 1e-3 { ", at the speed of this record" } else { "" }
    );
    figure
}

/// Height of the family's comb beside that of combs about unrelated fundamentals of the same spectrum.
fn combs(family: &Family) -> Option<Figure> {
    let hz = family.name.shocks_per_period() * family.measured_hz.unwrap_or(family.expected_hz);
    let highest = family.controls.iter().map(|c| c.1).reduce(f64::max)?;
    let (x, y): (Vec<f64>, Vec<f64>) = family.controls.iter().copied().unzip();
    let lead = family.score_db() - highest;
    let id = format!("combs-{}", family.name.name().to_lowercase());
    let figure = Figure::new(
        &id,
        &format!("{} beside {} combs at other spacings", family.name.shocks_name(), x.len()),
        Axis::si("Fundamental", "Hz"),
        Axis::plain("Height over the background", "dB"),
    )
    .with(Series::listed("other spacings", Colour::Grey, x, y).as_points())
    .with(
        Series::listed(family.name.shocks_name(), Colour::Red, vec![hz], vec![family.score_db()]).as_points(),
    )
    .caption(if lead > 0.0 {
        format!("It stands {lead:.1} dB above the highest of them.")
    } else {
        format!("The highest of them stands {:.1} dB above it.", -lead)
    })
    .note(
        "A comb is as high as the fourth highest of its first five harmonics. Unrelated are fundamentals \
         that share no multiple or fraction with this one, and are none of the shaft or the cage.",
    );
    Some(figure)
}

/// The mean power over one period of the impacts, and over an unrelated one.
fn period(family: &Family, (of_family, control): &(SynchronousMean, SynchronousMean)) -> Figure {
    let curve = |name: &str, colour: Colour, mean: &SynchronousMean| {
        let step = 1.0 / mean.power.len() as f64;
        Series::sampled(name, colour, 0.5 * step, step, mean.power.clone())
    };
    let highest = |mean: &SynchronousMean| mean.power.iter().copied().fold(0.0, f64::max);
    let name = family.name.shocks_name();
    let id = format!("period-{}", family.name.name().to_lowercase());
    let (most, by_chance) = (highest(of_family), highest(control));
    let mut figure = Figure::new(
        &id,
        &format!("Mean over one period of {name}"),
        Axis::plain("Part of the period", "").over(0.0, 1.0),
        Axis::plain("Power over its mean", ""),
    )
    .with(curve(&format!("unrelated, {:.2} Hz", control.hz), Colour::Grey, control))
    .with(curve(&format!("{name}, {:.2} Hz", of_family.hz), Colour::Blue, of_family))
    .caption(format!(
        "Over {} periods the power of the band rises to {most:.2} times its mean once a period; about an \
         unrelated rate, sought alike, to {by_chance:.2}.",
        of_family.periods
    ))
    .note(
        "From the beginning of the record, in the band in which the family stands highest. Each curve is \
         turned so that its highest value lies at a quarter. Impacts that slip lose their phase from period to period, \
         and with it this peak, though their lines stand.",
    );
    figure.levels = vec![Level { y: 1.0, label: "mean".into(), colour: Colour::Grey }];
    figure
}

/// The enhanced envelope spectrum with the places of all families: dashed where they are expected, solid
/// where found.
fn enhanced(spectrum: &Enhanced, families: &[Family]) -> Figure {
    // Slow changes of level fill the beginning.
    let first = ((LOWEST_CYCLIC_HZ / spectrum.grid_hz) as usize).clamp(1, spectrum.values.len().max(2) - 1);
    let mut figure = Figure::new(
        "enhanced",
        "Enhanced envelope spectrum",
        Axis::si("Cyclic frequency", "Hz"),
        Axis::plain("Mean coherence", ""),
    )
    .caption(
        "How surely each part of the spectrum comes and goes at a rate, averaged over all parts. It shows \
         what strikes where the signal is weak; the verdict does not rest on it.",
    )
    .note(format!(
        "From the first {:.2} s: cyclic lines {:.3} Hz apart, carriers {:.1} Hz apart. Dashed where a family \
         is expected, solid where it was found.",
        spectrum.duration_s, spectrum.grid_hz, spectrum.carrier_hz
    ))
    .with(Series::sampled(
        "coherence",
        Colour::Blue,
        first as f64 * spectrum.grid_hz,
        spectrum.grid_hz,
        spectrum.values[first..].to_vec(),
    ));
    let colours = [Colour::Red, Colour::Orange, Colour::Green, Colour::Purple];
    let end_hz = spectrum.grid_hz * spectrum.values.len() as f64;
    for (family, colour) in families.iter().zip(colours) {
        let found = family.measured_hz.filter(|_| family.is_there());
        let hz = found.unwrap_or(family.expected_hz) * family.name.shocks_per_period();
        let name = family.name.shocks_name();
        let shown = if found.is_some() { 3 } else { 1 };
        for n in (1..=shown).filter(|n| f64::from(*n) * hz < end_hz) {
            let label = if n == 1 { name.to_owned() } else { format!("{n}× {name}") };
            figure.marks.push(Mark { x: f64::from(n) * hz, label, colour, dashed: found.is_none() });
        }
    }
    figure
}

/// The envelope spectrum in which a family stands, with its harmonics and, where they are expected, its
/// sidebands.
fn envelope(band: &BandEnvelope, family: &Family, findings: &MeasuredFindings) -> Figure {
    let hz = family.name.shocks_per_period() * family.measured_hz.unwrap_or(family.expected_hz);
    let id = format!("envelope-{}", family.name.name().to_lowercase());
    let mut figure =
        spectrum_of(band, &id, &format!("Squared envelope spectrum about {}", family.name), 5.6 * hz)
            .caption(format!("{}. {}", family.name, sentence(&family.reason.to_string())));
    let shaft_hz = findings.speed_rpm.unwrap_or(0.0) / 60.0;
    let cage_hz = findings
        .families
        .iter()
        .find(|f| f.name == Defect::Ftf)
        .map_or(0.0, |f| f.measured_hz.unwrap_or(f.expected_hz));
    // A defect that turns with the shaft, or with the cage, comes and goes under the load.
    let side_hz = match family.name {
        Defect::Bpfi => shaft_hz,
        Defect::Bsf => cage_hz,
        Defect::Bpfo | Defect::Ftf => 0.0,
    };
    let side = if family.name == Defect::Bpfi { "shaft" } else { "cage" };
    let mark = |x: f64, label: String, colour: Colour, dashed: bool| Mark { x, label, colour, dashed };
    for n in 1..=5 {
        let at = f64::from(n) * hz;
        figure.marks.push(mark(at, format!("{n}×"), Colour::Red, false));
        if side_hz > 0.0 && n <= 3 {
            let label = |sign: &str| if n == 1 { format!("{sign}{side}") } else { String::new() };
            figure.marks.push(mark(at - side_hz, label("−"), Colour::Orange, true));
            figure.marks.push(mark(at + side_hz, label("+"), Colour::Orange, true));
        }
    }
    figure.cursor = Some(cursor(findings));
    let highest = family.controls.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((control_hz, _)) = highest {
        let inside = (1..=5).map(f64::from).filter(|n| n * control_hz < 5.6 * hz);
        figure.marks.extend(inside.map(|n| {
            let label = if n > 1.0 { String::new() } else { "a comb at another spacing".to_owned() };
            mark(n * control_hz, label, Colour::Grey, true)
        }));
    }
    figure.note += &format!(
        " Red: harmonics of {}{}{}.",
        family.name.shocks_name(),
        if side_hz > 0.0 { format!("; orange: their sidebands of the {side}") } else { String::new() },
        if highest.is_some() { "; grey: the highest comb at another spacing" } else { "" }
    );
    figure
}

fn spectrum_of(band: &BandEnvelope, id: &str, title: &str, to_hz: f64) -> Figure {
    let lines = ((to_hz / band.grid_hz) as usize + 1).min(band.values.len());
    let values = band.values.iter().take(lines).skip(1).map(|v| decibel(*v)).collect();
    Figure::new(id, title, Axis::si("Frequency", "Hz"), Axis::plain("Power over the mean power²", "dB"))
        .note(format!(
            "Band {:.0} to {:.0} Hz, {}, resolution {:.3} Hz, Hann window.",
            band.low_hz,
            band.high_hz,
            if band.segments == 1 { "one segment".to_owned() } else { format!("{} segments", band.segments) },
            band.grid_hz
        ))
        .with(Series::sampled("envelope", Colour::Blue, band.grid_hz, band.grid_hz, values))
}

fn decibel(power: f64) -> f64 {
    10.0 * power.max(1e-30).log10()
}
