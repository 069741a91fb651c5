//! The optical bench: all devices of a scene at their places.

use super::bodies::Bodies;
use super::branch::Left;
use super::interfaces::Interfaces;
use crate::device::{Cell, SkinHit, Structure};
use crate::photograph::ImageSource;
use glam::DVec3;
use optics::geometry::{Pose, Solid};

/// The most devices a scene may have: they are numbered in 16 bits.
pub const MOST_DEVICES: usize = u16::MAX as usize;

/// A device at its place.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Where it stands and how it is turned.
    pub pose: Pose,
    /// What it is made of.
    pub structure: Structure,
}

impl Placed {
    /// What a branch has left that runs away from this device, the `number`th: the surface of its skin that is
    /// given, or all of it if it is convex.
    pub(super) fn left(&self, number: u16, surface: Option<u16>) -> Option<Left> {
        let convex = self.structure.hull.is_convex();
        let surface = surface.filter(|_| !convex);
        (convex || surface.is_some()).then_some(Left { device: number, surface })
    }

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

    /// The sheet of its thin mirror in the world, if it has one.
    fn thin_mirror(&self) -> Option<Solid> {
        self.structure.hull.thin_mirror().map(|mirror| mirror.placed(&self.pose))
    }
}

/// Whether two thin sheets lie on each other.
fn coincide(a: &Solid, b: &Solid) -> bool {
    let (Solid::Prism { outline, extent }, Solid::Prism { outline: other, extent: beyond }) =
        (a, b)
    else {
        return false;
    };
    let ([a0, a1], [b0, b1]) = (outline.corners(), other.corners()) else { return false };
    let along = (*a1 - *a0).normalize();
    let [off_0, off_1] = [b0, b1].map(|b| along.perp_dot(*b - *a0).abs());
    let [at_0, at_1] = [b0, b1].map(|b| along.dot(*b - *a0));
    extent.overlaps(*beyond)
        && off_0.max(off_1) < TOUCHING
        && at_0.min(at_1) < a0.distance(*a1) - TOUCHING
        && at_0.max(at_1) > TOUCHING
}

/// All devices of a scene.
#[derive(Clone, Debug)]
pub struct Bench {
    devices: Vec<Placed>,
    /// Those of each device.
    interfaces: Vec<Interfaces>,
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
    /// The bench with the given devices, [`MOST_DEVICES`] at most, which must not overlap: see [`Bench::overlap`].
    #[must_use]
    pub fn new(devices: Vec<Placed>) -> Self {
        let bodies = Bodies::of(&devices);
        let interfaces = devices.iter().map(|device| Interfaces::of(&device.structure)).collect();
        Self { devices, interfaces, bodies, vacuum_wave_number: 0.0 }.with_wavelength(550.0)
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

    /// The interfaces of a device, by its number.
    pub(super) fn interfaces(&self, device: u16) -> &Interfaces {
        &self.interfaces[usize::from(device)]
    }

    /// The cell of a device.
    pub(super) fn cell(&self, (device, cell): (u16, u16)) -> &Cell {
        &self.devices[usize::from(device)].structure.cells[usize::from(cell)]
    }

    /// The bodies among the devices.
    pub(super) fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// The images on opaque bodies.
    pub fn body_images(&self) -> impl Iterator<Item = &ImageSource> {
        self.devices.iter().filter_map(|device| device.structure.hull.body()?.image())
    }

    /// The first two devices that overlap, if any do. Bodies may, unless their priorities are equal.
    #[must_use]
    pub fn overlap(&self) -> Option<(usize, usize)> {
        let solids: Vec<Vec<Solid>> = (self.devices.iter())
            .map(|device| device.solids().into_iter().chain(device.thin_mirror()).collect())
            .collect();
        let pairs = (0..solids.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
        let priority = |i: usize| self.devices[i].structure.hull.body().map(|body| body.priority);
        let may_overlap = |i: usize, j: usize| match (priority(i), priority(j)) {
            (Some(one), Some(other)) => one != other,
            _ => false,
        };
        let meet = |a: &Solid, b: &Solid| a.overlaps(b, TOUCHING) || coincide(a, b);
        pairs
            .filter(|&(i, j)| !may_overlap(i, j))
            .find(|&(i, j)| solids[i].iter().any(|a| solids[j].iter().any(|b| meet(a, b))))
    }

    /// The device that holds a point, if any does.
    #[must_use]
    pub fn holder(&self, point: DVec3) -> Option<usize> {
        self.devices.iter().position(|device| device.holds(point))
    }

    /// The nearest surface that a ray in air meets, `left` being what it has just left.
    #[must_use]
    pub(super) fn first_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        left: Option<Left>,
    ) -> Option<(u16, SkinHit)> {
        let mut nearest: Option<(u16, SkinHit)> = None;
        for (index, device) in (0u16..).zip(&self.devices) {
            let left = left.filter(|left| left.device == index);
            if left.is_some_and(|left| left.surface.is_none()) {
                continue;
            }
            let last = left.and_then(|left| left.surface);
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
