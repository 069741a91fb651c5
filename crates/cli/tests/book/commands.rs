//! Every command of the book and the README is run, at reduced size, in a folder of its own; every
//! scene is checked.

use super::page::{Page, pages, root};
use crate::running::{cloakroom, paper};
use std::env;
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// What is written smaller before a command is run; `small.sh` does the rest.
const SMALLER: [(&str, &str); 12] = [
    ("cargo run --release -- ", "cloakroom "),
    ("--frames 120", "--frames 3"),
    ("--frames 100", "--frames 3"),
    ("--frames 50", "--frames 3"),
    ("--frames-only 0..29", "--frames-only 0..1"),
    ("--size 1600x1200", "--size 80x60"),
    ("--size 160x120", "--size 60x45"),
    ("--size 400x300 --pulse", "--size 80x60 --pulse 0..1:0.5"),
    ("--draws 20", "--draws 2"),
    ("--draws 8", "--draws 2"),
    ("--tile 0,0,2048,2048", "--tile 0,0,40,30"),
    ("--region 300,250,400,200", "--region 4,4,20,16"),
];

/// How commands begin that are not run here, and where they are.
const ELSEWHERE: [(&str, &str); 17] = [
    ("cargo test", "runs this test"),
    ("cargo bench", ".ci/long"),
    ("cargo install", "installs into the home folder; by hand"),
    ("./release.sh", "by hand, before a release"),
    ("SKIP=windows ./release.sh", "the same"),
    ("pip install ./python", ".ci/long"),
    ("python -m venv", "CONTRIBUTING's set-up; .ci/long does the same"),
    ("cd python", "the same"),
    ("../venv/bin", "the same"),
    ("cd fuzz", "by hand: nightly Rust and cargo-fuzz"),
    (
        "cargo +nightly fuzz",
        "the same; the tests of crates/robustness run each target for a moment",
    ),
    ("benches/", "by hand: other programs, a quiet machine"),
    ("target/full_wave/venv", "by hand: full-wave solvers"),
    ("python3 conformance/generate.py", "python/tests/test_conformance.py"),
    ("cloakroom view --host", "crates/viewer/browser/explains.test.js, on the network there is"),
    ("python -m cloakroom.mitsuba", "python/tests/test_mitsuba.py"),
    ("web/build.sh", ".ci/run, where there is what compiles for browsers"),
];

/// Commands for programs that need not be there, and how to know whether they are.
const WHERE_THERE_IS: [(&str, &str); 4] = [
    ("python3 -c", "python3 -c 'import numpy'"),
    (".mp4", "ffmpeg -version"),
    ("mdbook ", "mdbook --version"),
    ("man -l", "man --version"),
];

/// A mesh that a scene in the pages names.
const MESH: &str = "part.stl";

/// What came of the commands of a page.
#[derive(Default)]
struct Tried {
    run: usize,
    failed: Vec<String>,
    elsewhere: [bool; ELSEWHERE.len()],
}

#[test]
fn every_command_runs() {
    let (pages, next) = (pages(), AtomicUsize::new(0));
    let work = || {
        let pages = std::iter::from_fn(|| pages.get(next.fetch_add(1, Ordering::Relaxed)));
        pages.map(tried).collect::<Vec<Tried>>()
    };
    let all: Vec<Tried> = thread::scope(|scope| {
        let workers = [scope.spawn(work), scope.spawn(work)];
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    });
    let failed: Vec<&str> = all.iter().flat_map(|page| &page.failed).map(String::as_str).collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    let run: usize = all.iter().map(|page| page.run).sum();
    assert!(run > 60, "only {run} commands were found");
    for (i, (start, _)) in ELSEWHERE.iter().enumerate() {
        assert!(
            all.iter().any(|page| page.elsewhere[i]),
            "no page has a command `{start}` any more"
        );
    }
}

/// Runs the commands of a page in a folder of its own.
fn tried(page: &Page) -> Tried {
    let mut tried = Tried::default();
    let commands = commands(page);
    if commands.is_empty() {
        return tried;
    }
    let folder = tempfile::tempdir().unwrap();
    furnish(folder.path());
    for command in commands {
        if let Some(i) = ELSEWHERE.iter().position(|(start, _)| command.starts_with(start)) {
            tried.elsewhere[i] = true;
            continue;
        }
        let missing =
            WHERE_THERE_IS.iter().find(|(part, test)| command.contains(part) && !works(test));
        if missing.is_some() {
            continue;
        }
        let smaller = SMALLER.iter().fold(command.clone(), |text, (a, b)| text.replace(a, b));
        tried.run += 1;
        if let Err(words) = shell(&smaller, folder.path()) {
            tried.failed.push(format!("{}: {command}\n{words}", page.path));
        }
    }
    tried
}

#[test]
fn every_scene_in_the_pages_is_sound() {
    let mut scenes = 0;
    for page in pages() {
        let folder = tempfile::tempdir().unwrap();
        for (_, text) in page.code.iter().filter(|(language, _)| language == "toml") {
            scenes += 1;
            let scene = folder.path().join("of-the-page.toml");
            if text.contains(MESH) {
                let mut solid = cloakroom();
                solid.args(["export", "gallery/polyhedron", "--device", "0", "-o"]);
                solid.arg(folder.path().join(MESH)).assert().success();
            }
            fs::write(&scene, text).unwrap();
            let output = cloakroom().arg("check").arg(&scene).output().unwrap();
            let words = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}: {words}\n{text}", page.path);
        }
    }
    assert!(scenes > 5, "only {scenes} scenes were found");
}

/// The commands of a page, without comments. One goes on in the next line after a backslash and
/// within quotes.
fn commands(page: &Page) -> Vec<String> {
    let mut commands = Vec::new();
    for (_, block) in page.code.iter().filter(|(language, _)| language == "sh") {
        let (mut command, mut quoted) = (String::new(), false);
        for line in block.lines() {
            let mut before = ' ';
            for c in line.chars() {
                if c == '#' && before == ' ' && !quoted {
                    break;
                }
                quoted ^= c == '\'';
                command.push(c);
                before = c;
            }
            if quoted || before == '\\' {
                command.push('\n');
            } else {
                commands.push(std::mem::take(&mut command).trim().to_owned());
            }
        }
        assert!(command.is_empty(), "{}: {command} has no end", page.path);
    }
    commands.retain(|command| !command.is_empty());
    commands
}

/// Puts into a folder what the commands of the pages take for granted.
fn furnish(folder: &Path) {
    let scenes = folder.join("scenes");
    cloakroom().args(["scenes", "--out"]).arg(scenes).assert().success();
    // The README shows a picture of its own through a cloak.
    let picture = "docs/cloaked.png";
    fs::create_dir(folder.join("docs")).unwrap();
    fs::copy(root().join(picture), folder.join(picture)).unwrap();
    let bin = folder.join("bin");
    fs::create_dir(&bin).unwrap();
    let small = bin.join("cloakroom");
    fs::write(&small, include_str!("small.sh")).unwrap();
    fs::set_permissions(&small, Permissions::from_mode(0o755)).unwrap();
    image::RgbImage::from_fn(32, 24, |x, y| image::Rgb([8 * x as u8, 10 * y as u8, 99]))
        .save(folder.join("holiday.jpg"))
        .unwrap();
    for name in ["scene.toml", "big.toml"] {
        fs::write(folder.join(name), "[[device]]\nkind = \"square-cloak\"\nrotation = 5\n")
            .unwrap();
    }
    for (panel, name) in [("6a", "empty"), ("6c", "cloaked")] {
        let small = ["--set", "camera.resolution=[40,30]", "--set", "camera.samples=1"];
        for ending in ["npz", "png"] {
            let out = folder.join(format!("{name}.{ending}"));
            cloakroom()
                .arg("render")
                .arg(paper(panel))
                .args(small)
                .arg("-o")
                .arg(out)
                .assert()
                .success();
        }
    }
}

/// Runs a command in a folder as a user would.
fn shell(command: &str, folder: &Path) -> Result<(), String> {
    let path = env::var("PATH").unwrap_or_default();
    let output = Command::new("sh")
        .args(["-ec", command])
        .current_dir(folder)
        .env("PATH", format!("{}:{path}", folder.join("bin").display()))
        .env("CLOAKROOM", env!("CARGO_BIN_EXE_cloakroom"))
        .stdin(Stdio::null())
        .output()
        .map_err(|error| error.to_string())?;
    let words = String::from_utf8_lossy(&output.stderr);
    if output.status.success() { Ok(()) } else { Err(format!("{}\n{words}", output.status)) }
}

fn works(command: &str) -> bool {
    let mut shell = Command::new("sh");
    shell.args(["-c", command]).stdout(Stdio::null()).stderr(Stdio::null());
    shell.status().is_ok_and(|status| status.success())
}
