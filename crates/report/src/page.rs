//! What all pages have: their head, sections, sentences and the files of their figures.

use std::fs;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::thread;

use maud::{Markup, PreEscaped, html};
use serde::Serialize;

use crate::Error;
use crate::figures::Item;
use crate::plot;

/// Writes every figure, on all cores.
pub(crate) fn write_figures(figures: &[&Item], folder: &Path) -> Result<(), Error> {
    fs::create_dir_all(folder).map_err(|why| Error::Write { path: folder.to_owned(), why })?;
    let figures = Mutex::new(figures.iter());
    let next = || figures.lock().unwrap_or_else(PoisonError::into_inner).next();
    let write_some = || std::iter::from_fn(next).try_for_each(|figure| write_figure(figure, folder));
    let cores = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        let others: Vec<_> = (1..cores).map(|_| scope.spawn(write_some)).collect();
        let mine = write_some();
        let of_others = others.into_iter().map(|other| other.join().unwrap_or_else(|why| resume_unwind(why)));
        of_others.fold(mine, Result::and)
    })
}

/// A figure as SVG and as PNG; one that moves as GIF too.
fn write_figure(figure: &Item, folder: &Path) -> Result<(), Error> {
    let write = |form: &str, bytes: &[u8]| {
        let path = folder.join(format!("{}.{form}", figure.id()));
        fs::write(&path, bytes).map_err(|why| Error::Write { path, why })
    };
    let svg = figure.to_svg()?;
    write("svg", svg.as_bytes())?;
    write("png", &plot::png(figure.id(), &svg)?)?;
    figure.animation().map_or(Ok(()), |gif| write("gif", gif))
}

/// `summary.json` with a final line end.
pub(crate) fn json(summary: &impl Serialize) -> Result<String, Error> {
    let text = serde_json::to_string_pretty(summary).map_err(Error::Summary)?;
    Ok(text + "\n")
}

/// What a page needs before its first word.
pub(crate) fn head(name: &str) -> Markup {
    html! {
        head {
            meta charset="utf-8";
            meta name="viewport" content="width=device-width, initial-scale=1";
            // An empty picture keeps browsers from asking a server for an icon.
            link rel="icon" href="data:,";
            title { (name) " – Stribeck" }
            (plot::script())
            style { (PreEscaped(include_str!("../assets/report.css"))) }
        }
    }
}

/// A heading, what stands before the figures, the figures (`otherwise` when there are none) and what stands
/// after them.
pub(crate) fn section(
    id: &str,
    name: &str,
    before: Markup,
    items: &[Item],
    after: Markup,
    otherwise: &str,
) -> Result<Markup, Error> {
    let drawn = items.iter().map(Item::to_html).collect::<Result<Vec<_>, _>>()?;
    Ok(html! {
        h2 id=(id) { (name) }
        (before)
        @if drawn.is_empty() { p { (otherwise) } }
        @for figure in drawn { (figure) }
        (after)
    })
}

/// A note with a capital and a full stop.
pub(crate) fn sentence(note: &str) -> String {
    let mut letters = note.chars();
    let first: String = letters.next().map(|c| c.to_uppercase().collect()).unwrap_or_default();
    let stop = if note.ends_with('.') { "" } else { "." };
    format!("{first}{}{stop}", letters.as_str())
}
