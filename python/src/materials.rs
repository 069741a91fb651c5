//! Materials by the wavelength, and what devices are made of, into files.

use crate::errors::{Failure, value_error};
use crate::scenes::Scene;
use crate::supervision::supervised;
use crate::values::{object_of, value_of};
use cloakroom::keys::Value;
use cloakroom::material::{self, Frame, Resolution};
use cloakroom::material_file::material_of;
use cloakroom::output::{self, GridFormat};
use num_complex::Complex64;
use numpy::{PyArray1, PyReadonlyArray1};
use optics::material::IndexLaw;
use pyo3::prelude::*;
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
