//! The page of `stribeck detect`: the smallest spall that is found, and the share of records over its length.

use std::path::Path;

use maud::html;
use stribeck_analysis::detection::{CAUTION, Detection, Smallest, WANTED, in_words};
use stribeck_store::run_dir::write_atomic;

use crate::Error;
use crate::page::{document, with_code};
use crate::plot::{Axis, Colour, Figure, Level, Mark, Series};

/// Writes `report.html` into a folder.
pub fn write_detection(folder: &Path, detection: &Detection) -> Result<(), Error> {
    let figure = figure(detection).to_html()?;
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let has_limit = has_limit(detection);
    let page = document(
        &format!("{}: the smallest spall that is found", detection.scene),
        html! {
            h1 { (detection.scene) ": the smallest spall that is found" }
            p class="headline" { (in_words(detection)) }
            @if let Some(sound) = detection.sound {
                p {
                    "Of the healthy bearing the verdict claims " (detection.family) " in " (sound.count) " of "
                    (sound.of) " records (" (percent(sound.low)) " to " (percent(sound.high)) ", 95 %)."
                }
            }
            aside class="limits" { p { strong { "How far to trust it. " } (with_code(CAUTION)) "." } }
            (figure)
            table {
                tr { th { "Length, mm" } th { "Found" } th { "Share" } th { "95 %" } @if has_limit { th { "Curve" } } }
                @for one in &detection.lengths {
                    tr {
                        td { (format!("{:.2}", one.length_mm)) }
                        td { (one.found.count) " of " (one.found.of) }
                        td { (percent(one.found.share)) }
                        td { (percent(one.found.low)) " to " (percent(one.found.high)) }
                        @if has_limit { td { (percent(one.by_curve)) } }
                    }
                }
            }
            p {
                "Each record is a simulated bearing from another start, behind the machine's path, with another \
                background; it is found where the verdict on measured records claims " (detection.family) ". The \
                intervals are Wilson's. "
                @if has_limit {
                    "The curve is logistic in the logarithm of the length; the interval of the length of nine in ten is \
                    that of a parametric bootstrap. "
                } @else {
                    "No curve is drawn: nine of ten lie outside of the lengths that were tried. "
                }
                "Seed " (detection.seed) "."
            }
        },
    );
    write_atomic(&folder.join("report.html"), page.into_string().as_bytes())?;
    Ok(())
}

/// Whether the length of nine in ten lies among those that were tried, which alone makes the curve one that says
/// something.
fn has_limit(detection: &Detection) -> bool {
    matches!(detection.smallest, Smallest::Between { .. })
}

fn figure(detection: &Detection) -> Figure {
    let of = |value: &dyn Fn(&stribeck_analysis::detection::OfLength) -> f64| {
        detection.lengths.iter().map(value).collect::<Vec<f64>>()
    };
    let lengths = of(&|one| one.length_mm.log10());
    let percent =
        |value: &dyn Fn(&stribeck_analysis::detection::OfLength) -> f64| of(&|one| 100.0 * value(one));
    let mut figure = Figure::new(
        "found",
        "Records in which the spall is found",
        Axis::decades("length of the spall", "mm"),
        Axis::plain("records", "%").over(0.0, 100.0),
    )
    .with(
        Series::listed("found", Colour::Orange, lengths.clone(), percent(&|one| one.found.share)).as_points(),
    )
    .with(
        Series::listed("95 %, upper end", Colour::Grey, lengths.clone(), percent(&|one| one.found.high))
            .as_edge(),
    )
    .with(Series::listed("95 %, lower end", Colour::Grey, lengths, percent(&|one| one.found.low)).as_edge());
    if has_limit(detection) {
        let curve = percent(&|one| one.by_curve);
        figure = figure.with(Series::listed("curve", Colour::Blue, of(&|one| one.length_mm.log10()), curve));
    }
    figure.levels.push(Level { y: 100.0 * WANTED, label: "nine of ten".to_owned(), colour: Colour::Grey });
    if let Smallest::Between { length_mm, .. } = detection.smallest {
        figure.marks.push(Mark::new(length_mm.log10(), format!("{length_mm:.2} mm"), Colour::Blue, true));
    }
    figure
}
