//! `cloakroom devices`: the catalogue with computed facts.

use crate::arguments::{listed, wrapped};
use crate::report::{self, Failure, Result};
use cloakroom::device::{self, CATALOGUE, Entry, Fact, FactValue, Request, Structure};
use cloakroom::json::json as value_json;
use cloakroom::keys::{Key, KeyKind, ValueRange, hint, quoted};
use cloakroom::scene::{Core, Placement};
use cloakroom_figures::short;
use serde_json::{Value, json};
use std::fmt::Write;

/// Prints the catalogue, or one kind of it.
pub fn run(kind: Option<&str>, json: bool) -> Result<()> {
    let chosen: Vec<&Entry> = match kind {
        None => CATALOGUE.to_vec(),
        Some(kind) => vec![device::entry(kind).ok_or_else(|| {
            let known: Vec<&str> = CATALOGUE.iter().map(|entry| entry.kind).collect();
            let hint = hint(kind, &known, "known kinds");
            Failure::Usage(format!("there is no kind of device {}{hint}", quoted(kind, '`')))
        })?],
    };
    if json {
        let list: Vec<Value> = chosen.iter().map(|entry| as_json(entry)).collect();
        return report::print_json(&json!({ "devices": list }));
    }
    let mut text = String::new();
    for entry in chosen {
        describe(entry, kind.is_some(), &mut text)?;
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
            // No zero has a sign.
            FactValue::Number(number) => json!(number + 0.0),
            FactValue::Numbers(numbers) => numbers.iter().map(|number| number + 0.0).collect(),
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

/// Describes a kind: with `all` also the keys of tables within its keys.
fn describe(entry: &Entry, all: bool, text: &mut String) -> std::fmt::Result {
    writeln!(text, "{}", entry.kind)?;
    writeln!(text, "{}\n", wrapped(entry.summary, "  ", "  "))?;
    let keys = all_keys(entry.keys);
    let shown = keys.iter().filter(|(name, _)| all || !name.contains('.'));
    for (name, key) in shown {
        let default =
            default(key).map_or_else(String::new, |default| format!(" [default: {default}]"));
        let words = format!("{} {}{default}", key.doc, sentence(&allowed(key)));
        text.push_str(&listed(name, 16, &words));
    }
    if all {
        let common = Placement::KEYS.iter().map(|key| key.name);
        let common: Vec<&str> = common.filter(|key| takes(entry, key)).collect();
        let words = format!(
            "It takes these keys of every device, too (`cloakroom schema --markdown`): {}.",
            common.join(", ")
        );
        writeln!(text, "\n{}", wrapped(&words, "  ", "  "))?;
    }
    writeln!(text)?;
    let device = (entry.device)();
    let media = device.build(Request::default()).ok().and_then(|structure| media_line(&structure));
    for line in media.into_iter().chain(fact_lines(device.facts(Request::default()))) {
        writeln!(text, "  {line}")?;
    }
    writeln!(text)
}

/// Whether a kind takes a key that devices have in common: some have no `length` or `core`.
fn takes(entry: &Entry, key: &str) -> bool {
    let asked = match key {
        "length" => Request { length: Some(10.0), ..Request::default() },
        "core" => Request { core: Core::Open, ..Request::default() },
        _ => return true,
    };
    // What is refused for another reason has keys without a default.
    (entry.device)().build(asked).err().is_none_or(|error| error.key != Some(key))
}

/// With a capital letter and a full stop, unless it begins with a quoted word.
fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}

/// What values a key takes, with its limits; a table's keys are told elsewhere.
pub fn allowed(key: &Key) -> String {
    match (key.kind, key.limits) {
        (KeyKind::Table { .. }, _) => "a table".to_owned(),
        (KeyKind::MaterialOrTable { .. }, _) => {
            "the name of a material or of a .yml file, or a table".to_owned()
        }
        (KeyKind::ChoiceNumberOrTable { options, .. }, limits) => {
            let words: Vec<_> = options.iter().map(|word| format!("\"{word}\"")).collect();
            let unit = if key.unit.is_empty() { String::new() } else { format!(" ({})", key.unit) };
            format!("{}, a number{unit} {}, or a table", words.join(", "), limits.describe())
        }
        (KeyKind::FlagOrTable { .. }, _) => "true, false or a table".to_owned(),
        (KeyKind::Tables { .. }, _) => "a list of tables".to_owned(),
        (_, ValueRange::Finite) => key.describe(),
        (_, limits) => format!("{}, {}", key.describe(), limits.describe()),
    }
}

/// What a key is where it is absent; `None` if its absence means something.
pub fn default(key: &Key) -> Option<String> {
    match (key.kind, (key.default)()) {
        (KeyKind::Choices { .. } | KeyKind::Tables { .. }, _) => None,
        (_, value) => value.map(|value| value.to_string()),
    }
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
        let words: Vec<String> = numbers.iter().map(|n| short(*n, 6)).collect();
        format!("{:<32} {}", fact.name, words.join(", "))
    };
    facts.into_iter().map(line).collect()
}
