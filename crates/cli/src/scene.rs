//! Scenes from files, and errors that point back into them.

use crate::arguments::{SceneArguments, ThreadsArguments};
use crate::report::Failure;
use cloakroom::render::PreparedSceneError;
use cloakroom::scene_file::{self, Loaded};

/// Reads a scene with its overrides.
pub fn load(arguments: &SceneArguments) -> Result<Loaded, Failure> {
    load_with(arguments, &[])
}

/// Reads a scene with its overrides and further ones after them.
pub fn load_with(arguments: &SceneArguments, further: &[String]) -> Result<Loaded, Failure> {
    let overrides = [&arguments.overrides, further].concat();
    scene_file::load(&arguments.scene, &overrides).map_err(Failure::from_error)
}

/// An error of a scene that could be read but not built, at its place in the file.
pub fn located(loaded: &Loaded, error: &PreparedSceneError) -> Failure {
    Failure::from_error(loaded.locations.error_at(&error.key(), error.to_string()))
}

/// Lets the work use the given number of threads, or all cores.
pub fn use_threads(threads: &ThreadsArguments) -> Result<(), Failure> {
    let threads = threads.count.map_or(0, usize::from);
    cloakroom::threads::use_threads(threads)
        .map_err(|error| Failure::Failed(format!("cannot start {threads} threads: {error}")))
}
