//! What happens to others' machines: processes killed at any moment, folders that cannot be
//! written, little memory, clocks that jump. No damaged file under a final name, and work begun
//! again ends with the same bytes.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::long;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant, SystemTime};
use tempfile::TempDir;

const SCENE: &str =
    "[camera]\nresolution = [96, 72]\nsamples = 4\n[[device]]\nkind = \"double-gaussian-cloak\"\n";

fn desk() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

fn program() -> PathBuf {
    assert_cmd::cargo::cargo_bin("cloakroom")
}

fn cloakroom(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(program());
    command.current_dir(folder).args(arguments).env_remove("RUST_BACKTRACE");
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// The same after limits of the shell, its message kept.
fn limited(folder: &Path, limit: &str, arguments: &[&str]) -> Output {
    let mut command = Command::new("bash");
    let script = format!("{limit}; exec \"$0\" \"$@\"");
    command.args(["-c", &script]).arg(program()).args(arguments).env_remove("RUST_BACKTRACE");
    command.current_dir(folder).output().unwrap()
}

fn one_message(output: &Output, parts: &[&str]) {
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.starts_with("error: "), "{message}");
    assert_eq!(message.lines().count(), 1, "{message}");
    parts.iter().for_each(|part| assert!(message.contains(part), "{part:?}: {message}"));
}

/// Every file under its final name, in this folder and those in it.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_none_or(|ending| ending != "part") {
            let bytes = fs::read(&path).unwrap();
            found.insert(path, bytes);
        }
    }
    found
}

/// Kills a command after ever longer times, until it ends by itself; no file may ever be there in
/// part. `clear` is what to remove before each try.
fn killed(arguments: &[&str], clear: bool) {
    let whole = desk();
    let start = Instant::now();
    assert!(cloakroom(whole.path(), arguments).status().unwrap().success());
    let time = start.elapsed();
    let expected: BTreeMap<PathBuf, Vec<u8>> = files(whole.path())
        .into_iter()
        .map(|(path, bytes)| (path.strip_prefix(whole.path()).unwrap().to_owned(), bytes))
        .collect();
    let desk = desk();
    let kills = long::count(6, 12);
    for number in 1..=kills {
        let mut child = cloakroom(desk.path(), arguments).spawn().unwrap();
        std::thread::sleep(time * number / (kills - 1));
        // It may have ended.
        let _ = child.kill();
        child.wait().unwrap();
        for (path, bytes) in files(desk.path()) {
            let name = path.strip_prefix(desk.path()).unwrap();
            // Frames go when the film is there.
            match expected.get(name) {
                Some(expected) => assert!(*expected == bytes, "{} is damaged", name.display()),
                None => assert!(image::open(&path).is_ok(), "{} is damaged", name.display()),
            }
            if clear && name != Path::new("scene.toml") {
                fs::remove_file(path).unwrap();
            }
        }
    }
    assert!(cloakroom(desk.path(), arguments).status().unwrap().success());
    for (name, bytes) in expected {
        assert!(fs::read(desk.path().join(&name)).unwrap() == bytes, "{}", name.display());
    }
}

#[test]
fn render_killed_at_any_moment() {
    let outputs = ["-o", "a.png", "-o", "a.npz", "-o", "a.exr"];
    killed(&[&["render", "scene.toml"][..], &outputs].concat(), true);
}

#[test]
fn figures_killed_at_any_moment() {
    killed(&["figures", "--only", "6", "--size", "48x36", "--samples", "1", "--out", "."], false);
}

#[test]
fn animate_killed_at_any_moment() {
    let sweep = ["--sweep", "device.0.rotation=0..90", "--frames", "6"];
    killed(&[&["animate", "scene.toml"][..], &sweep, &["-o", "a.gif"]].concat(), false);
}

#[test]
fn folders_that_cannot_be_written() {
    // A folder of the system, where root can make no files either; nobody is kept from a folder of
    // its own otherwise.
    let folder = Path::new("/proc/self");
    let desk = desk();
    let scene = desk.path().join("scene.toml");
    let scene = scene.to_str().unwrap();
    for arguments in [
        &["render", scene, "-o", "/proc/self/a.png"][..],
        &["figures", "--only", "6c", "--size", "8x6", "--out", "/proc/self/figures"],
        &["animate", scene, "--sweep", "device.0.rotation=0,1", "-o", "/proc/self/a.gif"],
    ] {
        let start = Instant::now();
        one_message(&limited(desk.path(), "true", arguments), &["/proc/self"]);
        // Before the work, not after it.
        assert!(start.elapsed() < Duration::from_secs(20));
    }
    assert!(folder.is_dir());
}

#[test]
fn disks_that_run_full() {
    // A limit on the size of files stands for a disk that runs full while a file is written.
    let full = "trap '' XFSZ; ulimit -f 1";
    for arguments in [
        &["figures", "--only", "6c", "--size", "200x150", "--samples", "1", "--out", "out"][..],
        &["animate", "scene.toml", "--sweep", "device.0.rotation=0,1", "-o", "out.gif"],
        &["export", "scene.toml", "-o", "out.vti"],
    ] {
        let desk = desk();
        one_message(&limited(desk.path(), full, arguments), &["cannot write"]);
        let left = files(desk.path());
        assert_eq!(left.len(), 1, "{:?}", left.keys());
    }
}

/// The limit of the process counts as the memory that there is.
#[cfg(target_os = "linux")]
#[test]
fn more_than_the_memory_is_refused_before_the_work() {
    let desk = desk();
    let little = "ulimit -v 3000000";
    let large = "camera.resolution=[20000, 20000]";
    let render = ["render", "scene.toml", "--set", large, "-o", "a.npz", "--threads", "2"];
    one_message(&limited(desk.path(), little, &render), &["memory", "MB"]);
    let grid = ["export", "scene.toml", "-o", "a.npz", "--grid", "2000x2000x100"];
    one_message(&limited(desk.path(), little, &grid), &["memory"]);
    // A stream without end is not taken in.
    let rays = ["trace", "scene.toml", "--rays", "/dev/zero"];
    one_message(&limited(desk.path(), little, &rays), &["longer than 1024 MiB"]);
    assert_eq!(files(desk.path()).len(), 1);
}

#[test]
fn clocks_that_jump() {
    let desk = desk();
    let at = desk.path();
    let picture = image::RgbImage::from_fn(40, 30, |x, y| image::Rgb([x as u8, y as u8, 7]));
    picture.save(at.join("photo.png")).unwrap();
    let arguments = [
        "animate",
        "scene.toml",
        "--set",
        "photograph.image=photo.png",
        "--sweep",
        "device.0.rotation=0,5",
        "-o",
        "frames",
    ];
    assert!(cloakroom(at, &arguments).status().unwrap().success());
    let made = files(&at.join("frames"));
    // Frames from the future, a photograph from the past, and the other way round: the same film
    // comes out.
    let day = Duration::from_secs(86_400);
    for (frames, photo) in [(day, Duration::ZERO), (Duration::ZERO, day)] {
        let set = |path: &Path, ahead: Duration| {
            let file = File::options().write(true).open(path).unwrap();
            file.set_modified(SystemTime::now() + ahead).unwrap();
        };
        made.keys().for_each(|path| set(path, frames));
        set(&at.join("photo.png"), photo);
        assert!(cloakroom(at, &arguments).status().unwrap().success());
        assert!(files(&at.join("frames")) == made);
    }
}
