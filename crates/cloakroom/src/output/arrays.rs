//! Named arrays of numbers, as NPZ.

use super::{OutputError, npz_file, write_whole};
use ndarray::ArrayViewD;
use ndarray_npy::NpzWriter;
use std::io;
use std::path::Path;

/// Named arrays of numbers of any shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Arrays {
    arrays: Vec<(&'static str, Vec<usize>, Vec<f64>)>,
}

impl Arrays {
    /// Adds an array of that shape, its last index running fastest.
    pub fn add(&mut self, name: &'static str, shape: &[usize], values: impl Iterator<Item = f64>) {
        self.arrays.push((name, shape.to_vec(), values.collect()));
    }

    /// Name, shape and values of each array.
    pub fn into_parts(self) -> impl Iterator<Item = (&'static str, Vec<usize>, Vec<f64>)> {
        self.arrays.into_iter()
    }
}

/// Writes arrays under their names, and the metadata as the array of bytes `metadata`, which holds a JSON object in
/// UTF-8.
///
/// # Errors
///
/// If the file cannot be written.
pub fn write_arrays(
    arrays: &Arrays,
    metadata: &[(String, String)],
    path: &Path,
) -> Result<(), OutputError> {
    write_whole(path, |out| {
        let mut npz = NpzWriter::new(out);
        for (name, shape, values) in &arrays.arrays {
            let array = ArrayViewD::from_shape(&shape[..], values).map_err(io::Error::other)?;
            npz.add_array(*name, &array).map_err(io::Error::other)?;
        }
        npz_file::add_metadata(&mut npz, metadata)?;
        npz.finish().map_err(io::Error::other)?;
        Ok(())
    })
}
