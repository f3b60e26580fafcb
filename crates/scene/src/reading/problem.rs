//! Errors of a scene, and the excerpt of its text that the user sees.

use std::fmt;
use std::ops::Range;

/// Source lines are shown up to this many characters around the mark, so that a one-line megabyte stays
/// readable.
const SHOWN_WIDTH: usize = 110;

/// Problems of a file are told up to this many at once: each holds its line, which may be all of the file.
pub(crate) const MOST_TOLD: usize = 100;

/// Everything that is wrong with a scene. Displays as one underlined excerpt per problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneError {
    problems: Vec<Problem>,
}

/// One thing that is wrong with a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Dotted path of the field, `bearing.rollers`; empty when the whole file is meant.
    pub field: String,
    /// Message, with the value.
    pub message: String,
    /// Accepted values, with their unit; may be empty.
    pub allowed: String,
    /// Remedy; may be empty.
    pub suggestion: String,
    /// Where the value was written.
    pub place: Place,
    /// Whether the value is none of its field, whatever the others are: a misspelt word, a wrong type.
    pub is_unreadable: bool,
}

/// Where a value was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// In a scene file.
    File {
        /// File name as the user gave it.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// The source line.
        source: String,
        /// Characters to underline, at least 1.
        width: usize,
    },
    /// In a `--set field=value` argument.
    CommandLine {
        /// The argument, `field=value`.
        argument: String,
        /// Column of the mark in characters, from 1.
        column: usize,
        /// Characters to underline, at least 1.
        width: usize,
    },
    /// Nowhere: the file as a whole, or a default.
    Unwritten {
        /// File name as the user gave it; empty for a scene built in memory.
        file: String,
    },
}

impl SceneError {
    /// Of one problem or more.
    pub fn new(problems: Vec<Problem>) -> Self {
        Self { problems }
    }

    /// The problems, in the order in which they were found. Never empty.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }
}

impl From<Problem> for SceneError {
    fn from(problem: Problem) -> Self {
        Self { problems: vec![problem] }
    }
}

impl From<Box<Problem>> for SceneError {
    fn from(problem: Box<Problem>) -> Self {
        (*problem).into()
    }
}

impl Problem {
    /// A problem without advice.
    pub fn new(message: impl Into<String>, place: Place) -> Self {
        let message = message.into();
        let (field, allowed, suggestion) = (String::new(), String::new(), String::new());
        Self { field, message, allowed, suggestion, place, is_unreadable: false }
    }

    /// The same, of a field.
    pub(crate) fn of(self, field: &str) -> Self {
        Self { field: field.to_owned(), ..self }
    }

    /// The same problem at another place.
    pub fn of_value_at(self, place: Place) -> Self {
        Self { place, ..self }
    }

    /// Proposes `value` for its field.
    pub(crate) fn propose(&mut self, value: &str, note: &str) {
        self.suggestion = if note.is_empty() { format!("`{value}`") } else { format!("`{value}` ({note})") };
    }

    /// Where it stands in its file, from 1; zeros where it is not in one.
    pub fn line_and_column(&self) -> (usize, usize) {
        match self.place {
            Place::File { line, column, .. } => (line, column),
            _ => (0, 0),
        }
    }
}

impl std::error::Error for SceneError {}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{problem}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.message)?;
        match &self.place {
            Place::File { file, line, column, source, width } => {
                writeln!(f, "  --> {file}:{line}:{column}")?;
                excerpt(f, &line.to_string(), source, *column, *width)?;
            }
            Place::CommandLine { argument, column, width } => {
                writeln!(f, "  --> command line")?;
                const FLAG: &str = "--set ";
                excerpt(f, " ", &format!("{FLAG}{argument}"), column + FLAG.len(), *width)?;
            }
            Place::Unwritten { file } if !file.is_empty() => writeln!(f, "  --> {file}")?,
            Place::Unwritten { .. } => {}
        }
        if !self.allowed.is_empty() {
            writeln!(f, "   = allowed: {}", self.allowed)?;
        }
        if !self.suggestion.is_empty() {
            writeln!(f, "   = try: {}", self.suggestion)?;
        }
        Ok(())
    }
}

/// Draws `source` with `width` characters underlined from `column` on, cut to a readable window.
fn excerpt(
    f: &mut fmt::Formatter<'_>,
    label: &str,
    source: &str,
    column: usize,
    width: usize,
) -> fmt::Result {
    // A control character would move the mark away from its place.
    let visible = |c: char| if c.is_control() { ' ' } else { c };
    let total = source.chars().count();
    let first = if total <= SHOWN_WIDTH { 0 } else { column.saturating_sub(SHOWN_WIDTH / 2) };
    let shown: String = source.chars().skip(first).take(SHOWN_WIDTH).map(visible).collect();
    let indent = column.saturating_sub(1).saturating_sub(first);
    let width = width.clamp(1, SHOWN_WIDTH.saturating_sub(indent).max(1));
    let margin = " ".repeat(label.len());
    writeln!(f, " {margin} |")?;
    writeln!(f, " {label} | {shown}")?;
    writeln!(f, " {margin} | {}{}", " ".repeat(indent), "^".repeat(width))
}

/// The place of a byte range of `text`; a range over several lines is cut to its first.
pub fn place_in_file(file: &str, text: &str, range: Range<usize>) -> Place {
    let start = floor_char(text, range.start);
    let end = floor_char(text, range.end).max(start);
    let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
    let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
    let marked = &text[start..end.min(line_end)];
    Place::File {
        file: file.to_owned(),
        line: text[..start].matches('\n').count() + 1,
        column: text[line_start..start].chars().count() + 1,
        source: text[line_start..line_end].trim_end().to_owned(),
        width: marked.trim_end().chars().count().max(1),
    }
}

/// Byte offset of a 1-based line and column, counted in characters.
pub fn offset(text: &str, line: usize, column: usize) -> usize {
    let before: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let within: usize = text[before..]
        .chars()
        .take(column.saturating_sub(1))
        .take_while(|c| *c != '\n')
        .map(char::len_utf8)
        .sum();
    before + within
}

/// The last character boundary at or before `at`.
fn floor_char(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}
