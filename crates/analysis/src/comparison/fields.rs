//! Fields in which scenes differ.

use serde::Serialize;
use serde_json::Value;
use stribeck_scene::fields::to_json;
use stribeck_scene::scene::Scene;

/// A field that is not the same in all scenes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FieldDifference {
    /// Its path, as `--set` takes it.
    pub field: String,
    /// Its value in each, as a scene has it; `None` where there is no scene.
    pub values: Vec<Option<String>>,
}

/// Fields in which `scenes` differ, in the order of their names. The name of a scene makes no difference.
pub fn differences(scenes: &[Option<&Scene>]) -> Vec<FieldDifference> {
    let plain = |scene: &Scene| to_json(&Scene { name: String::new(), ..scene.clone() });
    let values: Vec<Option<Value>> = scenes.iter().map(|scene| scene.map(plain)).collect();
    let mut found = Vec::new();
    compare("", &values.iter().map(Option::as_ref).collect::<Vec<_>>(), &mut found);
    // Fields drawn for each start come last.
    found.sort_by_key(|difference| DRAWN.contains(&difference.field.as_str()));
    found
}

/// Fields that a start draws.
const DRAWN: [&str; 3] = ["bearing.first_roller_deg", "cage.roller_offsets_um", "mesh.roller_phase_deg"];

fn compare(path: &str, values: &[Option<&Value>], found: &mut Vec<FieldDifference>) {
    let known: Vec<&Value> = values.iter().flatten().copied().collect();
    if known.windows(2).all(|pair| pair[0] == pair[1]) {
        return;
    }
    if !known.iter().all(|value| value.is_object()) {
        let words = |value: &Option<&Value>| value.map(as_written);
        found.push(FieldDifference { field: path.to_owned(), values: values.iter().map(words).collect() });
        return;
    }
    let mut names: Vec<&String> = known.iter().filter_map(|v| v.as_object()).flat_map(|o| o.keys()).collect();
    names.sort();
    names.dedup();
    for name in names {
        let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        // A field that one of them leaves out is there with nothing in it.
        let inner = values.iter().map(|value| value.map(|value| value.get(name).unwrap_or(&Value::Null)));
        compare(&path, &inner.collect::<Vec<_>>(), found);
    }
}

/// A value as a scene has it.
fn as_written(value: &Value) -> String {
    match value {
        Value::Null => "None".to_owned(),
        Value::Bool(yes) => yes.to_string(),
        Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), |n| n.to_string()),
        // A variant without fields; names have no blanks.
        Value::String(text) if text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') => text.clone(),
        Value::String(text) => format!("{text:?}"),
        Value::Array(items) => {
            format!("[{}]", items.iter().map(as_written).collect::<Vec<_>>().join(", "))
        }
        Value::Object(fields) => {
            let fields = fields.iter().filter(|(_, value)| !value.is_null());
            let fields = fields.map(|(name, value)| format!("{name}: {}", as_written(value)));
            format!("({})", fields.collect::<Vec<_>>().join(", "))
        }
    }
}
