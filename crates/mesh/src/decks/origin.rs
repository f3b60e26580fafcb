//! Lines of files that were put in the place of an `*INCLUDE`: which file they come from, and which of its
//! lines they are.
//!
//! Whoever puts them there encloses them in two comments, which [`Origins`] looks for:
//!
//! ```text
//! ** included: part.inp
//! *NODE
//! …
//! ** end of included
//! ```

/// What begins the comment before a file; its name follows.
const BEGINS: &str = "included: ";
/// The comment behind it.
const ENDS: &str = "end of included";

/// One of the two comments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mark<'a> {
    /// Before the lines of this file.
    Begins(&'a str),
    /// Behind them.
    Ends,
}

/// Meaning of a line.
pub(super) fn mark(line: &str) -> Option<Mark<'_>> {
    let words = line.strip_prefix("** ").or_else(|| line.strip_prefix("$ "))?;
    match words.strip_prefix(BEGINS) {
        Some(file) => Some(Mark::Begins(file.trim())),
        None => (words.trim_end() == ENDS).then_some(Mark::Ends),
    }
}

/// The file that each line comes from, as far as it is another one.
#[derive(Debug, Default)]
pub(super) struct Origins {
    /// First line, by the number in the whole text from 1, the file and the number of that line in it;
    /// ascending.
    pieces: Vec<(usize, Option<String>, usize)>,
}

impl Origins {
    pub(super) fn of(text: &str) -> Self {
        let mut pieces = Vec::new();
        let mut open: Vec<(Option<String>, usize)> = vec![(None, 0)];
        for (at, line) in text.lines().enumerate() {
            match mark(line) {
                Some(Mark::Begins(file)) => {
                    open.push((Some(file.to_owned()), 0));
                    pieces.push((at + 2, open.last().and_then(|(file, _)| file.clone()), 1));
                }
                Some(Mark::Ends) if open.len() > 1 => {
                    open.pop();
                    if let Some((file, line)) = open.last() {
                        pieces.push((at + 2, file.clone(), line + 1));
                    }
                }
                _ => {
                    if let Some((_, line)) = open.last_mut() {
                        *line += 1;
                    }
                }
            }
        }
        Self { pieces }
    }

    /// File and line there, of a line of the whole text.
    pub(super) fn locate(&self, line: usize) -> (Option<&str>, usize) {
        let after = self.pieces.partition_point(|(first, ..)| *first <= line);
        match after.checked_sub(1).map(|at| &self.pieces[at]) {
            Some((first, file, there)) => (file.as_deref(), there + line - first),
            None => (None, line),
        }
    }

    pub(super) fn shown(&self, line: usize) -> String {
        match self.locate(line) {
            (Some(file), line) => format!("`{file}`, line {line}"),
            (None, line) => format!("line {line}"),
        }
    }
}

/// The text of another file between its two comments; `comment` begins a comment in the format.
pub fn included(comment: &str, file: &str, text: &str) -> String {
    let newline = if text.is_empty() || text.ends_with('\n') { "" } else { "\n" };
    format!("{comment} {BEGINS}{file}\n{text}{newline}{comment} {ENDS}\n")
}
