//! Tables of a page, and their numbers.

use maud::{Markup, html};

/// A table from the cells of its head and of its rows.
pub(crate) fn table(class: Option<&str>, head: &Markup, rows: impl IntoIterator<Item = Markup>) -> Markup {
    html! {
        table class=[class] {
            thead { tr { (head) } }
            tbody { @for row in rows { tr { (row) } } }
        }
    }
}

/// The same, scrolled sideways where the page is narrow.
pub(crate) fn wide_table(
    class: Option<&str>,
    head: &Markup,
    rows: impl IntoIterator<Item = Markup>,
) -> Markup {
    html! { div class="scroll" { (table(class, head, rows)) } }
}

/// Quantities and their values.
pub(crate) fn pairs<'a>(rows: impl IntoIterator<Item = (&'a str, Option<String>)>) -> Markup {
    html! { table class="pairs" { tbody { @for (name, value) in rows { tr { td { (name) } (cell(value)) } } } } }
}

/// A table, folded up where its rows would fill the page.
pub(crate) fn folded(table: Markup, rows: usize, what: &str) -> Markup {
    const OPEN: usize = 24;
    if rows <= OPEN {
        return table;
    }
    html! { details { summary { (rows) " " (what) } (table) } }
}

/// A right-aligned cell; a dash when there is no value.
pub(crate) fn cell(value: Option<String>) -> Markup {
    match value {
        Some(text) => html! { td class="n" { (text) } },
        None => html! { td class="n absent" { "–" } },
    }
}

/// A number with a true minus sign.
pub(crate) fn minus(number: String) -> String {
    number.replace('-', "−")
}

/// With each item whether it is the first of its group.
pub(crate) fn grouped<T>(items: &[T], same: impl Fn(&T, &T) -> bool) -> impl Iterator<Item = (bool, &T)> {
    items.chunk_by(same).flat_map(|group| group.iter().enumerate().map(|(at, item)| (at == 0, item)))
}

/// A verdict of each item, beside all rows that share it.
pub(crate) fn said_once<T>(items: &[T], verdict: impl Fn(&T) -> &str) -> Vec<Markup> {
    let equal = |a: &T, b: &T| verdict(a) == verdict(b);
    let runs = items.chunk_by(equal).flat_map(|run| (0..run.len()).map(move |at| (at == 0).then_some(run)));
    runs.map(
        |run| html! { @if let Some(run) = run { td class="why" rowspan=(run.len()) { (verdict(&run[0])) } } },
    )
    .collect()
}
