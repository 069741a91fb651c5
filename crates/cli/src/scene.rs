//! Scenes from files, and errors that point back into them.

use crate::arguments::{SceneArguments, ThreadsArguments};
use crate::report::{Failure, Result};
use cloakroom::assembly::Assembly;
use cloakroom::render::{self, Images, PreparedScene, PreparedSceneError};
use cloakroom::scene_file::{Loaded, Override, SceneFileError, SceneText};
use std::path::PathBuf;

/// Reads a scene with its overrides and further ones after them.
pub fn load(arguments: &SceneArguments, further: &[Override]) -> Result<Loaded, SceneFileError> {
    SceneText::read(&arguments.scene)?.scene(&[&arguments.overrides, further].concat())
}

/// The files that a run reads: the scene, and those that it names.
pub fn inputs(arguments: &SceneArguments, loaded: &Loaded) -> Vec<PathBuf> {
    let named = loaded.scene.files().into_iter().map(|(_, path)| path);
    named.chain([arguments.scene.clone()]).collect()
}

/// What a picture of a scene needs, built; `images` keeps what has been read.
pub fn prepared<'s>(loaded: &'s Loaded, images: &mut Images) -> Result<PreparedScene<'s>> {
    PreparedScene::with_images(&loaded.scene, images).map_err(|error| located(loaded, &error))
}

/// The devices of a scene, built.
pub fn assembly(loaded: &Loaded) -> Result<Assembly> {
    render::assembly(&loaded.scene).map_err(|error| located(loaded, &error))
}

/// An error of a scene that could be read but not built, at its place in the file.
pub fn located(loaded: &Loaded, error: &PreparedSceneError) -> Failure {
    loaded.locations.error_at(&error.key(), error.to_string()).into()
}

/// Lets the work use the given number of threads, or all cores.
pub fn use_threads(threads: &ThreadsArguments) -> Result<()> {
    let threads = threads.count.map_or(0, usize::from);
    cloakroom::threads::use_threads(threads)
        .map_err(|error| Failure::Failed(format!("cannot start {threads} threads: {error}")))
}
