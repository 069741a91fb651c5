//! What devices are made of, into files.

use crate::errors::{output_error, stopped, value_error};
use crate::scenes::Scene;
use crate::supervision::supervised;
use cloakroom::material::{self, Frame, MaterialError, Resolution};
use cloakroom::output::{self, GridFormat};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use std::path::PathBuf;

/// Writes the index and the tensors of a device on a grid: `cells` along x, y and z, or cubes of the side `spacing`.
#[pyfunction]
#[pyo3(signature = (scene, path, device, cells, spacing, world, progress=None))]
#[expect(clippy::too_many_arguments, reason = "Python gives them by name")]
pub fn export_grid(
    py: Python<'_>,
    scene: &Scene,
    path: PathBuf,
    device: Option<usize>,
    cells: Option<[u32; 3]>,
    spacing: Option<f64>,
    world: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<()> {
    GridFormat::of(&path).map_err(|error| output_error(&error))?;
    output::check_writable(&path).map_err(|error| output_error(&error))?;
    let frame = if world { Frame::World } else { Frame::Device };
    let resolution = match (cells, spacing) {
        (Some(cells), _) => Resolution::Cells(cells),
        (None, Some(side)) => Resolution::Spacing(side),
        (None, None) => Resolution::Default,
    };
    supervised(py, progress.as_ref(), |watch| {
        let assembly = scene.assembly().map_err(|error| scene.located(&error))?;
        let begun = |rows| watch.begin(rows);
        let sampled = watch.supervise(|supervision| {
            material::sample(
                scene.scene(),
                &assembly,
                device,
                frame,
                resolution,
                &begun,
                supervision,
            )
        });
        output::write_grid(&sampled.map_err(failure)?, &path).map_err(|error| output_error(&error))
    })?
}

/// Writes the homogeneous segments of a device as a table.
#[pyfunction]
pub fn export_table(
    py: Python<'_>,
    scene: &Scene,
    path: PathBuf,
    device: Option<usize>,
) -> PyResult<()> {
    supervised(py, None, |_| {
        let assembly = scene.assembly().map_err(|error| scene.located(&error))?;
        let segments = material::segments(scene.scene(), &assembly, device).map_err(failure)?;
        material::write_segments(&segments, &path).map_err(|error| output_error(&error))
    })?
}

fn failure(error: MaterialError) -> PyErr {
    match error {
        MaterialError::Stopped => stopped(),
        MaterialError::TooLarge { .. } => PyMemoryError::new_err(error.to_string()),
        error => value_error(error),
    }
}
