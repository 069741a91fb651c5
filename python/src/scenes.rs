//! Scenes.

use crate::errors::{Failure, scene_error, unreadable, value_error};
use crate::images::Image;
use crate::supervision::supervised;
use crate::values::{object_of, value_of};
use cloakroom::assembly::Assembly;
use cloakroom::keys::{Table, Value};
use cloakroom::photograph::ImageSource;
use cloakroom::render::{Images, PreparedScene, PreparedSceneError, assembly};
use cloakroom::scene;
use cloakroom::scene_file::{self, Loaded, Override, SceneFileError};
use cloakroom_figures::examples;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// A scene that has been read, with keys that are set and images that are arrays.
#[pyclass(frozen, module = "cloakroom._cloakroom")]
#[derive(Debug)]
pub struct Scene {
    written: Arc<Written>,
    overrides: Vec<Override>,
    /// The arrays that are the photograph and the surroundings.
    arrays: Arrays,
    loaded: Loaded,
    /// The devices, built when they are first needed.
    assembly: OnceLock<Assembly>,
}

/// What a scene is read from.
#[derive(Debug)]
struct Written {
    content: Content,
    /// What messages call it: the file it comes from.
    name: String,
    /// The folder that its files are relative to.
    folder: PathBuf,
    /// Whether it comes from a file, so that messages may point into it.
    is_file: bool,
}

/// The text of a scene file, or its tables.
#[derive(Debug)]
enum Content {
    Text(String),
    Tables(Value),
}

impl Written {
    fn read(&self, overrides: &[Override], arrays: &Arrays) -> Result<Loaded, SceneFileError> {
        let Self { name, folder, .. } = self;
        let mut loaded = match &self.content {
            Content::Text(text) => scene_file::parse(text, name, folder, overrides)?,
            Content::Tables(tables) => {
                scene_file::assemble(tables.clone(), name, folder, overrides)?
            }
        };
        hang(arrays, folder, &mut loaded.scene);
        Ok(loaded)
    }
}

/// The images of the photograph and of the surroundings that are arrays, in the places of their
/// names.
type Arrays = [Option<ImageSource>; 2];

/// The same as Python hands them over.
type ImageArrays<'py> = [Option<PyRef<'py, Image>>; 2];

/// Puts arrays where a scene names them; an override may name a file instead.
fn hang(arrays: &Arrays, folder: &Path, scene: &mut scene::Scene) {
    let shown = [Some(&mut scene.photograph.image), scene.surroundings.image.as_mut()];
    for (source, image) in arrays.iter().zip(shown) {
        if let (Some(source), Some(image)) = (source, image) {
            let name = source.to_string();
            if [folder.join(&name), name.into()].map(ImageSource::File).contains(image) {
                *image = source.clone();
            }
        }
    }
}

/// Keys and their values, to be set in a scene.
fn settings(overrides: Vec<(String, Bound<'_, PyAny>)>) -> PyResult<Vec<Override>> {
    let setting = |(key, value): (String, Bound<'_, PyAny>)| {
        let value = value_of(&key, &value)?;
        Ok(Override::value(key, value))
    };
    overrides.into_iter().map(setting).collect()
}

#[pymethods]
impl Scene {
    /// The scene of a text.
    #[new]
    fn new(
        text: String,
        name: String,
        folder: PathBuf,
        is_file: bool,
        overrides: Vec<(String, Bound<'_, PyAny>)>,
        images: ImageArrays<'_>,
    ) -> Result<Self, Failure> {
        let written = Written { content: Content::Text(text), name, folder, is_file };
        Self::read(Arc::new(written), settings(overrides)?, images)
    }

    /// The scene of tables by their names, devices in the list `device`.
    #[staticmethod]
    fn of_tables(
        tables: &Bound<'_, PyDict>,
        folder: PathBuf,
        images: ImageArrays<'_>,
    ) -> Result<Self, Failure> {
        let name = "scene".to_owned();
        let content = Content::Tables(value_of(&name, tables)?);
        let written = Written { content, name, folder, is_file: false };
        Self::read(Arc::new(written), Vec::new(), images)
    }

    /// Reads a scene file, or an example where there is no such file.
    #[staticmethod]
    fn load(path: PathBuf) -> Result<Self, Failure> {
        let name = path.to_str().filter(|_| !path.exists()).unwrap_or_default();
        if let Some(example) = examples::named(name) {
            let (content, name) = (Content::Text(example.text.to_owned()), name.to_owned());
            let written = Written { content, name, folder: PathBuf::new(), is_file: false };
            return Self::read(Arc::new(written), Vec::new(), [None, None]);
        }
        let loaded = scene_file::load(&path, &[]).map_err(|mut error| {
            error.message += &examples::meant_by(name);
            unreadable(&path, error)
        })?;
        let written = Written {
            content: Content::Text(loaded.scene.source.clone()),
            name: path.display().to_string(),
            folder: path.parent().map(PathBuf::from).unwrap_or_default(),
            is_file: true,
        };
        let (written, arrays) = (Arc::new(written), Arrays::default());
        Ok(Self { written, overrides: Vec::new(), arrays, loaded, assembly: OnceLock::new() })
    }

    /// The same scene with other overrides and images.
    fn replaced(
        &self,
        overrides: Vec<(String, Bound<'_, PyAny>)>,
        images: ImageArrays<'_>,
    ) -> Result<Self, Failure> {
        Self::read(Arc::clone(&self.written), settings(overrides)?, images)
    }

    /// What it is made from again: the text of its file without overrides, what messages call it,
    /// the folder that its files are relative to, and whether it comes from a file.
    #[getter]
    fn written(&self) -> (String, &str, &Path, bool) {
        let Written { content, name, folder, is_file } = &*self.written;
        let text = match content {
            Content::Text(text) => text.clone(),
            Content::Tables(tables) => scene_file::text(tables),
        };
        (text, name, folder, *is_file)
    }

    /// The scene as TOML, overrides applied.
    #[getter]
    fn toml(&self) -> &str {
        &self.scene().source
    }

    /// Where its camera is once it has gone round its target, degrees.
    fn orbited(&self, degrees: f64) -> [f64; 3] {
        self.scene().camera.orbited(degrees).to_array()
    }

    /// Width and height of its picture.
    #[getter]
    fn resolution(&self) -> (u32, u32) {
        self.scene().camera.resolution.into()
    }

    /// The kinds of its devices.
    #[getter]
    fn kinds(&self) -> Vec<&'static str> {
        self.scene().devices.iter().map(|device| device.kind()).collect()
    }

    /// Its tables as a scene file writes them.
    #[getter]
    fn tables<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>, Failure> {
        let tables = match &self.written.content {
            Content::Tables(tables) if self.overrides.is_empty() => tables.clone(),
            _ => scene_file::tables(&self.scene().source, &self.written.name)?,
        };
        Ok(object_of(py, &tables)?)
    }

    /// What a PNG shows instead of what the camera sees, and whether with a bar of its colors.
    #[getter]
    fn map<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let keys = PyDict::new(py);
        let picture = &self.scene().picture;
        let is_of_map =
            |name: &str| name != "channels" && (name != "map" || picture.map.name().is_some());
        for (name, value) in picture.written().iter().filter(|(name, _)| is_of_map(name)) {
            keys.set_item(name, object_of(py, value)?)?;
        }
        Ok(keys)
    }

    /// The files that it names, and the keys that name them.
    #[getter]
    fn files(&self) -> Vec<(String, PathBuf)> {
        self.scene().files()
    }

    /// Builds the devices and keeps them.
    fn build(&self, py: Python<'_>) -> Result<(), Failure> {
        if self.is_built() {
            return Ok(());
        }
        supervised(py, None, |_, _| self.assembly().map(drop))
    }

    /// Builds the devices, and the rest of what a picture needs.
    fn check(&self, py: Python<'_>) -> Result<(), Failure> {
        supervised(py, None, |_, _| self.prepared().map(drop))
    }
}

impl Scene {
    fn read(
        written: Arc<Written>,
        overrides: Vec<Override>,
        images: ImageArrays<'_>,
    ) -> Result<Self, Failure> {
        let arrays = images.map(|image| image.map(|image| image.source.clone()));
        let loaded = written.read(&overrides, &arrays);
        let loaded = loaded.map_err(|error| scene_error(&error, written.is_file))?;
        Ok(Self { written, overrides, arrays, loaded, assembly: OnceLock::new() })
    }

    /// The scene.
    pub fn scene(&self) -> &scene::Scene {
        &self.loaded.scene
    }

    /// An error of the built scene, at its place.
    pub fn located(&self, error: &PreparedSceneError) -> Failure {
        if self.written.is_file {
            let located = self.loaded.locations.error_at(&error.key(), error.to_string());
            return scene_error(&located, true);
        }
        value_error(format!("{}: {error}", error.key()))
    }

    /// The same scene read again, with further overrides.
    pub fn reload(&self, further: &[Override]) -> Result<Loaded, SceneFileError> {
        self.written.read(&[&self.overrides, further].concat(), &self.arrays)
    }

    /// What a picture needs, built.
    pub fn prepared(&self) -> Result<PreparedScene<'_>, Failure> {
        PreparedScene::new(self.scene()).map_err(|error| self.located(&error))
    }

    /// The same with images that may have been read before.
    pub fn prepared_with(&self, images: &mut Images) -> Result<PreparedScene<'_>, Failure> {
        PreparedScene::with_images(self.scene(), images).map_err(|error| self.located(&error))
    }

    /// What has been read.
    pub fn loaded(&self) -> &Loaded {
        &self.loaded
    }

    /// The folder that its files are relative to.
    pub fn folder(&self) -> &Path {
        &self.written.folder
    }

    /// Whether it shows an image that is an array.
    pub fn shows_array(&self) -> bool {
        let is_array = |image: &ImageSource| matches!(image, ImageSource::Memory(_));
        let scene = self.scene();
        is_array(&scene.photograph.image) || scene.surroundings.image.as_ref().is_some_and(is_array)
    }

    /// Whether its devices have been built.
    pub fn is_built(&self) -> bool {
        self.assembly.get().is_some()
    }

    /// Its devices, built.
    pub fn assembly(&self) -> Result<&Assembly, Failure> {
        if let Some(assembly) = self.assembly.get() {
            return Ok(assembly);
        }
        let built = assembly(self.scene()).map_err(|error| self.located(&error))?;
        Ok(self.assembly.get_or_init(|| built))
    }
}
