//! From the tree of a scene file to the scene.

use std::path::Path;

use super::error::SceneFileError;
use super::locations::Locations;
use super::tree::{Entry, Item, Node, Origin, Table};
use crate::device::{self, CATALOGUE};
use crate::keys::{Key, KeyError, KeyKind, Value, Values, hint, quoted, unknown};
use crate::photograph::ImageSource;
use crate::scene::{
    Camera, CameraSettings, DeviceSettings, Light, PLACEMENT_KEYS, PhotographSettings,
    PictureSettings, Receiver, Scene, SurroundingsSettings, TABLES, TraceSettings,
};

/// The list of devices, the one list of tables a scene has.
pub(super) const DEVICES: &str = "device";
/// The key that says what a device is.
const KIND: &str = "kind";

/// Reads a tree; `source` of the scene is left empty.
pub(super) fn read(
    root: &Table,
    locations: &Locations,
    base_folder: &Path,
) -> Result<Scene, SceneFileError> {
    let mut scene = Scene::default();
    for entry in &root.entries {
        if entry.key == DEVICES {
            scene.devices = devices(entry, locations, base_folder)?;
            continue;
        }
        let Some(&(name, keys)) = TABLES.iter().find(|&&(name, _)| name == entry.key) else {
            return Err(locations.error(&entry.key_origin, unknown_table(entry)));
        };
        let Item::Table(table) = &entry.node.item else {
            let message =
                format!("{name} is {}; it must be a table: [{name}]", entry.node.item.describe());
            return Err(locations.error(&entry.key_origin, message));
        };
        let mut values = [Values::defaults(keys)];
        let place = format!(" in [{name}]");
        fill(&mut values, table, &[], &place, locations, base_folder)?;
        let [values] = values;
        store(&mut scene, name, &values).map_err(|error| locations.key_error(name, &error))?;
    }
    Ok(scene)
}

/// Puts the values of a table where they belong.
fn store(scene: &mut Scene, table: &str, values: &Values) -> Result<(), KeyError> {
    match table {
        "camera" => scene.camera = Camera::new(CameraSettings::from_values(values)?)?,
        "light" => scene.light = Light::from_values(values),
        "photograph" => scene.photograph = PhotographSettings::from_values(values),
        "surroundings" => scene.surroundings = SurroundingsSettings::from_values(values)?,
        "trace" => scene.trace = TraceSettings::from_values(values),
        "picture" => scene.picture = PictureSettings::from_values(values),
        "receiver" => scene.receiver = Receiver::from_values(values)?,
        _ => unreachable!("`{table}` is in the list of tables but not in the scene"),
    }
    Ok(())
}

fn devices(
    entry: &Entry,
    locations: &Locations,
    base_folder: &Path,
) -> Result<Vec<DeviceSettings>, SceneFileError> {
    let wrong = |node: &Node| {
        let message = format!(
            "device is {}; each device is a table of its own: [[device]]",
            node.item.describe()
        );
        locations.error(&node.origin, message)
    };
    let Item::List(items) = &entry.node.item else { return Err(wrong(&entry.node)) };
    let read = |item: &Node| match &item.item {
        Item::Table(table) => device(table, &item.origin, locations, base_folder),
        _ => Err(wrong(item)),
    };
    items.iter().map(read).collect()
}

fn device(
    table: &Table,
    header: &Origin,
    locations: &Locations,
    base_folder: &Path,
) -> Result<DeviceSettings, SceneFileError> {
    let entry = kind(table, header, locations)?;
    let mut values = [Values::defaults(entry.keys), Values::defaults(PLACEMENT_KEYS)];
    let place = format!(" in a {}", entry.kind);
    fill(&mut values, table, &[KIND], &place, locations, base_folder)?;
    let [own, placement] = values;
    Ok(DeviceSettings::from_values(entry, own, &placement))
}

fn kind(
    table: &Table,
    header: &Origin,
    locations: &Locations,
) -> Result<&'static device::Entry, SceneFileError> {
    let known: Vec<&str> = CATALOGUE.iter().map(|entry| entry.kind).collect();
    let Some(entry) = table.get(KIND) else {
        let message = match table.entries.iter().find(|entry| {
            entry.key.eq_ignore_ascii_case(KIND) || entry.key.eq_ignore_ascii_case("type")
        }) {
            Some(entry) => format!("a device's kind is written `kind`, not `{}`", entry.key),
            None => format!("this device has no `kind`; known kinds: {}", known.join(", ")),
        };
        return Err(locations.error(header, message));
    };
    let wrong = |message| Err(locations.error(&entry.node.origin, message));
    let Item::Text(word) = &entry.node.item else {
        let what = entry.node.item.describe();
        return wrong(format!("kind is {what}; it must be one of {}", known.join(", ")));
    };
    match CATALOGUE.iter().find(|entry| entry.kind == word) {
        Some(entry) => Ok(entry),
        None => {
            let hint = hint(word, &known, "known kinds");
            wrong(format!("there is no kind of device {}{hint}", quoted(word, '`')))
        }
    }
}

/// Gives every key of a table to the list that has it.
///
/// `known_besides` are keys that are read elsewhere; `place` such as " in [camera]" is for
/// messages.
fn fill(
    lists: &mut [Values],
    table: &Table,
    known_besides: &[&str],
    place: &str,
    locations: &Locations,
    base_folder: &Path,
) -> Result<(), SceneFileError> {
    for entry in &table.entries {
        if known_besides.contains(&entry.key.as_str()) {
            continue;
        }
        let find = |keys: &'static [Key]| keys.iter().find(|key| key.name == entry.key);
        let found = lists.iter_mut().find_map(|list| Some((find(list.keys())?, list)));
        let Some((key, list)) = found else {
            let known = lists.iter().flat_map(|list| list.keys()).map(|key| key.name);
            let known: Vec<_> = known_besides.iter().copied().chain(known).collect();
            let message = unknown("key", &entry.key, place, &known);
            return Err(locations.error(&entry.key_origin, message));
        };
        if let KeyKind::Tables { keys } = key.kind {
            list.set_tables(key.name, tables(entry, key, keys, locations, base_folder)?);
            continue;
        }
        if let (KeyKind::Table { keys }, Item::Table(_)) = (key.kind, &entry.node.item) {
            list.set_table(key.name, inner_table(&entry.node, key, keys, locations, base_folder)?);
            continue;
        }
        let value = entry.node.item.to_value();
        let set = match value {
            Ok(Value::Text(name))
                if matches!(key.kind, KeyKind::Image { .. }) && !name.is_empty() =>
            {
                let source = ImageSource::parse(&name, folder_of(table, key.name, base_folder));
                source
                    .map(|source| list.set_image(key.name, source))
                    .map_err(|error| error.to_string())
            }
            Ok(Value::Text(name))
                if matches!(key.kind, KeyKind::Samples { .. }) && !name.is_empty() =>
            {
                let file = folder_of(table, key.name, base_folder).join(name);
                match file.into_os_string().into_string() {
                    Ok(file) => list.set(key.name, file).map_err(|error| error.message),
                    Err(_) => Err("the folder's name is not valid Unicode".to_owned()),
                }
            }
            Ok(value) => list.set(key.name, value).map_err(|error| error.message),
            Err(what) => Err(format!("{} is {what}; it must be {}", key.name, key.describe())),
        };
        set.map_err(|message| locations.error(&entry.node.origin, message))?;
    }
    Ok(())
}

/// The tables of a list such as [[device.prism]].
fn tables(
    entry: &Entry,
    key: &Key,
    keys: &'static [Key],
    locations: &Locations,
    base_folder: &Path,
) -> Result<Vec<Values>, SceneFileError> {
    let Item::List(items) = &entry.node.item else {
        return Err(unfit(&entry.node, key, locations));
    };
    items.iter().map(|item| inner_table(item, key, keys, locations, base_folder)).collect()
}

/// A table within a device's.
fn inner_table(
    node: &Node,
    key: &Key,
    keys: &'static [Key],
    locations: &Locations,
    base_folder: &Path,
) -> Result<Values, SceneFileError> {
    let Item::Table(table) = &node.item else { return Err(unfit(node, key, locations)) };
    let mut values = [Values::defaults(keys)];
    let place = format!(" in a {}", key.name);
    fill(&mut values, table, &[], &place, locations, base_folder)?;
    let [values] = values;
    Ok(values)
}

fn unfit(node: &Node, key: &Key, locations: &Locations) -> SceneFileError {
    let what = node.item.describe();
    let message = format!("{} is {what}; it must be {}", key.name, key.describe());
    locations.error(&node.origin, message)
}

/// Names of files are relative to the scene file, those in overrides to the current folder.
fn folder_of<'a>(table: &Table, key: &str, base_folder: &'a Path) -> &'a Path {
    match table.get(key).map(|entry| &entry.node.origin) {
        Some(Origin::Override(_)) => Path::new(""),
        _ => base_folder,
    }
}

/// The message for a name at the top of a scene that is no table of it.
fn unknown_table(entry: &Entry) -> String {
    // A bare key at the top was meant for a table that has it.
    let home = TABLES.iter().find(|(_, keys)| keys.iter().any(|key| key.name == entry.key));
    let home = match home {
        _ if entry.key == KIND => Some("[[device]]".to_owned()),
        home => home.map(|(name, _)| format!("[{name}]")),
    };
    if let Some(home) = home {
        return format!("{} stands outside of its table, {home}", quoted(&entry.key, '`'));
    }
    let known: Vec<_> = TABLES.iter().map(|&(name, _)| name).chain([DEVICES]).collect();
    unknown("table", &entry.key, "", &known)
}
