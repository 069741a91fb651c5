//! `cloakroom schema`: all that a scene file can say, for editors or for people.

use crate::arguments::SchemaArguments;
use crate::report::{self, Failure};
use cloakroom::device::CATALOGUE;
use cloakroom::keys::{Key, KeyKind, Limits};
use cloakroom::scene::{Placement, TABLES};
use cloakroom::scene_file;
use std::fmt::{self, Write};

/// Prints the JSON Schema, or the reference page.
pub fn run(arguments: &SchemaArguments) -> Result<(), Failure> {
    if arguments.markdown {
        let mut text = String::new();
        write_reference(&mut text).map_err(Failure::from_error)?;
        return report::print(&text);
    }
    report::print_json(&scene_file::schema())
}

/// Every table with its keys, as a page in Markdown.
fn write_reference(text: &mut String) -> fmt::Result {
    writeln!(text, "# Scene reference\n")?;
    writeln!(
        text,
        "All that a scene file can say, written by `cloakroom schema --markdown`. A scene is TOML; everything but the \
         `kind` of a device has a default. Lengths in cm, angles in degrees, linear colors. Files named in a scene are \
         relative to it. [The guide to scenes](scenes.md) explains how the tables go together.\n"
    )?;
    for (name, keys) in TABLES {
        writeln!(text, "## `[{name}]`\n")?;
        write_table(keys, text)?;
    }
    writeln!(text, "## `[[device]]`\n")?;
    writeln!(text, "Every device takes these keys beside its `kind` and the keys of its kind.\n")?;
    write_table(Placement::KEYS, text)?;
    for entry in CATALOGUE {
        writeln!(text, "## `kind = \"{}\"`\n\n{}\n", entry.kind, entry.summary)?;
        if !entry.keys.is_empty() {
            write_table(entry.keys, text)?;
        }
    }
    // One line break ends the page.
    text.truncate(text.trim_end().len());
    writeln!(text)
}

/// The keys of a table, those of tables within it after them.
fn write_table(keys: &[Key], text: &mut String) -> fmt::Result {
    writeln!(text, "| key | what it is | value | default |\n| --- | --- | --- | --- |")?;
    write_rows(keys, "", text)?;
    writeln!(text)
}

fn write_rows(keys: &[Key], prefix: &str, text: &mut String) -> fmt::Result {
    for key in keys {
        let (allowed, default) = (allowed(key), default(key));
        writeln!(text, "| `{prefix}{}` | {} | {allowed} | {default} |", key.name, key.doc)?;
        if let KeyKind::Table { keys } | KeyKind::Tables { keys } = key.kind {
            write_rows(keys, &format!("{prefix}{}.", key.name), text)?;
        }
    }
    Ok(())
}

/// What values a key takes, with its limits.
fn allowed(key: &Key) -> String {
    match (key.kind, key.limits) {
        // The rows that follow name the keys.
        (KeyKind::Table { .. }, _) => "a table".to_owned(),
        (KeyKind::Tables { .. }, _) => "a list of tables".to_owned(),
        (_, Limits::Finite) => key.describe(),
        (_, limits) => format!("{}, {}", key.describe(), limits.describe()),
    }
}

fn default(key: &Key) -> String {
    match (key.kind, key.default_value()) {
        (KeyKind::Choices { .. } | KeyKind::Tables { .. }, _) => "none".to_owned(),
        (_, Some(value)) => format!("`{value}`"),
        (_, None) => String::new(),
    }
}
