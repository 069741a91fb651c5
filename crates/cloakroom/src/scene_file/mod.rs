//! Scene files: TOML in, a [`Scene`] out, or one message that says what is wrong and where.
//!
//! The text becomes values, and the places where they were written; overrides are applied to the
//! values, and each table is held against its list of keys ([`crate::keys`]). The same lists make
//! the JSON Schema of scene files ([`schema`]).

mod error;
mod locations;
mod overrides;
mod read;
mod schema;
#[cfg(test)]
mod tests;
mod tree;

use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;

pub use error::SceneFileError;
pub use locations::Locations;
pub use overrides::Override;
pub use schema::schema;

use crate::input::read_up_to;
use crate::keys::Value;
use crate::scene::Scene;

/// Longer files are no scenes.
const LONGEST_FILE: u64 = 16 << 20;

/// A scene, and where its parts were written.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// Where its parts were written.
    pub locations: Locations,
}

/// Reads a scene file and applies overrides such as `camera.samples=16` to it.
///
/// # Errors
///
/// If the file cannot be read, is not valid TOML, or says something a scene cannot say.
pub fn load(path: &Path, overrides: &[Override]) -> Result<Loaded, SceneFileError> {
    let name = path.display().to_string();
    let text = read_text(path, &name)?;
    parse(&text, &name, path.parent().unwrap_or(Path::new("")), overrides)
}

/// Reads the text of a scene; `name` stands in messages, and files that the scene names are
/// relative to `base_folder`.
///
/// # Errors
///
/// If the text is not valid TOML, or says something a scene cannot say.
pub fn parse(
    text: &str,
    name: &str,
    base_folder: &Path,
    overrides: &[Override],
) -> Result<Loaded, SceneFileError> {
    let mut locations = Locations::new(name, text, overrides);
    let root = tree::parse(&mut locations)?;
    let mut loaded = read_values(root, base_folder, locations)?;
    if overrides.is_empty() {
        loaded.scene.source = text.to_owned();
    }
    Ok(loaded)
}

/// The tables of a scene file as they are written.
///
/// # Errors
///
/// If the text is not valid TOML.
pub fn tables(text: &str, name: &str) -> Result<Value, SceneFileError> {
    tree::parse(&mut Locations::new(name, text, &[]))
}

/// Reads a scene that is a table of values rather than a text; what it would be as a text becomes
/// its source.
///
/// # Errors
///
/// If it says something a scene cannot say.
pub fn assemble(
    tables: Value,
    name: &str,
    base_folder: &Path,
    overrides: &[Override],
) -> Result<Loaded, SceneFileError> {
    read_values(tables, base_folder, Locations::new(name, "", overrides))
}

fn read_values(
    mut root: Value,
    base_folder: &Path,
    mut locations: Locations,
) -> Result<Loaded, SceneFileError> {
    overrides::apply(&mut root, &mut locations)?;
    let mut scene = read::read(&root, &locations, base_folder)?;
    scene.source = text(&root);
    Ok(Loaded { scene, locations })
}

/// The tables of a scene as the text of a scene file.
#[must_use]
pub fn text(tables: &Value) -> String {
    match tree::to_toml(tables) {
        // A document; a value would be written within braces.
        toml::Value::Table(table) => table.to_string(),
        value => value.to_string(),
    }
}

fn read_text(path: &Path, name: &str) -> Result<String, SceneFileError> {
    let fail = |message: String| SceneFileError::whole(name, message);
    let unreadable = |error: std::io::Error| {
        fail(match error.kind() {
            ErrorKind::NotFound => "there is no such file".to_owned(),
            ErrorKind::IsADirectory => "this is a folder, not a scene file".to_owned(),
            ErrorKind::PermissionDenied => "reading it is not permitted".to_owned(),
            ErrorKind::FileTooLarge => format!("{error}; no scene is"),
            _ => format!("it cannot be read: {error}"),
        })
    };
    if path.is_dir() {
        return Err(unreadable(ErrorKind::IsADirectory.into()));
    }
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| read_up_to(LONGEST_FILE, file, &mut bytes));
    read.map_err(unreadable)?;
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count() + 1;
        let mut error = fail("the file is not UTF-8 text".to_owned());
        error.line = u32::try_from(line).ok();
        error
    })
}
