//! What devices are made of, into files.

use crate::errors::Failure;
use crate::scenes::Scene;
use crate::supervision::supervised;
use cloakroom::material::{self, Frame, Resolution};
use cloakroom::output::{self, GridFormat};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Writes the index and the tensors of a device on a grid: `cells` along x, y and z, or cubes of
/// the side `spacing`.
#[pyfunction]
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
) -> Result<(), Failure> {
    GridFormat::of(&path)?;
    output::check_writable(&path)?;
    let frame = if world { Frame::World } else { Frame::Device };
    let resolution = match (cells, spacing) {
        (Some(cells), _) => Resolution::Cells(cells),
        (None, Some(side)) => Resolution::Spacing(side),
        (None, None) => Resolution::Default,
    };
    supervised(py, progress.as_ref(), |watch, supervision| {
        let (assembly, begun) = (scene.assembly()?, |rows| watch.begin(rows));
        let sampled = material::sample(
            scene.scene(),
            assembly,
            device,
            frame,
            resolution,
            &begun,
            supervision,
        )?;
        Ok(output::write_grid(&sampled, &path)?)
    })
}

/// Writes the homogeneous segments of a device as a table.
#[pyfunction]
pub fn export_table(
    py: Python<'_>,
    scene: &Scene,
    path: PathBuf,
    device: Option<usize>,
) -> Result<(), Failure> {
    supervised(py, None, |_, _| {
        let segments = material::segments(scene.scene(), scene.assembly()?, device)?;
        Ok(material::write_segments(&segments, &path)?)
    })
}
