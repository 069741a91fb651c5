//! What the program carries along: its version, example scenes, completions and manual pages.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::running::{cloakroom, json, stdout};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

fn text(arguments: &[&str]) -> String {
    String::from_utf8(stdout(cloakroom().args(arguments))).unwrap()
}

/// The subcommands as the help lists them.
fn commands() -> Vec<String> {
    let help = text(&["--help"]);
    let list = help.split_once("\n\n").unwrap().1.split_once("\nOptions:").unwrap().0;
    let names = list.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names = names.map(|line| line.split_whitespace().next().unwrap().to_owned());
    names.filter(|name| name != "help").collect()
}

/// Whether a program accepts a text on its standard input; `None` where there is no such program.
fn accepts(program: &str, arguments: &[&str], text: &str) -> Option<bool> {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().ok()?;
    std::io::Write::write_all(&mut child.stdin.take().unwrap(), text.as_bytes()).unwrap();
    Some(child.wait().unwrap().success())
}

#[test]
fn the_version_names_the_commit() {
    let version = text(&["--version"]);
    let start = concat!("cloakroom ", env!("CARGO_PKG_VERSION"));
    assert!(version.starts_with(start), "{version}");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let git = Command::new("git").arg("-C").arg(&root).args(["rev-parse", "HEAD"]).output();
    if let Ok(git) = git
        && git.status.success()
        && root.join(".git").exists()
    {
        let head = String::from_utf8(git.stdout).unwrap();
        let (_, commit) = version.split_once('(').unwrap();
        let (commit, date) = commit.split_once(' ').unwrap();
        assert!(commit.len() >= 9 && head.starts_with(commit), "{version} {head}");
        assert_eq!(date.trim_end().len(), "2026-01-01)".len(), "{version}");
    }
}

#[test]
fn example_scenes_are_listed_copied_and_never_written_over() {
    let list = text(&["scenes"]);
    assert!(list.lines().any(|line| line.starts_with("paper/fig7d.toml  ")), "{list}");
    let listed = json(&stdout(cloakroom().args(["scenes", "--json"])));
    let paths: Vec<_> = listed["scenes"].as_array().unwrap().iter().map(|s| &s["path"]).collect();
    assert_eq!(paths.len(), list.lines().count());

    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("scenes");
    let copy = |only: &str| {
        let mut command = cloakroom();
        command.args(["scenes", "--only", only, "--out"]).arg(&out);
        command.assert()
    };
    copy("shop-window").success().stdout("");
    let scene = out.join("shop-window.toml");
    cloakroom().arg("check").arg(&scene).assert().success();
    let again = copy("shop-window").success();
    let words = String::from_utf8_lossy(&again.get_output().stderr).into_owned();
    assert!(words.contains("they are all there"), "{words}");
    // Those that are there stay, untouched or not.
    copy("flux,shop-window").success();
    fs::write(&scene, "# mine\n").unwrap();
    let refused = copy("gallery,shop-window").code(1);
    let words = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(words.contains("differs from the example"), "{words}");
    assert_eq!(fs::read_to_string(&scene).unwrap(), "# mine\n");
    assert!(out.join("flux/window.toml").exists() && !out.join("gallery").exists());
    copy("shop-windo").code(2);
}

#[test]
fn all_example_scenes_are_sound() {
    let folder = tempfile::tempdir().unwrap();
    cloakroom().args(["scenes", "--out"]).arg(folder.path()).assert().success();
    for line in text(&["scenes"]).lines() {
        let path = line.split_whitespace().next().unwrap();
        let file = folder.path().join(path);
        cloakroom().arg("check").arg(&file).assert().success();
        if path.starts_with("flux/") {
            let few = ["--rays", "16", "--samples", "2"];
            cloakroom().arg("flux").arg(&file).args(few).assert().success();
        }
    }
}

#[test]
fn completions_know_every_command() {
    let commands = commands();
    assert!(commands.len() > 20 && commands.contains(&"render".to_owned()), "{commands:?}");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = text(&["completions", shell]);
        for command in &commands {
            assert!(script.contains(command.as_str()), "{shell}: {command}");
        }
        assert!(script.contains("min-power"), "{shell}");
        if shell != "powershell" {
            let syntax = accepts(shell, &["-n"], &script);
            assert!(syntax != Some(false), "{shell} does not understand its completions");
        }
    }
    cloakroom().args(["completions", "banana"]).assert().code(2);
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = tempfile::tempdir().unwrap();
    cloakroom().args(["manual", "--out"]).arg(folder.path()).assert().success().stdout("");
    let main = fs::read_to_string(folder.path().join("cloakroom.1")).unwrap();
    assert_eq!(main, text(&["manual"]));
    let commands = commands();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), commands.len() + 1);
    for command in &commands {
        let page =
            fs::read_to_string(folder.path().join(format!("cloakroom-{command}.1"))).unwrap();
        assert_eq!(page, text(&["manual", command]));
        assert!(
            main.contains(&format!("cloakroom\\-{}(1)", command.replace('-', "\\-"))),
            "{main}"
        );
        let lint = accepts("man", &["--warnings=all", "-l", "-"], &page);
        assert!(lint != Some(false), "man does not understand the page of {command}");
    }
    assert!(text(&["manual", "render"]).contains("\\-\\-tile"));
    cloakroom().args(["manual", "banana"]).assert().code(2);
}
