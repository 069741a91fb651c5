//! Pictures read back from files.

use super::{Channel, Picture, RgbImage, Samples, png_texts};
use crate::color::BINS;
use crate::{input, memory};
use ndarray::{ArrayView, Dimension, Ix1, Ix2, Ix3};
use ndarray_npy::{ViewElement, ViewNpyError, ViewNpyExt};
use std::error::Error;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use zip::ZipArchive;
use zip::read::ZipFile;

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

/// Opens a file; why not is said in words for people.
fn opened(path: &Path) -> Result<BufReader<File>, String> {
    File::open(path).map(BufReader::new).map_err(|error| input::reason(&error))
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
        let mut archive = ZipArchive::new(opened(path)?)?;
        let names: Vec<String> = archive.file_names().map(str::to_owned).collect();
        let arrays: Vec<(&str, &String)> = names
            .iter()
            .map(|entry| (entry.strip_suffix(".npy").unwrap_or(entry), entry))
            .filter(|(name, _)| wanted(name))
            .collect();
        let mut sizes = Vec::new();
        for (_, entry) in &arrays {
            sizes.push(archive.by_name(entry)?.size());
        }
        // The numbers of all, and the bytes of one beside them.
        let all = sizes.iter().fold(0, |sum: u64, size| sum.saturating_add(*size));
        let largest = sizes.iter().max().copied().unwrap_or(0);
        memory::check(all.saturating_add(largest), u64::MAX)?;
        let (mut channels, mut metadata, mut size) = (Vec::new(), Vec::new(), None);
        for (name, entry) in arrays {
            let within = |error: Box<dyn Error>| format!("`{name}`: {error}");
            let array = Npy::read(archive.by_name(entry)?).map_err(within)?;
            if name == "metadata" {
                metadata = array.metadata().map_err(within)?;
                continue;
            }
            let (shape, samples) = array
                .samples()
                .map_err(within)?
                .ok_or_else(|| format!("`{name}` is no array of a picture"))?;
            if *size.get_or_insert(shape) != shape {
                return Err(format!("`{name}` is not of the size of the others").into());
            }
            channels.push(Channel { name: name.to_owned(), samples });
        }
        let [height, width] = size.unwrap_or_default();
        Ok(Picture { width, height, channels, metadata })
    };
    read().map_err(|error| ReadError::new(path, error))
}

/// The bytes of an array's file, which lie in memory as its numbers must.
struct Npy {
    memory: Vec<u64>,
    length: usize,
}

impl Npy {
    /// Reads them out of an archive; that they fit into memory has been looked at.
    fn read(mut entry: ZipFile<'_, BufReader<File>>) -> Result<Self, Box<dyn Error>> {
        let length = usize::try_from(entry.size())?;
        let mut memory = vec![0; length.div_ceil(size_of::<u64>())];
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut memory);
        entry.read_exact(&mut bytes[..length])?;
        // The end of the file is where its checksum is looked at.
        io::copy(&mut entry, &mut io::sink())?;
        Ok(Self { memory, length })
    }

    /// The array in it, if it is one of this kind, and as long as it says.
    fn array<T: ViewElement, D: Dimension>(&self) -> Result<ArrayView<'_, T, D>, ViewNpyError> {
        let bytes: &[u8] = bytemuck::cast_slice(&self.memory);
        ArrayView::view_npy(&bytes[..self.length])
    }

    /// The texts in an array of bytes, which are JSON.
    fn metadata(&self) -> Result<Vec<(String, String)>, Box<dyn Error>> {
        let bytes = self.array::<u8, Ix1>()?.to_vec();
        let texts: serde_json::Map<String, serde_json::Value> = serde_json::from_slice(&bytes)?;
        let text =
            |(key, text): (String, serde_json::Value)| Some((key, text.as_str()?.to_owned()));
        let mut metadata: Vec<(String, String)> = texts.into_iter().filter_map(text).collect();
        // JSON has no order of keys; other files do.
        metadata.sort_by_key(|(key, _)| {
            let known = METADATA_KEYS.iter().position(|known| known == key);
            known.unwrap_or(METADATA_KEYS.len())
        });
        Ok(metadata)
    }

    /// The plane of a picture in it; `None` if it is none.
    fn samples(&self) -> Result<Option<Plane>, Box<dyn Error>> {
        if let Ok(array) = self.array::<f32, Ix2>() {
            let size = [array.nrows(), array.ncols()];
            return Ok(Some((size, Samples::F32(array.iter().copied().collect()))));
        }
        if let Ok(array) = self.array::<f32, Ix3>() {
            let (height, width, colors) = array.dim();
            if colors == BINS {
                let (bins, _) = array.as_slice().unwrap_or_default().as_chunks::<BINS>();
                return Ok(Some(([height, width], Samples::Bins(bins.to_vec()))));
            }
            if colors != 3 {
                return Ok(None);
            }
            let colors = array.rows().into_iter().map(|color| [color[0], color[1], color[2]]);
            return Ok(Some(([height, width], Samples::Rgb(colors.collect()))));
        }
        let array = self.array::<f64, Ix2>()?;
        let size = [array.nrows(), array.ncols()];
        Ok(Some((size, Samples::F64(array.iter().copied().collect()))))
    }
}

/// Height and width of a picture, and its numbers row by row.
type Plane = ([usize; 2], Samples);

/// Reads a PNG of 8-bit colors, as this program writes it, with its text metadata.
///
/// # Errors
///
/// If the file cannot be read, or is a PNG of another kind.
pub fn read_png(path: &Path) -> Result<(RgbImage, Vec<(String, String)>), ReadError> {
    const OTHER: &str = "it is no PNG of this program (8 bits, red, green and blue)";
    let read = || -> Result<_, Box<dyn Error>> {
        let mut reader = png::Decoder::new(opened(path)?).read_info()?;
        if reader.output_color_type() != (png::ColorType::Rgb, png::BitDepth::Eight) {
            return Err(OTHER.into());
        }
        let size = reader.output_buffer_size().ok_or(OTHER)?;
        memory::check(size as u64, u64::MAX)?;
        let mut pixels = vec![0; size];
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
    use std::io::Write;

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

    /// An archive with one array, whose header says a shape, and which the archive says is so long.
    fn archive(shape: &str, bytes: usize) -> Vec<u8> {
        let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({shape}), }}");
        let mut array = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
        array.extend(format!("{header:<117}\n").bytes());
        array.resize(array.len() + bytes, 0);
        let mut archive = zip::ZipWriter::new(io::Cursor::new(Vec::new()));
        let options = zip::write::SimpleFileOptions::default();
        archive.start_file("R.npy", options).expect("an entry");
        archive.write_all(&array).expect("written");
        archive.finish().expect("ended").into_inner()
    }

    #[test]
    fn what_an_archive_claims_takes_no_memory() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.npz");
        let refused = |bytes: &[u8], said: &str| {
            std::fs::write(&path, bytes).expect("written");
            let message = read_npz(&path).expect_err("must fail").to_string();
            assert!(message.contains("a.npz") && message.contains(said), "{message}");
        };
        std::fs::write(&path, archive("2, 3", 24)).expect("written");
        assert_eq!(read_npz(&path).map(|picture| picture.channels.len()), Ok(1));
        refused(&archive("100000, 100000", 8), "`R`");
        refused(&archive("4294967296, 4294967296", 8), "`R`");
        // The sizes of the entry in the archive's directory and before it.
        let mut claims = archive("100000, 100000", 8);
        let size = (128 + 8_u32).to_le_bytes();
        for at in 0..claims.len() - 4 {
            if claims[at..at + 4] == size {
                claims[at..at + 4].copy_from_slice(&0xFFFF_FFF0_u32.to_le_bytes());
            }
        }
        refused(&claims, "");
    }

    #[test]
    fn what_a_png_claims_takes_no_memory() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 65_535, 65_535);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_chunk(png::chunk::IDAT, &[0x78, 0x9C, 0, 0]).expect("a chunk");
        drop(writer);
        std::fs::write(&path, &bytes).expect("written");
        let message = read_png(&path).expect_err("must fail").to_string();
        assert!(message.contains("a.png"), "{message}");
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
