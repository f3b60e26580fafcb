//! The values of a file with their origins: lines of the file, arguments `field=value` of the command line,
//! and defaults; and from that, which field to blame where several are inconsistent.

use std::ops::Range;

use super::finding::{Finding, Remedy};
use super::problem::{Place, Problem, SceneError, place_in_file};
use crate::field::tree::{self, Content, Node, Source, Step, steps};
use crate::field::value::Value;
use crate::scene::Scene;

/// A kind of file that is written in fields and values.
#[derive(Debug)]
pub struct Kind {
    /// What such a file is: `a campaign`.
    pub noun: &'static str,
    /// Its fields, and an example.
    pub example: &'static str,
    /// Where the field of a scene stands in it, with `{}` for the field; empty where none does, `None` for a
    /// scene.
    pub for_fields_of_scenes: Option<&'static str>,
}

pub(crate) const SCENE: Kind = Kind {
    noun: "a scene",
    example: "`()` is the complete default scene; is the file cut off?",
    for_fields_of_scenes: None,
};

/// A complete scene as a tree, and its sources.
#[derive(Debug)]
pub(crate) struct Sources {
    pub(crate) kind: &'static Kind,
    file: String,
    pub(crate) text: String,
    pub(crate) arguments: Vec<String>,
    pub(crate) tree: Node,
    /// Whether an argument has named the bearing.
    pub(crate) is_named: bool,
}

impl Sources {
    /// A scene in memory, which nobody wrote.
    pub(crate) fn of_scene(scene: &Scene) -> Self {
        let (file, text, arguments) = (String::new(), String::new(), Vec::new());
        Self { kind: &SCENE, file, text, arguments, tree: scene.write(), is_named: false }
    }

    /// What a file of this kind says, its fields alone.
    pub(crate) fn of_text(text: &str, file: &str, kind: &'static Kind) -> Result<Self, SceneError> {
        let (file, text, tree) = (file.to_owned(), text.to_owned(), Node::group([]));
        let mut sources = Self { kind, file, text, arguments: Vec::new(), tree, is_named: false };
        sources.tree = tree::parse(&sources.text).map_err(|why| super::broken(why, &sources))?;
        Ok(sources)
    }

    /// The scene; `None` where a value is not one of its field.
    pub(crate) fn scene(&self) -> Option<Scene> {
        <Scene as Value>::read(&self.tree)
    }

    /// Takes the values of a scene, and keeps the origins of those that are the same.
    pub(crate) fn take(&mut self, scene: &Scene) {
        self.tree = scene.write().placed_as(&self.tree);
    }

    /// A place in the text of a source, by byte range.
    pub(crate) fn place_at(&self, source: Source, span: Range<usize>) -> Place {
        match source {
            Source::Default => Place::Unwritten { file: self.file.clone() },
            Source::File => place_in_file(&self.file, &self.text, span),
            Source::Argument(number) => command_line(&self.arguments[number], span.start, span.end),
        }
    }

    pub(crate) fn text_of<'a>(&'a self, node: &'a Node) -> &'a str {
        match (node.source, &node.content) {
            (Source::File, _) => &self.text[node.span.clone()],
            (Source::Argument(number), _) => self.arguments[number][node.span.clone()].trim(),
            (Source::Default, Content::Atom(text)) => text,
            (Source::Default, _) => "",
        }
    }

    /// Where `field` was written, if it was.
    fn written(&self, field: &str) -> Option<Place> {
        let node = self.tree.get(field).filter(|node| node.source != Source::Default)?;
        Some(self.place_at(node.source, node.span.clone()))
    }

    /// Place where `field` was written, if it was.
    pub(crate) fn place(&self, field: &str) -> Place {
        self.written(field).unwrap_or_else(|| self.place_at(Source::Default, 0..0))
    }

    /// Blames one field of a finding: of those involved the one that was written last, a default not at all, and
    /// among equals the likeliest.
    pub(crate) fn problem(&self, finding: Finding) -> Problem {
        let rank = |remedy: &Remedy| match self.written(&remedy.field) {
            Some(Place::CommandLine { .. }) => 2,
            Some(_) => 1,
            None => 0,
        };
        let Finding { message, remedies } = finding;
        // The first of several that are largest.
        let Some(blamed) = remedies.iter().rev().max_by_key(|remedy| rank(remedy)) else {
            return Problem::new(message, self.place(""));
        };
        let mut problem = Problem::new(message, self.place(&blamed.field)).of(&blamed.field);
        problem.allowed.clone_from(&blamed.allowed);
        let mut fixed = std::iter::once(blamed).chain(&remedies).filter(|remedy| remedy.fixed.is_some());
        if let Some(Remedy { field, fixed: Some([value, note]), .. }) = fixed.next() {
            let value =
                if *field == blamed.field { (*value).to_owned() } else { format!("{field}: {value}") };
            problem.propose(&value, note);
        }
        problem
    }
}

/// A place in an argument, by byte range.
pub(crate) fn command_line(argument: &str, from: usize, to: usize) -> Place {
    let column = argument[..from].chars().count() + 1;
    let width = argument[from..to].chars().count().max(1);
    Place::CommandLine { argument: argument.to_owned(), column, width }
}

pub(crate) fn find<'a>(tree: &'a mut Node, path: &str) -> Option<&'a mut Node> {
    fn one<'a>(node: &'a mut Node, step: Step<'_>) -> Option<&'a mut Node> {
        match (&mut node.content, step) {
            (Content::Behind(_, inside), _) => one(inside, step),
            (Content::Group(fields), Step::Field(name)) => {
                fields.iter_mut().find(|(key, _)| key.name == name).map(|(_, node)| node)
            }
            (Content::List(items), Step::Item(at)) => items.get_mut(at),
            _ => None,
        }
    }
    steps(path).try_fold(tree, one)
}
