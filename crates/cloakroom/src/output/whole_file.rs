//! Files that appear whole or not at all.

use super::OutputError;
use std::fs;
use std::io::{self, BufWriter, ErrorKind, Seek, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes a file such that it appears under its name only when it is complete: into a temporary
/// file beside it, which is renamed at the end and removed if anything goes wrong. A file that is
/// replaced keeps its mode; where the name is a link, what it leads to is replaced. A target that
/// exists and is not a regular file (a pipe, a device) is written to directly.
///
/// # Errors
///
/// [`OutputError`] with the file's name and the reason.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn WriteSeek) -> io::Result<()>,
) -> Result<(), OutputError> {
    let written = match place(path)? {
        None => {
            // Pipes cannot be sought in: the bytes are gathered first.
            let mut bytes = io::Cursor::new(Vec::new());
            write(&mut bytes).and_then(|()| {
                fs::OpenOptions::new().write(true).open(path)?.write_all(bytes.get_ref())
            })
        }
        Some(place) => place.write(write),
    };
    written.map_err(|error| OutputError::new(path, &error))
}

/// What a file can be written into.
pub trait WriteSeek: Write + Seek {}

impl<T: Write + Seek> WriteSeek for T {}

/// Where a file comes into being by a rename.
struct Place {
    folder: PathBuf,
    /// The file, no link.
    path: PathBuf,
}

impl Place {
    fn write(&self, write: impl FnOnce(&mut dyn WriteSeek) -> io::Result<()>) -> io::Result<()> {
        let mut file = temporary(&self.folder)?;
        let mut buffer = BufWriter::with_capacity(1 << 16, file.as_file_mut());
        write(&mut buffer)?;
        buffer.flush()?;
        drop(buffer);
        if let Ok(replaced) = fs::metadata(&self.path) {
            file.as_file().set_permissions(replaced.permissions())?;
        }
        file.persist(&self.path).map_err(|error| error.error)?;
        Ok(())
    }
}

/// A temporary file that others may read once it has its final name, as any file a program makes:
/// its mode is narrowed by the umask. Its own name, which is nobody's, stands in no error.
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".cloakroom-").suffix(".part").make_in(folder, |path| {
        fs::OpenOptions::new().read(true).write(true).create_new(true).open(path)
    })
}

/// Longer chains of links are none that lead anywhere.
const MOST_LINKS: usize = 40;

/// The file that a chain of links leads to, whether it is there or not.
fn followed(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&path) else { break };
        path = folder_of(&path).join(next);
    }
    path
}

/// The folder in which a name is.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Where a file comes into being by a rename; `None` where it is to be written to what is there.
fn place(path: &Path) -> Result<Option<Place>, OutputError> {
    let refuse =
        |reason: &str| Err(OutputError::Write { path: path.to_owned(), reason: reason.to_owned() });
    if path.as_os_str().to_string_lossy().ends_with(std::path::is_separator) {
        return refuse("a name that ends like this is that of a folder");
    }
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => return refuse("it is a folder"),
        Ok(found) if !found.is_file() => return Ok(None),
        // That there is nothing yet, or no folder for it, is not told here.
        Err(error) if !matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return Err(OutputError::new(path, &error));
        }
        _ => {}
    }
    let target = followed(path);
    let folder = folder_of(&target).to_owned();
    if !folder.is_dir() {
        return refuse(&format!("there is no folder {}", folder.display()));
    }
    Ok(Some(Place { folder, path: target }))
}

/// Whether two names are those of one file that is there, by links of any kind.
#[must_use]
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    let is_file = |path: &Path| fs::metadata(path).ok().filter(fs::Metadata::is_file);
    let (Some(a), Some(b)) = (is_file(one), is_file(other)) else { return false };
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        (a.dev(), a.ino()) == (b.dev(), b.ino())
    }
    #[cfg(not(unix))]
    {
        let _ = (a, b);
        matches!((fs::canonicalize(one), fs::canonicalize(other)), (Ok(a), Ok(b)) if a == b)
    }
}

/// Whether two names are those of one pipe, of which each byte can be read once.
#[must_use]
pub fn is_same_pipe(one: &Path, other: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{FileTypeExt, MetadataExt};
        let pipe = |path: &Path| {
            let found = fs::metadata(path).ok()?;
            let kind = found.file_type();
            (kind.is_fifo() || kind.is_socket()).then(|| (found.dev(), found.ino()))
        };
        pipe(one).is_some_and(|found| pipe(other) == Some(found))
    }
    #[cfg(not(unix))]
    {
        let _ = (one, other);
        false
    }
}

/// Whether what is written under two names is one file, which need not be there yet. Different names
/// of a pipe or a device are not: it takes what is written one after the other.
#[must_use]
pub fn is_same_output(one: &Path, other: &Path) -> bool {
    let resolved = |path: &Path| {
        let Place { folder, path } = place(path).ok()??;
        Some(fs::canonicalize(folder).ok()?.join(path.file_name()?))
    };
    one == other
        || is_same_file(one, other)
        || resolved(one).is_some_and(|path| Some(path) == resolved(other))
}

/// Checks before long work that a file can be written where it is wanted. What can go wrong later
/// (a disk that runs full) still can.
///
/// # Errors
///
/// [`OutputError`] with the file's name and the reason.
pub fn check_writable(path: &Path) -> Result<(), OutputError> {
    let tried = match place(path)? {
        None => fs::OpenOptions::new().write(true).open(path).map(drop),
        Some(place) => temporary(&place.folder).map(drop),
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
            Err(io::Error::from(ErrorKind::StorageFull))
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

    #[cfg(unix)]
    #[test]
    fn links_stay_and_so_do_modes() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let (one, other) = (tempfile::tempdir().expect("a"), tempfile::tempdir().expect("b"));
        let target = other.path().join("target.png");
        let (near, far) = (one.path().join("near.png"), one.path().join("far.png"));
        symlink(&target, &near).expect("a link");
        symlink("near.png", &far).expect("a link");
        for mode in [None, Some(0o640), Some(0o604)] {
            if let Some(mode) = mode {
                fs::set_permissions(&target, fs::Permissions::from_mode(mode)).expect("a mode");
            }
            let content = format!("{mode:?}");
            check_writable(&far).expect("can be written");
            write_whole(&far, |out| out.write_all(content.as_bytes())).expect("written");
            assert!(far.is_symlink() && near.is_symlink() && !target.is_symlink());
            assert_eq!(fs::read_to_string(&target).expect("a text"), content);
            let found = fs::metadata(&target).expect("a file").permissions().mode() & 0o777;
            assert!(mode.is_none_or(|mode| mode == found), "{mode:?}: {found:o}");
        }
        assert!(is_same_file(&far, &target) && !is_same_file(&far, &one.path().join("none")));
        let new = other.path().join("new.png");
        symlink(&new, one.path().join("to-new.png")).expect("a link");
        assert!(is_same_output(&one.path().join("to-new.png"), &new) && !new.exists());
        assert!(is_same_output(&other.path().join("./new.png"), &new));
        assert!(is_same_output(&far, &target) && !is_same_output(&far, &new));
        fs::remove_file(one.path().join("to-new.png")).expect("removed");
        fs::hard_link(&target, other.path().join("hard")).expect("a link");
        assert!(is_same_file(&near, &other.path().join("hard")));
        // Round and round.
        symlink("b", one.path().join("a")).expect("a link");
        symlink("a", one.path().join("b")).expect("a link");
        assert!(check_writable(&one.path().join("a")).is_err());
        assert_eq!((entries(one.path()), entries(other.path())), (4, 2));
    }

    #[test]
    fn impossible_places_are_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let missing = folder.path().join("nowhere").join("a.png");
        let error = check_writable(&missing).expect_err("must fail").to_string();
        assert!(error.contains("there is no folder"), "{error}");
        let error = check_writable(folder.path()).expect_err("must fail").to_string();
        assert!(error.contains("it is a folder"), "{error}");
        let long = folder.path().join(format!("{}.png", "a".repeat(300)));
        assert!(check_writable(&long).is_err());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn messages_name_the_file_that_is_wanted() {
        // A folder in which nobody can make a file.
        let path = Path::new("/proc/x.png");
        for failed in [check_writable(path), write_whole(path, |_| Ok(()))] {
            let message = failed.expect_err("must fail").to_string();
            assert!(message.starts_with("cannot write /proc/x.png: "), "{message}");
            assert!(!message.contains(".part"), "{message}");
        }
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
