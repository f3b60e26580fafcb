//! Numbers outside the range of their field.

use super::finding::{Finding, Remedy};
use crate::field::wording::number;
use crate::fields::tree::{Content, Node, join};
use crate::fields::value::Value;
use crate::fields::{Shape, Spot, spot};
use crate::scene::Scene;

/// Numbers of a tree outside their range, which other fields of `scene` may set.
pub(crate) fn in_tree(scene: &Node, tree: &Node, whole: Spot) -> Vec<Finding> {
    let mut found = Vec::new();
    numbers(scene, tree, whole, "", &mut found);
    found
}

/// Range of the field at `path`, in words, where `value` is outside.
pub(crate) fn refuses(path: &str, value: f64) -> Option<String> {
    let (range, unit) = spot(path, None)?.range?;
    let scene = Scene::default().write();
    (!range.contains(value, &scene)).then(|| range.in_words(unit, &scene))
}

/// Numbers outside their range in a value of a scene.
fn numbers(scene: &Node, node: &Node, spot: Spot, path: &str, found: &mut Vec<Finding>) {
    match (spot.shape.there(), &node.content) {
        // Its name may stand before its brackets.
        (Shape::Group(group), Content::Group(_) | Content::Behind(..)) => {
            for field in group.fields {
                let at = join(path, field.name);
                if let Some(node) = node.field(field.name) {
                    numbers(scene, node, spot.at(group, field), &at, found);
                }
            }
        }
        (Shape::Words(words), Content::Behind(word, inside)) => {
            if let Some(shape) = words.get(word).and_then(|word| word.inside) {
                numbers(scene, inside, spot.with(shape), path, found);
            }
        }
        (Shape::List(item), Content::List(items)) => {
            for (i, node) in items.iter().enumerate() {
                numbers(scene, node, spot.with(*item), &format!("{path}[{i}]"), found);
            }
        }
        // Times of a course are checked with their order.
        (Shape::Pair, Content::Tuple(items)) => {
            if let [_, value] = items.as_slice() {
                found.extend(outside(scene, value, spot, path));
            }
        }
        (Shape::Number | Shape::Count, _) => found.extend(outside(scene, node, spot, path)),
        _ => {}
    }
}

/// The finding on a number outside the range of its field.
fn outside(scene: &Node, node: &Node, spot: Spot, path: &str) -> Option<Finding> {
    let ((range, unit), value) = (spot.range?, f64::read(node)?);
    if range.contains(value, scene) {
        return None;
    }
    let message = if value.is_finite() {
        format!("`{path}` is {}, outside its range", number(value))
    } else {
        format!("`{path}` is {value}, which is not a finite number")
    };
    Some(Finding::new(message, vec![Remedy::new(path, range.in_words(unit, scene))]))
}
