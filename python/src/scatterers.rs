//! Devices for renderers of others: rays in, one leaf of each out.

use crate::errors::{Failure, value_error};
use crate::scenes::Scene;
use crate::supervision::{at_once, supervised};
use cloakroom::assembly::Placed;
use cloakroom::outline_mesh::{Matter, outlines};
use cloakroom::render::Supervision;
use cloakroom::trace::{
    Launch, Limits, Placement, RayStatus, ScatterRay, Scattered, scatter as scatter_rays,
};
use glam::{DMat3, DVec3};
use ndarray::{Array2, ArrayView1, ArrayView2, ArrayView3, Axis};
use num_complex::Complex;
use numpy::{Element, IntoPyArray, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use optics::geometry::{Pose, REACH, Solid};
use optics::wave::{ComplexVector, transverse_basis, unit};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// So many rays take less time than threads.
const FEW: usize = 64;

/// A number of an array.
trait Real: Element + Copy + Send + Sync {
    fn get(self) -> f64;
    fn of(number: f64) -> Self;
}

impl Real for f64 {
    fn get(self) -> f64 {
        self
    }

    fn of(number: f64) -> Self {
        number
    }
}

impl Real for f32 {
    fn get(self) -> f64 {
        f64::from(self)
    }

    fn of(number: f64) -> Self {
        number as Self
    }
}

/// The rays as they are handed over.
struct Rays<'a, T> {
    origins: ArrayView2<'a, T>,
    directions: ArrayView2<'a, T>,
    draws: Option<ArrayView1<'a, T>>,
    fields: Option<ArrayView3<'a, Complex<f64>>>,
}

impl<T: Real> Rays<'_, T> {
    fn ray(&self, number: usize) -> ScatterRay {
        let row = |array: &ArrayView2<'_, T>| {
            DVec3::from_array(std::array::from_fn(|axis| array[[number, axis]].get()))
        };
        let origin = row(&self.origins);
        // What is no direction is refused later.
        let direction = unit(row(&self.directions)).unwrap_or_default();
        let electric = match &self.fields {
            Some(fields) => std::array::from_fn(|i| {
                let part = |part: fn(&Complex<f64>) -> f64| {
                    DVec3::from_array(std::array::from_fn(|axis| part(&fields[[number, i, axis]])))
                };
                ComplexVector::new(part(|c| c.re), part(|c| c.im))
            }),
            None => {
                let (horizontal, vertical) = transverse_basis(direction, DVec3::Z, DVec3::X);
                [horizontal.into(), vertical.into()]
            }
        };
        let draw = self.draws.as_ref().map(|draws| draws[number].get());
        ScatterRay { launch: Launch { origin, direction, electric }, draw }
    }
}

/// Where the devices of a scene stand: a rotation and a place in a world whose unit is so many cm.
fn placement(rotation: ArrayView2<'_, f64>, place: ArrayView1<'_, f64>, unit: f64) -> Placement {
    let column = |axis| DVec3::from_array([0, 1, 2].map(|row| rotation[[row, axis]]));
    let origin = DVec3::from_array([0, 1, 2].map(|axis| place[axis])) * unit;
    let rotation = DMat3::from_cols(column(0), column(1), column(2));
    let upright = rotation.z_axis == DVec3::Z;
    let angle = rotation.x_axis.y.atan2(rotation.x_axis.x);
    let turned = || Pose::from_rotation(origin, rotation);
    Placement { pose: if upright { Pose::new(origin, angle) } else { turned() }, unit }
}

/// Scatters rays of shape (N, 3), all of `float32` or of `float64`. Gives the arrays of a `Scattered` by
/// their names; fields only if they are wanted or given.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "Python gives them by name")]
pub fn scatter<'py>(
    py: Python<'py>,
    scene: &Scene,
    origins: &Bound<'py, PyAny>,
    directions: &Bound<'py, PyAny>,
    draws: Option<&Bound<'py, PyAny>>,
    fields: Option<PyReadonlyArray3<'py, Complex<f64>>>,
    want_fields: bool,
    rotation: PyReadonlyArray2<'py, f64>,
    place: PyReadonlyArray1<'py, f64>,
    unit: f64,
    min_power: f64,
) -> Result<Bound<'py, PyDict>, Failure> {
    let limits = Limits { min_power, tolerance: scene.scene().trace.tolerance };
    let placement = placement(rotation.as_array(), place.as_array(), unit);
    let fields = fields.as_ref().map(PyReadonlyArray3::as_array);
    let work = Work { py, scene, limits, placement, want_fields: want_fields || fields.is_some() };
    if let Ok(origins) = origins.extract::<PyReadonlyArray2<'py, f32>>() {
        let directions: PyReadonlyArray2<'py, f32> = directions.extract()?;
        let draws: Option<PyReadonlyArray1<'py, f32>> =
            draws.map(PyAnyMethods::extract).transpose()?;
        let draws = draws.as_ref().map(PyReadonlyArray1::as_array);
        let (origins, directions) = (origins.as_array(), directions.as_array());
        return work.of(&Rays { origins, directions, draws, fields });
    }
    let origins: PyReadonlyArray2<'py, f64> = origins.extract()?;
    let directions: PyReadonlyArray2<'py, f64> = directions.extract()?;
    let draws: Option<PyReadonlyArray1<'py, f64>> = draws.map(PyAnyMethods::extract).transpose()?;
    let draws = draws.as_ref().map(PyReadonlyArray1::as_array);
    let (origins, directions) = (origins.as_array(), directions.as_array());
    work.of(&Rays { origins, directions, draws, fields })
}

struct Work<'a, 'py> {
    py: Python<'py>,
    scene: &'a Scene,
    limits: Limits,
    placement: Placement,
    want_fields: bool,
}

impl<'py> Work<'_, 'py> {
    fn of<T: Real>(&self, rays: &Rays<'_, T>) -> Result<Bound<'py, PyDict>, Failure> {
        let Self { py, scene, limits, placement, want_fields } = self;
        let count = rays.origins.len_of(Axis(0));
        let traced = |supervision: &Supervision<'_>| -> Result<_, Failure> {
            let (done, stop) = (supervision.rows_done, supervision.stop);
            let ray = |number: usize| rays.ray(number);
            Ok(scatter_rays(scene.assembly()?, *limits, placement, count, &ray, done, stop)?)
        };
        let scattered = if count <= FEW && scene.is_built() {
            at_once(*py, traced)?
        } else {
            supervised(*py, None, |_, supervision| traced(supervision))?
        };
        let every = rays.draws.is_none();
        arrays::<T>(*py, &scattered, every, *want_fields)
    }
}

fn arrays<'py, T: Real>(
    py: Python<'py>,
    scattered: &[Scattered],
    every: bool,
    want_fields: bool,
) -> Result<Bound<'py, PyDict>, Failure> {
    let arrays = PyDict::new(py);
    let real = |of: fn(&Scattered) -> f64| {
        scattered.iter().map(|leaf| T::of(of(leaf))).collect::<Vec<T>>().into_pyarray(py)
    };
    let vectors = |of: fn(&Scattered) -> DVec3| -> Result<Bound<'py, PyArray2<T>>, Failure> {
        let mut rows = Vec::with_capacity(3 * scattered.len());
        scattered.iter().for_each(|leaf| rows.extend(of(leaf).to_array().map(T::of)));
        Ok(Array2::from_shape_vec((scattered.len(), 3), rows)?.into_pyarray(py))
    };
    if every {
        let rays: Vec<u32> = scattered.iter().map(|leaf| leaf.ray).collect();
        arrays.set_item("ray", rays.into_pyarray(py))?;
    }
    let status: Vec<u8> = scattered.iter().map(|leaf| leaf.status as u8).collect();
    arrays.set_item("status", status.into_pyarray(py))?;
    let straight: Vec<bool> = scattered.iter().map(|leaf| leaf.straight).collect();
    arrays.set_item("straight", straight.into_pyarray(py))?;
    arrays.set_item("position", vectors(|leaf| leaf.position)?)?;
    arrays.set_item("direction", vectors(|leaf| leaf.direction)?)?;
    arrays.set_item("weight", real(|leaf| leaf.weight))?;
    arrays.set_item("probability", real(|leaf| leaf.probability))?;
    arrays.set_item("transmitted", real(|leaf| leaf.transmitted))?;
    arrays.set_item("pruned", real(|leaf| leaf.pruned))?;
    arrays.set_item("optical_path", real(|leaf| leaf.optical_path))?;
    let path: Vec<u64> = scattered.iter().map(|leaf| leaf.path).collect();
    arrays.set_item("path", path.into_pyarray(py))?;
    let body = |leaf: &Scattered| match leaf.status {
        RayStatus::Ended => i32::from(leaf.body),
        _ => -1,
    };
    let body: Vec<i32> = scattered.iter().map(body).collect();
    arrays.set_item("body", body.into_pyarray(py))?;
    if want_fields {
        let fields = scattered.iter().flat_map(|leaf| leaf.electric.map(|e| e.components()));
        let fields: Vec<Complex<f64>> = fields.flatten().collect();
        let fields = ndarray::Array3::from_shape_vec((scattered.len(), 2, 3), fields)?;
        arrays.set_item("electric_field", fields.into_pyarray(py))?;
    }
    Ok(arrays)
}

/// The axes and the origin of a frame (3, 4), the least and the greatest coordinates in it, and whether it
/// is a ball that touches them.
type DeviceBounds<'py> = (Bound<'py, PyArray2<f64>>, [f64; 3], [f64; 3], bool);

/// The name of a part, what it is of, and its triangles (N, 9).
type Outline<'py> = (String, &'static str, Bound<'py, PyArray2<f64>>);

/// The space that each device takes up, in the unit of a world of so many cm.
#[pyfunction]
pub fn device_bounds<'py>(
    py: Python<'py>,
    scene: &Scene,
    unit: f64,
) -> Result<Vec<DeviceBounds<'py>>, Failure> {
    let assembly = scene.assembly()?;
    let bounds = |(number, placed): (usize, &Placed)| {
        let name = scene.scene().device_name(number);
        let endless = || {
            value_error(format!(
                "{name} (counted from 0) is endless; give it a `length`, and take a box instead of a slab"
            ))
        };
        let hull = &placed.structure.hull;
        let mirror = hull.thin_mirror.as_ref().and_then(Solid::bounds);
        let ends = [hull.bounds(&Pose::IDENTITY), mirror].into_iter().flatten();
        let [low, high] = ends.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]).ok_or_else(endless)?;
        if low.min_element() <= -REACH || high.max_element() >= REACH {
            return Err(endless());
        }
        let ball = mirror.is_none() && matches!(hull.solids[..], [Solid::Ball { .. }]);
        let rotation = placed.pose.rotation();
        let columns =
            [rotation.x_axis, rotation.y_axis, rotation.z_axis, placed.pose.origin / unit];
        let frame = Array2::from_shape_fn((3, 4), |(row, column)| columns[column][row]);
        let [low, high] = [low, high].map(|corner| (corner / unit).to_array());
        Ok((frame.into_pyarray(py), low, high, ball))
    };
    assembly.devices().iter().enumerate().map(bounds).collect()
}

/// The outlines of all devices, in the unit of a world of so many cm.
#[pyfunction]
pub fn outline_meshes<'py>(
    py: Python<'py>,
    scene: &Scene,
    unit: f64,
) -> Result<Vec<Outline<'py>>, Failure> {
    let meshes = outlines(scene.scene(), scene.assembly()?, None)?;
    let mesh = |mesh: cloakroom::outline_mesh::OutlineMesh| {
        let matter = match mesh.matter {
            Matter::Medium => "medium",
            Matter::Metal => "metal",
            Matter::Polarizer => "polarizer",
            Matter::Opaque(_) => "opaque",
        };
        let rows: Vec<f64> =
            mesh.triangles.iter().flatten().flat_map(|at| (*at / unit).to_array()).collect();
        let rows = Array2::from_shape_vec((mesh.triangles.len(), 9), rows)?;
        Ok((mesh.name, matter, rows.into_pyarray(py)))
    };
    meshes.into_iter().map(mesh).collect()
}
