//! Which scenes pages may show.

use super::*;
use cloakroom::scene::Scene;
use serde_json::json;

fn opened(folder: &Path) -> Opened {
    let text = "[photograph]\nimage = 'mine.png'\n[[device]]\nkind = 'square-cloak'\n";
    let loaded = scene_file::parse(text, "a", folder, &[]).expect("a scene");
    Opened::new(&loaded, "a", folder).expect("tables")
}

fn object(value: Value) -> SceneTables {
    match value {
        Value::Object(object) => object,
        other => panic!("{other}"),
    }
}

#[test]
fn a_page_can_name_no_other_file() {
    let opened = opened(Path::new("/home/user/scenes"));
    let reads = |scene: Value, uploaded| opened.read(&object(scene), uploaded);
    let photograph = |name: &str| json!({ "photograph": { "image": name } });
    // However it is written, it is the file that the user has opened.
    for name in ["mine.png", "./mine.png", "builtin:bookshelf", "/home/user/scenes/mine.png"] {
        reads(photograph(name), None).expect(name);
    }
    let surface =
        |name: &str| json!({ "device": [{ "kind": "body", "surface": { "image": name } }] });
    let around = |name: &str| json!({ "surroundings": { "image": name } });
    for name in [
        "/etc/passwd",
        "../scenes/mine.png",
        "other.png",
        "../../../etc/passwd",
        "mine.png\u{0}",
        "file:///etc/passwd",
    ] {
        for scene in [photograph(name), surface(name), around(name)] {
            let message = reads(scene, None).expect_err(name);
            assert!(message.contains("it can open no file"), "{message}");
        }
    }
    let uploaded = opened.source_of("other.png");
    reads(photograph("other.png"), Some(&uploaded)).expect("uploaded");
    assert!(reads(photograph("third.png"), Some(&uploaded)).is_err());
    // A body, or the surroundings, would show a file of that name.
    for mut scene in [surface("other.png"), around("other.png")] {
        assert!(reads(scene.clone(), Some(&uploaded)).is_err());
        scene["photograph"] = json!({ "image": "other.png" });
        assert!(reads(scene, Some(&uploaded)).is_err());
    }
}

/// Nobody writes into the pipe: whoever opened it would wait for ever.
#[test]
#[cfg(unix)]
fn a_file_that_a_page_may_not_name_is_not_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo");
    assert!(made.success());
    let (sender, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let scene = json!({ "device": [{ "kind": "graded", "index": pipe }] });
        let read = opened(Path::new("/home/user/scenes")).read(&object(scene), None);
        sender.send(read.map(drop)).expect("heard");
    });
    let refused = receiver.recv_timeout(std::time::Duration::from_secs(20)).expect("an answer");
    assert!(refused.expect_err("refused").contains("it can open no file"));
}

/// A pipe gives its bytes once only, however often a page looks.
#[test]
fn the_index_of_the_scene_that_was_opened_is_read_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.npy");
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 4), }";
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(format!("{header:<117}\n").bytes());
    bytes.extend([1.5_f64; 16].iter().flat_map(|number| number.to_le_bytes()));
    for overridden in [false, true] {
        std::fs::write(&path, &bytes).expect("written");
        let named = if overridden { "kind = 'graded'" } else { "kind = 'graded'\nindex = 'a.npy'" };
        let change = format!("device.0.index={}", path.display());
        let changes: Vec<_> = overridden.then(|| change.as_str().into()).into_iter().collect();
        let text = format!("[[device]]\n{named}\n");
        let loaded = scene_file::parse(&text, "a", folder.path(), &changes).expect("a scene");
        let opened = Opened::new(&loaded, "a", folder.path()).expect("tables");
        std::fs::remove_file(&path).expect("removed");
        for _ in 0..2 {
            let read = opened.read(&object(opened.tables.clone()), None).expect("its own scene");
            cloakroom::render::assembly(&read.scene).expect("a device");
        }
    }
}

#[test]
fn files_named_in_overrides_are_those_of_the_user() {
    let folder = Path::new("/home/user/scenes");
    let text = "[[device]]\nkind = 'body'\n[[device]]\nkind = 'graded'\nindex = 'mine.npy'\n";
    let changes = [
        "photograph.image=a.png",
        "surroundings.image=b.png",
        "device.0.surface.image=c.png",
        "device.1.index=d.npy",
    ];
    for number in 0..=changes.len() {
        let overrides: Vec<_> = changes[..number].iter().map(|&text| text.into()).collect();
        let loaded = scene_file::parse(text, "a", folder, &overrides).expect("a scene");
        let opened = Opened::new(&loaded, "a", folder).expect("tables");
        let read = opened.read(&object(opened.tables.clone()), None).expect("its own scene");
        let absolute = |scene| {
            let paths = Scene::files(scene).into_iter().map(|(_, path)| std::path::absolute(path));
            paths.collect::<Result<Vec<_>, _>>().expect("paths")
        };
        assert_eq!(absolute(&read.scene), absolute(&loaded.scene));
    }
}

#[test]
fn scenes_survive_the_way_there_and_back() {
    for exhibit in cloakroom_figures::gallery::EXHIBITS {
        let tables = tables(exhibit.scene).expect(exhibit.name);
        let values = json::value(&Value::Object(tables.clone())).expect(exhibit.name);
        let one =
            scene_file::parse(exhibit.scene, "a", Path::new(""), &[]).expect(exhibit.name).scene;
        let other =
            scene_file::assemble(values, "a", Path::new(""), &[]).expect(exhibit.name).scene;
        assert_eq!(super::tables(&other.source), Ok(tables), "{}", exhibit.name);
        assert_eq!(one.camera, other.camera);
        assert_eq!(one.surroundings, other.surroundings);
        assert_eq!(one.devices, other.devices);
    }
}

#[test]
fn names_of_photographs_are_plain() {
    for name in ["holiday.jpg", "Foto vom Urlaub (3).PNG", "ü"] {
        assert!(is_plain_name(name), "{name}");
    }
    for name in ["", "..", "../a.png", "a/b.png", "a\\b.png", "builtin:x", ".a", "-o", "a\nb"] {
        assert!(!is_plain_name(name), "{name}");
    }
}
