//! Scenes.

use crate::errors::{scene_error, value_error};
use crate::images::Image;
use crate::supervision::supervised;
use cloakroom::photograph::ImageSource;
use cloakroom::render::{StudioError, bench};
use cloakroom::scene::{self, SurroundingsSettings};
use cloakroom::scene_file::{self, Loaded, SceneFileError};
use cloakroom::trace::Bench;
use pyo3::exceptions::PyFileNotFoundError;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// A scene that has been read: the text of a scene file, the folder that its files are relative to, overrides such as
/// `camera.samples=16`, and images that are arrays.
#[pyclass(frozen, module = "cloakroom._cloakroom")]
#[derive(Debug)]
pub struct Scene {
    text: String,
    /// What messages call it: the file it comes from.
    name: String,
    folder: PathBuf,
    /// Whether it comes from a file, so that messages may point into it.
    is_file: bool,
    overrides: Vec<String>,
    arrays: Arrays,
    loaded: Loaded,
    /// The devices, built when they are first needed.
    bench: OnceLock<Arc<Bench>>,
}

/// Images that are arrays, in the places of their names.
#[derive(Debug, Default)]
struct Arrays {
    photograph: Option<ImageSource>,
    surroundings: Option<ImageSource>,
}

impl Arrays {
    /// Puts them where a scene names them; an override may name a file instead.
    fn hang(&self, folder: &Path, scene: &mut scene::Scene) {
        let stands = |image: &ImageSource, source: &ImageSource| {
            let name = source.to_string();
            [folder.join(&name), name.into()].map(ImageSource::File).contains(image)
        };
        if let Some(source) = &self.photograph
            && stands(&scene.photograph.image, source)
        {
            scene.photograph.image = source.clone();
        }
        if let Some(source) = &self.surroundings
            && let SurroundingsSettings::Image(image) = &scene.surroundings
            && stands(image, source)
        {
            scene.surroundings = SurroundingsSettings::Image(source.clone());
        }
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (text, name, folder, is_file, overrides, photograph=None, surroundings=None))]
    fn new(
        text: String,
        name: String,
        folder: PathBuf,
        is_file: bool,
        overrides: Vec<String>,
        photograph: Option<&Image>,
        surroundings: Option<&Image>,
    ) -> PyResult<Self> {
        let loaded = scene_file::parse(&text, &name, &folder, &overrides)
            .map_err(|error| scene_error(&error, is_file))?;
        let source = |image: Option<&Image>| image.map(|image| image.source.clone());
        let arrays = Arrays { photograph: source(photograph), surroundings: source(surroundings) };
        let mut scene =
            Self { text, name, folder, is_file, overrides, arrays, loaded, bench: OnceLock::new() };
        scene.arrays.hang(&scene.folder, &mut scene.loaded.scene);
        Ok(scene)
    }

    /// Reads a scene file.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        let loaded = scene_file::load(&path, &[]).map_err(|error| {
            if path.exists() {
                scene_error(&error, true)
            } else {
                PyFileNotFoundError::new_err(error.to_string())
            }
        })?;
        let folder = path.parent().map(PathBuf::from).unwrap_or_default();
        Ok(Self {
            text: loaded.scene.source.clone(),
            name: path.display().to_string(),
            folder,
            is_file: true,
            overrides: Vec::new(),
            arrays: Arrays::default(),
            loaded,
            bench: OnceLock::new(),
        })
    }

    /// The text of the scene file, without overrides.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// What messages call it.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// The folder that its files are relative to.
    #[getter]
    fn folder(&self) -> &Path {
        &self.folder
    }

    /// Whether it comes from a file.
    #[getter]
    fn is_file(&self) -> bool {
        self.is_file
    }

    /// The scene as TOML, overrides applied.
    #[getter]
    fn toml(&self) -> &str {
        &self.scene().source
    }

    /// Width and height of its picture.
    #[getter]
    fn resolution(&self) -> (u32, u32) {
        self.scene().camera.resolution().into()
    }

    /// The kinds of its devices.
    #[getter]
    fn kinds(&self) -> Vec<&'static str> {
        self.scene().devices.iter().map(|device| device.entry.kind).collect()
    }

    /// What a PNG shows instead of what the camera sees, and whether with a bar of its colors.
    #[getter]
    fn map(&self) -> (Option<&'static str>, bool) {
        (self.scene().picture.map, self.scene().picture.color_bar)
    }

    /// Builds the devices, and the rest of what a picture needs.
    fn check(&self, py: Python<'_>) -> PyResult<()> {
        supervised(py, None, |_| cloakroom::render::Studio::new(self.scene()).map(drop))?
            .map_err(|error| self.located(&error))
    }
}

impl Scene {
    /// The scene.
    pub fn scene(&self) -> &scene::Scene {
        &self.loaded.scene
    }

    /// An error of the built scene, at its place.
    pub fn located(&self, error: &StudioError) -> PyErr {
        if self.is_file {
            let located = self.loaded.locations.error_at(&error.key(), error.to_string());
            return scene_error(&located, true);
        }
        value_error(format!("{}: {error}", error.key()))
    }

    /// The same scene read again, with further overrides.
    pub fn reload(&self, further: &[String]) -> Result<Loaded, SceneFileError> {
        let overrides = [&self.overrides, further].concat();
        let mut loaded = scene_file::parse(&self.text, &self.name, &self.folder, &overrides)?;
        self.arrays.hang(&self.folder, &mut loaded.scene);
        Ok(loaded)
    }

    /// Its devices, built.
    pub fn bench(&self) -> Result<Arc<Bench>, StudioError> {
        if let Some(bench) = self.bench.get() {
            return Ok(Arc::clone(bench));
        }
        let built = Arc::new(bench(self.scene())?);
        Ok(Arc::clone(self.bench.get_or_init(|| built)))
    }
}
