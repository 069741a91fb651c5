//! Rays traced by the million.

use crate::errors::{Failure, value_error};
use crate::scenes::Scene;
use crate::supervision::{at_once, supervised};
use cloakroom::output;
use cloakroom::ray_json::{Polarization, launch, leaf_table};
use cloakroom::render::{Supervision, ray_settings};
use cloakroom::trace::{LeafTable, PathTable, RaySettings};
use ndarray::{Array, Array2, Array3, ArrayView2, Axis, ShapeError};
use num_complex::Complex64;
use numpy::{Element, IntoPyArray, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Traces rays of shape (N, 3). `polarization` is a word, `"both"` for two at once; `fields` of the
/// shape (N, 1, 3) or (N, 2, 3) stand instead of it. Gives the arrays of a `Traced` by their names.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "Python gives them by name")]
pub fn trace<'py>(
    py: Python<'py>,
    scene: &Scene,
    origins: PyReadonlyArray2<'py, f64>,
    directions: PyReadonlyArray2<'py, f64>,
    polarization: &str,
    fields: Option<PyReadonlyArray3<'py, Complex64>>,
    min_power: Option<f64>,
    coherent: bool,
    group_delay: bool,
    pick: Option<u64>,
    paths: Option<f64>,
    progress: Option<Py<PyAny>>,
) -> Result<Bound<'py, PyDict>, Failure> {
    let settings = RaySettings {
        pick,
        paths,
        ..ray_settings(scene.scene(), min_power, coherent, group_delay)
    };
    let rays = Rays {
        origins: origins.as_array(),
        directions: directions.as_array(),
        fields: fields.as_ref().map(PyReadonlyArray3::as_array),
    };
    let both = rays.fields.map_or(polarization == "both", |fields| fields.len_of(Axis(1)) == 2);
    if both {
        let words = [Polarization::Horizontal, Polarization::Vertical];
        return arrays(py, leaves(py, scene, &rays, words, settings, progress)?, group_delay);
    }
    let word = match polarization {
        "vertical" => Polarization::Vertical,
        _ => Polarization::Horizontal,
    };
    arrays(py, leaves(py, scene, &rays, [word], settings, progress)?, group_delay)
}

/// So many rays take less time than threads.
const FEW: usize = 16;

/// The rays as they are handed over.
#[derive(Clone, Copy)]
struct Rays<'a> {
    origins: ArrayView2<'a, f64>,
    directions: ArrayView2<'a, f64>,
    fields: Option<ndarray::ArrayView3<'a, Complex64>>,
}

fn leaves<const N: usize>(
    py: Python<'_>,
    scene: &Scene,
    rays: &Rays<'_>,
    words: [Polarization; N],
    settings: RaySettings,
    progress: Option<Py<PyAny>>,
) -> Result<LeafTable<N>, Failure> {
    let Rays { origins, directions, fields } = *rays;
    let count = origins.len_of(Axis(0));
    let launched = |index: usize| {
        let row = |array: &ArrayView2<'_, f64>| std::array::from_fn(|axis| array[[index, axis]]);
        let polarizations = match &fields {
            Some(fields) => std::array::from_fn(|i| {
                let field = [0, 1, 2].map(|axis| fields[[index, i, axis]]);
                Polarization::ElectricField(field.map(|c| [c.re, c.im]))
            }),
            None => words,
        };
        launch(row(&origins), row(&directions), polarizations)
    };
    let traced = |supervision: &Supervision<'_>| -> Result<_, Failure> {
        let (done, stop) = (supervision.rows_done, supervision.stop);
        Ok(leaf_table(scene.assembly()?, settings, count, &launched, done, stop)?)
    };
    if count <= FEW && scene.is_built() && progress.is_none() {
        return at_once(py, traced);
    }
    supervised(py, progress.as_ref(), |watch, supervision| {
        scene.assembly()?;
        watch.begin(count as u64);
        traced(supervision)
    })
}

/// The arrays of a `Traced`. Of one polarization they have no axis for it.
fn arrays<const N: usize>(
    py: Python<'_>,
    table: LeafTable<N>,
    group_delay: bool,
) -> Result<Bound<'_, PyDict>, Failure> {
    let (arrays, leaves) = (PyDict::new(py), table.ray.len());
    arrays.set_item("ray", table.ray.into_pyarray(py))?;
    arrays.set_item("position", triples(table.position)?.into_pyarray(py))?;
    arrays.set_item("direction", triples(table.direction)?.into_pyarray(py))?;
    arrays.set_item("power", polarized(py, table.power)?)?;
    arrays.set_item("optical_path", table.optical_path.into_pyarray(py))?;
    if group_delay {
        arrays.set_item("group_path", table.group_path.into_pyarray(py))?;
    }
    let fields = table.electric_field.into_flattened();
    if N == 1 {
        arrays.set_item("electric_field", triples(fields)?.into_pyarray(py))?;
    } else {
        let fields = Array3::from_shape_vec((leaves, N, 3), fields.into_flattened())?;
        arrays.set_item("electric_field", fields.into_pyarray(py))?;
    }
    arrays.set_item("absorbed", polarized(py, table.absorbed)?)?;
    arrays.set_item("pruned", polarized(py, table.pruned)?)?;
    if let Some(paths) = table.paths {
        let of_paths = PyDict::new(py);
        of_paths.set_item("ray", paths.ray.into_pyarray(py))?;
        of_paths.set_item("power", polarized(py, paths.power)?)?;
        of_paths.set_item("leaf", paths.leaf.into_pyarray(py))?;
        of_paths.set_item("parent", paths.parent.into_pyarray(py))?;
        let start: Vec<i64> = paths.start.iter().map(|start| *start as i64).collect();
        of_paths.set_item("start", start.into_pyarray(py))?;
        of_paths.set_item("vertex", triples(paths.vertex)?.into_pyarray(py))?;
        of_paths.set_item("optical_path", paths.optical_path.into_pyarray(py))?;
        arrays.set_item("paths", of_paths)?;
    }
    Ok(arrays)
}

/// Numbers for each polarization: of one, (N,); of two, (N, 2).
fn polarized<T: Element, const N: usize>(
    py: Python<'_>,
    rows: Vec<[T; N]>,
) -> Result<Bound<'_, PyAny>, Failure> {
    let count = rows.len();
    let flat = rows.into_flattened();
    Ok(if N == 1 {
        flat.into_pyarray(py).into_any()
    } else {
        Array::from_shape_vec((count, N), flat)?.into_pyarray(py).into_any()
    })
}

/// Rows of three, their memory as it is.
fn triples<T>(rows: Vec<[T; 3]>) -> Result<Array2<T>, ShapeError> {
    Array2::from_shape_vec((rows.len(), 3), rows.into_flattened())
}

/// Writes paths as VTK polygonal data: `power` of the shape (P, N), the others as those of `Paths`.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "Python gives them by name")]
pub fn export_paths(
    py: Python<'_>,
    path: PathBuf,
    ray: PyReadonlyArray1<'_, u32>,
    power: PyReadonlyArray2<'_, f64>,
    leaf: PyReadonlyArray1<'_, i64>,
    parent: PyReadonlyArray1<'_, i64>,
    start: PyReadonlyArray1<'_, i64>,
    vertex: PyReadonlyArray2<'_, f64>,
    optical_path: PyReadonlyArray1<'_, f64>,
) -> Result<(), Failure> {
    let power = power.as_array();
    let (ray, leaf, parent) = (ray.as_array(), leaf.as_array(), parent.as_array());
    let (start, vertex) = (start.as_array(), vertex.as_array());
    let optical_path = optical_path.as_array();
    let (paths, vertices) = (ray.len(), vertex.len_of(Axis(0)));
    let fit = [leaf.len(), parent.len(), power.len_of(Axis(0))].iter().all(|rows| *rows == paths)
        && start.len() == paths + 1
        && start.iter().zip(start.iter().skip(1)).all(|(begin, end)| begin <= end)
        && [start[0], start[paths]] == [0, vertices as i64]
        && optical_path.len() == vertices
        && vertex.len_of(Axis(1)) == 3
        && matches!(power.len_of(Axis(1)), 1 | 2);
    if !fit {
        return Err(value_error("the arrays of the paths are not of the same paths"));
    }
    let table = PathTable::<1> {
        ray: ray.to_vec(),
        power: Vec::new(),
        leaf: leaf.to_vec(),
        parent: parent.to_vec(),
        // None is below the first, which is 0.
        start: start.iter().map(|start| *start as u64).collect(),
        vertex: vertex.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect(),
        optical_path: optical_path.to_vec(),
    };
    let polarizations = power.len_of(Axis(1));
    let powers: Vec<f64> = power.iter().copied().collect();
    supervised(py, None, |_, _| {
        let written = match polarizations {
            1 => output::write_paths(&with_power::<1>(table, &powers), &[], &path),
            _ => output::write_paths(&with_power::<2>(table, &powers), &[], &path),
        };
        Ok(written?)
    })
}

/// The paths with their powers, which are as many as the rows of numbers have.
fn with_power<const N: usize>(paths: PathTable, powers: &[f64]) -> PathTable<N> {
    let PathTable { ray, leaf, parent, start, vertex, optical_path, .. } = paths;
    let power = powers.as_chunks::<N>().0.to_vec();
    PathTable { ray, power, leaf, parent, start, vertex, optical_path }
}
