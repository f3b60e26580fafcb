//! The width of lines, also where rustfmt leaves them alone: in comments, texts and macros.

use std::path::Path;

use anyhow::{Context, Result};

use super::sources;

/// As `max_width` in `rustfmt.toml` says it of code.
const COLUMNS: usize = 110;

pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let mut complaints = Vec::new();
    for folder in ["crates", "xtask"] {
        for file in sources::rust_files(&root.join(folder))? {
            let text =
                std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
            let file = file.strip_prefix(root).unwrap_or(&file).display();
            complaints.extend(long_lines(&text).map(|(number, columns)| {
                format!("{file}:{number}: {columns} columns, and {COLUMNS} are allowed: break it")
            }));
        }
    }
    Ok(complaints)
}

/// Numbers and lengths of lines that are too long and could be broken. Rows of tables in documentation cannot, nor can one long word.
fn long_lines(text: &str) -> impl Iterator<Item = (usize, usize)> {
    text.lines().enumerate().filter_map(|(at, line)| {
        let columns = line.chars().count();
        let content = line.trim_start().trim_start_matches(['/', '!']).trim_start();
        let is_row = content.starts_with('|');
        let breaks = line.trim_start().chars().take(COLUMNS).skip(4).any(char::is_whitespace);
        (columns > COLUMNS && !is_row && breaks).then_some((at + 1, columns))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn example_long_lines_are_found_but_for_rows_of_tables() {
        let long = "word ".repeat(30);
        let text = format!("// {long}\n//! | {long} |\n// short\n    {long}\n");
        assert_eq!(long_lines(&text).map(|(at, _)| at).collect::<Vec<_>>(), [1, 4]);
    }
}
