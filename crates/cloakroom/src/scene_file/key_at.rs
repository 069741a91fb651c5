//! Which key of a scene a path such as `device.0.rotation` names.

use super::read::{DEVICES, KIND};
use crate::device;
use crate::keys::{Key, KeyKind, Value};
use crate::scene::{Placement, TABLES};

/// The key at a path; `root` is the scene, in which the kinds of the devices stand. `None` where the
/// path names no key.
pub(super) fn key_at(root: &Value, path: &[String]) -> Option<&'static Key> {
    let (top, mut rest) = path.split_first()?;
    let mut lists: Vec<&'static [Key]> = if top == DEVICES {
        let (number, keys) = rest.split_first()?;
        rest = keys;
        let device = root.entry(DEVICES)?.as_list()?.get(number.parse::<usize>().ok()?)?;
        let kind = device.entry(KIND).and_then(Value::as_text).and_then(device::entry);
        kind.map(|kind| kind.keys).into_iter().chain([Placement::KEYS]).collect()
    } else {
        TABLES.iter().filter(|(name, _)| name == top).map(|&(_, keys)| keys).collect()
    };
    let mut found: Option<&'static Key> = None;
    for name in rest {
        let in_list = found.is_some_and(|key| matches!(key.kind, KeyKind::Tables { .. }));
        if in_list && name.parse::<usize>().is_ok() {
            continue;
        }
        let key = lists.iter().copied().flatten().find(|key| key.name == name)?;
        lists = key.kind.inner_keys().into_iter().collect();
        found = Some(key);
    }
    found
}
