//! The page of several measured records side by side: how health and defect families went from one to the next.

use std::path::Path;

use maud::{DOCTYPE, Markup, html};
use serde::Serialize;
use stribeck_scene::run_dir::write_atomic;

use super::{head, json};
use crate::Error;
use crate::measured::{Family, Findings};
use crate::plot::{Axis, Colour, Figure, Series};

/// One record of a trend.
#[derive(Debug, Serialize)]
pub struct TrendEntry {
    /// The file.
    pub file: String,
    /// Folder of its own page, below that of the trend.
    pub folder: String,
    /// Its findings; `null` where it could not be analysed.
    pub findings: Option<Findings>,
    /// Why it could not be.
    pub error: Option<String>,
}

/// Writes `trend.json` and `trend.html` of some records, in their order, into `folder`, which must be there.
///
/// # Errors
/// [`Error::Run`] when the files cannot be written, [`Error::Drawing`].
pub fn write_trend(folder: &Path, entries: &[TrendEntry]) -> Result<(), Error> {
    write_atomic(&folder.join("trend.json"), json(&entries)?.as_bytes())?;
    write_atomic(&folder.join("trend.html"), page(entries)?.into_string().as_bytes())?;
    Ok(())
}

fn page(entries: &[TrendEntry]) -> Result<Markup, Error> {
    let figures = figures(entries).iter().map(Figure::to_html).collect::<Result<Vec<_>, _>>()?;
    let title = format!("{} records side by side", entries.len());
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            (head(&title))
            body {
                h1 { (title) }
                p class="lead" { "In the order in which they were given." }
                div class="scroll" { (table(entries)) }
                @for figure in figures { (figure) }
            }
        }
    })
}

fn table(entries: &[TrendEntry]) -> Markup {
    let number = |x: f64| format!("{x:.4}");
    let level = |findings: &Findings, name: &str| {
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
                        @for name in ["BPFO", "BPFI", "BSF", "FTF"] {
                            @let (db, claimed) = level(findings, name);
                            td { @if claimed { strong { (db) } } @else { (db) } }
                        }
                        td {
                            @if let Some(spall) = findings.spall_mm { (format!("{:.2} ({:.2}–{:.2})", spall.value, spall.low, spall.high)) }
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
        p class="hint" { "Levels of the first harmonic above the background of the envelope spectrum; bold where a defect is claimed." }
    }
}

fn figures(entries: &[TrendEntry]) -> Vec<Figure> {
    let over = |of: &dyn Fn(&Findings) -> Option<f64>| -> Vec<f64> {
        entries.iter().map(|e| e.findings.as_ref().and_then(of).unwrap_or(f64::NAN)).collect()
    };
    let chart = |id: &str, title: &str, axis: Axis| Figure::new(id, title, Axis::plain("Record", ""), axis);
    let line = |name: &str, colour, y| Series::sampled(name, colour, 1.0, 1.0, y);
    let unit =
        entries.iter().find_map(|e| e.findings.as_ref()?.unit.clone()).unwrap_or_else(|| "unit".to_owned());
    let level = |name: &'static str| {
        over(&|f: &Findings| {
            let of = |family: &Family| family.level_db.filter(|_| family.is_there());
            f.families.iter().find(|family| family.name == name).and_then(of)
        })
    };
    let mut figures = vec![
        chart("rms", "Root mean square", Axis::plain("RMS", &unit)).with(line(
            "RMS",
            Colour::Blue,
            over(&|f| Some(f.health.rms)),
        )),
        chart("kurtosis", "Kurtosis and crest factor", Axis::plain("Kurtosis, crest factor", ""))
            .with(line("kurtosis", Colour::Blue, over(&|f| Some(f.health.kurtosis))))
            .with(line("crest factor", Colour::Orange, over(&|f| Some(f.health.crest_factor)))),
    ];
    let families =
        [("BPFO", Colour::Blue), ("BPFI", Colour::Orange), ("BSF", Colour::Green), ("FTF", Colour::Purple)];
    let mut levels = chart("levels", "Defect families that are there", Axis::plain("Level", "dB"));
    for (name, colour) in families {
        let y = level(name);
        if y.iter().any(|db| db.is_finite()) {
            levels = levels.with(line(name, colour, y));
        }
    }
    if !levels.series.is_empty() {
        figures.push(levels);
    }
    figures
}
