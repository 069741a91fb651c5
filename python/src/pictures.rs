//! Pictures: rendered into numpy arrays, and from them into files.

use crate::errors::{Failure, unreadable, value_error};
use crate::memory::check_copy;
use crate::scenes::Scene;
use crate::supervision::supervised;
use crate::values::value_of;
use cloakroom::color::BINS;
use cloakroom::keys::Table;
use cloakroom::output::{self, Channel, Picture, Samples};
use cloakroom::render as rendering;
use cloakroom::render::{ChannelSet, Tile};
use cloakroom::scene::PictureSettings;
use cloakroom_figures::{PictureFormat, shown, write_picture};
use ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray3, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::io::Cursor;
use std::path::PathBuf;

/// Channels by their names, and metadata.
type Arrays<'py> = (Bound<'py, PyDict>, Vec<(String, String)>);

/// Channels by their names, metadata, and how many branches of ray trees were cut and lost.
type Rendered<'py> = (Bound<'py, PyDict>, Vec<(String, String)>, (u64, u64));

/// Renders a scene: the image alone, or every channel; all of the picture, or the tile left, top,
/// width, height. `progress` is called with the rows done and all rows.
#[pyfunction]
pub fn render<'py>(
    py: Python<'py>,
    scene: &Scene,
    image_only: bool,
    tile: Option<[u32; 4]>,
    progress: Option<Py<PyAny>>,
) -> Result<Rendered<'py>, Failure> {
    let tile = tile.map(|[left, top, width, height]| {
        Tile { left, top, width, height }.check(scene.scene().camera.resolution)
    });
    let tile = tile.transpose()?;
    let wanted = if image_only { ChannelSet::Image } else { ChannelSet::Everything };
    let rendered = supervised(py, progress.as_ref(), |watch, supervision| {
        let prepared = scene.prepared()?;
        watch.begin(tile.map_or(prepared.rows(), |tile| tile.height.into()));
        Ok(match tile {
            Some(tile) => rendering::render_tile(&prepared, wanted, tile, supervision)?,
            None => rendering::render(&prepared, wanted, supervision)?,
        })
    })?;
    let stats = (rendered.stats.endless, rendered.stats.lost);
    let (channels, metadata) = arrays(py, rendered.picture)?;
    Ok((channels, metadata, stats))
}

/// The pulses of a pixel, by its column and row. Gives JSON.
#[pyfunction]
pub fn pulses(py: Python<'_>, scene: &Scene, pixel: [u32; 2]) -> Result<String, Failure> {
    let list = supervised(py, None, |_, _| Ok(rendering::pulses(&scene.prepared()?, pixel)?))?;
    Ok(serde_json::to_string(&list)?)
}

/// What rendering the image of a scene takes: seconds, rays followed, camera rays, bytes, threads.
#[pyfunction]
pub fn estimate(py: Python<'_>, scene: &Scene) -> Result<(f64, f64, u64, u64, usize), Failure> {
    supervised(py, None, |_, _| {
        let prepared = scene.prepared()?;
        let rendering::Estimate { seconds, walks, samples, bytes } = rendering::estimate(&prepared);
        Ok((seconds, walks, samples, bytes, rayon::current_num_threads()))
    })
}

/// The channels of a picture as arrays, and its metadata. The memory of each channel goes to numpy
/// as it is.
fn arrays(py: Python<'_>, picture: Picture) -> Result<Arrays<'_>, Failure> {
    let shape = (picture.height, picture.width);
    let channels = PyDict::new(py);
    for Channel { name, samples } in picture.channels {
        match samples {
            Samples::F32(values) => channels.set_item(name, plane(py, shape, values)?)?,
            Samples::F64(values) => channels.set_item(name, plane(py, shape, values)?)?,
            Samples::Rgb(values) => {
                let colors = Array3::from_shape_vec((shape.0, shape.1, 3), values.into_flattened());
                channels.set_item(name, colors?.into_pyarray(py))?;
            }
            Samples::Bins(values) => {
                let shape = (shape.0, shape.1, BINS);
                let bins = Array3::from_shape_vec(shape, values.into_flattened());
                channels.set_item(name, bins?.into_pyarray(py))?;
            }
        }
    }
    Ok((channels, picture.metadata))
}

/// Reads a picture from an NPZ.
#[pyfunction]
pub fn read(py: Python<'_>, path: PathBuf) -> Result<Arrays<'_>, Failure> {
    let read = |error| unreadable(&path, error);
    arrays(py, supervised(py, None, |_, _| output::read_npz(&path).map_err(read))?)
}

/// What a tile is called, its channels and its metadata.
type Piece<'py> = (String, Bound<'py, PyDict>, Vec<(String, String)>);

/// Puts tiles together.
#[pyfunction]
pub fn merge<'py>(py: Python<'py>, tiles: Vec<Piece<'py>>) -> Result<Arrays<'py>, Failure> {
    let piece = |(name, channels, metadata): Piece<'_>| {
        Ok((name, metadata, picture_of(&channels, Vec::new())?))
    };
    let pieces = tiles.into_iter().map(piece).collect::<Result<Vec<_>, Failure>>()?;
    arrays(py, rendering::merge(&pieces)?)
}

fn plane<'py, T: numpy::Element>(
    py: Python<'py>,
    shape: (usize, usize),
    values: Vec<T>,
) -> Result<Bound<'py, numpy::PyArray2<T>>, Failure> {
    Ok(Array2::from_shape_vec(shape, values)?.into_pyarray(py))
}

/// Writes channels as the ending of the file's name asks for; a PNG shows the image, or the map of
/// one channel.
#[pyfunction]
pub fn save(
    py: Python<'_>,
    path: PathBuf,
    channels: &Bound<'_, PyDict>,
    metadata: Vec<(String, String)>,
    map: &Bound<'_, PyDict>,
) -> Result<(), Failure> {
    let format = PictureFormat::of(&path)?;
    let (picture, settings) = (picture_of(channels, metadata)?, settings_of(map)?);
    supervised(py, None, |_, _| Ok(write_picture(&picture, &settings, format, &path)?))
}

/// What a PNG of the channels shows, as 8-bit sRGB (height, width, 3).
#[pyfunction]
pub fn srgb<'py>(
    py: Python<'py>,
    channels: &Bound<'py, PyDict>,
    map: &Bound<'py, PyDict>,
) -> Result<Bound<'py, PyArray3<u8>>, Failure> {
    let (picture, settings) = (picture_of(channels, Vec::new())?, settings_of(map)?);
    let image = supervised(py, None, |_, _| Ok(shown(&picture, &settings)?))?;
    let (width, height) = image.dimensions();
    let shape = (height as usize, width as usize, 3);
    Ok(Array3::from_shape_vec(shape, image.into_raw())?.into_pyarray(py))
}

/// A PNG of the channels as bytes.
#[pyfunction]
pub fn png_bytes<'py>(
    py: Python<'py>,
    channels: &Bound<'py, PyDict>,
    metadata: Vec<(String, String)>,
    map: &Bound<'py, PyDict>,
) -> Result<Bound<'py, PyBytes>, Failure> {
    let (picture, settings) = (picture_of(channels, metadata)?, settings_of(map)?);
    let bytes = supervised(py, None, |_, _| {
        let mut out = Cursor::new(Vec::new());
        output::encode_png(&shown(&picture, &settings)?, &picture.metadata, &mut out)?;
        Ok(out.into_inner())
    })?;
    Ok(PyBytes::new(py, &bytes))
}

/// What a picture shows, by keys of a scene's table `picture`.
fn settings_of(keys: &Bound<'_, PyDict>) -> Result<PictureSettings, Failure> {
    let mut settings = PictureSettings::default();
    for (name, object) in keys {
        let name: String = name.extract()?;
        let value = value_of(&name, &object)?;
        settings.set(&name, value).map_err(|error| value_error(error.message))?;
    }
    settings.check_one_range().map_err(|error| value_error(error.message))?;
    Ok(settings)
}

/// The picture that channels are.
pub fn picture_of(
    channels: &Bound<'_, PyDict>,
    metadata: Vec<(String, String)>,
) -> Result<Picture, Failure> {
    let mut size = None;
    let mut taken = Vec::new();
    for (name, array) in channels {
        let name: String = name.extract()?;
        check_copy(&format!("channel `{name}`"), &array)?;
        let (shape, samples) = if let Ok(plane) = array.extract::<PyReadonlyArray2<'_, f32>>() {
            (plane.shape().to_vec(), Samples::F32(plane.as_array().iter().copied().collect()))
        } else if let Ok(plane) = array.extract::<PyReadonlyArray2<'_, f64>>() {
            (plane.shape().to_vec(), Samples::F64(plane.as_array().iter().copied().collect()))
        } else if let Ok(colors) = array.extract::<PyReadonlyArray3<'_, f32>>()
            && colors.shape()[2] == 3
        {
            let values: Vec<f32> = colors.as_array().iter().copied().collect();
            let (texels, _) = values.as_chunks::<3>();
            (colors.shape().to_vec(), Samples::Rgb(texels.to_vec()))
        } else if let Ok(spectra) = array.extract::<PyReadonlyArray3<'_, f32>>()
            && spectra.shape()[2] == BINS
        {
            let values: Vec<f32> = spectra.as_array().iter().copied().collect();
            let (texels, _) = values.as_chunks::<BINS>();
            (spectra.shape().to_vec(), Samples::Bins(texels.to_vec()))
        } else {
            let message = format!(
                "channel `{name}` must be an array of float32 or float64, (height, width), or of float32, \
                 (height, width, 3) or (height, width, 16)"
            );
            return Err(PyTypeError::new_err(message).into());
        };
        let shape = [shape[0], shape[1]];
        if *size.get_or_insert(shape) != shape {
            return Err(value_error(format!("channel `{name}` is not of the size of the others")));
        }
        taken.push(Channel { name, samples });
    }
    let [height, width] = size.filter(|size| !size.contains(&0)).ok_or_else(|| {
        value_error("a picture has one channel at least, and each one pixel at least")
    })?;
    Ok(Picture { width, height, channels: taken, metadata })
}
