//! Results as JSON schemas, for programs that read it.

use serde_json::{Map, Value, json};

use stribeck_diagnosis::quantity::{Entry, Kind, Part};

use super::without_links;

/// A schema of a file, with its version (JSON Schema, 2020-12).
pub fn titled(title: &str, mut schema: Value) -> Value {
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    schema["title"] = format!("{title}, Stribeck {}", env!("CARGO_PKG_VERSION")).into();
    schema
}

/// The schema of a type.
pub fn of<T: Part>() -> Value {
    content(T::KIND)
}

fn content(kind: Kind) -> Value {
    match kind {
        // A number that is not finite is written as null.
        Kind::Number => json!({ "type": ["number", "null"] }),
        Kind::Whole => json!({ "type": "integer" }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Text => json!({ "type": "string" }),
        Kind::Group(entries) => group(entries),
        Kind::List(item) => json!({ "type": "array", "items": content(*item) }),
        Kind::Optional(inner) => json!({ "anyOf": [content(*inner), { "type": "null" }] }),
        Kind::Several(item, n) => {
            json!({ "type": "array", "items": content(*item), "minItems": n, "maxItems": n })
        }
        Kind::Pair([first, second]) => {
            json!({ "type": "array", "prefixItems": [content(*first), content(*second)], "minItems": 2, "maxItems": 2 })
        }
    }
}

fn group(entries: &[Entry]) -> Value {
    let (mut properties, mut required) = (Map::new(), Vec::new());
    add(entries, &mut properties, &mut required);
    json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn add(entries: &[Entry], properties: &mut Map<String, Value>, required: &mut Vec<&str>) {
    for entry in entries {
        if let ("flatten", Kind::Group(inner)) = (entry.written, entry.kind) {
            add(inner, properties, required);
            continue;
        }
        if entry.written == "skip" {
            continue;
        }
        let mut schema = content(entry.kind);
        schema["description"] = without_links(entry.about.trim_start()).into();
        properties.insert(entry.name.to_owned(), schema);
        if !entry.written.contains("skip_serializing_if") {
            required.push(entry.name);
        }
    }
}
