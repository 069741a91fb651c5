//! Devices that have names.

use super::{read_with, scene_with};
use crate::scene::DeviceName;

const TWO: &str = "[[device]]\nkind = \"mirror\"\nname = \"left\"\n\
                   [[device]]\nkind = \"body\"\nname = \"right-hand\"\nposition = [30, 0, 0]\n";

#[test]
fn overrides_take_the_name_of_a_device_for_its_number() {
    for (set, number) in [
        ("left.rotation=5", 0),
        ("device.left.rotation=5", 0),
        ("right-hand.rotation=5", 1),
        ("device.1.rotation=5", 1),
    ] {
        let scene = scene_with(TWO, &[set]);
        assert_eq!(scene.devices[number].placement.rotation, 5.0, "{set}");
    }
    let scene = scene_with(TWO, &["device.0.name=\"a\"", "a.width=7"]);
    assert_eq!(scene.device_name(0).to_string(), "device 0 (\"a\")");
    assert_eq!(scene.device_name(7), DeviceName { number: 7, name: None });
    let error = read_with(TWO, &["middle.rotation=5"]).expect_err("no such device").to_string();
    assert!(error.contains("middle"), "{error}");
}

#[test]
fn a_name_means_one_thing() {
    for (name, place, words) in [
        ("\"left\"", "scene.toml:6:8", "device 0 is called \"left\", too"),
        ("\"light\"", "scene.toml:6:8", "the name of a table"),
        ("\"2nd\"", "scene.toml:6:8", "a letter, then letters"),
        ("\"a.b\"", "scene.toml:6:8", "a letter, then letters"),
        ("\"\"", "scene.toml:6:8", "a letter, then letters"),
        ("3", "scene.toml:6:8", "a letter, then letters"),
    ] {
        let text = TWO.replace("\"right-hand\"", name);
        let error = read_with(&text, &[]).expect_err(name).to_string();
        assert!(error.starts_with(place) && error.contains(words), "{name}\n{error}");
    }
}

#[test]
fn messages_call_a_device_by_its_name() {
    let both = "[[device]]\nkind = \"lens\"\nname = \"left\"\n\
                [[device]]\nkind = \"lens\"\nname = \"right-hand\"\nposition = [30, 0, 0]\n";
    let scene = scene_with(both, &["right-hand.position=[0, 0, 0]"]);
    let error = crate::render::assembly(&scene).expect_err("they overlap").to_string();
    let expected = "device 1 (\"right-hand\") overlaps device 0 (\"left\"); ";
    assert!(error.starts_with(expected), "{error}");
}
