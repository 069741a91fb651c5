//! What is measured: pictures against each other, devices over settings, light on a receiver, the paper's statements.

use crate::errors::{output_error, stopped, value_error};
use crate::images::Image;
use crate::pictures::picture_of;
use crate::scenes::Scene;
use crate::supervision::supervised;
use cloakroom::flux::{self as light, Direction, FluxError, Sampling};
use cloakroom::measure::{
    self, Plan, QualityError, Region, Sweep, View, quality as measured_quality,
};
use cloakroom::output;
use cloakroom::photograph::ImageSource;
use cloakroom::render::RenderError;
use cloakroom_figures::verification::{self, VerificationError};
use cloakroom_figures::{IllustrationError, STANDARD_PLOT, TableError, TableFormat, write_table};
use ndarray::{ArrayD, IxDyn};
use numpy::{IntoPyArray, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyFileNotFoundError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

/// A picture as it may be handed over: the channels of one, an image, or the name of a file.
fn view(object: &Bound<'_, PyAny>) -> PyResult<View> {
    if let Ok(channels) = object.cast::<PyDict>() {
        return View::of(&picture_of(channels, Vec::new())?).map_err(value_error);
    }
    if let Ok(image) = object.cast::<Image>()
        && let ImageSource::Memory(image) = &image.get().source
    {
        return View::of_linear(image).map_err(value_error);
    }
    let path: PathBuf = object
        .extract()
        .map_err(|_| PyTypeError::new_err("a picture, an array or a path is expected"))?;
    View::read(&path).map_err(|error| {
        if path.exists() {
            value_error(error)
        } else {
            PyFileNotFoundError::new_err(error.to_string())
        }
    })
}

/// Compares two pictures, over the whole and over a region: a mask (height, width), or left, top, width and height in
/// pixels. Gives JSON.
#[pyfunction]
#[pyo3(signature = (first, second, mask=None, rectangle=None))]
pub fn quality(
    py: Python<'_>,
    first: &Bound<'_, PyAny>,
    second: &Bound<'_, PyAny>,
    mask: Option<PyReadonlyArray2<'_, bool>>,
    rectangle: Option<[usize; 4]>,
) -> PyResult<String> {
    let (first, second) = (view(first)?, view(second)?);
    let region = match (mask, rectangle) {
        (Some(mask), _) => {
            let width = mask.shape()[1].max(1);
            Some(Region::new(width, mask.as_array().iter().copied().collect()))
        }
        (None, Some(rectangle)) => Some(Region::rectangle(&first, rectangle)),
        (None, None) => None,
    };
    let region = region.transpose().map_err(value_error)?;
    let comparison = supervised(py, None, |_| measure::compare(&first, &second, region.as_ref()))?;
    serde_json::to_string(&comparison.map_err(value_error)?).map_err(value_error)
}

/// Measures a scene for every combination of the values of keys, as overrides write them; `path` may name a table or a
/// plot to write. Gives JSON.
#[pyfunction]
#[pyo3(signature = (scene, sweeps, path=None, progress=None))]
pub fn sweep(
    py: Python<'_>,
    scene: &Scene,
    sweeps: Vec<(String, Vec<String>)>,
    path: Option<PathBuf>,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let format = path.as_deref().map(TableFormat::of).transpose();
    let format = format.map_err(|error| output_error(&error))?;
    check_writable(path.as_deref())?;
    let sweeps: Vec<Sweep> =
        sweeps.into_iter().map(|(key, values)| Sweep { key, values }).collect();
    let table = supervised(py, progress.as_ref(), |watch| {
        let plan = Plan::new(sweeps, |further| scene.reload(further)).map_err(quality_error)?;
        watch.begin(plan.steps());
        watch.supervise(|supervision| measured_quality(&plan, supervision)).map_err(quality_error)
    })??;
    if let (Some(path), Some(format)) = (&path, format) {
        let plot = STANDARD_PLOT.map(str::to_owned);
        write_table(&table, format, &plot, path).map_err(|error| match error {
            TableError::Drawing(IllustrationError::Output(error)) => output_error(&error),
            error => value_error(error),
        })?;
    }
    serde_json::to_string(&table.to_json()).map_err(value_error)
}

/// Says before long work that a file cannot be written.
fn check_writable(path: Option<&Path>) -> PyResult<()> {
    path.map_or(Ok(()), output::check_writable).map_err(|error| output_error(&error))
}

fn quality_error(error: QualityError) -> PyErr {
    match error {
        QualityError::Render(RenderError::Stopped) => stopped(),
        error => value_error(error),
    }
}

/// Goes through the statements of the paper. Gives JSON.
#[pyfunction]
#[pyo3(signature = (progress=None))]
pub fn verify(py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<String> {
    let findings = supervised(py, progress.as_ref(), |watch| {
        watch.begin(verification::steps());
        verification::verify(&|| watch.advance(1), watch.stop())
    })?
    .map_err(|error| match error {
        VerificationError::Render(RenderError::Stopped) => stopped(),
        error => value_error(error),
    })?;
    serde_json::to_string(&findings).map_err(value_error)
}

/// Measures the light on the receiver, for angles of incidence tilted along the receiver, or for the sun over a day at a
/// latitude with a declination; `sampling` is rays, samples and cells. Gives arrays by their names.
#[pyfunction]
#[pyo3(signature = (scene, angles, tilt, sun, sampling, path=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "Python gives them by name")]
pub fn flux<'py>(
    py: Python<'py>,
    scene: &Scene,
    angles: Vec<f64>,
    tilt: f64,
    sun: Option<[f64; 2]>,
    sampling: [u32; 3],
    path: Option<PathBuf>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    check_writable(path.as_deref())?;
    let receiver = &scene.scene().receiver;
    let directions: Vec<Direction> = match sun {
        Some([latitude, declination]) => light::sun_day(receiver, latitude, declination, 0.5),
        None => light::across_range(receiver, &angles, tilt),
    };
    let [rays, samples, cells] = sampling;
    let sampling = Sampling { rays, samples, cells };
    let report = supervised(py, progress.as_ref(), |watch| {
        watch.supervise(|supervision| {
            let begun = |steps| watch.begin(steps);
            light::flux(scene.scene(), &directions, sampling, &begun, supervision)
        })
    })?
    .map_err(|error| match error {
        FluxError::Scene(error) => scene.located(&error),
        FluxError::Stopped => stopped(),
        error => value_error(error),
    })?;
    if let Some(path) = path {
        light::write_flux_npz(&report, &path).map_err(|error| output_error(&error))?;
    }
    let arrays = PyDict::new(py);
    for (name, shape, values) in light::flux_arrays(&report).into_parts() {
        let array = ArrayD::from_shape_vec(IxDyn(&shape), values).map_err(value_error)?;
        arrays.set_item(name, array.into_pyarray(py))?;
    }
    Ok(arrays)
}
