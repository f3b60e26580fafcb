//! The width of comments and texts, which rustfmt leaves as they are.

use std::path::Path;

use anyhow::{Context, Result};

use super::{layers, sources};

/// As `max_width` in `rustfmt.toml`, which is for code.
const COLUMNS: usize = 110;

/// A text of as many characters on one line can be broken with a backslash.
const LONG_TEXT: usize = 80;

pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let mut complaints = Vec::new();
    for folder in layers::folders(root)? {
        for file in sources::rust_files(&root.join(folder))? {
            let text =
                std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
            let file = file.strip_prefix(root).unwrap_or(&file);
            // Texts of tests are files and pages, whose lines are their own.
            let texts = !file.components().any(|part| part.as_os_str() == "tests");
            complaints.extend(long_lines(&text, texts).into_iter().map(|(number, columns)| {
                let file = file.display();
                format!("{file}:{number}: {columns} columns, and {COLUMNS} are allowed: break it")
            }));
        }
    }
    Ok(complaints)
}

/// Numbers and lengths of lines of comments, and of `texts` where asked, that are too long and could be
/// broken: rows of tables and code in documentation cannot.
fn long_lines(text: &str, texts: bool) -> Vec<(usize, usize)> {
    let (mut found, mut in_code) = (Vec::new(), false);
    for (at, line) in text.lines().enumerate() {
        let content = line.trim_start();
        let comment = content.starts_with("//").then(|| content.trim_start_matches(['/', '!']).trim_start());
        in_code = match comment {
            Some(comment) => in_code != comment.starts_with("```"),
            None => false,
        };
        let columns = line.chars().count();
        let breakable = match comment {
            Some(comment) => !in_code && !comment.starts_with('|'),
            None => texts && quoted(line).any(|text| text.chars().count() > LONG_TEXT && text.contains(' ')),
        };
        if columns > COLUMNS && breakable {
            found.push((at + 1, columns));
        }
    }
    found
}

/// The text between quotes on a line.
fn quoted(line: &str) -> impl Iterator<Item = &str> {
    line.split('"').skip(1).step_by(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_long_comments_and_texts_are_found_but_for_tables_and_code() {
        let long = "word ".repeat(30);
        let text = format!(
            "// {long}\n//! | {long} |\n//! ```\n//! {long}\n//! ```\n// \
            short\n    say(\"{long}\");\n"
        );
        let found = |texts| long_lines(&text, texts).into_iter().map(|(at, _)| at).collect::<Vec<_>>();
        assert_eq!(found(true), [1, 7]);
        assert_eq!(found(false), [1]);
    }
}
