//! `cloakroom view`: an interactive page in the browser.

use crate::arguments::ViewArguments;
use crate::interruption::{self, STOP};
use crate::report::{Failure, Result, print, say};
use crate::scene;
use cloakroom::scene_file;
use cloakroom_figures::examples;
use cloakroom_viewer::{Settings, WayIn, serve};
use std::path::Path;

/// Serves the page until Ctrl-C.
pub fn run(arguments: &ViewArguments) -> Result<()> {
    scene::use_threads(&arguments.threads)?;
    let overrides = &arguments.overrides;
    let path = arguments.scene.as_deref().unwrap_or(Path::new(""));
    let folder = path.parent().unwrap_or(path);
    let scene = match &arguments.scene {
        Some(path) => scene::text(path)?.scene(overrides)?,
        None => scene_file::parse(examples::FIRST, "the first scene", folder, overrides)?,
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let (host, port) = (arguments.host, arguments.port);
    let settings = Settings { scene, name, folder: folder.to_owned(), host, port };
    // While the server is being set up there is nothing to end in good order.
    let mut busy = None;
    let mut told = Ok(());
    let mut way = None;
    let ready = |address: &str| {
        busy = Some(interruption::busy());
        told = print(&format!("{address}\n"));
        if !host.is_loopback() {
            say(
                "whoever on this network has the link can use the page, and others on it can read along: it is not encrypted",
            );
        }
        say("Ctrl-C ends it");
        if !arguments.no_open {
            way = WayIn::new(address).ok().filter(|way| open::that_detached(way.path()).is_ok());
            if way.is_none() {
                say("no browser could be opened; open the address yourself");
            }
        }
    };
    let served = serve(&settings, ready, &STOP);
    drop(way);
    served?;
    drop(busy);
    told?;
    Err(Failure::Interrupted)
}
