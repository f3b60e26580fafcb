//! The page of several measured records side by side: levels and defect families from one record to the next.

use std::path::Path;

use maud::{DOCTYPE, Markup, html};
use serde::Serialize;
use stribeck_store::run_dir::write_atomic;

use crate::Error;
use crate::page::{head, json};
use crate::plot::{Axis, Colour, Figure, Level, Series};
use stribeck_diagnosis::joint::Joint;
use stribeck_diagnosis::record::alarm::{Judged, Limit, Quantity, State};
use stribeck_diagnosis::words::numbers::chance;
use stribeck_diagnosis::{Defect, Family, MeasuredFindings};

/// One record of a trend.
#[derive(Debug, Serialize)]
pub struct TrendEntry {
    /// The file.
    pub file: String,
    /// Folder of its own page, below that of the trend.
    pub folder: String,
    /// Its findings; `null` where it could not be analysed.
    pub findings: Option<MeasuredFindings>,
    /// Why it could not be.
    pub error: Option<String>,
    /// How its levels stand to the limits.
    pub alarms: Vec<Judged>,
}

/// Highest limit that is drawn, over the highest value.
const ROOM: f64 = 2.0;

/// Writes `trend.json` and `trend.html` of some records, in their order, into `folder`, which must be there;
/// `limits` are drawn beside the levels.
///
/// # Errors
/// [`Error::Run`] when the files cannot be written, [`Error::Drawing`].
pub fn write_trend(folder: &Path, entries: &[TrendEntry], limits: &[Limit]) -> Result<(), Error> {
    write_atomic(&folder.join("trend.json"), json(&entries)?.as_bytes())?;
    write_atomic(&folder.join("trend.html"), page(entries, limits)?.into_string().as_bytes())?;
    Ok(())
}

/// Writes `joint.json` and `joint.html` of several channels of one machine and their joint verdict into
/// `folder`, which must be there.
///
/// # Errors
/// [`Error::Run`] when the files cannot be written, [`Error::Drawing`].
pub fn write_joint(folder: &Path, joint: &Joint, entries: &[TrendEntry]) -> Result<(), Error> {
    write_atomic(&folder.join("joint.json"), json(&joint)?.as_bytes())?;
    write_atomic(&folder.join("joint.html"), joint_page(joint, entries).into_string().as_bytes())?;
    Ok(())
}

fn joint_page(joint: &Joint, entries: &[TrendEntry]) -> Markup {
    let title = format!("{} channels together", entries.len());
    html! {
        (DOCTYPE)
        html lang="en" {
            (head(&title))
            body {
                h1 { (title) }
                p class="lead" { (joint.verdict) }
                @for note in &joint.notes { p class="hint" { (note) } }
                h2 #shares { "Share of each channel" }
                div class="scroll" { (families_by_channel(joint)) }
                p class="hint" {
                    "The part of each channel in the power that swings with a family, and the height of the \
                    family in it; bold where the channel claims a defect by itself. The probability of a false \
                    alarm is the smallest of all channels times their number, which holds however they depend \
                    on each other."
                }
                h2 #channels { "Channels" }
                div class="scroll" { (table(entries)) }
            }
        }
    }
}

/// Families of a joint verdict: a row a family, a column a channel.
fn families_by_channel(joint: &Joint) -> Markup {
    let number = |x: Option<f64>, unit: &str, factor: f64| {
        x.map_or_else(|| "–".to_owned(), |x| format!("{:.0} {unit}", factor * x))
    };
    html! {
        table {
            tr {
                th { "Family" } @for name in &joint.channels { th { (name) } }
                th { "False alarm" } th { "Nearest" } th { "Verdict" }
            }
            @for family in &joint.families {
                tr {
                    td { (family.name) }
                    @for channel in &family.channels {
                        @let share = number(channel.share, "%", 100.0);
                        @let text = format!("{share}, {}", number(channel.height_db, "dB", 1.0));
                        td { @if channel.claimed { strong { (text) } } @else { (text) } }
                    }
                    td { (chance(family.p_value)) }
                    td { (family.nearest.as_deref().filter(|_| family.claimed).unwrap_or("–")) }
                    td { @if family.claimed { strong { "a defect" } } @else { "none" } }
                }
            }
        }
    }
}

fn page(entries: &[TrendEntry], limits: &[Limit]) -> Result<Markup, Error> {
    let figures = figures(entries, limits).iter().map(Figure::to_html).collect::<Result<Vec<_>, _>>()?;
    let title = format!("{} records side by side", entries.len());
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            (head(&title))
            body {
                h1 { (title) }
                p class="lead" { "In the order in which they were given." }
                div class="scroll" { (table(entries)) }
                @if !limits.is_empty() {
                    h2 #alarms { "Alarm bands" }
                    div class="scroll" { (alarms(entries, limits)) }
                    h2 #levels-over-records { "Levels" }
                }
                @for figure in figures { (figure) }
            }
        }
    })
}

fn table(entries: &[TrendEntry]) -> Markup {
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
                        td { a href=(format!("{}/report.html", entry.folder)) { (entry.file) } }
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
fn alarms(entries: &[TrendEntry], limits: &[Limit]) -> Markup {
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

fn figures(entries: &[TrendEntry], limits: &[Limit]) -> Vec<Figure> {
    let over = |of: &dyn Fn(&MeasuredFindings) -> Option<f64>| -> Vec<f64> {
        entries.iter().map(|e| e.findings.as_ref().and_then(of).unwrap_or(f64::NAN)).collect()
    };
    let chart = |id: &str, title: &str, axis: Axis| {
        Figure::new(id, title, Axis::counted("Record", entries.len()), axis)
    };
    let points = |name: &str, colour, y| Series::sampled(name, colour, 1.0, 1.0, y).as_points();
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
    let colours = [Colour::Blue, Colour::Orange, Colour::Green, Colour::Purple];
    let mut levels = chart("levels", "Defect families that are there", Axis::plain("Level", "dB"));
    for (name, colour) in Defect::ALL.into_iter().zip(colours) {
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
