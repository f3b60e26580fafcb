//! The table of fields as a JSON schema, for editors and other programs.

use serde_json::{Map, Value as Json, json};

use super::page::sentence;
use super::tree::{Content, Node};
use super::value::Value;
use super::{Shape, Spot};
use crate::scene::Scene;

/// The schema of a scene (JSON Schema, 2020-12): fields, types, ranges, defaults and descriptions. A word
/// with brackets is an object with the word as its only name.
pub fn json_schema() -> Json {
    let mut schema = of(Spot::ROOT);
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("A scene of Stribeck");
    schema
}

fn of(spot: Spot) -> Json {
    match spot.shape {
        Shape::Optional(inner) => json!({ "anyOf": [of(spot.with(*inner)), { "type": "null" }] }),
        Shape::Any => json!({}),
        Shape::Number => within("number", spot),
        Shape::Count => within("integer", spot),
        Shape::Text => json!({ "type": "string" }),
        Shape::Pair => {
            json!({ "type": "array", "prefixItems": [{ "type": "number" }, within("number", spot)] })
        }
        Shape::List(item) => json!({ "type": "array", "items": of(spot.with(*item)) }),
        Shape::Words(words) => {
            let word = |word: &super::Word| match word.inside {
                None => json!({ "const": word.word, "description": sentence(word.about) }),
                Some(inside) => json!({
                    "type": "object",
                    "properties": { word.word: of(spot.with(inside)) },
                    "required": [word.word],
                    "additionalProperties": false,
                    "description": sentence(word.about),
                }),
            };
            json!({ "oneOf": words.words.iter().map(word).collect::<Vec<_>>() })
        }
        Shape::Group(group) => {
            let mut properties = Map::new();
            for field in group.fields {
                let at = spot.at(group, field);
                let mut schema = of(at);
                schema["description"] = json!(sentence(field.about));
                if let Some(default) = at.default() {
                    schema["default"] = json(&default, field.shape);
                }
                properties.insert(field.name.to_owned(), schema);
            }
            let required: Vec<&str> =
                group.fields.iter().filter(|field| field.is_required).map(|field| field.name).collect();
            json!({
                "type": "object",
                "properties": properties,
                "required": required,
                "additionalProperties": false,
            })
        }
    }
}

/// The values of a scene by their names, without those that a written scene leaves out.
pub fn to_json(scene: &Scene) -> Json {
    json(&scene.write(), Scene::SHAPE)
}

/// A number in its range.
fn within(kind: &str, spot: Spot) -> Json {
    let mut schema = json!({ "type": kind });
    if let Some((range, _)) = spot.range {
        let [low, high] = [("inimum", range.low_included), ("aximum", range.high_included)]
            .map(|(end, included)| if included { format!("m{end}") } else { format!("exclusiveM{end}") });
        schema[low] = json!(range.low);
        // An end that other fields set is theirs.
        if range.most.is_none() {
            schema[high] = json!(range.high);
        }
    }
    schema
}

fn json(node: &Node, shape: Shape) -> Json {
    match (&node.content, shape.there()) {
        (Content::Atom(_), Shape::Number) => f64::read(node).map_or(Json::Null, |number| json!(number)),
        (Content::Atom(_), Shape::Count) => u64::read(node).map_or(Json::Null, |number| json!(number)),
        (Content::Atom(_), Shape::Text) => String::read(node).map_or(Json::Null, |text| json!(text)),
        (Content::Atom(word), _) => {
            if word == "None" {
                Json::Null
            } else {
                json!(word)
            }
        }
        (Content::List(items), Shape::List(item)) => items.iter().map(|node| json(node, *item)).collect(),
        (Content::Group(fields), Shape::Group(group)) => {
            let value = |(key, node): &(super::tree::Key, Node)| {
                let field = group.get(&key.name).filter(|field| !group.omits(field, node))?;
                Some((key.name.clone(), json(node, field.shape)))
            };
            Json::Object(fields.iter().filter_map(value).collect())
        }
        (Content::Behind(word, inside), Shape::Words(words)) => {
            let shape = words.get(word).and_then(|word| word.inside).unwrap_or(Shape::Text);
            json!({ word: json(inside, shape) })
        }
        _ => Json::Null,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_the_schema_has_types_ranges_and_defaults() {
        let schema = json_schema();
        let at = |path: &str| schema.pointer(path).cloned().unwrap_or_default();
        let size = at("/properties/mesh/properties/size_mm");
        assert_eq!(size["exclusiveMinimum"], 0.0);
        assert_eq!((&size["maximum"], &size["default"]), (&json!(1000.0), &json!(0.5)));
        assert_eq!(at("/properties/cage/anyOf/1/type"), "null");
        assert_eq!(at("/properties/cage/default/pocket"), "straight");
        assert_eq!(at("/properties/mesh/default/grading"), Json::Null);
        assert_eq!(at("/properties/output/properties/sensors/items/required"), json!(["name", "angle_deg"]));
        assert_eq!(at("/properties/housing/oneOf/2/properties/mesh/type"), "object");
        assert_eq!(at("/additionalProperties"), false);
    }
}
