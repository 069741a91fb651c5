//! Running the command, and reading what it prints.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use assert_cmd::Command;
use serde_json::Value;
use std::path::{Path, PathBuf};

pub fn cloakroom() -> Command {
    Command::cargo_bin("cloakroom").unwrap()
}

pub fn paper(panel: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/paper/fig{panel}.toml"))
}

pub fn json(output: &[u8]) -> Value {
    serde_json::from_slice(output).unwrap()
}

pub fn stdout(command: &mut Command) -> Vec<u8> {
    command.assert().success().get_output().stdout.clone()
}
