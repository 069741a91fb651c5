//! How `cloakroom view` opens a browser.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// In the place of a browser's launcher: keeps what it is told, and what anybody may know of that.
const LAUNCHER: &str = "#!/bin/sh\nprintf '%s\\n' \"$@\" > \"$HEARD/arguments\"\n\
                        cp \"$1\" \"$HEARD/page\"\n\
                        ls -ld \"${1%/*}\" \"$1\" | cut -c 1-10 > \"$HEARD/modes\"\n\
                        touch \"$HEARD/done\"\n";

/// All users of a machine see the command lines of its processes.
#[test]
fn the_secret_is_on_no_command_line() {
    let desk = tempfile::tempdir().unwrap();
    let [programs, heard, temporary] = ["programs", "heard", "temporary"].map(|name| {
        let folder = desk.path().join(name);
        fs::create_dir(&folder).unwrap();
        folder
    });
    let launcher = programs.join("xdg-open");
    fs::write(&launcher, LAUNCHER).unwrap();
    fs::set_permissions(&launcher, fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", programs.display(), std::env::var("PATH").unwrap());
    let mut view = Command::new(assert_cmd::cargo::cargo_bin("cloakroom"))
        .args(["view", "--port", "0"])
        .envs([("HEARD", heard.as_path()), ("TMPDIR", temporary.as_path())])
        .env("PATH", path)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut address = String::new();
    BufReader::new(view.stdout.take().unwrap()).read_line(&mut address).unwrap();
    let address = address.trim_end();
    let start = Instant::now();
    while !heard.join("done").exists() && start.elapsed() < Duration::from_secs(30) {
        std::thread::sleep(Duration::from_millis(20));
    }
    let told = |name: &str| fs::read_to_string(heard.join(name)).unwrap_or_default();
    let (arguments, page, modes) = (told("arguments"), told("page"), told("modes"));
    let asked = Command::new("kill").args(["-TERM", &view.id().to_string()]).status().unwrap();
    assert!(asked.success());
    assert_eq!(view.wait().unwrap().code(), Some(130));
    let secret = address.trim_end_matches('/').rsplit('/').next().unwrap();
    assert!(secret.len() == 32 && !arguments.contains(secret), "{arguments}");
    assert_eq!(page.matches(address).count(), 2, "{page}");
    assert_eq!(modes, "drwx------\n-rw-------\n");
    assert_eq!(fs::read_dir(&temporary).unwrap().count(), 0, "it is gone at the end");
}
