//! The figures of a table, and the names of keys in words.

use crate::device::{CATALOGUE, Imperfection};
use crate::keys::{Key, hint};
use crate::scene::{Placement, TABLES};

/// One figure of a table: what it is called in files, and in words.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Column {
    /// Its name in files, with the unit.
    pub name: String,
    /// What it is, for the axis of a plot.
    pub title: String,
    /// Its unit, as plots write it; empty for a bare number.
    pub unit: &'static str,
}

/// There is no such figure.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no figure `{name}`{hint}")]
pub struct UnknownColumn {
    /// The name asked for.
    name: String,
    /// What may have been meant.
    hint: String,
}

/// The place of a column by its name.
pub(super) fn find_column(columns: &[Column], name: &str) -> Result<usize, UnknownColumn> {
    columns.iter().position(|column| column.name == name).ok_or_else(|| {
        let known: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        UnknownColumn { name: name.to_owned(), hint: hint(name, &known, "known figures") }
    })
}

/// The name of a key in words, and the unit that keys of that name have.
#[must_use]
pub fn name_and_unit(key: &str) -> (String, &'static str) {
    let name = key.rsplit('.').find(|part| part.parse::<usize>().is_err()).unwrap_or(key);
    let unit = unit_of(name);
    // A unit stands behind the name, and not in it.
    let bare = name.strip_suffix(unit).and_then(|bare| bare.strip_suffix('_')).unwrap_or(name);
    let words = bare.replace('_', " ");
    let mut letters = words.chars();
    let title = match letters.next() {
        // The symbols w and h of a map stay small.
        Some(first) if words.len() > 1 => first.to_uppercase().chain(letters).collect(),
        _ => words,
    };
    (title, unit)
}

/// The unit of a key, from the lists of keys.
fn unit_of(name: &str) -> &'static str {
    let devices = CATALOGUE.iter().map(|entry| entry.keys);
    let tables = TABLES.iter().map(|(_, keys)| *keys);
    let keys = devices.chain(tables).chain([Placement::KEYS, Imperfection::KEYS]).flatten();
    let has_unit = |key: &&Key| key.name == name && !key.unit.is_empty();
    let unit = keys.into_iter().find(has_unit).map_or("", |key| key.unit);
    if unit == "degrees" { "°" } else { unit }
}
