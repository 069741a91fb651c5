//! Overrides: `camera.samples=16` sets one key of a scene.

use super::error::SceneFileError;
use super::read::DEVICES;
use super::tree::{Item, Node, Origin, Table, parse_value};
use crate::keys::quoted;

/// The deepest key there is; anything deeper is refused before a tree of it is built.
const DEEPEST: usize = 16;

/// Applies overrides to a scene, in order.
pub(super) fn apply(
    root: &mut Table,
    overrides: &[String],
    name: &str,
) -> Result<(), SceneFileError> {
    for (number, text) in overrides.iter().enumerate() {
        apply_one(root, text, Origin::Override(number))
            .map_err(|message| SceneFileError::in_override(name, text, message))?;
    }
    Ok(())
}

fn apply_one(root: &mut Table, text: &str, origin: Origin) -> Result<(), String> {
    let Some((path, value)) = text.split_once('=') else {
        return Err("an override is written KEY=VALUE, such as camera.samples=16".to_owned());
    };
    let path: Vec<&str> = path.split('.').map(str::trim).collect();
    if path.iter().any(|key| key.is_empty()) {
        return Err("a key is missing; write it as in camera.samples=16".to_owned());
    }
    if path.len() > DEEPEST {
        return Err("no key lies that deep".to_owned());
    }
    let value = parse_value(value.trim(), &origin)?;

    let mut walked = String::new();
    let (first, rest) = path.split_first().ok_or("a key is missing")?;
    let mut place = descend(root, first, rest.first().copied(), &mut walked, &origin)?;
    for (i, key) in rest.iter().enumerate() {
        let next = rest.get(i + 1).copied();
        place = match &mut place.item {
            Item::Table(table) => descend(table, key, next, &mut walked, &origin)?,
            Item::List(items) => entry(items, key, &mut walked, &origin)?,
            scalar => {
                let what = scalar.describe();
                let key = quoted(key, '`');
                return Err(format!("{walked} is {what}; there is no {key} in it"));
            }
        };
    }
    *place = value;
    Ok(())
}

/// The node of a key, made if it is not there; `next` is the key after it.
fn descend<'a>(
    table: &'a mut Table,
    key: &str,
    next: Option<&str>,
    walked: &mut String,
    origin: &Origin,
) -> Result<&'a mut Node, String> {
    let top = walked.is_empty();
    if !top {
        walked.push('.');
    }
    walked.push_str(key);
    let counted = next.is_some_and(|next| next.parse::<usize>().is_ok());
    let devices = top && key == DEVICES;
    if counted && !devices && table.get(key).is_none() {
        return Err(format!(
            "{walked} is not written in the scene, so an entry of it cannot be set alone; set \
             all of it: {walked}=[...]"
        ));
    }
    let new = || if devices { Item::List(Vec::new()) } else { Item::Table(Table::default()) };
    Ok(table.get_or_insert(key, origin, new))
}

/// An entry of a list by its number; the number after the last adds a table to a list of tables.
fn entry<'a>(
    items: &'a mut Vec<Node>,
    key: &str,
    walked: &mut String,
    origin: &Origin,
) -> Result<&'a mut Node, String> {
    let tables = items.iter().all(|node| matches!(node.item, Item::Table(_)));
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
        items.push(Node { origin: origin.clone(), item: Item::Table(Table::default()) });
    }
    walked.push('.');
    walked.push_str(&index.to_string());
    Ok(&mut items[index])
}
