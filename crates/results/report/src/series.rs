//! The page of a series of measured records: the verdict on all of them, families, levels and lengths from one
//! record to the next.

use std::path::Path;

use maud::{Markup, html};
use serde::Serialize;
use stribeck_store::run_dir::write_atomic;

use crate::Error;
use crate::brief::answers;
use crate::page::{cell, document, folded, json, wide_table};
use crate::plot::{Axis, Band, Colour, Figure, Level, Mark, Series as Curve};
use stribeck_diagnosis::quantities;
use stribeck_diagnosis::record::alarm::{Judged, Limit, Quantity, State};
use stribeck_diagnosis::series::{Onset, Series};
use stribeck_diagnosis::words::brief::Brief;
use stribeck_diagnosis::words::numbers::chance;
use stribeck_diagnosis::{Defect, Family, Interval, MeasuredFindings};

quantities! {
    /// One record of a series.
    #[derive(Debug, Serialize)]
    pub struct SeriesRecord {
        /// The file.
        pub file: String,
        /// Folder of its own page, below that of the series; `null` where it has none.
        pub folder: Option<String>,
        /// Its findings; `null` where it could not be analysed.
        pub findings: Option<MeasuredFindings>,
        /// Why it could not be.
        pub error: Option<String>,
        /// How its levels stand to the limits.
        pub alarms: Vec<Judged>,
    }
}

/// Highest limit that is drawn, over the highest value.
const ROOM: f64 = 2.0;

quantities! {
    /// Content of `findings.json` of a series.
    #[derive(Debug, Serialize)]
    pub struct SeriesFindings {
        /// The verdict on all of them.
        pub series: Series,
        /// Each of them, in their order.
        pub records: Vec<SeriesRecord>,
    }
}

/// Writes `findings.json` and `report.html` of a series of records into `folder`, which must be there;
/// `limits` are drawn beside the levels.
pub fn write_series(folder: &Path, findings: &SeriesFindings, limits: &[Limit]) -> Result<(), Error> {
    write_atomic(&folder.join("findings.json"), json(findings)?.as_bytes())?;
    write_atomic(&folder.join("report.html"), page(findings, limits)?.into_string().as_bytes())?;
    Ok(())
}

fn page(findings: &SeriesFindings, limits: &[Limit]) -> Result<Markup, Error> {
    let SeriesFindings { series, records } = findings;
    let html_of = |figures: Vec<Figure>| figures.iter().map(Figure::to_html).collect::<Result<Vec<_>, _>>();
    let of_families = html_of(heights(series).into_iter().chain(lengths(series, records)).collect())?;
    let of_levels = html_of(levels(records, limits))?;
    let title = format!("A series of {} records", records.len());
    Ok(document(
        &title,
        html! {
            h1 { (title) }
            p class="headline" { (series.verdict) }
            @if let Some(last) = records.iter().rev().find_map(|record| record.findings.as_ref()) {
                (answers(&Brief::of_series(series, last)))
            }
            @if series.sound > 0 {
                p class="hint" { "The first " (series.sound) " records are of the healthy machine." }
            }
            @if !series.families.is_empty() {
                h2 #families { "Defect families" }
                @for figure in of_families { (figure) }
                (evidence(series))
            }
            h2 #levels { "Levels" }
            @for figure in of_levels { (figure) }
            @if !limits.is_empty() {
                h2 #alarms { "Alarm bands" }
                (folded(html! { div class="scroll" { (alarms(records, limits)) } }, records.len(), "records and their levels"))
            }
            h2 #records { "Records" }
            (folded(html! { div class="scroll" { (table(records)) } }, records.len(), "records, in the order in which they were given"))
        },
    ))
}

/// What the records together say of each family.
fn evidence(series: &Series) -> Markup {
    let head = html! {
        th { "Family" } th { "Records that claim it" } th { "Of the last" } th { "False alarm" } th { "Since record" }
        th { "Verdict" }
    };
    let rows = series.families.iter().map(|family| {
        let since = family.onset.map(|onset| format!("{} ({}–{})", onset.record, onset.low, onset.high));
        html! {
            td { (family.name) }
            (cell(Some(family.claiming.to_string())))
            (cell(Some(format!("{} of {}", family.last_claiming, family.last))))
            td { (chance(family.p_value)) }
            (cell(since))
            td { @if family.claimed { strong { "a defect" } } @else { "none" } }
        }
    });
    html! {
        (wide_table(None, &head, rows))
        p class="hint" {
            "Twice the median probability of the last records, one, two, four and so on, of which the smallest \
            counts, times the number of choices: it holds however the records depend on each other. In brackets \
            the interval of 90 %."
        }
    }
}

pub(crate) fn table(entries: &[SeriesRecord]) -> Markup {
    let number = |x: f64| format!("{x:.4}");
    let level = |findings: &MeasuredFindings, name: Defect| {
        let family = findings.families.iter().find(|f| f.name == name);
        let db = family.and_then(|f| f.level_db).map(|db| format!("{db:.1}"));
        (db.unwrap_or_else(|| "–".to_owned()), family.is_some_and(|f| f.claimed))
    };
    html! {
        table {
            tr {
                th { "" } th { "Record" } th { "Length (s)" } th { "RMS" } th { "Crest factor" } th { "Kurtosis" }
                th { "BPFO (dB)" } th { "BPFI (dB)" } th { "BSF (dB)" } th { "FTF (dB)" } th { "Spall (mm)" } th { "Verdict" }
            }
            @for (at, entry) in entries.iter().enumerate() {
                tr {
                    td { (at + 1) }
                    @if let Some(findings) = &entry.findings {
                        td {
                            @if let Some(folder) = &entry.folder {
                                a href=(format!("{folder}/report.html")) { (entry.file) }
                            } @else { (entry.file) }
                        }
                        td { (format!("{:.2}", findings.duration_s)) } td { (number(findings.health.rms)) }
                        td { (number(findings.health.crest_factor)) } td { (number(findings.health.kurtosis)) }
                        @for name in Defect::ALL {
                            @let (db, claimed) = level(findings, name);
                            td { @if claimed { strong { (db) } } @else { (db) } }
                        }
                        td {
                            @if let Some(spall) = findings.spall_mm { (format!("{:.2} ({:.2}–{:.2})", spall.value, spall.low, spall.high)) }
                            @else if findings.spall_below_mm.is_some() { "one event" }
                            @else { "–" }
                        }
                        td { (findings.verdict) }
                    } @else {
                        td { (entry.file) }
                        td colspan="10" { (entry.error.as_deref().unwrap_or("not analysed")) }
                    }
                }
            }
        }
        p class="hint" { "Levels of the first harmonic above the background of the envelope spectrum; bold \
            where a defect is claimed." }
    }
}

/// A column a limit, a row a record.
fn alarms(entries: &[SeriesRecord], limits: &[Limit]) -> Markup {
    html! {
        table {
            tr { th { "" } th { "Record" } @for limit in limits { th { (limit.quantity.name()) } } }
            tr { td { "" } td { "Warning from" } @for limit in limits { td { (format!("{:.4}", limit.warning)) } } }
            tr { td { "" } td { "Alarm from" } @for limit in limits { td { (format!("{:.4}", limit.alarm)) } } }
            @for (at, entry) in entries.iter().enumerate() {
                tr {
                    td { (at + 1) }
                    td { (entry.file) }
                    @for limit in limits {
                        td {
                            @match entry.alarms.iter().find(|j| j.limit.quantity == limit.quantity) {
                                None => "–",
                                Some(judged) => {
                                    @match judged.state {
                                        State::Good => (format!("{:.4}", judged.value)),
                                        State::Warning => { (format!("{:.4} ", judged.value)) strong { "warning" } },
                                        State::Alarm => { (format!("{:.4} ", judged.value)) strong { "alarm" } },
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Levels from one record to the next, beside their limits.
pub(crate) fn levels(entries: &[SeriesRecord], limits: &[Limit]) -> Vec<Figure> {
    let over = |of: &dyn Fn(&MeasuredFindings) -> Option<f64>| -> Vec<f64> {
        entries.iter().map(|e| e.findings.as_ref().and_then(of).unwrap_or(f64::NAN)).collect()
    };
    let chart = |id: &str, title: &str, axis: Axis| chart(id, title, entries.len(), axis);
    let limited = |mut figure: Figure, quantities: &[Quantity]| {
        // One that lies far above all values would leave them no room.
        let values = figure.series.iter().flat_map(|s| &s.y).copied().filter(|y| y.is_finite());
        let most = ROOM * values.fold(0.0, f64::max);
        for limit in limits.iter().filter(|limit| quantities.contains(&limit.quantity)) {
            let name = limit.quantity.name();
            for (y, what, colour) in
                [(limit.warning, "warning", Colour::Orange), (limit.alarm, "alarm", Colour::Red)]
            {
                if y <= most {
                    figure.levels.push(Level { y, label: format!("{name} {what}"), colour });
                } else {
                    figure.note = format!("Limits above {most:.3} are in the table only.");
                }
            }
        }
        figure
    };
    let unit =
        entries.iter().find_map(|e| e.findings.as_ref()?.unit.clone()).unwrap_or_else(|| "unit".to_owned());
    let level = |name: Defect| {
        over(&|f: &MeasuredFindings| {
            let of = |family: &Family| family.level_db.filter(|_| family.is_there());
            f.families.iter().find(|family| family.name == name).and_then(of)
        })
    };
    let rms = chart("rms", "Root mean square", Axis::plain("RMS", &unit)).with(points(
        "RMS",
        Colour::Blue,
        over(&|f| Some(f.health.rms)),
    ));
    let shape = chart("kurtosis", "Kurtosis and crest factor", Axis::plain("Kurtosis, crest factor", ""))
        .with(points("kurtosis", Colour::Blue, over(&|f| Some(f.health.kurtosis))))
        .with(points("crest factor", Colour::Orange, over(&|f| Some(f.health.crest_factor))));
    let mut figures =
        vec![limited(rms, &[Quantity::Rms]), limited(shape, &[Quantity::Kurtosis, Quantity::CrestFactor])];
    let velocity = over(&|f| f.velocity_mm_s);
    if velocity.iter().any(|v| v.is_finite()) {
        let figure = chart("velocity", "Velocity, 10 to 1000 Hz", Axis::plain("RMS of velocity", "mm/s"));
        let figure = figure.with(points("velocity", Colour::Blue, velocity));
        figures.push(limited(figure, &[Quantity::VelocityMmS]));
    }
    let mut levels =
        chart("first-lines", "First lines of the families that are there", Axis::plain("Level", "dB"));
    for (name, colour) in Defect::ALL.into_iter().zip(COLOURS) {
        let y = level(name);
        if y.iter().any(|db| db.is_finite()) {
            levels = levels.with(points(name.name(), colour, y));
        }
    }
    if !levels.series.is_empty() {
        let all = [Quantity::Bpfo, Quantity::Bpfi, Quantity::Bsf, Quantity::Ftf];
        figures.push(limited(levels, &all));
    }
    figures
}

/// Colours of the families, in their order.
const COLOURS: [Colour; 4] = [Colour::Blue, Colour::Orange, Colour::Green, Colour::Purple];

fn chart(id: &str, title: &str, records: usize, axis: Axis) -> Figure {
    Figure::new(id, title, Axis::counted("Record", records), axis)
}

fn points(name: &str, colour: Colour, y: Vec<f64>) -> Curve {
    Curve::sampled(name, colour, 1.0, 1.0, y).as_points()
}

/// Heights of the families' combs, with the onsets of those that are claimed.
pub(crate) fn heights(series: &Series) -> Option<Figure> {
    let axis = Axis::plain("Height above the background", "dB");
    let mut figure = chart("heights", "How high each family stands", series.records, axis);
    for (family, colour) in series.families.iter().zip(COLOURS) {
        let y: Vec<f64> = family.height_db.iter().map(|db| db.unwrap_or(f64::NAN)).collect();
        if y.iter().any(|db| db.is_finite()) {
            figure = figure.with(points(family.name.name(), colour, y));
        }
        if let Some(Onset { record, low, high }) = family.onset {
            let name = family.name;
            figure.marks.push(Mark::new(record as f64, format!("{name} since {record}"), colour, false));
            let label = format!("{name} begins, 90 %");
            figure.bands.push(Band { from: low as f64 - 0.5, to: high as f64 + 0.5, label });
        }
    }
    (!figure.series.is_empty()).then_some(figure)
}

/// Lengths of a spall with their intervals, where two records at least give one.
fn lengths(series: &Series, records: &[SeriesRecord]) -> Option<Figure> {
    series.growth?;
    let of = |value: fn(&Interval) -> f64| -> Vec<f64> {
        let spall = |record: &SeriesRecord| record.findings.as_ref()?.spall_mm.as_ref().map(value);
        records.iter().map(|record| spall(record).unwrap_or(f64::NAN)).collect()
    };
    let axis = Axis::plain("Length", "mm");
    let figure = chart("lengths", "Length of the spall", records.len(), axis)
        .with(points("length", Colour::Blue, of(|mm| mm.value)))
        .with(points("90 %, from", Colour::Grey, of(|mm| mm.low)))
        .with(points("90 %, to", Colour::Grey, of(|mm| mm.high)));
    Some(figure)
}
