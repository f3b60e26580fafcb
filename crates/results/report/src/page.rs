//! Common parts of all pages: head, sections, tables, sentences and the files of their figures.

use std::fs;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::thread;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde::Serialize;

use crate::element_words::ElementWords;
use crate::{Error, plot};

mod item;
mod table;

pub(crate) use item::{HALF_PAGE_PX, Item, charts, drawn};
pub(crate) use table::{cell, folded, grouped, minus, pairs, said_once, table, wide_table};

/// Writes every figure, on all cores.
pub(crate) fn write_figures(figures: &[&Item], folder: &Path, words: ElementWords) -> Result<(), Error> {
    fs::create_dir_all(folder).map_err(|why| Error::Write { path: folder.to_owned(), why })?;
    let figures = Mutex::new(figures.iter());
    let next = || figures.lock().unwrap_or_else(PoisonError::into_inner).next();
    let write_some = || std::iter::from_fn(next).try_for_each(|figure| write_figure(figure, folder, words));
    let cores = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        let others: Vec<_> = (1..cores).map(|_| scope.spawn(write_some)).collect();
        let mine = write_some();
        let of_others = others.into_iter().map(|other| other.join().unwrap_or_else(|why| resume_unwind(why)));
        of_others.fold(mine, Result::and)
    })
}

/// A figure as SVG.
fn write_figure(figure: &Item, folder: &Path, words: ElementWords) -> Result<(), Error> {
    let path = folder.join(format!("{}.svg", figure.id()));
    let svg = words.markup(figure.to_svg()?);
    fs::write(&path, svg).map_err(|why| Error::Write { path, why })
}

/// `summary.json` with a final line end.
pub(crate) fn json(summary: &impl Serialize) -> Result<String, Error> {
    let text = serde_json::to_string_pretty(summary).map_err(Error::Summary)?;
    Ok(text + "\n")
}

/// How many of many are complete, how many others ended how, and what the page makes of them.
pub(crate) fn banner<'a>(
    (complete, all): (usize, usize),
    noun: &str,
    others: impl IntoIterator<Item = (&'a str, usize)>,
    rest: &str,
) -> Markup {
    let others = others.into_iter().filter(|(_, count)| *count > 0);
    let others: Vec<String> = others.map(|(how, count)| format!("{count} {how}")).collect();
    html! {
        div class="banner" role="alert" {
            strong { (complete) " of " (all) " " (noun) " are complete" } ": " (others.join(", ")) ". " (rest)
        }
    }
}

/// The defect frequencies, where a page names one.
const FREQUENCIES: &str = "BPFO and BPFI: ball pass frequencies of the outer and of the inner raceway, at which rolling \
    elements pass a spot of it. BSF: ball spin frequency, at which an element turns; a spot on it strikes twice a turn. \
    FTF: fundamental train frequency, that of the cage.";

/// A page: title, styles, scripts and what it says.
pub(crate) fn document(name: &str, body: Markup) -> Markup {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                // An empty picture keeps browsers from asking a server for an icon.
                link rel="icon" href="data:,";
                title { (name) " – Stribeck" }
                (plot::script())
                style { (PreEscaped(include_str!("../assets/report.css"))) }
            }
            body {
                (body)
                @if ["BPFO", "BPFI", "BSF", "FTF"].iter().any(|name| body.0.contains(name)) {
                    footer class="hint" { (FREQUENCIES) }
                }
            }
        }
    }
}

/// A section of a page: text, figures, text. Without a heading it is a part of what stands before it.
#[derive(Debug, Default)]
pub(crate) struct Section {
    id: &'static str,
    heading: &'static str,
    /// Name in the contents; empty where they leave it out.
    link: &'static str,
    /// The question that it answers, behind which it is folded up; empty where it is open.
    question: &'static str,
    before: Markup,
    pub(crate) figures: Vec<Item>,
    /// Text where there are no figures.
    otherwise: &'static str,
    after: Markup,
}

impl Section {
    /// A section with its anchor and its heading, which the contents show as well.
    pub(crate) fn new(id: &'static str, heading: &'static str) -> Self {
        Self { id, heading, link: heading, ..Self::default() }
    }

    /// Text without a heading.
    pub(crate) fn text(after: Markup) -> Self {
        Self { after, ..Self::default() }
    }

    /// With a shorter name in the contents.
    pub(crate) fn linked(self, link: &'static str) -> Self {
        Self { link, ..self }
    }

    /// Folded up behind the question that it answers.
    pub(crate) fn folded(self, question: &'static str) -> Self {
        Self { question, ..self }
    }

    /// With text in front of the figures.
    pub(crate) fn before(self, before: Markup) -> Self {
        Self { before, ..self }
    }

    /// With figures, or the text `otherwise`.
    pub(crate) fn figures(self, figures: impl IntoIterator<Item = Item>, otherwise: &'static str) -> Self {
        Self { figures: figures.into_iter().collect(), otherwise, ..self }
    }

    /// With text behind the figures.
    pub(crate) fn after(self, after: Markup) -> Self {
        Self { after, ..self }
    }

    pub(crate) fn markup(&self) -> Result<Markup, Error> {
        let drawn = figures(&self.figures)?;
        let heading = html! { @if !self.id.is_empty() { h2 id=(self.id) { (self.heading) } } };
        let inside = html! {
            (self.before)
            @if self.figures.is_empty() && !self.otherwise.is_empty() { p { (self.otherwise) } }
            (drawn)
            (self.after)
        };
        Ok(html! {
            @if self.question.is_empty() {
                (heading) (inside)
            } @else {
                details class="section" { summary { (heading) (self.question) } (inside) }
            }
        })
    }
}

/// Links to the summary and to all sections.
pub(crate) fn contents(sections: &[Section]) -> Markup {
    let linked = sections.iter().filter(|section| !section.link.is_empty()).map(|s| (s.id, s.link));
    html! {
        nav aria-label="Contents" {
            @for (id, name) in [("summary", "Summary")].into_iter().chain(linked) { a href={ "#" (id) } { (name) } }
        }
    }
}

/// Figures one after the other; neighbours of one group share a frame with tabs, and sentences that the notes
/// of all of them have stand once below it.
pub(crate) fn figures(items: &[Item]) -> Result<Markup, Error> {
    let groups =
        items.chunk_by(|a, b| a.tab().is_some() && a.tab().map(|t| t.group) == b.tab().map(|t| t.group));
    let drawn = groups.map(|group| match group {
        [alone] => alone.to_html(),
        several => tabs(several),
    });
    let drawn = drawn.collect::<Result<Vec<_>, _>>()?;
    Ok(html! { @for group in drawn { (group) } })
}

fn tabs(items: &[Item]) -> Result<Markup, Error> {
    let notes: Vec<Vec<&str>> = items.iter().map(|item| sentences(item.note())).collect();
    let of_all = |sentence: &&str| notes.iter().all(|note| note.contains(sentence));
    let shared: Vec<&str> = notes[0].iter().copied().filter(|sentence| of_all(sentence)).collect();
    let own = |note: &[&str]| {
        let left: Vec<&str> = note.iter().copied().filter(|sentence| !shared.contains(sentence)).collect();
        left.join(" ")
    };
    let drawn = items.iter().zip(&notes).map(|(item, note)| item.with_note(own(note)));
    let drawn = drawn.collect::<Result<Vec<_>, _>>()?;
    Ok(html! {
        div class="tabs" {
            div class="tab-row" role="tablist" {
                @for (n, item) in items.iter().enumerate() {
                    button type="button" role="tab" aria-selected=(if n == 0 { "true" } else { "false" }) {
                        (item.tab().map_or("", |tab| tab.label.as_str()))
                    }
                }
            }
            @for (n, figure) in drawn.iter().enumerate() {
                div class=(if n == 0 { "panel on" } else { "panel" }) role="tabpanel" { (figure) }
            }
            @if !shared.is_empty() { p class="note" { (shared.join(" ")) } }
        }
    })
}

/// A word of the trade with its meaning behind it.
pub(crate) fn term(word: &str, meaning: &str) -> Markup {
    html! { abbr title=(meaning) tabindex="0" { (word) } }
}

/// A note sentence by sentence, each with its full stop.
fn sentences(note: &str) -> Vec<&str> {
    let mut rest = note;
    let mut all = Vec::new();
    while let Some(at) = rest.find(". ") {
        all.push(&rest[..=at]);
        rest = &rest[at + 2..];
    }
    all.push(rest);
    all.retain(|sentence| !sentence.is_empty());
    all
}

/// Words, with text between grave accents set as code.
pub(crate) fn with_code(words: &str) -> Markup {
    let parts = words.split('`').enumerate();
    html! { @for (n, part) in parts { @if n % 2 == 1 { code { (part) } } @else { (part) } } }
}

/// A stable name as words.
pub(crate) fn spoken(name: &str) -> String {
    name.replace('_', " ")
}

/// A note with a capital and a full stop.
pub(crate) fn sentence(note: &str) -> String {
    capital(note) + if note.ends_with('.') { "" } else { "." }
}

pub(crate) fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first: String = letters.next().map(|c| c.to_uppercase().collect()).unwrap_or_default();
    first + letters.as_str()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_a_note_falls_into_sentences_and_keeps_its_decimals() {
        assert_eq!(sentences("Up to 33.3 Hz. Red: the defect."), ["Up to 33.3 Hz.", "Red: the defect."]);
        assert!(sentences("").is_empty());
    }
}
