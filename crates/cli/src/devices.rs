//! `cloakroom devices`: the catalogue with computed facts.

use crate::arguments::DevicesArguments;
use crate::report::{self, Failure};
use cloakroom::device::{CATALOGUE, Entry, Fact, FactValue};
use cloakroom::json::json as value_json;
use cloakroom::keys::{Key, KeyKind};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// Prints the catalogue.
pub fn run(arguments: &DevicesArguments) -> Result<(), Failure> {
    if arguments.json {
        let list: Vec<Value> = CATALOGUE.iter().map(|entry| as_json(entry)).collect();
        return report::print_json(&json!({ "devices": list }));
    }
    let mut text = String::new();
    for entry in CATALOGUE {
        describe(entry, &mut text).map_err(Failure::from_error)?;
    }
    report::print(&text)
}

fn as_json(entry: &Entry) -> Value {
    let mut object = Map::new();
    object.insert("kind".into(), json!(entry.kind));
    object.insert("title".into(), json!(entry.title));
    object.insert("summary".into(), json!(entry.summary));
    object.insert("keys".into(), keys_as_json(entry.keys));
    for fact in (entry.device)().facts() {
        let value = match fact.value {
            FactValue::Number(number) => json!(number),
            FactValue::Numbers(numbers) => json!(numbers),
        };
        object.insert(fact.name.into(), value);
    }
    Value::Object(object)
}

fn keys_as_json(keys: &[Key]) -> Value {
    let key = |key: &Key| {
        let mut object = json!({ "name": key.name, "doc": key.doc, "allowed": key.describe(), "default": key.default_value().map(value_json) });
        if let KeyKind::Table { keys } | KeyKind::Tables { keys } = key.kind {
            object["keys"] = keys_as_json(keys);
        }
        object
    };
    keys.iter().map(key).collect()
}

/// A line for each key; those of a list of tables follow it, as `prism.corners`.
fn describe_keys(keys: &[Key], prefix: &str, text: &mut String) -> std::fmt::Result {
    for key in keys {
        let name = format!("{prefix}{}", key.name);
        writeln!(text, "  {name:<12} {} ({})", key.doc, key.describe())?;
        if let KeyKind::Table { keys } | KeyKind::Tables { keys } = key.kind {
            describe_keys(keys, &format!("{name}."), text)?;
        }
    }
    Ok(())
}

fn describe(entry: &Entry, text: &mut String) -> std::fmt::Result {
    writeln!(text, "{}\n  {}\n", entry.kind, entry.summary)?;
    describe_keys(entry.keys, "", text)?;
    writeln!(text)?;
    for line in fact_lines((entry.device)().facts()) {
        writeln!(text, "  {line}")?;
    }
    writeln!(text)
}

/// The computed facts of a device, a line each.
pub fn fact_lines(facts: Vec<Fact>) -> Vec<String> {
    facts
        .into_iter()
        .map(|fact| {
            let value = match fact.value {
                FactValue::Number(number) => format!("{number:.6}"),
                FactValue::Numbers(numbers) => {
                    let parts: Vec<String> = numbers.iter().map(|n| format!("{n:.6}")).collect();
                    parts.join(", ")
                }
            };
            format!("{:<32} {value}", fact.name)
        })
        .collect()
}
