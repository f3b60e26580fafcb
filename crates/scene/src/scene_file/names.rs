//! Names that cannot be folders or channels, and numbers outside their range.

use crate::field::value::Value;
use crate::field::wording::shown;
use crate::fields::Spot;
use crate::reading::finding::{Finding, Remedy};
use crate::reading::ranges::in_tree;
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
