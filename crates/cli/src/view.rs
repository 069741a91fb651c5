//! `cloakroom view`: an interactive page in the browser.

use crate::arguments::ViewArguments;
use crate::interruption::{self, STOP};
use crate::report::{Failure, Result, print, say};
use crate::scene;
use cloakroom::scene_file;
use cloakroom_figures::examples;
use cloakroom_viewer::{Settings, serve};
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

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
    let settings = Settings { scene, name, folder: folder.to_owned(), port: arguments.port };
    // While the server is being set up there is nothing to end in good order.
    let mut busy = None;
    let mut told = Ok(());
    let mut way = None;
    let ready = |address: &str| {
        busy = Some(interruption::busy());
        told = print(&format!("{address}\n"));
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

/// A file that leads a browser to an address and that nobody else can read: all users of a machine
/// see the command lines of its processes, and the address has a secret. It is gone when dropped.
struct WayIn {
    folder: TempDir,
}

/// The file's name in its folder.
const WAY_IN: &str = "view.html";

impl WayIn {
    /// One to an address, of digits and such: none of it means something in HTML.
    fn new(address: &str) -> std::io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix("cloakroom-view-");
        // Nobody else can enter it.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
        let folder = builder.tempdir()?;
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        let way = Self { folder };
        write!(
            options.open(way.path())?,
            "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>cloakroom</title>\n\
             <meta name=\"referrer\" content=\"no-referrer\">\n\
             <meta http-equiv=\"refresh\" content=\"0; url={address}\">\n\
             <p><a href=\"{address}\">Open the page</a></p>\n"
        )?;
        Ok(way)
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join(WAY_IN)
    }
}
