//! Devices for renderers of others: rays in, one leaf of each out.

use crate::errors::{Failure, value_error};
use crate::scenes::Scene;
use crate::supervision::{at_once, supervised};
use cloakroom::assembly::Placed;
use cloakroom::outline_mesh::{Matter, outlines};
use cloakroom::render::Supervision;
use cloakroom::trace::{
    Launch, Limits, Placement, RayStatus, ScatterRay, Scattered, scatter_batches,
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
        let every = rays.draws.is_none();
        let traced = |supervision: &Supervision<'_>| -> Result<Vec<Columns<T>>, Failure> {
            let (done, stop) = (supervision.rows_done, supervision.stop);
            let ray = |number: usize| rays.ray(number);
            let kept = |rows: Vec<Scattered>| Columns::of(&rows, every, *want_fields);
            let assembly = scene.assembly()?;
            Ok(scatter_batches(assembly, *limits, placement, count, &ray, &kept, done, stop)?)
        };
        let batches = if count <= FEW && scene.is_built() {
            at_once(*py, traced)?
        } else {
            supervised(*py, None, |_, supervision| traced(supervision))?
        };
        arrays(*py, &batches, every, *want_fields)
    }
}

/// The rows of a batch, by columns, of which there are fewer bytes.
struct Columns<T> {
    /// The numbers of the rays, unless each has one row.
    ray: Vec<u32>,
    status: Vec<u8>,
    straight: Vec<bool>,
    position: Vec<T>,
    direction: Vec<T>,
    weight: Vec<T>,
    probability: Vec<T>,
    transmitted: Vec<T>,
    pruned: Vec<T>,
    optical_path: Vec<T>,
    path: Vec<u64>,
    body: Vec<i32>,
    /// The components of the fields, if they are wanted.
    fields: Vec<Complex<f64>>,
}

impl<T: Real> Columns<T> {
    fn of(rows: &[Scattered], every: bool, want_fields: bool) -> Self {
        fn room<C>(count: usize) -> Vec<C> {
            Vec::with_capacity(count)
        }
        let count = rows.len();
        let mut columns = Self {
            ray: room(if every { count } else { 0 }),
            status: room(count),
            straight: room(count),
            position: room(3 * count),
            direction: room(3 * count),
            weight: room(count),
            probability: room(count),
            transmitted: room(count),
            pruned: room(count),
            optical_path: room(count),
            path: room(count),
            body: room(count),
            fields: room(if want_fields { 6 * count } else { 0 }),
        };
        // Row by row: a row is longer than a line of the processor's memory.
        for row in rows {
            columns.push(row, every, want_fields);
        }
        columns
    }

    #[inline]
    fn push(&mut self, row: &Scattered, every: bool, want_fields: bool) {
        if every {
            self.ray.push(row.ray);
        }
        self.status.push(row.status as u8);
        self.straight.push(row.straight);
        self.position.extend_from_slice(&row.position.to_array().map(T::of));
        self.direction.extend_from_slice(&row.direction.to_array().map(T::of));
        self.weight.push(T::of(row.weight));
        self.probability.push(T::of(row.probability));
        self.transmitted.push(T::of(row.transmitted));
        self.pruned.push(T::of(row.pruned));
        self.optical_path.push(T::of(row.optical_path));
        self.path.push(row.path);
        self.body.push(if row.status == RayStatus::Ended { i32::from(row.body) } else { -1 });
        if want_fields {
            self.fields.extend(row.electric.iter().flat_map(|field| field.components()));
        }
    }
}

fn arrays<'py, T: Real>(
    py: Python<'py>,
    batches: &[Columns<T>],
    every: bool,
    want_fields: bool,
) -> Result<Bound<'py, PyDict>, Failure> {
    fn whole<T, C: Clone>(batches: &[Columns<T>], of: fn(&Columns<T>) -> &[C]) -> Vec<C> {
        batches.iter().map(of).collect::<Vec<_>>().concat()
    }
    let arrays = PyDict::new(py);
    let numbers = |name: &str, of: fn(&Columns<T>) -> &[T]| {
        arrays.set_item(name, whole(batches, of).into_pyarray(py))
    };
    let vectors = |name: &str, of: fn(&Columns<T>) -> &[T]| -> Result<(), Failure> {
        let flat = whole(batches, of);
        let rows = Array2::from_shape_vec((flat.len() / 3, 3), flat)?;
        Ok(arrays.set_item(name, rows.into_pyarray(py))?)
    };
    if every {
        arrays.set_item("ray", whole(batches, |rows| &rows.ray).into_pyarray(py))?;
    }
    arrays.set_item("status", whole(batches, |rows| &rows.status).into_pyarray(py))?;
    arrays.set_item("straight", whole(batches, |rows| &rows.straight).into_pyarray(py))?;
    vectors("position", |rows| &rows.position)?;
    vectors("direction", |rows| &rows.direction)?;
    numbers("weight", |rows| &rows.weight)?;
    numbers("probability", |rows| &rows.probability)?;
    numbers("transmitted", |rows| &rows.transmitted)?;
    numbers("pruned", |rows| &rows.pruned)?;
    numbers("optical_path", |rows| &rows.optical_path)?;
    arrays.set_item("path", whole(batches, |rows| &rows.path).into_pyarray(py))?;
    arrays.set_item("body", whole(batches, |rows| &rows.body).into_pyarray(py))?;
    if want_fields {
        let fields = whole(batches, |rows| &rows.fields);
        let fields = ndarray::Array3::from_shape_vec((fields.len() / 6, 2, 3), fields)?;
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
