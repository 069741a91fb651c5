//! Files that appear whole or not at all.

use super::OutputError;
use std::fs;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes a file such that it appears under its name only when it is complete: into a temporary
/// file beside it, which is renamed at the end and removed if anything goes wrong. A target that
/// exists and is not a regular file (a pipe, a device) is written to directly.
///
/// # Errors
///
/// [`OutputError`] with the file's name and the reason.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn WriteSeek) -> io::Result<()>,
) -> Result<(), OutputError> {
    let written = match folder(path)? {
        None => {
            // Pipes cannot be sought in: the bytes are gathered first.
            let mut bytes = io::Cursor::new(Vec::new());
            write(&mut bytes).and_then(|()| {
                fs::OpenOptions::new().write(true).open(path)?.write_all(bytes.get_ref())
            })
        }
        Some(folder) => write_and_rename(path, &folder, write),
    };
    written.map_err(|error| OutputError::new(path, &error))
}

/// What a file can be written into.
pub trait WriteSeek: Write + Seek {}

impl<T: Write + Seek> WriteSeek for T {}

fn write_and_rename(
    path: &Path,
    folder: &Path,
    write: impl FnOnce(&mut dyn WriteSeek) -> io::Result<()>,
) -> io::Result<()> {
    let mut file = temporary(folder)?;
    let mut buffer = BufWriter::with_capacity(1 << 16, file.as_file_mut());
    write(&mut buffer)?;
    buffer.flush()?;
    drop(buffer);
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// A temporary file that others may read once it has its final name, as any file a program makes.
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".cloakroom-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Narrowed by the umask.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// The folder within which a file comes into being by a rename; `None` where it is to be written to
/// what is there.
fn folder(path: &Path) -> Result<Option<PathBuf>, OutputError> {
    let refuse =
        |reason: &str| Err(OutputError::Write { path: path.to_owned(), reason: reason.to_owned() });
    if path.as_os_str().to_string_lossy().ends_with(std::path::is_separator) {
        return refuse("a name that ends like this is that of a folder");
    }
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => return refuse("it is a folder"),
        Ok(found) if !found.is_file() => return Ok(None),
        // A link is followed, so that it stays one.
        Ok(_) if path.is_symlink() => {
            let target = fs::canonicalize(path).map_err(|error| OutputError::new(path, &error))?;
            return folder(&target);
        }
        _ => {}
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return refuse(&format!("there is no folder {}", folder.display()));
    }
    Ok(Some(folder.to_owned()))
}

/// Checks before long work that a file can be written where it is wanted. What can go wrong later
/// (a disk that runs full) still can.
///
/// # Errors
///
/// [`OutputError`] with the file's name and the reason.
pub fn check_writable(path: &Path) -> Result<(), OutputError> {
    let tried = match folder(path)? {
        None => fs::OpenOptions::new().write(true).open(path).map(drop),
        Some(folder) => temporary(&folder).map(drop),
    };
    tried.map_err(|error| OutputError::new(path, &error))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(folder: &Path) -> usize {
        fs::read_dir(folder).expect("a folder").count()
    }

    #[test]
    fn a_failure_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        let failed = write_whole(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        });
        let message = failed.expect_err("must fail").to_string();
        assert!(message.contains("a.png") && message.contains("no space left"), "{message}");
        assert_eq!(entries(folder.path()), 0);
    }

    #[test]
    fn an_old_file_survives_a_failure() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        write_whole(&path, |out| out.write_all(b"old")).expect("written");
        let failed = write_whole(&path, |_| Err(io::Error::other("broken")));
        assert!(failed.is_err());
        assert_eq!(fs::read(&path).expect("still there"), b"old");
        assert_eq!(entries(folder.path()), 1);
    }

    #[test]
    fn impossible_places_are_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let missing = folder.path().join("nowhere").join("a.png");
        let error = check_writable(&missing).expect_err("must fail").to_string();
        assert!(error.contains("there is no folder"), "{error}");
        let error = check_writable(folder.path()).expect_err("must fail").to_string();
        assert!(error.contains("it is a folder"), "{error}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_told() {
        let failed = write_whole(Path::new("/dev/full"), |out| out.write_all(b"something"));
        let message = failed.expect_err("must fail").to_string();
        assert!(message.contains("no space left"), "{message}");
        assert!(fs::metadata("/dev/full").is_ok_and(|found| !found.is_file()));
    }
}
