//! Where the parts of a scene were written.

use std::collections::HashMap;
use std::sync::Arc;

use super::error::{OverrideAtFault, SceneFileError};
use super::overrides::Override;
use super::read::DEVICES;
use crate::keys::{KeyError, Value};
use std::ops::Range;

/// Where something was written.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Origin {
    /// Bytes of the scene file.
    File(Range<usize>),
    /// The override of this number.
    Override(usize),
}

/// Where a key and its value were written; the place of a table is its header.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub key: Origin,
    pub value: Origin,
}

/// The path of a key of the table at `path`.
pub(super) fn join(path: &str, key: &str) -> String {
    // A dot in a key, which no known one has, is none between keys.
    let key = key.replace('.', "\u{1}");
    if path.is_empty() { key } else { format!("{path}.{key}") }
}

/// Where the parts of a scene were written, for everything that turns out to be wrong only later:
/// devices that overlap, a camera inside metal, a photograph that cannot be read.
#[derive(Clone, Debug)]
pub struct Locations {
    name: String,
    pub(super) text: Arc<str>,
    pub(super) overrides: Arc<[Override]>,
    /// By path, such as `device.1.side`.
    places: HashMap<String, Place>,
}

impl Locations {
    pub(super) fn new(name: &str, text: &str, overrides: &[Override]) -> Self {
        let places = HashMap::new();
        Locations { name: name.to_owned(), text: text.into(), overrides: overrides.into(), places }
    }

    /// Keeps the place of the key at a path.
    pub(super) fn tell(&mut self, path: &str, place: Place) {
        self.places.insert(path.to_owned(), place);
    }

    /// A value at a path and all in it is that of the override of this number.
    pub(super) fn tell_override(&mut self, path: &str, value: &Value, number: usize) {
        let origin = || Origin::Override(number);
        let within = join(path, "");
        self.places.retain(|known, _| !known.starts_with(&within));
        self.tell(path, Place { key: origin(), value: origin() });
        for (name, value) in value.as_table().unwrap_or_default() {
            self.tell_override(&join(path, name), value, number);
        }
        for (number_in_list, value) in value.as_list().unwrap_or_default().iter().enumerate() {
            if value.as_table().is_some() {
                self.tell_override(&join(path, &number_in_list.to_string()), value, number);
            }
        }
    }

    /// Whether the value at a path is that of an override.
    pub(super) fn is_overridden(&self, path: &str) -> bool {
        matches!(self.places.get(path), Some(Place { value: Origin::Override(_), .. }))
    }

    /// An error that points at a key.
    pub(super) fn error_at_key(&self, path: &str, message: impl Into<String>) -> SceneFileError {
        match self.places.get(path) {
            Some(place) => self.error(&place.key, message),
            None => SceneFileError::whole(&self.name, message),
        }
    }

    /// An error that points at a part of the scene: `camera.up`, `device.1` (its header) or
    /// `device.1.side` (its value); at the nearest part around it where that one is not written.
    pub fn error_at(&self, path: &str, message: impl Into<String>) -> SceneFileError {
        let around = std::iter::successors(Some(path), |inner| Some(inner.rsplit_once('.')?.0));
        let written = around.filter_map(|at| Some((at, &self.places.get(at)?.value)));
        // An override that has made the table around is not to blame for what it does not say.
        let mut to_blame = written.filter(|(at, origin)| {
            !matches!(origin, Origin::Override(_)) || *at == path || at.starts_with(DEVICES)
        });
        match to_blame.next() {
            Some((_, origin @ Origin::File(_))) if path.starts_with(DEVICES) => {
                let (mut error, set) = (self.error(origin, message), self.device_overrides());
                if let Some(excerpt) = error.excerpt.as_mut().filter(|_| !set.is_empty()) {
                    *excerpt += &format!("\n  with {}", set.join(", "));
                }
                error
            }
            Some((_, origin)) => self.error(origin, message),
            None => SceneFileError::whole(&self.name, message),
        }
    }

    /// What sets keys of devices: a fault between two of them may be that of either.
    fn device_overrides(&self) -> Vec<String> {
        let places = self.places.iter().filter(|(path, _)| path.starts_with(DEVICES));
        let mut numbers: Vec<usize> = places
            .filter_map(|(_, place)| match place.value {
                Origin::Override(number) => Some(number),
                Origin::File(_) => None,
            })
            .collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers.into_iter().map(|number| self.overrides[number].words()).collect()
    }

    /// An error of a table such as `device.1`, at the key the error names.
    pub fn key_error(&self, table: &str, error: &KeyError) -> SceneFileError {
        self.error_at(&error.path_in(table), &error.message)
    }

    /// An error of what is written at a place.
    pub(super) fn error(&self, origin: &Origin, message: impl Into<String>) -> SceneFileError {
        let error = SceneFileError::whole(&self.name, message);
        match origin {
            Origin::File(span) => error.in_text(&self.text, span.clone()),
            Origin::Override(number) => {
                let set = &self.overrides[*number];
                let at_fault = OverrideAtFault { text: set.to_string(), words: set.words() };
                SceneFileError { at_fault: Some(Box::new(at_fault)), ..error }
            }
        }
    }
}
