//! Habits from other formats: JSON, YAML and TOML instead of RON, and the decimal comma.

use std::ops::Range;

/// A recognised habit: its error, and the spelling in RON.
pub(crate) struct Habit {
    pub(crate) range: Range<usize>,
    pub(crate) message: String,
    pub(crate) suggestion: String,
}

/// The format of a text that is not RON, recognised by its first line.
pub(crate) fn other_format(text: &str, noun: &str) -> Option<Habit> {
    let (at, line) = first_line(text)?;
    let range = at..at + line.len();
    let habit = |format: &str, how: String| {
        let message = format!("this is {format}; {noun} is written in RON");
        Some(Habit { range: range.clone(), message, suggestion: how })
    };
    if line.starts_with('{') {
        let all = "`(name: \"x\", bearing: (rollers: 24))`: round brackets, and names without quotes";
        return habit("JSON", all.to_owned());
    }
    if line.starts_with('#') {
        let suggestion = "`//` begins a comment".to_owned();
        return Some(Habit { range, message: "`#` is not a comment in RON".to_owned(), suggestion });
    }
    let section = line.strip_prefix('[').and_then(|rest| rest.split_once(']')).map(|(name, _)| name);
    if let Some(name) = section.filter(|name| is_name(name)) {
        return habit(
            "TOML",
            format!("`({name}: ( … ))`, and inside it `name: value,` instead of `name = value`"),
        );
    }
    if let Some((name, value)) = line.split_once('=').filter(|(name, _)| is_name(name.trim())) {
        let (name, value) = (name.trim(), one_value(value));
        return habit("TOML", format!("`({name}: {value}, …)`: everything in round brackets, with commas"));
    }
    let (name, value) = line.split_once(':').filter(|(name, _)| is_name(name.trim()))?;
    let value = one_value(value);
    let value = if value.is_empty() { "( … )".to_owned() } else { value };
    let how = format!("`({}: {value}, …)`: everything in round brackets, with commas", name.trim());
    habit("YAML, or RON without its outer brackets", how)
}

/// The first line with content, and where it begins. Comments of YAML and TOML are skipped where more
/// follows.
fn first_line(text: &str) -> Option<(usize, &str)> {
    let mut comment = None;
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        let start = at + line.len() - line.trim_start().len();
        at += line.len();
        let line = line.trim();
        if line.is_empty() || line.starts_with("//") || line == "---" || line.starts_with("#!") {
            continue;
        }
        if !line.starts_with('#') {
            // With RON below it only the comment is foreign.
            let ron_below = comment.filter(|_| line.starts_with('('));
            return Some(ron_below.unwrap_or((start, line)));
        }
        comment = comment.or(Some((start, line)));
    }
    comment
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || "_.".contains(c))
}

/// A value of YAML or TOML as RON writes it: words in quotes, no comment, no comma behind it.
fn one_value(text: &str) -> String {
    let value = text.split(" #").next().unwrap_or(text).trim().trim_end_matches(',');
    let word = value.starts_with(|c: char| c.is_alphabetic()) && value != "None";
    super::wording::shown(&if word { format!("{value:?}") } else { value.to_owned() })
}

/// The length of a number with a decimal comma at the beginning of `text`.
pub(crate) fn comma_number(text: &str) -> Option<usize> {
    let rest = text.trim_start_matches(['-', '+']);
    let whole = rest.find(|c: char| !(c.is_ascii_digit() || c == '.')).filter(|at| *at > 0)?;
    let fraction = rest[whole..].strip_prefix(',')?;
    let digits = fraction.find(|c: char| !c.is_ascii_digit()).unwrap_or(fraction.len());
    (digits > 0).then_some(text.len() - fraction.len() + digits)
}

/// Message on the number that [`with_point`] makes. Three digits behind the comma may be thousands.
pub(crate) fn comma_note(written: &str) -> &'static str {
    match written.rsplit_once(',') {
        Some((whole, thousands)) if thousands.len() == 3 && !whole.contains('.') => {
            "with a decimal point; thousands are written without a comma"
        }
        _ => "with a decimal point",
    }
}

/// `50,0` → `50.0`; `50.000,0` → `50000.0`.
pub(crate) fn with_point(written: &str) -> String {
    written.replace('.', "").replace(',', ".")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_formats_are_recognised_by_their_first_line() {
        for (text, words) in [
            ("{\"name\": \"x\"}", "JSON"),
            ("\n  {\n \"name\": 1}", "JSON"),
            ("name: x\nbearing:\n  rollers: 24\n", "YAML"),
            ("---\n# a comment\nbearing:\n  rollers: 24\n", "YAML"),
            ("name = \"x\"\n", "TOML"),
            ("# a comment\n[bearing]\nrollers = 24\n", "TOML"),
            ("# a comment\n(name: \"x\")", "`#` is not a comment"),
        ] {
            assert!(
                other_format(text, "a scene").is_some_and(|habit| habit.message.contains(words)),
                "{text}"
            );
        }
        for text in ["(name: 3)", "// x\n(", "", "#![enable(implicit_some)]\n(x", "hello", "\"x\""] {
            assert!(other_format(text, "a scene").is_none(), "{text}");
        }
    }

    #[test]
    fn by_hand_decimal_commas() {
        for (text, length) in
            [("50,0)", Some(4)), ("-3,25, x", Some(5)), ("50, 0", None), ("50.000,5", Some(8))]
        {
            assert_eq!(comma_number(text), length, "{text}");
        }
        assert_eq!(with_point("-50,25"), "-50.25");
        assert_eq!(with_point("50.000,5"), "50000.5");
    }
}
