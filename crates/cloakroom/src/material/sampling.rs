//! The material of a device on a grid.

use super::{Frame, MaterialError, Resolution, chosen};
use crate::assembly::{Assembly, Placed};
use crate::device::MaterialAt;
use crate::output::{Grid, GridArray, GridFile, GridValues};
use crate::render::{Supervision, metadata};
use crate::scene::Scene;
use crate::trace::Stopped;
use glam::DMat3;
use optics::medium::Tensor;
use rayon::prelude::*;
use std::sync::atomic::Ordering;

/// What is in a cell of a grid: its code in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum CellContent {
    /// Air outside of the device.
    Air = 0,
    /// The device's material.
    Material = 1,
    /// Metal.
    Metal = 2,
    /// Air in the hidden region of an open core.
    Hidden = 3,
}

impl CellContent {
    /// The words for the codes, in their order.
    pub const WORDS: [&'static str; 4] = ["air", "material", "metal", "hidden"];
}

/// A symmetric tensor: xx, yy, zz, xy, yz, xz.
pub type SymmetricTensor = [f64; 6];

/// One cell.
#[derive(Clone, Copy)]
struct Point {
    region: CellContent,
    index: f64,
    /// Permittivity and permeability.
    real: [SymmetricTensor; 2],
    imaginary: [SymmetricTensor; 2],
}

/// The material of a device on a grid: arrays `region` (see [`CellContent`]), `index` (of an
/// anisotropic medium the geometric mean, [`optics::medium::Medium::mean_index`]), `permittivity`
/// and `permeability`, and where the device absorbs `permittivity_imaginary` and
/// `permeability_imaginary`. Metal has no numbers: NaN.
///
/// `device` may be left out if there is only one. `begun` is told how many rows there are to do.
///
/// # Errors
///
/// If there is no such device, it has no material, or the grid is empty or too large; and if the
/// work was stopped.
pub fn sample(
    scene: &Scene,
    assembly: &Assembly,
    device: Option<usize>,
    frame: Frame,
    resolution: Resolution,
    begun: &dyn Fn(u64),
    supervision: &Supervision<'_>,
) -> Result<GridFile, MaterialError> {
    let (device, placed) = chosen(scene, assembly, device)?;
    let grid = Grid::around(placed, frame, resolution)?;
    let row = grid.cells[0];
    let rows = grid.count() / row;
    begun(rows as u64);
    let points: Vec<Vec<Point>> = (0..rows)
        .into_par_iter()
        .map(|number| {
            if supervision.stop.load(Ordering::Relaxed) {
                return Err(MaterialError::from(Stopped));
            }
            let cells = number * row..(number + 1) * row;
            let points = cells.map(|cell| point(placed, frame, grid.middle(cell))).collect();
            (supervision.rows_done)(1);
            Ok(points)
        })
        .collect::<Result<_, _>>()?;
    let points: Vec<Point> = points.into_iter().flatten().collect();
    Ok(GridFile { grid, arrays: arrays(&points), metadata: described(scene, device, frame) })
}

fn point(placed: &Placed, frame: Frame, at: glam::DVec3) -> Point {
    let is_world = frame == Frame::World;
    let local = if is_world { placed.pose.to_local(at) } else { at };
    let empty = |region, value: f64| Point {
        region,
        index: value,
        real: [[value, value, value, value - 1.0, value - 1.0, value - 1.0]; 2],
        imaginary: [[0.0 * value; 6]; 2],
    };
    let medium = match placed.structure.material_at(local) {
        MaterialAt::Air => return empty(CellContent::Air, 1.0),
        MaterialAt::HiddenAir => return empty(CellContent::Hidden, 1.0),
        MaterialAt::Metal | MaterialAt::Opaque => return empty(CellContent::Metal, f64::NAN),
        MaterialAt::Medium(medium) => medium,
    };
    let (permittivity, permeability) = medium.tensors();
    let turned = |tensor: Tensor| tensor.turned(&placed.pose.rotation());
    let tensors = [permittivity, permeability];
    let tensors = if is_world { tensors.map(turned) } else { tensors };
    let six = |m: &DMat3| [m.x_axis.x, m.y_axis.y, m.z_axis.z, m.x_axis.y, m.y_axis.z, m.x_axis.z];
    Point {
        region: CellContent::Material,
        index: medium.mean_index(),
        real: tensors.map(|Tensor { re, .. }| six(&re)),
        imaginary: tensors.map(|Tensor { im, .. }| six(&im)),
    }
}

fn arrays(points: &[Point]) -> Vec<GridArray> {
    let array = |name: &'static str, values: GridValues| GridArray { name, values };
    let tensors = |of: &dyn Fn(&Point) -> SymmetricTensor| {
        GridValues::SymmetricTensors(points.iter().map(of).collect())
    };
    let regions = points.iter().map(|point| point.region as u8).collect();
    let mut arrays = vec![
        array("region", GridValues::Codes(regions, &CellContent::WORDS)),
        array("index", GridValues::Numbers(points.iter().map(|point| point.index).collect())),
        array("permittivity", tensors(&|point| point.real[0])),
        array("permeability", tensors(&|point| point.real[1])),
    ];
    let absorbs = |point: &Point| point.imaginary.iter().flatten().any(|entry| *entry > 0.0);
    if points.iter().any(absorbs) {
        arrays.push(array("permittivity_imaginary", tensors(&|point| point.imaginary[0])));
        arrays.push(array("permeability_imaginary", tensors(&|point| point.imaginary[1])));
    }
    arrays
}

/// What the numbers are, for files.
fn described(scene: &Scene, device: usize, frame: Frame) -> Vec<(String, String)> {
    let frame = if frame == Frame::World { "world" } else { "device" };
    let codes: Vec<String> =
        (0..).zip(CellContent::WORDS).map(|(i, word)| format!("{i} {word}")).collect();
    let own = [
        ("device", device.to_string()),
        ("frame", frame.to_owned()),
        ("length_unit", "cm".to_owned()),
        ("region", codes.join(", ")),
    ];
    let own = own.map(|(key, text)| (key.to_owned(), text));
    metadata(scene).into_iter().chain(own).collect()
}
