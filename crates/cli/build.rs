//! Tells the program the commit that it is built from.
//!
//! A published crate carries it in `.cargo_vcs_info.json`, a clone has git. Without either, the
//! program only knows its version.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let folder = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let folder = Path::new(&folder);
    let version = env::var("CARGO_PKG_VERSION").unwrap_or_default();
    let commit = packaged_commit(folder).or_else(|| cloned_commit(folder));
    let version = match commit {
        Some(commit) => format!("{version} ({commit})"),
        None => version,
    };
    println!("cargo::rustc-env=CLOAKROOM_VERSION={version}");
}

/// The commit that `cargo package` has written down.
fn packaged_commit(folder: &Path) -> Option<String> {
    let text = fs::read_to_string(folder.join(".cargo_vcs_info.json")).ok()?;
    let (_, rest) = text.split_once("\"sha1\"")?;
    let hash = rest.split('"').nth(1)?;
    Some(hash.chars().take(9).collect())
}

/// The commit and its date in the clone that this crate is a part of.
fn cloned_commit(folder: &Path) -> Option<String> {
    let root = folder.parent()?.parent()?.canonicalize().ok()?;
    // A copy without git may lie in somebody else's repository.
    let top = git(folder, &["rev-parse", "--show-toplevel"])?;
    if Path::new(&top).canonicalize().ok()? != root {
        return None;
    }
    // The reference that HEAD stands for, unless it is detached.
    let branch = git(folder, &["symbolic-ref", "--quiet", "HEAD"]);
    for name in ["HEAD", "packed-refs"].into_iter().map(str::to_owned).chain(branch) {
        let path = folder.join(git(folder, &["rev-parse", "--git-path", &name])?);
        // A path that is missing would run this script at every build.
        if path.exists() {
            println!("cargo::rerun-if-changed={}", path.display());
        }
    }
    git(folder, &["log", "-1", "--format=%h %cs", "--abbrev=9"])
}

fn git(folder: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("-C").arg(folder).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
