//! Whole frames: the paper's scenes at 256 x 256 pixels, 1 sample each, and reading the photograph.
//!
//! `cargo bench -p cloakroom`

use cloakroom::photograph::{self, Edges, Pyramid};
use cloakroom::render::{Studio, Supervision, Wanted, render};
use cloakroom::scene_file;
use divan::Bencher;
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn main() {
    divan::main();
}

/// Scenes: the empty view, (iii) turned by 10 degrees, its mirror view, and (iv).
const SCENES: [(&str, &str); 4] = [
    ("empty", ""),
    ("mirror", "[[device]]\nkind = \"square-cloak\"\nrotation = 10\nshow = \"mirror\"\n"),
    ("square_cloak", "[[device]]\nkind = \"square-cloak\"\nrotation = 10\n"),
    ("double_gaussian_cloak", "[[device]]\nkind = \"double-gaussian-cloak\"\n"),
];

#[divan::bench(args = SCENES.map(|(name, _)| name))]
fn frame(bencher: Bencher, name: &str) {
    let devices = SCENES.iter().find(|(known, _)| *known == name).map_or("", |(_, text)| text);
    let text = format!("[camera]\nresolution = [256, 256]\nsamples = 1\n{devices}");
    let loaded = scene_file::parse(&text, name, Path::new(""), &[]).expect("a sound scene");
    let studio = Studio::new(&loaded.scene).expect("a sound scene");
    let stop = AtomicBool::new(false);
    bencher.counter(divan::counter::ItemsCount::new(256u32 * 256)).bench(|| {
        let supervision = Supervision { rows_done: &|_| {}, stop: &stop };
        render(&studio, Wanted::Image, &supervision).expect("a picture")
    });
}

#[divan::bench]
fn read_the_photograph() -> Pyramid {
    let image = photograph::load(&cloakroom::scene::Scene::default().photograph.image);
    Pyramid::new(image.expect("the builtin photograph"), Edges::Clamp)
}
