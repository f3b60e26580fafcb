//! Who wrote a field: a line of the file, an argument of the command line, or nobody (a default).

use super::outline::Outline;
use super::problem::{Place, Problem, place_in_file};

/// Something wrong with the meaning of a scene, before its place is known.
#[derive(Debug, Clone)]
pub(crate) struct Finding {
    /// Fields involved, the culprit first. The first one that somebody wrote is underlined.
    pub fields: Vec<String>,
    /// What is wrong, with the value.
    pub message: String,
    /// What would be accepted.
    pub allowed: String,
    /// What to try.
    pub suggestion: String,
}

/// One accepted `field=value`.
#[derive(Debug, Clone)]
pub(crate) struct Override {
    /// Dotted path.
    pub path: String,
    /// The whole argument.
    pub argument: String,
}

impl Override {
    /// The part behind `=`, underlined.
    pub(crate) fn place_of_value(&self) -> Place {
        let from = self.argument.find('=').map_or(0, |at| at + 1);
        command_line(&self.argument, from, self.argument.len())
    }
}

/// A place in an argument, by byte range.
pub(crate) fn command_line(argument: &str, from: usize, to: usize) -> Place {
    let column = argument[..from].chars().count() + 1;
    let width = argument[from..to].chars().count().max(1);
    Place::CommandLine { argument: argument.to_owned(), column, width }
}

/// The writers of a scene.
pub(crate) struct Origin<'a> {
    file: &'a str,
    text: &'a str,
    outline: Outline,
    overrides: Vec<Override>,
}

impl<'a> Origin<'a> {
    pub(crate) fn in_file(file: &'a str, text: &'a str, overrides: Vec<Override>) -> Self {
        Self { file, text, outline: Outline::of(text), overrides }
    }

    pub(crate) fn in_memory(overrides: Vec<Override>) -> Self {
        Self { file: "", text: "", outline: Outline::default(), overrides }
    }

    /// Gives a finding its place.
    pub(crate) fn problem(&self, finding: Finding) -> Problem {
        let written = finding.fields.iter().find_map(|field| self.written(field));
        let place = written.unwrap_or_else(|| Place::Unwritten { file: self.file.to_owned() });
        Problem {
            field: finding.fields.into_iter().next().unwrap_or_default(),
            message: finding.message,
            allowed: finding.allowed,
            suggestion: finding.suggestion,
            place,
        }
    }

    /// Where `field` was written; an override of the field or of a section around it wins over the file.
    fn written(&self, field: &str) -> Option<Place> {
        let covers = |path: &str| {
            field == path || field.strip_prefix(path).is_some_and(|rest| rest.starts_with(['.', '[']))
        };
        if let Some(by) = self.overrides.iter().rev().find(|by| covers(&by.path)) {
            return Some(by.place_of_value());
        }
        let entry = self.outline.get(field)?;
        Some(place_in_file(self.file, self.text, entry.value.clone()))
    }
}
