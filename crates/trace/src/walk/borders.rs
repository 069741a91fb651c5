//! Borders between devices, and between a device and what is around it: crossed in the world's
//! frame.

use super::branch::{Branch, Place};
use super::event::Event;
use super::surfaces::{Between, Interface};
use super::{LeafEnd, PathRecorder, Tracer};
use crate::assembly::{Ahead, Assembly, DepartedSurface, Screen, slack_at};
use crate::device::{Coating, FarSide, InnerRay, Passage};
use glam::DVec3;
use optics::interface::{OutgoingWaves, Side};
use optics::medium::Medium;
use optics::propagation::VirtualPoint;

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Met {
    Screen,
    Device(Ahead),
    /// A surface within rounding, which it does not cross.
    Grazed(DepartedSurface),
}

/// What lies beyond a border between devices.
#[expect(clippy::large_enum_variant, reason = "it is looked at and dropped")]
enum Destination<'a> {
    Air,
    /// A metal; a perfect conductor without a medium.
    Metal(Option<&'a Medium>),
    End(LeafEnd),
    /// A region of a device, with its medium in the world's frame.
    Region {
        place: (u16, u16),
        virtual_point: Option<VirtualPoint>,
        medium: Medium,
    },
}

impl Assembly {
    /// What a ray in a body, in its frame, meets before the border to which it has passed, and the
    /// passage to there.
    pub(super) fn guest_ahead(
        &self,
        (ray, departed): (&InnerRay, Option<DepartedSurface>),
        body: u16,
        passage: Option<&Passage>,
        screen: Option<Screen>,
    ) -> Option<(Met, Passage)> {
        let pose = &self.device(body).pose;
        let origin = pose.to_world(ray.position);
        let direction = pose.vector_to_world(ray.direction);
        let slack = slack_at(origin);
        let end = passage.map_or(f64::INFINITY, |p| (p.position - ray.position).length());
        let hit = self.first_guest(body, origin, direction, departed);
        let hit = hit.filter(|(_, hit)| hit.distance < end - slack);
        let reach = hit.map_or(end - slack, |(_, hit)| hit.distance + slack);
        let screen = screen.and_then(|screen| screen.hit(origin, direction, -slack));
        let to = |distance: f64, face: u16, onward: DVec3| {
            let end = ray.position + ray.direction * distance;
            Passage::straight(ray, end, face, onward, FarSide::Outside)
        };
        if let Some(distance) = screen.filter(|distance| *distance <= reach) {
            return Some((Met::Screen, to(distance.max(0.0), u16::MAX, ray.direction)));
        }
        let (guest, hit) = hit?;
        let at = origin + direction * hit.distance;
        let departed = departed.and_then(|departed| departed.unless_met(guest, &hit));
        let met = match self.ahead(at, direction, departed) {
            ahead @ Ahead::Surface(..) => Met::Device(ahead),
            ahead @ Ahead::Body(there) if there != body => Met::Device(ahead),
            Ahead::Air | Ahead::Body(_) => Met::Grazed(DepartedSurface::met(guest, &hit)),
        };
        let outward = self.device(guest).pose.vector_to_world(hit.outward);
        Some((met, to(hit.distance, guest, -pose.vector_to_local(outward))))
    }

    /// What is between two media in the world, given the coating of what a branch leaves there and
    /// what is ahead of it.
    fn between(
        &self,
        (position, place): (DVec3, Place),
        left: Coating,
        ahead: Ahead,
    ) -> Between<'_> {
        let entered = match ahead {
            Ahead::Air => None,
            Ahead::Surface(number, hit) => Some((number, hit.coating)),
            Ahead::Body(number) => {
                let device = self.device(number);
                let coating = device.structure.surfaces.first().map(|surface| surface.coating);
                // Within a body its surface is not there.
                coating.filter(|coating| *coating != Coating::None).zip(device.body()).and_then(
                    |(coating, body)| {
                        let local = device.pose.to_local(position);
                        let slack = 2.0 * slack_at(position);
                        body.shape.borders(local, slack).then_some((number, coating))
                    },
                )
            }
        };
        let left = match place {
            Place::Region { device, .. } => Some((device, left)),
            Place::Air => None,
        };
        let sides = [left, entered];
        let films = sides.map(|side| match side {
            Some((device, Coating::Film(film))) => self.film_in_world(device, film),
            _ => &[],
        });
        let perfect = |side: &Option<(u16, Coating)>| {
            side.is_some_and(|(_, coating)| coating == Coating::Antireflection)
        };
        if films.iter().any(|film| !film.is_empty()) {
            Between::Films(films)
        } else if sides.iter().any(perfect) {
            Between::PerfectCoating
        } else {
            Between::Nothing
        }
    }

    /// What light has departed from that is sent back by what is ahead of it.
    fn departed_from(&self, ahead: Ahead) -> Option<DepartedSurface> {
        let (number, surface) = match ahead {
            Ahead::Air => return None,
            Ahead::Surface(number, hit) => (number, Some(hit.surface)),
            Ahead::Body(number) => (number, None),
        };
        self.device(number).departed(number, surface)
    }

    /// What lies beyond a border, at a point of the world; `None` if rounding hides it.
    fn destination(&self, position: DVec3, ahead: Ahead) -> Option<Destination<'_>> {
        let (number, far) = match ahead {
            Ahead::Air => return Some(Destination::Air),
            Ahead::Surface(number, hit) => (number, hit.far),
            // A body has one surface, and what is behind that is in it.
            Ahead::Body(number) => (number, self.device(number).structure.surfaces.first()?.far),
        };
        Some(match far {
            // Between a medium and a polarizer there is a gap of air, however thin.
            FarSide::Outside | FarSide::Polarizer => Destination::Air,
            FarSide::Conductor | FarSide::Metal(_) => {
                Destination::Metal(self.device(number).structure.metal(far))
            }
            FarSide::Opaque => Destination::End(LeafEnd::Body(number)),
            FarSide::Region(region) | FarSide::Seam(region) => {
                let device = self.device(number);
                let position = device.pose.to_local(position);
                let mut graded = None;
                let (virtual_point, medium) = device.region(region).enter(position, &mut graded)?;
                let medium = device.medium_in_world(medium);
                Destination::Region { place: (number, region), virtual_point, medium }
            }
        })
    }
}

impl<const N: usize, W: PathRecorder<N>> Tracer<'_, N, W> {
    /// What a ray meets at a point, in the world, at which it leaves `departed`.
    pub(super) fn met_at(
        &self,
        position: DVec3,
        direction: DVec3,
        departed: Option<DepartedSurface>,
    ) -> Met {
        let slack = slack_at(position);
        let screen = self.screen.filter(|_| self.screen_touches);
        let screen = screen.and_then(|screen| screen.hit(position, direction, -slack));
        if screen.is_some_and(|distance| distance <= slack) {
            return Met::Screen;
        }
        Met::Device(self.assembly.ahead(position, direction, departed))
    }

    /// Takes a branch from a region across its border, both in the frame of the region's device, to
    /// what it meets there.
    pub(super) fn leave(
        &mut self,
        branch: &mut Branch<N>,
        medium: &Medium,
        met: Met,
        (number, region): (u16, u16),
        passage: &Passage,
    ) -> bool {
        let device = self.assembly.device(number);
        let ahead = match met {
            Met::Grazed(departed) => {
                branch.departed = Some(departed);
                return true;
            }
            Met::Screen => {
                branch.leave_frame(&device.pose);
                return self.end(branch, LeafEnd::Screen);
            }
            Met::Device(ahead) => ahead,
        };
        let medium = device.medium_in_world(medium);
        branch.leave_frame(&device.pose);
        let onward = device.pose.vector_to_world(passage.outward);
        let event = Event::Face { device: number, region, face: passage.face }.shared();
        self.cross(branch, &medium, passage.coating, ahead, (onward, event))
    }

    /// Splits a branch, in the world's frame but still of the place that it leaves, at the border
    /// of that place, with its coating, to what is ahead.
    pub(super) fn cross(
        &mut self,
        branch: &mut Branch<N>,
        here: &Medium,
        left: Coating,
        ahead: Ahead,
        (onward, event): (DVec3, Event),
    ) -> bool {
        let (assembly, place) = (self.assembly, branch.place);
        let between = assembly.between((branch.position, place), left, ahead);
        let interface = Interface { onward, between, event };
        let Some(destination) = assembly.destination(branch.position, ahead) else {
            return self.lose(branch.power);
        };
        // Sheets would be met again at once.
        let departed = assembly.departed_from(ahead);
        let back = |branch: &mut Branch<N>| {
            branch.departed = departed;
            if let Place::Region { device, .. } = place {
                branch.enter_frame(&assembly.device(device).pose);
            }
        };
        let on = |branch: &mut Branch<N>| match &destination {
            Destination::Region { place: (device, region), virtual_point, .. } => {
                branch.enter_frame(&assembly.device(*device).pose);
                branch.enter_region(*device, *region, *virtual_point);
            }
            _ => branch.come_out(match place {
                Place::Region { device, .. } => assembly.device(device).departed(device, None),
                Place::Air => None,
            }),
        };
        let there = match &destination {
            Destination::Region { medium, .. } => medium,
            Destination::Air => &Medium::AIR,
            Destination::End(end) => return self.end(branch, *end),
            Destination::Metal(metal) => {
                return self.reflect(branch, here, *metal, &interface, back);
            }
        };
        if here == there && !matches!(interface.between, Between::Films(_)) {
            // A border between equal media: nothing is there.
            on(branch);
            return true;
        }
        let mut waves = OutgoingWaves::new();
        self.split(here, there, branch, &interface, &mut waves);
        self.go_on(branch, &waves, interface.event, |branch, side| match side {
            Side::Reflected => back(branch),
            Side::Transmitted => on(branch),
        })
    }
}
