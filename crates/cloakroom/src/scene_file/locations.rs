//! Where the parts of a scene were written.

use std::collections::HashMap;
use std::sync::Arc;

use super::error::SceneFileError;
use super::tree::{Item, Node, Origin, Table};
use crate::keys::KeyError;

/// Where the parts of a scene were written, for everything that turns out to be wrong only later:
/// devices that overlap, a camera inside metal, a photograph that cannot be read.
#[derive(Clone, Debug)]
pub struct Locations {
    name: String,
    text: Arc<str>,
    overrides: Arc<[String]>,
    /// By path, such as `device.1.side`; values for keys, headers for tables.
    places: HashMap<String, Origin>,
}

impl Locations {
    /// The locations of a scene that was written nowhere; `name` stands in its messages.
    pub fn nowhere(name: impl Into<String>) -> Self {
        Locations {
            name: name.into(),
            text: "".into(),
            overrides: [].into(),
            places: HashMap::new(),
        }
    }

    pub(super) fn new(name: &str, text: &str, overrides: &[String], root: &Table) -> Self {
        let mut places = HashMap::new();
        record_table(&mut places, "", root);
        Locations { name: name.to_owned(), text: text.into(), overrides: overrides.into(), places }
    }

    /// An error that points at a part of the scene: `camera.up`, `device.1` (its header) or
    /// `device.1.side` (its value); at the nearest part around it where that one is not written.
    pub fn error_at(&self, path: &str, message: impl Into<String>) -> SceneFileError {
        let mut around = path;
        loop {
            match self.places.get(around) {
                // An override that has made the table around is not to blame for what it does not say.
                Some(Origin::Override(_)) if around != path && !around.starts_with("device") => {}
                Some(origin) => return self.error(origin, message),
                None => {}
            }
            match around.rsplit_once('.') {
                Some((outer, _)) => around = outer,
                None => return SceneFileError::whole(&self.name, message),
            }
        }
    }

    /// An error of a table such as `device.1`, at the key the error names.
    pub fn key_error(&self, table: &str, error: &KeyError) -> SceneFileError {
        self.error_at(&error.path_in(table), &error.message)
    }

    pub(super) fn error(&self, origin: &Origin, message: impl Into<String>) -> SceneFileError {
        match origin {
            Origin::File(span) => {
                SceneFileError::in_text(&self.name, &self.text, span.clone(), message)
            }
            Origin::Override(number) => match self.overrides.get(*number) {
                Some(text) => SceneFileError::in_override(&self.name, text, message),
                None => SceneFileError::whole(&self.name, message),
            },
        }
    }
}

fn record_table(places: &mut HashMap<String, Origin>, path: &str, table: &Table) {
    for entry in &table.entries {
        let path =
            if path.is_empty() { entry.key.clone() } else { format!("{path}.{}", entry.key) };
        record(places, path, &entry.node);
    }
}

fn record(places: &mut HashMap<String, Origin>, path: String, node: &Node) {
    match &node.item {
        Item::Table(table) => record_table(places, &path, table),
        // Of a vector only the whole is pointed at.
        Item::List(items) if items.iter().any(|item| matches!(item.item, Item::Table(_))) => {
            for (i, item) in items.iter().enumerate() {
                record(places, format!("{path}.{i}"), item);
            }
        }
        _ => {}
    }
    places.entry(path).or_insert_with(|| node.origin.clone());
}
