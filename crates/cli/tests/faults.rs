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
            // Frames and strips go when the work is done.
            let is_whole = match expected.get(name) {
                Some(expected) => *expected == bytes,
                None => image::open(&path).is_ok() || cloakroom::output::read_npz(&path).is_ok(),
            };
            assert!(is_whole, "{} is damaged", name.display());
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
    let full = "ulimit -f 1";
    for arguments in [
        &["figures", "--only", "6c", "--size", "200x150", "--samples", "1", "--out", "out"][..],
        &["animate", "scene.toml", "--sweep", "device.0.rotation=0,1", "-o", "out.gif"],
        &["export", "scene.toml", "-o", "out.vti"],
        &["export", "scene.toml", "-o", "out.npz"],
        &["render", "scene.toml", "--set", "camera.resolution=[200, 150]", "-o", "out.npz"],
        &["render", "scene.toml", "--set", "camera.resolution=[200, 150]", "-o", "out.exr"],
        &["flux", "scene.toml", "--rays", "16", "--angles", "0..40:1", "-o", "out.npz"],
        &["quality", "scene.toml", "--sweep", "device.0.rotation=0..20:1", "-o", "out.npz"],
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

/// Runs the command with a text on its standard input.
fn fed(folder: &Path, text: &str, arguments: &[&str]) -> Output {
    use std::io::Write;
    let mut command = cloakroom(folder, arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

#[test]
fn inputs_that_can_be_read_once_are() {
    let desk = desk();
    let at = desk.path();
    let small = ["--set", "camera.resolution=[12, 9]", "--set", "camera.samples=1"];
    let sweep = ["--sweep", "device.0.rotation=0,5,10"];
    let frames = |scene, out| [&["animate", scene][..], &small, &sweep, &["-o", out]].concat();
    assert!(cloakroom(at, &frames("scene.toml", "file")).status().unwrap().success());
    let measured = |scene| [&["quality", scene, "--json"][..], &small, &sweep].concat();
    let expected = cloakroom(at, &measured("scene.toml")).stdout(Stdio::piped()).output().unwrap();
    for (name, folder) in [("-", "dash"), ("/dev/stdin", "device")] {
        assert!(fed(at, SCENE, &frames(name, folder)).status.success());
        for frame in 0..3 {
            let bytes = |folder: &str| {
                fs::read(at.join(folder).join(format!("frame-{frame:06}.png"))).unwrap()
            };
            assert!(bytes(folder) == bytes("file"), "{name} {frame}");
        }
        let output = fed(at, SCENE, &measured(name));
        assert_eq!(String::from_utf8_lossy(&output.stderr), "");
        assert!(output.stdout == expected.stdout, "{name}");
    }
    // An index and a photograph from pipes, too.
    let array = npy(1.1);
    fs::write(at.join("index.npy"), &array).unwrap();
    let picture = image::RgbImage::from_fn(40, 30, |x, y| image::Rgb([x as u8, y as u8, 7]));
    picture.save(at.join("photo.png")).unwrap();
    let scene = |index: &str, photograph: &str| {
        format!(
            "[photograph]\nimage = \"{photograph}\"\nwidth = 90\n[[device]]\nkind = \"graded\"\nindex = \"{index}\"\n"
        )
    };
    fs::write(at.join("files.toml"), scene("index.npy", "photo.png")).unwrap();
    fs::write(at.join("pipes.toml"), scene("index.pipe", "photo.pipe")).unwrap();
    assert!(cloakroom(at, &frames("files.toml", "files")).status().unwrap().success());
    let script = "mkfifo index.pipe photo.pipe; cat index.npy > index.pipe & cat photo.png > photo.pipe & \
                  exec timeout 60 \"$0\" \"$@\"";
    let mut command = Command::new("bash");
    command.args(["-c", script]).arg(program()).args(frames("pipes.toml", "pipes"));
    assert!(command.current_dir(at).status().unwrap().success());
    for frame in 0..3 {
        let pixels = |folder: &str| {
            let file = at.join(folder).join(format!("frame-{frame:06}.png"));
            image::open(file).unwrap().into_rgb8()
        };
        assert!(pixels("pipes") == pixels("files"), "{frame}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn one_pipe_is_one_input() {
    let desk = desk();
    let at = desk.path();
    let told = "are one pipe, which gives its bytes once only";
    let rays = |scene, rays| ["trace", scene, "--rays", rays];
    for (scene, name) in [("-", "/dev/stdin"), ("/dev/stdin", "-"), ("-", "/dev/fd/0")] {
        one_message(&fed(at, SCENE, &rays(scene, name)), &[told, name]);
    }
    let images = ["photograph.image=\"/dev/stdin\"", "surroundings.image=\"/dev/fd/0\""];
    let check = ["check", "scene.toml", "--set", images[0], "--set", images[1]];
    one_message(&fed(at, "", &check), &[told, "/dev/stdin and /dev/fd/0"]);
    let sweep = ["--set", images[1], "--sweep", "device.0.rotation=0,5", "-o", "frames"];
    let animate = [&["animate", "scene.toml", "--set", images[0]][..], &sweep].concat();
    one_message(&fed(at, "", &animate), &[told]);
    // A pipe of an index that is none is not read again.
    let index = ["--set", "device.0={kind=\"graded\", index=\"/dev/stdin\"}"];
    for (bytes, said) in [("nothing at all", "no .npy file of an array"), ("", "no .npy file")] {
        let output = fed(at, bytes, &[&["check", "scene.toml"][..], &index].concat());
        one_message(&output, &["/dev/stdin", said]);
    }
    fs::write(at.join("bad.npy"), "\u{93}NUMPX").unwrap();
    let message = |name: &str, text: &str| {
        let set = format!("device.0={{kind=\"graded\", index=\"{name}\"}}");
        let output = fed(at, text, &["check", "scene.toml", "--set", &set]);
        String::from_utf8(output.stderr).unwrap().rsplit_once(name).unwrap().1.to_owned()
    };
    assert_eq!(message("/dev/stdin", "\u{93}NUMPX"), message("bad.npy", ""));
}

/// A file of numpy: 4 x 4 numbers, of which one is `index` and the others 1.
fn npy(index: f64) -> Vec<u8> {
    let text = "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 4), }";
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(format!("{text:<117}\n").bytes());
    let numbers = (0..16).map(|place| if place == 5 { index } else { 1.0 });
    bytes.extend(numbers.flat_map(f64::to_le_bytes));
    bytes
}

#[test]
fn frames_of_other_inputs_are_made_again() {
    let desk = desk();
    let at = desk.path();
    let scene = "[camera]\nresolution = [24, 18]\nsamples = 1\n[photograph]\nimage = \"photo.png\"\n\
                 [[device]]\nkind = \"graded\"\nindex = \"index.npy\"\n";
    fs::write(at.join("scene.toml"), scene).unwrap();
    let past = SystemTime::now() - Duration::from_secs(1_000_000);
    let put = |name: &str, bytes: &[u8]| {
        fs::write(at.join(name), bytes).unwrap();
        File::options().write(true).open(at.join(name)).unwrap().set_modified(past).unwrap();
    };
    let photo = |blue: u8| {
        let picture = image::RgbImage::from_fn(8, 6, |x, y| image::Rgb([x as u8, y as u8, blue]));
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        bytes.into_inner()
    };
    let arguments = ["animate", "scene.toml", "--sweep", "device.0.rotation=0,5", "-o", "frames"];
    let run = || {
        let output = cloakroom(at, &arguments).stderr(Stdio::piped()).output().unwrap();
        assert!(output.status.success());
        let kept = String::from_utf8_lossy(&output.stderr).contains("2 of 2 frames were there");
        (kept, files(&at.join("frames")))
    };
    put("index.npy", &npy(1.1));
    put("photo.png", &photo(7));
    let (_, first) = run();
    assert_eq!(run(), (true, first.clone()));
    put("index.npy", &npy(1.2));
    let (kept, second) = run();
    assert!(!kept && first.values().ne(second.values()));
    put("photo.png", &photo(200));
    let (kept, third) = run();
    assert!(!kept && second.values().ne(third.values()));
    put("index.npy", &npy(1.1));
    put("photo.png", &photo(7));
    assert_eq!(run(), (false, first));
}

#[test]
fn what_the_parent_ignores_stays_ignored() {
    for (signals, sent) in [("HUP", "HUP"), ("INT TERM HUP", "INT"), ("TERM", "TERM")] {
        let desk = desk();
        let script = format!(
            "trap '' {signals}; \"$0\" render scene.toml --set camera.samples=64 -o a.png & \
             sleep 0.3; kill -{sent} $!; sleep 0.1; kill -{sent} $!; wait $!"
        );
        let mut command = Command::new("bash");
        command.args(["-c", &script]).arg(program()).current_dir(desk.path());
        assert!(command.status().unwrap().success(), "{signals}");
        assert!(desk.path().join("a.png").exists(), "{signals}");
    }
}

#[test]
fn a_picture_goes_on_where_it_was_stopped() {
    killed(&["render", "scene.toml", "--resume", "-o", "a.npz", "-o", "a.png"], false);
    let desk = desk();
    let at = desk.path();
    let plain = ["render", "scene.toml", "-o", "a.npz", "-o", "a.png"];
    assert!(cloakroom(at, &plain).status().unwrap().success());
    let made = |name: &str| fs::read(at.join(name)).unwrap();
    let (npz, png) = (made("a.npz"), made("a.png"));
    let resumed = ["render", "scene.toml", "--resume", "-o", "a.npz", "-o", "a.png"];
    // Strips of another scene, and damaged ones, are made again. They stay where the picture cannot
    // be written.
    let folder = at.join("a.npz.strips");
    fs::remove_file(at.join("a.npz")).unwrap();
    std::os::unix::fs::symlink("/dev/full", at.join("a.npz")).unwrap();
    let other = ["render", "scene.toml", "--set", "camera.seed=9", "--resume", "-o", "a.npz"];
    one_message(&limited(at, "true", &other), &["a.npz"]);
    fs::remove_file(at.join("a.npz")).unwrap();
    let strips = files(&folder);
    assert!(strips.len() > 2, "{}", strips.len());
    let (path, bytes) = strips.iter().next().unwrap();
    fs::write(path, &bytes[..bytes.len() / 2]).unwrap();
    assert!(cloakroom(at, &resumed).status().unwrap().success());
    assert!(made("a.npz") == npz && made("a.png") == png);
    let left: Vec<_> = files(at).into_keys().collect();
    assert_eq!(left.len(), 3, "{left:?}");
}

#[test]
fn finished_strips_are_taken_as_they_are() {
    use std::os::unix::fs::MetadataExt;
    for ending in ["png", "npz", "exr"] {
        let desk = desk();
        let at = desk.path();
        let name = format!("a.{ending}");
        assert!(cloakroom(at, &["render", "scene.toml", "-o", &name]).status().unwrap().success());
        let whole = fs::read(at.join(&name)).unwrap();
        // The picture cannot be written in the end: all strips stay.
        fs::remove_file(at.join(&name)).unwrap();
        std::os::unix::fs::symlink("/dev/full", at.join(&name)).unwrap();
        let resumed = ["render", "scene.toml", "--resume", "-o", &name];
        let strips = || -> Vec<(PathBuf, u64, SystemTime)> {
            let folder = files(&at.join(format!("{name}.strips")));
            let strip = |path: PathBuf| {
                let found = fs::metadata(&path).unwrap();
                (path, found.ino(), found.modified().unwrap())
            };
            folder.into_keys().map(strip).collect()
        };
        one_message(&limited(at, "true", &resumed), &[&name]);
        let first = strips();
        assert!(first.len() > 2, "{}", first.len());
        one_message(&limited(at, "true", &resumed), &[&name]);
        assert_eq!(strips(), first);
        // A damaged one is made again, and no other.
        fs::write(&first[1].0, b"PK").unwrap();
        let damaged = strips();
        one_message(&limited(at, "true", &resumed), &[&name]);
        let mended = strips();
        let is_kept = |number: &usize| mended[*number] == damaged[*number];
        assert_eq!((0..first.len()).filter(|n| !is_kept(n)).collect::<Vec<_>>(), [1]);
        fs::remove_file(at.join(&name)).unwrap();
        assert!(cloakroom(at, &resumed).status().unwrap().success());
        assert!(fs::read(at.join(&name)).unwrap() == whole, "{name}");
        assert_eq!(files(at).len(), 2);
    }
}

#[test]
fn nothing_is_written_over_what_is_read() {
    let desk = desk();
    let at = desk.path();
    let scene = "[camera]\nresolution = [24, 18]\nsamples = 1\n[photograph]\nimage = \"photo.png\"\n\
                 [[device]]\nkind = \"graded\"\nindex = \"index.npz\"\n";
    fs::write(at.join("scene.png"), scene).unwrap();
    fs::write(at.join("index.npz"), npy(1.1)).unwrap();
    image::RgbImage::new(8, 6).save(at.join("photo.png")).unwrap();
    std::os::unix::fs::symlink("photo.png", at.join("link.png")).unwrap();
    fs::hard_link(at.join("photo.png"), at.join("hard.png")).unwrap();
    let tile = ["render", "scene.png", "--tile", "0,0,24,18", "-o", "tile.npz"];
    assert!(cloakroom(at, &tile).status().unwrap().success());
    fs::create_dir(at.join("fig")).unwrap();
    image::RgbImage::new(8, 6).save(at.join("fig/fig6c.png")).unwrap();
    image::RgbImage::new(8, 6).save(at.join("fig/eaton-lens.png")).unwrap();
    fs::create_dir(at.join("frames")).unwrap();
    image::RgbImage::new(8, 6).save(at.join("frames/frame-000001.png")).unwrap();
    let before = files(at);
    let frame = "photograph.image=frames/frame-000001.png";
    let sweep = ["--sweep", "device.0.rotation=0,5"];
    for arguments in [
        &["render", "scene.png", "-o", "scene.png"][..],
        &["render", "scene.png", "-o", "a.png", "-o", "./photo.png"],
        &["render", "scene.png", "-o", "link.png"],
        &["render", "scene.png", "-o", "hard.png"],
        &["render", "scene.png", "-o", "index.npz"],
        &["merge", "tile.npz", "-o", "tile.npz"],
        &["diagram", "scene.png", "-o", "photo.png"],
        &["export", "scene.png", "-o", "index.npz"],
        &["flux", "scene.png", "-o", "photo.png"],
        &[&["quality", "scene.png", "-o", "photo.png"][..], &sweep].concat(),
        &[&["animate", "scene.png", "-o", "photo.png"][..], &sweep].concat(),
        &[&["animate", "scene.png", "--set", frame, "-o", "frames"][..], &sweep].concat(),
        &["figures", "--only", "6c", "--photo", "fig/fig6c.png", "--out", "fig"],
        &["gallery", "--only", "eaton-lens", "--photo", "fig/eaton-lens.png", "--out", "fig"],
    ] {
        let output = limited(at, "true", arguments);
        one_message(&output, &["this run reads that file"]);
        assert!(files(at) == before, "{arguments:?}");
    }
}

#[test]
fn one_file_that_fails_keeps_no_other_from_being_written() {
    let desk = desk();
    let at = desk.path();
    std::os::unix::fs::symlink("/dev/full", at.join("full.png")).unwrap();
    let arguments = ["render", "scene.toml", "-o", "full.png", "-o", "a.npz", "-o", "b.png"];
    one_message(&limited(at, "true", &arguments), &["full.png"]);
    assert!(at.join("a.npz").exists() && image::open(at.join("b.png")).is_ok());
}

#[test]
fn all_files_that_fail_are_named_and_the_rest_is_given() {
    let desk = desk();
    let at = desk.path();
    for name in ["full.png", "full.csv", "full.exr"] {
        std::os::unix::fs::symlink("/dev/full", at.join(name)).unwrap();
    }
    let render = ["render", "scene.toml", "-o", "full.png", "-o", "a.npz", "-o", "full.exr"];
    one_message(&limited(at, "true", &render), &["write full.png: ", "; cannot write full.exr: "]);
    assert!(at.join("a.npz").exists());
    let flux = ["flux", "scene.toml", "--rays", "16", "--angles", "0..10:5"];
    let files = ["-o", "full.csv", "-o", "k.npz", "--map", "map.svg"];
    let output = limited(at, "true", &[&flux[..], &files].concat());
    one_message(&output, &["full.csv"]);
    assert!(at.join("map.svg").exists() && at.join("k.npz").exists());
    assert!(String::from_utf8_lossy(&output.stdout).contains("convergence at"));
    let quality = ["quality", "scene.toml", "--set", "camera.samples=1", "-o", "full.csv"];
    let quality = [&quality[..], &["--sweep", "device.0.rotation=0,5"]].concat();
    let output = limited(at, "true", &quality);
    one_message(&output, &["full.csv"]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("correlation"));
    let output = limited(at, "true", &[&quality[..], &["--json"]].concat());
    one_message(&output, &["full.csv"]);
    assert!(serde_json::from_slice::<serde_json::Value>(&output.stdout).is_ok());
    // Before the work, too.
    let none = ["render", "scene.toml", "-o", "no/a.png", "-o", "b.npz", "-o", "none/c.exr"];
    one_message(&limited(at, "true", &none), &["no/a.png: ", "none/c.exr: "]);
    assert!(!at.join("b.npz").exists());
}

#[test]
fn two_outputs_are_two_files() {
    let desk = desk();
    let at = desk.path();
    fs::create_dir(at.join("sub")).unwrap();
    std::os::unix::fs::symlink("new.png", at.join("link.png")).unwrap();
    fs::write(at.join("old.png"), "").unwrap();
    std::os::unix::fs::symlink("old.png", at.join("to-old.png")).unwrap();
    let names = || -> std::collections::BTreeSet<_> {
        fs::read_dir(at).unwrap().map(|entry| entry.unwrap().file_name()).collect()
    };
    let before = names();
    let sweep = ["--sweep", "device.0.rotation=0,5"];
    for arguments in [
        &["flux", "scene.toml", "-o", "two.png", "--map", "two.png"][..],
        &["render", "scene.toml", "-o", "a.png", "-o", "a.png"],
        &["render", "scene.toml", "-o", "a.png", "-o", "sub/../a.png"],
        &["render", "scene.toml", "-o", "new.png", "-o", "./link.png"],
        &["render", "scene.toml", "-o", "to-old.png", "-o", "old.png"],
        &["diagram", "scene.toml", "-o", "a.png", "-o", "./a.png"],
        &[&["quality", "scene.toml", "-o", "a.png", "-o", "a.png"][..], &sweep].concat(),
    ] {
        let output = limited(at, "true", arguments);
        one_message(&output, &["another output of this run is that file"]);
        assert_eq!(names(), before, "{arguments:?}");
        assert_eq!(fs::metadata(at.join("old.png")).unwrap().len(), 0);
    }
}

#[test]
fn words_of_a_scene_command_no_terminal() {
    let desk = desk();
    let at = desk.path();
    let name = "a\u{1b}[2J\u{202e}b.png";
    image::RgbImage::new(8, 6).save(at.join(name)).unwrap();
    let set = format!("photograph.image={name:?}").replace("\\u{1b}", "\\u001b");
    let set = set.replace("\\u{202e}", "\\u202e");
    let output = limited(at, "true", &["check", "scene.toml", "--set", &set]);
    let words = String::from_utf8(output.stdout).unwrap();
    assert!(words.contains("a\\u{1b}[2J\\u{202e}b.png"), "{words}");
    assert!(!words.contains(['\u{1b}', '\u{202e}']));
}
