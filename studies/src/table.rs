//! Output of a study: a table of its variants as Markdown and as comma-separated values, and pictures.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use stribeck_report::plot::Figure;

use crate::Finished;

/// One number a variant.
#[derive(Clone, Copy)]
pub(crate) struct Column {
    /// Heading, with its unit.
    pub(crate) name: &'static str,
    /// Decimals shown.
    pub(crate) decimals: usize,
    /// The number; `None` when the run does not yield it.
    pub(crate) of: fn(&Finished) -> Option<f64>,
}

/// The pages of a study: `docs/results/STUDY.md`, `.csv` and `STUDY-NAME.svg`.
pub(crate) struct Sheet {
    study: &'static str,
    folder: PathBuf,
    text: String,
    values: String,
}

impl Sheet {
    /// An empty sheet under a title, of the repository at `root`.
    pub(crate) fn new(root: &Path, study: &'static str, title: &str) -> Self {
        let text = format!(
            "# {title}\n\nWritten by `cargo xtask study {study}`, every number in \
             [{study}.csv]({study}.csv).\n"
        );
        Self {
            study,
            folder: root.join("docs/results"),
            text,
            values: "table,variant,quantity,value\n".to_owned(),
        }
    }

    /// Adds a paragraph.
    pub(crate) fn say(&mut self, text: &str) {
        let _ = write!(self.text, "\n{text}\n");
    }

    /// Adds a heading of the second level.
    pub(crate) fn heading(&mut self, text: &str) {
        let _ = write!(self.text, "\n## {text}\n");
    }

    /// Adds a table of runs, one row a variant. A variant without numbers has a note below.
    pub(crate) fn runs(&mut self, table: &str, rows: &[&Finished], columns: &[Column]) {
        let mut names = vec!["variant"];
        names.extend(columns.iter().map(|c| c.name));
        let cells = rows.iter().map(|run| {
            let mut cells = vec![run.variant.name.clone()];
            for column in columns {
                let value = (column.of)(run).filter(|v| v.is_finite());
                let exact = value.map_or(String::new(), |v| v.to_string());
                let _ = writeln!(self.values, "{table},{},{},{exact}", run.variant.name, quoted(column.name));
                cells.push(value.map_or("–".to_owned(), |v| number(v, column.decimals)));
            }
            cells
        });
        let cells: Vec<Vec<String>> = cells.collect();
        self.table(&names, &cells);
        for run in rows {
            if let Err(why) = &run.summary {
                self.say(&format!("`{}`: no numbers. {why}", run.variant.name));
            }
        }
    }

    /// Adds a number to the values alone; none is an empty field.
    pub(crate) fn value(&mut self, table: &str, variant: &str, quantity: &str, value: Option<f64>) {
        self.word(table, variant, quantity, &value.map_or(String::new(), |v| v.to_string()));
    }

    /// Adds a word to the values alone.
    pub(crate) fn word(&mut self, table: &str, variant: &str, quantity: &str, word: &str) {
        let [table, variant, quantity, word] = [table, variant, quantity, word].map(quoted);
        let _ = writeln!(self.values, "{table},{variant},{quantity},{word}");
    }

    /// Adds a table of words.
    pub(crate) fn table(&mut self, names: &[&str], rows: &[Vec<String>]) {
        let _ = write!(self.text, "\n| {} |\n|{}\n", names.join(" | "), "---|".repeat(names.len()));
        for row in rows {
            let _ = writeln!(self.text, "| {} |", row.join(" | "));
        }
    }

    /// Draws a picture beside the page and shows it in it.
    ///
    /// # Errors
    /// When it cannot be drawn or written.
    pub(crate) fn picture(&mut self, figure: &Figure) -> Result<()> {
        let name = format!("{}-{}.svg", self.study, figure.id);
        write(&self.folder.join(&name), &figure.to_svg()?)?;
        self.say(&format!("![{}]({name})", figure.title));
        if !figure.caption.is_empty() {
            self.say(&figure.caption);
        }
        Ok(())
    }

    /// Writes page and values; returns the path of the page.
    ///
    /// # Errors
    /// When they cannot be written.
    pub(crate) fn write(&self) -> Result<PathBuf> {
        let page = self.folder.join(format!("{}.md", self.study));
        write(&self.folder.join(format!("{}.csv", self.study)), &self.values)?;
        write(&page, &self.text)?;
        Ok(page)
    }
}

/// The number of a column for a run; not a number when it has none, a gap in a picture.
pub(crate) fn quantity_by(column: &Column, run: &Finished) -> f64 {
    (column.of)(run).unwrap_or(f64::NAN)
}

/// A number with a real minus sign.
pub(crate) fn number(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}").replace('-', "−")
}

/// A positive number with that many figures at least.
pub(crate) fn figures(value: f64, figures: usize) -> String {
    let before = value.log10().floor() as i64 + 1;
    number(value, (figures as i64 - before).max(0) as usize)
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

fn write(path: &Path, text: &str) -> Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
    }
    std::fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_a_sheet_has_a_row_a_variant_and_quotes_commas() {
        let mut sheet = Sheet::new(Path::new(""), "none", "Nothing");
        sheet.table(&["a", "b"], &[vec!["1".into(), "2".into()]]);
        assert!(sheet.text.contains("| a | b |\n|---|---|\n| 1 | 2 |\n"), "{}", sheet.text);
        assert_eq!((quoted("a, b"), number(-1.25, 1)), ("\"a, b\"".into(), "−1.2".into()));
    }
}
