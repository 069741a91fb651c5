//! `cloakroom view`: an interactive page in the browser.

use crate::arguments::ViewArguments;
use crate::interruption;
use crate::report::{Failure, print, say};
use crate::scene;
use cloakroom::scene_file;
use cloakroom_figures::examples;
use cloakroom_viewer::{Settings, serve};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Serves the page until Ctrl-C.
pub fn run(arguments: &ViewArguments, stop: &'static AtomicBool) -> Result<(), Failure> {
    scene::use_threads(&arguments.threads)?;
    let settings = settings(arguments)?;
    let _busy = interruption::busy();
    let mut told = Ok(());
    let ready = |address: &str| {
        told = print(&format!("{address}\n"));
        say("Ctrl-C ends it");
        if !arguments.no_open && open::that_detached(address).is_err() {
            say("no browser could be opened; open the address yourself");
        }
    };
    serve(&settings, ready, stop).map_err(Failure::from_error)?;
    told?;
    Err(Failure::Interrupted)
}

fn settings(arguments: &ViewArguments) -> Result<Settings, Failure> {
    let overrides = &arguments.overrides;
    let (loaded, name, folder) = match &arguments.scene {
        Some(path) => {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let folder = path.parent().map(Path::to_owned).unwrap_or_default();
            (scene_file::load(path, overrides), name, folder)
        }
        None => {
            let loaded =
                scene_file::parse(examples::FIRST, "the first scene", Path::new(""), overrides);
            (loaded, String::new(), PathBuf::new())
        }
    };
    let scene = loaded.map_err(Failure::from_error)?;
    Ok(Settings { scene, name, folder, port: arguments.port })
}
