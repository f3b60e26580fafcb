//! The summary as a JSON schema, for programs that read it.

use serde_json::{Map, Value, json};

use super::{Entry, Kind, without_links};

/// The schema of a content.
pub(crate) fn of(kind: Kind) -> Value {
    match kind {
        // A number that is not finite is written as null.
        Kind::Number => json!({ "type": ["number", "null"] }),
        Kind::Whole => json!({ "type": "integer" }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Text => json!({ "type": "string" }),
        Kind::Group(entries) => group(entries),
        Kind::List(item) => json!({ "type": "array", "items": of(*item) }),
        Kind::Optional(inner) => json!({ "anyOf": [of(*inner), { "type": "null" }] }),
        Kind::Several(item, n) => {
            json!({ "type": "array", "items": of(*item), "minItems": n, "maxItems": n })
        }
        Kind::Pair([first, second]) => {
            json!({ "type": "array", "prefixItems": [of(*first), of(*second)], "minItems": 2, "maxItems": 2 })
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
        let mut schema = of(entry.kind);
        schema["description"] = without_links(entry.about.trim_start()).into();
        properties.insert(entry.name.to_owned(), schema);
        if !entry.written.contains("skip_serializing_if") {
            required.push(entry.name);
        }
    }
}
