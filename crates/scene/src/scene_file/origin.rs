//! Origin of a field: a line of the file, an argument of the command line, or a default; and from that, which
//! field to blame where several are inconsistent.

use super::finding::{Finding, Proposal};
use super::outline::Outline;
use super::problem::{Place, Problem, place_in_file};

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
        command_line(&self.argument, self.value_start(), self.argument.len())
    }

    /// The value of the field `rest` inside this override's value (empty: the whole); `None` where it is left
    /// out. The name of a bearing sets all of its fields.
    fn place_of(&self, rest: &str) -> Option<Place> {
        let from = self.value_start();
        if rest.is_empty() || self.path == "bearing" && !self.argument[from..].contains('(') {
            return Some(self.place_of_value());
        }
        let outline = Outline::of(&self.argument[from..]);
        let value = outline.get(rest)?.value.clone();
        Some(command_line(&self.argument, from + value.start, from + value.end))
    }

    fn value_start(&self) -> usize {
        self.argument.find('=').map_or(0, |at| at + 1)
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

    /// Blames one field of a finding, and proposes the first value of its remedy.
    ///
    /// The command line was written last, a default not at all: the field written last is blamed first, and
    /// among equals the likeliest one that a single value can repair.
    pub(crate) fn problem(&self, finding: Finding) -> Problem {
        let mut candidates: Vec<Candidate> = Vec::with_capacity(finding.remedies.len());
        for remedy in finding.remedies {
            let proposal = remedy.values.into_iter().next();
            let place = self.written(&remedy.field);
            candidates.push(Candidate { field: remedy.field, allowed: remedy.allowed, proposal, place });
        }
        let last = candidates.iter().map(Candidate::rank).max().unwrap_or(0);
        let among = |candidate: &&Candidate| candidate.rank() == last;
        let best = candidates.iter().filter(among).find(|candidate| candidate.proposal.is_some());
        let Some(blamed) = best.or_else(|| candidates.iter().find(among)) else {
            return Problem::new(finding.message, Place::Unwritten { file: self.file.to_owned() });
        };
        let nowhere = Place::Unwritten { file: self.file.to_owned() };
        let mut problem = Problem::new(finding.message, blamed.place.clone().unwrap_or(nowhere));
        problem.field.clone_from(&blamed.field);
        problem.allowed.clone_from(&blamed.allowed);
        let another = candidates.iter().find(|candidate| candidate.proposal.is_some());
        match best.or(another) {
            Some(Candidate { field, proposal: Some(Proposal { value, note }), .. }) => {
                problem.propose(field, value, note);
            }
            // Items of a list cannot be tried beforehand.
            _ if blamed.field.contains('[') => {
                problem.suggestion = "take a value that is allowed there".to_owned();
            }
            _ if candidates.len() == 1 => {
                problem.suggestion = format!("give `{}` an allowed value", blamed.field);
            }
            _ => {
                problem.suggestion =
                    "no single value repairs this; change several of the fields together".to_owned()
            }
        }
        problem
    }

    /// Place where `field` was written, if it was.
    pub(crate) fn place(&self, field: &str) -> Place {
        self.written(field).unwrap_or(Place::Unwritten { file: self.file.to_owned() })
    }

    /// Where `field` was written; an override of the field or of a section around it wins over the file.
    fn written(&self, field: &str) -> Option<Place> {
        let within = |path: &str| {
            let rest = field.strip_prefix(path)?;
            (rest.is_empty() || rest.starts_with(['.', '['])).then(|| rest.trim_start_matches('.').to_owned())
        };
        let by = self.overrides.iter().rev().find_map(|by| Some((by, within(&by.path)?)));
        if let Some((by, rest)) = by {
            return by.place_of(&rest);
        }
        let entry = self.outline.get(field)?;
        Some(place_in_file(self.file, self.text, entry.value.clone()))
    }
}

/// A field that may be to blame.
struct Candidate {
    field: String,
    allowed: String,
    /// A value that repairs the finding.
    proposal: Option<Proposal>,
    place: Option<Place>,
}

impl Candidate {
    fn rank(&self) -> u8 {
        match self.place {
            Some(Place::CommandLine { .. }) => 2,
            Some(_) => 1,
            None => 0,
        }
    }
}
