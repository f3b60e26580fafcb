//! Numbers of a study, one a row: table, variant, quantity and value, as `docs/results/STUDY.csv` keeps them.

use std::path::Path;

use anyhow::{Context, Result, ensure};

const HEAD: &str = "table,variant,quantity,value";

/// All numbers and words that a study measured, in the order of the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rows(Vec<[String; 4]>);

impl Rows {
    /// Adds a number; none is an empty field.
    pub fn value(&mut self, table: &str, variant: &str, quantity: &str, value: impl Into<Option<f64>>) {
        self.word(table, variant, quantity, &value.into().map_or(String::new(), |v| v.to_string()));
    }

    /// Adds a word.
    pub fn word(&mut self, table: &str, variant: &str, quantity: &str, word: &str) {
        self.0.push([table, variant, quantity, &word.replace('\n', " ")].map(str::to_owned));
    }

    /// Adds several numbers of one variant.
    pub fn values<V: Into<Option<f64>>>(
        &mut self,
        table: &str,
        variant: &str,
        values: impl IntoIterator<Item = (impl AsRef<str>, V)>,
    ) {
        values.into_iter().for_each(|(quantity, value)| self.value(table, variant, quantity.as_ref(), value));
    }

    /// Takes the rows of these tables out.
    pub(crate) fn clear(&mut self, tables: &[&str]) {
        self.0.retain(|[table, ..]| !tables.contains(&table.as_str()));
    }

    /// The value as it is written; `None` where there is no such row.
    pub(crate) fn get(&self, table: &str, variant: &str, quantity: &str) -> Option<&str> {
        let found = self.0.iter().find(|[t, v, q, _]| t == table && v == variant && q == quantity);
        found.map(|row| row[3].as_str())
    }

    /// The number; `None` where there is none.
    pub(crate) fn number(&self, table: &str, variant: &str, quantity: &str) -> Option<f64> {
        self.get(table, variant, quantity)?.parse().ok()
    }

    pub(crate) fn variants(&self, table: &str) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for [of, variant, ..] in &self.0 {
            if of == table && !names.contains(variant) {
                names.push(variant.clone());
            }
        }
        names
    }

    pub(crate) fn quantities(&self, table: &str, variant: &str) -> Vec<String> {
        let of = self.0.iter().filter(|[t, v, ..]| t == table && v == variant);
        of.map(|row| row[2].clone()).collect()
    }

    /// The numbers of one quantity over the variants of a table that have it.
    pub(crate) fn column(&self, table: &str, quantity: &str) -> Vec<(&str, f64)> {
        let of = self.0.iter().filter(|[t, _, q, _]| t == table && q == quantity);
        of.filter_map(|[_, variant, _, value]| Some((variant.as_str(), value.parse().ok()?))).collect()
    }

    /// Reads the file of a study.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let text =
            std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        let mut lines = text.lines();
        ensure!(lines.next() == Some(HEAD), "{}: its first line is not `{HEAD}`", path.display());
        let rows = lines.map(|line| {
            fields(line).try_into().map_err(|_| anyhow::anyhow!("{}: four fields: {line}", path.display()))
        });
        Ok(Self(rows.collect::<Result<_>>()?))
    }

    pub(crate) fn to_csv(&self) -> String {
        let rows = self.0.iter().map(|row| row.each_ref().map(|field| quoted(field)).join(","));
        std::iter::once(HEAD.to_owned()).chain(rows).map(|line| line + "\n").collect()
    }
}

/// Whether a name is the pattern, in which one `*` stands for any text.
pub(crate) fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        Some((start, end)) => name.starts_with(start) && name.ends_with(end),
        None => name == pattern,
    }
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// The fields of a line, of which some are quoted.
fn fields(line: &str) -> Vec<String> {
    let (mut all, mut inside) = (vec![String::new()], false);
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        let last = all.len() - 1;
        match c {
            '"' if inside && chars.next_if_eq(&'"').is_some() => all[last].push('"'),
            '"' => inside = !inside,
            ',' if !inside => all.push(String::new()),
            c => all[last].push(c),
        }
    }
    all
}

/// The middle value, the upper one of an even number.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roundtrip_of_rows_with_commas_and_quotes() {
        let mut rows = Rows::default();
        rows.value("a", "b, c", "says \"d\"", 0.1 + 0.2);
        rows.value("a", "b, c", "nothing", None);
        rows.word("a", "e", "word", "two\nlines");
        let path = std::env::temp_dir().join(format!("stribeck-rows-{}.csv", std::process::id()));
        std::fs::write(&path, rows.to_csv()).expect("a temporary file");
        let read = Rows::read(&path).expect("what was written");
        std::fs::remove_file(&path).ok();
        assert_eq!(read, rows);
        assert_eq!(read.number("a", "b, c", "says \"d\""), Some(0.1 + 0.2));
        assert_eq!(
            (read.number("a", "b, c", "nothing"), read.get("a", "e", "word")),
            (None, Some("two lines"))
        );
        assert_eq!(read.variants("a"), ["b, c", "e"]);
    }
}
