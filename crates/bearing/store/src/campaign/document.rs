//! A file that defines scenes, such as that of a campaign: its text, the places of its fields, and messages
//! as those on scenes, with line, field, allowed values and remedy.

use std::ops::Range;

use stribeck_scene::fields::Shape;
use stribeck_scene::fields::tree::{Content, Node};
use stribeck_scene::fields::value::Value;
use stribeck_scene::scene_file::{Kind, Place, Problem, SceneError, place_in_file, read_as};

/// A file, and where its fields stand.
pub(crate) struct File<'a> {
    pub(crate) name: &'a str,
    pub(crate) text: &'a str,
    /// Its values.
    pub(crate) tree: Node,
}

/// A value of a scene in such a file: where it is written.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Written(pub(crate) Range<usize>);

impl Value for Written {
    const SHAPE: Shape = Shape::Any;

    fn read(node: &Node) -> Option<Self> {
        Some(Self(node.span.clone()))
    }

    fn write(&self) -> Node {
        Node::group([])
    }
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
    /// Reads a text as a file of this kind.
    pub(crate) fn read<T: Value>(
        name: &'a str,
        text: &'a str,
        kind: &'static Kind,
    ) -> Result<(T, Self), SceneError> {
        let (read, tree) = read_as(text, name, kind)?;
        Ok((read, Self { name, text, tree }))
    }

    pub(crate) fn written(&self, value: &Written) -> String {
        self.text[value.0.clone()].to_owned()
    }

    /// The value at a path; the whole file where it is not written.
    pub(crate) fn place(&self, path: &str) -> Place {
        match self.tree.get(path).filter(|_| !path.is_empty()) {
            Some(node) => place_in_file(self.name, self.text, node.span.clone()),
            None => Place::Unwritten { file: self.name.to_owned() },
        }
    }

    pub(crate) fn refuse(&self, path: &str, why: String) -> SceneError {
        let mut problem = Problem::new(why, self.place(path));
        path.clone_into(&mut problem.field);
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
        }
        problem
    }
}
