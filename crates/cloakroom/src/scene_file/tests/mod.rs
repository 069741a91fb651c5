//! Tests of scene files: what is read, and what is said about what cannot be.

mod any_input;
mod messages;
mod names;

use std::path::{Path, PathBuf};

use super::*;
use crate::keys::{Given, Value};
use crate::photograph::ImageSource;
use crate::scene::{CameraSettings, DeviceSettings, Polarizer, Projection, Show};

fn read(text: &str) -> Result<Loaded, SceneFileError> {
    read_with(text, &[])
}

fn read_with(text: &str, overrides: &[&str]) -> Result<Loaded, SceneFileError> {
    let overrides: Vec<_> = overrides.iter().map(|&text| text.into()).collect();
    parse(text, "scene.toml", Path::new("scenes"), &overrides)
}

#[test]
fn keys_are_set_to_values_as_to_text() {
    let text = "[[device]]\nkind = \"square-cloak\"\n";
    let set = |key: &str, value: Value| Override::value(key, value);
    let with = |each: Override| parse(text, "scene.toml", Path::new(""), &[each]);
    let by_value = with(set("device.0.rotation", 5.5.into())).unwrap_or_else(|e| panic!("{e}"));
    let by_text = with("device.0.rotation=5.5".into()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(by_value.scene.source, by_text.scene.source);
    // A text that looks like a number is a text.
    let message = |each: Override| with(each).map(drop).expect_err("wrong").to_string();
    let wrong = message(set("device.0.rotation", Value::Text("5".to_owned())));
    assert!(wrong.contains("device.0.rotation=\"5\""), "{wrong}");
    let wrong = message(set("device.0.rotatoin", 5.0.into()));
    assert!(wrong.contains("did you mean"), "{wrong}");
}

fn scene_with(text: &str, overrides: &[&str]) -> Scene {
    read_with(text, overrides).unwrap_or_else(|error| panic!("{error}")).scene
}

/// Everything a scene says, beside its own text.
fn said(scene: &Scene) -> String {
    format!("{:?}", Scene { source: String::new(), ..scene.clone() })
}

const EVERYTHING: &str = r#"
[camera]
position = [-90, 1.5, 0]
target = [40, 0, 0]
up = [0, 1, 1]
projection = "orthographic"
width = 60
resolution = [640, 480]
samples = 16
seed = 7
polarizer = 30

[light]
wavelength_nm = 633

[photograph]
image = "me.png"
x = 60
width = 80

[surroundings]
image = "sky.exr"

[trace]
min_power = 1e-6
tolerance = 1e-7

[picture]
channels = ["stokes", "first_face_reflectance"]
map = "time_of_flight"
color_bar = false

[[device]]
kind = "square-cloak"
show = "bare"
core = "metal"
rotation = 10
position = [1, 2, 3]
length = 40
side = 12

[[device]]
kind = "square-cloak"
position = [0, 50, 0]
"#;

#[test]
fn an_empty_file_is_the_default_scene() {
    for text in ["", "\n", "# nothing\n", "\u{feff}", "[camera]\n[trace]\n", "device = []"] {
        assert_eq!(said(&scene_with(text, &[])), said(&Scene::default()), "{text:?}");
    }
}

fn side(device: &DeviceSettings) -> Option<Value> {
    device.device.table().get("side")
}

#[test]
fn every_key_is_read() {
    let scene = scene_with(EVERYTHING, &[]);
    let camera: &CameraSettings = &scene.camera;
    assert_eq!(camera.position.to_array(), [-90.0, 1.5, 0.0]);
    assert_eq!(camera.up.to_array(), [0.0, 1.0, 1.0]);
    assert_eq!((camera.projection, camera.width), (Projection::Orthographic, Some(60.0)));
    assert_eq!((camera.resolution, camera.samples, camera.seed), ([640, 480], 16, 7));
    assert_eq!(camera.polarizer, Polarizer::Angle(30.0));
    assert_eq!(scene.light.wavelength_nm, 633.0);
    assert_eq!(scene.photograph.image, ImageSource::File("scenes/me.png".into()));
    assert_eq!((scene.photograph.x, scene.photograph.width), (Given::from(60.0), Some(80.0)));
    let sky = ImageSource::File("scenes/sky.exr".into());
    assert_eq!(scene.surroundings.image, Some(sky));
    assert_eq!(scene.trace.min_power, Given::from(1e-6));
    assert_eq!(scene.trace.tolerance, 1e-7);
    assert_eq!(
        (scene.picture.map.name(), scene.picture.color_bar),
        (Some("time_of_flight"), false)
    );
    let [first, second] = scene.devices.as_slice() else { panic!("two devices") };
    assert_eq!((first.kind(), first.placement.show), ("square-cloak", Show::Bare));
    assert_eq!(
        (first.placement.rotation, first.placement.position.to_array()),
        (10.0, [1.0, 2.0, 3.0])
    );
    assert_eq!((first.placement.length, side(first)), (Some(40.0), Some(12.0.into())));
    assert_eq!((second.placement.rotation, second.placement.length), (0.0, None));
    assert_eq!(side(second), Some(14.1.into()));
    assert_eq!(scene.source, EVERYTHING);
}

#[test]
fn overrides_set_keys_that_are_there_and_keys_that_are_not() {
    let scene = scene_with(
        EVERYTHING,
        &[
            "camera.samples=1",
            " camera.position = [1, 2, 3] ",
            "camera.up.0=0.5",
            "photograph.image=holiday.jpg",
            "device.1.show=mirror",
            "device.1.rotation=-1e1",
            "device.2.kind=square-cloak",
            "device.2.side=3",
        ],
    );
    assert_eq!(scene.camera.samples, 1);
    assert_eq!(scene.camera.position.to_array(), [1.0, 2.0, 3.0]);
    assert_eq!(CameraSettings::clone(&scene.camera).up.to_array(), [0.5, 1.0, 1.0]);
    // Files in overrides are relative to the current folder.
    assert_eq!(scene.photograph.image, ImageSource::File("holiday.jpg".into()));
    let second = &scene.devices[1].placement;
    assert_eq!((second.show, second.rotation), (Show::Mirror, -10.0));
    assert_eq!(scene.devices.len(), 3);
    assert_eq!(side(&scene.devices[2]), Some(3.0.into()));

    let scene = scene_with("", &["device.0.kind=square-cloak", "light.wavelength_nm=600"]);
    assert_eq!((scene.devices.len(), scene.light.wavelength_nm), (1, 600.0));
    let scene = scene_with("", &[r#"device.0={kind="square-cloak", side=2}"#]);
    assert_eq!(side(&scene.devices[0]), Some(2.0.into()));
    let scene = scene_with("", &[r#"camera={samples=2}"#, "photograph.image=2024-01-01"]);
    assert_eq!(scene.camera.samples, 2);
    assert_eq!(scene.photograph.image, ImageSource::File("2024-01-01".into()));
    assert_eq!(scene_with("", &["camera.seed=1", "camera.seed=2"]).camera.seed, 2);
}

#[test]
fn an_override_repairs_what_it_replaces() {
    let text = "[camera]\nsamples = -4\n";
    assert!(read(text).is_err());
    assert_eq!(scene_with(text, &["camera.samples=4"]).camera.samples, 4);
}

#[test]
fn the_source_of_an_overridden_scene_reads_as_the_same_scene() {
    let overrides = ["camera.samples=3", "device.1.rotation=0.1", "trace.tolerance=1.5e-9"];
    let scene = scene_with(EVERYTHING, &overrides);
    assert_eq!(said(&scene_with(&scene.source, &[])), said(&scene));
    let scene = scene_with("", &["device.0.kind=square-cloak", "light.wavelength_nm=1e11"]);
    assert_eq!(said(&scene_with(&scene.source, &[])), said(&scene));
}

#[test]
fn files_are_read_or_it_is_said_why_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.toml");
    let error = |path: &Path| load(path, &[]).expect_err("no scene");
    let missing = error(&path);
    assert_eq!(missing.to_string(), format!("{}: there is no such file", path.display()));
    assert!(error(folder.path()).message.contains("folder"));

    std::fs::write(&path, "[photograph]\nimage = 'me.png'\n").expect("written");
    let loaded = load(&path, &[]).expect("a scene");
    let image = ImageSource::File(folder.path().join("me.png"));
    assert_eq!(loaded.scene.photograph.image, image);

    std::fs::write(&path, b"[camera]\n# \xff\n").expect("written");
    let latin = error(&path);
    assert_eq!((latin.line, latin.message.as_str()), (Some(2), "the file is not UTF-8 text"));
    assert_eq!(load(Path::new(""), &[]).expect_err("no name").line, None);
}

#[test]
fn later_checks_can_point_at_parts_of_the_scene() {
    let locations = read_with(EVERYTHING, &["device.1.rotation=5"]).expect("a scene").locations;
    let line = |path: &str| locations.error_at(path, "wrong").line;
    let line_of = |part: &str| {
        let at = EVERYTHING.find(part).expect("there");
        u32::try_from(EVERYTHING[..at].matches('\n').count() + 1).ok()
    };
    assert_eq!(line("camera.up"), line_of("up = "));
    assert_eq!(line("device.0.side"), line_of("side"));
    assert_eq!(line("device.0"), line_of("[[device]]"));
    assert_eq!(line("device.1"), line_of("[[device]]").map(|first| first + 9));
    assert_eq!(line("device.1.side"), line("device.1"), "not written: the device's header");
    assert_eq!(line("banana.split"), None);
    let overridden = locations.error_at("device.1.rotation", "wrong");
    assert_eq!(overridden.to_string(), "--set device.1.rotation=5: wrong");
    let error = crate::keys::KeyError::at("side", "too large");
    assert_eq!(locations.key_error("device.0", &error).line, line_of("side"));
    let nowhere = Locations::new("scene", "", &[]).error_at("device.0", "wrong");
    assert_eq!(nowhere.to_string(), "scene: wrong");
}

#[test]
fn base_folders_do_not_touch_absolute_names() {
    let scene = scene_with("[photograph]\nimage = '/me.png'", &[]);
    assert_eq!(scene.photograph.image, ImageSource::File(PathBuf::from("/me.png")));
}
