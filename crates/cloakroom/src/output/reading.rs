//! Pictures read back from files.

use super::{Channel, Picture, RgbImage, Samples, png_texts};
use ndarray::{Array1, Array2, Array3};
use ndarray_npy::{NpzReader, ReadNpzError};
use std::error::Error;
use std::fmt::Display;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// The keys of metadata, in the order in which pictures have them.
const METADATA_KEYS: [&str; 5] = ["software", "scene", "version", "seed", "inputs"];

/// A file that cannot be read as a picture of this program.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot read {}: {reason}", path.display())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// Why not.
    pub reason: String,
}

impl ReadError {
    /// For a file that cannot be read.
    pub(crate) fn new(path: &Path, reason: impl ToString) -> Self {
        Self { path: path.to_owned(), reason: reason.to_string() }
    }
}

/// Reads a picture from an NPZ: every channel, and the metadata.
///
/// # Errors
///
/// If the file cannot be read, or an array in it is none of a picture.
pub fn read_npz(path: &Path) -> Result<Picture, ReadError> {
    let picture = read_channels(path, |_| true)?;
    if picture.channels.is_empty() {
        return Err(ReadError::new(path, "it has no channels"));
    }
    Ok(picture)
}

/// Reads the channels of those names from an NPZ, and its metadata if that is one of them.
///
/// # Errors
///
/// If the file cannot be read, or one of these arrays is none of a picture.
pub(crate) fn read_channels(
    path: &Path,
    wanted: impl Fn(&str) -> bool,
) -> Result<Picture, ReadError> {
    let read = || -> Result<Picture, Box<dyn Error>> {
        let mut npz = NpzReader::new(BufReader::new(File::open(path)?))?;
        let (mut channels, mut metadata, mut size) = (Vec::new(), Vec::new(), None);
        for name in npz.names()?.into_iter().filter(|name| wanted(name)) {
            let within = |error: &dyn Display| format!("`{name}`: {error}");
            if name == "metadata" {
                let bytes: Array1<u8> = npz.by_name(&name).map_err(|error| within(&error))?;
                let texts: serde_json::Map<String, serde_json::Value> =
                    serde_json::from_slice(&bytes.to_vec()).map_err(|error| within(&error))?;
                let texts = texts.into_iter();
                metadata = texts
                    .filter_map(|(key, text)| Some((key, text.as_str()?.to_owned())))
                    .collect();
                // JSON has no order of keys; other files do.
                metadata.sort_by_key(|(key, _): &(String, String)| {
                    let known = METADATA_KEYS.iter().position(|known| known == key);
                    known.unwrap_or(METADATA_KEYS.len())
                });
                continue;
            }
            let (shape, samples) = samples(&mut npz, &name)
                .map_err(|error| within(&error))?
                .ok_or_else(|| format!("`{name}` is no array of a picture"))?;
            if *size.get_or_insert(shape) != shape {
                return Err(format!("`{name}` is not of the size of the others").into());
            }
            channels.push(Channel { name, samples });
        }
        let [height, width] = size.unwrap_or_default();
        Ok(Picture { width, height, channels, metadata })
    };
    read().map_err(|error| ReadError::new(path, error))
}

/// Height and width of an array of a picture, and its numbers row by row; `None` if it is none.
fn samples(
    npz: &mut NpzReader<BufReader<File>>,
    name: &str,
) -> Result<Option<([usize; 2], Samples)>, ReadNpzError> {
    let single: Result<Array2<f32>, _> = npz.by_name(name);
    if let Ok(array) = single {
        let size = [array.nrows(), array.ncols()];
        return Ok(Some((size, Samples::F32(array.iter().copied().collect()))));
    }
    let colors: Result<Array3<f32>, _> = npz.by_name(name);
    if let Ok(array) = colors {
        let (height, width, colors) = array.dim();
        let values: Vec<f32> = array.iter().copied().collect();
        let samples = || Samples::Rgb(values.as_chunks().0.to_vec());
        return Ok((colors == 3).then(|| ([height, width], samples())));
    }
    let array: Array2<f64> = npz.by_name(name)?;
    let size = [array.nrows(), array.ncols()];
    Ok(Some((size, Samples::F64(array.iter().copied().collect()))))
}

/// Reads a PNG of 8-bit colors, as this program writes it, with its text metadata.
///
/// # Errors
///
/// If the file cannot be read, or is a PNG of another kind.
pub fn read_png(path: &Path) -> Result<(RgbImage, Vec<(String, String)>), ReadError> {
    const OTHER: &str = "it is no PNG of this program (8 bits, red, green and blue)";
    let read = || -> Result<_, Box<dyn Error>> {
        let mut reader = png::Decoder::new(BufReader::new(File::open(path)?)).read_info()?;
        if reader.output_color_type() != (png::ColorType::Rgb, png::BitDepth::Eight) {
            return Err(OTHER.into());
        }
        let mut pixels = vec![0; reader.output_buffer_size().ok_or(OTHER)?];
        reader.next_frame(&mut pixels)?;
        reader.finish()?;
        let info = reader.info();
        let metadata = png_texts(info)?;
        Ok((RgbImage::from_raw(info.width, info.height, pixels).ok_or(OTHER)?, metadata))
    };
    read().map_err(|error| ReadError::new(path, error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{write, write_png};

    #[test]
    fn what_was_written_is_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.npz");
        let channel = |name: &str, samples| Channel { name: name.to_owned(), samples };
        let picture = Picture {
            width: 2,
            height: 1,
            channels: vec![
                channel("horizontal.R", Samples::F32(vec![0.25, 1e-30])),
                channel("time_of_flight", Samples::F64(vec![1.0 / 3.0, -2.0])),
                channel("stokes.S1", Samples::Rgb(vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])),
            ],
            metadata: ["software", "scene", "version", "seed", "tile"]
                .map(|key| (key.to_owned(), format!("{key} ü\n\"")))
                .to_vec(),
        };
        write(&picture, &path).expect("written");
        assert_eq!(read_npz(&path), Ok(picture));
        std::fs::write(&path, b"PK nothing").expect("written");
        let message = read_npz(&path).expect_err("must fail").to_string();
        assert!(message.starts_with("cannot read ") && message.contains("a.npz"), "{message}");
    }

    #[test]
    fn images_and_their_texts_are_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        let image = RgbImage::from_fn(3, 2, |x, y| image::Rgb([x as u8, y as u8, 200]));
        let metadata = vec![("software".to_owned(), "x".to_owned()), ("scene".into(), "ü".into())];
        write_png(&image, &metadata, &path).expect("written");
        assert_eq!(read_png(&path), Ok((image, metadata)));
        image::GrayImage::new(2, 2).save(&path).expect("written");
        assert!(read_png(&path).expect_err("gray").to_string().contains("no PNG of this program"));
    }
}
