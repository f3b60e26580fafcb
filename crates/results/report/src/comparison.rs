//! The page of a comparison: changed fields, changed results, and the curves over each other.

mod figures;

use std::path::Path;

use maud::{Markup, PreEscaped, html};
use stribeck_analysis::comparison::{Comparison, Contrast, FieldDifference, Kind, Row, Side, Verdict};
use stribeck_analysis::statistic::Statistic;
use stribeck_diagnosis::words::numbers::{gravities, significant};
use stribeck_store::run_dir::write_atomic;

use crate::Error;
use crate::page::{HALF_PAGE_PX, capital, document, json, sentence};
use crate::plot::{Colour, Figure};
use figures::Figures;

/// Most sides whose curves stay apart over each other.
pub const MOST_COMPARED: usize = Colour::FOREGROUNDS.len();
/// Fields and numbers that the answer names; the tables have all.
const NAMED: usize = 4;
/// Least change of a number that the answer names where its scatter is unknown [%].
const WORTH: f64 = 10.0;
/// Longest value of a field in the answer [characters].
const LONGEST: usize = 48;

/// Writes `compare.json` and `report.html` into `folder`, which is made.
pub fn write_comparison(folder: &Path, comparison: &Comparison) -> Result<(), Error> {
    std::fs::create_dir_all(folder).map_err(|why| Error::Write { path: folder.to_owned(), why })?;
    write_atomic(&folder.join("compare.json"), json(comparison)?.as_bytes())?;
    let page = page(comparison)?.into_string();
    write_atomic(&folder.join("report.html"), page.as_bytes())?;
    Ok(())
}

fn page(comparison: &Comparison) -> Result<Markup, Error> {
    let sides = &comparison.sides;
    let title = title(sides);
    let Figures { trace, spectra, envelope, forces } = Figures::of(comparison);
    let picture = match comparison.is_of_surfaces() {
        true => spectra.first().or(envelope.first()),
        false => envelope.first().or(spectra.first()),
    };
    let first = first_screen(comparison, picture.or(trace.first()))?;
    let drawn = |figures: Vec<Figure>| figures.iter().map(Figure::to_html).collect::<Result<Vec<_>, _>>();
    let sections = [
        ("signals", "Signals", drawn(trace)?),
        ("spectra", "Spectra", drawn(spectra)?),
        ("envelopes", "Envelope spectra", drawn(envelope)?),
        ("forces", "Forces", drawn(forces)?),
    ];
    Ok(document(
        &title,
        html! {
            h1 { (title) }
            (first)
            (at_a_glance(sides))
            h2 #fields { "What was changed" }
            (fields(comparison))
            h2 #numbers { "What changed with it" }
            (rows(comparison, &comparison.rows))
            @for (id, name, figures) in sections.iter().filter(|(_, _, figures)| !figures.is_empty()) {
                h2 id=(id) { (name) }
                @for figure in figures { (figure) }
            }
            @if !comparison.numbers.is_empty() {
                h2 #all { "All numbers" }
                details {
                    summary { (format!("The {} numbers of the summaries that are not the same", comparison.numbers.len())) }
                    (rows(comparison, &comparison.numbers))
                }
            }
            h2 #notes { "Notes" }
            ul class="notes" { @for note in &comparison.notes { li { (sentence(note)) } } }
        },
    ))
}

/// The answer, its first sentence in bold, beside a figure.
fn first_screen(comparison: &Comparison, figure: Option<&Figure>) -> Result<Markup, Error> {
    let lines = answer(comparison);
    let Some((first, others)) = lines.split_first() else { return Ok(html! {}) };
    let picture = figure.map(|figure| {
        Ok::<_, Error>((&figure.id, Figure { width_px: HALF_PAGE_PX, ..figure.clone() }.to_svg()?))
    });
    let picture = picture.transpose()?;
    Ok(html! {
        div class="top" {
            p class="headline" { (first) }
            @if let Some((id, svg)) = picture { a class="picture" href={ "#" (id) } { (PreEscaped(svg)) } }
            div class="answer" { @for line in others { p { (line) } } }
        }
    })
}

fn title(sides: &[Side]) -> String {
    match sides {
        [a, b] => format!("{} beside {}", b.label, a.label),
        [a, others @ ..] => format!("{} beside {}", count(others.len(), "other"), a.label),
        [] => String::new(),
    }
}

fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// The answer in a few sentences: the results that differ, the fields that do, and each side alone.
pub fn answer(comparison: &Comparison) -> Vec<String> {
    let sides = &comparison.sides;
    let scenes = sides.iter().filter(|side| side.scene.is_some()).count();
    let changed = match (scenes, comparison.fields.len()) {
        (0 | 1, _) => String::new(),
        (_, 0) => "The scenes are the same.".to_owned(),
        (_, fields) => {
            let named = comparison.fields.iter().take(NAMED).map(field_in_words);
            let more = fields.saturating_sub(NAMED);
            let rest = if more > 0 { format!(", and {more} more") } else { String::new() };
            format!(
                "The scenes differ in {}: {}{rest}.",
                count(fields, "field"),
                named.collect::<Vec<_>>().join("; ")
            )
        }
    };
    let known: Vec<&Row> =
        comparison.rows.iter().filter(|row| row.against_first.iter().any(Option::is_some)).collect();
    let scatter = known
        .iter()
        .any(|row| row.against_first.iter().flatten().any(|contrast| contrast.verdict != Verdict::Unknown));
    let differ: Vec<&&Row> = known.iter().filter(|row| row.differs()).collect();
    let follows = if known.is_empty() {
        "They have no number in common.".to_owned()
    } else if !scatter {
        // In the order of the table, the signal first.
        let changes = |row: &&&Row| {
            let percent = row.against_first.iter().flatten().filter_map(|c| c.percent);
            percent.map(f64::abs).any(|percent| percent >= WORTH)
        };
        let mut told = Vec::new();
        // A peak that is that of the exits is told once.
        let is_new = |row: &&&Row| {
            let values = values_in_words(row);
            let is_new = !told.contains(&values);
            told.push(values);
            is_new
        };
        let named = known.iter().filter(changes).filter(is_new).take(NAMED).map(|row| row_in_words(row));
        let named: Vec<String> = named.collect();
        if known.iter().all(|row| row.against_first.iter().flatten().all(|c| c.difference == 0.0)) {
            "No number differs.".to_owned()
        } else {
            match named.is_empty() {
                true => format!("No number differs by {WORTH} % or more."),
                false => format!("{}.", capital(&named.join("; "))),
            }
        }
    } else if differ.is_empty() {
        format!("None of {} differs by more than the starts scatter.", count(known.len(), "number"))
    } else {
        let named = differ.iter().take(NAMED).map(|row| row_in_words(row));
        let more = differ.len().saturating_sub(NAMED);
        let rest = if more > 0 { format!(", and {more} more") } else { String::new() };
        format!(
            "{} of {} differ by more than the starts scatter: {}{rest}.",
            differ.len(),
            count(known.len(), "number"),
            named.collect::<Vec<_>>().join("; ")
        )
    };
    let verdict = |side: &Side| match side.verdict.as_str() {
        "" => format!("{}: too short to be judged by itself.", side.label),
        words => format!("{}: {}", side.label, sentence(words)),
    };
    let caution = if known.is_empty() || scatter {
        String::new()
    } else {
        "Each is a single signal, so change and scatter are not distinguished.".to_owned()
    };
    [mesh(comparison), follows, changed, caution, sides.iter().map(verdict).collect::<Vec<_>>().join(" ")]
        .into_iter()
        .filter(|line| !line.is_empty())
        .collect()
}

/// The line of the mesh in each side, where surfaces of contact differ and one has it.
fn mesh(comparison: &Comparison) -> String {
    let lines = &comparison.mesh_lines;
    if !comparison.is_of_surfaces() || lines.iter().all(Option::is_none) {
        return String::new();
    }
    let each = comparison.sides.iter().zip(lines).map(|(side, line)| match line {
        Some(line) => format!("{} has it at {:.0} Hz, {}", side.label, line.hz, gravities(line.level_g)),
        None => format!("{} has none", side.label),
    });
    format!("Line of the mesh: {}.", each.collect::<Vec<_>>().join("; "))
}

fn field_in_words(difference: &FieldDifference) -> String {
    let value = |value: &Option<String>| shortened(value.as_deref().unwrap_or("–"));
    let values: Vec<String> = difference.values.iter().map(value).collect();
    format!("{} {}", difference.field, values.join(" → "))
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    let kept: String = text.chars().take(LONGEST - 1).collect();
    format!("{kept}…")
}

fn row_in_words(row: &Row) -> String {
    format!("{} {}", row.quantity, values_in_words(row))
}

fn values_in_words(row: &Row) -> String {
    let value = |v: &Option<Statistic>| v.as_ref().map_or("–".to_owned(), |s| significant(s.mean, 3));
    let values: Vec<String> = row.values.iter().map(value).collect();
    format!("{} {}", values.join(" → "), row.unit).trim_end().to_owned()
}

/// The sides with their colours.
fn at_a_glance(sides: &[Side]) -> Markup {
    let known = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
    html! {
        div class="scroll" {
            table {
                tr {
                    th { "" } th { "What" } th { "Bearing" } th { "Shaft (rpm)" } th { "Load (N)" } th { "Signal" }
                    th { "Length (s)" } th { "Rate (Hz)" }
                }
                @for (side, colour) in sides.iter().zip(Colour::FOREGROUNDS) {
                    tr {
                        td { span class="side" style=(format!("background: var({})", colour.name())) {} (side.label) }
                        td { (kind(side)) }
                        td { (known(side.bearing.clone())) }
                        td { (known(side.shaft_hz.map(|hz| significant(60.0 * hz, 5)))) }
                        td { (known(side.load_n.map(|n| significant(n, 5)))) }
                        td { (side.channel) @if !side.unit.is_empty() { ", in " (if side.kind == Kind::Record { side.unit.as_str() } else { "g" }) } }
                        td { (significant(side.duration_s, 4)) }
                        td { (significant(side.rate_hz, 6)) }
                    }
                }
            }
        }
    }
}

fn kind(side: &Side) -> String {
    match side.kind {
        Kind::Run => "run".to_owned(),
        Kind::Ensemble => count(side.signals, "start"),
        Kind::Record => "measured record".to_owned(),
    }
}

fn fields(comparison: &Comparison) -> Markup {
    let with_scene = comparison.sides.iter().filter(|side| side.scene.is_some()).count();
    html! {
        @if with_scene < 2 {
            p { "Records have no scene, so nothing can be said of what was changed between them." }
        } @else if comparison.fields.is_empty() {
            p { "Nothing: the scenes are the same in every field but their names." }
        } @else {
            div class="scroll" {
                table {
                    tr { th { "Field" } @for side in &comparison.sides { th { (side.label) } } }
                    @for difference in &comparison.fields {
                        tr {
                            td { code { (difference.field) } }
                            @for value in &difference.values { td { (value.as_deref().unwrap_or("–")) } }
                        }
                    }
                }
            }
        }
    }
}

fn rows(comparison: &Comparison, rows: &[Row]) -> Markup {
    let sides = &comparison.sides;
    html! {
        div class="scroll" {
            table {
                tr {
                    th { "Quantity" }
                    @for side in sides { th class="n" { (side.label) } }
                    @for side in sides.iter().skip(1) {
                        th class="n" { @if sides.len() == 2 { "Difference" } @else { (side.label) " less " (sides[0].label) } }
                        th { "By chance?" }
                    }
                }
                @for row in rows {
                    tr {
                        td { (row.quantity) @if !row.unit.is_empty() { " (" (row.unit) ")" } }
                        @for value in &row.values { td class="n" { (value.as_ref().map_or("–".to_owned(), mean)) } }
                        @for contrast in &row.against_first {
                            @match contrast {
                                None => { td class="n absent" { "–" } td {} },
                                Some(contrast) => {
                                    td class="n" { (difference(contrast)) }
                                    @let words = by_chance(contrast, sides);
                                    td { @if contrast.verdict == Verdict::Differs { strong { (words) } } @else { (words) } }
                                },
                            }
                        }
                    }
                }
            }
        }
        p class="hint" {
            @if sides.iter().any(|side| side.scene.is_some()) {
                "Where a side has several starts: mean ± standard deviation of one start. Differences with \
                 their 95 % interval; a number differs where that leaves zero out."
            } @else {
                "One record of each: how far a further one would scatter is unknown."
            }
        }
    }
}

/// Whether a difference may be chance, in words. Records have no starts.
pub fn by_chance(contrast: &Contrast, sides: &[Side]) -> &'static str {
    match contrast.verdict {
        Verdict::Unknown if sides.iter().all(|side| side.scene.is_none()) => "one record each",
        verdict => verdict.words(),
    }
}

/// The mean, and how far one start scatters.
pub fn mean(statistic: &Statistic) -> String {
    let mean = significant(statistic.mean, 4);
    match statistic.deviation {
        Some(deviation) => format!("{mean} ± {}", significant(deviation, 2)),
        None => mean,
    }
}

/// A difference with its interval, or as a part of the first where there is none.
pub fn difference(contrast: &Contrast) -> String {
    let signed = |value: f64| {
        let text = significant(value, 3);
        if value > 0.0 { format!("+{text}") } else { text.replace('-', "−") }
    };
    let part = contrast.percent.filter(|p| p.abs() < 1e4).map(|p| format!(" ({} %)", signed(p)));
    let interval =
        contrast.low.zip(contrast.high).map(|(low, high)| format!(" [{} to {}]", signed(low), signed(high)));
    format!("{}{}{}", signed(contrast.difference), part.unwrap_or_default(), interval.unwrap_or_default())
}
