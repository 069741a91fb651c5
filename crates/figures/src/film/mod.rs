//! Films: a scene frame by frame, while keys of it change.
//!
//! Frames are rendered one after the other into a folder ([`FrameFolder`]), each a PNG that carries
//! its scene, so that stopped work goes on where it was and many machines can share it; then they
//! become one file ([`FilmFormat`]).

mod animation;
mod apng_file;
mod flight;
mod frames;
mod gif_file;
mod pulse;
mod video;
mod webp_file;

pub use animation::{RenderedFrames, frame_metadata, render_frames};
pub(super) use flight::time_in_words;
pub use flight::{FlightFilm, FlightFilmError, flight_frames};
pub use frames::FrameFolder;
pub use pulse::pulse_frames;

use cloakroom::output::{self, OutputError, RgbImage};
use cloakroom::render::RenderError;
use cloakroom::trace::Stopped;
use std::error::Error;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Why there is no film.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// The folder of the frames cannot be made, a frame not be read, or `ffmpeg` not make the film.
    #[error("{what} {}: {reason}", path.display())]
    Failed {
        /// What has not come about, as in `cannot read the frame`.
        what: &'static str,
        /// The folder, the frame or the film.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
    /// The folder of a film has frames of a longer one.
    #[error(
        "{} is there, and the film has {count} frames; take another folder, or remove it",
        path.display()
    )]
    Beyond {
        /// The first frame that is too many.
        path: PathBuf,
        /// How many there are to be.
        count: usize,
    },
    /// The frames are not of one size.
    #[error(
        "the frame {} has {} x {} pixels, the first one {} x {}; a film has one size",
        path.display(), size[0], size[1], first[0], first[1]
    )]
    Size {
        /// The frame.
        path: PathBuf,
        /// Its size.
        size: [u32; 2],
        /// That of the first frame.
        first: [u32; 2],
    },
    /// The frames are too large for the format.
    #[error("{format} holds at most {most} x {most} pixels; the frames have {} x {}", size[0], size[1])]
    TooLarge {
        /// The format.
        format: &'static str,
        /// The most pixels a side.
        most: u32,
        /// The size of the frames.
        size: [u32; 2],
    },
    /// There is no `ffmpeg`.
    #[error(
        "MP4 and WebM files are made by ffmpeg, which is not installed; install it, or write a .gif, .apng, \
         .webp or a folder of frames"
    )]
    NoFfmpeg,
    /// The film cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The work was stopped.
    #[error("{0}")]
    Render(#[from] RenderError),
}

/// What a film is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmFormat {
    /// Animated GIF: 255 colors.
    Gif,
    /// Animated PNG: every color, large files.
    Apng,
    /// Animated WebP, lossless.
    WebP,
    /// MP4 (H.264), by `ffmpeg`.
    Mp4,
    /// WebM (VP9), by `ffmpeg`.
    WebM,
    /// A folder of PNG files.
    Frames,
}

impl FilmFormat {
    /// The format that a name asks for: by its ending, and a folder if it has none or there is one
    /// of that name.
    ///
    /// # Errors
    ///
    /// A sentence for any other ending.
    pub fn of(path: &Path) -> Result<Self, String> {
        match output::ending(path).as_deref() {
            _ if path.is_dir() => Ok(Self::Frames),
            Some("gif") => Ok(Self::Gif),
            Some("png" | "apng") => Ok(Self::Apng),
            Some("webp") => Ok(Self::WebP),
            Some("mp4") => Ok(Self::Mp4),
            Some("webm") => Ok(Self::WebM),
            None => Ok(Self::Frames),
            Some(_) => Err(format!(
                "cannot tell the format of {} by its ending; use .gif, .apng, .png, .webp, .mp4, .webm, or a \
                 name without ending for a folder of frames",
                path.display()
            )),
        }
    }

    /// Checks before long work that the format can be written here.
    ///
    /// # Errors
    ///
    /// [`FilmError::NoFfmpeg`] where that is needed.
    pub fn check(self) -> Result<(), FilmError> {
        match self {
            Self::Mp4 | Self::WebM if !video::ffmpeg_is_there() => Err(FilmError::NoFfmpeg),
            _ => Ok(()),
        }
    }
}

/// A film to be written.
#[derive(Clone, Copy)]
pub struct Film<'a> {
    /// Its frames, which are finished.
    pub frames: &'a FrameFolder,
    /// Its file.
    pub path: &'a Path,
    /// Frames a second, 1 to 100.
    pub rate: u32,
    /// What the film carries: scene, version, seed of its first frame.
    pub metadata: &'a [(String, String)],
    /// Called after each frame.
    pub frame_done: &'a (dyn Fn() + Sync),
    /// Set from outside to stop the work.
    pub stop: &'a AtomicBool,
}

impl FilmError {
    fn failed(what: &'static str, path: &Path, reason: &dyn Display) -> Self {
        Self::Failed { what, path: path.to_owned(), reason: reason.to_string() }
    }
}

impl Film<'_> {
    /// Writes it in a format; it is there whole or not at all.
    ///
    /// # Errors
    ///
    /// If a frame cannot be read or the film not be written, or the work was stopped.
    pub fn write(&self, format: FilmFormat) -> Result<(), FilmError> {
        match format {
            FilmFormat::Gif => gif_file::write(self),
            FilmFormat::Apng => apng_file::write(self),
            FilmFormat::WebP => webp_file::write(self),
            FilmFormat::Mp4 => video::write(self, video::H264),
            FilmFormat::WebM => video::write(self, video::VP9),
            FilmFormat::Frames => Ok(()),
        }
    }

    /// Says that a frame is done; an error if the work is to stop.
    fn done(&self) -> Result<(), FilmError> {
        (self.frame_done)();
        if self.stop.load(std::sync::atomic::Ordering::Relaxed) {
            return Err(RenderError::from(Stopped).into());
        }
        Ok(())
    }

    /// The size of the first frame, `most` a side at most.
    fn size(&self, format: &'static str, most: u32) -> Result<[u32; 2], FilmError> {
        let size: [u32; 2] = self.frames.read(0)?.dimensions().into();
        if size.iter().any(|side| *side > most) {
            return Err(FilmError::TooLarge { format, most, size });
        }
        Ok(size)
    }

    /// The frames one after the other, all of which must have the size of the first.
    fn checked(&self, first: [u32; 2]) -> impl Iterator<Item = Result<RgbImage, FilmError>> {
        (0..self.frames.count).map(move |number| {
            let frame = self.frames.read(number)?;
            let size: [u32; 2] = frame.dimensions().into();
            if size != first {
                return Err(FilmError::Size { path: self.frames.file(number), size, first });
            }
            Ok(frame)
        })
    }
}

/// How long a frame stays, in parts of a second, such that all together keep the rate.
fn stay(number: usize, rate: u32, parts: f64) -> u32 {
    let begins = |number: usize| (number as f64 * parts / f64::from(rate)).round();
    (begins(number + 1) - begins(number)) as u32
}

/// Writes a file whole or not at all, by work that may end with an error of the film, or of the
/// file.
fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn output::WriteSeek) -> Result<(), Box<dyn Error + Send + Sync>>,
) -> Result<(), FilmError> {
    let mut failure = None;
    let written = output::write_whole(path, |out| {
        write(out).map_err(|error| match error.downcast::<FilmError>() {
            Ok(error) => {
                failure = Some(*error);
                io::Error::other("no film")
            }
            Err(error) => io::Error::other(error),
        })
    });
    failure.map_or(Ok(()), Err)?;
    Ok(written?)
}

#[cfg(test)]
mod tests;
