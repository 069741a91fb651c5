//! NPZ: every channel as one numpy array, (height, width) or (height, width, 3).

use super::{OutputError, Picture, Samples, write_whole};
use ndarray::{ArrayView1, ArrayView2, ArrayView3};
use ndarray_npy::NpzWriter;
use std::io;
use std::path::Path;

/// Writes every channel as an array (height, width) under its name, and the metadata as the array
/// of bytes `metadata`, which holds a JSON object in UTF-8.
///
/// # Errors
///
/// If the file cannot be written.
pub(super) fn write_npz(picture: &Picture, path: &Path) -> Result<(), OutputError> {
    write_whole(path, |out| {
        let mut npz = NpzWriter::new(out);
        let shape = (picture.height, picture.width);
        for channel in &picture.channels {
            match &channel.samples {
                Samples::F32(values) => {
                    let array = ArrayView2::from_shape(shape, values).map_err(io::Error::other)?;
                    npz.add_array(&channel.name, &array).map_err(io::Error::other)?;
                }
                Samples::Rgb(values) => {
                    let shape = (picture.height, picture.width, 3);
                    let values = values.as_flattened();
                    let array = ArrayView3::from_shape(shape, values).map_err(io::Error::other)?;
                    npz.add_array(&channel.name, &array).map_err(io::Error::other)?;
                }
                Samples::F64(values) => {
                    let array = ArrayView2::from_shape(shape, values).map_err(io::Error::other)?;
                    npz.add_array(&channel.name, &array).map_err(io::Error::other)?;
                }
            }
        }
        add_metadata(&mut npz, &picture.metadata)?;
        npz.finish().map_err(io::Error::other)?;
        Ok(())
    })
}

/// Adds metadata as the array of bytes `metadata`, which holds a JSON object in UTF-8.
pub(super) fn add_metadata<W: io::Write + io::Seek>(
    npz: &mut NpzWriter<W>,
    metadata: &[(String, String)],
) -> io::Result<()> {
    let metadata: serde_json::Map<String, serde_json::Value> =
        metadata.iter().map(|(key, text)| (key.clone(), text.clone().into())).collect();
    let bytes = serde_json::to_vec(&metadata).map_err(io::Error::other)?;
    npz.add_array("metadata", &ArrayView1::from(&bytes[..])).map_err(io::Error::other)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::Channel;
    use super::*;
    use ndarray::{Array1, Array2, Array3};
    use ndarray_npy::NpzReader;

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
