//! Interfaces solved by the thousand.

use crate::errors::{Failure, value_error};
use crate::memory::check_memory;
use crate::supervision::supervised;
use cloakroom::interface_json::{
    ComplexMatrix, InterfaceReport, InterfaceRequest, JonesReport, ModeReport,
};
use glam::DVec3;
use ndarray::{Array2, Array3, ArrayView2, ArrayView3, Axis};
use num_complex::Complex64;
use numpy::{IntoPyArray, PyReadonlyArray2, PyReadonlyArray3};
use optics::medium::{Medium, Tensor};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;
use std::sync::atomic::Ordering;

/// Permittivity and permeability of a medium, each of shape (N, 3, 3), or (1, 3, 3) for all.
type Tensors<'py> = (PyReadonlyArray3<'py, Complex64>, PyReadonlyArray3<'py, Complex64>);

/// The tensors of a medium, and how messages call it.
struct Media<'a> {
    name: &'static str,
    permittivity: ArrayView3<'a, Complex64>,
    permeability: ArrayView3<'a, Complex64>,
    /// The medium, where it is the same everywhere.
    same: Option<Medium>,
}

impl<'a> Media<'a> {
    fn new(name: &'static str, tensors: &'a Tensors<'_>) -> Result<Self, Failure> {
        let (permittivity, permeability) = (tensors.0.as_array(), tensors.1.as_array());
        let mut media = Self { name, permittivity, permeability, same: None };
        if media.permittivity.len_of(Axis(0)) == 1 && media.permeability.len_of(Axis(0)) == 1 {
            media.same = Some(media.medium(0).map_err(value_error)?);
        }
        Ok(media)
    }

    fn medium(&self, index: usize) -> Result<Medium, String> {
        if let Some(medium) = &self.same {
            return Ok(*medium);
        }
        let [permittivity, permeability] =
            [&self.permittivity, &self.permeability].map(|tensors| {
                let tensor = tensors.index_axis(Axis(0), index.min(tensors.len_of(Axis(0)) - 1));
                let mut matrix = Tensor::from(0.0);
                for ((i, j), entry) in tensor.indexed_iter() {
                    matrix.re.col_mut(j)[i] = entry.re;
                    matrix.im.col_mut(j)[i] = entry.im;
                }
                matrix
            });
        Medium::new(permittivity, permeability).map_err(|error| format!("{}: {error}", self.name))
    }
}

/// Bytes of an interface in all arrays: of six modes, of powers, amplitudes and fields.
const ARRAYS: usize = 6 * (3 * 16 + 24 + 2 * 48 + 1) + 2 * 4 * (8 + 16) + 2 * 64 + 32;

/// Solves interfaces with normals and tangential wave vectors of shape (N, 3). Gives the arrays of
/// an `Interface` by their names.
#[pyfunction]
pub fn interface<'py>(
    py: Python<'py>,
    incident: Tensors<'py>,
    transmitted: Option<Tensors<'py>>,
    normals: PyReadonlyArray2<'py, f64>,
    tangentials: PyReadonlyArray2<'py, f64>,
    progress: Option<Py<PyAny>>,
) -> Result<Bound<'py, PyDict>, Failure> {
    let incident = Media::new("incident", &incident)?;
    let beyond = transmitted.as_ref().map(|tensors| Media::new("transmitted", tensors));
    let beyond = beyond.transpose()?;
    let (normals, tangentials) = (normals.as_array(), tangentials.as_array());
    let count = tangentials.len_of(Axis(0));
    // The reports, and the arrays that are made of them.
    let each = 2 * InterfaceReport::BYTES + ARRAYS;
    check_memory(&format!("solving {count} interfaces"), count as u64 * each as u64)?;
    let vector = |array: &ArrayView2<'_, f64>, index: usize| {
        DVec3::new(array[[index, 0]], array[[index, 1]], array[[index, 2]])
    };
    let solve = |index: usize| -> Result<InterfaceReport, String> {
        let request = InterfaceRequest::new(
            incident.medium(index)?,
            beyond.as_ref().map(|media| media.medium(index)).transpose()?,
            vector(&normals, index),
            vector(&tangentials, index),
        );
        request.and_then(|request| request.solve()).map_err(|error| error.to_string())
    };
    let reports = supervised(py, progress.as_ref(), |watch, supervision| {
        watch.begin(count as u64);
        let solved: Vec<Result<InterfaceReport, String>> = (0..count)
            .into_par_iter()
            .map(|index| {
                if supervision.stop.load(Ordering::Relaxed) {
                    return Err("stopped".to_owned());
                }
                (supervision.rows_done)(1);
                solve(index)
            })
            .collect();
        // In order, so that the first bad one is the one that is named.
        let reports = solved.into_iter().enumerate().map(|(index, report)| {
            let named = |problem| format!("interface {index} (counted from 0): {problem}");
            report.map_err(|problem| value_error(named(problem)))
        });
        reports.collect::<Result<Vec<_>, _>>()
    })?;
    let arrays = PyDict::new(py);
    arrays.set_item("incident", modes(py, &reports, |report| &report.incident)?)?;
    arrays.set_item("reflected", modes(py, &reports, |report| &report.reflected)?)?;
    if beyond.is_some() {
        arrays.set_item("transmitted", modes(py, &reports, |report| &report.transmitted)?)?;
    }
    let outgoing = if beyond.is_some() { 4 } else { 2 };
    let power = Array3::from_shape_fn((reports.len(), outgoing, 2), |(i, row, column)| {
        reports[i].power[row][column].unwrap_or(f64::NAN)
    });
    let total = |of: fn(&InterfaceReport) -> [Option<f64>; 2]| {
        Array2::from_shape_fn((reports.len(), 2), |(i, column)| {
            of(&reports[i])[column].unwrap_or(f64::NAN)
        })
    };
    let amplitudes = Array3::from_shape_fn((reports.len(), outgoing, 2), |(i, row, column)| {
        complex(reports[i].amplitudes[row][column])
    });
    let jones = |of: fn(&JonesReport) -> Option<ComplexMatrix>| {
        Array3::from_shape_fn((reports.len(), 2, 2), |(i, row, column)| {
            let matrix = reports[i].jones.as_ref().and_then(of);
            complex(matrix.map_or([f64::NAN; 2], |matrix| matrix[row][column]))
        })
    };
    arrays.set_item("power", power.into_pyarray(py))?;
    arrays.set_item("amplitudes", amplitudes.into_pyarray(py))?;
    let reflected = jones(|jones| Some(jones.reflected));
    arrays.set_item("jones_reflected", reflected.into_pyarray(py))?;
    let transmitted = beyond.is_some().then(|| jones(|jones| jones.transmitted).into_pyarray(py));
    arrays.set_item("jones_transmitted", transmitted)?;
    arrays.set_item("total_reflected", total(|r| r.total_reflected).into_pyarray(py))?;
    arrays.set_item("total_transmitted", total(|r| r.total_transmitted).into_pyarray(py))?;
    Ok(arrays)
}

fn complex([re, im]: [f64; 2]) -> Complex64 {
    Complex64::new(re, im)
}

/// Pairs of modes as arrays (N, 2, 3) and (N, 2).
fn modes<'py>(
    py: Python<'py>,
    reports: &[InterfaceReport],
    of: impl Fn(&InterfaceReport) -> &[ModeReport],
) -> Result<Bound<'py, PyDict>, Failure> {
    let shape = (reports.len(), 2, 3);
    let field = |field: fn(&ModeReport) -> &[[f64; 2]; 3]| {
        Array3::from_shape_fn(shape, |(i, mode, axis)| complex(field(&of(&reports[i])[mode])[axis]))
    };
    let poynting = Array3::from_shape_fn(shape, |(i, mode, axis)| {
        of(&reports[i])[mode].poynting.map_or(f64::NAN, |poynting| poynting[axis])
    });
    let propagating =
        Array2::from_shape_fn((reports.len(), 2), |(i, mode)| of(&reports[i])[mode].propagating);
    let arrays = PyDict::new(py);
    arrays.set_item("wave_vector", field(|mode| &mode.wave_vector).into_pyarray(py))?;
    arrays.set_item("poynting", poynting.into_pyarray(py))?;
    arrays.set_item("electric_field", field(|mode| &mode.electric_field).into_pyarray(py))?;
    arrays.set_item("magnetic_field", field(|mode| &mode.magnetic_field).into_pyarray(py))?;
    arrays.set_item("propagating", propagating.into_pyarray(py))?;
    Ok(arrays)
}
