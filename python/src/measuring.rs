//! What is measured: pictures against each other, devices over settings, light on a receiver, the
//! paper's statements.

use crate::errors::{Failure, unreadable};
use crate::images::Image;
use crate::pictures::picture_of;
use crate::scenes::Scene;
use crate::supervision::supervised;
use crate::values::value_of;
use cloakroom::flux::{self as light, Direction, FluxError, Sampling};
use cloakroom::measure::{self, PixelMask, Sweep, SweepPlan, View};
use cloakroom::output;
use cloakroom::photograph::ImageSource;
use cloakroom_figures::verification;
use cloakroom_figures::{STANDARD_PLOT, TableFormat, write_table};
use ndarray::ArrayD;
use numpy::{IntoPyArray, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// A picture as it may be handed over: the channels of one, an image, or the name of a file.
fn view(object: &Bound<'_, PyAny>) -> Result<View, Failure> {
    if let Ok(channels) = object.cast::<PyDict>() {
        return Ok(View::of(&picture_of(channels, Vec::new())?)?);
    }
    if let Ok(image) = object.cast::<Image>()
        && let ImageSource::Memory(image) = &image.get().source
    {
        return Ok(View::of_linear(image)?);
    }
    let path: PathBuf = object
        .extract()
        .map_err(|_| PyTypeError::new_err("a picture, an array or a path is expected"))?;
    View::read(&path).map_err(|error| unreadable(&path, error))
}

/// Compares two pictures, over the whole and over a region: a mask (height, width), or left, top,
/// width and height in pixels. Gives JSON.
#[pyfunction]
pub fn quality(
    py: Python<'_>,
    first: &Bound<'_, PyAny>,
    second: &Bound<'_, PyAny>,
    mask: Option<PyReadonlyArray2<'_, bool>>,
    rectangle: Option<[usize; 4]>,
) -> Result<String, Failure> {
    let (first, second) = (view(first)?, view(second)?);
    let region = match (mask, rectangle) {
        (Some(mask), _) => {
            let width = mask.shape()[1].max(1);
            Some(PixelMask::new(width, mask.as_array().iter().copied().collect()))
        }
        (None, Some(rectangle)) => Some(PixelMask::rectangle(&first, rectangle)),
        (None, None) => None,
    };
    let region = region.transpose()?;
    let compare = || measure::compare(&first, &second, region.as_ref());
    Ok(serde_json::to_string(&supervised(py, None, |_, _| Ok(compare()?))?)?)
}

/// Measures a scene for every combination of the values of keys, by their keys; `reference`
/// has the devices that should be seen; `path` may name a table or a plot to write. Gives JSON.
#[pyfunction]
pub fn sweep(
    py: Python<'_>,
    scene: &Scene,
    sweeps: Vec<(String, Vec<Bound<'_, PyAny>>)>,
    reference: Option<&Scene>,
    path: Option<PathBuf>,
    progress: Option<Py<PyAny>>,
) -> Result<String, Failure> {
    let format = path.as_deref().map(TableFormat::of).transpose()?;
    path.as_deref().map_or(Ok(()), output::check_writable)?;
    let sweep = |(key, values): (String, Vec<Bound<'_, PyAny>>)| {
        let values = values.iter().map(|value| value_of(&key, value)).collect::<PyResult<_>>()?;
        Ok(Sweep::through(key, values))
    };
    let sweeps = sweeps.into_iter().map(sweep).collect::<PyResult<Vec<Sweep>>>()?;
    let table = supervised(py, progress.as_ref(), |watch, supervision| {
        let plan = SweepPlan::new(sweeps, Vec::new(), |further| scene.reload(further))?;
        let plan = match reference {
            Some(reference) => {
                reference.assembly()?;
                plan.with_reference(reference.scene().clone())
            }
            None => plan,
        };
        watch.begin(plan.steps());
        Ok(measure::quality(&plan, supervision)?)
    })?;
    if let (Some(path), Some(format)) = (&path, format) {
        write_table(&table, format, &STANDARD_PLOT.map(str::to_owned), path)?;
    }
    Ok(serde_json::to_string(&table.to_json())?)
}

/// Goes through the statements of the paper. Gives JSON.
#[pyfunction]
pub fn verify(py: Python<'_>, progress: Option<Py<PyAny>>) -> Result<String, Failure> {
    let findings = supervised(py, progress.as_ref(), |watch, supervision| {
        watch.begin(verification::steps());
        Ok(verification::verify(&|| (supervision.rows_done)(1), supervision.stop)?)
    })?;
    Ok(serde_json::to_string(&findings)?)
}

/// Measures the light on the receiver, for angles of incidence tilted along the receiver, or for
/// the sun over a day at a latitude with a declination; `sampling` is rays, samples and cells.
/// Gives arrays by their names.
#[pyfunction]
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
) -> Result<Bound<'py, PyDict>, Failure> {
    path.as_deref().map_or(Ok(()), output::check_writable)?;
    let receiver = &scene.scene().receiver;
    let directions: Vec<Direction> = match sun {
        Some([latitude, declination]) => light::sun_day(receiver, latitude, declination, 0.5),
        None => light::across_range(receiver, &angles, tilt),
    };
    let [rays, samples, cells] = sampling;
    let sampling = Sampling { rays, samples, cells };
    let report = supervised(py, progress.as_ref(), |watch, supervision| {
        let begun = |steps| watch.begin(steps);
        let report = light::flux(scene.scene(), &directions, sampling, &begun, supervision);
        report.map_err(|error| match error {
            FluxError::Scene(error) => scene.located(&error),
            error => error.into(),
        })
    })?;
    if let Some(path) = path {
        light::write_flux_npz(&report, &path)?;
    }
    let arrays = PyDict::new(py);
    for (name, shape, values) in light::flux_arrays(&report) {
        arrays.set_item(name, ArrayD::from_shape_vec(shape, values)?.into_pyarray(py))?;
    }
    Ok(arrays)
}
