//! Names and units of columns from the lines above them.

use super::FirstRows;
use super::dialect::Dialect;
use crate::units::{self, is_unit, seconds};

/// Names and units of `columns` columns; both may be empty texts.
pub(super) fn names(
    head: &[String],
    dialect: Dialect,
    columns: usize,
    rows: &FirstRows,
) -> (Vec<String>, Vec<String>) {
    let fitting: Vec<Vec<String>> = head
        .iter()
        .map(|line| line.trim_start_matches(|c: char| c.is_whitespace() || matches!(c, '#' | '%')))
        .filter(|line| !dialect.is_empty(line))
        .filter_map(|line| words(line, dialect, columns, rows))
        .collect();
    // The row of units, where there is one, stands below that of the names.
    let units = (1..fitting.len()).rev().take(4).find(|n| is_row_of_units(&fitting[*n]));
    let (names, units) = match (units, fitting.last()) {
        (Some(n), _) => (fitting[n - 1].clone(), fitting[n].clone()),
        (None, Some(last)) => (last.clone(), Vec::new()),
        (None, None) => (Vec::new(), Vec::new()),
    };
    let name = |n: usize| names.get(n).filter(|name| !name.is_empty()).cloned();
    ((0..columns).map(|n| name(n).unwrap_or_else(|| format!("column {}", n + 1))).collect(), units)
}

/// The words of a line, where they are as many as there are columns; `# t_ms acc_g` may be split otherwise
/// than its rows.
fn words(line: &str, dialect: Dialect, columns: usize, rows: &FirstRows) -> Option<Vec<String>> {
    let split = |separator: char| {
        let mut all: Vec<String> =
            Dialect { separator, ..dialect }.split(line).into_iter().map(str::to_owned).collect();
        // A separator at the end of a line makes no column, and one that is missing there loses none.
        while all.len() > columns && all.last().is_some_and(String::is_empty) {
            all.pop();
        }
        // LabVIEW heads a column that rows without a comment leave out.
        if all.len() == columns + 1 && all.last().is_some_and(|word| word.eq_ignore_ascii_case("comment")) {
            all.pop();
        }
        if all.len() + 1 == columns && rows.leave_the_first(&all) {
            all.insert(0, String::new());
        } else if all.len() + 1 == columns && columns > 2 {
            all.push(String::new());
        }
        (all.len() == columns).then_some(all)
    };
    let others = [';', '\t', '|', ',', ' '].into_iter().filter(|c| *c != dialect.separator);
    if columns == 1 {
        return Some(vec![line.trim().trim_matches('"').to_owned()]);
    }
    split(dialect.separator).or_else(|| others.into_iter().find_map(split))
}

/// A row is one of units when a field is a unit of time, or most are units of any sort.
fn is_row_of_units(row: &[String]) -> bool {
    let some: Vec<&String> = row.iter().filter(|field| !field.is_empty()).collect();
    let known = some.iter().filter(|field| is_unit(field)).count();
    // `t` and `time` are names.
    let time = some.iter().any(|field| seconds(field).is_some());
    !some.is_empty() && (2 * known > some.len() || known > 0 && time)
}

/// The sample rate [Hz] that lines above the table say, with notes on those that should and do not, and on those that
/// contradict each other.
pub(crate) fn rate_hz(
    head: &[String],
    dialect: Dialect,
    commas: bool,
    notes: &mut Vec<String>,
) -> Option<f64> {
    let mut rates = units::Rates::default();
    for line in head {
        let Some((whole, key, rest)) = key_of(line) else { continue };
        match rate_of(line, dialect, commas) {
            Some(hz) => rates.said.push((whole.trim_end().to_owned(), hz)),
            None if whole[key.len()..].starts_with(',') => {}
            // What the table makes ambiguous says nothing.
            None => rates.odd.extend(units::odd_words(key, rest.trim_start_matches([':', '=']))),
        }
    }
    rates.agreed(notes)
}

/// A line without the marks of a comment, and its parts before and behind the first separator.
fn key_of(line: &str) -> Option<(&str, &str, &str)> {
    let line = line.trim_start_matches(|c: char| c.is_whitespace() || "#%\"".contains(c));
    let (key, rest) = line.split_once([':', '=', '\t', ';', ','])?;
    Some((line, key, rest))
}

/// The sample rate [Hz] that a line says: `fs = 12800`, `Sample rate: 12.8 kHz`, `Delta_X` and the step behind a
/// separator. `commas` says that the table has decimal commas.
pub(crate) fn rate_of(line: &str, dialect: Dialect, commas: bool) -> Option<f64> {
    let (line, key, rest) = key_of(line)?;
    let rest = rest.trim_matches(|c: char| c.is_whitespace() || "\";,:=".contains(c));
    let end = rest.find(|c: char| !(c.is_ascii_digit() || ".,+-eE".contains(c)));
    let (number, behind) = rest.split_at(end.unwrap_or(rest.len()));
    let number = number.trim_end_matches([',', '.']);
    // The head may have another decimal sign than the table.
    let plain = |text: &str| text.parse().ok();
    let unit = behind.split_whitespace().next().filter(|word| is_unit(word) || units::hertz(word).is_some());
    // `12,800 Hz` are thousands. Where the table has decimal commas it may be either, as may `12.800`.
    let groups = |sign: char| {
        let (whole, rest) = number.split_once(sign)?;
        let digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
        let fits = (1..=3).contains(&whole.len()) && !whole.starts_with('0') && rest.len() == 3;
        (fits && digits(whole) && digits(rest)).then(|| format!("{whole}{rest}"))
    };
    // Behind a comma several fields may follow.
    let of_key = || key.rsplit([' ', '[', '(', '_']).next().filter(|_| !line[key.len()..].starts_with(','));
    let in_hz = unit.or_else(of_key).and_then(units::hertz) == Some(1.0);
    if in_hz && commas && (groups(',').is_some() || groups('.').is_some()) {
        return None;
    }
    let thousands = groups(',').filter(|_| in_hz);
    let number = thousands.as_deref().unwrap_or(number);
    let value = plain(number).or_else(|| dialect.number(number));
    let value = value.or_else(|| plain(&number.replacen(',', ".", 1)));
    // Fields of the table may stand behind it.
    let field = || number.split_once(dialect.separator).filter(|_| dialect.separator == ',');
    let value = value.or_else(|| plain(field()?.0))?;
    // A word that is no unit may be one that is not known; a sentence goes on behind a comma or a point.
    let alone = behind.trim().is_empty() || unit.is_some() || behind.starts_with(['\t', ';', ',']);
    // `25.6k` are thousands, no kelvins.
    let (value, unit) = if unit == Some("k") { (1e3 * value, None) } else { (value, unit) };
    alone.then(|| units::rate_hz(key, unit, value)).flatten()
}
