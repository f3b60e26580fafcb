//! Pages of studies: a template in Markdown into which the numbers of the study are put.
//!
//! `{table > variant > quantity : 2}` is a number with two decimals. A line that begins with `{each table}`
//! is repeated for every variant of the table; `{@}` is then the variant's name and `{quantity : 2}` a number
//! of it. `{each table : a; b = shown as b; c*}` takes some of them, `{each table where quantity = word}`
//! those that have the word, and `!=` the others. `{count table where …}` is how many there are. Behind the
//! colon stands the number of decimals, `f3` for three figures, `%1` for per cent, `e2` for an exponent,
//! `1e3 * 2` for thousandfold; without one the value is shown as it is written.

use std::fmt::Write;

use crate::rows::{Rows, matches};

/// Fills in a template; the second value lists what it asks for and the rows do not have.
pub(crate) fn render(template: &str, rows: &Rows) -> (String, Vec<String>) {
    let mut missing = Vec::new();
    let mut page = String::new();
    for line in template.lines() {
        let each = line.strip_prefix("{each ").and_then(|rest| rest.split_once('}'));
        let Some((clause, row)) = each else {
            page += &filled(line, None, rows, &mut missing);
            page.push('\n');
            continue;
        };
        let (table, chosen) = choose(clause, rows);
        if chosen.is_empty() && !clause.contains(" where ") {
            missing.push(clause.to_owned());
        }
        for (variant, shown) in chosen {
            page += &filled(row.trim_start(), Some([table, &variant, &shown]), rows, &mut missing);
            page.push('\n');
        }
    }
    (page, missing)
}

/// A line with its braces filled in, in a row of a table: its name, the variant and the name that is shown.
fn filled(line: &str, of: Option<[&str; 3]>, rows: &Rows, missing: &mut Vec<String>) -> String {
    let mut text = String::new();
    let mut rest = line;
    while let Some((before, (inside, after))) =
        rest.split_once('{').and_then(|(before, rest)| Some((before, rest.split_once('}')?)))
    {
        text += before;
        rest = after;
        let (path, form) = inside.split_once(" : ").unwrap_or((inside, ""));
        let path: Vec<&str> = path.split(" > ").map(str::trim).collect();
        let value = match (path.as_slice(), of) {
            (["@"], Some([_, _, shown])) => Some(shown.to_owned()),
            ([clause], _) if clause.starts_with("count ") => {
                Some(choose(&clause["count ".len()..], rows).1.len().to_string())
            }
            ([table, variant, quantity], _) => rows.get(table, variant, quantity).map(|v| shown(v, form)),
            ([table, quantity], Some([_, variant, _])) => {
                rows.get(table, variant, quantity).map(|v| shown(v, form))
            }
            ([quantity], Some([table, variant, _])) => {
                rows.get(table, variant, quantity).map(|v| shown(v, form))
            }
            _ => None,
        };
        text += value.as_deref().unwrap_or("–");
        if value.is_none() {
            missing.push(
                of.map_or(inside.to_owned(), |[table, variant, _]| format!("{table} > {variant} > {inside}")),
            );
        }
    }
    text + rest
}

/// The table of a clause, and its variants with the names that are shown.
fn choose<'a>(clause: &'a str, rows: &Rows) -> (&'a str, Vec<(String, String)>) {
    if let Some((table, condition)) = clause.split_once(" where ") {
        let (quantity, word, wanted) = match condition.split_once(" != ") {
            Some((quantity, word)) => (quantity, word, false),
            None => condition.split_once(" = ").map_or((condition, "", true), |(q, w)| (q, w, true)),
        };
        let mut all = rows.variants(table);
        all.retain(|variant| (rows.get(table, variant, quantity) == Some(word)) == wanted);
        return (table, all.into_iter().map(|name| (name.clone(), name)).collect());
    }
    let (table, list) = clause.split_once(" : ").unwrap_or((clause, "*"));
    let all = rows.variants(table);
    let mut chosen = Vec::new();
    for item in list.split("; ").map(str::trim) {
        let (name, words) = item.split_once(" = ").unwrap_or((item, ""));
        let of = all.iter().filter(|variant| matches(name, variant));
        chosen.extend(of.map(|v| (v.clone(), if words.is_empty() { v.clone() } else { words.to_owned() })));
    }
    (table, chosen)
}

/// A value in the form that a template asks for.
fn shown(value: &str, form: &str) -> String {
    if value.is_empty() {
        return "–".to_owned();
    }
    let (factor, form) =
        form.split_once(" * ").map_or((1.0, form), |(f, form)| (f.parse().unwrap_or(1.0), form));
    let Ok(number) = value.parse::<f64>() else { return value.to_owned() };
    let number = factor * number;
    let digits = |from: usize| form.get(from..).and_then(|digits| digits.parse::<usize>().ok()).unwrap_or(0);
    match form.chars().next() {
        None => value.replace('-', "−"),
        Some('%') => decimals(100.0 * number, digits(1)),
        Some('e') => format!("{number:.*e}", digits(1)).replace('-', "−"),
        Some('f') => {
            let before = if number == 0.0 { 1 } else { number.abs().log10().floor() as i64 + 1 };
            decimals(number, (digits(1) as i64 - before).clamp(0, 12) as usize)
        }
        Some(_) => decimals(number, digits(0)),
    }
}

/// A number with a real minus sign.
pub(crate) fn decimals(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "∞".to_owned();
    }
    let mut text = String::new();
    let _ = write!(text, "{value:.decimals$}");
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_numbers_rows_and_counts() {
        let mut rows = Rows::default();
        rows.values("t", "a", [("x", 1.2345), ("y", -0.5)]);
        rows.values("t", "b2", [("x", 4e-5), ("y", 2.0)]);
        rows.word("t", "a", "ended", "right");
        rows.word("t", "b2", "ended", "warned");
        let filled = |template: &str| render(template, &rows);
        assert_eq!(filled("{t > a > x : 2} g, {t > a > y : %1} %").0, "1.23 g, −50.0 %\n");
        assert_eq!(filled("{each t}| {@} | {x : f2} |").0, "| a | 1.2 |\n| b2 | 0.000040 |\n");
        assert_eq!(filled("{each t : b* = second; a}{@}: {y : 1e3 * 0}").0, "second: 2000\na: −500\n");
        assert_eq!(filled("{each t where ended != right}{@} {x : e1}").0, "b2 4.0e−5\n");
        assert_eq!(filled("{count t where ended = right} of {count t}"), ("1 of 2\n".into(), Vec::new()));
        let (page, missing) = filled("{each t}{z}");
        assert_eq!(
            (page.as_str(), missing),
            ("–\n–\n", vec!["t > a > z".to_owned(), "t > b2 > z".to_owned()])
        );
    }

    /// Words of a page are edited in its template, numbers in its table: neither by hand in the page.
    #[test]
    fn golden_every_page_is_its_template_with_the_numbers_kept() {
        let results = crate::root().join("docs/results");
        let mut pages = 0;
        for entry in std::fs::read_dir(crate::package().join("pages")).expect("templates") {
            let path = entry.expect("a template").path();
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let (page, missing) = crate::page_of(&name).expect("a page");
            assert_eq!(missing, Vec::<String>::new(), "{name}: numbers that its table does not have");
            let kept = std::fs::read_to_string(results.join(format!("{name}.md"))).expect("the page");
            let kept = &kept[crate::mark_of(&kept).len()..];
            assert!(page == kept, "{name}.md differs: `cargo xtask study {name} --page-only` writes it anew");
            pages += 1;
        }
        assert!(pages >= 10, "{pages} pages");
    }
}
