//! Overrides: `camera.samples=16` sets one key of a scene, `device.*.rotation=5` that of every device.

use super::error::SceneFileError;
use super::key_at::key_at;
use super::locations::{Locations, Origin, join};
use super::read::{DEVICES, KIND};
use super::tree::{parse_value, to_toml};
use crate::keys::{Key, KeyKind, Value, hint, quoted};
use crate::scene::Placement;
use cloakroom_trace::key;
use std::fmt;
use std::sync::Arc;

/// The deepest key there is; anything deeper is refused before a tree of it is built.
const DEEPEST: usize = 16;

/// What people call the entries of places and directions.
const COORDINATES: [&str; 3] = ["x", "y", "z"];

/// What is set in a scene: one key.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    setting: Setting,
    /// The words that set it, if not `--set` and what it displays as.
    words: Option<String>,
}

#[derive(Clone, Debug, PartialEq)]
enum Setting {
    /// As text, `camera.samples=16`.
    Text(String),
    /// As a key, as in `device.0.rotation`, and what it is to be.
    Value(String, Value),
}

impl Override {
    /// A key, as in `device.0.rotation`, and its value.
    pub fn value(key: impl Into<String>, value: impl Into<Value>) -> Self {
        Self { setting: Setting::Value(key.into(), value.into()), words: None }
    }

    /// The same, set by other words on the command line than `--set`, as in `--photo room.png`:
    /// messages say those.
    #[must_use]
    pub fn by(self, words: String) -> Self {
        Self { words: Some(words), ..self }
    }

    /// The words on the command line that set it.
    pub(super) fn words(&self) -> String {
        self.words.clone().unwrap_or_else(|| format!("--set {self}"))
    }
}

impl From<&str> for Override {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

impl From<String> for Override {
    fn from(text: String) -> Self {
        Self { setting: Setting::Text(text), words: None }
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.setting {
            Setting::Text(text) => f.write_str(text),
            Setting::Value(key, value) => write!(f, "{key}={}", to_toml(value)),
        }
    }
}

/// Applies overrides to a scene, in order.
pub(super) fn apply(root: &mut Value, locations: &mut Locations) -> Result<(), SceneFileError> {
    let mut added = Vec::new();
    for (number, each) in Arc::clone(&locations.overrides).iter().enumerate() {
        let told = |message| locations.error(&Origin::Override(number), message);
        let (mut path, value) = key_and_value(root, each).map_err(told)?;
        if let Some((parts, device)) = called(root, &path) {
            path.splice(..parts, [DEVICES.to_owned(), device.to_string()]);
        }
        let mut paths = Vec::new();
        expand(Some(root), &path, &mut Vec::new(), &mut paths).map_err(told)?;
        for path in paths {
            let value = value.clone();
            let device = apply_one(root, &path, value, number, locations)
                .map_err(|message| locations.error(&Origin::Override(number), message))?;
            added.extend(device.map(|device| (device, number)));
        }
    }
    // Its kind may come after its other keys.
    let devices = root.entry(DEVICES).and_then(Value::as_list).unwrap_or_default();
    for (device, number) in added {
        let is_table = devices.get(device).is_some_and(|device| device.as_table().is_some());
        if is_table && devices[device].entry(KIND).is_none() {
            let message = not_there(DEVICES, device, device, true);
            return Err(locations.error(&Origin::Override(number), message));
        }
    }
    Ok(())
}

/// The parts of an override's key, and its value.
fn key_and_value(root: &Value, each: &Override) -> Result<(Vec<String>, Value), String> {
    let (path, given) = match &each.setting {
        Setting::Value(key, value) => (key.as_str(), Ok(value)),
        Setting::Text(text) => {
            let (path, text) = text
                .split_once('=')
                .ok_or("an override is written KEY=VALUE, such as camera.samples=16")?;
            (path, Err(text.trim()))
        }
    };
    let path: Vec<String> = path.split('.').map(|key| key.trim().to_owned()).collect();
    let words = given.map_or_else(Some, Value::as_text);
    let value = match (words.and_then(|words| pair(key_at(root, &path), words)), given) {
        (Some(pair), _) => pair,
        (None, Ok(value)) => Ok(value.clone()),
        (None, Err(text)) => parse_value(text),
    };
    if path.iter().any(String::is_empty) {
        return Err("a key is missing; write it as in camera.samples=16".to_owned());
    }
    if path.iter().any(|key| key.ends_with(']')) {
        let dotted = path.join(".").replace('[', ".").replace(['"', '\'', ']'], "");
        return Err(format!("entries of lists follow a dot: {}", quoted(&dotted, '`')));
    }
    if path.len() > DEEPEST {
        return Err("no key lies that deep".to_owned());
    }
    Ok((path, value?))
}

/// The paths that one stands for in which `*` is every entry of a list; `place` is what is at `done`.
fn expand(
    place: Option<&Value>,
    rest: &[String],
    done: &mut Vec<String>,
    paths: &mut Vec<Vec<String>>,
) -> Result<(), String> {
    let Some((key, rest)) = rest.split_first() else {
        paths.push(done.clone());
        return Ok(());
    };
    let items = place.and_then(Value::as_list);
    if key == "*" {
        let count = items.map_or(0, <[_]>::len);
        if count == 0 {
            let list = done.join(".");
            return Err(format!("there is no {list}.*: {}", entries(&list, 0)));
        }
        for number in 0..count {
            done.push(number.to_string());
            expand(items.and_then(|items| items.get(number)), rest, done, paths)?;
            done.pop();
        }
        return Ok(());
    }
    let next = match items {
        Some(items) => key.parse().ok().and_then(|number: usize| items.get(number)),
        None => place.and_then(|place| place.entry(key)),
    };
    done.push(key.clone());
    expand(next, rest, done, paths)?;
    done.pop();
    Ok(())
}

/// Sets the key at a path; the number of the device that is made for it, if one is.
fn apply_one(
    root: &mut Value,
    path: &[String],
    value: Value,
    number: usize,
    locations: &mut Locations,
) -> Result<Option<usize>, String> {
    // What a list is that the scene does not write: an entry of it can be set alone.
    let is_list = |end: usize| path.get(end).is_some_and(|next| next.parse::<usize>().is_ok());
    // Its entries have no names, which is told where they are looked for.
    let is_named = |end: usize| path.get(end).is_some_and(|next| COORDINATES.contains(&&**next));
    let unwritten: Vec<Option<Value>> = (1..=path.len())
        .map(|end| {
            key_at(root, &path[..end])
                .filter(|_| is_list(end) || is_named(end))
                .and_then(|k| (k.default)())
        })
        .collect();
    let mut walked = String::new();
    let mut place = root;
    // The first part of the path that was not there.
    let mut made = None;
    for (i, (key, unwritten)) in path.iter().zip(unwritten).enumerate() {
        let (inner, new) = match place {
            Value::Table(entries) => descend(entries, key, is_list(i + 1), unwritten, &mut walked)?,
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
    let device = made.filter(|made| *made <= 1 && path[0] == DEVICES).and(path.get(1));
    Ok(device.and_then(|device| device.parse().ok()))
}

/// The device that a path calls by its name, `left.rotation` or `device.left.rotation`: how many
/// parts of the path say so, and the device's number.
fn called(root: &Value, path: &[String]) -> Option<(usize, usize)> {
    let parts = if path[0] == DEVICES { 2 } else { 1 };
    let name = path.get(parts - 1)?;
    let devices = root.entry(DEVICES).and_then(Value::as_list)?;
    let called =
        |device: &Value| device.entry(key!(Placement.name)).and_then(Value::as_text) == Some(name);
    Some((parts, devices.iter().position(called)?))
}

/// A resolution as people type it, 640x480; `None` where the key is another or a list is written.
fn pair(key: Option<&Key>, text: &str) -> Option<Result<Value, String>> {
    let text = text.trim_matches(['"', '\'', ' ']);
    let is_pair = key.is_some_and(|key| matches!(key.kind, KeyKind::IntegerPair));
    if !is_pair || text.starts_with('[') {
        return None;
    }
    let side = |text: &str| text.trim().parse::<i64>().ok();
    let sides = text.split_once(['x', 'X', '×']);
    let pair = sides.and_then(|(width, height)| Some([side(width)?, side(height)?]));
    Some(pair.map(Value::from).ok_or_else(|| {
        format!("{} is no width and height; write them as in 640x480", quoted(text, '`'))
    }))
}

/// The value of a key, made if it is not there, and whether it was. One of which an entry is set is
/// made what it is where it is not written.
fn descend<'a>(
    entries: &'a mut Vec<(String, Value)>,
    key: &str,
    is_list: bool,
    unwritten: Option<Value>,
    walked: &mut String,
) -> Result<(&'a mut Value, bool), String> {
    let top = walked.is_empty();
    if !top {
        walked.push('.');
    }
    walked.push_str(key);
    let devices = top && key == DEVICES;
    let known = entries.iter().position(|(name, _)| name == key);
    let index = known.unwrap_or(entries.len());
    if known.is_none() {
        let new = match unwritten.filter(|value| value.as_list().is_some()) {
            Some(value) => value,
            None if devices => Value::List(Vec::new()),
            // What is no table at all is told where the scene is read.
            None if is_list && !top => {
                return Err(format!(
                    "{walked} is not written in the scene, so an entry of it cannot be set alone; \
                     set all of it: {walked}=[...]"
                ));
            }
            None => Value::Table(Vec::new()),
        };
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
        let (word, key) = (key, quoted(key, '`'));
        let axis = COORDINATES.iter().position(|axis| *axis == word).filter(|i| *i < count);
        if let Some(number) = axis {
            return Err(format!(
                "the entries of {walked} have numbers and no names: {walked}.{number}"
            ));
        }
        if walked.as_str() != DEVICES {
            return Err(format!(
                "{key} is not a number; the entries of {walked} are counted from 0: {walked}.0"
            ));
        }
        let names = items.iter().filter_map(|item| item.entry(key!(Placement.name))?.as_text());
        let hint = hint(word, &names.collect::<Vec<_>>(), "there are");
        return Err(format!(
            "no device is called {key}; devices are counted from 0, as in {walked}.0, and {walked}.* is \
             every one{hint}"
        ));
    };
    if index > count || (index == count && !tables) {
        return Err(not_there(walked, index, count, tables));
    }
    if index == count {
        items.push(Value::Table(Vec::new()));
    }
    walked.push('.');
    walked.push_str(&index.to_string());
    Ok((&mut items[index], index == count))
}

/// The message about an entry of a list that has so many others, to which one may be added if
/// `grows`.
fn not_there(list: &str, index: usize, count: usize, grows: bool) -> String {
    let add = match list {
        _ if !grows => String::new(),
        DEVICES => format!("; {list}.{count}.{KIND}=... would add one"),
        _ => format!("; {list}.{count} would add one"),
    };
    format!("there is no {list}.{index}: {}{add}", entries(list, count))
}

/// What entries a list has.
fn entries(list: &str, count: usize) -> String {
    match (list, count) {
        (DEVICES, 0) => "the scene has no devices".to_owned(),
        (DEVICES, 1) => format!("the scene has one device, {list}.0"),
        (DEVICES, _) => format!("the scene has {count} devices, {list}.0 to {list}.{}", count - 1),
        (_, 0) => format!("{list} has no entries"),
        (_, 1) => format!("{list} has one entry, {list}.0"),
        _ => format!("{list} has the entries 0 to {}", count - 1),
    }
}
