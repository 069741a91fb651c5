//! The grid of rays, and the cells that they come down on.

use super::{Direction, FluxError, Sampling};
use crate::assembly::Assembly;
use crate::device::REACH;
use crate::scene::{Receiver, Scene};
use crate::split_mix::{STEP, mix};
use crate::trace::Launch;
use glam::{DVec2, DVec3};
use optics::wave::transverse_basis;

/// What the grid of rays must cover, and the cells of the receiver.
pub(super) struct Launcher {
    receiver: Receiver,
    /// Corners of what light may meet: of the devices and of the receiver.
    corners: Vec<DVec3>,
    /// Whether the problem is endless along z: then one row of rays, anywhere along z, says all.
    endless: bool,
    /// Cells across and along the receiver.
    pub cells: [usize; 2],
    rays: u32,
}

impl Launcher {
    pub fn new(scene: &Scene, assembly: &Assembly, sampling: Sampling) -> Result<Self, FluxError> {
        let receiver = scene.receiver.clone();
        let endless_along = |device: usize, problem| {
            Err(FluxError::Endless { device: scene.device_name(device), problem })
        };
        let mut corners = Vec::new();
        let mut endless = Vec::new();
        for (device, placed) in assembly.devices().iter().enumerate() {
            let Some([low, high]) = placed.structure.hull.bounds(&placed.pose) else {
                // Nothing in the way.
                endless.push(true);
                continue;
            };
            if !(high - low).truncate().is_finite() {
                return endless_along(
                    device,
                    "its axis, which is not that of z; give it a `length`",
                );
            }
            let is_endless = high.z - low.z > REACH;
            endless.push(is_endless);
            if is_endless && receiver.normal.z != 0.0 {
                return endless_along(
                    device,
                    "z, and the receiver is not along z; give the device a `length`, or the receiver a \
                     normal with z = 0",
                );
            }
            let (low, high) =
                if is_endless { (low.with_z(0.0), high.with_z(0.0)) } else { (low, high) };
            let own = (0..8).map(|k| {
                DVec3::select(glam::BVec3::new(k & 1 > 0, k & 2 > 0, k & 4 > 0), low, high)
            });
            let own: Vec<DVec3> = own.collect();
            let deepest = own.iter().map(|at| (receiver.position - *at).dot(receiver.normal));
            let depth = deepest.fold(f64::NEG_INFINITY, f64::max);
            if depth > 0.0 {
                let device = scene.device_name(device);
                return Err(FluxError::BehindReceiver { device, depth });
            }
            corners.extend(own);
        }
        let all = endless.iter().all(|endless| *endless);
        if !all && let Some(device) = endless.iter().position(|endless| *endless) {
            return endless_along(device, "z and others are not; give it a `length`");
        }
        let [across, along] = receiver.axes();
        for (u, v) in [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)] {
            let v = if all { 0.0 } else { v };
            let corner =
                receiver.position + across * (u * receiver.width) + along * (v * receiver.length);
            corners.push(if all { corner.with_z(0.0) } else { corner });
        }
        let wide = sampling.cells as usize;
        let side = receiver.width / f64::from(sampling.cells);
        let long =
            if all { 1 } else { (receiver.length / side).round().clamp(1.0, 4096.0) as usize };
        Ok(Self { receiver, corners, endless: all, cells: [wide, long], rays: sampling.rays })
    }

    /// The size of the receiver, cm; endless along z: of a piece 1 cm long.
    pub fn size(&self) -> [f64; 2] {
        [self.receiver.width, if self.endless { 1.0 } else { self.receiver.length }]
    }

    /// The cell of the receiver that a ray comes down on.
    pub fn cell(&self, origin: DVec3, direction: DVec3) -> Option<usize> {
        let at = self.receiver.meet(origin, direction)?;
        let [wide, long] = self.cells;
        let index = |at: f64, size: f64, count: usize| {
            let share = at / size + 0.5;
            (0.0..1.0).contains(&share).then(|| ((share * count as f64) as usize).min(count - 1))
        };
        let column = index(at.x, self.receiver.width, wide)?;
        let row = if self.endless { 0 } else { index(at.y, self.receiver.length, long)? };
        Some(row * wide + column)
    }

    /// The grid of rays for light from a direction.
    pub fn field(&self, direction: Direction) -> Field {
        let along = direction.along;
        // Endless along z, the light may be cut anywhere along z: in the plane z = 0, per cm of z.
        let (u, v, axis) = if self.endless {
            let flat = along.truncate().normalize_or(DVec2::X);
            (flat.perp().extend(0.0), DVec3::ZERO, flat.extend(0.0))
        } else {
            let (u, v) = transverse_basis(along, DVec3::Z, DVec3::X);
            (u, v, along)
        };
        let range = |axis: DVec3| {
            let at = || self.corners.iter().map(|corner| corner.dot(axis));
            [at().fold(f64::INFINITY, f64::min), at().fold(f64::NEG_INFINITY, f64::max)]
        };
        let (u_range, v_range) = (range(u), range(v));
        let size = [u_range[1] - u_range[0], v_range[1] - v_range[0]];
        let counts = if self.endless {
            [self.rays, 1]
        } else {
            // Cells about as long as wide.
            let rays = f64::from(self.rays);
            let columns = (rays * size[0] / size[1]).sqrt().ceil().clamp(1.0, rays);
            [columns as u32, (rays / columns).ceil() as u32]
        };
        // Far enough before everything.
        let back = range(axis)[0] - 1.0;
        // Of the light on the receiver if nothing is there but it, and it lies across the light.
        let [width, length] = self.size();
        let area = if self.endless {
            // A row of rays carries what falls on 1 cm of z.
            size[0] * along.truncate().length()
        } else {
            size[0] * size[1]
        };
        let share = area / f64::from(counts[0]) / f64::from(counts[1]) / (width * length);
        let (horizontal, vertical) = transverse_basis(along, DVec3::Z, DVec3::X);
        Field {
            corner: u * u_range[0] + v * v_range[0] + axis * back,
            u: u * size[0],
            v: v * size[1],
            along,
            electric: [horizontal, vertical],
            counts,
            share,
        }
    }
}

/// The rays of one direction.
pub(super) struct Field {
    corner: DVec3,
    u: DVec3,
    v: DVec3,
    along: DVec3,
    electric: [DVec3; 2],
    counts: [u32; 2],
    /// The irradiance on the whole receiver that a ray stands for, that across the light being 1.
    pub share: f64,
}

impl Field {
    pub fn count(&self) -> u32 {
        self.counts[0] * self.counts[1]
    }

    /// A ray: anywhere in its cell of the grid.
    pub fn launch(&self, sample: u32, number: u32, seed: u64) -> Launch<2> {
        let [columns, rows] = self.counts;
        let (column, row) = (number % columns, number / columns);
        let shift = jitter(seed, sample, number);
        let share = DVec2::new(
            (f64::from(column) + shift.x) / f64::from(columns),
            (f64::from(row) + shift.y) / f64::from(rows),
        );
        Launch {
            origin: self.corner + self.u * share.x + self.v * share.y,
            direction: self.along,
            electric: self.electric.map(Into::into),
        }
    }
}

/// Two numbers from 0 to 1 that depend on a ray alone.
fn jitter(seed: u64, sample: u32, number: u32) -> DVec2 {
    let state = seed ^ (u64::from(sample) << 32 | u64::from(number));
    // Not the first number: rays side by side begin side by side.
    let nth = |n: u64| (mix(state.wrapping_add(STEP.wrapping_mul(n))) >> 11) as f64;
    DVec2::new(nth(1), nth(2)) / (1u64 << 53) as f64
}
