//! A file that defines scenes, such as that of a campaign: its text, the places of its fields, and messages
//! as those on scenes, with line, field, allowed values and remedy.

use std::ops::Range;

use ron::error::SpannedError;

use stribeck_scene::fields::tree::{self, Content, Node};
use stribeck_scene::scene_file::{
    self, Place, Problem, SceneError, list, nearest, offset, place_in_file, shown,
};

/// Properties of one kind of file.
pub(crate) struct Kind {
    /// Noun for such a file: `a campaign`.
    pub(crate) noun: &'static str,
    /// Its fields, and an example file.
    pub(crate) example: &'static str,
    /// The part of it whose type has this name.
    pub(crate) part: fn(Option<&str>) -> &'static str,
    /// Remedy for a missing field without default, by the type that misses it.
    pub(crate) lacking: fn(Option<&str>) -> Option<&'static str>,
    /// Remedy for a field of a scene at the wrong level.
    pub(crate) for_fields_of_scenes: &'static str,
    /// How large a whole number in the field of this name may be; `None` for other fields.
    pub(crate) most: fn(&str) -> Option<u64>,
}

/// The text of a file, and where its fields stand.
pub(crate) struct File<'a> {
    pub(crate) name: &'a str,
    pub(crate) text: &'a str,
    /// Its values; none of a text that is broken.
    pub(crate) tree: Node,
    kind: &'static Kind,
}

/// A file that cannot be read.
pub(crate) fn unreadable(name: &str, kind: &Kind, example: &str, error: &std::io::Error) -> SceneError {
    let place = Place::Unwritten { file: name.to_owned() };
    let noun = kind.noun;
    let mut problem = Problem::new(format!("cannot read `{name}` as {noun}: {error}"), place);
    problem.suggestion = format!("name the file of {noun}, such as {example}");
    problem.into()
}

impl<'a> File<'a> {
    pub(crate) fn new(name: &'a str, text: &'a str, kind: &'static Kind) -> Self {
        let tree = tree::parse(text).unwrap_or_else(|_| Node::group([]));
        Self { name, text, tree, kind }
    }

    /// The value at a path; the whole file where it is not written.
    pub(crate) fn place(&self, path: &str) -> Place {
        match self.tree.get(path).filter(|_| !path.is_empty()) {
            Some(node) => place_in_file(self.name, self.text, node.span.clone()),
            None => Place::Unwritten { file: self.name.to_owned() },
        }
    }

    /// Refuses the value at a path.
    pub(crate) fn refuse(&self, path: &str, why: String) -> SceneError {
        let mut problem = Problem::new(why, self.place(path));
        path.clone_into(&mut problem.field);
        problem.into()
    }

    /// A problem of the value at a path.
    pub(crate) fn shown(&self, mut problem: Problem, path: &str) -> SceneError {
        problem.place = self.place(path);
        problem.into()
    }

    /// The scene that all others start from; a mistake in an item of `set` is shown at that item.
    pub(crate) fn of_base(&self, error: SceneError) -> SceneError {
        SceneError::new(error.problems().iter().cloned().map(|problem| self.in_set(problem)).collect())
    }

    /// The same problem in the item of `set` that is to blame.
    pub(crate) fn in_set(&self, mut problem: Problem) -> Problem {
        if let Place::CommandLine { argument, .. } = &problem.place {
            let is_argument =
                |node: &&Node| self.text[node.span.clone()].trim_matches('"') == argument.as_str();
            let item = match self.tree.get("set").map(|set| &set.content) {
                Some(Content::List(items)) => items.iter().find(is_argument),
                _ => None,
            };
            problem.place = match item {
                Some(node) => place_in_file(self.name, self.text, node.span.clone()),
                None => self.place("set"),
            };
            problem.suggestion = problem.suggestion.replacen("--set ", "", 1);
        }
        problem
    }

    /// A text that is no such file.
    pub(crate) fn not_understood(&self, error: &SpannedError) -> SceneError {
        use ron::Error as E;
        let start = offset(self.text, error.span.start.line, error.span.start.col);
        let end = offset(self.text, error.span.end.line, error.span.end.col).max(start);
        let mut range = start..end;
        let mut problem = Problem::new("", self.place(""));
        match &error.code {
            E::NoSuchStructField { expected, found, outer } => {
                let named = self.tree.entries("").into_iter().map(|(_, key, _)| key);
                let named = named.filter(|key| self.text[key.clone()] == **found && key.end <= end + 1);
                range = named.max_by_key(|key| key.start).unwrap_or(range);
                problem.field.clone_from(found);
                problem.message =
                    format!("unknown field `{}` in {}", shown(found), (self.kind.part)(outer.as_deref()));
                problem.allowed = list(expected);
                problem.suggestion = match nearest(found, expected) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None if scene_file::unknown_field(found).is_none() => {
                        self.kind.for_fields_of_scenes.replace("{}", found)
                    }
                    None => String::new(),
                };
            }
            E::NoSuchEnumVariant { expected, found, .. } => {
                problem.field = self.at(start).map_or_else(String::new, |(path, _)| path);
                problem.message =
                    format!("`{}` is `{}`, which is not one of its words", problem.field, shown(found));
                problem.allowed = list(expected);
                if let Some(near) = nearest(found, expected) {
                    problem.suggestion = format!("did you mean `{near}`?");
                }
            }
            E::MissingStructField { field, outer } => {
                problem.field = (*field).to_owned();
                problem.message =
                    format!("{} lacks `{field}`, which has no default", (self.kind.part)(outer.as_deref()));
                let lacking = (self.kind.lacking)(outer.as_deref()).unwrap_or(self.kind.example);
                problem.suggestion = lacking.replace("{field}", field);
            }
            E::DuplicateStructField { field, .. } => {
                problem.field = (*field).to_owned();
                problem.message = format!("field `{field}` is given twice");
                problem.suggestion = "keep one of the two".to_owned();
            }
            code => match self.no_whole_number(start) {
                Some((path, at, most)) => {
                    let value = shown(&self.text[at.clone()]);
                    problem.message = format!("`{path}` is `{value}`");
                    problem.field = path;
                    problem.allowed = format!("a whole number, at most {most}");
                    range = at;
                }
                None => {
                    problem.message = format!("the file of {} cannot be read: {code}", self.kind.noun);
                    self.kind.example.clone_into(&mut problem.suggestion);
                }
            },
        }
        problem.place = place_in_file(self.name, self.text, range);
        problem.into()
    }

    /// The innermost field whose value contains a byte of the text: its path and the range of its value.
    fn at(&self, at: usize) -> Option<(String, Range<usize>)> {
        let entries = self.tree.entries("").into_iter().map(|(path, _, node)| (path, node.span.clone()));
        entries.into_iter().find(|(_, span)| span.start <= at && at <= span.end)
    }

    /// The number at a byte of the text that is to be a whole one and is not, and how large it may be.
    fn no_whole_number(&self, at: usize) -> Option<(String, Range<usize>, u64)> {
        let (path, range) = self.at(at)?;
        let most = (self.kind.most)(path.rsplit('.').next()?)?;
        self.text[range.clone()].parse::<u64>().is_err().then_some((path, range, most))
    }
}
