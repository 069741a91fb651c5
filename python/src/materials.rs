//! Materials by the wavelength, and what devices are made of, into files.

use crate::errors::{Failure, value_error};
use crate::scenes::Scene;
use crate::supervision::supervised;
use crate::values::{object_of, value_of};
use cloakroom::keys::Value;
use cloakroom::material::{self, Frame, Resolution};
use cloakroom::material_file::material_of;
use cloakroom::output::{self, GridFormat, ShapedArray};
use num_complex::Complex64;
use numpy::{PyArray1, PyReadonlyArray1, ToPyArray};
use optics::material::IndexLaw;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

const UM_PER_NM: f64 = 1e-3;

/// A material, and how a scene says which it is.
#[pyclass(frozen)]
pub struct Material {
    pub value: Value,
    material: Arc<optics::material::Material>,
}

#[pymethods]
impl Material {
    #[new]
    fn new(what: &Bound<'_, PyAny>) -> Result<Self, Failure> {
        let value = value_of("material", what)?;
        let material = material_of(&value).map_err(value_error)?;
        Ok(Self { value, material })
    }

    /// What the key `material` of a scene says.
    #[getter]
    fn value<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object_of(py, &self.value)
    }

    #[getter]
    fn title(&self) -> &str {
        &self.material.title
    }

    #[getter]
    fn source(&self) -> &str {
        &self.material.source
    }

    #[getter]
    fn is_uniaxial(&self) -> bool {
        self.material.extraordinary.is_some()
    }

    /// From where to where its laws hold, nm.
    #[getter]
    fn range_nm(&self) -> (f64, f64) {
        let laws = std::iter::once(&self.material.ordinary).chain(&self.material.extraordinary);
        laws.fold((0.0, f64::INFINITY), |(least, most), law| {
            let [from, to] = law.range_um.map(|um| (um * 1e6).round() / 1e3);
            (least.max(from), most.min(to))
        })
    }

    /// Complex indices and complex group indices at wavelengths in nm.
    fn indices<'py>(
        &self,
        py: Python<'py>,
        wavelengths_nm: PyReadonlyArray1<'py, f64>,
        extraordinary: bool,
    ) -> Result<[Bound<'py, PyArray1<Complex64>>; 2], Failure> {
        let law: &IndexLaw = match &self.material.extraordinary {
            Some(law) if extraordinary => law,
            _ => &self.material.ordinary,
        };
        let at = |nm: &f64| {
            law.at(nm * UM_PER_NM)
                .map_err(|error| value_error(format!("{}: {error}", self.material.title)))
        };
        let wavelengths = wavelengths_nm.as_array();
        let found: Vec<_> = wavelengths.iter().map(at).collect::<Result<_, _>>()?;
        Ok([
            PyArray1::from_iter(py, found.iter().map(|at| at.index)),
            PyArray1::from_iter(py, found.iter().map(|at| at.group_index)),
        ])
    }
}

/// The index and the tensors of a device on a grid, `cells` along x, y and z, or cubes of the side
/// `spacing`: into a file, or as arrays by their names.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "Python gives them by name")]
pub fn export_grid<'py>(
    py: Python<'py>,
    scene: &Scene,
    path: Option<PathBuf>,
    device: Option<usize>,
    cells: Option<[u32; 3]>,
    spacing: Option<f64>,
    world: bool,
    progress: Option<Py<PyAny>>,
) -> Result<Option<Bound<'py, PyDict>>, Failure> {
    if let Some(path) = &path {
        GridFormat::of(path)?;
        output::check_writable(path)?;
    }
    let frame = if world { Frame::World } else { Frame::Device };
    let resolution = match (cells, spacing) {
        (Some(cells), _) => Resolution::Cells(cells),
        (None, Some(side)) => Resolution::Spacing(side),
        (None, None) => Resolution::Default,
    };
    let sampled = supervised(py, progress.as_ref(), |watch, supervision| {
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
        path.as_deref().map_or(Ok(()), |path| output::write_grid(&sampled, path))?;
        Ok(sampled)
    })?;
    if path.is_some() {
        return Ok(None);
    }
    let arrays = PyDict::new(py);
    for (name, array) in sampled.shaped() {
        match array {
            ShapedArray::Codes(codes) => arrays.set_item(name, codes.to_pyarray(py))?,
            ShapedArray::Numbers(numbers) => arrays.set_item(name, numbers.to_pyarray(py))?,
        }
    }
    Ok(Some(arrays))
}

/// The homogeneous segments of a device: into a file, or as JSON.
#[pyfunction]
pub fn export_table(
    py: Python<'_>,
    scene: &Scene,
    path: Option<PathBuf>,
    device: Option<usize>,
) -> Result<Option<String>, Failure> {
    supervised(py, None, |_, _| {
        let segments = material::segments(scene.scene(), scene.assembly()?, device)?;
        Ok(match path {
            Some(path) => material::write_segments(&segments, &path).map(|()| None)?,
            None => Some(serde_json::to_string(&segments)?),
        })
    })
}
