//! From the values of a scene file to the scene.

use std::path::Path;
use std::sync::Arc;

use super::NamedFiles;
use super::error::SceneFileError;
use super::locations::{Locations, join};
use crate::device::{AnyDevice, CATALOGUE, Request, entry};
use crate::keys::{Key, KeyKind, Table, Value, hint, quoted, synonym, unknown};
use crate::scene::{Camera, CameraSettings, DeviceSettings, Placement, Scene, TABLES};
use cloakroom_trace::key;

/// The list of devices, the one list of tables a scene has.
pub(super) const DEVICES: &str = "device";
/// The key that says what a device is.
pub(super) const KIND: &str = "kind";

/// The entries of a table.
type Entries = [(String, Value)];

/// Reads the tables of a scene; `source` of the scene is left empty.
pub(super) fn read(
    root: &Value,
    locations: &Locations,
    base_folder: &Path,
    files: &NamedFiles,
) -> Result<Scene, SceneFileError> {
    let reader = Reader { locations, base_folder, files };
    let mut scene = Scene::default();
    for (name, value) in root.as_table().unwrap_or_default() {
        if name == DEVICES {
            scene.devices = reader.devices(value)?;
            continue;
        }
        let path = join("", name);
        let mut camera = CameraSettings::default();
        let table: &mut dyn Table = match name.as_str() {
            "camera" => &mut camera,
            "light" => &mut scene.light,
            "photograph" => &mut scene.photograph,
            "surroundings" => &mut scene.surroundings,
            "trace" => &mut scene.trace,
            "picture" => &mut scene.picture,
            "receiver" => &mut scene.receiver,
            _ => return Err(locations.error_at_key(&path, unknown_table(name, root))),
        };
        let Some(entries) = value.as_table() else {
            let message = format!("{name} is {value}; it must be a table: [{name}]");
            return Err(locations.error_at_key(&path, message));
        };
        let held = reader.held(&[table.keys()], entries, &[], name, &format!(" in [{name}]"))?;
        reader.fill(&mut [table], &held, name)?;
        let checked = match name.as_str() {
            "camera" => Camera::new(camera).map(|camera| scene.camera = camera),
            "light" => scene.light.spectrum.lamp(false).map(drop),
            "photograph" => scene.photograph.pose().map(drop),
            "surroundings" => scene.surroundings.check_one(),
            "picture" => scene.picture.check_one_range(),
            "receiver" => scene.receiver.normalize(),
            _ => Ok(()),
        };
        checked.map_err(|error| locations.key_error(name, &error))?;
    }
    for device in &mut scene.devices {
        device.wavelength_nm = scene.light.wavelength_nm();
    }
    scene.material_files = files.materials.read();
    Ok(scene)
}

/// What it takes to read a table.
struct Reader<'a> {
    locations: &'a Locations,
    base_folder: &'a Path,
    files: &'a NamedFiles,
}

impl Reader<'_> {
    fn devices(&self, value: &Value) -> Result<Vec<DeviceSettings>, SceneFileError> {
        let wrong = |path: &str, value: &Value| {
            let message =
                format!("device is {value}; each device is a table of its own: [[device]]");
            self.locations.error_at(path, message)
        };
        let items = value.as_list().ok_or_else(|| wrong(DEVICES, value))?;
        let read = |(number, item): (usize, &Value)| {
            let path = join(DEVICES, &number.to_string());
            self.device(item.as_table().ok_or_else(|| wrong(&path, item))?, &path)
        };
        let devices: Vec<DeviceSettings> =
            items.iter().enumerate().map(read).collect::<Result<_, _>>()?;
        self.check_names(&devices)?;
        Ok(devices)
    }

    /// Refuses names that mean more than one thing.
    fn check_names(&self, devices: &[DeviceSettings]) -> Result<(), SceneFileError> {
        let names = || devices.iter().map(|device| device.placement.name.as_deref());
        for (number, name) in names().enumerate() {
            let Some(name) = name else { continue };
            let message = if let Some(other) = names().take(number).position(|n| n == Some(name)) {
                format!(
                    "device {other} is called {name:?}, too; give each device a name of its own"
                )
            } else if name == DEVICES || TABLES.iter().any(|(table, _)| *table == name) {
                format!("{name:?} is the name of a table of the scene; give the device another one")
            } else {
                continue;
            };
            let path = join(&join(DEVICES, &number.to_string()), key!(Placement.name));
            return Err(self.locations.error_at(&path, message));
        }
        Ok(())
    }

    fn device(&self, entries: &Entries, path: &str) -> Result<DeviceSettings, SceneFileError> {
        let (mut device, mut placement) = (self.kind(entries, path)?, Placement::default());
        let lists = [device.table().keys(), Placement::KEYS];
        let place = format!(" in a {}", device.kind());
        let held = self.held(&lists, entries, &[KIND], path, &place)?;
        self.fill(&mut [device.table_mut(), &mut placement], &held, path)?;
        let index_files = self.files.indices.of(&device);
        let wavelength_nm = Request::DESIGN_WAVELENGTH_NM;
        let settings = DeviceSettings { device, placement, draw: 0, index_files, wavelength_nm };
        settings.pose().map_err(|error| self.locations.key_error(path, &error))?;
        Ok(settings)
    }

    /// A device of the kind that a table asks for.
    fn kind(&self, entries: &Entries, path: &str) -> Result<AnyDevice, SceneFileError> {
        let known: Vec<&str> = CATALOGUE.iter().map(|entry| entry.kind).collect();
        let Some((_, value)) = entries.iter().find(|(name, _)| name == KIND) else {
            let meant = entries
                .iter()
                .map(|(name, _)| name)
                .find(|name| name.eq_ignore_ascii_case(KIND) || name.eq_ignore_ascii_case("type"));
            let message = match meant {
                Some(name) => format!("a device's kind is written `kind`, not `{name}`"),
                None => format!("this device has no `kind`; known kinds: {}", known.join(", ")),
            };
            return Err(self.locations.error_at(path, message));
        };
        let wrong = |message| self.locations.error_at(&join(path, KIND), message);
        let Value::Text(word) = value else {
            let known = known.join(", ");
            return Err(wrong(format!("kind is {value}; it must be one of {known}")));
        };
        let entry = CATALOGUE.iter().find(|entry| entry.kind == word).ok_or_else(|| {
            let hint = hint(word, &known, "known kinds");
            wrong(format!("there is no kind of device {}{hint}", quoted(word, '`')))
        })?;
        Ok((entry.device)())
    }

    /// Holds every entry of the table at `path` against its key in one of the lists.
    ///
    /// `known_besides` are keys that are read elsewhere; `place` such as " in [camera]" is for
    /// messages.
    fn held(
        &self,
        lists: &[&'static [Key]],
        entries: &Entries,
        known_besides: &[&str],
        path: &str,
        place: &str,
    ) -> Result<Vec<(String, Value)>, SceneFileError> {
        let keys = || lists.iter().copied().flatten();
        let own = entries.iter().filter(|(name, _)| !known_besides.contains(&name.as_str()));
        let held = own.map(|(name, value)| {
            let path = join(path, name);
            let Some(key) = keys().find(|key| key.name == name) else {
                let known = keys().map(|key| key.name);
                let known: Vec<_> = known_besides.iter().copied().chain(known).collect();
                let message = unknown("key", name, place, &known);
                return Err(self.locations.error_at_key(&path, message));
            };
            Ok((name.clone(), self.value(key, value, &path)?))
        });
        held.collect()
    }

    /// Holds a value against its key; what is wrong within a table is told at its place there.
    fn value(&self, key: &Key, value: &Value, path: &str) -> Result<Value, SceneFileError> {
        let inner = |keys, value: &Value, path: &str| match value {
            Value::Table(entries) => {
                let held = self.held(&[keys], entries, &[], path, &format!(" in a {}", key.name));
                held.map(Value::Table)
            }
            _ => Err(self.locations.error_at(path, key.wrong_type(value))),
        };
        match (key.kind, value) {
            (KeyKind::Table { keys }, _)
            | (
                KeyKind::FlagOrTable { keys }
                | KeyKind::MaterialOrTable { keys }
                | KeyKind::ChoiceNumberOrTable { keys, .. },
                Value::Table(_),
            ) => inner(keys, value, path),
            (KeyKind::Tables { keys }, Value::List(items)) => {
                let items = items.iter().enumerate();
                let held = items.map(|(i, item)| inner(keys, item, &join(path, &i.to_string())));
                held.collect::<Result<_, _>>().map(Value::List)
            }
            _ => key.check(value).map_err(|message| self.locations.error_at(path, message)),
        }
    }

    /// Gives each value to the table that has its key, makes names of files relative to the scene
    /// file (those in overrides are relative to the current folder), and reads materials.
    fn fill(
        &self,
        tables: &mut [&mut dyn Table],
        held: &Entries,
        path: &str,
    ) -> Result<(), SceneFileError> {
        for (name, value) in held {
            // One of them has the key, for the value has been held against it.
            tables.iter_mut().any(|table| table.put(name, value));
        }
        let mut fault = None;
        for table in tables {
            table.visit_files(path, &mut |path, file| {
                if !self.locations.is_overridden(path) {
                    *file.path = self.base_folder.join(&*file.path);
                }
                if let Some(material) = file.material {
                    match self.files.materials.at(file.path) {
                        Ok(read) => *material = Some(Arc::clone(&read.material)),
                        Err(message) => fault = fault.take().or(Some((path.to_owned(), message))),
                    }
                }
            });
        }
        fault.map_or(Ok(()), |(path, message)| Err(self.locations.error_at(&path, message)))
    }
}

/// The message for a name at the top of a scene that is no table of it.
fn unknown_table(name: &str, root: &Value) -> String {
    let word = quoted(name, '`');
    // A bare key at the top was meant for a table that has it, or calls it otherwise, or for a device.
    let devices = places_of_devices(root);
    let is_key = |(_, keys): &(String, Vec<&str>)| keys.contains(&name);
    let home = TABLES.iter().find(|(_, keys)| keys.iter().any(|key| key.name == name));
    let home = match home {
        _ if name == KIND => Some("[[device]]".to_owned()),
        home => home.map(|(name, _)| format!("[{name}]")),
    };
    if let Some(home) = home {
        return format!("{word} stands outside of its table, {home}");
    }
    if let Some((place, _)) = devices.iter().find(|device| is_key(device)) {
        return format!("{word} is a key of devices, as in {place}.{name}");
    }
    let tables = TABLES.iter().map(|&(table, keys)| {
        (table.to_owned(), keys.iter().map(|key| key.name).collect::<Vec<_>>())
    });
    let meant = tables
        .chain(devices)
        .find_map(|(place, keys)| synonym(name, &keys).map(|key| format!("{place}.{key}")));
    if let Some(meant) = meant {
        return format!("there is no {word}; here it is called `{meant}`");
    }
    let devices = root.entry(DEVICES).and_then(Value::as_list).unwrap_or_default().iter();
    let names = devices.filter_map(|device| device.entry(key!(Placement.name))?.as_text());
    let tables = TABLES.iter().map(|&(name, _)| name).chain([DEVICES]);
    unknown("table", name, "", &tables.chain(names).collect::<Vec<_>>())
}

/// Where the devices of a scene are, as in `device.0`, and the keys of each; of a scene without devices where
/// one would be.
fn places_of_devices(root: &Value) -> Vec<(String, Vec<&'static str>)> {
    let devices = root.entry(DEVICES).and_then(Value::as_list).unwrap_or_default();
    let kinds = devices.iter().map(|device| device.entry(KIND).and_then(Value::as_text));
    let kinds: Vec<Option<&str>> = if devices.is_empty() { vec![None] } else { kinds.collect() };
    let keys = |kind: Option<&str>| {
        let own = kind.and_then(entry).map_or(&[][..], |entry| entry.keys);
        Placement::KEYS.iter().chain(own).map(|key| key.name).collect()
    };
    let placed = kinds.into_iter().enumerate();
    placed.map(|(number, kind)| (join(DEVICES, &number.to_string()), keys(kind))).collect()
}
