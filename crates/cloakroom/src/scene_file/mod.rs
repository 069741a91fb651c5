//! Scene files: TOML in, a [`Scene`] out, or one message that says what is wrong and where.
//!
//! The text becomes values, and the places where they were written; overrides are applied to the
//! values, and each table is held against its list of keys ([`crate::keys`]). The same lists make
//! the JSON Schema of scene files ([`schema`]).

mod error;
mod key_at;
mod locations;
mod overrides;
mod read;
mod schema;
#[cfg(test)]
mod tests;
mod tree;

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use error::{OverrideAtFault, SceneFileError};
pub use locations::Locations;
pub use overrides::Override;
pub use schema::schema;

use crate::index_file::{IndexFile, IndexFiles};
use crate::input::{read_file, read_up_to, reason};
use crate::keys::Value;
use crate::material_file::{MaterialFile, MaterialFiles};
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

/// The text of a scene file, of which scenes with different overrides are made. It is read once, and
/// so is each file of an index that they name: a pipe gives its bytes once only.
#[derive(Debug)]
pub struct SceneText {
    text: String,
    name: String,
    base_folder: PathBuf,
    files: NamedFiles,
}

/// The files that a scene names and that are read with it.
#[derive(Debug, Default)]
struct NamedFiles {
    indices: IndexFiles,
    materials: MaterialFiles,
}

impl SceneText {
    /// A text; `name` stands in messages, and files that the scene names are relative to
    /// `base_folder`.
    #[must_use]
    pub fn new(text: &str, name: &str, base_folder: &Path) -> Self {
        Self {
            text: text.to_owned(),
            name: name.to_owned(),
            base_folder: base_folder.to_owned(),
            files: NamedFiles::default(),
        }
    }

    /// Reads the text of a file, or of standard input for `-`.
    ///
    /// # Errors
    ///
    /// If it cannot be read.
    pub fn read(path: &Path) -> Result<Self, SceneFileError> {
        Ok(Self::new(&read_text(path)?, &name_of(path), path.parent().unwrap_or(Path::new(""))))
    }

    /// The scene, with overrides such as `camera.samples=16`.
    ///
    /// # Errors
    ///
    /// If the text is not valid TOML, or says something a scene cannot say.
    pub fn scene(&self, overrides: &[Override]) -> Result<Loaded, SceneFileError> {
        let Self { text, name, base_folder, files } = self;
        let mut locations = Locations::new(name, text, overrides);
        let root = tree::parse(&mut locations)?;
        let mut loaded = read_values(root, base_folder, locations, files)?;
        if overrides.is_empty() {
            loaded.scene.source.clone_from(text);
        }
        Ok(loaded)
    }
}

/// Reads a scene file, or standard input for `-`, and applies overrides such as `camera.samples=16`
/// to it.
///
/// # Errors
///
/// If the file cannot be read, is not valid TOML, or says something a scene cannot say.
pub fn load(path: &Path, overrides: &[Override]) -> Result<Loaded, SceneFileError> {
    SceneText::read(path)?.scene(overrides)
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
    SceneText::new(text, name, base_folder).scene(overrides)
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
    let locations = Locations::new(name, "", overrides);
    read_values(tables, base_folder, locations, &NamedFiles::default())
}

/// The same without opening a file: the indices of devices are those of files that have been read
/// before, or are left to be read where the devices are built.
///
/// # Errors
///
/// As [`assemble`].
pub fn assemble_with(
    index_files: &[Arc<IndexFile>],
    material_files: &[Arc<MaterialFile>],
    tables: Value,
    name: &str,
    base_folder: &Path,
) -> Result<Loaded, SceneFileError> {
    let locations = Locations::new(name, "", &[]);
    let files = NamedFiles {
        indices: IndexFiles::only(index_files),
        materials: MaterialFiles::only(material_files),
    };
    read_values(tables, base_folder, locations, &files)
}

fn read_values(
    mut root: Value,
    base_folder: &Path,
    mut locations: Locations,
    files: &NamedFiles,
) -> Result<Loaded, SceneFileError> {
    overrides::apply(&mut root, &mut locations)?;
    let mut scene = read::read(&root, &locations, base_folder, files)?;
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

/// Whether a path stands for standard input.
fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// The name of a file in messages.
fn name_of(path: &Path) -> String {
    if is_standard_input(path) { "standard input".to_owned() } else { path.display().to_string() }
}

/// The text of a file, or of standard input for `-`.
///
/// # Errors
///
/// If it cannot be read, or is no text.
pub fn read_text(path: &Path) -> Result<String, SceneFileError> {
    let fail = |message: String| SceneFileError::whole(name_of(path), message);
    let path = (!is_standard_input(path)).then_some(path);
    let unreadable = |error: io::Error| {
        fail(match error.kind() {
            ErrorKind::IsADirectory => "this is a folder, not a scene file".to_owned(),
            ErrorKind::NotFound | ErrorKind::PermissionDenied => reason(&error),
            ErrorKind::FileTooLarge => format!("{error}; no scene is"),
            _ => format!("it cannot be read: {error}"),
        })
    };
    if path.is_some_and(Path::is_dir) {
        return Err(unreadable(ErrorKind::IsADirectory.into()));
    }
    let read = || match path {
        Some(path) => read_file(LONGEST_FILE, path),
        None => {
            let mut bytes = Vec::new();
            read_up_to(LONGEST_FILE, io::stdin(), &mut bytes).map(|()| bytes)
        }
    };
    let bytes = read().map_err(unreadable)?;
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count() + 1;
        let mut error = fail("the file is not UTF-8 text".to_owned());
        error.line = u32::try_from(line).ok();
        error
    })
}
