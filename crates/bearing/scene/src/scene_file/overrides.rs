//! Arguments `field=value` of the command line, and words of catalogues for fields of the bearing.

use std::ops::Range;

use super::named;
use crate::catalogue;
use crate::field::tree::{self, Content, Key, Node, Source, Step, steps};
use crate::field::wording::{list, shown};
use crate::field::{Shape, wording};
use crate::fields::{Spot, names_in, spot};
use crate::reading::sources::{Sources, command_line, find};
use crate::reading::{self, Place, Problem, SceneError, suggest};
use crate::scene::Scene;

impl Sources {
    /// Puts an empty group at a path, in the place of what is written there.
    pub(crate) fn open(&mut self, path: &str) {
        if let Some(node) = find(&mut self.tree, path) {
            node.content = Content::Group(Vec::new());
        }
    }

    /// Gives fields of the bearing that are called by words of catalogues ([`suggest::ACCEPTED`]) their names here;
    /// one that says that elements are balls sets `element`, too.
    pub(crate) fn accept_words_of_catalogues(&mut self) {
        let Some(node) = find(&mut self.tree, "bearing") else { return };
        let (source, span) = (node.source, node.span.clone());
        let Content::Group(fields) = &mut node.content else { return };
        let mut balls = false;
        for (key, _) in fields.iter_mut() {
            if let Some((theirs, ours)) = suggest::ACCEPTED.iter().find(|(theirs, _)| *theirs == key.name) {
                balls |= theirs.contains("ball");
                key.name = (*ours).to_owned();
            }
        }
        if balls && fields.iter().all(|(key, _)| key.name != "element") {
            let ball = Node { content: Content::Atom("ball".to_owned()), span: span.clone(), source };
            fields.push((Key { name: "element".to_owned(), span }, ball));
        }
    }

    /// Applies arguments in order.
    ///
    /// # Errors
    /// All that cannot be applied; the others are, as far as they go, so each meets the scene that it is
    /// written for.
    pub(crate) fn set_all<S: AsRef<str>>(&mut self, arguments: &[S]) -> Result<(), SceneError> {
        let given = written_by(arguments);
        let mut problems = Vec::new();
        for argument in arguments {
            problems.extend(self.set(argument.as_ref(), &given).err().unwrap_or_default());
        }
        if problems.is_empty() { Ok(()) } else { Err(SceneError::new(problems)) }
    }

    /// Applies one argument; `given` has the paths of all fields that arguments set.
    fn set(&mut self, argument: &str, given: &[String]) -> Result<(), Vec<Problem>> {
        let number = self.arguments.len();
        self.arguments.push(argument.to_owned());
        let Some((written, value)) = argument.split_once('=') else {
            let message = format!("`{}` has no `=`", shown(argument));
            let mut problem = Problem::new(message, command_line(argument, 0, argument.len()));
            "write `--set field=value`, for example `--set mesh.size_mm=1.0`"
                .clone_into(&mut problem.suggestion);
            return Err(vec![problem]);
        };
        let path = written.trim();
        let at = written.len() + 1;
        let spot = self.known(path, argument).map_err(|mut problem| {
            if let Some(hz) =
                value.trim().parse::<f64>().ok().filter(|hz| *hz > 0.0 && path.ends_with("rate_hz"))
            {
                let us = wording::number(1e6 / hz);
                problem.suggestion = format!("`output.interval_us={us}` (1e6 over the rate in Hz)");
            }
            vec![*problem]
        })?;
        let place = command_line(argument, at, argument.len());
        if path == "bearing"
            && let Some(name) = named::designation(value).or_else(|| bare_designation(value))
        {
            let scene = self.scene().unwrap_or_default();
            return self.name(scene, &name, given, Source::Argument(number), at..argument.len());
        }
        let node = if matches!(spot.shape.there(), Shape::Text) && !Node::atom(value.trim()).is_quoted() {
            // The shell has already eaten the user's quotes.
            let content = Content::Atom(format!("{:?}", value.trim()));
            Node { content, span: at..argument.len(), source: Source::Argument(number) }
        } else {
            tree::parse_argument(argument, at, number, path)
                .map_err(|_| vec![incomplete(path, value.trim(), spot, place)])?
        };
        let found = reading::faults(&node, spot, path, self);
        if !found.is_empty() {
            return Err(found);
        }
        let written = node.entries(path).into_iter().map(|(path, ..)| path);
        let written: Vec<String> = given.iter().cloned().chain(written).collect();
        let holds_size = || {
            self.written(named::SIZE).is_some()
                || self.scene().is_some_and(|scene| !named::size_follows(&scene))
        };
        let holds_size = path == "mesh.roller_facets" && holds_size();
        put(&mut self.tree, path, node);
        if let Some(mut scene) = self.scene() {
            if path == "bearing"
                && let Some(name) = named::alone(&scene.bearing, &written)
            {
                return self.name(scene, &name, &written, Source::Argument(number), at..argument.len());
            }
            // Sizes that follow from the bearing, as for `housing=pedestal()`.
            named::follow_bearing(&mut scene, path, holds_size, given);
            self.take(&scene);
        }
        Ok(())
    }

    /// Makes the bearing of a scene that of a name, which an argument has at `span`.
    fn name(
        &mut self,
        mut scene: Scene,
        name: &str,
        given: &[String],
        source: Source,
        span: Range<usize>,
    ) -> Result<(), Vec<Problem>> {
        named::put(&mut scene, name, given).map_err(|why| {
            let is_unreadable = catalogue::parse(name).is_err();
            let place = self.place_at(source, span.clone());
            vec![Problem { is_unreadable, ..super::unknown_bearing(why, place) }]
        })?;
        self.take(&scene);
        self.is_named = true;
        if let Some(bearing) = find(&mut self.tree, "bearing") {
            bearing.place_all(source, &span);
        }
        Ok(())
    }

    /// The entry of the table at a path; refuses one that no scene has, or not this one.
    fn known(&self, path: &str, argument: &str) -> Result<Spot, Box<Problem>> {
        let mark = command_line(argument, 0, argument.find('=').unwrap_or(argument.len()));
        let Some(found) = spot(path, Some(&self.tree)) else { return Err(Box::new(unknown(path, mark))) };
        let refuse = |message: String, allowed: String, suggestion: String| {
            let mut problem = Box::new(Problem::new(message, mark.clone()));
            path.clone_into(&mut problem.field);
            (problem.allowed, problem.suggestion) = (allowed, suggestion);
            Err(problem)
        };
        // Items of lists must be there, and have the form that has such a field.
        let (mut at, mut node, mut in_list) = (String::new(), Some(&self.tree), false);
        for step in steps(path) {
            let next = node.and_then(|node| node.step(step));
            match step {
                Step::Item(_) if next.is_none() => {
                    let items = node.map(|node| &node.inside().content);
                    let count = if let Some(Content::List(items)) = items { items.len() } else { 0 };
                    let message =
                        format!("`{path}` does not exist: `{at}` has {count} items, numbered from 0");
                    return refuse(message, String::new(), format!("give the whole list: `{at}=[ … ]`"));
                }
                Step::Field(name) if in_list && next.is_none() => {
                    let word = node.and_then(Node::word).unwrap_or_default();
                    let groups = spot(&at, None).map(|spot| spot.shape.there());
                    let Some(Shape::Words(words)) = groups else { return Ok(found) };
                    let names: Vec<&str> =
                        words.get(word).and_then(|word| word.inside).map_or_else(Vec::new, |inside| {
                            inside
                                .groups()
                                .iter()
                                .flat_map(|group| group.fields)
                                .map(|field| field.name)
                                .collect()
                        });
                    let message = format!("`{at}` is `{word}`, which has no field `{name}`");
                    return refuse(message, list(&names), format!("give the whole form: `{at}= … `"));
                }
                _ => {}
            }
            match step {
                Step::Field(name) if at.is_empty() => name.clone_into(&mut at),
                Step::Field(name) => at += &format!(".{name}"),
                Step::Item(item) => {
                    in_list = true;
                    at += &format!("[{item}]");
                }
            }
            node = next;
        }
        Ok(found)
    }
}

/// Paths of all fields that arguments `field=value` set.
pub(crate) fn written_by<S: AsRef<str>>(arguments: &[S]) -> Vec<String> {
    let fields = |argument: &S| {
        let (path, value) = argument.as_ref().split_once('=')?;
        let path = path.trim();
        let mut paths = vec![path.to_owned()];
        if let Ok(value) = tree::parse(value) {
            paths.extend(value.entries(path).into_iter().map(|(path, ..)| path));
        }
        Some(paths)
    };
    arguments.iter().filter_map(fields).flatten().collect()
}

/// A designation without its quotes, which shells take away.
fn bare_designation(value: &str) -> Option<String> {
    let value = value.trim();
    (!value.is_empty() && !value.contains(['(', ')', '"'])).then(|| value.to_owned())
}

/// Refuses a value that is not one value: a bracket is missing, or something follows.
fn incomplete(path: &str, value: &str, spot: Spot, place: Place) -> Problem {
    let mut problem = Problem { is_unreadable: true, ..Problem::new("", place) };
    path.clone_into(&mut problem.field);
    problem.allowed = spot.allowed();
    problem.message = match value {
        "" => format!("`{path}` is given no value"),
        _ => format!("`{path}` is given `{}`, which is not one complete value", shown(value)),
    };
    problem
}

/// Refuses a path that no scene has.
pub(crate) fn unknown(path: &str, mark: Place) -> Problem {
    // The longest prefix that exists is the section; the rest is the unknown name.
    let sections = path.match_indices('.').rev().map(|(at, _)| &path[..at]);
    let section = sections.into_iter().find(|section| !names_in(section).is_empty()).unwrap_or("");
    let name = path.strip_prefix(section).unwrap_or(path).trim_start_matches('.');
    let siblings = names_in(section);
    let message = match path {
        "" => "the name of a field is missing in front of `=`".to_owned(),
        _ => format!("no field `{}` in a scene", shown(path)),
    };
    let mut problem = Problem::new(message, mark);
    path.clone_into(&mut problem.field);
    problem.suggestion = suggest::field(section, name, &siblings, true).unwrap_or_default();
    problem.allowed = with_section(list(&siblings), section, &siblings);
    problem
}

/// Writes the names in a text with their section, as `--set` takes them.
fn with_section(text: String, section: &str, names: &[&str]) -> String {
    if section.is_empty() {
        return text;
    }
    let full = |text: String, name: &&str| text.replace(&format!("`{name}`"), &format!("`{section}.{name}`"));
    names.iter().fold(text, full)
}

/// Puts a value at a path. A group that is `None` is opened, and a word that has no such field becomes the
/// first one that has it.
fn put(tree: &mut Node, path: &str, value: Node) {
    if let Some(node) = find(tree, path) {
        *node = value;
        return;
    }
    let Some((section, name)) = path.rsplit_once('.') else { return };
    let (source, span) = (value.source, value.span.clone());
    let mut group = Node::group([(name, value)]);
    (group.source, group.span) = (source, span.clone());
    let words = match spot(section, None).map(|spot| spot.shape.there()) {
        Some(Shape::Words(words)) => words.words,
        _ => &[],
    };
    let has = |inside: Shape| inside.groups().iter().any(|group| group.get(name).is_some());
    let word = words.iter().find(|word| word.inside.is_some_and(has));
    let opened = match word {
        Some(word) => Node { source, span, ..Node::behind(word.word, group) },
        None => group,
    };
    put(tree, section, opened);
}
