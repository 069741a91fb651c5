//! The scenes of the gallery can be looked at.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom::render::Studio;
use cloakroom::scene_file;
use std::fs;
use std::path::Path;

#[test]
fn every_scene_is_sound() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/gallery");
    for file in fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let loaded = scene_file::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
            if let Err(error) = Studio::new(&loaded.scene) {
                panic!("{}: {error}", path.display());
            }
        }
    }
}
