//! `cloakroom devices`: the catalogue with computed facts.

use crate::report::{self, Result};
use cloakroom::device::{CATALOGUE, Entry, Fact, FactValue, Request, Structure};
use cloakroom::json::json as value_json;
use cloakroom::keys::Key;
use serde_json::{Value, json};
use std::fmt::Write;

/// Prints the catalogue.
pub fn run(json: bool) -> Result<()> {
    if json {
        let list: Vec<Value> = CATALOGUE.iter().map(|entry| as_json(entry)).collect();
        return report::print_json(&json!({ "devices": list }));
    }
    let mut text = String::new();
    for entry in CATALOGUE {
        describe(entry, &mut text)?;
    }
    report::print(&text)
}

fn as_json(entry: &Entry) -> Value {
    let mut object = json!({
        "kind": entry.kind,
        "title": entry.title,
        "summary": entry.summary,
        "keys": keys_as_json(entry.keys),
        "media": (entry.device)().build(Request::default()).map(|structure| structure.media()).unwrap_or_default(),
    });
    for fact in (entry.device)().facts(Request::default()) {
        object[fact.name] = match fact.value {
            FactValue::Number(number) => json!(number),
            FactValue::Numbers(numbers) => json!(numbers),
        };
    }
    object
}

fn keys_as_json(keys: &[Key]) -> Value {
    let key = |key: &Key| {
        let mut object = json!({ "name": key.name, "doc": key.doc, "allowed": key.describe(), "default": (key.default)().map(value_json) });
        if let Some(keys) = key.kind.inner_keys() {
            object["keys"] = keys_as_json(keys);
        }
        object
    };
    keys.iter().map(key).collect()
}

/// Keys by their names; those of a table, or of a list of tables, follow it, as `prism.corners`.
pub fn all_keys(keys: &'static [Key]) -> Vec<(String, &'static Key)> {
    let mut all = Vec::new();
    for key in keys {
        all.push((key.name.to_owned(), key));
        if let Some(keys) = key.kind.inner_keys() {
            let within = all_keys(keys).into_iter();
            all.extend(within.map(|(name, inner)| (format!("{}.{name}", key.name), inner)));
        }
    }
    all
}

fn describe(entry: &Entry, text: &mut String) -> std::fmt::Result {
    writeln!(text, "{}\n  {}\n", entry.kind, entry.summary)?;
    for (name, key) in all_keys(entry.keys) {
        writeln!(text, "  {name:<12} {} ({})", key.doc, key.describe())?;
    }
    writeln!(text)?;
    let device = (entry.device)();
    let media = device.build(Request::default()).ok().and_then(|structure| media_line(&structure));
    for line in media.into_iter().chain(fact_lines(device.facts(Request::default()))) {
        writeln!(text, "  {line}")?;
    }
    writeln!(text)
}

/// How its media were classified, for that decides how long rays take; `None` without media.
pub fn media_line(structure: &Structure) -> Option<String> {
    let media = structure.media();
    let words: Vec<String> =
        media.iter().map(|(class, count)| format!("{count} {class}")).collect();
    (!words.is_empty()).then(|| format!("{:<32} {}", "media", words.join(", ")))
}

/// The computed facts of a device, a line each.
pub fn fact_lines(facts: Vec<Fact>) -> Vec<String> {
    let line = |fact: Fact| {
        let numbers = match fact.value {
            FactValue::Number(number) => vec![number],
            FactValue::Numbers(numbers) => numbers,
        };
        let words: Vec<String> = numbers.iter().map(|n| format!("{n:.6}")).collect();
        format!("{:<32} {}", fact.name, words.join(", "))
    };
    facts.into_iter().map(line).collect()
}
