//! What pages see is what `cloakroom render` makes.

use crate::page::{Heard, Server, look};
use cloakroom::output::to_srgb;
use cloakroom::render::{ChannelSet, PreparedScene, Supervision, render};
use cloakroom::scene_file;
use serde_json::json;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The picture of a scene file as RGBA.
fn rendered(text: &str) -> Vec<u8> {
    let loaded = scene_file::parse(text, "a", Path::new(""), &[]).unwrap();
    let prepared = PreparedScene::new(&loaded.scene).unwrap();
    let stop = AtomicBool::new(false);
    let supervision = Supervision { rows_done: &|_| {}, stop: &stop };
    let picture = render(&prepared, ChannelSet::Image, &supervision).unwrap().picture;
    let image = to_srgb(&picture).unwrap();
    image.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2], 255]).collect()
}

#[test]
fn finished_pictures_are_those_of_the_command_line() {
    let server = Server::start(0);
    let mut page = server.page();
    page.say(&look(1, 10.0, 5));
    let (caption, pixels) = page.finished(1);
    assert_eq!((&caption["samples"], &caption["width"]), (&json!(5), &json!(48)));
    // What is saved renders to the same picture.
    let mut scene = look(1, 10.0, 5)["look"]["scene"].clone();
    scene["camera"] = json!({ "resolution": [48, 36], "samples": 5 });
    page.say(&json!({ "save": { "scene": scene } }));
    let saved = page.hear_of("saved")["text"].as_str().unwrap().to_owned();
    assert_eq!(pixels, rendered(&saved));
}

#[test]
fn light_in_flight_arrives_moment_by_moment() {
    let server = Server::start(0);
    let mut page = server.page();
    let mut at = |id: u64, moment: f64| {
        let mut look = look(id, 0.0, 1);
        look["look"]["moment"] = json!(moment);
        page.say(&look);
        let (caption, pixels) = page.finished(id);
        let sum = pixels.chunks_exact(4).flat_map(|pixel| &pixel[..3]).map(|code| u64::from(*code));
        (caption["time_ns"].as_f64().unwrap(), sum.sum::<u64>())
    };
    let all: Vec<(f64, u64)> = (0..=8).map(|i| at(i + 1, i as f64 / 8.0)).collect();
    assert!(all.is_sorted_by(|(one, _), (other, _)| one < other), "{all:?}");
    // Dark before the first light and after the last; between them past the cloak, and later through it.
    assert_eq!((all[0].1, all[8].1), (0, 0), "{all:?}");
    assert!(all[1].1 > 0 && all[7].1 > 0, "{all:?}");
    let mut wrong = look(10, 0.0, 1);
    wrong["look"]["moment"] = json!(1.5);
    page.say(&wrong);
    let said = page.hear_of("error")["message"].to_string();
    assert!(said.contains("share from 0 to 1"), "{said}");
}

#[test]
fn pictures_come_coarse_first_and_with_all_else() {
    let server = Server::start(0);
    let mut page = server.page();
    let mut look = look(4, 10.0, 16);
    look["look"]["size"] = json!([320, 240]);
    look["look"]["beside"] = json!("bare");
    page.say(&look);
    let (mut samples, mut besides, mut section, mut numbers) = (Vec::new(), 0, None, None);
    while samples.last() != Some(&json!(16)) || besides < 4 {
        match page.listen() {
            Heard::Picture(caption, _) if caption["view"] == "bare" => {
                assert_eq!(caption["last"], true);
                besides += 1;
            }
            Heard::Picture(caption, _) => {
                if samples.is_empty() {
                    assert!(caption["width"].as_u64().unwrap() < 320);
                    assert!(caption["min_power"].as_f64().unwrap() >= 0.01);
                }
                samples.push(caption["samples"].clone());
            }
            Heard::Text(message) => {
                assert!(message["error"].is_null(), "{message}");
                section = section.or(message.get("section").cloned());
                numbers = numbers.or(message.get("numbers").cloned());
            }
            Heard::End => panic!("the server has closed the page"),
        }
    }
    assert_eq!(samples, [1, 1, 4, 16].map(|n| json!(n)));
    assert_eq!(besides, 4);
    let section = section.unwrap();
    assert_eq!(section["devices"][0]["metal"].as_array().map(Vec::len), Some(1));
    let numbers = numbers.unwrap();
    // A perfect cloak absorbs nothing, and looks more like its mirror than bare metal like the
    // empty view.
    assert_eq!(numbers["absorbed"], json!(0.0));
    let sum: f64 = ["delivered", "escaped", "absorbed", "pruned"]
        .iter()
        .map(|key| numbers[key].as_f64().unwrap())
        .sum();
    assert!((sum - 1.0).abs() < 1e-6, "{numbers}");
    let likeness = |of: &str| numbers[of]["structural_similarity"].as_f64().unwrap();
    assert!(
        likeness("to_ideal") > 0.9 && likeness("bare_to_empty") < likeness("to_ideal"),
        "{numbers}"
    );
}

#[test]
fn rays_account_for_their_power() {
    let server = Server::start(0);
    let mut page = server.page();
    page.say(&json!({ "ray": { "id": 1, "at": [0.5, 0.5] } }));
    assert!(page.hear_of("error")["message"].as_str().unwrap().contains("no picture yet"));
    let scene = json!({ "device": [{ "kind": "square-cloak", "material": "negative-uniaxial", "rotation": 4 }] });
    page.say(&json!({ "look": { "id": 2, "scene": scene, "size": [64, 48], "samples": 1 } }));
    page.finished(2);
    page.say(&json!({ "ray": { "id": 3, "at": [0.5, 0.45] } }));
    let rays = page.hear_of("rays");
    assert_eq!((&rays["id"], &rays["pixel"]), (&json!(3), &json!([32, 21])));
    let lines = rays["lines"].as_array().unwrap();
    let leaves: f64 = lines
        .iter()
        .filter(|line| line["leaves"] == true)
        .map(|line| line["power"].as_f64().unwrap())
        .sum();
    assert!(lines.len() > 10 && leaves > 0.8 && leaves <= 1.0 + 1e-9, "{leaves}");
    let pulses = &rays["pulses"];
    let sum: f64 = ["delivered", "escaped", "absorbed", "pruned"]
        .iter()
        .map(|key| pulses[key].as_f64().unwrap())
        .sum();
    assert!((sum - 1.0).abs() < 1e-9, "{pulses}");
    // The strongest ray that lands does so where the strongest pulse comes from.
    let lands = lines.iter().find(|line| line["lands"] == true).unwrap();
    let landing = lands["points"].as_array().unwrap().last().unwrap();
    assert!((landing[0].as_f64().unwrap() - 50.0).abs() < 1e-3, "{landing}");
}

#[test]
fn new_wishes_cancel_stale_work() {
    let server = Server::start(0);
    let mut page = server.page();
    let scene = json!({ "device": [{ "kind": "square-cloak", "material": "negative-uniaxial", "rotation": 7 }] });
    page.say(&json!({ "look": { "id": 1, "scene": scene, "size": [2000, 2000], "samples": 64 } }));
    page.hear_of("section");
    let start = std::time::Instant::now();
    page.say(&look(2, 3.0, 1));
    page.finished(2);
    // The first one would take minutes.
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

#[test]
fn impossible_scenes_are_explained() {
    let server = Server::start(0);
    let mut page = server.page();
    let fails = |page: &mut crate::page::Page, device: serde_json::Value, part: &str| {
        let scene = json!({ "device": [device] });
        page.say(&json!({ "look": { "id": 5, "scene": scene, "size": [8, 8], "samples": 1 } }));
        let error = page.hear_of("error");
        let message = error["message"].as_str().unwrap();
        assert!(error["id"] == 5 && message.contains(part), "{error}");
    };
    fails(&mut page, json!({ "kind": "square-cloak", "sied": 3 }), "did you mean");
    fails(&mut page, json!({ "kind": "square-cloak", "side": -3 }), "side");
    fails(&mut page, json!({ "kind": "cylinder-cloak", "inner": 12 }), "inner");
    fails(
        &mut page,
        json!({ "kind": "sphere-cloak", "position": [-100, 0, 0] }),
        "the camera stands inside",
    );
    page.say(&look(6, 3.0, 1));
    page.finished(6);
}
