//! Pictures (PNG, EXR, NPZ) and data on grids (NPZ, VTI, CSV) into files, each whole or not at all;
//! and pictures back from PNG and NPZ.

mod exr_file;
mod flight_file;
mod grid_file;
mod npz_file;
mod path_file;
mod picture;
mod png_file;
mod reading;
mod vtk_file;
mod whole_file;

pub use flight_file::{FlightOrder, FlightStore};
pub use grid_file::{Grid, GridArray, GridFile, GridFormat, GridValues, ShapedArray, write_grid};
pub use image::RgbImage;
pub(crate) use npz_file::write_npz;
pub use path_file::write_paths;
pub use picture::{Channel, Picture, Samples};
pub use png_file::{encode_png, light_to_srgb, to_srgb, write_png, write_png_in_strips};
pub use png_file::{encoder as png_encoder, texts as png_texts};
pub(crate) use reading::read_channels;
pub use reading::{ReadError, read_npz, read_png};
pub use whole_file::{
    WriteSeek, check_writable, is_same_file, is_same_output, is_same_pipe, write_whole,
};

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

/// Why a file cannot be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OutputError {
    /// The file could not be written.
    #[error("cannot write {}: {reason}", path.display())]
    Write {
        /// Which file.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
    /// The ending of the file's name is not that of a format.
    #[error("cannot tell the format of {} by its ending; use {known}", path.display())]
    UnknownFormat {
        /// Which file.
        path: PathBuf,
        /// The endings there are for what it is to hold.
        known: String,
    },
    /// The picture has no image: this channel is missing.
    #[error("the picture has no channel `{0}`")]
    MissingChannel(String),
}

impl OutputError {
    fn new(path: &Path, error: &io::Error) -> Self {
        let reason = match innermost(error).kind() {
            io::ErrorKind::StorageFull => "no space left on the device".to_owned(),
            io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
            io::ErrorKind::ReadOnlyFilesystem => "the file system is read-only".to_owned(),
            io::ErrorKind::QuotaExceeded => "the disk quota is used up".to_owned(),
            io::ErrorKind::FileTooLarge => "the file would be larger than is allowed".to_owned(),
            _ => innermost(error).to_string(),
        };
        Self::Write { path: path.to_owned(), reason }
    }
}

/// The error of the system beneath those that encoders wrap around it.
fn innermost(error: &io::Error) -> &io::Error {
    let causes = std::iter::successors(Some(error as &(dyn Error + 'static)), |&error| {
        let of_system = error.downcast_ref::<io::Error>();
        of_system.map_or_else(|| error.source(), |error| error.get_ref().map(|inner| inner as _))
    });
    causes.filter_map(<dyn Error>::downcast_ref).last().unwrap_or(error)
}

/// The ending of a file's name in small letters.
#[must_use]
pub fn ending(path: &Path) -> Option<String> {
    path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase())
}

/// The format that the ending of a file's name asks for, of those known.
///
/// # Errors
///
/// [`OutputError::UnknownFormat`] for any other ending.
pub fn format_of<T: Copy>(path: &Path, known: &[(&str, T)]) -> Result<T, OutputError> {
    let ending = ending(path);
    let format = known.iter().find(|(name, _)| ending.as_deref() == Some(name));
    format.map(|(_, format)| *format).ok_or_else(|| {
        let names: Vec<String> = known.iter().map(|(name, _)| format!(".{name}")).collect();
        let (last, others) = names.split_last().expect("formats");
        let known = match others {
            [] => last.clone(),
            others => format!("{} or {last}", others.join(", ")),
        };
        OutputError::UnknownFormat { path: path.to_owned(), known }
    })
}

/// A format of picture files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8-bit sRGB: what the camera with its polarizer sees.
    Png,
    /// All channels in single precision.
    Exr,
    /// All channels as arrays, times in double precision.
    Npz,
}

impl Format {
    /// The format that the ending of a file's name asks for.
    ///
    /// # Errors
    ///
    /// [`OutputError::UnknownFormat`] for any other ending.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        format_of(path, &[("png", Self::Png), ("exr", Self::Exr), ("npz", Self::Npz)])
    }
}

/// Writes a picture in the format that the file's ending asks for.
///
/// # Errors
///
/// If the ending is unknown, the file cannot be written, or a PNG lacks the image.
pub fn write(picture: &Picture, path: &Path) -> Result<(), OutputError> {
    match Format::of(path)? {
        Format::Png => write_png(&to_srgb(picture)?, &picture.metadata, path),
        Format::Exr => exr_file::write_exr(picture, path),
        Format::Npz => npz_file::write_picture(picture, path),
    }
}
