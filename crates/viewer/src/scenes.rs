//! Scenes from pages: JSON tables in, a scene out, and no way to a file that the user has not
//! opened.

use crate::protocol::SceneTables;
use cloakroom::index_file::IndexFile;
use cloakroom::json;
use cloakroom::material_file::MaterialFile;
use cloakroom::photograph::ImageSource;
use cloakroom::scene_file::{self, Loaded};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Weakest branches that a page may ask for.
const LEAST_POWER: f64 = 1e-7;

/// Finest tolerance that a page may ask for, cm.
const LEAST_TOLERANCE: f64 = 1e-9;

/// Where a scene names its photograph.
const PHOTOGRAPH: &str = "photograph.image";

/// What scenes from pages are called in messages.
const NAME: &str = "scene";

/// The scene that pages begin with, and the folder and the files that came with it.
#[derive(Clone, Debug)]
pub struct Opened {
    /// Its tables.
    pub tables: Value,
    /// What it is called.
    pub name: String,
    folder: PathBuf,
    /// The files that it names.
    files: Vec<PathBuf>,
    /// Those of an index, read: a pipe gives its bytes once only.
    index_files: Vec<Arc<IndexFile>>,
    material_files: Vec<Arc<MaterialFile>>,
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
        for (place, path) in loaded.scene.files() {
            let absolute = std::path::absolute(&path).unwrap_or_else(|_| path.clone());
            // A file named in an override is relative to where the user is.
            if let Some(entry) = tables.pointer_mut(&format!("/{}", place.replace('.', "/")))
                && entry.as_str().is_some_and(|text| folder.join(text) != path)
            {
                *entry = absolute.display().to_string().into();
            }
            known.extend([path, absolute]);
        }
        let devices = loaded.scene.devices.iter();
        let index_files = devices.flat_map(|device| device.index_files.clone()).collect();
        let (name, folder) = (name.to_owned(), folder.to_owned());
        let material_files = loaded.scene.material_files.clone();
        Ok(Self { tables, name, folder, files: known, index_files, material_files })
    }

    /// Where a photograph of that name would lie, were it a file of the scene's folder. Uploaded
    /// ones are hung up under this name and never looked for.
    pub fn source_of(&self, name: &str) -> ImageSource {
        ImageSource::File(self.folder.join(name))
    }

    /// Reads the scene of a page, and opens no file for it. `uploaded` is the photograph that the
    /// page has brought.
    ///
    /// # Errors
    ///
    /// One message: what is wrong in the scene, or that it names a file it may not.
    pub fn read(
        &self,
        scene: &SceneTables,
        uploaded: Option<&ImageSource>,
    ) -> Result<Loaded, String> {
        let tables = json::value(&Value::Object(scene.clone()))?;
        let mut loaded = scene_file::assemble_with(
            &self.index_files,
            &self.material_files,
            tables,
            NAME,
            &self.folder,
        )
        .map_err(|error| error.message.clone())?;
        // What the page has brought is the photograph and nothing else: on a body or around the
        // scene a file of that name would be looked for.
        let brought = uploaded == Some(&loaded.scene.photograph.image);
        let known = |(place, path): (String, PathBuf)| {
            self.files.contains(&path) || (brought && place == PHOTOGRAPH)
        };
        if !loaded.scene.files().into_iter().all(known) {
            return Err(
                "a page can show the images, and take the grids, that came with the program or with the scene that \
                 was opened, and a photograph dropped onto it; it can open no file"
                    .to_owned(),
            );
        }
        let trace = &mut loaded.scene.trace;
        trace.min_power.value = trace.min_power.value.max(LEAST_POWER);
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
    let tables = scene_file::tables(source, NAME).map_err(|error| error.message.clone())?;
    match json::json(tables) {
        Value::Object(tables) => Ok(tables),
        _ => Err("a scene is a table".to_owned()),
    }
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
