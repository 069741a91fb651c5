//! Pictures of scenes, for all tests.

use cloakroom::output::{Picture, RgbImage, to_srgb};
use cloakroom::render::{ChannelSet, PreparedScene, Supervision, render};
use cloakroom::scene_file;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The picture of a scene whose files are in a folder, with the channels that are wanted.
pub fn rendered(folder: &Path, scene: &str, wanted: ChannelSet) -> Picture {
    let loaded = scene_file::parse(scene, "test", folder, &[]).unwrap();
    let prepared = PreparedScene::new(&loaded.scene).unwrap();
    let stop = AtomicBool::new(false);
    let supervision = Supervision { rows_done: &|_| {}, stop: &stop };
    render(&prepared, wanted, &supervision).unwrap().picture
}

/// The picture of a scene whose files are in a folder, with all channels.
pub fn picture_in(folder: &Path, scene: &str) -> Picture {
    rendered(folder, scene, ChannelSet::Everything)
}

/// The picture of a scene without files, with all channels.
pub fn picture(scene: &str) -> Picture {
    picture_in(Path::new(""), scene)
}

/// What a PNG of a scene shows.
pub fn png(scene: &str) -> RgbImage {
    to_srgb(&picture(scene)).unwrap()
}

/// In how many pixels two pictures differ, and by how many 8-bit steps at most.
pub fn difference(one: &RgbImage, other: &RgbImage) -> (usize, u8) {
    assert_eq!(one.dimensions(), other.dimensions());
    let steps = one
        .pixels()
        .zip(other.pixels())
        .map(|(a, b)| a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b)).fold(0, u8::max));
    steps.filter(|step| *step > 0).fold((0, 0), |(count, most), step| (count + 1, most.max(step)))
}
