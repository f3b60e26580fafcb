//! The verdict on one sheet of paper, for whoever decides: answers, one picture, and where it comes from.

use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use stribeck_diagnosis::words::brief::Brief;
use stribeck_diagnosis::words::numbers::significant;
use stribeck_diagnosis::{Analysis, MeasuredFindings};
use stribeck_store::run_dir::write_atomic;

use crate::measured::{self, Baseline};
use crate::page::{sentence, with_code};
use crate::plot::Figure;
use crate::series::{self, SeriesFindings};
use crate::{Error, SeriesRecord};

/// Name of the sheet, which a browser prints.
pub const SHEET: &str = "verdict.html";
/// Width of its picture: letters are as large as those about it [px].
const PICTURE_PX: u32 = 640;

/// Writes the sheet of the record in `file` into `folder`, which must be there.
///
/// # Errors
/// Where the picture cannot be drawn or the file not be written.
pub fn write_brief(
    folder: &Path,
    file: &str,
    analysis: &Analysis,
    baseline: Option<&Baseline>,
) -> Result<(), Error> {
    let findings = &analysis.findings;
    let mut provenance = vec![("Record", recorded(file, findings)), ("Machine", machine(findings))];
    provenance.extend(baseline.map(|healthy| ("Healthy machine", healthy.name.clone())));
    let mut figures = measured::evidence(analysis, baseline)?;
    // Without a claim what stands highest: a comb that is no family's before the nearest family.
    let is_foreign = |figure: &Figure| figure.id == measured::FOREIGN;
    let foreign =
        figures.iter().position(is_foreign).filter(|_| !findings.families.iter().any(|f| f.claimed));
    let picture = (!figures.is_empty()).then(|| figures.swap_remove(foreign.unwrap_or(0)));
    write(folder, file, &findings.verdict, &Brief::of(findings), picture, provenance)
}

/// Writes the sheet of a series of records into `folder`, which must be there.
///
/// # Errors
/// Where the picture cannot be drawn or the file not be written.
pub fn write_series_brief(folder: &Path, findings: &SeriesFindings) -> Result<(), Error> {
    let SeriesFindings { series, records } = findings;
    let analysed = || records.iter().filter_map(|record| Some((record, record.findings.as_ref()?)));
    let Some((_, last)) = analysed().next_back() else { return Ok(()) };
    let title = format!("A series of {} records", records.len());
    let name = |record: &SeriesRecord| {
        Path::new(&record.file).file_name().map_or(record.file.clone(), |n| n.to_string_lossy().into_owned())
    };
    let ends = [records.first(), records.last()].map(|record| record.map_or(String::new(), name));
    let provenance = vec![
        (
            "Records",
            format!("{} of {} analysed, {} to {}", series.analysed, series.records, ends[0], ends[1]),
        ),
        ("The last", recorded("", last)),
        ("Machine", machine(last)),
    ];
    let picture = series::heights(series).or_else(|| series::levels(records, &[]).into_iter().next());
    write(folder, &title, &series.verdict, &Brief::of_series(series, last), picture, provenance)
}

fn write(
    folder: &Path,
    title: &str,
    verdict: &str,
    brief: &Brief,
    picture: Option<Figure>,
    provenance: Vec<(&str, String)>,
) -> Result<(), Error> {
    let program = ("Program", format!("Stribeck {}; all numbers: findings.json", env!("CARGO_PKG_VERSION")));
    let picture = picture.map(|figure| Figure { width_px: PICTURE_PX, ..figure });
    let drawn = picture.as_ref().map(Figure::to_svg).transpose()?;
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                title { (brief.headline) ": " (title) }
                style { (PreEscaped(include_str!("../assets/brief.css"))) }
            }
            body {
                p class="of" { (title) }
                h1 { (brief.headline) }
                p { (with_code(verdict)) }
                (answers(brief))
                @if let (Some(figure), Some(svg)) = (&picture, &drawn) {
                    figure {
                        (PreEscaped(svg))
                        figcaption { (figure.caption) " " (figure.note) }
                    }
                }
                table class="small" {
                    @for (name, value) in provenance.iter().chain([&program]) { tr { th { (name) } td { (value) } } }
                }
            }
        }
    };
    write_atomic(&folder.join(SHEET), page.into_string().as_bytes())?;
    Ok(())
}

/// How sure, how long, not seen, next: a row each.
pub(crate) fn answers(brief: &Brief) -> Markup {
    let Brief { sure, length, unseen, next, .. } = brief;
    html! {
        table class="answers" {
            tr { th { "How sure" } td { (sure) } }
            @if let Some(length) = length { tr { th { "How long" } td { (length) } } }
            tr { th { "Not seen" } td { (unseen) } }
            tr { th { "Next" } td { (with_code(next)) } }
        }
    }
}

/// Length, rate and quality of a record in words.
fn recorded(file: &str, findings: &MeasuredFindings) -> String {
    let MeasuredFindings { channel, unit, rate_hz, duration_s, .. } = findings;
    let file = if file.is_empty() { String::new() } else { format!("{file}, ") };
    let unit = unit.as_ref().map_or(", unit not known".to_owned(), |unit| format!(", in {unit}"));
    let flaws: Vec<&str> = findings.quality.iter().map(|found| found.kind.name()).collect();
    let flaws = if flaws.is_empty() { String::new() } else { format!("; {}", flaws.join(", ")) };
    format!("{file}{channel}, {duration_s:.2} s at {} Hz{unit}{flaws}", significant(*rate_hz, 7))
}

/// Bearing and speed, and how the speed is known.
fn machine(findings: &MeasuredFindings) -> String {
    let bearing = findings.bearing.as_deref().unwrap_or("bearing not known");
    let speed = match (findings.speed_rpm, findings.speed_uncertainty_rpm, findings.speed_given_rpm) {
        (None, ..) => "speed not known".to_owned(),
        (Some(rpm), Some(off), _) => format!("{rpm:.1} ± {off:.1} rpm, sought in the record"),
        (Some(rpm), None, Some(given)) => format!("{rpm:.1} rpm by the lines of the shaft, {given:.1} given"),
        (Some(rpm), None, None) => format!("{rpm:.1} rpm"),
    };
    let zone = findings
        .zone
        .as_ref()
        .map_or(String::new(), |zone| format!(". Velocity: {}", sentence(&zone.to_string())));
    format!("{bearing}; {speed}{zone}")
}
