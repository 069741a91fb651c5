//! Scenes from pages: JSON tables in, a scene out, and no way to a file that the user has not opened.

use crate::protocol::SceneTables;
use cloakroom::keys::{KeyKind, Sampled};
use cloakroom::photograph::ImageSource;
use cloakroom::scene::{DeviceSettings, Scene, SurroundingsSettings};
use cloakroom::scene_file::{self, Loaded};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Weakest branches that a page may ask for.
const LEAST_POWER: f64 = 1e-7;

/// Finest tolerance that a page may ask for, cm.
const LEAST_TOLERANCE: f64 = 1e-9;

/// Where a scene names its photograph.
const PHOTOGRAPH: &str = "/photograph/image";

/// What scenes from pages are called in messages.
const NAME: &str = "scene";

/// The scene that pages begin with, and the folder and the files that came with it.
#[derive(Clone, Debug)]
pub(crate) struct Opened {
    /// Its tables.
    pub tables: Value,
    /// What it is called.
    pub name: String,
    folder: PathBuf,
    /// The files that it names.
    files: Vec<PathBuf>,
}

impl Opened {
    /// A scene that the user has opened; names of files in it are relative to `folder`.
    ///
    /// # Errors
    ///
    /// If its text cannot be read as TOML, which it has been read as before.
    pub fn new(loaded: &Loaded, name: &str, folder: &Path) -> Result<Self, String> {
        let mut tables = Value::Object(tables(&loaded.scene.source)?);
        let mut known = Vec::new();
        for (place, path) in files(&loaded.scene) {
            let absolute = std::path::absolute(&path).unwrap_or_else(|_| path.clone());
            // A file named in an override is relative to where the user is.
            if let Some(entry) = tables.pointer_mut(&place)
                && entry.as_str().is_some_and(|text| folder.join(text) != path)
            {
                *entry = absolute.display().to_string().into();
            }
            known.extend([path, absolute]);
        }
        Ok(Self { tables, name: name.to_owned(), folder: folder.to_owned(), files: known })
    }

    /// Where a photograph of that name would lie, were it a file of the scene's folder. Uploaded ones are hung up
    /// under this name and never looked for.
    pub fn source_of(&self, name: &str) -> ImageSource {
        ImageSource::File(self.folder.join(name))
    }

    /// Reads the scene of a page. `uploaded` is the photograph that the page has brought.
    ///
    /// # Errors
    ///
    /// One message: what is wrong in the scene, or that it names a file it may not.
    pub fn read(
        &self,
        scene: &SceneTables,
        uploaded: Option<&ImageSource>,
    ) -> Result<Loaded, String> {
        let text = text(scene)?;
        let mut loaded = scene_file::parse(&text, NAME, &self.folder, &[])
            .map_err(|error| error.message.clone())?;
        // What the page has brought is the photograph and nothing else: on a body or around the scene a file of that
        // name would be looked for.
        let brought = uploaded == Some(&loaded.scene.photograph.image);
        let known = |(place, path): (String, PathBuf)| {
            self.files.contains(&path) || (brought && place == PHOTOGRAPH)
        };
        if !files(&loaded.scene).into_iter().all(known) {
            return Err(
                "a page can show the images, and take the grids, that came with the program or with the scene that \
                 was opened, and a photograph dropped onto it; it can open no file"
                    .to_owned(),
            );
        }
        let trace = &mut loaded.scene.trace;
        trace.min_power = trace.min_power.max(LEAST_POWER);
        trace.tolerance = trace.tolerance.max(LEAST_TOLERANCE);
        Ok(loaded)
    }
}

/// The tables of a scene file as JSON.
///
/// # Errors
///
/// If it is no TOML.
pub(crate) fn tables(source: &str) -> Result<SceneTables, String> {
    let table: toml::Table = toml::from_str(source).map_err(|error| error.to_string())?;
    match serde_json::to_value(table) {
        Ok(Value::Object(tables)) => Ok(tables),
        Ok(_) => Err("a scene is a table".to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

/// The text of a scene file.
///
/// # Errors
///
/// If the JSON says what TOML cannot.
pub(crate) fn text(scene: &SceneTables) -> Result<String, String> {
    let mut table = toml::Table::new();
    for (key, value) in scene {
        table.insert(key.clone(), value_of(value)?);
    }
    toml::to_string_pretty(&table).map_err(|error| error.to_string())
}

fn value_of(value: &Value) -> Result<toml::Value, String> {
    Ok(match value {
        Value::Null => {
            return Err("null stands for nothing in a scene; leave the key out".to_owned());
        }
        Value::Bool(flag) => (*flag).into(),
        Value::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(integer), _) => integer.into(),
            (None, Some(float)) => float.into(),
            (None, None) => return Err(format!("{number} is no number of a scene")),
        },
        Value::String(text) => text.as_str().into(),
        Value::Array(items) => {
            toml::Value::Array(items.iter().map(value_of).collect::<Result<_, _>>()?)
        }
        Value::Object(entries) => {
            let mut table = toml::Table::new();
            for (key, value) in entries {
                table.insert(key.clone(), value_of(value)?);
            }
            table.into()
        }
    })
}

/// Every file that a scene names, images and grids, and where its tables name it: a JSON pointer.
fn files(scene: &Scene) -> Vec<(String, PathBuf)> {
    let mut files = Vec::new();
    if let ImageSource::File(path) = &scene.photograph.image {
        files.push((PHOTOGRAPH.to_owned(), path.clone()));
    }
    if let SurroundingsSettings::Image(ImageSource::File(path)) = &scene.surroundings {
        files.push(("/surroundings/image".to_owned(), path.clone()));
    }
    for (number, device) in scene.devices.iter().enumerate() {
        if let Some(ImageSource::File(path)) = body_image(device) {
            files.push((format!("/device/{number}/surface/image"), path));
        }
        let keys = device.entry.keys.iter();
        for key in keys.filter(|key| matches!(key.kind, KeyKind::Samples { .. })) {
            if let Some(Sampled::InFile(file)) = device.values.samples(key.name) {
                files.push((format!("/device/{number}/{}", key.name), file.into()));
            }
        }
    }
    files
}

/// The image on an opaque body.
fn body_image(device: &DeviceSettings) -> Option<ImageSource> {
    const SURFACE: &str = "surface";
    device.entry.keys.iter().find(|key| key.name == SURFACE)?;
    device.values.table(SURFACE)?.optional_image("image").cloned()
}

/// A file's name without folders, as a photograph may have.
pub(crate) fn is_plain_name(name: &str) -> bool {
    !name.is_empty()
        && name.len() <= 200
        && !name.starts_with(['.', '-'])
        && !name.contains(['/', '\\', ':', '\0'])
        && !name.chars().any(char::is_control)
}

#[cfg(test)]
mod tests;
