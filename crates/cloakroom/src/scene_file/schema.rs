//! The JSON Schema of scene files, for editors that complete and check TOML.

use serde_json::{Map, Value, json};

use crate::device::{CATALOGUE, Entry};
use crate::keys::{Key, KeyKind, ValueRange};
use crate::scene::{Placement, TABLES};
use optics::material::Material;

/// The JSON Schema (draft 2020-12) of a scene file, made from the lists of keys and the catalogue
/// of devices.
pub fn schema() -> Value {
    let mut tables: Map<String, Value> = TABLES
        .iter()
        .map(|&(name, keys)| {
            let mut table = closed_table(properties(keys));
            demand(name, &mut table);
            (name.to_owned(), table)
        })
        .collect();
    let kinds = CATALOGUE.iter().map(|entry| json!({ "$ref": format!("#/$defs/{}", entry.kind) }));
    let kinds: Vec<Value> = kinds.collect();
    tables.insert(
        "device".to_owned(),
        json!({
            "type": "array",
            "description": "The devices, each a table [[device]].",
            "items": { "type": "object", "required": ["kind"], "oneOf": kinds },
        }),
    );
    let definitions: Map<String, Value> =
        CATALOGUE.iter().map(|entry| (entry.kind.to_owned(), device(entry))).collect();
    let mut schema = closed_table(tables);
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    schema["title"] = "cloakroom scene".into();
    schema["description"] = "A scene of cloakroom. Lengths in cm, angles in degrees.".into();
    schema["$defs"] = definitions.into();
    schema
}

fn device(entry: &Entry) -> Value {
    let mut all = properties(entry.keys);
    all.extend(properties(Placement::KEYS));
    let kind = json!({ "const": entry.kind, "description": "What the device is." });
    all.insert("kind".to_owned(), kind);
    let mut table = closed_table(all);
    table["title"] = entry.title.into();
    table["description"] = entry.summary.into();
    table["required"] = json!(["kind"]);
    table
}

/// Adds to a table what its keys demand of each other.
fn demand(name: &str, table: &mut Value) {
    match name {
        "camera" => {
            table["if"] = json!({
                "required": ["projection"],
                "properties": { "projection": { "const": "orthographic" } },
            });
            table["then"] =
                json!({ "required": ["width"], "properties": { "field_of_view": false } });
            table["else"] = json!({ "properties": { "width": false } });
        }
        "surroundings" => table["not"] = json!({ "required": ["color", "image"] }),
        _ => {}
    }
}

fn closed_table(properties: Map<String, Value>) -> Value {
    json!({ "type": "object", "additionalProperties": false, "properties": properties })
}

/// A table within a device's; polygons have no default.
fn inner_table(keys: &[Key]) -> Value {
    let mut table = closed_table(properties(keys));
    let required = keys.iter().filter(|key| matches!(key.kind, KeyKind::Polygon));
    table["required"] = required.map(|key| key.name).collect();
    table
}

fn properties(keys: &[Key]) -> Map<String, Value> {
    keys.iter().map(|key| (key.name.to_owned(), property(key))).collect()
}

fn property(key: &Key) -> Value {
    let number = number(key.limits);
    let mut property = match key.kind {
        KeyKind::Number | KeyKind::Integer => number,
        KeyKind::Flag => json!({ "type": "boolean" }),
        KeyKind::Choice { options } => json!({ "enum": options }),
        KeyKind::Choices { options } => json!({ "type": "array", "items": { "enum": options } }),
        KeyKind::Vector => list(number, 3),
        KeyKind::IntegerPair | KeyKind::Interval => list(number, 2),
        KeyKind::Image => json!({ "type": "string", "minLength": 1 }),
        KeyKind::ChoiceOrNumber { options } => json!({ "anyOf": [{ "enum": options }, number] }),
        KeyKind::ChoiceNumberOrTable { options, keys } => {
            json!({ "anyOf": [{ "enum": options }, number, inner_table(keys)] })
        }
        KeyKind::Tensor => tensor(number),
        KeyKind::Complex => json!({ "anyOf": [number, list(number.clone(), 2)] }),
        KeyKind::Direction => json!({ "anyOf": [number, list(json!({ "type": "number" }), 3)] }),
        KeyKind::Axes => list(list(json!({ "type": "number" }), 3), 3),
        KeyKind::Material => material_name(),
        KeyKind::MaterialOrTable { keys } => {
            json!({ "anyOf": [material_name(), inner_table(keys)] })
        }
        KeyKind::Mesh => {
            json!({ "type": "string", "pattern": r"\.([sS][tT][lL]|[oO][bB][jJ]|[gG][lL][bB]|[gG][lL][tT][fF])$" })
        }
        KeyKind::Name => json!({ "type": "string", "pattern": r"^\p{L}[\p{L}\p{N}_-]{0,63}$" }),
        KeyKind::Polygon => json!({ "type": "array", "items": list(number, 2), "minItems": 3 }),
        KeyKind::Samples { dimensions: [least, most] } => {
            let list = |items: Value| json!({ "type": "array", "items": items, "minItems": 1 });
            let mut forms = vec![json!({ "type": "string", "minLength": 1 })];
            let mut nested = number;
            for dimension in 0..=most {
                if dimension >= least {
                    forms.push(nested.clone());
                }
                nested = list(nested);
            }
            json!({ "anyOf": forms })
        }
        KeyKind::Table { keys } => inner_table(keys),
        KeyKind::FlagOrTable { keys } => {
            json!({ "anyOf": [{ "type": "boolean" }, inner_table(keys)] })
        }
        KeyKind::Tables { keys } => json!({ "type": "array", "items": inner_table(keys) }),
    };
    property["description"] = key.doc.into();
    if !key.unit.is_empty() {
        property["description"] = format!("{} Unit: {}.", key.doc, key.unit).into();
        property["x-unit"] = key.unit.into();
    }
    if let Some(default) = (key.default)() {
        property["default"] = crate::json::json(default);
    }
    property
}

/// The name of a material that comes with the program, or of a file.
fn material_name() -> Value {
    let file = json!({ "type": "string", "pattern": "\\.[yY][aA]?[mM][lL]$" });
    json!({ "anyOf": [{ "enum": Material::NAMES }, file] })
}

/// A number, [re, im], or 3 x 3 of either.
fn tensor(number: Value) -> Value {
    let pair = list(number.clone(), 2);
    let rows = list(list(json!({ "anyOf": [number, pair] }), 3), 3);
    json!({ "anyOf": [number, pair, rows] })
}

fn number(limits: ValueRange) -> Value {
    match limits {
        ValueRange::Finite => json!({ "type": "number" }),
        ValueRange::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
        ValueRange::Between(low, high) => {
            json!({ "type": "number", "exclusiveMinimum": low, "exclusiveMaximum": high })
        }
        ValueRange::Within(low, high) => {
            json!({ "type": "number", "minimum": low, "maximum": high })
        }
        ValueRange::Whole(low, high) => {
            json!({ "type": "integer", "minimum": low, "maximum": high })
        }
    }
}

fn list(items: Value, length: usize) -> Value {
    json!({ "type": "array", "items": items, "minItems": length, "maxItems": length })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_and_every_kind_is_there_and_closed() {
        let schema = schema();
        assert_eq!(schema["additionalProperties"], false);
        for &(table, keys) in TABLES {
            let table = &schema["properties"][table];
            assert_eq!(table["additionalProperties"], false);
            assert_eq!(table["properties"].as_object().map(Map::len), Some(keys.len()));
        }
        for entry in CATALOGUE {
            let device = &schema["$defs"][entry.kind];
            assert_eq!(device["additionalProperties"], false);
            assert_eq!(device["properties"]["kind"]["const"], entry.kind);
            let keys = device["properties"].as_object().map(Map::len);
            assert_eq!(keys, Some(1 + entry.keys.len() + Placement::KEYS.len()), "a name twice");
        }
    }

    #[test]
    fn keys_say_type_limits_unit_and_default() {
        let schema = schema();
        let camera = &schema["properties"]["camera"]["properties"];
        let view = &camera["field_of_view"];
        assert_eq!((&view["exclusiveMinimum"], &view["default"]), (&json!(0.0), &json!(40.0)));
        assert!(view["description"].as_str().is_some_and(|d| d.ends_with("Unit: degrees.")));
        assert_eq!(view["x-unit"], "degrees");
        assert_eq!(schema["$defs"]["square-cloak"]["properties"]["side"]["x-unit"], "cm");
        assert!(camera["samples"].get("x-unit").is_none());
        assert_eq!(camera["position"]["default"], json!([-100.0, 0.0, 0.0]));
        assert_eq!(camera["resolution"]["items"]["maximum"], 65_536);
        assert_eq!(camera["projection"]["enum"], json!(["perspective", "orthographic"]));
        assert!(camera["width"].get("default").is_none());
    }

    #[test]
    fn every_reference_leads_somewhere() {
        fn references(value: &Value, found: &mut Vec<String>) {
            match value {
                Value::Object(map) => {
                    if let Some(Value::String(reference)) = map.get("$ref") {
                        found.push(reference.clone());
                    }
                    map.values().for_each(|value| references(value, found));
                }
                Value::Array(items) => items.iter().for_each(|value| references(value, found)),
                _ => {}
            }
        }
        let schema = schema();
        let mut found = Vec::new();
        references(&schema, &mut found);
        for reference in found {
            let pointer = reference.strip_prefix('#').expect("inside the document");
            assert!(schema.pointer(pointer).is_some(), "{reference}");
        }
    }
}
