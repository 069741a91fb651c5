//! `cloakroom schema`: all that a scene file can say, for editors or for people.

use crate::devices::{self, all_keys, allowed};
use crate::report::{self, Result};
use cloakroom::device::CATALOGUE;
use cloakroom::keys::{Key, KeyKind};
use cloakroom::scene::{Placement, TABLES};
use cloakroom::scene_file;
use std::fmt::{self, Write};

/// Prints the JSON Schema, or the reference page.
pub fn run(markdown: bool) -> Result<()> {
    if markdown {
        return report::print(&reference()?);
    }
    report::print_json(&scene_file::schema())
}

/// Every table with its keys, as a page in Markdown.
fn reference() -> Result<String, fmt::Error> {
    let mut text = String::new();
    writeln!(text, "# Scene reference\n")?;
    writeln!(
        text,
        "All that a scene file can say, written by `cloakroom schema --markdown`. A scene is TOML; everything but the \
         `kind` of a device has a default. Lengths in cm, angles in degrees, linear colors. Files named in a scene are \
         relative to it. [The guide to scenes](scenes.md) explains how the tables go together.\n"
    )?;
    for (name, keys) in TABLES {
        writeln!(text, "## `[{name}]`\n")?;
        write_table(keys, &mut text)?;
    }
    writeln!(text, "## `[[device]]`\n")?;
    writeln!(text, "Every device takes these keys beside its `kind` and the keys of its kind.\n")?;
    write_table(Placement::KEYS, &mut text)?;
    for entry in CATALOGUE {
        writeln!(text, "## `kind = \"{}\"`\n\n{}\n", entry.kind, entry.summary)?;
        if !entry.keys.is_empty() {
            write_table(entry.keys, &mut text)?;
        }
    }
    // One line break ends the page.
    Ok(format!("{}\n", text.trim_end()))
}

/// The keys of a table, those of tables within it after them.
fn write_table(keys: &'static [Key], text: &mut String) -> fmt::Result {
    writeln!(text, "| key | what it is | value | default |\n| --- | --- | --- | --- |")?;
    for (name, key) in all_keys(keys) {
        writeln!(text, "| `{name}` | {} | {} | {} |", key.doc, allowed(key), default(key))?;
    }
    writeln!(text)
}

fn default(key: &Key) -> String {
    match devices::default(key) {
        Some(value) => format!("`{value}`"),
        None if matches!(key.kind, KeyKind::Choices { .. } | KeyKind::Tables { .. }) => {
            "none".to_owned()
        }
        None => String::new(),
    }
}
