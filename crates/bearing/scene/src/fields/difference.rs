//! Fields in which scenes differ.

use super::tree::{Content, Node, join};
use super::value::Value;
use crate::scene::Scene;

/// Paths of the fields that are not the same in all scenes, in the order of their names, each with its value
/// in every scene as it would be written; `None` where there is no scene.
pub fn differences(scenes: &[Option<&Scene>]) -> Vec<(String, Vec<Option<String>>)> {
    let trees: Vec<Option<Node>> = scenes.iter().map(|scene| scene.map(Value::write)).collect();
    let mut found = Vec::new();
    compare("", &trees.iter().map(Option::as_ref).collect::<Vec<_>>(), &mut found);
    found
}

fn compare(path: &str, nodes: &[Option<&Node>], found: &mut Vec<(String, Vec<Option<String>>)>) {
    let known: Vec<&Node> = nodes.iter().flatten().copied().collect();
    if known.windows(2).all(|pair| pair[0] == pair[1]) {
        return;
    }
    let form = |node: &Node| match (&node.content, &node.inside().content) {
        (Content::Behind(word, _), Content::Group(_)) => Some(word.clone()),
        (_, Content::Group(_)) => Some(String::new()),
        _ => None,
    };
    let same_form = known.windows(2).all(|pair| form(pair[0]) == form(pair[1]));
    match &known[0].inside().content {
        Content::Group(fields) if same_form => {
            let mut names: Vec<&str> = fields.iter().map(|(key, _)| key.name.as_str()).collect();
            names.sort_unstable();
            for name in names {
                let path = join(path, name);
                let inner = nodes.iter().map(|node| node.and_then(|node| node.field(name)));
                compare(&path, &inner.collect::<Vec<_>>(), found);
            }
        }
        _ => found.push((path.to_owned(), nodes.iter().map(|node| node.map(in_words)).collect())),
    }
}

/// A value on one line, short.
fn in_words(node: &Node) -> String {
    let all = |nodes: &[Node]| nodes.iter().map(in_words).collect::<Vec<_>>().join(", ");
    match &node.content {
        Content::Atom(text) => match (f64::read(node), String::read(node)) {
            (Some(number), _) => number.to_string(),
            (_, Some(name)) if name.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c)) => name,
            _ => text.clone(),
        },
        Content::List(items) => format!("[{}]", all(items)),
        Content::Tuple(items) => format!("({})", all(items)),
        Content::Group(fields) => {
            let there = fields.iter().filter(|(_, node)| !node.is_none());
            let field = |(key, node): &(super::tree::Key, Node)| format!("{}: {}", key.name, in_words(node));
            format!("({})", there.map(field).collect::<Vec<_>>().join(", "))
        }
        Content::Behind(word, inside) => match &inside.content {
            Content::Group(_) => format!("{word}{}", in_words(inside)),
            _ => format!("{word}({})", in_words(inside)),
        },
    }
}
