//! What a device is made of, for fabrication and for full-wave solvers: the index and the tensors
//! on a regular grid, and the homogeneous segments as a table. The media are those that the tracer
//! meets.

mod grid;
mod sampling;
mod segments;

pub use grid::{Frame, Resolution};
pub use sampling::{CellContent, SymmetricTensor, sample};
pub use segments::{Segment, segments, write_segments};

use crate::assembly::{Assembly, Placed};
use crate::device::Show;
use crate::memory::Shortage;
use crate::scene::{DeviceName, NoDevice, Scene};
use crate::trace::Stopped;

/// Why the material of a device cannot be given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// There is no device of that number.
    #[error(transparent)]
    NoDevice(#[from] NoDevice),
    /// It is not said which of these devices.
    #[error(
        "the scene has {} devices; say which `device` is meant, by its number or name: {}", .0.len(),
        .0.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
    )]
    WhichDevice(Vec<DeviceName>),
    /// The device has no medium in it, or no homogeneous segments.
    #[error("{device}, {kind}, {problem}")]
    Unsuitable {
        /// Which device.
        device: DeviceName,
        /// Its kind.
        kind: &'static str,
        /// What it is instead, and hence has not.
        problem: &'static str,
    },
    /// The grid has no cells.
    #[error("a grid needs a positive spacing, and at least one cell along each axis")]
    EmptyGrid,
    /// The grid has too many cells.
    #[error(
        "a grid of {} x {} x {} cells {shortage}; take fewer", cells[0], cells[1], cells[2]
    )]
    TooLarge {
        /// Cells along x, y and z.
        cells: [u64; 3],
        /// The memory needed and there.
        shortage: Shortage,
    },
    /// The grid has more cells than there is a number for their bytes.
    #[error("so fine a grid is too large for any memory; take fewer cells, or a larger spacing")]
    TooFine,
    /// The device has no end in the plane, so no grid fits around it.
    #[error("the device is endless along every axis of the grid; take the device's frame")]
    Endless,
    /// The work was stopped from outside.
    #[error("stopped")]
    Stopped(#[from] Stopped),
}

/// The device that is meant, if there is a medium in it: that of the number, or the only one there
/// is.
fn chosen<'a>(
    scene: &Scene,
    assembly: &'a Assembly,
    device: Option<usize>,
) -> Result<(usize, &'a Placed), MaterialError> {
    let count = assembly.devices().len();
    let device = match device {
        Some(device) => device,
        None if count > 1 => {
            let names = (0..count).map(|number| scene.device_name(number));
            return Err(MaterialError::WhichDevice(names.collect()));
        }
        None => 0,
    };
    let none = NoDevice { device, count };
    let placed = assembly.devices().get(device).ok_or(none)?;
    let settings = &scene.devices[device];
    let problem = match settings.placement.show {
        Show::Bare => "is shown as bare metal: it has no material",
        Show::Mirror => "is shown as the mirror it imitates: it has no material",
        Show::Empty => "is not shown (show = \"empty\"): it has no material",
        Show::Cloak if placed.structure.is_opaque() => "is opaque: it has no material",
        Show::Cloak if placed.structure.polarizes() => "is an ideal sheet: it has no material",
        Show::Cloak if placed.structure.regions.is_empty() => {
            "is made of metal alone: it has no material"
        }
        Show::Cloak => return Ok((device, placed)),
    };
    let kind = settings.kind();
    Err(MaterialError::Unsuitable { device: scene.device_name(device), kind, problem })
}
