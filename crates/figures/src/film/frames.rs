//! A folder of frames: PNG files, each of which says what it shows, so that work can be taken up
//! again.

use super::animation::frames_beside;
use super::{FilmError, FilmFormat};
use cloakroom::output::{RgbImage, png_texts};
use std::fs;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// A folder of numbered frames.
#[derive(Clone, Debug)]
pub struct FrameFolder {
    /// Where it is.
    pub(super) folder: PathBuf,
    /// How many frames it is for.
    pub(super) count: usize,
}

impl FrameFolder {
    /// The folder for so many frames, made if it is not there.
    ///
    /// # Errors
    ///
    /// If it cannot be made.
    pub fn new(folder: &Path, count: usize) -> Result<Self, FilmError> {
        fs::create_dir_all(folder)
            .map_err(|error| FilmError::failed("cannot make the folder", folder, &error))?;
        Ok(Self { folder: folder.to_owned(), count })
    }

    /// The folder for the frames of a film, made if it is not there: the film itself where it is one, which
    /// then has no frames beyond, of a longer one; else one beside it.
    ///
    /// # Errors
    ///
    /// If it cannot be made, or has frames beyond.
    pub fn of_film(path: &Path, format: FilmFormat, count: usize) -> Result<Self, FilmError> {
        if format != FilmFormat::Frames {
            return Self::new(&frames_beside(path), count);
        }
        let frames = Self::new(path, count)?;
        frames.check_none_beyond()?;
        Ok(frames)
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// Refuses a folder that holds frames beyond its own, of a longer film.
    ///
    /// # Errors
    ///
    /// If there is one.
    fn check_none_beyond(&self) -> Result<(), FilmError> {
        let number = |name: &str| {
            let digits = name.strip_prefix("frame-")?.strip_suffix(".png")?;
            digits.parse::<usize>().ok().filter(|number| *number >= self.count)
        };
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        let beyond = entries.filter(|entry| entry.file_name().to_str().and_then(number).is_some());
        match beyond.map(|entry| entry.path()).min() {
            Some(path) => Err(FilmError::Beyond { path, count: self.count }),
            None => Ok(()),
        }
    }

    /// How many frames it is for.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// The file of a frame, counted from 0: `frame-000000.png` and so on.
    #[must_use]
    pub fn file(&self, frame: usize) -> PathBuf {
        self.folder.join(format!("frame-{frame:06}.png"))
    }

    /// Whether a frame is there that shows just this: it carries the same metadata, the contents of
    /// files among them.
    #[must_use]
    pub fn is_finished(&self, frame: usize, metadata: &[(String, String)]) -> bool {
        let same = |carried: Vec<(String, String)>| {
            carried.len() == metadata.len() && metadata.iter().all(|pair| carried.contains(pair))
        };
        carried(&self.file(frame)).is_some_and(same)
    }

    /// Reads a frame.
    ///
    /// # Errors
    ///
    /// If it cannot be read.
    pub fn read(&self, frame: usize) -> Result<RgbImage, FilmError> {
        let path = self.file(frame);
        let image = image::open(&path).map(image::DynamicImage::into_rgb8);
        image.map_err(|error| FilmError::failed("cannot read the frame", &path, &error))
    }

    /// Removes the frames, and the folder if nothing else is in it.
    pub fn remove(&self) {
        for frame in 0..self.count {
            // What cannot be removed stays: the film is there.
            let _ = fs::remove_file(self.file(frame));
        }
        let _ = fs::remove_dir(&self.folder);
    }
}

/// What a PNG says of itself.
fn carried(path: &Path) -> Option<Vec<(String, String)>> {
    let file = BufReader::new(fs::File::open(path).ok()?);
    let reader = png::Decoder::new(file).read_info().ok()?;
    png_texts(reader.info()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cloakroom::output::write_png;

    #[test]
    fn a_frame_is_finished_if_it_shows_the_same() {
        let outer = tempfile::tempdir().expect("a folder");
        let frames = FrameFolder::new(&outer.path().join("frames"), 2).expect("a folder");
        let say = |scene: &str| {
            [("software", "cloakroom"), ("scene", scene)].map(|(k, v)| (k.to_owned(), v.to_owned()))
        };
        let image = RgbImage::from_fn(5, 4, |x, y| image::Rgb([x as u8, y as u8, 9]));
        assert!(!frames.is_finished(0, &say("a")));
        write_png(&image, &say("a"), &frames.file(0)).expect("written");
        assert!(frames.is_finished(0, &say("a")));
        assert!(!frames.is_finished(0, &say("b")) && !frames.is_finished(1, &say("a")));
        assert!(!frames.is_finished(0, &say("a")[..1]));
        assert_eq!(frames.read(0).expect("a frame"), image);
        // Half a file is none.
        fs::write(frames.file(0), &fs::read(frames.file(0)).expect("bytes")[..40]).expect("cut");
        assert!(!frames.is_finished(0, &say("a")));
        frames.remove();
        assert!(!frames.folder.exists());
    }
}
