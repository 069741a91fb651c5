//! The files that commands write.

use crate::report::{Failure, Result, wrote};
use cloakroom::output::{self, OutputError};
use std::path::{Path, PathBuf};

/// Files with the formats that their endings ask for.
pub fn formats<F>(
    files: &[PathBuf],
    of: fn(&Path) -> Result<F, OutputError>,
) -> Result<Vec<(&Path, F)>> {
    files.iter().map(|file| Ok((file.as_path(), of(file)?))).collect()
}

/// Says before long work that one of some files cannot be written.
pub fn check_writable<'p>(files: impl IntoIterator<Item = &'p PathBuf>) -> Result<()> {
    files.into_iter().try_for_each(|file| Ok(output::check_writable(file)?))
}

/// Makes the folder for files.
pub fn make_folder(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|error| {
        Failure::Failed(format!("cannot make the folder {}: {error}", folder.display()))
    })
}

/// Writes a file and says so.
pub fn write(path: &Path, text: &[u8]) -> Result<()> {
    output::write_whole(path, |file| file.write_all(text))?;
    wrote(path);
    Ok(())
}
