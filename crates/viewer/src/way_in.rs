//! The way into the page for a browser.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::PathBuf;
use tempfile::TempDir;

/// A file that leads a browser to an address and that nobody else can read: all users of a machine
/// see the command lines of its processes, and the address has a secret. It is gone when dropped.
#[derive(Debug)]
pub struct WayIn {
    folder: TempDir,
}

/// The file's name in its folder.
const WAY_IN: &str = "view.html";

impl WayIn {
    /// One to an address as [`serve`](crate::serve) tells it: none of it means something in HTML.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn new(address: &str) -> std::io::Result<Self> {
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

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.folder.path().join(WAY_IN)
    }
}
