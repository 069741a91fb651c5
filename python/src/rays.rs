//! Rays traced by the million.

use crate::errors::Failure;
use crate::scenes::Scene;
use crate::supervision::supervised;
use cloakroom::ray_json::{Polarization, RayRequest, leaf_table};
use cloakroom::render::ray_settings;
use ndarray::{Array2, ArrayView2, Axis, ShapeError};
use num_complex::Complex64;
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Traces rays of shape (N, 3); `polarization` is a word, `fields` of shape (N, 3) stand instead of
/// it. Gives the arrays of a `Traced` by their names.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "Python gives them by name")]
pub fn trace<'py>(
    py: Python<'py>,
    scene: &Scene,
    origins: PyReadonlyArray2<'py, f64>,
    directions: PyReadonlyArray2<'py, f64>,
    polarization: &str,
    fields: Option<PyReadonlyArray2<'py, Complex64>>,
    min_power: Option<f64>,
    coherent: bool,
    group_delay: bool,
    progress: Option<Py<PyAny>>,
) -> Result<Bound<'py, PyDict>, Failure> {
    let (origins, directions) = (origins.as_array(), directions.as_array());
    let fields = fields.as_ref().map(PyReadonlyArray2::as_array);
    let vertical = polarization == "vertical";
    let count = origins.len_of(Axis(0));
    let settings = ray_settings(scene.scene(), min_power, coherent, group_delay);
    let ray = |index: usize| {
        let row = |array: &ArrayView2<'_, f64>| std::array::from_fn(|axis| array[[index, axis]]);
        let polarization = match &fields {
            Some(fields) => {
                let field = |axis| fields[[index, axis]];
                Polarization::ElectricField([0, 1, 2].map(field).map(|c| [c.re, c.im]))
            }
            None if vertical => Polarization::Vertical,
            None => Polarization::Horizontal,
        };
        RayRequest { origin: row(&origins), direction: row(&directions), polarization }
    };
    let table = supervised(py, progress.as_ref(), |watch, supervision| {
        let assembly = scene.assembly()?;
        watch.begin(count as u64);
        let (done, stop) = (supervision.rows_done, supervision.stop);
        Ok(leaf_table(assembly, settings, count, &ray, done, stop)?)
    })?;
    let arrays = PyDict::new(py);
    arrays.set_item("ray", table.ray.into_pyarray(py))?;
    arrays.set_item("position", triples(table.position)?.into_pyarray(py))?;
    arrays.set_item("direction", triples(table.direction)?.into_pyarray(py))?;
    arrays.set_item("power", table.power.into_pyarray(py))?;
    arrays.set_item("optical_path", table.optical_path.into_pyarray(py))?;
    if group_delay {
        arrays.set_item("group_path", table.group_path.into_pyarray(py))?;
    }
    arrays.set_item("electric_field", triples(table.electric_field)?.into_pyarray(py))?;
    arrays.set_item("absorbed", table.absorbed.into_pyarray(py))?;
    arrays.set_item("pruned", table.pruned.into_pyarray(py))?;
    Ok(arrays)
}

/// Rows of three, their memory as it is.
fn triples<T>(rows: Vec<[T; 3]>) -> Result<Array2<T>, ShapeError> {
    Array2::from_shape_vec((rows.len(), 3), rows.into_flattened())
}
