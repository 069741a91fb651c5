//! Devices for renderers of others: rays in, one leaf of each out.

use crate::errors::{Failure, value_error};
use crate::scenes::Scene;
use crate::supervision::{at_once, supervised};
use cloakroom::assembly::Placed;
use cloakroom::outline_mesh::{Matter, outlines};
use cloakroom::render::Supervision;
use cloakroom::trace::{
    self, Launch, Limits, Placement, RayStatus, ScatterRay, Scattered, batches, scatter_batches,
};
use glam::{DMat3, DVec3};
use ndarray::{Array2, Array3, ArrayView1, ArrayView2, ArrayView3, Axis};
use num_complex::Complex;
use numpy::{Element, IntoPyArray, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use optics::geometry::{Pose, REACH, Solid};
use optics::wave::{ComplexVector, transverse_basis, unit};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::Range;

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
        let origin = vector(&self.origins, number);
        // What is no direction is refused later.
        let direction = unit(vector(&self.directions, number)).unwrap_or_default();
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

/// A row of three numbers.
fn vector<T: Real>(array: &ArrayView2<'_, T>, number: usize) -> DVec3 {
    let row = array.row(number);
    match row.to_slice() {
        Some(&[x, y, z]) => DVec3::new(x.get(), y.get(), z.get()),
        _ => DVec3::from_array(std::array::from_fn(|axis| row[axis].get())),
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
        let traced = |supervision: &Supervision<'_>| -> Result<Columns<T>, Failure> {
            let (done, stop) = (supervision.rows_done, supervision.stop);
            let ray = |number: usize| rays.ray(number);
            let assembly = scene.assembly()?;
            if every {
                let rows = trace::scatter(assembly, *limits, placement, count, &ray, done, stop)?;
                let mut columns = Columns::new(rows.len(), true, *want_fields);
                columns.rows().fill(&rows);
                return Ok(columns);
            }
            // Each ray has a row, so its place is known.
            let mut columns = Columns::new(count, false, *want_fields);
            let mut rows = columns.rows();
            let keep = |part: &mut Rows<'_, T>, rows: Vec<Scattered>| part.fill(&rows);
            let part = |rays: Range<usize>| (rays.clone(), rows.take(rays.len()));
            let parts = batches(count).into_iter().map(part).collect();
            scatter_batches(assembly, *limits, placement, parts, &ray, &keep, done, stop)?;
            Ok(columns)
        };
        let columns = if count <= FEW && scene.is_built() {
            at_once(*py, traced)?
        } else {
            supervised(*py, None, |_, supervision| traced(supervision))?
        };
        columns.into_arrays(*py, every, *want_fields)
    }
}

/// The arrays of what became of rays.
struct Columns<T> {
    /// The numbers of the rays, unless each has one row.
    ray: Vec<u32>,
    status: Vec<u8>,
    straight: Vec<bool>,
    position: Vec<[T; 3]>,
    direction: Vec<[T; 3]>,
    weight: Vec<T>,
    probability: Vec<T>,
    transmitted: Vec<T>,
    pruned: Vec<T>,
    optical_path: Vec<T>,
    path: Vec<u64>,
    body: Vec<i32>,
    /// The fields, if they are wanted.
    electric_field: Vec<[[Complex<f64>; 3]; 2]>,
}

impl<T: Real> Columns<T> {
    /// Zeros, which cost nothing before they are written.
    fn new(rows: usize, every: bool, want_fields: bool) -> Self {
        let numbers = || vec![T::of(0.0); rows];
        let vectors = || vec![[T::of(0.0); 3]; rows];
        let fields = if want_fields { rows } else { 0 };
        Self {
            ray: vec![0; if every { rows } else { 0 }],
            status: vec![0; rows],
            straight: vec![false; rows],
            position: vectors(),
            direction: vectors(),
            weight: numbers(),
            probability: numbers(),
            transmitted: numbers(),
            pruned: numbers(),
            optical_path: numbers(),
            path: vec![0; rows],
            body: vec![0; rows],
            electric_field: vec![Default::default(); fields],
        }
    }

    fn rows(&mut self) -> Rows<'_, T> {
        Rows {
            ray: &mut self.ray,
            status: &mut self.status,
            straight: &mut self.straight,
            position: &mut self.position,
            direction: &mut self.direction,
            weight: &mut self.weight,
            probability: &mut self.probability,
            transmitted: &mut self.transmitted,
            pruned: &mut self.pruned,
            optical_path: &mut self.optical_path,
            path: &mut self.path,
            body: &mut self.body,
            electric_field: &mut self.electric_field,
        }
    }

    fn into_arrays(
        self,
        py: Python<'_>,
        every: bool,
        want_fields: bool,
    ) -> Result<Bound<'_, PyDict>, Failure> {
        let (rows, arrays) = (self.status.len(), PyDict::new(py));
        let numbers = |name: &str, of: Vec<T>| arrays.set_item(name, of.into_pyarray(py));
        let vectors = |name: &str, of: Vec<[T; 3]>| -> Result<(), Failure> {
            let of = Array2::from_shape_vec((rows, 3), of.into_flattened())?;
            Ok(arrays.set_item(name, of.into_pyarray(py))?)
        };
        if every {
            arrays.set_item("ray", self.ray.into_pyarray(py))?;
        }
        arrays.set_item("status", self.status.into_pyarray(py))?;
        arrays.set_item("straight", self.straight.into_pyarray(py))?;
        vectors("position", self.position)?;
        vectors("direction", self.direction)?;
        numbers("weight", self.weight)?;
        numbers("probability", self.probability)?;
        numbers("transmitted", self.transmitted)?;
        numbers("pruned", self.pruned)?;
        numbers("optical_path", self.optical_path)?;
        arrays.set_item("path", self.path.into_pyarray(py))?;
        arrays.set_item("body", self.body.into_pyarray(py))?;
        if want_fields {
            let flat = self.electric_field.into_flattened().into_flattened();
            let fields = Array3::from_shape_vec((rows, 2, 3), flat)?;
            arrays.set_item("electric_field", fields.into_pyarray(py))?;
        }
        Ok(arrays)
    }
}

/// Successive rows of [`Columns`].
struct Rows<'a, T> {
    ray: &'a mut [u32],
    status: &'a mut [u8],
    straight: &'a mut [bool],
    position: &'a mut [[T; 3]],
    direction: &'a mut [[T; 3]],
    weight: &'a mut [T],
    probability: &'a mut [T],
    transmitted: &'a mut [T],
    pruned: &'a mut [T],
    optical_path: &'a mut [T],
    path: &'a mut [u64],
    body: &'a mut [i32],
    electric_field: &'a mut [[[Complex<f64>; 3]; 2]],
}

impl<'a, T: Real> Rows<'a, T> {
    /// Takes off the first of them; of columns that are left out, none.
    fn take(&mut self, rows: usize) -> Self {
        fn first<'a, C>(column: &mut &'a mut [C], rows: usize) -> &'a mut [C] {
            column.split_off_mut(..rows.min(column.len())).unwrap_or_default()
        }
        Self {
            ray: first(&mut self.ray, rows),
            status: first(&mut self.status, rows),
            straight: first(&mut self.straight, rows),
            position: first(&mut self.position, rows),
            direction: first(&mut self.direction, rows),
            weight: first(&mut self.weight, rows),
            probability: first(&mut self.probability, rows),
            transmitted: first(&mut self.transmitted, rows),
            pruned: first(&mut self.pruned, rows),
            optical_path: first(&mut self.optical_path, rows),
            path: first(&mut self.path, rows),
            body: first(&mut self.body, rows),
            electric_field: first(&mut self.electric_field, rows),
        }
    }

    fn fill(&mut self, rows: &[Scattered]) {
        // Row by row: a row is longer than a line of the processor's memory.
        for (i, row) in rows.iter().enumerate() {
            if let Some(ray) = self.ray.get_mut(i) {
                *ray = row.ray;
            }
            self.status[i] = row.status as u8;
            self.straight[i] = row.straight;
            self.position[i] = row.position.to_array().map(T::of);
            self.direction[i] = row.direction.to_array().map(T::of);
            self.weight[i] = T::of(row.weight);
            self.probability[i] = T::of(row.probability);
            self.transmitted[i] = T::of(row.transmitted);
            self.pruned[i] = T::of(row.pruned);
            self.optical_path[i] = T::of(row.optical_path);
            self.path[i] = row.path;
            self.body[i] = if row.status == RayStatus::Ended { i32::from(row.body) } else { -1 };
            if let Some(fields) = self.electric_field.get_mut(i) {
                *fields = row.electric.map(|field| field.components());
            }
        }
    }
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
