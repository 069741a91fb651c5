//! What is seen beyond the edge of the photograph, against photographs that are larger.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::pictures::picture_in;
use cloakroom::output::Picture;
use cloakroom::render::PreparedScene;
use cloakroom::scene_file;
use image::{Rgb, RgbImage};
use std::path::Path;

/// Pixels of a side of the photograph.
const SIDE: u32 = 64;

fn color(x: u32, y: u32) -> Rgb<u8> {
    Rgb([(x * 4) as u8, (y * 4) as u8, ((x / 8 + y / 8) % 2 * 255) as u8])
}

/// A folder with the photograph, and with one of three by three of it for each border.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let save = |image: RgbImage, name: &str| {
        image.save(folder.path().join(format!("{name}.png"))).unwrap();
    };
    save(RgbImage::from_fn(SIDE, SIDE, color), "photograph");
    let there = |border: &str, i: u32| match (border, i / SIDE) {
        (_, 1) | ("repeat", _) => i % SIDE,
        ("mirror", _) => SIDE - 1 - i % SIDE,
        (_, 0) => 0,
        _ => SIDE - 1,
    };
    for border in ["mirror", "repeat", "clamp"] {
        let large =
            RgbImage::from_fn(3 * SIDE, 3 * SIDE, |x, y| color(there(border, x), there(border, y)));
        save(large, border);
    }
    folder
}

/// The photograph with a border, or a large one instead, as `keys` have a camera see it.
fn seen(folder: &Path, border: Option<&str>, image: &str, width: f64, keys: &str) -> Picture {
    let border = border.map(|border| format!("border = '{border}'\n")).unwrap_or_default();
    let photograph = format!("[photograph]\nimage = '{image}.png'\nwidth = {width:?}\n{border}");
    picture_in(folder, &format!("{photograph}{keys}"))
}

fn largest_difference(one: &Picture, other: &Picture, channel: &str) -> f64 {
    let [one, other] = [one, other].map(|picture| &picture.channel(channel).unwrap().samples);
    let pair = |i: usize| (one.get(i) - other.get(i)).abs();
    (0..one.len())
        .map(pair)
        .fold(0.0, |most, off| if off > most || off.is_nan() { off } else { most })
}

#[test]
fn a_border_is_a_larger_photograph() {
    let folder = folder();
    let straight = "[camera]\nresolution = [60, 45]\nsamples = 2\n";
    let oblique = "[camera]\nposition = [-60, 40, 50]\nfield_of_view = 20\nresolution = [60, 45]\n\
                   samples = 1\n";
    let from_behind = "[camera]\nposition = [200, 10, 5]\nresolution = [40, 30]\nsamples = 1\n";
    let turned = "[camera]\nresolution = [80, 60]\nsamples = 1\n\
                  [[device]]\nkind = 'square-cloak'\nrotation = 7\n";
    for (keys, width, finest) in [
        (straight, 50.0, false),
        (straight, 90.0, false),
        (oblique, 40.0, false),
        (from_behind, 50.0, false),
        (turned, 60.0, false),
        // Each pixel is a part of one of the photograph.
        ("[camera]\nfield_of_view = 4\nresolution = [60, 45]\ntarget = [50, 25, 25]\n", 50.0, true),
    ] {
        for border in ["mirror", "repeat", "clamp"] {
            // Coarse copies of the image know of its edge what is near it.
            if border == "clamp" && !finest {
                continue;
            }
            let small = seen(folder.path(), Some(border), "photograph", width, keys);
            let large = seen(folder.path(), None, border, 3.0 * width, keys);
            for channel in ["R", "G", "B", "delivered", "escaped"] {
                let off = largest_difference(&small, &large, channel);
                assert!(off < 1e-5, "{border} {channel}: {off}\n{keys}");
            }
        }
    }
}

#[test]
fn beyond_the_edge_light_lands_or_goes_past() {
    let folder = folder();
    let keys = "[camera]\nresolution = [16, 12]\nsamples = 1\n";
    let sum = |picture: &Picture, channel: &str| {
        let samples = &picture.channel(channel).unwrap().samples;
        (0..samples.len()).map(|i| samples.get(i)).sum::<f64>() / samples.len() as f64
    };
    let past = seen(folder.path(), None, "photograph", 40.0, keys);
    let none = seen(folder.path(), Some("none"), "photograph", 40.0, keys);
    let mirrored = seen(folder.path(), Some("mirror"), "photograph", 40.0, keys);
    assert!(sum(&past, "escaped") > 0.5);
    assert_eq!(sum(&none, "escaped"), sum(&past, "escaped"));
    assert_eq!((sum(&mirrored, "escaped"), sum(&mirrored, "delivered")), (0.0, 1.0));
    let flights = &mirrored.channel("time_of_flight").unwrap().samples;
    assert!((0..flights.len()).all(|i| flights.get(i) > 150.0 / 30.0));
}

#[test]
fn what_cuts_the_plane_beyond_the_edge_is_in_the_way_of_a_border() {
    let prepared = |border: &str| {
        let text = format!(
            "[photograph]\nborder = '{border}'\n[[device]]\nkind = 'square-cloak'\nposition = [50, 200, 0]\n"
        );
        let loaded = scene_file::parse(&text, "test", Path::new(""), &[]).unwrap();
        PreparedScene::new(&loaded.scene).map(drop).map_err(|error| error.to_string())
    };
    assert_eq!(prepared("none"), Ok(()));
    let message = prepared("repeat").unwrap_err();
    assert!(message.contains("cuts through the photograph"), "{message}");
}
