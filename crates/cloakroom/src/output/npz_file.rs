//! NPZ: arrays for numpy, as those of a picture: every channel as one array, (height, width) or
//! (height, width, 3).

use super::{OutputError, Picture, Samples, WriteSeek, write_whole};
use crate::color::BINS;
use ndarray::{ArrayBase, ArrayView, ArrayView1, Data, Dimension, StrideShape};
use ndarray_npy::{NpzWriter, WritableElement};
use serde_json::{Map, Value};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

/// An archive of arrays that is being written.
pub(crate) struct Npz<'o> {
    writer: NpzWriter<UntilError<'o>>,
    /// What becomes the array of bytes `metadata`, which holds a JSON object in UTF-8.
    pub metadata: Map<String, Value>,
}

impl Npz<'_> {
    /// Adds an array of that shape.
    pub fn add<T: WritableElement, D: Dimension>(
        &mut self,
        name: &str,
        shape: impl Into<StrideShape<D>>,
        values: &[T],
    ) -> io::Result<()> {
        let array = ArrayView::from_shape(shape, values).map_err(io::Error::other)?;
        self.add_array(name, &array)
    }

    /// Adds an array as it is.
    pub fn add_array<S: Data, D: Dimension>(
        &mut self,
        name: &str,
        array: &ArrayBase<S, D>,
    ) -> io::Result<()>
    where
        S::Elem: WritableElement,
    {
        self.writer.add_array(name, array).map_err(io::Error::other)
    }
}

/// Takes all that comes after an error as if it were written, and where: an archive that is given
/// up is ended all the same, and would tell on standard error that it cannot be.
pub(super) struct UntilError<'o> {
    out: &'o mut dyn WriteSeek,
    has_failed: bool,
    position: u64,
    length: u64,
}

impl<'o> UntilError<'o> {
    pub(super) fn new(out: &'o mut dyn WriteSeek) -> Self {
        Self { out, has_failed: false, position: 0, length: 0 }
    }

    /// Does it if nothing has failed yet; `otherwise` stands for what would have come of it.
    fn unless_failed<T>(
        &mut self,
        otherwise: T,
        act: impl FnOnce(&mut dyn WriteSeek) -> io::Result<T>,
    ) -> io::Result<T> {
        if self.has_failed {
            return Ok(otherwise);
        }
        let did = act(self.out);
        self.has_failed = did.is_err();
        did
    }
}

impl Write for UntilError<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.unless_failed(bytes.len(), |out| out.write(bytes))?;
        self.position += written as u64;
        self.length = self.length.max(self.position);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.unless_failed((), |out| out.flush())
    }
}

impl Seek for UntilError<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let from = |start: u64, by: i64| start.checked_add_signed(by);
        let expected = match to {
            SeekFrom::Start(position) => Some(position),
            SeekFrom::End(by) => from(self.length, by),
            SeekFrom::Current(by) => from(self.position, by),
        };
        let expected = expected.ok_or(io::ErrorKind::InvalidInput)?;
        self.position = self.unless_failed(expected, |out| out.seek(to))?;
        Ok(self.position)
    }
}

/// Writes an archive of the arrays that `add` adds, and metadata as the array of bytes `metadata`.
///
/// # Errors
///
/// If the file cannot be written.
pub(crate) fn write_npz(
    path: &Path,
    metadata: &[(String, String)],
    add: impl FnOnce(&mut Npz<'_>) -> io::Result<()>,
) -> Result<(), OutputError> {
    write_whole(path, |out| write_archive(out, metadata, add))
}

fn write_archive(
    out: &mut dyn WriteSeek,
    metadata: &[(String, String)],
    add: impl FnOnce(&mut Npz<'_>) -> io::Result<()>,
) -> io::Result<()> {
    let metadata = metadata.iter().map(|(key, text)| (key.clone(), text.clone().into()));
    let mut npz =
        Npz { writer: NpzWriter::new(UntilError::new(out)), metadata: metadata.collect() };
    add(&mut npz)?;
    let bytes = serde_json::to_vec(&npz.metadata)?;
    npz.writer.add_array("metadata", &ArrayView1::from(&bytes)).map_err(io::Error::other)?;
    npz.writer.finish().map(drop).map_err(io::Error::other)
}

/// Writes every channel as an array (height, width) under its name, a
/// spectrum as (height, width, 16), and the metadata.
///
/// # Errors
///
/// If the file cannot be written.
pub(super) fn write_picture(picture: &Picture, path: &Path) -> Result<(), OutputError> {
    let (height, width) = (picture.height, picture.width);
    write_npz(path, &picture.metadata, |npz| {
        picture.channels.iter().try_for_each(|channel| match &channel.samples {
            Samples::F32(values) => npz.add(&channel.name, (height, width), values),
            Samples::F64(values) => npz.add(&channel.name, (height, width), values),
            Samples::Rgb(values) => {
                npz.add(&channel.name, (height, width, 3), values.as_flattened())
            }
            Samples::Bins(values) => {
                npz.add(&channel.name, (height, width, BINS), values.as_flattened())
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::super::Channel;
    use super::*;
    use ndarray::{Array1, Array2, Array3};
    use ndarray_npy::NpzReader;

    /// A file on a disk of so many bytes.
    struct Small(io::Cursor<Vec<u8>>, u64);

    impl Write for Small {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let room = usize::try_from(self.1.saturating_sub(self.0.position())).expect("small");
            if room == 0 {
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.0.write(&bytes[..room.min(bytes.len())])
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Small {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.0.seek(to)
        }
    }

    #[test]
    fn a_disk_full_at_any_byte_is_an_error() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.npz");
        let add = |npz: &mut Npz<'_>| {
            npz.add("one", 40, &[1.0; 40])?;
            npz.add("other", (3, 2), &[0_u8; 6])
        };
        write_npz(&path, &[], add).expect("written");
        let size = std::fs::metadata(&path).expect("a file").len();
        for room in 0..=size {
            let mut small = Small(io::Cursor::default(), room);
            let written = write_archive(&mut small, &[], add);
            assert_eq!(written.is_ok(), room == size, "{room} of {size}");
            if let Err(error) = written {
                let told = OutputError::new(&path, &error).to_string();
                assert!(told.contains("no space left"), "{told}");
            }
        }
    }

    #[test]
    fn arrays_can_be_read_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.npz");
        let times = vec![1e-15, f64::NAN, 3.0, 4.0, 5.0, 6.0];
        let picture = Picture {
            width: 3,
            height: 2,
            channels: vec![
                Channel { name: "horizontal.R".into(), samples: Samples::F32(vec![0.5; 6]) },
                Channel { name: "time_of_flight".into(), samples: Samples::F64(times) },
                Channel {
                    name: "stokes.S1".into(),
                    samples: Samples::Rgb(vec![[0.25, -0.5, 4.0]; 6]),
                },
            ],
            metadata: vec![("seed".into(), "7".into())],
        };
        super::super::write(&picture, &path).expect("written");
        let file = std::fs::File::open(&path).expect("a file");
        let mut npz = NpzReader::new(file).expect("an archive");
        let red: Array2<f32> = npz.by_name("horizontal.R").expect("an array");
        assert_eq!(red.dim(), (2, 3));
        let times: Array2<f64> = npz.by_name("time_of_flight").expect("an array");
        assert_eq!((times[(0, 0)], times[(1, 0)]), (1e-15, 4.0));
        let stokes: Array3<f32> = npz.by_name("stokes.S1").expect("an array");
        assert_eq!((stokes.dim(), stokes[(1, 2, 1)]), ((2, 3, 3), -0.5));
        let metadata: Array1<u8> = npz.by_name("metadata").expect("an array");
        assert_eq!(metadata.to_vec(), br#"{"seed":"7"}"#);
    }
}
