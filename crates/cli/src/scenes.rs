//! `cloakroom scenes`: the example scenes, listed or copied.

use crate::arguments::ScenesArguments;
use crate::files::{make_folder, write};
use crate::report::{self, Failure, Result, say};
use cloakroom_figures::examples::{self, Example};
use serde_json::{Value, json};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Lists the chosen scenes, or copies them.
pub fn run(arguments: &ScenesArguments) -> Result<()> {
    let chosen = examples::select(&arguments.only).map_err(Failure::Usage)?;
    if let Some(folder) = &arguments.out {
        return copy(&chosen, folder);
    }
    if arguments.json {
        let list: Vec<Value> =
            chosen.iter().map(|e| json!({ "path": e.path, "description": e.words })).collect();
        return report::print_json(&json!({ "scenes": list }));
    }
    let width = chosen.iter().map(|example| example.path.len()).max().unwrap_or_default();
    let line = |e: &Example| format!("{:<width$}  {}\n", e.path, e.words);
    report::print(&chosen.iter().map(line).collect::<String>())
}

/// Copies scenes into a folder. What the user has changed there stays: then nothing is copied.
fn copy(chosen: &[Example], folder: &Path) -> Result<()> {
    let mut missing: Vec<(PathBuf, &Example)> = Vec::new();
    for example in chosen {
        let path = folder.join(example.path);
        match fs::read(&path) {
            Ok(there) if there == example.text.as_bytes() => {}
            Ok(_) => {
                let path = path.display();
                return Err(Failure::Failed(format!(
                    "{path} is there and differs from the example; choose another folder with --out"
                )));
            }
            Err(error) if error.kind() == ErrorKind::NotFound => missing.push((path, example)),
            Err(error) => {
                let path = path.display();
                return Err(Failure::Failed(format!("cannot read {path}: {error}")));
            }
        }
    }
    if missing.is_empty() {
        say(&format!("{}: they are all there", folder.display()));
    }
    for (path, example) in missing {
        if let Some(parent) = path.parent() {
            make_folder(parent)?;
        }
        write(&path, example.text.as_bytes())?;
    }
    Ok(())
}
