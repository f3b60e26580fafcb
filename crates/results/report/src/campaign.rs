//! The index of a campaign: its main numbers over the fields that vary, and a row for each run.

mod change;

use std::collections::BTreeMap;
use std::path::Path;

use maud::{Markup, PreEscaped, html};
use stribeck_analysis::comparison::OF_SIGNAL;
use stribeck_analysis::runs::OneOfMany;
use stribeck_analysis::summary::Summary;
use stribeck_diagnosis::words::numbers::significant;
use stribeck_store::run_dir::write_atomic;

use crate::Error;
use crate::field_words::FieldWords;
use crate::page::{HALF_PAGE_PX, banner, capital, document, sentence};
use crate::plot::{Axis, Colour, Figure, Series};
use change::Change;

/// A campaign whose runs have come to their end.
#[derive(Debug)]
pub struct CampaignIndex {
    /// Its name.
    pub name: String,
    /// What is run, in words; `None` where the bearing is among what varies.
    pub bearing: Option<String>,
    /// Fields that vary.
    pub fields: Vec<String>,
    /// Its runs, in order.
    pub runs: Vec<OneOfMany>,
    /// What was refused, and what its absence gives away.
    pub notes: Vec<String>,
    /// Files beside the page: name and content.
    pub files: Vec<(String, String)>,
}

/// A number that is drawn over the fields.
struct Drawn {
    path: String,
    words: String,
    unit: &'static str,
    /// Whether the table lists it, too: numbers of the signal.
    is_listed: bool,
}

/// Numbers of the leading sensor's signal, then the main ones of the run.
fn drawn() -> Vec<Drawn> {
    let of_signal = OF_SIGNAL.iter().filter_map(|q| {
        let path = q.path?.to_owned();
        Some(Drawn { unit: q.unit.unwrap_or("g"), path, words: capital(q.words), is_listed: true })
    });
    let of_run = Summary::main_quantities().into_iter().map(|q| Drawn {
        words: capital(q.words.unwrap_or_default()),
        unit: q.unit(),
        path: q.path,
        is_listed: false,
    });
    of_signal.chain(of_run).collect()
}

/// Fields that have figures; more are in the tables.
const MOST_FIELDS: usize = 4;
/// Rows of the table.
const MOST_ROWS: usize = 1000;
/// Letters of all names on an axis: the chart of a phone has no room for more.
const NAMES: usize = 40;
/// A field whose values span more than this is drawn over its logarithm.
const DECADES_FROM: f64 = 20.0;

/// Writes `index.html` into the folder of a campaign.
pub fn write_campaign(folder: &Path, index: &CampaignIndex) -> Result<(), Error> {
    let page = page(index)?.into_string();
    write_atomic(&folder.join("index.html"), page.as_bytes())?;
    Ok(())
}

/// What a field does: figures and sentences of the numbers that change, the most first, and the words of
/// those that do not.
struct Over<'a> {
    field: &'a str,
    changes: Vec<(String, Figure)>,
    same: Vec<String>,
}

impl<'a> Over<'a> {
    fn of(index: &'a CampaignIndex, at: usize) -> Self {
        let (field, abscissa) = (index.fields[at].as_str(), Abscissa::of(index, at));
        let mut changes = Vec::new();
        let mut same = Vec::new();
        let mut seen: Vec<Vec<Option<String>>> = Vec::new();
        for drawn in drawn() {
            let numbers: Vec<Option<String>> = index
                .runs
                .iter()
                .map(|run| run.numbers.get(&drawn.path).map(|x| significant(*x, 3)))
                .collect();
            // Two names of one number, as of a peak that is that of the exits.
            if numbers.iter().any(Option::is_some) && seen.contains(&numbers) {
                continue;
            }
            seen.push(numbers);
            let Some(figure) = figure(index, at, &abscissa, &drawn) else { continue };
            match Change::of(index, &abscissa, &drawn.path) {
                Some(change) if change.size(drawn.unit) >= 1.0 => {
                    let words = change.words(&drawn, field);
                    let caption = format!("{words}.");
                    // The signal first: it is what a sensor has of the field.
                    let rank = ((!change.is_monotone(), !drawn.is_listed), -change.size(drawn.unit));
                    changes.push((rank, (words, figure.caption(caption))));
                }
                _ => same.push(drawn.words),
            }
        }
        // What comes and goes may be scatter.
        changes.sort_by(|(a, _), (b, _)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        Self { field, changes: changes.into_iter().map(|(_, change)| change).collect(), same }
    }

    fn markup(&self, is_first: bool) -> Result<Markup, Error> {
        let drawn = self.changes.iter().map(|(_, figure)| figure.to_html()).collect::<Result<Vec<_>, _>>()?;
        let figures = html! { div class="pairs-of-figures" { @for figure in &drawn { (figure) } } };
        Ok(html! {
            h2 { "Over the " (FieldWords::of(self.field).inside()) " " small { code { (self.field) } } }
            @if self.changes.is_empty() && self.same.is_empty() { p { "No run has a number that could be drawn." } }
            // One field at a time; the others are a click away.
            @if is_first || drawn.is_empty() { (figures) }
            @else { details { summary { (format!("{} figures", drawn.len())) } (figures) } }
            @if !self.same.is_empty() { p class="hint" { "No change beyond the scatter: " (self.same.join(", ")) "." } }
        })
    }
}

fn page(index: &CampaignIndex) -> Result<Markup, Error> {
    let over: Vec<Over<'_>> =
        (0..index.fields.len().min(MOST_FIELDS)).map(|at| Over::of(index, at)).collect();
    let complete = index.runs.iter().filter(|run| run.is_complete()).count();
    let sections = over.iter().enumerate().map(|(place, over)| over.markup(place == 0));
    let sections = sections.collect::<Result<Vec<_>, _>>()?;
    Ok(document(
        &index.name,
        html! {
            h1 { (index.name) }
            p class="lead" { (lead(index)) }
            @if complete < index.runs.len() { (incomplete(index, complete)) }
            (first_screen(index, &over)?)
            @for section in sections { (section) }
            h2 #runs { "Runs" }
            (table(index))
            h2 #files { "Files" }
            ul class="notes" {
                @for (file, what) in &index.files { li { a href=(file) { (file) } ": " (what) } }
            }
        },
    ))
}

/// Sentences of a field on the first screen.
const FIRST: usize = 4;

/// What changes most over the first field that changes anything, beside its figure.
fn first_screen(index: &CampaignIndex, over: &[Over<'_>]) -> Result<Markup, Error> {
    let Some((first, figure)) = over.iter().find_map(|over| over.changes.first()) else {
        return Ok(html! { p class="headline" { "Nothing changes beyond the scatter of the runs." } });
    };
    let picture = Figure { width_px: HALF_PAGE_PX, ..figure.clone() }.to_svg()?;
    let others = |over: &Over<'_>| {
        let words = over.changes.iter().map(|(words, _)| words).filter(|words| *words != first);
        words.take(FIRST).map(|words| format!("{words}.")).collect::<Vec<String>>()
    };
    let several = index.runs.iter().any(|run| run.row.start > 1);
    Ok(html! {
        div class="top" {
            p class="headline" { (first) "." }
            a class="picture" href={ "#" (figure.id) } { (PreEscaped(picture)) }
            div class="answer" { @for words in over.iter().flat_map(others) { p { (words) } } }
        }
        aside class="limits" {
            p {
                strong { "How far to trust it. " }
                @if several { "A change counts from three standard deviations of the starts on." }
                @else if index.fields.len() > 1 { "A change counts where it is three times what the other fields make \
                         at one value, and a hundredth at least." }
                @else { "Each value has one start, whose scatter is unknown: a change counts from a tenth or 3 dB \
                         on. Several starts (" code { "starts" } ") measure it." }
                " Means of all runs of a value."
            }
        }
    })
}

fn lead(index: &CampaignIndex) -> String {
    let starts = index.runs.iter().map(|run| run.row.start).max().unwrap_or(1);
    let over = |field: &String| {
        format!("the {} ({} values)", FieldWords::of(field).inside(), values(index, field).len())
    };
    let of_starts = if starts > 1 { format!(", {starts} starts each") } else { String::new() };
    format!(
        "{} runs{} over {}{of_starts}.",
        index.runs.len(),
        index.bearing.as_ref().map_or_else(String::new, |bearing| format!(" of {bearing}")),
        index.fields.iter().map(over).collect::<Vec<_>>().join(", ")
    )
}

/// Values that a field has, each once, in their order.
fn values<'a>(index: &'a CampaignIndex, field: &str) -> Vec<&'a str> {
    let at = index.fields.iter().position(|name| name == field);
    let mut found: Vec<&str> = Vec::new();
    for value in index.runs.iter().filter_map(|run| run.values.get(at?)) {
        let value = value.trim_matches('"');
        if !found.contains(&value) {
            found.push(value);
        }
    }
    found
}

fn incomplete(index: &CampaignIndex, complete: usize) -> Markup {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for run in index.runs.iter().filter(|run| !run.is_complete()) {
        *counts.entry(run.row.status.as_str()).or_default() += 1;
    }
    let notes = index.notes.iter().map(|note| format!(" {}", sentence(note))).collect::<String>();
    let rest = "What the others left is drawn where there is a number, and their reasons are in the table.";
    banner((complete, index.runs.len()), "runs", counts, &format!("{rest}{notes}"))
}

/// Where the values of a field stand on an axis.
struct Abscissa {
    axis: Axis,
    /// Of each run; not a number where it has none.
    places: Vec<f64>,
    /// Names of the words' places on the axis.
    words: String,
    /// Whether more of it is more of something: names and seeds have no order.
    is_ordered: bool,
}

impl Abscissa {
    fn of(index: &CampaignIndex, at: usize) -> Self {
        let field = &index.fields[at];
        let title = FieldWords::of(field);
        let numbers: Option<Vec<f64>> = index.runs.iter().map(|run| run.value(&index.fields, at)).collect();
        let Some(numbers) = numbers else {
            let all = values(index, field);
            let place = |run: &OneOfMany| {
                let value = run.values.get(at).map(|value| value.trim_matches('"'));
                value
                    .and_then(|value| all.iter().position(|v| *v == value))
                    .map_or(f64::NAN, |n| n as f64 + 1.0)
            };
            let places = index.runs.iter().map(place).collect();
            // Longer names would overlap: numbers stand for them.
            let is_short = all.iter().map(|value| value.chars().count() + 1).sum::<usize>() <= NAMES;
            let (axis, words) = if is_short {
                let names = all.iter().map(|value| (*value).to_owned()).collect();
                (Axis::named(&title.words, names), String::new())
            } else {
                let words = all.iter().enumerate().map(|(n, value)| format!("{} is {value}", n + 1));
                let words = format!(" {}.", words.collect::<Vec<_>>().join(", "));
                (Axis::counted(&title.words, all.len()), words)
            };
            return Self { axis, places, words, is_ordered: false };
        };
        let name = field.rsplit('.').next().unwrap_or(field);
        let is_ordered = name != "seed" && !name.ends_with("_seed");
        let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if least > 0.0 && most / least > DECADES_FROM {
            let places = numbers.iter().map(|x| x.log10()).collect();
            let axis = Axis::decades(&title.words, title.unit);
            return Self { axis, places, words: String::new(), is_ordered };
        }
        // Room beside the outer ones.
        let margin = if most > least { 0.04 * (most - least) } else { 0.5 * most.abs().max(1.0) };
        let axis = Axis::plain(&title.words, title.unit).over(least - margin, most + margin);
        Self { axis, places: numbers, words: String::new(), is_ordered }
    }

    /// From the least to the largest place.
    fn width(&self) -> f64 {
        let known = self.places.iter().copied().filter(|place| place.is_finite());
        let (least, most) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        if most > least { most - least } else { 1.0 }
    }
}

/// A quantity over a field, coloured by the other field where there is one other, else by the claimed family.
fn figure(
    index: &CampaignIndex,
    at: usize,
    abscissa: &Abscissa,
    Drawn { path, words, unit, .. }: &Drawn,
) -> Option<Figure> {
    let known = index.runs.iter().zip(&abscissa.places).filter_map(|(run, place)| {
        Some((run, *place, *run.numbers.get(path)?)).filter(|(_, place, _)| place.is_finite())
    });
    let mut known: Vec<(&OneOfMany, f64, f64)> = known.collect();
    if known.is_empty() {
        return None;
    }
    known.sort_by(|a, b| a.1.total_cmp(&b.1));
    let other = (0..index.fields.len()).find(|n| *n != at).filter(|_| index.fields.len() == 2);
    let other = other.filter(|n| values(index, &index.fields[*n]).len() <= Colour::FOREGROUNDS.len());
    let group = |run: &OneOfMany| match other {
        Some(n) => {
            let title = FieldWords::of(&index.fields[n]);
            let value = run.values.get(n).map_or("–", |value| value.trim_matches('"'));
            format!("{} {value} {}", title.inside(), title.unit).trim_end().to_owned()
        }
        None => run.row.claimed.as_ref().map_or("not judged".to_owned(), |claimed| match claimed.as_str() {
            "none" => "nothing claimed".to_owned(),
            "undecided" => "undecided".to_owned(),
            claimed => format!("{claimed} claimed"),
        }),
    };
    let mut groups: Vec<String> = Vec::new();
    for (run, ..) in &known {
        if !groups.contains(&group(run)) {
            groups.push(group(run));
        }
    }
    let id = format!("{}-{at}", path.replace(['.', '_'], "-"));
    let title = format!("{words} over the {}", FieldWords::of(&index.fields[at]).inside());
    let mut figure = Figure::new(&id, &title, abscissa.axis.clone(), Axis::plain(words, unit));
    // A line through names would be a trend.
    let joined = abscissa.is_ordered && (other.is_some() || index.fields.len() == 1);
    let (mut lines, mut dots) = (Vec::new(), Vec::new());
    for (name, colour) in groups.iter().zip(Colour::FOREGROUNDS.into_iter().cycle()) {
        let (x, y): (Vec<f64>, Vec<f64>) =
            known.iter().filter(|(run, ..)| group(run) == *name).map(|(_, x, y)| (*x, *y)).unzip();
        lines.extend(means(name, colour, &x, &y).filter(|_| joined));
        let x = side_by_side(&x, abscissa.width());
        dots.push(Series::listed(name, colour, x, y).as_points());
    }
    // Lines lie behind the dots.
    figure.series = lines.into_iter().chain(dots).collect();
    let starts = index.runs.iter().any(|run| run.row.start > 1);
    let (least, most) = known
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), (_, _, y)| (least.min(*y), most.max(*y)));
    let dots = if starts { "A dot for every start." } else { "A dot for every run." };
    Some(
        figure
            .caption(format!(
                "From {} to {}.",
                significant(least, 3),
                format!("{} {unit}", significant(most, 3)).trim_end()
            ))
            .note(format!("{dots}{}", abscissa.words)),
    )
}

/// A line through the means of points at ascending places, where there are several places.
fn means(name: &str, colour: Colour, x: &[f64], y: &[f64]) -> Option<Series> {
    let (mut places, mut means): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for all in x.chunk_by(|a, b| a == b) {
        let from = x.partition_point(|place| *place < all[0]);
        places.push(all[0]);
        means.push(y[from..from + all.len()].iter().sum::<f64>() / all.len() as f64);
    }
    // Dots and the line through them have one name.
    let name = if places.len() < x.len() { format!("{name}, mean") } else { name.to_owned() };
    (places.len() > 1).then(|| Series::listed(&name, colour, places, means))
}

/// The abscissae, equal ones spread a little, so that no dot hides another.
fn side_by_side(x: &[f64], width: f64) -> Vec<f64> {
    /// Of the width of the axis, from the first to the last of equal places.
    const APART: f64 = 0.012;
    x.chunk_by(|a, b| a == b)
        .flat_map(|all| {
            let step = APART * width / all.len() as f64;
            (0..all.len()).map(move |n| all[0] + step * (n as f64 - 0.5 * (all.len() - 1) as f64))
        })
        .collect()
}

fn table(index: &CampaignIndex) -> Markup {
    let has = |drawn: &Drawn| index.runs.iter().any(|run| run.numbers.contains_key(&drawn.path));
    let listed: Vec<Drawn> = drawn().into_iter().filter(|drawn| drawn.is_listed && has(drawn)).collect();
    html! {
        div class="scroll" {
            table {
                tr {
                    th { "Run" }
                    @for field in &index.fields { th title=(field) { (FieldWords::of(field).with_unit()) } }
                    th { "Ended" } th { "Claimed" }
                    @for Drawn { words, unit, .. } in &listed { th class="n" { (words) @if !unit.is_empty() { " (" (unit) ")" } } }
                }
                @for run in index.runs.iter().take(MOST_ROWS) {
                    tr {
                        td {
                            @match &run.folder {
                                Some(folder) => a href=(format!("{folder}/")) { (run.row.run) },
                                None => (run.row.run),
                            }
                        }
                        @for value in &run.values { td { (value.trim_matches('"')) } }
                        td { (run.row.status) @if let Some(why) = &run.row.reason { ": " (why.lines().next().unwrap_or_default()) } }
                        td { (run.row.claimed.as_deref().unwrap_or("–")) }
                        @for Drawn { path, .. } in &listed {
                            td class="n" { (run.numbers.get(path).map_or("–".to_owned(), |x| significant(*x, 4))) }
                        }
                    }
                }
            }
        }
        @if index.runs.len() > MOST_ROWS {
            p class="hint" { (format!("The first {MOST_ROWS} of {} runs; `runs.parquet` has all.", index.runs.len())) }
        }
        p class="hint" {
            "Levels of a family are those of its first harmonic above the background of the envelope \
             spectrum, whether it is claimed or not. A number of the run opens its folder."
        }
    }
}

#[cfg(test)]
mod tests {
    use stribeck_analysis::runs::RunRow;

    use super::*;

    pub(super) fn run(number: usize, value: &str, rms_g: f64) -> OneOfMany {
        OneOfMany {
            row: RunRow {
                run: number,
                variant: number,
                start: 1,
                split: "train".to_owned(),
                status: "complete".to_owned(),
                reason: None,
                warnings: None,
                claimed: Some("none".to_owned()),
                n_samples: None,
                truth: None,
            },
            values: vec![value.to_owned()],
            numbers: BTreeMap::from([("levels.record.rms_g".to_owned(), rms_g)]),
            scene: None,
            program: None,
            folder: None,
        }
    }

    pub(super) fn index(runs: Vec<OneOfMany>) -> CampaignIndex {
        let (name, fields) = ("x".into(), vec!["operation.load_n".into()]);
        let bearing = Some("a 6205".into());
        CampaignIndex { name, bearing, fields, runs, notes: Vec::new(), files: Vec::new() }
    }

    #[test]
    fn by_hand_the_line_goes_through_the_means_of_each_place() {
        let index = index(vec![run(1, "100", 1.0), run(2, "200", 4.0), run(3, "100", 3.0)]);
        let figure = figure(&index, 0, &Abscissa::of(&index, 0), &drawn()[0]).expect("a number");
        assert_eq!((figure.series[0].y.as_slice(), figure.series[1].y.len()), (&[2.0, 4.0][..], 3));
        // Charts join points of one abscissa, so these are drawn as dots.
        let x: Vec<f64> = (0..3).map(|n| figure.series[1].position(n)).collect();
        assert!(x[0] < x[1] && x[1] - x[0] < 2.0 && x[2] == 200.0, "{x:?}");
        assert!(index.runs.iter().all(|run| !run.numbers.contains_key("levels.record.kurtosis")));
        assert!(super::figure(&index, 0, &Abscissa::of(&index, 0), &drawn()[3]).is_none());
    }

    #[test]
    fn by_hand_words_stand_side_by_side_and_decades_over_their_logarithm() {
        let of_words = index(vec![run(1, "outer", 1.0), run(2, "inner", 2.0), run(3, "outer", 1.5)]);
        let abscissa = Abscissa::of(&of_words, 0);
        assert_eq!(abscissa.places, [1.0, 2.0, 1.0]);
        assert_eq!(
            (abscissa.axis.names, abscissa.words),
            (vec!["outer".to_owned(), "inner".to_owned()], String::new())
        );
        let long = ["a name that is long", "another one that is as long"];
        let of_long = index(vec![run(1, long[0], 1.0), run(2, long[1], 2.0)]);
        let abscissa = Abscissa::of(&of_long, 0);
        assert!(abscissa.axis.names.is_empty());
        assert_eq!(abscissa.words, " 1 is a name that is long, 2 is another one that is as long.");
        let of_decades = Abscissa::of(&index(vec![run(1, "1", 1.0), run(2, "100", 2.0)]), 0);
        assert_eq!(of_decades.places, [0.0, 2.0]);
    }
}
