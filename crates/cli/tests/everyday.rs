//! The command line for every day: short ways to say what is common, and words that help.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::running::{cloakroom, stdout};
use std::fs;
use std::path::Path;
use std::process::Output;

const SCENE: &str =
    "[camera]\nresolution = [40, 30]\nsamples = 1\n[[device]]\nkind = \"square-cloak\"\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    cloakroom().current_dir(folder).args(arguments).output().unwrap()
}

fn succeeds(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {words}");
    String::from_utf8(output.stdout).unwrap()
}

/// The message of a command that fails with that status.
fn fails(folder: &Path, arguments: &[&str], status: i32) -> String {
    let output = run(folder, arguments);
    assert_eq!(output.status.code(), Some(status), "{arguments:?} {output:?}");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn a_picture_without_a_name_has_that_of_its_scene() {
    let folder = folder();
    let at = folder.path();
    fs::create_dir(at.join("deep")).unwrap();
    fs::copy(at.join("scene.toml"), at.join("deep/cloak.toml")).unwrap();
    let said = run(at, &["render", "deep/cloak.toml"]);
    assert_eq!(String::from_utf8(said.stderr).unwrap().trim(), "deep/cloak.png");
    assert!(at.join("deep/cloak.png").exists());
    // An example is no file: its picture goes where one is.
    succeeds(at, &["render", "gallery/luneburg-lens", "--size", "16x12", "--samples", "1"]);
    assert_eq!(image::image_dimensions(at.join("luneburg-lens.png")).unwrap(), (16, 12));
    assert!(fails(at, &["render", "-"], 2).contains("-o FILE"));
    assert!(fails(at, &["render", "gallery"], 1).contains("there is no such file"));
    assert!(fails(at, &["render", "scene.toml", "--tile", "0,0,4,4"], 2).contains("--output"));
}

#[test]
fn what_is_common_has_names_of_its_own() {
    let folder = folder();
    let at = folder.path();
    image::RgbImage::from_pixel(8, 6, image::Rgb([0, 255, 0])).save(at.join("green.png")).unwrap();
    let short = ["--size", "24x18", "--samples", "2", "--photo", "green.png", "-o", "short.png"];
    succeeds(at, &[&["render", "scene.toml"][..], &short].concat());
    let sets = ["camera.resolution=24x18", "camera.samples=2", "photograph.image=green.png"];
    let sets = sets.iter().flat_map(|set| ["--set", set]).collect::<Vec<_>>();
    succeeds(at, &[&["render", "scene.toml"][..], &sets, &["-o", "long.png"]].concat());
    let open = |name: &str| image::open(at.join(name)).unwrap().into_rgb8();
    assert_eq!(open("short.png"), open("long.png"));
    assert_eq!(open("short.png").dimensions(), (24, 18));
    // What is said by --set goes before.
    succeeds(
        at,
        &[
            "render",
            "scene.toml",
            "--size",
            "8x6",
            "--set",
            "camera.resolution=12x9",
            "-o",
            "a.png",
        ],
    );
    assert_eq!(open("a.png").dimensions(), (12, 9));
    assert!(fails(at, &["render", "scene.toml", "--size", "8"], 2).contains("WIDTHxHEIGHT"));
}

#[test]
fn the_empty_view_is_that_of_no_devices() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("nothing.toml"), SCENE.split("[[device]]").next().unwrap()).unwrap();
    succeeds(at, &["render", "scene.toml", "--set", "device.0.rotation=20", "-o", "turned.png"]);
    succeeds(at, &["render", "scene.toml", "--empty", "-o", "flag.png"]);
    succeeds(at, &["render", "scene.toml", "--set", "device.0.show=empty", "-o", "key.png"]);
    succeeds(at, &["render", "nothing.toml", "-o", "nothing.png"]);
    let open = |name: &str| image::open(at.join(name)).unwrap().into_rgb8();
    assert_eq!(open("flag.png"), open("nothing.png"));
    assert_eq!(open("key.png"), open("nothing.png"));
    assert_ne!(open("turned.png"), open("nothing.png"));
    // A body and a lens can be taken away, too, and core = "open" is no hindrance.
    for device in ["body", "luneburg-lens", "cylinder-cloak\"\ncore = \"open"] {
        let text = format!("[[device]]\nkind = \"{device}\"\nshow = \"empty\"\n");
        fs::write(at.join("away.toml"), text).unwrap();
        assert!(succeeds(at, &["check", "away.toml"]).contains("shown as empty"));
    }
    let message = fails(at, &["export", "away.toml", "-o", "a.csv"], 1);
    assert!(message.contains("is not shown"), "{message}");
}

#[test]
fn every_device_and_unwritten_entries_can_be_set() {
    let folder = folder();
    let at = folder.path();
    let two = format!("{SCENE}[[device]]\nkind = \"cylinder-cloak\"\nposition = [0, 40, 0]\n");
    fs::write(at.join("two.toml"), two).unwrap();
    let text = succeeds(at, &["check", "two.toml", "--set", "device.*.rotation=5"]);
    assert_eq!(text.matches("rotation 5 degrees").count(), 2, "{text}");
    let set = ["--set", "camera.position.1=20", "--set", "device.0.position.2=3"];
    succeeds(at, &[&["check", "scene.toml"][..], &set].concat());
    let message = fails(at, &["check", "scene.toml", "--set", "device.1.rotation=5"], 1);
    assert!(
        message.contains("there is no device.1: the scene has one device, device.0"),
        "{message}"
    );
    for (set, word) in [
        ("camera.fov=30", "`field_of_view`"),
        ("device.0.tilt=3", "`rotation`"),
        ("device.0.size=3", "`side`"),
        ("trace.epsilon=1e-7", "`tolerance`"),
        ("background.color=[1,1,1]", "`surroundings`"),
    ] {
        let message = fails(at, &["check", "scene.toml", "--set", set], 1);
        assert!(message.contains(&format!("here it is called {word}")), "{message}");
    }
}

#[test]
fn sweeps_go_along_vectors_and_entries() {
    let folder = folder();
    let quality = |sweep: &str| {
        let arguments = [
            "quality",
            "scene.toml",
            "--set",
            "camera.resolution=12x9",
            "--sweep",
            sweep,
            "--json",
        ];
        let table: serde_json::Value =
            serde_json::from_str(&succeeds(folder.path(), &arguments)).unwrap();
        table["rows"].as_array().unwrap().len()
    };
    assert_eq!(quality("camera.position.1=-5..5:5"), 3);
    assert_eq!(quality("camera.position=[-100,0,0]..[-100,3,4]:2.5"), 3);
    assert_eq!(quality("device.*.rotation=0..10:5"), 3);
}

#[test]
fn cameras_go_round_and_along_keyframes() {
    let folder = folder();
    let at = folder.path();
    let position = |name: &str| {
        let decoder = png_text(&at.join(name));
        let line = decoder.lines().find(|line| line.starts_with("position")).unwrap();
        line.split_once('=').unwrap().1.trim().to_owned()
    };
    let small = ["--size", "12x9"];
    let orbit = ["animate", "scene.toml", "--orbit", "0..360", "--frames", "4", "-o", "round"];
    let narrow = ["--set", "photograph.x=-300"];
    succeeds(at, &[&orbit[..], &small, &narrow].concat());
    // About y through x = 50, counterclockwise from above: from -x first to +z.
    assert_eq!(position("round/frame-000001.png"), "[50.0, 0.0, 150.0]");
    assert_eq!(position("round/frame-000002.png"), "[200.0, 0.0, 0.0]");
    let path = "way = 'linear'\n[[keyframe]]\nframe = 0\ncamera.position = [-100, 0, 0]\n\
                [[keyframe]]\nframe = 2\ncamera.position = [-80, 10, 0]\n";
    fs::write(at.join("path.toml"), path).unwrap();
    let along = ["animate", "scene.toml", "--keyframes", "path.toml", "-o", "along"];
    succeeds(at, &[&along[..], &small].concat());
    assert_eq!(position("along/frame-000001.png"), "[-90.0, 5.0, 0.0]");
    let vectors = ["--sweep", "camera.position=[-100,0,0]..[-80,10,0]", "--frames", "3"];
    let swept = ["animate", "scene.toml", "-o", "swept"];
    succeeds(at, &[&swept[..], &vectors, &small].concat());
    let open = |name: &str| image::open(at.join(name)).unwrap().into_rgb8();
    assert_eq!(open("swept/frame-000001.png"), open("along/frame-000001.png"));
    assert!(fails(at, &["animate", "scene.toml", "-o", "a.gif"], 2).contains("--orbit"));
    let message = fails(at, &["animate", "scene.toml", "--keyframes", "none.toml", "-o", "b"], 1);
    assert!(message.contains("none.toml: there is no such file"), "{message}");
}

/// The scene that a PNG carries.
fn png_text(path: &Path) -> String {
    let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(path).unwrap()));
    let reader = decoder.read_info().unwrap();
    let info = reader.info();
    info.utf8_text.iter().find(|text| text.keyword == "scene").unwrap().get_text().unwrap()
}

#[test]
fn help_is_in_groups_and_begins_with_an_example() {
    let help = String::from_utf8(stdout(cloakroom().arg("--help"))).unwrap();
    for part in ["Make pictures:\n  render", "Measure:\n  quality", "Look things up:", "Example:"] {
        assert!(help.contains(part), "{part:?} is not in {help}");
    }
    let help = String::from_utf8(stdout(cloakroom().args(["render", "--help"]))).unwrap();
    for part in ["Scene:", "Picture:", "Files:", "Work:", "Example:\n  cloakroom render"] {
        assert!(help.contains(part), "{part:?} is not in {help}");
    }
}

#[test]
fn devices_are_listed_with_limits_and_defaults() {
    let text = String::from_utf8(stdout(cloakroom().arg("devices"))).unwrap();
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(!text.contains("-0.000000"), "{text}");
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words(&text).contains(
            "side Side of the square. A number (cm), from 1e-6 to 1000000. [default: 14.1]"
        ),
        "{text}"
    );
    let one = String::from_utf8(stdout(cloakroom().args(["devices", "body"]))).unwrap();
    assert!(one.starts_with("body\n") && !one.contains("square-cloak"), "{one}");
    assert!(one.contains("\n  surface.color") && one.contains("rotation"), "{one}");
    let json = String::from_utf8(stdout(cloakroom().args(["devices", "--json"]))).unwrap();
    assert!(!json.contains("-0.0,") && !json.contains("-0.0\n"), "{json}");
    let message = fails(Path::new("."), &["devices", "square-cloack"], 2);
    assert!(message.contains("did you mean `square-cloak`?"), "{message}");
}

#[test]
fn check_tells_of_the_photograph() {
    let folder = folder();
    let check = |sets: &[&str]| {
        let sets = sets.iter().flat_map(|set| ["--set", set]).collect::<Vec<_>>();
        succeeds(folder.path(), &[&["check", "scene.toml"][..], &sets].concat())
    };
    let plain = check(&[]);
    assert!(!plain.contains("hint") && !plain.contains("warning"), "{plain}");
    let turned = check(&["device.0.rotation=20"]);
    assert!(turned.contains("past the photograph's edge"), "{turned}");
    let bordered = check(&["device.0.rotation=20", "photograph.border=mirror"]);
    assert!(
        !bordered.contains("hint") && bordered.contains("beyond its edge: mirror"),
        "{bordered}"
    );
    let before = check(&["photograph.x=-50"]);
    assert!(before.contains("between the camera and device 0"), "{before}");
    let views = ["camera.projection=orthographic", "camera.width=40", "photograph.x=-50"];
    assert!(check(&views).contains("between the camera and device 0"));
    for (set, told) in [
        ("device.0.position=[0,400,0]", "device 0 is out of the camera's view"),
        (
            "device.0={kind=\"sphere-cloak\",outer=0.2,inner=0.1}",
            "device 0 is less than 4 pixels large in the picture",
        ),
        ("photograph.x=-300", "none comes from the photograph, which is at"),
        ("device.0.rotation=0.1745", "device.0.rotation is 0.1745, which looks like radians"),
        ("camera.field_of_view=0.6981", "angles are in degrees: 40"),
    ] {
        let checked = check(&[set]);
        assert!(checked.contains(told), "{set}: {checked}");
    }
}

#[test]
fn the_dark_and_the_empty_are_told_where_they_are_measured() {
    let folder = folder();
    let quality = |set: &str| {
        let sweep = ["--sweep", "camera.samples=1", "--size", "16x12", "--set", set];
        let output = run(folder.path(), &[&["quality", "scene.toml"], &sweep[..]].concat());
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(quality("photograph.x=-300").contains("no light of the photograph arrives"));
    assert!(quality("device.0.position=[0,400,0]").contains("no device is in view"));
    assert_eq!(quality("camera.seed=1"), "");
}

#[test]
fn diagrams_tell_which_devices_stand_beside_their_rays() {
    let folder = folder();
    let at = folder.path();
    let diagram = |scene: &str| {
        let output = run(at, &["diagram", scene, "-o", "rays.svg", "--rays", "3"]);
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    assert_eq!(diagram("scene.toml"), "");
    let beside = "[[device]]\nkind = \"sphere-cloak\"\nname = \"ball\"\nposition = [0, 30, 50]\n";
    fs::write(at.join("beside.toml"), format!("{SCENE}length = 20\n{beside}")).unwrap();
    let told = diagram("beside.toml");
    assert!(told.contains("ball") && !told.contains("device 0"), "{told}");
}

#[test]
fn faults_are_told_in_the_words_that_were_typed() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("keys.toml"), "[[keyframe]]\nframe = 0\ndevice.0.bad = 1\n").unwrap();
    let late = "[[keyframe]]\nframe = 0\ncamera.samples = 1\n[[keyframe]]\nframe = 9\ndevice.0.side = -1\n";
    fs::write(at.join("late.toml"), late).unwrap();
    fs::write(at.join("far.toml"), "[[keyframe]]\nframe = 3e9\ndevice.0.side = 1\n").unwrap();
    let two =
        format!("{SCENE}name = \"left\"\n[[device]]\nkind = \"mirror\"\nposition = [0, 40, 0]\n");
    fs::write(at.join("two.toml"), two).unwrap();
    let animate = |words: &[&'static str]| {
        [&["animate", "scene.toml", "-o", "a.gif", "--frames", "2"], words].concat()
    };
    let check = |set: &'static str| vec!["check", "two.toml", "--set", set];
    for (arguments, told) in [
        (
            animate(&["--keyframes", "keys.toml"]),
            "error: --keyframes keys.toml, frame 0, device.0.bad=1.0: ",
        ),
        // The keyframe in which it is written, not the first frame that has it.
        (
            animate(&["--keyframes", "late.toml"]),
            "error: --keyframes late.toml, frame 9, device.0.side=-1.0: ",
        ),
        (animate(&["--keyframes", "far.toml"]), "a film has at most 100000 frames"),
        (animate(&["--orbit", "0..20:5"]), "--orbit 0..20:5: it takes no step"),
        (vec!["check", "scene.toml", "--photo", "no.png"], "error: --photo no.png: there is no"),
        (vec!["check", "gallery/prims"], "did you mean `gallery/prisms`?"),
        (vec!["check", "fig6c.toml"], "did you mean `paper/fig6c`?"),
        (check("camera.resolution=0x0"), "the first number of resolution is 0"),
        (
            check("camera.resolution=160x"),
            "`160x` is no width and height; write them as in 640x480",
        ),
        (check("device.lfet.side=2"), "did you mean `left`?"),
        (check("device.1.name=left"), "error: --set device.1.name=left: "),
        (check("device.1.position=[0,0,0]"), "\n  with --set device.1.position=[0,0,0]"),
        (check("device.1.metal=silver"), "metal = { material = \"silver\" }"),
        (check("device.1.metal=false"), "leave it out"),
    ] {
        let message = fails(at, &arguments, 1);
        assert!(message.contains(told), "{arguments:?}\n{message}");
    }
    let resolved = succeeds(at, &["check", "two.toml", "--set", "camera.resolution=160X120"]);
    assert!(resolved.contains("picture      160 x 120 pixels"));
    let warned = succeeds(at, &["check", "two.toml", "--set", "device.1.metal.index=1.5"]);
    assert!(warned.contains("the metal of device 1 does not absorb"), "{warned}");
    let empty = ["render", "two.toml", "--empty", "--set", "device.0.bad=1"];
    assert!(fails(at, &empty, 1).contains("--set device.0.bad=1"));
}

#[test]
fn meshes_and_materials_are_of_devices_by_number_or_name() {
    let folder = folder();
    let at = folder.path();
    let two = "[[device]]\nkind = \"sphere-cloak\"\nname = \"ball\"\n\
               [[device]]\nkind = \"body\"\nshape = \"slab\"\nposition = [30, 0, 0]\nindex = 1.5\n";
    fs::write(at.join("two.toml"), two).unwrap();
    succeeds(at, &["export", "two.toml", "--device", "ball", "-o", "named.stl"]);
    succeeds(at, &["export", "two.toml", "--device", "0", "-o", "numbered.stl"]);
    let bytes = |name: &str| fs::read(at.join(name)).unwrap();
    assert_eq!(bytes("named.stl"), bytes("numbered.stl"));
    let no = |words: &[&str]| fails(at, &[&["export", "two.toml"], words].concat(), 1);
    assert!(
        no(&["--device", "bal", "-o", "a.stl"]).contains("no device of the scene is called `bal`")
    );
    let beyond = no(&["--device", "2", "-o", "a.stl"]);
    assert!(beyond.contains("there is no device 2: the scene has 2 devices, 0 to 1"), "{beyond}");
    let which = no(&["-o", "a.npz"]);
    assert!(which.contains("by its number or name: device 0 (\"ball\"), device 1"), "{which}");
    assert!(no(&["--grid", "3x3x3", "-o", "a.stl"]).contains("--grid: a mesh has no cells"));
    let empty = fails(at, &["export", "scene.toml", "--set", "device=[]", "-o", "a.vti"], 1);
    assert!(empty.contains("the scene has no devices"), "{empty}");
    assert!(!at.join("a.stl").exists() && !at.join("a.vti").exists());
}

#[test]
fn a_floor_may_stand_alone_and_be_what_a_carpet_should_look_like() {
    let folder = folder();
    let at = folder.path();
    let view = "[camera]\nresolution = [40, 30]\nsamples = 1\nposition = [-60, 12, 0]\n";
    let floor = format!("{view}[[device]]\nkind = \"prisms\"\nfloor = 20\nlength = 20\n");
    let bump = "prism = [{ corners = [[-2, 0], [2, 0], [0, 1]], metal = true }]\n";
    fs::write(at.join("floor.toml"), &floor).unwrap();
    fs::write(at.join("bump.toml"), format!("{floor}{bump}")).unwrap();
    let sweep = ["--sweep", "camera.samples=1", "--size", "32x24", "--reference", "floor.toml"];
    let measured = |scene: &str| {
        let table = succeeds(at, &[&["quality", scene, "--json"], &sweep[..]].concat());
        let table: serde_json::Value = serde_json::from_str(&table).unwrap();
        table["rows"][0]["figures"]["in_place_share"].as_f64().unwrap()
    };
    assert_eq!(measured("floor.toml"), 1.0);
    assert!(measured("bump.toml") < 0.99);
    // Files tell what they are held against.
    succeeds(at, &[&["quality", "bump.toml", "-o", "plot.svg"], &sweep[..]].concat());
    let plot = fs::read_to_string(at.join("plot.svg")).unwrap();
    assert_eq!(plot.matches("floor = 20").count(), 2, "{plot}");
    // What is wrong with the reference is told of its file.
    let long =
        "kind = \"mirror\"\nrotation = 90\nposition = [0, -40, 0]\nwidth = 400\nheight = 400\n";
    fs::write(at.join("long.toml"), format!("{view}[[device]]\n{long}")).unwrap();
    let long = ["quality", "bump.toml", "--sweep", "camera.samples=1", "--reference", "long.toml"];
    let said = fails(at, &long, 1);
    assert!(said.contains("long.toml") && !said.contains("bump.toml"), "{said}");
}
