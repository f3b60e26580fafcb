//! Names and units of columns from the lines above them.

use super::dialect::Dialect;
use crate::units::{is_unit, seconds};

/// Names and units of `columns` columns; both may be empty texts.
pub(crate) fn names(head: &[String], dialect: Dialect, columns: usize) -> (Vec<String>, Vec<String>) {
    let fitting: Vec<Vec<String>> = head
        .iter()
        .map(|line| line.trim_start_matches(|c: char| c.is_whitespace() || matches!(c, '#' | '%')))
        .filter(|line| !dialect.is_empty(line))
        .filter_map(|line| words(line, dialect, columns))
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
fn words(line: &str, dialect: Dialect, columns: usize) -> Option<Vec<String>> {
    let split = |separator: char| {
        let mut all: Vec<String> =
            Dialect { separator, ..dialect }.split(line).into_iter().map(str::to_owned).collect();
        // A separator at the end of a line makes no column, and one that is missing there loses none.
        while all.len() > columns && all.last().is_some_and(String::is_empty) {
            all.pop();
        }
        if all.len() + 1 == columns && columns > 2 {
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
