//! `cloakroom animate`: films and frames, work taken up again, work that is shared.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::running::cloakroom;
use std::fs;
use std::path::Path;

const SCENE: &str =
    "[camera]\nresolution = [40, 30]\nsamples = 1\n[[device]]\nkind = \"square-cloak\"\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

fn animate(folder: &Path, arguments: &[&str]) -> std::process::Output {
    let mut command = cloakroom();
    command.current_dir(folder).args(["animate", "scene.toml"]).args(arguments);
    command.output().unwrap()
}

/// What a failed command says: one message, and nothing else.
fn failure(output: &std::process::Output) -> String {
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(output.stdout.is_empty());
    String::from_utf8(output.stderr.clone()).unwrap()
}

const TURN: [&str; 4] = ["--sweep", "device.0.rotation=0..90", "--frames", "4"];

#[test]
fn a_film_is_made_and_its_frames_go() {
    let folder = folder();
    let output = animate(folder.path(), &[&TURN[..], &["-o", "a.gif", "--fps", "10"]].concat());
    assert!(output.status.success(), "{output:?}");
    assert!(output.stdout.is_empty());
    let bytes = fs::read(folder.path().join("a.gif")).unwrap();
    assert!(bytes.starts_with(b"GIF89a"));
    // Its width and height.
    assert_eq!(bytes[6..10], [40, 0, 30, 0]);
    assert!(!folder.path().join("a.gif.frames").exists());
}

#[test]
fn shared_work_is_taken_up_where_it_was() {
    let folder = folder();
    let at = folder.path();
    let part = |range| animate(at, &[&TURN[..], &["-o", "a.png", "--frames-only", range]].concat());
    assert!(part("2..3").status.success());
    let frames = at.join("a.png.frames");
    assert!(!at.join("a.png").exists() && !frames.join("frame-000001.png").exists());
    let made = || fs::metadata(frames.join("frame-000002.png")).and_then(|f| f.modified());
    let before = made().unwrap();
    // A frame of another scene is made again, one of this stays.
    assert!(part("0..1").status.success());
    fs::copy(frames.join("frame-000000.png"), frames.join("frame-000003.png")).unwrap();
    let all = animate(at, &[&TURN[..], &["-o", "a.png", "--keep-frames"]].concat());
    let said = String::from_utf8(all.stderr).unwrap();
    assert!(all.status.success() && said.contains("3 of 4 frames were there already"), "{said}");
    assert_eq!(made().unwrap(), before);
    assert!(at.join("a.png").exists());
    // A frame is the picture that `render` makes.
    let mut render = cloakroom();
    render.current_dir(at).args(["render", "scene.toml", "-o", "b.png"]);
    render.args(["--set", "device.0.rotation=90"]);
    assert!(render.output().unwrap().status.success());
    let open = |path| image::open(path).unwrap().into_rgb8();
    assert_eq!(open(frames.join("frame-000003.png")), open(at.join("b.png")));
}

#[test]
fn maps_need_a_scale_of_their_own() {
    let folder = folder();
    let map = ["--set", "picture.map=time_of_flight_difference", "-o", "frames"];
    let output = animate(folder.path(), &[&TURN[..], &map].concat());
    assert!(failure(&output).contains("--map-range LOW,HIGH"));
    let range = ["--map-range", "-0.1,0.5"];
    assert!(animate(folder.path(), &[&TURN[..], &map, &range].concat()).status.success());
    assert_eq!(fs::read_dir(folder.path().join("frames")).unwrap().count(), 4);
}

#[test]
fn what_cannot_be_made_is_told_before_the_work() {
    let folder = folder();
    let fails = |arguments: &[&str], part: &str| {
        let output = animate(folder.path(), arguments);
        let message = failure(&output);
        assert!(message.contains(part), "{message}");
    };
    let with = |more: &[&'static str]| [&TURN[..], more].concat();
    fails(&with(&["-o", "a.avi"]), "a.avi by its ending; use .gif");
    fails(&with(&["-o", "nowhere/a.gif"]), "there is no folder nowhere");
    fails(&with(&["-o", "a.gif", "--frames-only", "2..4"]), "the frames are 0 to 3");
    fails(&["--sweep", "device.0.rotation=0..90", "-o", "a.gif"], "give --frames");
    fails(&["--sweep", "device.0.rotatoin=1,2", "-o", "a.gif"], "did you mean `rotation`");
    fails(&["--sweep", "device.0.side=10,-1", "-o", "a.gif"], "side");
    let sizes = "camera.resolution=[40,30],[50,30]";
    fails(&["--sweep", sizes, "-o", "a.gif"], "a film has one size");
    // Nothing is left of any of them but the scene.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn without_ffmpeg_videos_are_refused_at_once() {
    let folder = folder();
    let mut command = cloakroom();
    command.current_dir(folder.path()).env("PATH", "").args(["animate", "scene.toml"]);
    let output = command.args(TURN).args(["-o", "a.mp4"]).output().unwrap();
    assert!(failure(&output).contains("ffmpeg, which is not installed"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
