//! Regular grids of cells around a device.

use super::MaterialError;
use crate::assembly::Placed;
use crate::device::REACH;
use crate::output::Grid;
use glam::DVec3;
use optics::geometry::Pose;

/// Along which axes a grid lies, and its tensors' components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Frame {
    /// The device's own: its axis is z, and it is not turned.
    #[default]
    Device,
    /// The scene's.
    World,
}

/// How fine a grid is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// So many cells along x, y and z.
    Cells([u32; 3]),
    /// Cubic cells of that side, cm.
    Spacing(f64),
    /// Cubic cells, 64 along the longest side.
    Default,
}

/// Cells along the longest side where nothing is asked for.
const DEFAULT_CELLS: f64 = 64.0;

/// More cells than this along an axis are no grid.
const MOST_CELLS: f64 = 1e9;

impl Grid {
    /// The grid around a device with its hidden region. Along an axis on which the device has no
    /// end its cells are centred on the device's origin: a single layer, unless more are asked for.
    ///
    /// # Errors
    ///
    /// If it would have no cells, or far too many.
    pub fn around(
        placed: &Placed,
        frame: Frame,
        resolution: Resolution,
    ) -> Result<Self, MaterialError> {
        let pose = match frame {
            Frame::Device => Pose::new(DVec3::ZERO, 0.0),
            Frame::World => placed.pose,
        };
        let bounds = placed.structure.hull.bounds(&pose);
        let [low, high] = bounds.ok_or(MaterialError::Endless)?;
        let size = high - low;
        let has_ends = |axis: usize| size[axis] < REACH;
        let longest = (0..3).filter(|axis| has_ends(*axis)).map(|axis| size[axis]);
        let longest = longest.reduce(f64::max).ok_or(MaterialError::Endless)?;
        let default = longest / DEFAULT_CELLS;
        let side = if let Resolution::Spacing(side) = resolution { side } else { default };
        let (spacing, cells) = match resolution {
            Resolution::Cells(cells) if cells.contains(&0) => return Err(MaterialError::EmptyGrid),
            Resolution::Cells(cells) => {
                let side = |axis: usize| size[axis] / f64::from(cells[axis]);
                let sides = (0..3).filter(|axis| has_ends(*axis)).map(side);
                let least = sides.reduce(f64::min).unwrap_or(longest);
                let spacing = [0, 1, 2].map(|axis| if has_ends(axis) { side(axis) } else { least });
                (DVec3::from(spacing), cells.map(f64::from))
            }
            _ if !(side > 0.0 && side.is_finite()) => return Err(MaterialError::EmptyGrid),
            Resolution::Spacing(_) | Resolution::Default => {
                // A side that divides the size but for rounding does.
                let count = |axis: usize| (size[axis] / side - 1e-9).ceil().max(1.0);
                let cells = [0, 1, 2].map(|axis| if has_ends(axis) { count(axis) } else { 1.0 });
                (DVec3::splat(side), cells)
            }
        };
        check_memory(cells)?;
        let middle = [0, 1, 2].map(|axis| {
            if has_ends(axis) { 0.5 * (low[axis] + high[axis]) } else { pose.origin[axis] }
        });
        let corner = DVec3::from(middle) - spacing * DVec3::from(cells) * 0.5;
        Ok(Self { corner, spacing, cells: cells.map(|count| count as usize) })
    }
}

/// Refuses a grid that would not fit into the memory that is free now.
fn check_memory(cells: [f64; 3]) -> Result<(), MaterialError> {
    /// A code, an index and two tensors with their imaginary parts: as they are sampled, and in
    /// arrays.
    const BYTES: f64 = 2.0 * 8.0 * (2.0 + 4.0 * 6.0);
    let needed = cells.iter().product::<f64>() * BYTES;
    if needed >= u64::MAX as f64 {
        return Err(MaterialError::TooFine);
    }
    let is_countable = cells.iter().all(|count| *count <= MOST_CELLS);
    let most = if is_countable { f64::INFINITY } else { MOST_CELLS * BYTES };
    crate::memory::check(needed as u64, most as u64).map_err(|shortage| MaterialError::TooLarge {
        cells: cells.map(|count| count as u64),
        shortage,
    })
}
