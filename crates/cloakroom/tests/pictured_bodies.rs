//! Images on opaque bodies, seen by an orthographic camera: each face gives the image back, and the
//! round ones show it where the map says.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::pictures::picture_in;
use cloakroom::output::Picture;
use cloakroom::photograph::decode;
use cloakroom::render::{Images, PreparedScene};
use cloakroom::scene_file;
use image::{Rgb, RgbImage};
use std::path::Path;

/// Pixels of a block of one color, and how many blocks the image has.
const BLOCK: u32 = 16;
const BLOCKS: [u32; 2] = [4, 3];

fn block_color([column, row]: [u32; 2]) -> [u8; 3] {
    [(40 + 60 * column) as u8, (30 + 90 * row) as u8, (200 - 20 * column - 50 * row) as u8]
}

fn light_of(code: u8) -> f64 {
    decode(f64::from(code) / 255.0)
}

/// A folder with the image of blocks and one whose red is the column and whose green is the row, of
/// 256.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let blocks = RgbImage::from_fn(BLOCK * BLOCKS[0], BLOCK * BLOCKS[1], |x, y| {
        Rgb(block_color([x / BLOCK, y / BLOCK]))
    });
    blocks.save(folder.path().join("blocks.png")).unwrap();
    let ramp = RgbImage::from_fn(256, 256, |x, y| Rgb([x as u8, y as u8, 0]));
    ramp.save(folder.path().join("ramp.png")).unwrap();
    folder
}

/// What a camera at a position sees that looks at the origin, with a width of its view.
fn look(
    folder: &Path,
    [position, up]: [[f64; 3]; 2],
    width: f64,
    resolution: [u32; 2],
    body: &str,
) -> Picture {
    let text = format!(
        "[camera]\nprojection = \"orthographic\"\nposition = {position:?}\ntarget = [0, 0, 0]\n\
         up = {up:?}\nwidth = {width:?}\nresolution = {resolution:?}\nsamples = 1\n\
         [photograph]\nx = 500\n[[device]]\nkind = \"body\"\n{body}\n"
    );
    picture_in(folder, &text)
}

fn pixel(picture: &Picture, [x, y]: [u32; 2]) -> [f64; 3] {
    let index = y as usize * picture.width + x as usize;
    ["R", "G", "B"].map(|name| picture.channel(name).unwrap().samples.get(index))
}

#[test]
fn each_face_of_a_box_shows_the_image() {
    let folder = folder();
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let times = |axis: [f64; 3], factor: f64| axis.map(|part| part * factor);
    // From where; what is up; the width of the face; its size over its pixels is that of the image.
    for (from, up, size) in [
        (times(x, -90.0), y, [6.0, 6.0, 8.0]),
        (times(x, 90.0), y, [6.0, 6.0, 8.0]),
        (times(z, -90.0), y, [8.0, 6.0, 6.0]),
        (times(z, 90.0), y, [8.0, 6.0, 6.0]),
        (times(y, 90.0), x, [6.0, 6.0, 8.0]),
        (times(y, -90.0), times(x, -1.0), [6.0, 6.0, 8.0]),
    ] {
        for scale in [1, 2] {
            let resolution = BLOCKS.map(|blocks| blocks * BLOCK * scale);
            let body =
                format!("shape = \"box\"\nsize = {size:?}\nsurface = {{ image = \"blocks.png\" }}");
            let picture = look(folder.path(), [from, up], 8.0, resolution, &body);
            for column in 0..BLOCKS[0] {
                for row in 0..BLOCKS[1] {
                    let code = block_color([column, row]);
                    // Well inside the block.
                    for (i, j) in [(4, 4), (8, 8), (11, 4), (5, 11)] {
                        let at = [column * BLOCK + i, row * BLOCK + j].map(|k| k * scale);
                        let light = pixel(&picture, at);
                        for (light, code) in light.into_iter().zip(code) {
                            let expected = light_of(code);
                            assert!(
                                (light - expected).abs() < 1e-6,
                                "{from:?} {at:?} {light} {code}"
                            );
                        }
                    }
                }
            }
            let absorbed = &picture.channel("absorbed").unwrap().samples;
            assert!((0..absorbed.len()).all(|i| absorbed.get(i) == 1.0));
        }
    }
}

/// The column and the row of the ramp that a pixel shows.
fn coordinates(picture: &Picture, at: [u32; 2]) -> [f64; 2] {
    let [red, green, _] = pixel(picture, at);
    [red, green].map(|light| {
        // The code, by steps of linear light.
        let above = (1..=255u8).find(|code| light_of(*code) >= light).unwrap_or(255);
        let (a, b) = (light_of(above - 1), light_of(above));
        (f64::from(above - 1) + (light - a) / (b - a) + 0.5) / 256.0
    })
}

#[test]
fn round_bodies_show_it_where_the_map_says() {
    let folder = folder();
    let (n, width) = (200, 20.0);
    let surface = "surface = { image = \"ramp.png\" }";
    let sphere = format!("shape = \"sphere\"\nradius = 8\n{surface}");
    let can = format!("shape = \"cylinder\"\nradius = 6\nlength = 16\n{surface}");
    let ends = [[-90.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let [ball, side] = [&sphere, &can].map(|body| look(folder.path(), ends, width, [n, n], body));
    let end = look(folder.path(), [[0.0, 0.0, 90.0], [0.0, 1.0, 0.0]], width, [n, n], &can);
    let mut compared = 0;
    for row in (0..n).step_by(7) {
        for column in (0..n).step_by(7) {
            let place = |k: u32| (f64::from(k) + 0.5 - f64::from(n) / 2.0) * width / f64::from(n);
            let (right, up) = (place(column), -place(row));
            let mut check = |picture: &Picture, what: &str, expected: [f64; 2]| {
                let seen = coordinates(picture, [column, row]);
                for (seen, expected) in seen.into_iter().zip(expected) {
                    assert!(
                        (seen - expected).abs() < 0.004,
                        "{what} {right} {up}: {seen} {expected}"
                    );
                }
                compared += 1;
            };
            let tau = std::f64::consts::TAU;
            // From -x, z is right and y up.
            if right.hypot(up) < 7.0 {
                let depth = (64.0 - right * right - up * up).sqrt();
                let longitude = right.atan2(depth) / tau;
                check(&ball, "ball", [0.5 + longitude, (up / 8.0).acos() / (0.5 * tau)]);
            }
            if right.abs() < 7.5 && up.abs() < 5.0 {
                let around = (-up).atan2((36.0 - up * up).sqrt()) / tau;
                check(&side, "side", [0.5 + around, 0.5 - right / 16.0]);
            }
            if right.hypot(up) < 5.5 {
                check(&end, "end", [0.5 + right / 12.0, 0.5 - up / 12.0]);
            }
        }
    }
    assert!(compared > 700, "{compared}");
}

/// Stripes of one pixel each, far finer than what a pixel of the picture sees, are gray: half of
/// the light.
#[test]
fn what_is_too_fine_is_averaged_in_linear_light() {
    let folder = folder();
    let stripes = RgbImage::from_fn(1024, 512, |x, _| Rgb([if x % 2 == 0 { 0 } else { 255 }; 3]));
    stripes.save(folder.path().join("stripes.png")).unwrap();
    let surface = "surface = { image = \"stripes.png\" }";
    let view = [[-90.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for shape in ["shape = \"box\"\nsize = [8, 8, 8]", "shape = \"sphere\"\nradius = 7"] {
        let picture = look(folder.path(), view, 8.0, [16, 16], &format!("{shape}\n{surface}"));
        for row in 0..16 {
            for column in 0..16 {
                for light in pixel(&picture, [column, row]) {
                    assert!((light - 0.5).abs() < 0.02, "{shape} {column} {row} {light}");
                }
            }
        }
    }
}

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    let folder = folder();
    std::fs::write(folder.path().join("notes.png"), "no image").unwrap();
    for (keys, place, words) in [
        ("shape = \"box\"\nsurface = { image = \"no.png\" }", "4:21", "there is no image file"),
        ("shape = \"box\"\nsurface = { image = \"notes.png\" }", "4:21", "not an image"),
        ("shape = \"box\"\nsurface = { image = \"builtin:shelf\" }", "4:21", "built-in image"),
        ("shape = \"box\"\nsurface = { image = 3 }", "4:21", "the name of an image"),
        (
            "shape = \"box\"\nsurface = { color = [1, 0, 0], image = \"blocks.png\" }",
            "4:11",
            "both given",
        ),
        ("shape = \"slab\"\nsurface = { image = \"blocks.png\" }", "4:11", "endless"),
        ("shape = \"cylinder\"\nsurface = { image = \"blocks.png\" }", "4:11", "endless"),
    ] {
        let text = format!("[[device]]\nkind = \"body\"\n{keys}\n");
        let error = match scene_file::parse(&text, "test", folder.path(), &[]) {
            Err(error) => error.to_string(),
            Ok(loaded) => {
                let error = PreparedScene::new(&loaded.scene).unwrap_err();
                loaded.locations.error_at(&error.key(), error.to_string()).to_string()
            }
        };
        assert!(
            error.starts_with(&format!("test:{place}")) && error.contains(words),
            "{text}\n{error}"
        );
    }
}

#[test]
fn images_are_read_once_and_kept_while_they_are_shown() {
    let folder = folder();
    let scene = |image: &str| {
        let surface = format!("surface = {{ image = \"{image}\" }}");
        let bodies = [
            "shape = \"box\"\nsize = [4, 4, 4]\nposition = [0, 9, 0]",
            "shape = \"sphere\"\nradius = 3",
            "shape = \"cylinder\"\nradius = 3\nlength = 4\nposition = [0, -9, 0]",
        ]
        .map(|shape| format!("[[device]]\nkind = \"body\"\n{shape}\n{surface}\n"))
        .concat();
        scene_file::parse(&bodies, "a", folder.path(), &[]).unwrap().scene
    };
    let (ramp, blocks) = (scene("ramp.png"), scene("blocks.png"));
    let empty = scene_file::parse("", "a", folder.path(), &[]).unwrap().scene;
    let mut images = Images::default();
    PreparedScene::with_images(&ramp, &mut images).unwrap();
    std::fs::remove_file(folder.path().join("ramp.png")).unwrap();
    assert!(PreparedScene::new(&ramp).is_err());
    PreparedScene::with_images(&ramp, &mut images).unwrap();
    PreparedScene::with_images(&empty, &mut images).unwrap();
    PreparedScene::with_images(&ramp, &mut images).unwrap();
    PreparedScene::with_images(&blocks, &mut images).unwrap();
    assert!(PreparedScene::with_images(&ramp, &mut images).is_err());
}

/// Under a white sky over black ground, a matt surface shows a share of (1 + n.y) / 2 of what it scatters: a ball from above to
/// below, turned or not, a box and a cylinder by their faces. What is not lit shows what it always does.
#[test]
fn the_surroundings_light_what_is_lit() {
    let folder = folder();
    let sky = RgbImage::from_fn(512, 256, |_, y| Rgb([if y < 128 { 255 } else { 0 }; 3]));
    sky.save(folder.path().join("sky.png")).unwrap();
    let seen = |around: &str, eye: [f64; 3], body: &str| {
        let up = if eye[1] == 0.0 { "[0, 1, 0]" } else { "[1, 0, 0]" };
        let text = format!(
            "[camera]\nprojection = \"orthographic\"\nposition = {eye:?}\ntarget = [0, 0, 0]\nup = {up}\n\
             width = 8\nresolution = [32, 32]\nsamples = 1\n[photograph]\nx = 500\n[surroundings]\n{around}\n\
             [[device]]\nkind = \"body\"\n{body}\n"
        );
        picture_in(folder.path(), &text)
    };
    let sky = "image = \"sky.png\"";
    let red = |lit: &str| format!("surface = {{ color = [0.8, 0.2, 0.4]{lit} }}");
    let lit = red(", lit = true");
    for turn in ["", "rotation = 70\n"] {
        let ball = format!("shape = \"sphere\"\nradius = 4\n{turn}{lit}");
        let picture = seen(sky, [-90.0, 0.0, 0.0], &ball);
        for row in 2..30_u32 {
            let up = (15.5 - f64::from(row)) / 4.0 / 4.0;
            let light = pixel(&picture, [16, row]);
            for (light, color) in light.into_iter().zip([0.8, 0.2, 0.4]) {
                let expected = color * 0.5 * (1.0 + up);
                // Samples lie anywhere in their pixel.
                assert!((light - expected).abs() < 0.03 * color, "{row}: {light} {expected}");
            }
        }
    }
    for (shape, eye, share) in [
        ("shape = \"box\"\nsize = [9, 9, 9]", [-90.0, 0.0, 0.0], 0.5),
        ("shape = \"box\"\nsize = [9, 9, 9]", [0.0, 90.0, 0.0], 1.0),
        ("shape = \"box\"\nsize = [9, 9, 9]\nrotation = 90", [0.0, 90.0, 0.0], 1.0),
        ("shape = \"cylinder\"\nradius = 6\nlength = 9\naxis = [0, 1, 0]", [0.0, 90.0, 0.0], 1.0),
        ("shape = \"slab\"\nthickness = 3", [-90.0, 0.0, 0.0], 0.5),
    ] {
        let light = pixel(&seen(sky, eye, &format!("{shape}\n{lit}")), [16, 16]);
        for (light, color) in light.into_iter().zip([0.8, 0.2, 0.4]) {
            assert!((light / (color * share) - 1.0).abs() < 0.01, "{shape}: {light}");
        }
        let own = pixel(&seen(sky, eye, &format!("{shape}\n{}", red(""))), [16, 16]);
        assert!((own[0] - 0.8).abs() < 1e-6, "{shape}: {own:?}");
        // Light that is the same all around is what a surface scatters of it; none is black.
        let even = pixel(&seen("color = [0.5, 1, 2]", eye, &format!("{shape}\n{lit}")), [16, 16]);
        for (light, expected) in even.into_iter().zip([0.4, 0.2, 0.8]) {
            assert!((light - expected).abs() < 1e-6, "{shape}: {even:?}");
        }
        assert_eq!(pixel(&seen("", eye, &format!("{shape}\n{lit}")), [16, 16]), [0.0; 3]);
    }
}
