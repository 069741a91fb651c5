//! Scenes from files, and errors that point back into them.

use crate::arguments::{FormatArguments, PictureArguments, SceneArguments, ThreadsArguments};
use crate::report::{Failure, Result};
use cloakroom::assembly::Assembly;
use cloakroom::keys::Value;
use cloakroom::output;
use cloakroom::render::{self, Images, PreparedScene, PreparedSceneError};
use cloakroom::scene_file::{Loaded, Override, SceneText};
use cloakroom_figures::examples::{self, Example};
use std::path::{Path, PathBuf};

/// Reads a scene with its overrides and further ones after them.
pub fn load(arguments: &SceneArguments, further: &[Override]) -> Result<Loaded> {
    load_with(arguments, &text(&arguments.scene)?, &[&arguments.overrides, further].concat())
}

/// Reads a scene, whose text has been read, with these overrides alone.
pub fn load_with(
    arguments: &SceneArguments,
    text: &SceneText,
    overrides: &[Override],
) -> Result<Loaded> {
    let loaded = text.scene(overrides)?;
    check_pipes(arguments, &loaded, None)?;
    Ok(loaded)
}

/// The text of a scene: that of a file, or of the example of that name where there is no such file.
pub fn text(path: &Path) -> Result<SceneText> {
    match example(path) {
        Some(example) => Ok(SceneText::new(example.text, example.path, Path::new(""))),
        None => SceneText::read(path).map_err(|mut error| {
            if let Some(name) = path.to_str().filter(|_| !path.exists()) {
                error.message += &examples::meant_by(name);
            }
            error.into()
        }),
    }
}

/// The example scene that a path names, as in `gallery/prisms`, if no file is there.
pub fn example(path: &Path) -> Option<Example> {
    let name = path.to_str().filter(|_| path != Path::new("-") && !path.exists())?;
    examples::named(name)
}

/// The overrides of a scene whose picture is asked for. Devices that are taken away are looked at
/// first.
pub fn overrides(
    text: &SceneText,
    scene: &SceneArguments,
    picture: &PictureArguments,
) -> Result<Vec<Override>> {
    let mut all = set(scene, &picture.format);
    if picture.empty {
        text.scene(&all)?;
        all.push(Override::value("device", Value::List(Vec::new())).by("--empty".to_owned()));
    }
    Ok(all)
}

/// What has a name of its own, then `--set`, which knows better.
pub fn set(scene: &SceneArguments, format: &FormatArguments) -> Vec<Override> {
    let FormatArguments { size, samples, photo } = format;
    let size = size.map(|[width, height]| {
        let sides = [width, height].map(i64::from);
        Override::value("camera.resolution", sides).by(format!("--size {width}x{height}"))
    });
    let samples = samples.map(|samples| {
        let words = format!("--samples {samples}");
        Override::value("camera.samples", i64::from(samples)).by(words)
    });
    let photo = photo.as_ref().map(|photo| {
        let path = photo.display().to_string();
        let words = format!("--photo {path}");
        Override::value("photograph.image", path).by(words)
    });
    let named = size.into_iter().chain(samples).chain(photo);
    named.chain(scene.overrides.iter().cloned()).collect()
}

/// Refuses a pipe that is to be read for two things: it gives its bytes once only. `rays` is what is
/// read beside the scene and the files that it names.
pub fn check_pipes(arguments: &SceneArguments, loaded: &Loaded, rays: Option<&Path>) -> Result<()> {
    // One image or index of several devices is read once.
    let of_number = |key: String| key.rsplit('.').take(2).collect::<Vec<_>>().join(".");
    let named = loaded.scene.files().into_iter().map(|(key, path)| (of_number(key), path));
    let mut files: Vec<(String, PathBuf)> = named.collect();
    files.push(("the scene".to_owned(), arguments.scene.clone()));
    files.extend(rays.map(|path| ("--rays".to_owned(), path.to_owned())));
    for (number, (what, path)) in files.iter().enumerate() {
        for (other, same) in &files[..number] {
            let is_read_once = what == other && path == same;
            if !is_read_once && output::is_same_pipe(&opened(path), &opened(same)) {
                return Err(Failure::Failed(format!(
                    "{} and {} are one pipe, which gives its bytes once only; give one of them as \
                     a file",
                    same.display(),
                    path.display()
                )));
            }
        }
    }
    Ok(())
}

/// The file that a name of an input stands for.
fn opened(path: &Path) -> PathBuf {
    if path == Path::new("-") { "/dev/stdin".into() } else { path.to_owned() }
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
