//! The files that commands write.

use crate::report::{Failure, Result, all, wrote};
use cloakroom::output::{self, OutputError};
use std::path::{Path, PathBuf};

/// Files with the formats that their endings ask for.
pub fn formats<F>(
    files: &[PathBuf],
    of: fn(&Path) -> Result<F, OutputError>,
) -> Result<Vec<(&Path, F)>> {
    files.iter().map(|file| Ok((file.as_path(), of(file)?))).collect()
}

/// Says before long work which of the files that a user has named cannot be written, are read by this
/// run, or are one file under two names.
pub fn check_outputs<'p>(
    files: impl IntoIterator<Item = &'p PathBuf>,
    inputs: &[PathBuf],
) -> Result<()> {
    let files: Vec<&PathBuf> = files.into_iter().collect();
    all(files.iter().enumerate().map(|(number, file)| {
        if files[..number].iter().any(|other| output::is_same_output(other, file)) {
            return Err(Failure::Failed(format!(
                "cannot write {}: another output of this run is that file; give another name",
                file.display()
            )));
        }
        check_writable([file], inputs)
    }))
}

/// Says before long work that one of some files cannot be written, or is one that is read.
pub fn check_writable<'p>(
    files: impl IntoIterator<Item = impl AsRef<Path> + 'p>,
    inputs: &[PathBuf],
) -> Result<()> {
    files.into_iter().try_for_each(|file| {
        let file = file.as_ref();
        if inputs.iter().any(|input| output::is_same_file(input, file)) {
            return Err(Failure::Failed(format!(
                "cannot write {}: this run reads that file; give another name",
                file.display()
            )));
        }
        Ok(output::check_writable(file)?)
    })
}

/// Writes each of some files, whether or not another of them fails: all failures.
pub fn write_each<'p, F>(
    files: impl IntoIterator<Item = (&'p Path, F)>,
    mut write: impl FnMut(&'p Path, F) -> Result<()>,
) -> Result<()> {
    all(files.into_iter().map(|(path, format)| write(path, format)))
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
