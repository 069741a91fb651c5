//! Pictures read back from files.

use super::{Channel, Picture, RgbImage, Samples, png_texts};
use ndarray::{Array, Array1, ArrayBase, Dimension, Ix2, Ix3, OwnedRepr};
use ndarray_npy::{NpzReader, ReadNpzError, ReadableElement};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// The keys of metadata, in the order in which pictures have them.
const METADATA_KEYS: [&str; 4] = ["software", "scene", "version", "seed"];

/// A file that cannot be read as a picture of this program.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot read {}: {reason}", path.display())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// Why not.
    pub reason: String,
}

/// Reads a picture from an NPZ: every channel, and the metadata.
///
/// # Errors
///
/// If the file cannot be read, or an array in it is none of a picture.
pub fn read_npz(path: &Path) -> Result<Picture, ReadError> {
    let failed = |reason: String| ReadError { path: path.to_owned(), reason };
    let file = File::open(path).map_err(|error| failed(error.to_string()))?;
    let mut npz =
        NpzReader::new(BufReader::new(file)).map_err(|error| failed(error.to_string()))?;
    let names = npz.names().map_err(|error| failed(error.to_string()))?;
    let (mut channels, mut metadata, mut size) = (Vec::new(), Vec::new(), None);
    for name in names {
        if name == "metadata" {
            let bytes: Result<Array1<u8>, _> = npz.by_name(&name);
            let bytes = bytes.map_err(|error| failed(format!("`{name}`: {error}")))?.to_vec();
            let texts: serde_json::Map<String, serde_json::Value> = serde_json::from_slice(&bytes)
                .map_err(|error| failed(format!("`{name}`: {error}")))?;
            let text =
                |(key, text): (String, serde_json::Value)| Some((key, text.as_str()?.to_owned()));
            metadata = texts.into_iter().filter_map(text).collect();
            // JSON has no order of keys; other files do.
            metadata.sort_by_key(|(key, _): &(String, String)| {
                METADATA_KEYS.iter().position(|known| known == key).unwrap_or(METADATA_KEYS.len())
            });
            continue;
        }
        let (shape, samples) = samples(&mut npz, &name)
            .map_err(|error| failed(format!("`{name}`: {error}")))?
            .ok_or_else(|| failed(format!("`{name}` is no array of a picture")))?;
        if *size.get_or_insert(shape) != shape {
            return Err(failed(format!("`{name}` is not of the size of the others")));
        }
        channels.push(Channel { name, samples });
    }
    let [height, width] = size.ok_or_else(|| failed("it has no channels".to_owned()))?;
    Ok(Picture { width, height, channels, metadata })
}

/// Height and width of an array of a picture, and its numbers; `None` if it is none.
fn samples(
    npz: &mut NpzReader<BufReader<File>>,
    name: &str,
) -> Result<Option<([usize; 2], Samples)>, ReadNpzError> {
    if let Ok(array) = read::<f32, Ix2>(npz, name) {
        let (height, width) = array.dim();
        return Ok(Some(([height, width], Samples::F32(in_order(array)))));
    }
    if let Ok(array) = read::<f32, Ix3>(npz, name) {
        let (height, width, colors) = array.dim();
        let values = in_order(array);
        let samples = (colors == 3).then(|| Samples::Rgb(values.as_chunks().0.to_vec()));
        return Ok(samples.map(|samples| ([height, width], samples)));
    }
    let array = read::<f64, Ix2>(npz, name)?;
    let (height, width) = array.dim();
    Ok(Some(([height, width], Samples::F64(in_order(array)))))
}

fn read<T: ReadableElement, D: Dimension>(
    npz: &mut NpzReader<BufReader<File>>,
    name: &str,
) -> Result<ArrayBase<OwnedRepr<T>, D>, ReadNpzError> {
    npz.by_name(name)
}

/// The numbers row by row.
fn in_order<T: Copy, D: Dimension>(array: Array<T, D>) -> Vec<T> {
    array.iter().copied().collect()
}

/// Reads a PNG of 8-bit colors, as this program writes it, with its text metadata.
///
/// # Errors
///
/// If the file cannot be read, or is a PNG of another kind.
pub fn read_png(path: &Path) -> Result<(RgbImage, Vec<(String, String)>), ReadError> {
    let failed = |reason: String| ReadError { path: path.to_owned(), reason };
    let file = File::open(path).map_err(|error| failed(error.to_string()))?;
    let mut reader = png::Decoder::new(BufReader::new(file))
        .read_info()
        .map_err(|error| failed(error.to_string()))?;
    let other = || failed("it is no PNG of this program (8 bits, red, green and blue)".to_owned());
    if reader.output_color_type() != (png::ColorType::Rgb, png::BitDepth::Eight) {
        return Err(other());
    }
    let mut pixels = vec![0; reader.output_buffer_size().ok_or_else(other)?];
    reader.next_frame(&mut pixels).map_err(|error| failed(error.to_string()))?;
    reader.finish().map_err(|error| failed(error.to_string()))?;
    let info = reader.info();
    let metadata = png_texts(info).map_err(|error| failed(error.to_string()))?;
    let image = RgbImage::from_raw(info.width, info.height, pixels).ok_or_else(other)?;
    Ok((image, metadata))
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
