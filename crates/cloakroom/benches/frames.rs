//! Whole frames at 256 x 256 pixels, 1 sample each, and what comes before the first pixel.
//!
//! `cargo bench -p cloakroom --bench frames`; items are pixels.

use cloakroom::photograph::{self, Edges, Pyramid};
use cloakroom::render::{ChannelSet, PreparedScene, Supervision, render};
use cloakroom::scene::Scene;
use cloakroom::scene_file;
use divan::Bencher;
use divan::counter::ItemsCount;
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn main() {
    divan::main();
}

const EMPTY: &str = "";
const MIRROR: &str = "[[device]]\nkind = \"square-cloak\"\nrotation = 10\nshow = \"mirror\"\n";
const SQUARE: &str = "[[device]]\nkind = \"square-cloak\"\nrotation = 10\n";
const GAUSSIAN: &str = "[[device]]\nkind = \"double-gaussian-cloak\"\nrotation = 10\n";

/// The empty view, the flat mirror, and the designs of the paper, turned by 10 degrees.
const SCENES: [(&str, &str, &str); 6] = [
    ("empty", EMPTY, ""),
    ("mirror", MIRROR, ""),
    ("iii", SQUARE, ""),
    ("iv", GAUSSIAN, ""),
    ("i", SQUARE, "material = \"positive-uniaxial\"\n"),
    ("ii", SQUARE, "material = \"negative-uniaxial\"\n"),
];

fn scene(name: &str, resolution: u32) -> Scene {
    let (_, device, more) =
        SCENES.into_iter().find(|(known, ..)| *known == name).expect("a scene of the list");
    let camera = format!("[camera]\nresolution = [{resolution}, {resolution}]\nsamples = 1\n");
    let text = format!("{camera}{device}{more}");
    scene_file::parse(&text, name, Path::new(""), &[]).expect("a sound scene").scene
}

fn picture(prepared: &PreparedScene<'_>) {
    let stop = AtomicBool::new(false);
    let supervision = Supervision { rows_done: &|_| {}, stop: &stop };
    divan::black_box(render(prepared, ChannelSet::Image, &supervision).expect("a picture"));
}

#[divan::bench(args = SCENES.map(|(name, ..)| name))]
fn frame(bencher: Bencher, name: &str) {
    let scene = scene(name, 256);
    let prepared = PreparedScene::new(&scene).expect("a sound scene");
    bencher.counter(ItemsCount::new(256u32 * 256)).bench(|| picture(&prepared));
}

/// From the text of a scene to a picture of 64 x 64 pixels, the photograph read on the way.
#[divan::bench(args = SCENES.map(|(name, ..)| name))]
fn start_up(bencher: Bencher, name: &str) {
    bencher.bench(|| {
        let scene = scene(name, 64);
        picture(&PreparedScene::new(&scene).expect("a sound scene"));
    });
}

#[divan::bench]
fn read_the_photograph() -> Pyramid {
    let image = photograph::load(&Scene::default().photograph.image);
    Pyramid::new(image.expect("the builtin photograph"), Edges::Clamp)
}
