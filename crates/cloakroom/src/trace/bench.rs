//! The optical bench: all devices of a scene at their places.

use super::bodies::Bodies;
use crate::device::{SkinHit, Structure};
use glam::DVec3;
use optics::geometry::{Pose, Solid};

/// A device at its place.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Where it stands and how it is turned.
    pub pose: Pose,
    /// What it is made of.
    pub structure: Structure,
}

impl Placed {
    /// Whether a point of the world lies inside the device.
    #[must_use]
    pub fn holds(&self, point: DVec3) -> bool {
        self.structure.hull.holds(self.pose.to_local(point))
    }

    /// The space that the device takes up in the world.
    #[must_use]
    pub fn solids(&self) -> Vec<Solid> {
        self.structure.hull.solids().iter().map(|solid| solid.placed(&self.pose)).collect()
    }
}

/// All devices of a scene.
#[derive(Clone, Debug)]
pub struct Bench {
    devices: Vec<Placed>,
    bodies: Bodies,
    vacuum_wave_number: f64,
}

impl Default for Bench {
    fn default() -> Self {
        Self::new(Vec::new())
    }
}

/// How deep two devices may press into each other before they count as overlapping, cm.
pub(super) const TOUCHING: f64 = 1e-9;

impl Bench {
    /// The bench with the given devices, which must not overlap: see [`Bench::overlap`].
    #[must_use]
    pub fn new(devices: Vec<Placed>) -> Self {
        let bodies = Bodies::of(&devices);
        Self { devices, bodies, vacuum_wave_number: 0.0 }.with_wavelength(550.0)
    }

    /// The same bench in light of another wavelength (in vacuum, nm) than 550 nm. Only absorption depends
    /// on it: media are given for it.
    #[must_use]
    pub fn with_wavelength(self, wavelength_nm: f64) -> Self {
        const CM_PER_NM: f64 = 1e-7;
        let vacuum_wave_number = std::f64::consts::TAU / (wavelength_nm * CM_PER_NM);
        Self { vacuum_wave_number, ..self }
    }

    /// k0, the wave number in vacuum, 1/cm.
    #[must_use]
    pub fn vacuum_wave_number(&self) -> f64 {
        self.vacuum_wave_number
    }

    /// The devices, in the order of the scene.
    #[must_use]
    pub fn devices(&self) -> &[Placed] {
        &self.devices
    }

    /// The bodies among the devices.
    pub(super) fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// The first two devices that overlap, if any do. Bodies may, unless their priorities are equal.
    #[must_use]
    pub fn overlap(&self) -> Option<(usize, usize)> {
        let solids: Vec<_> = self.devices.iter().map(Placed::solids).collect();
        let pairs = (0..solids.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
        let priority = |i: usize| self.devices[i].structure.hull.body().map(|body| body.priority);
        let may_overlap = |i: usize, j: usize| match (priority(i), priority(j)) {
            (Some(one), Some(other)) => one != other,
            _ => false,
        };
        pairs.into_iter().filter(|&(i, j)| !may_overlap(i, j)).find(|&(i, j)| {
            solids[i].iter().any(|one| solids[j].iter().any(|two| one.overlaps(two, TOUCHING)))
        })
    }

    /// The device that holds a point, if any does.
    #[must_use]
    pub fn holder(&self, point: DVec3) -> Option<usize> {
        self.devices.iter().position(|device| device.holds(point))
    }

    /// The nearest surface that a ray in air meets. `last` is the device and the surface of its skin
    /// that the ray has just left.
    #[must_use]
    pub(super) fn first_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        last: Option<(u16, u16)>,
    ) -> Option<(u16, SkinHit)> {
        let mut nearest: Option<(u16, SkinHit)> = None;
        for (index, device) in (0u16..).zip(&self.devices) {
            let last = last.filter(|(which, _)| *which == index).map(|(_, skin)| skin);
            let hit = device.structure.first_hit(
                device.pose.to_local(origin),
                device.pose.vector_to_local(direction),
                last,
            );
            if let Some(hit) = hit
                && nearest.is_none_or(|(_, least)| hit.distance < least.distance)
            {
                nearest = Some((index, hit));
            }
        }
        nearest
    }
}
