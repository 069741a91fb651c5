//! Devices at their places: what is where, what may overlap, and where rays meet it.

mod interfaces;
mod placed;
mod screen;

pub(crate) use placed::DepartedSurface;
pub use placed::Placed;
pub use screen::Screen;

use crate::device::{Region, SurfaceHit};
use glam::DVec3;
use interfaces::Interfaces;
use optics::geometry::{Solid, TOUCHING, first_along};
use optics::interface::FilmLayer;

/// The most devices a scene may have: they are numbered in 16 bits.
pub const MOST_DEVICES: usize = u16::MAX as usize;

/// All devices of a scene.
///
/// Where several could be at one point, the order is: a device that is no body, then the bodies by
/// falling priority, then air.
#[derive(Clone, Debug)]
pub struct Assembly {
    devices: Vec<Placed>,
    /// Those of each device.
    interfaces: Vec<Interfaces>,
    /// The bodies, by falling priority.
    bodies: Vec<u16>,
    /// The films of each device, in the world's frame.
    films: Vec<Vec<Vec<FilmLayer>>>,
    /// For each body the devices that rays in it may meet: those that come before it and reach into
    /// its bounds.
    guests: Vec<Vec<u16>>,
    /// Whether there is one device at most, and no body: around it is air, and nothing touches it.
    pub(crate) simple: bool,
    /// Of a single device that absorbs nothing the axes of its frame along which it has no end, as ones among
    /// zeros: none else. What a wave vector has along them is never changed.
    pub(crate) endless_axes: DVec3,
    /// k0, the wave number in vacuum, 1/cm.
    pub(crate) vacuum_wave_number: f64,
}

/// What is ahead of a ray at a point that may lie on the borders of several devices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Ahead {
    Air,
    /// A surface of a device that is no body.
    Surface(u16, SurfaceHit),
    /// The inside of a body.
    Body(u16),
}

/// Borders that are no further than this from a point, cm, go through it: what rounding makes of
/// coordinates.
pub(crate) fn slack_at(point: DVec3) -> f64 {
    TOUCHING.max(1e-14 * point.abs().max_element())
}

impl Assembly {
    /// The assembly with the given devices, [`MOST_DEVICES`] at most, which must not overlap: see
    /// [`Assembly::overlap`].
    #[must_use]
    pub fn new(devices: Vec<Placed>) -> Self {
        let interfaces = devices.iter().map(|device| Interfaces::of(&device.structure)).collect();
        let priority = |number: u16| devices[usize::from(number)].body().map(|body| body.priority);
        let numbers = || (0u16..).take(devices.len());
        let mut bodies: Vec<u16> = numbers().filter(|number| priority(*number).is_some()).collect();
        bodies.sort_by_key(|number| std::cmp::Reverse(priority(*number)));
        let bounds: Vec<Option<[DVec3; 2]>> = devices.iter().map(Placed::bounds).collect();
        let meet = |one: u16, other: u16| {
            let [one, other] = [one, other].map(|number| bounds[usize::from(number)]);
            one.zip(other).is_some_and(|([low, high], [from, to])| {
                low.cmple(to + TOUCHING).all() && from.cmple(high + TOUCHING).all()
            })
        };
        let comes_before = |one: u16, other: u16| match (priority(one), priority(other)) {
            (_, None) => false,
            (None, Some(_)) => true,
            (Some(one), Some(other)) => one > other,
        };
        let guests = numbers()
            .map(|host| {
                numbers().filter(|&guest| comes_before(guest, host) && meet(guest, host)).collect()
            })
            .collect();
        let simple = devices.len() <= 1 && bodies.is_empty();
        let films = devices.iter().map(Placed::films_in_world).collect();
        let (vacuum_wave_number, endless_axes) = (0.0, DVec3::ZERO);
        let mut assembly = Self {
            interfaces,
            bodies,
            films,
            guests,
            devices,
            simple,
            endless_axes,
            vacuum_wave_number,
        };
        if let ([device], false) = (&assembly.devices[..], assembly.absorbs()) {
            assembly.endless_axes = device.structure.hull.endless_axes();
        }
        assembly.with_wavelength(550.0)
    }

    /// The same assembly in light of another wavelength (in vacuum, nm) than 550 nm. Only
    /// absorption depends on it: media are given for it.
    #[must_use]
    pub fn with_wavelength(self, wavelength_nm: f64) -> Self {
        const CM_PER_NM: f64 = 1e-7;
        let vacuum_wave_number = std::f64::consts::TAU / (wavelength_nm * CM_PER_NM);
        Self { vacuum_wave_number, ..self }
    }

    /// Whether there are media with two waves, and the optical paths of these differ in each by no
    /// more than that (cm) after the thinnest part of its device.
    #[must_use]
    pub fn is_hardly_birefringent(&self, path: f64) -> bool {
        let mut parted = self.devices.iter().flat_map(Placed::parted).peekable();
        parted.peek().is_some() && parted.all(|parted| parted <= path)
    }

    /// Whether a medium, a metal or a film of a device takes power from light.
    #[must_use]
    pub fn absorbs(&self) -> bool {
        let absorbs = |region: &Region| match region {
            Region::Homogeneous(region) => region.medium.absorbs(),
            Region::Conformal(region) => region.loss_tangent > 0.0,
            Region::Radial(_) | Region::ClosedForm(_) | Region::Spatial(_) => false,
        };
        self.devices.iter().any(|Placed { structure, .. }| {
            structure.regions.iter().any(absorbs)
                || !structure.metals.is_empty()
                || structure.films.iter().flatten().any(|layer| layer.medium.absorbs())
        })
    }

    /// Whether light is followed step by step through a graded medium.
    #[must_use]
    pub fn is_graded(&self) -> bool {
        let structures = self.devices.iter().map(|device| &device.structure);
        structures.flat_map(|structure| &structure.regions).any(Region::is_integrated)
    }

    /// The devices, in the order of the scene.
    #[must_use]
    pub fn devices(&self) -> &[Placed] {
        &self.devices
    }

    /// A device, by its number.
    pub(crate) fn device(&self, number: u16) -> &Placed {
        &self.devices[usize::from(number)]
    }

    /// The layers of a film of a device, in the world's frame.
    pub(crate) fn film_in_world(&self, device: u16, film: u16) -> &[FilmLayer] {
        &self.films[usize::from(device)][usize::from(film)]
    }

    /// The interfaces of a device, by its number.
    pub(crate) fn interfaces(&self, device: u16) -> &Interfaces {
        &self.interfaces[usize::from(device)]
    }

    /// The first two devices that overlap, if any do: sheets without thickness do that lie on each
    /// other, for none of them comes first. Bodies may, unless their priorities are equal; and a
    /// device may stand within a body of a medium, whose border its thin mirror may cross.
    #[must_use]
    pub fn overlap(&self) -> Option<(usize, usize)> {
        let solids: Vec<Vec<Solid>> = self.devices.iter().map(Placed::solids).collect();
        let mirrors: Vec<Option<Solid>> = self.devices.iter().map(Placed::thin_mirror).collect();
        let overlap = |i: usize, j: usize| {
            let touch = |a: &Solid, b: &Solid| a.overlaps(b, TOUCHING);
            let meet = |i: usize, j: usize| {
                let thin = mirrors[i].as_ref();
                thin.is_some_and(|mirror| solids[j].iter().any(|solid| touch(mirror, solid)))
            };
            let lie_on = |i: usize, j: usize| {
                let [sheets, others] = [i, j].map(|of| solids[of].iter().chain(&mirrors[of]));
                sheets.into_iter().any(|a| others.clone().any(|b| a.coincides(b, TOUCHING)))
            };
            let both_mirrors = mirrors[i].as_ref().zip(mirrors[j].as_ref());
            let solids_do = solids[i].iter().any(|a| solids[j].iter().any(|b| touch(a, b)));
            let host = |host: usize, guest: usize| {
                let medium = !self.devices[host].structure.regions.is_empty()
                    && !self.devices[guest].structure.polarizes();
                let within = |solid: &Solid| solids[host].iter().any(|host| solid.is_within(host));
                medium && solids[guest].iter().all(within)
            };
            match [i, j].map(|device| self.devices[device].body()) {
                [Some(one), Some(other)] => one.priority == other.priority && solids_do,
                [Some(_), None] => solids_do && !host(i, j),
                [None, Some(_)] => solids_do && !host(j, i),
                [None, None] => {
                    solids_do
                        || meet(i, j)
                        || meet(j, i)
                        || both_mirrors.is_some_and(|(a, b)| touch(a, b))
                        || lie_on(i, j)
                }
            }
        };
        let pairs = (0..solids.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
        pairs.into_iter().find(|&(i, j)| overlap(i, j))
    }

    /// The device that holds a point, if any does: the innermost of several.
    #[must_use]
    pub fn device_containing(&self, point: DVec3) -> Option<usize> {
        let holds = |number: &usize| self.devices[*number].holds(point);
        let others =
            (0..self.devices.len()).filter(|number| self.devices[*number].body().is_none());
        others.chain(self.bodies.iter().map(|body| usize::from(*body))).find(holds)
    }

    /// The nearest surface ahead of a ray in air. `departed` is what the ray has just left.
    #[inline(always)]
    pub(crate) fn first_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        departed: Option<DepartedSurface>,
    ) -> Option<(u16, SurfaceHit)> {
        if self.simple {
            return self.hit_of(0, origin, direction, departed).map(|hit| (0, hit));
        }
        self.first_hit_of((0u16..).take(self.devices.len()), origin, direction, departed)
    }

    /// The nearest surface ahead of a ray in a body, of the devices that it may meet there.
    pub(crate) fn first_guest(
        &self,
        body: u16,
        origin: DVec3,
        direction: DVec3,
        departed: Option<DepartedSurface>,
    ) -> Option<(u16, SurfaceHit)> {
        let guests = self.guests[usize::from(body)].iter().copied();
        self.first_hit_of(guests, origin, direction, departed)
    }

    /// Of the nearest surface ahead of a ray in air its device, its number there, and how far it is.
    #[inline(always)]
    pub(crate) fn first_surface(&self, origin: DVec3, direction: DVec3) -> Option<(u16, u16, f64)> {
        // In each case by itself: every sample of a picture asks for it, and all that a hit is would be copied.
        if self.simple {
            return self
                .hit_of(0, origin, direction, None)
                .map(|hit| (0, hit.surface, hit.distance));
        }
        let (device, hit) = self.first_hit(origin, direction, None)?;
        Some((device, hit.surface, hit.distance))
    }

    /// The nearest surface of some devices ahead of a ray. Surfaces of other devices than the
    /// departed one that rounding has put a hair behind the ray are met, too, at the distance 0.
    fn first_hit_of(
        &self,
        numbers: impl Iterator<Item = u16>,
        origin: DVec3,
        direction: DVec3,
        departed: Option<DepartedSurface>,
    ) -> Option<(u16, SurfaceHit)> {
        let slack = slack_at(origin);
        let hits = numbers.filter_map(|number| {
            // A device that is not convex is met again from where it was left.
            let own = departed.is_some_and(|departed| departed.device == number);
            let back = if own { 0.0 } else { slack };
            let hit = self.hit_of(number, origin - direction * back, direction, departed)?;
            Some(((hit.distance - back).max(0.0), (number, hit)))
        });
        let (distance, (number, hit)) = first_along(hits)?;
        Some((number, SurfaceHit { distance, ..hit }))
    }

    /// The nearest surface of one device ahead of a ray, `departed` being what the ray has just
    /// left.
    #[inline(always)]
    fn hit_of(
        &self,
        number: u16,
        origin: DVec3,
        direction: DVec3,
        departed: Option<DepartedSurface>,
    ) -> Option<SurfaceHit> {
        let last = match departed.filter(|departed| departed.device == number) {
            Some(DepartedSurface { surface: None, .. }) => return None,
            departed => departed.and_then(|departed| departed.surface),
        };
        let Placed { pose, structure, .. } = self.devices.get(usize::from(number))?;
        structure.first_hit(pose.to_local(origin), pose.vector_to_local(direction), last)
    }

    /// What is ahead of a ray at a point of the borders of any number of devices: of those that it
    /// enters there, or is in already, the one that comes first.
    pub(crate) fn ahead(
        &self,
        point: DVec3,
        direction: DVec3,
        departed: Option<DepartedSurface>,
    ) -> Ahead {
        let slack = slack_at(point);
        let behind = point - direction * slack;
        let others = (0u16..).zip(&self.devices).filter(|(_, device)| device.body().is_none());
        let hits = others.filter_map(|(number, _)| {
            let hit = self.hit_of(number, behind, direction, departed)?;
            (hit.distance <= 2.0 * slack).then_some((hit.distance, (number, hit)))
        });
        if let Some((_, (device, hit))) = first_along(hits) {
            return Ahead::Surface(device, SurfaceHit { distance: 0.0, ..hit });
        }
        let inside = |number: &&u16| {
            let device = self.device(**number);
            device.body().is_some_and(|body| {
                let (point, direction) =
                    (device.pose.to_local(point), device.pose.vector_to_local(direction));
                body.shape.holds_ahead(point, direction, slack)
            })
        };
        self.bodies.iter().find(inside).map_or(Ahead::Air, |number| Ahead::Body(*number))
    }
}
