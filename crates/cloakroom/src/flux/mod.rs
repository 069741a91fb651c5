//! How much light comes through to a plane behind the devices: for nothing, for bare metal and for
//! the cloak.
//!
//! Parallel light of unit irradiance across its direction is traced forward, from a stratified grid
//! of rays. Where all devices are endless along z, so is the problem: one row of rays is enough.

mod directions;
mod files;
mod launch;
mod result;

pub use directions::{Direction, across_range, sun_day};
pub use files::{Arrays, flux_arrays, flux_csv, write_flux_npz};
pub use result::{Convergence, FluxReport, Gain, Incidence, STANDS, Stand, Total};

use crate::assembly::Assembly;
use crate::measure;
use crate::render::{PreparedSceneError, Supervision, assembly, limits, metadata};
use crate::scene::{DeviceName, Scene};
use crate::trace::{Stopped, Tracer};
use launch::Launcher;
use rayon::prelude::*;
use result::Tally;
use std::sync::atomic::Ordering;

/// How the light is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Rays of each of the independent samples that the errors come from.
    pub rays: u32,
    /// How many such samples there are, 2 at least.
    pub samples: u32,
    /// Cells of the map across the receiver.
    pub cells: u32,
}

/// Why no flux can be given.
#[derive(Debug, thiserror::Error)]
pub enum FluxError {
    /// The scene is impossible.
    #[error(transparent)]
    Scene(#[from] PreparedSceneError),
    /// There is nothing in the way of the light.
    #[error("the scene has no device; there is nothing to compare")]
    NoDevice,
    /// The receiver is not behind all devices.
    #[error(
        "{device} (counted from 0) reaches {depth:.4} cm through the plane of the receiver or behind it; \
         all devices must stand in front of it, on the side of its normal: move `receiver.position`"
    )]
    BehindReceiver {
        /// Which device.
        device: DeviceName,
        /// How far it reaches through, cm.
        depth: f64,
    },
    /// A device without an end is across the receiver, not upright, or beside one that has ends.
    #[error("{device} (counted from 0) is endless along {problem}")]
    Endless {
        /// Which device.
        device: DeviceName,
        /// Along what, what is wrong with that, and the mend.
        problem: &'static str,
    },
    /// There are no directions of the light.
    #[error("there is no direction that light comes to the receiver from")]
    NoDirection,
    /// A direction does not come from the front, at this angle to the normal, degrees.
    #[error(
        "light at {0} degrees to the normal does not come from the front of the receiver; it must be less than 90"
    )]
    FromBehind(f64),
    /// A number makes no sense.
    #[error("{name} is {value}; it must be from {low} to {high}")]
    Setting {
        /// What it is the number of.
        name: &'static str,
        /// The number.
        value: u32,
        /// The least that is allowed.
        low: u32,
        /// The most that is allowed.
        high: u32,
    },
    /// The work was stopped from outside.
    #[error("stopped")]
    Stopped(#[from] Stopped),
}

/// The flux that comes to the scene's receiver, for light from each of the directions.
///
/// `begun` is told how many steps there are.
///
/// # Errors
///
/// If the scene, the receiver or a setting is impossible, or the work was stopped.
pub fn flux(
    scene: &Scene,
    directions: &[Direction],
    sampling: Sampling,
    begun: &dyn Fn(u64),
    supervision: &Supervision<'_>,
) -> Result<FluxReport, FluxError> {
    for (name, value, low, high) in [
        ("the number of rays", sampling.rays, 16, 100_000_000),
        ("the number of samples", sampling.samples, 2, 1024),
        ("the number of cells", sampling.cells, 1, 4096),
    ] {
        if !(low..=high).contains(&value) {
            return Err(FluxError::Setting { name, value, low, high });
        }
    }
    if directions.is_empty() {
        return Err(FluxError::NoDirection);
    }
    if scene.devices.is_empty() {
        return Err(FluxError::NoDevice);
    }
    for direction in directions {
        let degrees = direction.incidence(&scene.receiver);
        if degrees.is_nan() || degrees >= 90.0 {
            return Err(FluxError::FromBehind(degrees));
        }
    }
    let cloaked = assembly(scene)?;
    let launcher = Launcher::new(scene, &cloaked, sampling)?;
    let bare = measure::bare(scene).map_or_else(|| Ok(cloaked.clone()), |bare| assembly(&bare))?;
    // In the order of `STANDS`.
    let assemblies = [assembly(&measure::empty(scene))?, bare, cloaked];
    begun((directions.len() * STANDS.len()) as u64);
    let mut incidences = Vec::new();
    for direction in directions {
        let mut tallies = Vec::new();
        for assembly in &assemblies {
            tallies.push(tally(scene, assembly, &launcher, *direction, sampling, supervision)?);
            (supervision.rows_done)(1);
        }
        let field = launcher.field(*direction);
        let rays = (field.count(), field.share);
        incidences.push(Incidence::new(
            *direction,
            direction.incidence(&scene.receiver),
            &tallies,
            rays,
        ));
    }
    Ok(FluxReport {
        cells: launcher.cells,
        size: launcher.size(),
        incidences,
        metadata: metadata(scene),
    })
}

/// Traces all samples of one direction.
fn tally(
    scene: &Scene,
    assembly: &Assembly,
    launcher: &Launcher,
    direction: Direction,
    sampling: Sampling,
    supervision: &Supervision<'_>,
) -> Result<Vec<Tally>, FluxError> {
    let limits = limits(scene);
    let field = launcher.field(direction);
    (0..sampling.samples)
        .into_par_iter()
        .map(|sample| {
            let mut tracer = Tracer::<2>::new(assembly, limits);
            let mut tally = Tally::new(launcher.cells);
            for number in 0..field.count() {
                if number % 256 == 0 && supervision.stop.load(Ordering::Relaxed) {
                    return Err(Stopped.into());
                }
                let launch = field.launch(sample, number, scene.camera.seed);
                let (leaves, outcome) = tracer.trace(&launch);
                tally.stats += outcome.stats;
                for leaf in leaves.iter().filter(|leaf| leaf.body().is_none()) {
                    if let Some(cell) = launcher.cell(leaf.position, leaf.direction) {
                        tally.add(cell, leaf.power.map(|power| power * field.share));
                    }
                }
            }
            Ok(tally)
        })
        .collect()
}

#[cfg(test)]
mod tests;
