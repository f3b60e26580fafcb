//! Numbers outside the range of their field, and names that name nothing.

use super::finding::{Finding, Remedy};
use crate::field::wording::{number, shown};
use crate::fields::tree::{Content, Node, join};
use crate::fields::value::Value;
use crate::fields::{Shape, Spot, spot};
use crate::scene::Scene;

/// Longest name of a scene or sensor: they become folder and channel names.
const MAX_NAME: usize = 64;
/// Most sensors: each adds a handful of channels to every sample.
const MAX_SENSORS: usize = 64;

/// Everything outside its range.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let tree = scene.write();
    let mut found = in_tree(&tree, &tree, Spot::ROOT);
    found.extend(names(scene));
    found
}

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

/// Names that cannot be folders or channels, and sensors that share one.
fn names(scene: &Scene) -> Vec<Finding> {
    const NAME: &str = "letters, digits, `_` and `-`, a letter or digit first, at most 64 characters";
    const SENSOR: &str = "letters, digits and `_`, a letter first, at most 64 characters";
    let mut found = Vec::new();
    let plain = |name: &str, extra: &str| {
        name.len() <= MAX_NAME && name.chars().all(|c| c.is_ascii_alphanumeric() || extra.contains(c))
    };
    if !(plain(&scene.name, "_-") && scene.name.starts_with(|c: char| c.is_ascii_alphanumeric())) {
        found.push(bad_name("name".to_owned(), &scene.name, NAME));
    }
    let sensors = &scene.output.sensors;
    if sensors.is_empty() || sensors.len() > MAX_SENSORS {
        let remedy = Remedy::new("output.sensors", format!("1 to {MAX_SENSORS} sensors"))
            .value("[(name: \"side\", angle_deg: 0.0)]", "the report needs one acceleration at least");
        found.push(Finding::new(format!("`output.sensors` has {} entries", sensors.len()), vec![remedy]));
    }
    for (i, sensor) in sensors.iter().enumerate() {
        let path = format!("output.sensors[{i}].name");
        if !(plain(&sensor.name, "_") && sensor.name.starts_with(|c: char| c.is_ascii_alphabetic())) {
            found.push(bad_name(path, &sensor.name, SENSOR));
        } else if let Some(first) = sensors[..i].iter().position(|other| other.name == sensor.name) {
            let message = format!("sensors {first} and {i} are both called `{}`", sensor.name);
            let remedies = [path, format!("output.sensors[{first}].name")];
            let another = |field| Remedy::new(field, "a name of its own for each sensor");
            found.push(Finding::new(message, remedies.map(another).into()));
        }
    }
    found
}

fn bad_name(path: String, name: &str, allowed: &str) -> Finding {
    let message = format!("`{path}` is \"{}\", which cannot name a folder or a channel", shown(name));
    Finding::new(message, vec![Remedy::new(path, allowed)])
}
