//! Overrides: `camera.samples=16` sets one key of a scene.

use super::error::SceneFileError;
use super::locations::{Locations, Origin, join};
use super::read::DEVICES;
use super::tree::{parse_value, to_toml};
use crate::keys::{Value, quoted};
use crate::scene::Placement;
use cloakroom_trace::key;
use std::fmt;
use std::sync::Arc;

/// The deepest key there is; anything deeper is refused before a tree of it is built.
const DEEPEST: usize = 16;

/// What is set in a scene: one key.
#[derive(Clone, Debug, PartialEq)]
pub enum Override {
    /// As text, `camera.samples=16`.
    Text(String),
    /// As a key and its value.
    Value {
        /// The key, as in `device.0.rotation`.
        key: String,
        /// What it is to be.
        value: Value,
    },
}

impl From<&str> for Override {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Override {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) => f.write_str(text),
            Self::Value { key, value } => write!(f, "{key}={}", to_toml(value)),
        }
    }
}

/// Applies overrides to a scene, in order.
pub(super) fn apply(root: &mut Value, locations: &mut Locations) -> Result<(), SceneFileError> {
    for (number, each) in Arc::clone(&locations.overrides).iter().enumerate() {
        apply_one(root, each, number, locations)
            .map_err(|message| locations.error(&Origin::Override(number), message))?;
    }
    Ok(())
}

fn apply_one(
    root: &mut Value,
    each: &Override,
    number: usize,
    locations: &mut Locations,
) -> Result<(), String> {
    let (path, written) = match each {
        Override::Value { key, value } => (key.as_str(), Ok(value)),
        Override::Text(text) => text
            .split_once('=')
            .map(|(path, value)| (path, Err(value.trim())))
            .ok_or("an override is written KEY=VALUE, such as camera.samples=16")?,
    };
    let mut path: Vec<String> = path.split('.').map(|key| key.trim().to_owned()).collect();
    if path.iter().any(String::is_empty) {
        return Err("a key is missing; write it as in camera.samples=16".to_owned());
    }
    if path.len() > DEEPEST {
        return Err("no key lies that deep".to_owned());
    }
    if let Some((parts, device)) = called(root, &path) {
        path.splice(..parts, [DEVICES.to_owned(), device.to_string()]);
    }
    let value = written.map_or_else(parse_value, |value| Ok(value.clone()))?;
    let mut walked = String::new();
    let mut place = root;
    // The first part of the path that was not there.
    let mut made = None;
    for (i, key) in path.iter().enumerate() {
        let next = path.get(i + 1).map(String::as_str);
        let (inner, new) = match place {
            Value::Table(entries) => descend(entries, key, next, &mut walked)?,
            Value::List(items) => entry(items, key, &mut walked)?,
            scalar => {
                let key = quoted(key, '`');
                return Err(format!("{walked} is {scalar}; there is no {key} in it"));
            }
        };
        place = inner;
        if new && made.is_none() {
            made = Some(i);
        }
    }
    *place = value;
    let parts = |count: usize| path[..count].iter().fold(String::new(), |all, key| join(&all, key));
    // Tables made on the way are the override's, too.
    for count in made.map_or(path.len(), |made| made + 1)..path.len() {
        locations.tell_override(&parts(count), &Value::Table(Vec::new()), number);
    }
    locations.tell_override(&parts(path.len()), place, number);
    Ok(())
}

/// The device that a path calls by its name, `left.rotation` or `device.left.rotation`: how many
/// parts of the path say so, and the device's number.
fn called(root: &Value, path: &[String]) -> Option<(usize, usize)> {
    let parts = if path[0] == DEVICES { 2 } else { 1 };
    let name = path.get(parts - 1)?;
    let (_, devices) = root.as_table()?.iter().find(|(key, _)| key == DEVICES)?;
    let is_called = |device: &Value| {
        let mut entries = device.as_table().unwrap_or_default().iter();
        entries.any(|(key, value)| key == key!(Placement.name) && value.as_text() == Some(name))
    };
    Some((parts, devices.as_list()?.iter().position(is_called)?))
}

/// The value of a key, made if it is not there, and whether it was; `next` is the key after it.
fn descend<'a>(
    entries: &'a mut Vec<(String, Value)>,
    key: &str,
    next: Option<&str>,
    walked: &mut String,
) -> Result<(&'a mut Value, bool), String> {
    let top = walked.is_empty();
    if !top {
        walked.push('.');
    }
    walked.push_str(key);
    let counted = next.is_some_and(|next| next.parse::<usize>().is_ok());
    let devices = top && key == DEVICES;
    let known = entries.iter().position(|(name, _)| name == key);
    if counted && !devices && known.is_none() {
        return Err(format!(
            "{walked} is not written in the scene, so an entry of it cannot be set alone; set \
             all of it: {walked}=[...]"
        ));
    }
    let index = known.unwrap_or(entries.len());
    if known.is_none() {
        let new = if devices { Value::List(Vec::new()) } else { Value::Table(Vec::new()) };
        entries.push((key.to_owned(), new));
    }
    Ok((&mut entries[index].1, known.is_none()))
}

/// An entry of a list by its number, and whether it was made: the number after the last adds a
/// table to a list of tables.
fn entry<'a>(
    items: &'a mut Vec<Value>,
    key: &str,
    walked: &mut String,
) -> Result<(&'a mut Value, bool), String> {
    let tables = items.iter().all(|item| item.as_table().is_some());
    let count = items.len();
    let Ok(index) = key.parse::<usize>() else {
        return Err(format!(
            "{} is not a number; the entries of {walked} are counted from 0: {walked}.0",
            quoted(key, '`')
        ));
    };
    if index > count || (index == count && !tables) {
        let there = match count {
            0 => format!("{walked} has no entries"),
            1 => format!("{walked} has one entry, {walked}.0"),
            _ => format!("{walked} has the entries 0 to {}", count - 1),
        };
        let add = if tables { format!("; {walked}.{count} would add one") } else { String::new() };
        return Err(format!("there is no {walked}.{index}: {there}{add}"));
    }
    if index == count {
        items.push(Value::Table(Vec::new()));
    }
    walked.push('.');
    walked.push_str(&index.to_string());
    Ok((&mut items[index], index == count))
}
