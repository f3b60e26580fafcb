//! What the table of fields does not allow in a tree of values: unknown names, missing fields, values of the
//! wrong type; and texts that are no tree.

pub(crate) mod finding;
pub(crate) mod load;
pub(crate) mod problem;
pub(crate) mod ranges;
pub(crate) mod sources;
pub(crate) mod suggest;

use std::ops::Range;

use stribeck_theory::catalogue::CatalogueBearing;

use crate::field::wording::{list, shown};
use crate::fields::tree::{Broken, Content, Node, Source, Stop, join};
use crate::fields::value::Value;
use problem::MOST_TOLD;
pub use problem::{Place, Problem, SceneError, offset, place_in_file};
pub use sources::Kind;
use sources::Sources;
pub use suggest::nearest;

use crate::fields::{Group, Shape, Spot, Words, spot};
use crate::scene::Scene;

/// Some editors write a byte order mark first, which RON does not accept.
pub fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// Reads the text of another file than a scene by the table of its fields: what it says, and where it says
/// it.
///
/// # Errors
/// Unknown and missing fields, values of the wrong type and numbers outside their range, with their places.
pub fn read_as<T: Value>(text: &str, file: &str, kind: &'static Kind) -> Result<(T, Node), SceneError> {
    let sources = Sources::of_text(text, file, kind)?;
    let whole = Spot::of(T::SHAPE);
    let mut found = faults(&sources.tree, whole, "", &sources);
    if found.is_empty() {
        let outside = ranges::in_tree(&Scene::default().write(), &sources.tree, whole);
        found = outside.into_iter().take(MOST_TOLD).map(|finding| sources.problem(finding)).collect();
    }
    match T::read(&sources.tree).filter(|_| found.is_empty()) {
        Some(read) => Ok((read, sources.tree)),
        None => Err(SceneError::new(found)),
    }
}

/// What in `node` its entry of the table does not allow, [`MOST_TOLD`] at most.
pub(crate) fn faults(node: &Node, spot: Spot, path: &str, sources: &Sources) -> Vec<Problem> {
    let mut found = Found { sources, problems: Vec::new() };
    found.check(node, spot, path);
    found.problems
}

struct Found<'a> {
    sources: &'a Sources,
    problems: Vec<Problem>,
}

impl Found<'_> {
    fn add(&mut self, field: &str, message: String, node: &Node, span: Range<usize>) -> &mut Problem {
        let place = self.sources.place_at(node.source, span);
        let mut problem = Problem { is_unreadable: true, ..Problem::new(message, place) };
        field.clone_into(&mut problem.field);
        self.problems.push(problem);
        let last = self.problems.len() - 1;
        &mut self.problems[last]
    }

    fn check(&mut self, node: &Node, spot: Spot, path: &str) {
        let is_left_out = node.is_none() && matches!(spot.shape, Shape::Optional(_));
        if is_left_out || self.problems.len() >= MOST_TOLD {
            return;
        }
        match (spot.shape.there(), &node.content) {
            (Shape::Any, _) => {}
            (Shape::Number, _) if f64::read(node).is_some() => {}
            (Shape::Count, _) if u64::read(node).is_some() => {}
            (Shape::Text, _) if String::read(node).is_some() => {}
            (Shape::Pair, _) if <(f64, f64)>::read(node).is_some() => {}
            (Shape::List(item), Content::List(items)) => {
                let of_item = spot.item().unwrap_or_else(|| spot.with(*item));
                for (i, node) in items.iter().enumerate() {
                    self.check(node, of_item, &format!("{path}[{i}]"));
                }
            }
            (Shape::Group(group), Content::Group(_)) => self.group(node, spot, group, path),
            // RON allows the name of a group before its brackets.
            (Shape::Group(group), Content::Behind(name, inside)) if name == group.name => {
                self.check(inside, spot, path);
            }
            (Shape::Group(_), Content::Behind(name, inside)) => {
                let span = node.span.start..inside.span.start;
                let problem = self.add(
                    path,
                    format!("`{}(` is no part of {}", shown(name), self.sources.kind.noun),
                    node,
                    span,
                );
                "leave the name in front of the bracket out: `( … )`".clone_into(&mut problem.suggestion);
            }
            (Shape::Words(words), _) => self.word(node, spot, words, path),
            _ => self.mismatch(node, spot, path),
        }
    }

    fn home(&self, path: &str) -> String {
        if path.is_empty() { self.sources.kind.noun.to_owned() } else { format!("`{path}`") }
    }

    fn group(&mut self, node: &Node, spot: Spot, group: &'static Group, path: &str) {
        let Content::Group(fields) = &node.content else { return };
        for (i, (key, value)) in fields.iter().enumerate() {
            if self.problems.len() >= MOST_TOLD {
                return;
            }
            let at = join(path, &key.name);
            match group.get(&key.name) {
                _ if fields[..i].iter().any(|(before, _)| before.name == key.name) => {
                    let message = format!("field `{}` is given twice", key.name);
                    let problem = self.add(&at, message, node, key.span.clone());
                    "keep one of the two lines".clone_into(&mut problem.suggestion);
                }
                Some(field) => self.check(value, spot.at(group, field), &at),
                None => {
                    let names: Vec<&str> = group
                        .fields
                        .iter()
                        .filter(|field| !field.is_internal)
                        .map(|field| field.name)
                        .collect();
                    let message = format!("unknown field `{}` in {}", shown(&key.name), self.home(path));
                    let kind = self.sources.kind;
                    let problem = self.add(&at, message, node, key.span.clone());
                    problem.allowed = list(&names);
                    problem.suggestion = advice(path, &key.name, &names, kind);
                }
            }
        }
        for field in group.fields.iter().filter(|field| field.is_required && node.field(field.name).is_none())
        {
            let message = format!("{} has no field `{}`, which has no default", self.home(path), field.name);
            let problem = self.add(&join(path, field.name), message, node, node.span.clone());
            problem.suggestion = format!("add `{}: …` ({})", field.name, field.shape.words());
        }
    }

    fn word(&mut self, node: &Node, spot: Spot, words: &'static Words, path: &str) {
        let Some(written) = node.word() else { return self.mismatch(node, spot, path) };
        let known = words.get(written);
        match (&node.content, known.map(|word| word.inside)) {
            (Content::Atom(_), Some(None)) => {}
            (Content::Behind(_, inside), Some(Some(shape))) => self.check(inside, spot.inside(shape), path),
            (Content::Atom(_), Some(Some(shape))) => {
                let message = format!("`{path}` is `{written}` without its brackets");
                let problem = self.add(path, message, node, node.span.clone());
                problem.allowed = spot.allowed();
                match meant(written, spot.shape, path) {
                    Some((value, note)) => problem.propose(&value, note),
                    None => problem.suggestion = format!("`{written}( … )`, with {} in it", shape.words()),
                }
            }
            (Content::Behind(..), Some(None)) => {
                let message =
                    format!("`{path}` is `{written}( … )`, and `{written}` has nothing in brackets");
                let problem = self.add(path, message, node, node.span.clone());
                problem.propose(written, "without brackets");
            }
            (_, None) if written.starts_with(|c: char| c.is_alphabetic()) && !spot_is_none(spot, written) => {
                let message = format!("`{path}` is `{}`, which is not one of its words", shown(written));
                // In `Some( … )` it stands behind a bracket.
                let is_first = self.sources.text_of(node).starts_with(written);
                let end = if is_first { node.span.start + written.len() } else { node.span.end };
                let problem = self.add(path, message, node, node.span.start..end);
                let names = words.names();
                problem.allowed = list(&names);
                if let Some(near) = suggest::nearest(written, &names) {
                    problem.suggestion = format!("did you mean `{near}`?");
                }
            }
            _ => self.mismatch(node, spot, path),
        }
    }

    /// A value of the wrong type.
    fn mismatch(&mut self, node: &Node, spot: Spot, path: &str) {
        let value = self.sources.text_of(node).to_owned();
        let too_large = spot.shape.counts() && !value.is_empty() && value.bytes().all(|b| b.is_ascii_digit());
        let not = if too_large { "too large".to_owned() } else { format!("not {}", spot.shape.words()) };
        let message = if path.is_empty() {
            format!("{} is expected here", spot.shape.words())
        } else {
            format!("`{path}` is `{}`, which is {not}", shown(&value))
        };
        let is_group = matches!(spot.shape.there(), Shape::Group(_));
        let unnamed = is_group && (path.is_empty() || matches!(node.content, Content::Tuple(_)));
        let problem = self.add(path, message, node, node.span.clone());
        problem.allowed = spot.allowed();
        if unnamed {
            "fields stand with their names in round brackets: `(name: value, …)`"
                .clone_into(&mut problem.suggestion);
        } else if let Some((value, note)) = meant(&value, spot.shape, path) {
            problem.propose(&value, note);
        }
    }
}

/// Remedy for a field that is not one of `names`.
fn advice(section: &str, found: &str, names: &[&str], kind: &Kind) -> String {
    let Some(elsewhere) = kind.for_fields_of_scenes else {
        return suggest::field(section, found, names, true).unwrap_or_default();
    };
    let of_scene = || spot(found, None).map(|_| elsewhere.replace("{}", found));
    suggest::field("", found, names, false).or_else(of_scene).unwrap_or_default()
}

/// Whether a word is meant for `None`.
fn spot_is_none(spot: Spot, written: &str) -> bool {
    matches!(spot.shape, Shape::Optional(_)) && written.eq_ignore_ascii_case("none")
}

/// The value that was probably meant by one of the wrong type.
fn meant(value: &str, shape: Shape, path: &str) -> Option<(String, &'static str)> {
    let bare = value.trim_matches('"');
    if matches!(shape, Shape::Optional(_)) && bare.eq_ignore_ascii_case("none") {
        return Some(("None".to_owned(), "with a capital letter"));
    }
    match shape.there() {
        Shape::Number if bare != value && bare.parse::<f64>().is_ok_and(f64::is_finite) => {
            Some((bare.to_owned(), "without quotes"))
        }
        Shape::Count if bare.parse::<u32>().is_ok() => Some((bare.to_owned(), "without quotes")),
        Shape::Text
            if bare.chars().all(|c| c.is_ascii_alphanumeric() || "_.-/".contains(c)) && !bare.is_empty() =>
        {
            Some((format!("\"{bare}\""), "in quotes"))
        }
        Shape::Words(words) => match words.get(bare)?.inside {
            None => Some((bare.to_owned(), "without quotes")),
            Some(Shape::Group(_)) => Some((format!("{bare}()"), "with brackets for its fields")),
            Some(Shape::Count) => Some((format!("{bare}(1)"), "with its number")),
            Some(_) => None,
        },
        Shape::Group(_) if path == "bearing" => {
            let known = CatalogueBearing::parse(bare).ok()?;
            Some((format!("\"{}\"", known.name), "the name of a bearing of the catalogue, in quotes"))
        }
        _ => None,
    }
}

/// The error on a text that is no tree.
pub(crate) fn broken(broken: Broken, sources: &Sources) -> Problem {
    let (source, text) = (Source::File, sources.text.as_str());
    let noun = sources.kind.noun.trim_start_matches("a ").trim_start_matches("an ");
    let Broken { field, range, kind } = broken;
    let mut problem = Problem::new("", sources.place_at(source, range.clone()));
    let cannot = format!("the {noun} cannot be read");
    let (message, suggestion) = match kind {
        Stop::Empty => (format!("the {noun} is empty"), sources.kind.example),
        Stop::Ends => (
            format!("the {noun} ends too early: a closing bracket or a value is missing"),
            "is the file cut off? Every `(` needs its `)`",
        ),
        Stop::Deep => (format!("{cannot}: it has too many brackets in each other"), ""),
        Stop::NoValue if text[range.start..].starts_with('{') => {
            ("a group `( … )` is expected here".to_owned(), hint(text, range.start))
        }
        Stop::NoValue => (format!("{cannot}: a value is expected here"), hint(text, range.start)),
        Stop::Expected(what) => (format!("{cannot}: {what} is expected here"), hint(text, range.start)),
    };
    (problem.message, problem.field) = (message, field);
    suggestion.clone_into(&mut problem.suggestion);
    problem
}

/// Hint on the place where reading stopped.
fn hint(text: &str, at: usize) -> &'static str {
    let before = text[..at].trim_end();
    let rest = text[at..].trim_start();
    let next = rest.trim_start_matches(|c: char| c.is_ascii_alphanumeric() || "_ ".contains(c));
    if rest.starts_with('{') || before.ends_with('{') {
        "a group stands in round brackets: `( … )`"
    } else if rest.starts_with('=') || next.starts_with('=') {
        "a value follows a colon: `name: value`"
    } else if rest.starts_with('"') && !before.ends_with(':') {
        "names of fields are written without quotes: `name: value`"
    } else if rest.starts_with('\'') {
        "a text stands in double quotes"
    } else if rest.starts_with('#') {
        "`//` begins a comment"
    } else if before.ends_with(',') && rest.starts_with(|c: char| c.is_ascii_digit()) {
        "a number has a decimal point"
    } else {
        "look for a missing comma, bracket or quote near the mark"
    }
}
