//! Files that a scene names and a device is made of: numbers on a grid, and meshes of triangles.

use crate::device::{AnyDevice, FacetedSolid, Graded};
use crate::input::{Digest, read_file, reason};
use crate::keys::{Key, KeyError, KeyKind, MeshSource, Sampled, Samples, find, shape_text};
use crate::mesh_file;
use cloakroom_trace::key;
use ndarray::ArrayViewD;
use ndarray_npy::{ViewElement, ViewNpyError, ViewNpyExt};
use optics::geometry::Polyhedron;
use std::borrow::Cow;
use std::cell::RefCell;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Longer files are no index of a device and no mesh.
const LONGEST: u64 = 256 << 20;

/// A file that has been read, or a pipe of which it is known why it cannot be: its bytes are gone.
#[derive(Debug, PartialEq)]
pub struct IndexFile {
    path: PathBuf,
    content: Result<Content, String>,
}

/// What was in a file.
#[derive(Debug, PartialEq)]
struct Content {
    data: Data,
    /// Of its bytes.
    digest: Digest,
}

/// What a device is made of.
#[derive(Clone, Debug, PartialEq)]
enum Data {
    Samples(Samples),
    Solid(Arc<Polyhedron>),
}

impl IndexFile {
    /// Of the content of the file at `path`, if that is this one.
    pub(crate) fn digest_of(&self, path: &Path) -> Option<Digest> {
        let content = self.content.as_ref().ok().filter(|_| self.is_at(path))?;
        Some(content.digest)
    }

    /// Whether that is its path, from the current folder or in full.
    fn is_at(&self, path: &Path) -> bool {
        let full = |path: &Path| std::path::absolute(path).ok();
        self.path == path || full(&self.path).is_some_and(|own| Some(own) == full(path))
    }
}

/// Files that have been read, each once: a pipe gives its bytes once only.
#[derive(Debug, Default)]
pub(crate) struct IndexFiles {
    known: RefCell<Vec<Arc<IndexFile>>>,
    /// Whether these are all, and no other is opened.
    are_all: bool,
}

impl IndexFiles {
    /// Files that have been read before, and no others.
    pub(crate) fn only(known: &[Arc<IndexFile>]) -> Self {
        Self { known: RefCell::new(known.to_vec()), are_all: true }
    }

    /// Those of a device that can be read, or read once only; what is wrong with one is told where
    /// the device is built.
    pub(crate) fn of(&self, device: &AnyDevice) -> Vec<Arc<IndexFile>> {
        let numbers = paths(device).into_iter().map(|(_, path)| (path, false));
        let all = numbers.chain(mesh_path(device).map(|path| (path, true)));
        all.filter_map(|(path, is_mesh)| self.at(path, is_mesh)).collect()
    }

    fn at(&self, path: &Path, is_mesh: bool) -> Option<Arc<IndexFile>> {
        let mut files = self.known.borrow_mut();
        if let Some(known) = files.iter().find(|file| file.is_at(path)) {
            return Some(Arc::clone(known));
        }
        if self.are_all {
            return None;
        }
        let content = if is_mesh { read_mesh(path) } else { read(path) };
        // A file may be mended until the device is built.
        let gives_again =
            || fs::metadata(path).map_or(true, |found| found.is_file() || found.is_dir());
        if content.is_err() && gives_again() {
            return None;
        }
        let file = Arc::new(IndexFile { path: path.to_owned(), content });
        files.push(Arc::clone(&file));
        Some(file)
    }
}

/// The file of a device's mesh.
fn mesh_path(device: &AnyDevice) -> Option<&Path> {
    match device {
        AnyDevice::FacetedSolid(FacetedSolid { mesh: Some(MeshSource::InFile(path)), .. }) => {
            Some(path)
        }
        _ => None,
    }
}

/// The files of numbers of a device, with the names of their keys: of its index, ratio and axes, or
/// of its corners or planes.
fn paths(device: &AnyDevice) -> Vec<(&'static str, &Path)> {
    fn in_file<const LEAST: usize, const MOST: usize>(
        sampled: Option<&Sampled<LEAST, MOST>>,
    ) -> Option<&Path> {
        match sampled {
            Some(Sampled::InFile(path)) => Some(path),
            _ => None,
        }
    }
    let files = match device {
        AnyDevice::Graded(graded) => vec![
            (key!(Graded.index), in_file(graded.index.as_ref())),
            (key!(Graded.ratio), in_file(graded.ratio.as_ref())),
            (key!(Graded.optic_axis), in_file(graded.optic_axis.as_ref())),
        ],
        AnyDevice::FacetedSolid(solid) => vec![
            (key!(FacetedSolid.vertices), in_file(solid.vertices.as_ref())),
            (key!(FacetedSolid.planes), in_file(solid.planes.as_ref())),
        ],
        _ => Vec::new(),
    };
    files.into_iter().filter_map(|(key, path)| Some((key, path?))).collect()
}

/// A device with the numbers in the place of the files that hold them, some of which may be known.
///
/// # Errors
///
/// If a file cannot be read, or a number in it is not allowed.
pub(crate) fn with_files_read<'d>(
    device: &'d AnyDevice,
    known: &[Arc<IndexFile>],
) -> Result<Cow<'d, AnyDevice>, KeyError> {
    let (paths, mesh) = (paths(device), mesh_path(device));
    if paths.is_empty() && mesh.is_none() {
        return Ok(Cow::Borrowed(device));
    }
    let mut read = device.clone();
    for (name, path) in paths {
        let samples = samples_of(find(device.table().keys(), name)?, path, known)?;
        match &mut read {
            AnyDevice::Graded(graded) if name == key!(Graded.index) => {
                graded.index = Some(Sampled::Here(samples));
            }
            AnyDevice::Graded(graded) if name == key!(Graded.ratio) => {
                graded.ratio = Some(Sampled::Here(samples));
            }
            AnyDevice::Graded(graded) => graded.optic_axis = Some(Sampled::Here(samples)),
            AnyDevice::FacetedSolid(solid) if name == key!(FacetedSolid.vertices) => {
                solid.vertices = Some(Sampled::Here(samples));
            }
            AnyDevice::FacetedSolid(solid) => solid.planes = Some(Sampled::Here(samples)),
            _ => {}
        }
    }
    if let (AnyDevice::FacetedSolid(own), Some(path)) = (&mut read, mesh) {
        let data = data_of(key!(FacetedSolid.mesh), path, known, read_mesh)?;
        if let Data::Solid(solid) = data {
            own.mesh = Some(MeshSource::Here(solid));
        }
    }
    Ok(Cow::Owned(read))
}

/// What is in a file, which may be known.
fn data_of(
    key: &'static str,
    path: &Path,
    known: &[Arc<IndexFile>],
    read: fn(&Path) -> Result<Content, String>,
) -> Result<Data, KeyError> {
    let data = match known.iter().find(|known| known.is_at(path)) {
        Some(known) => known.content.as_ref().map(|known| known.data.clone()).map_err(Clone::clone),
        None => read(path).map(|content| content.data),
    };
    data.map_err(|message| KeyError::at(key, message))
}

/// The numbers of a file, as its key allows them.
fn samples_of(key: &Key, path: &Path, known: &[Arc<IndexFile>]) -> Result<Samples, KeyError> {
    let file = path.display();
    let Data::Samples(samples) = data_of(key.name, path, known, read)? else {
        return Err(KeyError::at(key.name, format!("{file} holds a mesh, and no numbers")));
    };
    if let KeyKind::Samples { dimensions: [least, most] } = key.kind {
        let shape = samples.shape();
        let words = [
            "one number",
            "one dimension",
            "two dimensions",
            "three dimensions",
            "four dimensions",
        ];
        let word = |count: usize| words.get(count).copied().unwrap_or("more dimensions");
        let expected = (least..=most).map(word).collect::<Vec<_>>().join(", or ");
        let message = format!(
            "the array in {file} is {}, of {}; {} must be of {expected}",
            shape_text(shape),
            word(shape.len()),
            key.name,
        );
        KeyError::refuse_if(!(least..=most).contains(&shape.len()), key.name, message)?;
    }
    if let Some(at) = samples.values().iter().position(|number| !key.limits.allow(*number)) {
        let message = format!(
            "{}{} is {} in {file}; it must be {}",
            key.name,
            samples.place(at),
            samples.values()[at],
            key.limits.describe()
        );
        return Err(KeyError::at(key.name, message));
    }
    Ok(samples)
}

/// Most dimensions that the array of a file may have: vectors in space.
const MOST_DIMENSIONS: usize = 4;

/// Reads a file of numpy with one array of 64-bit or 32-bit floats.
///
/// # Errors
///
/// A message that names the file and says why it cannot be used.
fn read(path: &Path) -> Result<Content, String> {
    let failed = |reason: String| format!("cannot read {}: {reason}", path.display());
    let bytes = read_file(LONGEST, path).map_err(|error| failed(reason(&error)))?;
    let numbers = match numbers::<f64>(&bytes) {
        Err(ViewNpyError::WrongDescriptor(_)) => numbers::<f32>(&bytes),
        numbers => numbers,
    };
    let (shape, values) = numbers.map_err(|error| match error {
        ViewNpyError::WrongDescriptor(_) => failed("its numbers are no floats".to_owned()),
        error => failed(format!("it is no .npy file of an array of numbers: {error}")),
    })?;
    if shape.len() > MOST_DIMENSIONS {
        let count = shape.len();
        return Err(failed(format!("its array has {count} dimensions; it may have two to four")));
    }
    let samples = Samples::of(&shape, values).map_err(|error| failed(error.to_string()))?;
    Ok(Content { data: Data::Samples(samples), digest: Digest::of(&bytes) })
}

/// Reads a file of a mesh.
///
/// # Errors
///
/// A message that names the file and says why it cannot be used.
fn read_mesh(path: &Path) -> Result<Content, String> {
    let failed = |reason: String| format!("cannot read {}: {reason}", path.display());
    let bytes = read_file(LONGEST, path).map_err(|error| failed(reason(&error)))?;
    let solid = mesh_file::solid(path, &bytes);
    let solid = solid.map_err(|reason| format!("{}: {reason}", path.display()))?;
    Ok(Content { data: Data::Solid(solid), digest: Digest::of(&bytes) })
}

/// The shape and the numbers of an array, the last axis running fastest.
fn numbers<T: ViewElement + Copy + Into<f64>>(
    bytes: &[u8],
) -> Result<(Vec<usize>, Vec<f64>), ViewNpyError> {
    let array = ArrayViewD::<T>::view_npy(bytes)?;
    Ok((array.shape().to_vec(), array.iter().map(|&number| number.into()).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{Array, Array2};
    use ndarray_npy::WriteNpyExt;
    use std::fs::File;

    #[test]
    fn arrays_of_either_order_and_type_are_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.npy");
        let array = Array::from_shape_fn((2, 3), |(i, j)| 1.0 + i as f64 + 0.5 * j as f64);
        let expected = Samples::new(&[vec![1.0, 1.5, 2.0], vec![2.0, 2.5, 3.0]]).expect("a grid");
        array.write_npy(File::create(&path).expect("a file")).expect("written");
        assert_eq!(read(&path).map(|file| file.data), Ok(Data::Samples(expected.clone())));
        array.mapv(|n| n as f32).write_npy(File::create(&path).expect("a file")).expect("written");
        assert_eq!(read(&path).map(|file| file.data), Ok(Data::Samples(expected.clone())));
        let turned: Array2<f64> = array.t().as_standard_layout().into_owned();
        turned.t().write_npy(File::create(&path).expect("a file")).expect("written");
        assert_eq!(read(&path).map(|file| file.data), Ok(Data::Samples(expected)));
    }

    #[test]
    fn what_is_no_such_file_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.npy");
        let refused = |part: &str| {
            let message = read(&path).expect_err("must fail");
            assert!(message.contains("a.npy") && message.contains(part), "{message}");
        };
        refused("there is no such file");
        fs::write(&path, b"nothing").expect("written");
        refused("no .npy file");
        Array::from_elem((2, 2), 1_i32)
            .write_npy(File::create(&path).expect("a file"))
            .expect("written");
        refused("no floats");
        Array::from_elem(3, 1.0_f64)
            .write_npy(File::create(&path).expect("a file"))
            .expect("written");
        let Data::Samples(of_line) = read(&path).expect("numbers").data else { panic!("a mesh") };
        assert_eq!(of_line.shape(), [3]);
        Array::from_elem((2, 1, 1, 1, 2), 1.0_f64)
            .write_npy(File::create(&path).expect("a file"))
            .expect("written");
        refused("its array has 5 dimensions");
        // A header that promises more than memory holds.
        let header = format!(
            "{:<117}\n",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000, 1000000), }"
        );
        let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
        bytes.extend(header.bytes());
        fs::write(&path, &bytes).expect("written");
        refused("no .npy file of an array");
    }
}
