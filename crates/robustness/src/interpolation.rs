//! Pictures whose rays share their neighbours' work, against those of rays traced one by one.

use crate::draws::Draws;
use crate::scenes::{scene_of, scene_seen};
use cloakroom::device::CATALOGUE;
use cloakroom::output::to_srgb;
use cloakroom::render::{ChannelSet, PreparedScene, Supervision, Tile, render_tile};
use cloakroom::scene_file;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use toml::{Table, Value};

/// Width and height of the pictures: six patches.
const SIZE: [i64; 2] = [96, 64];
const WHOLE: Tile = Tile { left: 0, top: 0, width: 96, height: 64 };

/// Samples of each pixel.
const SAMPLES: i64 = 4;

/// How many pixels may differ, by one step of 8 bits: what lies between two steps.
const ROUNDED: usize = 3;

/// Looks at a random device from anywhere; how many rays that takes.
///
/// # Panics
///
/// If the picture differs from that of rays traced one by one.
pub fn interpolate(draws: &mut Draws<'_>) -> u64 {
    let scene = scene_seen(draws, SIZE, SAMPLES);
    compare(draws, &scene, Path::new("/nowhere"), WHOLE)
}

/// Looks straight onto a random device, as the paper does, at what is about the middle of a large picture; how many
/// rays that takes. There rays at the nodes of patches meet edges, for these lie where the picture is halved.
///
/// # Panics
///
/// If the picture differs from that of rays traced one by one.
pub fn interpolate_straight(draws: &mut Draws<'_>) -> u64 {
    let entry = draws.pick(CATALOGUE);
    let mut scene = scene_of(draws, entry);
    if let Some(Value::Array(devices)) = scene.get_mut("device") {
        for device in devices.iter_mut().filter_map(Value::as_table_mut) {
            device.remove("rotation");
            device.remove("axis");
        }
    }
    let [width, height] = *draws.pick(&[[640, 480], [512, 384], [1024, 1024], [1280, 720]]);
    let camera = Table::from_iter([
        ("resolution".to_owned(), Value::from(vec![width, height])),
        ("samples".to_owned(), SAMPLES.into()),
    ]);
    scene.insert("camera".to_owned(), camera.into());
    // Patches of any of the four quarters.
    let mut first =
        |side: u32, own: u32| side / 2 - own / 4 - own / 2 * u32::from(draws.chance(128));
    let [left, top] = [first(width, WHOLE.width), first(height, WHOLE.height)];
    compare(draws, &scene, Path::new("/nowhere"), Tile { left, top, ..WHOLE })
}

/// Looks at bars behind a pane in one device, at a comb, or at balls that only a mirror shows; how many rays
/// that takes.
///
/// # Panics
///
/// If the picture differs from that of rays traced one by one, or if a file cannot be written.
pub fn interpolate_small(draws: &mut Draws<'_>) -> u64 {
    let folder = tempfile::tempdir().expect("a folder");
    let combs = draws.below(3) == 0;
    let text = match combs {
        true => combed(draws, folder.path()),
        false if draws.chance(128) => bars(draws),
        false => mirrored(draws),
    };
    let scene = text.parse().expect("TOML");
    let rays = compare(draws, &scene, folder.path(), WHOLE);
    assert!(rays > 1 || !combs, "refused:\n{scene}");
    rays
}

/// A pane with bars behind it, of metal or glass, along z or upright.
fn bars(draws: &mut Draws<'_>) -> String {
    let rectangle = |x: [f64; 2], y: [f64; 2]| {
        format!(
            "[[{}, {}], [{}, {}], [{}, {}], [{}, {}]]",
            x[0], y[0], x[1], y[0], x[1], y[1], x[0], y[1]
        )
    };
    let mut scene = camera();
    let axis = *draws.pick(&["[0, 0, 1]", "[0, 1, 0]", "[0.1, 0.3, 1]"]);
    scene += &format!("[[device]]\nkind = \"prisms\"\naxis = {axis}\nlength = 40\n");
    let matter = *draws.pick(&[
        "index = 1.5",
        "uniaxial = { ordinary = 1.5, extraordinary = 1.7, optic_axis = [1, 1, 0] }",
    ]);
    let pane = rectangle([-10.0, -6.0], [-20.0, 20.0]);
    scene += &format!("[[device.prism]]\ncorners = {pane}\n{matter}\n");
    let width = 10f64.powf(draws.between(-1.0, 0.5));
    let count = 2 + draws.below(5);
    for number in 0..count {
        let middle = -16.0 + 32.0 * (number as f64 + draws.between(0.2, 0.8)) / count as f64;
        let corners = rectangle([5.0, 5.0 + width], [middle, middle + width]);
        let matter = *draws.pick(&["metal = true", "index = 1.5"]);
        scene += &format!("[[device.prism]]\ncorners = {corners}\n{matter}\n");
    }
    scene
}

/// A comb of glass, seen from any side.
fn combed(draws: &mut Draws<'_>, folder: &Path) -> String {
    std::fs::write(folder.join("comb.obj"), comb(draws)).expect("a file");
    let axis = draws.direction();
    let (rotation, position) = (draws.tenths(-180.0, 180.0), draws.tenths(-20.0, 20.0));
    let matter = *draws.pick(&[
        "index = 1.5",
        "uniaxial = { ordinary = 1.5, extraordinary = 1.7, optic_axis = [1, 1, 0] }",
    ]);
    format!(
        "{}[[device]]\nkind = \"polyhedron\"\nmesh = \"comb.obj\"\naxis = [{}, {}, {}]\nrotation = {rotation}\nposition = [0, {position}, 0]\n{matter}\n",
        camera(),
        axis.x,
        axis.y,
        axis.z
    )
}

/// A bar along y with teeth towards x, as the mesh of an OBJ file: a dented solid with small parts.
fn comb(draws: &mut Draws<'_>) -> String {
    let (back, tooth, height) =
        (draws.between(2.0, 8.0), 10f64.powf(draws.between(-0.5, 1.0)), draws.between(1.0, 20.0));
    // Where teeth and gaps begin, in turns; the last gap is none.
    let mut steps = vec![-16.0];
    for _ in 0..2 * (2 + draws.below(4)) - 1 {
        let wide = 10f64.powf(draws.between(-0.5, 0.9));
        steps.push(steps.last().copied().unwrap_or_default() + wide);
    }
    // Columns of corners along y: behind the back, before it, at the ends of the teeth; each below and above.
    let columns = [0.0, back, back + tooth];
    let mut text = String::new();
    for (z, x) in [-height, height].iter().flat_map(|z| columns.map(|x| (*z, x))) {
        text.extend(steps.iter().map(|y| format!("v {x} {y} {z}\n")));
    }
    let corner = |column: usize, step: usize| column * steps.len() + step;
    // Rectangles of the outline, counter-clockwise as seen from above.
    let cell = |column: usize, step: usize| {
        [(column, step), (column + 1, step), (column + 1, step + 1), (column, step + 1)]
            .map(|(column, step)| corner(column, step))
    };
    let backs = (0..steps.len() - 1).map(|step| cell(0, step));
    let teeth = (0..steps.len() - 1).step_by(2).map(|step| cell(1, step));
    let cells: Vec<[usize; 4]> = backs.chain(teeth).collect();
    let sides = |[a, b, c, d]: [usize; 4]| [[a, b], [b, c], [c, d], [d, a]];
    let all: Vec<[usize; 2]> = cells.iter().copied().flat_map(sides).collect();
    let above = columns.len() * steps.len();
    let mut face = |corners: [usize; 4]| {
        let [a, b, c, d] = corners.map(|corner| corner + 1);
        text += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
    };
    for [a, b, c, d] in cells {
        face([a, b, c, d].map(|corner| corner + above));
        face([d, c, b, a]);
    }
    for [a, b] in all.iter().filter(|[a, b]| !all.contains(&[*b, *a])) {
        face([*a, *b, b + above, a + above]);
    }
    text
}

/// Balls behind the camera, and a mirror behind glass before it.
fn mirrored(draws: &mut Draws<'_>) -> String {
    let mut scene = camera();
    let rotation = draws.between(-10.0, 10.0);
    for (x, matter) in [(0.0, "index = 1.5"), (2.5, "metal = true")] {
        scene += &format!(
            "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [2, 60, 60]\nrotation = {rotation}\nposition = [{x}, 0, 0]\n{matter}\n"
        );
    }
    for _ in 0..2 + draws.below(4) {
        let radius = 10f64.powf(draws.between(-0.5, 0.8));
        let (x, y, z) =
            (draws.between(-160.0, -108.0), draws.between(-40.0, 40.0), draws.between(-40.0, 40.0));
        scene += &format!(
            "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = {radius}\nposition = [{x}, {y}, {z}]\nsurface = {{ color = [0.9, 0.1, 0.1] }}\n"
        );
    }
    scene
}

fn camera() -> String {
    let [width, height] = SIZE;
    format!(
        "[camera]\nresolution = [{width}, {height}]\nsamples = {SAMPLES}\nposition = [-100, 0, 0]\n[surroundings]\ncolor = [0.5, 0.5, 0.5]\n"
    )
}

/// Compares a part of a picture. `folder` has the files that the scene names.
fn compare(draws: &mut Draws<'_>, scene: &Table, folder: &Path, part: Tile) -> u64 {
    // Pictures differ within the tolerance: coarser ones would show.
    let tolerance = 10f64.powf(draws.between(-9.0, -6.0));
    let scene = |exact: bool| {
        let mut scene = scene.clone();
        let trace: [(_, Value); 2] = [("tolerance", tolerance.into()), ("exact", exact.into())];
        let trace = trace.map(|(key, value)| (key.to_owned(), value));
        scene.insert("trace".to_owned(), Value::Table(Table::from_iter(trace)));
        scene.to_string()
    };
    let looked_at = |exact: bool| {
        let loaded = scene_file::parse(&scene(exact), "soak", folder, &[]).ok()?;
        let prepared = PreparedScene::new(&loaded.scene).ok()?;
        let stop = AtomicBool::new(false);
        let supervision = Supervision { rows_done: &|_| {}, stop: &stop };
        let rendered = render_tile(&prepared, ChannelSet::Image, part, &supervision);
        let picture = rendered.expect("a picture").picture;
        Some(to_srgb(&picture).expect("an image"))
    };
    let (Some(shared), Some(exact)) = (looked_at(false), looked_at(true)) else { return 1 };
    let mut differ = 0;
    for (shared, exact) in shared.pixels().zip(exact.pixels()) {
        let steps = shared.0.iter().zip(exact.0).map(|(one, other)| one.abs_diff(other));
        let most = steps.max().unwrap_or(0);
        assert!(most <= 1, "a pixel of {part} is off by {most} steps:\n{}", scene(false));
        differ += usize::from(most > 0);
    }
    assert!(differ <= ROUNDED, "{differ} pixels of {part} differ:\n{}", scene(false));
    (2 * SAMPLES * SIZE[0] * SIZE[1]).unsigned_abs()
}
