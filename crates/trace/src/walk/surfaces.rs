//! From surface to surface: how a branch runs on, and what becomes of it where media meet.

use super::branch::{Branch, Place};
use super::{LeafEnd, PathRecorder, PathSegment, Tracer};
use crate::assembly::{Ahead, DepartedSurface, slack_at};
use crate::device::{Coating, FarSide, Passage, Region, SurfaceHit};
use glam::DVec3;
use optics::interface::{
    OutgoingWave, OutgoingWaves, Side, reflect_at_conductor, split_down_to, transmit_antireflection,
};
use optics::medium::{Medium, ModeKind};
use optics::propagation::{PathPoint, VirtualPoint};

/// The square of the largest wave vector that is followed, a billion times the largest index of refraction. Light
/// that runs into a corner of a hyperbolic medium gets there: each face makes it shorter, and it never comes out.
const SHORTEST_WAVE: f64 = 1e30;

/// Light that crosses more borders than this in a row within rounding of one point has spiralled into an
/// edge of a negative-index body, and never comes out.
const MOST_STANDSTILLS: u8 = 16;

/// Tells borders between devices from those with air in the fingerprint of a path.
const BETWEEN_DEVICES: u64 = 1 << 55;

/// What lies beyond a border between devices.
#[expect(clippy::large_enum_variant, reason = "it is looked at and dropped")]
enum Beyond {
    Air,
    Conductor,
    End(LeafEnd),
    /// A region of a device, with its medium in the world's frame.
    Region {
        device: u16,
        region: u16,
        virtual_point: Option<VirtualPoint>,
        medium: Medium,
    },
}

/// A border between devices, in the world's frame.
struct Border {
    /// The unit normal, along the ray.
    onward: DVec3,
    coating: Coating,
    event: u64,
    /// What light that is sent back has departed from.
    departed: Option<DepartedSurface>,
}

impl<'a, const N: usize, W: PathRecorder<N>> Tracer<'a, N, W> {
    /// Whether a ray in air runs on through air to the screen, or for ever.
    #[must_use]
    pub fn meets_nothing(&self, origin: DVec3, direction: DVec3) -> bool {
        self.surface_ahead(origin, direction, None).is_none()
    }

    /// Follows a branch in air to the next surface; whether it goes on from there.
    pub(super) fn through_air(&mut self, branch: &mut Branch<N>) -> bool {
        let hit = self.surface_ahead(branch.position, branch.direction, branch.departed);
        let Some((number, hit)) = hit else {
            self.leaves.push(branch.leaf(LeafEnd::Away));
            return false;
        };
        let from = branch.position;
        branch.position += branch.direction * hit.distance;
        self.recorder.record(|| PathSegment {
            power: branch.power,
            optical_path: branch.optical_path,
            inside: None,
            path: vec![
                PathPoint { position: from, optical_path: 0.0 },
                PathPoint { position: branch.position, optical_path: hit.distance },
            ],
        });
        branch.optical_path += hit.distance;
        branch.group_path += hit.distance;
        branch.met_device = true;
        let (number, hit) = if self.assembly.simple {
            (number, hit)
        } else if !self.moves(branch, hit.distance) {
            return false;
        } else {
            match self.assembly.ahead(branch.position, branch.direction, branch.departed) {
                Ahead::Surface(number, hit) => (number, hit),
                Ahead::Body(body) if body == number => (number, hit),
                Ahead::Body(body) => {
                    let outward = self.assembly.device(number).pose.vector_to_world(hit.outward);
                    let event = BETWEEN_DEVICES | event(number, &hit);
                    let border =
                        Border { onward: -outward, coating: Coating::None, event, departed: None };
                    let beyond = self.beyond(branch, Ahead::Body(body));
                    return self.cross(branch, &Medium::AIR, beyond, &border);
                }
                // Only grazed.
                Ahead::Air => {
                    let surface = Some(hit.surface);
                    branch.departed = Some(DepartedSurface { device: number, surface });
                    return true;
                }
            }
        };
        self.enter(branch, number, &hit)
    }

    /// Takes a branch in air that has come to a surface of a device into it.
    fn enter(&mut self, branch: &mut Branch<N>, number: u16, hit: &SurfaceHit) -> bool {
        let device = self.assembly.device(number);
        let departed = || device.departed(number, Some(hit.surface));
        let event = event(number, hit);
        let region = match hit.far {
            FarSide::Region(region) | FarSide::Seam(region) => region,
            FarSide::Conductor => {
                branch.enter_frame(&device.pose);
                let waves = self.reflect(&Medium::AIR, branch, -hit.outward);
                return self.go_on(branch, &waves, event, |branch, _| {
                    branch.leave_frame(&device.pose);
                    branch.departed = departed();
                });
            }
            FarSide::Opaque => return self.end(branch, LeafEnd::Body(number)),
            FarSide::Outside => {
                branch.departed =
                    Some(DepartedSurface { device: number, surface: Some(hit.surface) });
                return true;
            }
        };
        branch.enter_frame(&device.pose);
        if let Some(interface) = self.assembly.interfaces(number).entrance(hit.surface) {
            let wave = interface.transmit(&branch.incident());
            return self.go_on_alone(branch, &wave, event, |branch| {
                branch.enter_region(number, region, None);
            });
        }
        let mut graded = None;
        let found = device.region(region).enter(branch.position, &mut graded);
        let Some((virtual_point, medium)) = found else {
            return self.lose(branch.power);
        };
        let mut waves = OutgoingWaves::new();
        self.split(&Medium::AIR, medium, branch, -hit.outward, hit.coating, &mut waves);
        self.go_on(branch, &waves, event, |branch, side| match side {
            Side::Reflected => {
                branch.leave_frame(&device.pose);
                branch.departed = departed();
            }
            Side::Transmitted => branch.enter_region(number, region, virtual_point),
        })
    }

    /// Whether a branch in a region starts as several waves that then part: each goes on alone.
    pub(super) fn parts(&mut self, branch: &Branch<N>, region: &Region) -> bool {
        if branch.mode != ModeKind::Shared {
            return false;
        }
        let parted = region.parted(branch.position, branch.wave_vector);
        let Some([(a, in_a), (b, in_b)]) = parted else { return false };
        for mut part in [branch.part(a, in_a, in_b), branch.part(b, in_b, in_a)] {
            if self.follows(part.power) {
                part.update_survival(self.least_power());
                self.waiting.push(part);
            }
        }
        true
    }

    /// Takes a branch to the surface to which it has passed through a region, or to what stands in a body before it;
    /// whether it goes on from there.
    pub(super) fn pass(
        &mut self,
        branch: &mut Branch<N>,
        place: (u16, u16),
        passage: Option<&Passage>,
    ) -> bool {
        let device = self.assembly.device(place.0);
        let is_body = device.body().is_some();
        let guest = if is_body { self.guest_ahead(branch, place.0, passage) } else { None };
        let Some(passage) = guest.as_ref().map(|(_, passage)| passage).or(passage) else {
            // It is lost in rounding, or runs along an endless body for ever.
            return self.lose(branch.power);
        };
        if is_body && !self.moves(branch, (passage.position - branch.position).length()) {
            return false;
        }
        let mut graded = None;
        let Some(medium) = self.travel(branch, place, passage, &mut graded) else {
            return false;
        };
        let Some((met, _)) = guest else {
            // Sent back from here, it may come again to what it has left.
            branch.departed = None;
            return self.arrive(branch, place, medium, passage);
        };
        let onward = device.pose.vector_to_world(passage.outward);
        let event = BETWEEN_DEVICES | face_event(place, passage.face);
        let border = Border { onward, coating: Coating::None, event, departed: None };
        self.leave(branch, medium, met, border)
    }

    /// Takes a branch along a passage through a region; the medium at its end, or `None` if the branch does not come there.
    #[inline]
    fn travel<'m>(
        &mut self,
        branch: &mut Branch<N>,
        (number, region_number): (u16, u16),
        passage: &Passage,
        graded: &'m mut Option<Medium>,
    ) -> Option<&'m Medium>
    where
        'a: 'm,
    {
        let region = self.assembly.device(number).region(region_number);
        let way = passage.position - branch.position;
        self.recorder.record(|| PathSegment {
            power: branch.power,
            optical_path: branch.optical_path,
            inside: Some((number, region_number)),
            path: region.path(&branch.inner_ray(), passage, self.limits.tolerance),
        });
        branch.position = passage.position;
        branch.met_device = true;
        let medium = region.medium(passage.position, passage.virtual_point.as_ref(), graded);
        let Some(medium) = medium else {
            self.lose(branch.power);
            return None;
        };
        if medium.absorbs() && !self.absorb(branch, way) {
            return None;
        }
        if passage.extinction > 0.0 && !self.extinguish(branch, passage.extinction) {
            return None;
        }
        branch.wave_vector = passage.wave_vector;
        branch.direction = passage.direction;
        branch.optical_path += passage.optical_path;
        branch.group_path += region.group_path(passage.optical_path, way);
        branch.virtual_point = passage.virtual_point;
        if let Some(transport) = passage.transport {
            branch.electric = branch.electric.map(|field| field.transformed(&transport));
        }
        Some(medium)
    }

    /// Splits a branch at the border of the region through which it has passed.
    #[inline]
    fn arrive(
        &mut self,
        branch: &mut Branch<N>,
        (number, region): (u16, u16),
        medium: &Medium,
        passage: &Passage,
    ) -> bool {
        let device = self.assembly.device(number);
        let event = face_event((number, region), passage.face);
        let interface = self.assembly.interfaces(number).exit(region, passage.face);
        match passage.far {
            FarSide::Conductor => {
                let waves = self.reflect(medium, branch, passage.outward);
                self.go_on(branch, &waves, event, |_, _| ())
            }
            FarSide::Seam(next) => {
                branch.place = Place::Region { device: number, region: next };
                true
            }
            FarSide::Region(next) => {
                if let Some(interface) = interface {
                    let wave = interface.transmit(&branch.incident());
                    return self.go_on_alone(branch, &wave, event, |branch| {
                        branch.enter_region(number, next, None);
                    });
                }
                let mut graded = None;
                let beyond = device.region(next).enter(branch.position, &mut graded);
                let Some((virtual_point, beyond)) = beyond else {
                    return self.lose(branch.power);
                };
                let mut waves = OutgoingWaves::new();
                self.split(medium, beyond, branch, passage.outward, passage.coating, &mut waves);
                self.go_on(branch, &waves, event, |branch, side| {
                    if side == Side::Transmitted {
                        branch.enter_region(number, next, virtual_point);
                    }
                })
            }
            FarSide::Opaque => self.end(branch, LeafEnd::Body(number)),
            FarSide::Outside => {
                // It has met no surface from outside, which it may meet next unless the device is convex.
                let departed = device.departed(number, None);
                if !self.assembly.simple || self.screen_touches {
                    let position = device.pose.to_world(branch.position);
                    let direction = device.pose.vector_to_world(branch.direction);
                    let met = self.met_at(position, direction, departed);
                    if met != Met::Air {
                        let onward = device.pose.vector_to_world(passage.outward);
                        let event = BETWEEN_DEVICES | event;
                        let border =
                            Border { onward, coating: passage.coating, event, departed: None };
                        return self.leave(branch, medium, met, border);
                    }
                }
                let leave = |branch: &mut Branch<N>| {
                    branch.come_out(departed);
                    branch.leave_frame(&device.pose);
                };
                if let Some(interface) = interface {
                    let wave = interface.transmit(&branch.incident());
                    return self.go_on_alone(branch, &wave, event, leave);
                }
                let air = &Medium::AIR;
                let mut waves = OutgoingWaves::new();
                self.split(medium, air, branch, passage.outward, passage.coating, &mut waves);
                self.go_on(branch, &waves, event, |branch, side| {
                    if side == Side::Transmitted {
                        leave(branch);
                    }
                })
            }
        }
    }

    /// What a ray meets at a point, in the world, at which it leaves `departed`.
    fn met_at(&self, position: DVec3, direction: DVec3, departed: Option<DepartedSurface>) -> Met {
        let slack = slack_at(position);
        let screen = self.screen.filter(|_| self.screen_touches);
        let screen = screen.and_then(|screen| screen.hit(position, direction, -slack));
        if screen.is_some_and(|distance| distance <= slack) {
            return Met::Screen;
        }
        match self.assembly.ahead(position, direction, departed) {
            Ahead::Air => Met::Air,
            ahead => Met::Device(ahead),
        }
    }

    /// What a ray in a body, in its frame, meets before the border to which it has passed, and the passage to there.
    fn guest_ahead(
        &self,
        branch: &Branch<N>,
        body: u16,
        passage: Option<&Passage>,
    ) -> Option<(Met, Passage)> {
        let pose = &self.assembly.device(body).pose;
        let origin = pose.to_world(branch.position);
        let direction = pose.vector_to_world(branch.direction);
        let slack = slack_at(origin);
        let end = passage.map_or(f64::INFINITY, |p| (p.position - branch.position).length());
        let hit = self.assembly.first_guest(body, origin, direction, branch.departed);
        let hit = hit.filter(|(_, hit)| hit.distance < end - slack);
        let reach = hit.map_or(end - slack, |(_, hit)| hit.distance + slack);
        let screen = self.screen.and_then(|screen| screen.hit(origin, direction, -slack));
        let ray = branch.inner_ray();
        let to = |distance: f64, face: u16, onward: DVec3| {
            let end = branch.position + branch.direction * distance;
            Passage::straight(&ray, end, face, onward, FarSide::Outside)
        };
        if let Some(distance) = screen.filter(|distance| *distance <= reach) {
            return Some((Met::Screen, to(distance.max(0.0), u16::MAX, branch.direction)));
        }
        let (guest, hit) = hit?;
        let at = origin + direction * hit.distance;
        let met = match self.assembly.ahead(at, direction, branch.departed) {
            Ahead::Air => {
                Met::Grazed(DepartedSurface { device: guest, surface: Some(hit.surface) })
            }
            Ahead::Body(there) if there == body => {
                Met::Grazed(DepartedSurface { device: guest, surface: Some(hit.surface) })
            }
            ahead => Met::Device(ahead),
        };
        let outward = self.assembly.device(guest).pose.vector_to_world(hit.outward);
        Some((met, to(hit.distance, guest, -pose.vector_to_local(outward))))
    }

    /// Takes a branch from a region, in its frame, across a border beyond which is not air.
    fn leave(&mut self, branch: &mut Branch<N>, medium: &Medium, met: Met, border: Border) -> bool {
        let Place::Region { device: number, .. } = branch.place else { return false };
        let device = self.assembly.device(number);
        let turned = (!medium.is_isotropic()).then(|| device.medium_in_world(medium));
        let ahead = match met {
            Met::Grazed(departed) => {
                branch.departed = Some(departed);
                return true;
            }
            Met::Screen => {
                branch.leave_frame(&device.pose);
                return self.end(branch, LeafEnd::Screen);
            }
            Met::Air => Ahead::Air,
            Met::Device(ahead) => ahead,
        };
        branch.leave_frame(&device.pose);
        let coating = match ahead {
            Ahead::Surface(_, hit) if border.coating == Coating::None => hit.coating,
            _ => border.coating,
        };
        let beyond = self.beyond(branch, ahead);
        let departed = self.departed_from(ahead);
        let border = Border { coating, departed, ..border };
        self.cross(branch, turned.as_ref().unwrap_or(medium), beyond, &border)
    }

    /// What light has departed from that is sent back by what is ahead of it.
    fn departed_from(&self, ahead: Ahead) -> Option<DepartedSurface> {
        match ahead {
            Ahead::Air => None,
            Ahead::Surface(number, hit) => {
                self.assembly.device(number).departed(number, Some(hit.surface))
            }
            Ahead::Body(number) => self.assembly.device(number).departed(number, None),
        }
    }

    /// What lies beyond a border, at which the branch is, in the world's frame; `None` if rounding hides it.
    fn beyond(&self, branch: &Branch<N>, ahead: Ahead) -> Option<Beyond> {
        let (number, far) = match ahead {
            Ahead::Air => return Some(Beyond::Air),
            Ahead::Surface(number, hit) => (number, hit.far),
            Ahead::Body(number) if self.assembly.device(number).structure.is_opaque() => {
                (number, FarSide::Opaque)
            }
            Ahead::Body(number) => (number, FarSide::Region(0)),
        };
        Some(match far {
            FarSide::Outside => Beyond::Air,
            FarSide::Conductor => Beyond::Conductor,
            FarSide::Opaque => Beyond::End(LeafEnd::Body(number)),
            FarSide::Region(region) | FarSide::Seam(region) => {
                let device = self.assembly.device(number);
                let position = device.pose.to_local(branch.position);
                let mut graded = None;
                let (virtual_point, medium) = device.region(region).enter(position, &mut graded)?;
                let medium = device.medium_in_world(medium);
                Beyond::Region { device: number, region, virtual_point, medium }
            }
        })
    }

    /// Splits a branch, in the world's frame but still of the place that it leaves, at the border of two devices or of one
    /// and what is around it.
    fn cross(
        &mut self,
        branch: &mut Branch<N>,
        here: &Medium,
        beyond: Option<Beyond>,
        border: &Border,
    ) -> bool {
        let Some(beyond) = beyond else { return self.lose(branch.power) };
        let (assembly, place) = (self.assembly, branch.place);
        let back = |branch: &mut Branch<N>| {
            // Sheets would be met again at once.
            branch.departed = border.departed;
            if let Place::Region { device, .. } = place {
                branch.enter_frame(&assembly.device(device).pose);
            }
        };
        let on = |branch: &mut Branch<N>| match &beyond {
            Beyond::Region { device, region, virtual_point, .. } => {
                branch.enter_frame(&assembly.device(*device).pose);
                branch.enter_region(*device, *region, *virtual_point);
            }
            _ => branch.come_out(match place {
                Place::Region { device, .. } => assembly.device(device).departed(device, None),
                Place::Air => None,
            }),
        };
        let there = match &beyond {
            Beyond::Region { medium, .. } => medium,
            Beyond::Air => &Medium::AIR,
            Beyond::End(end) => return self.end(branch, *end),
            Beyond::Conductor => {
                let waves = self.reflect(here, branch, border.onward);
                return self.go_on(branch, &waves, border.event, |branch, _| back(branch));
            }
        };
        if here == there {
            // A border between equal media: nothing is there.
            on(branch);
            return true;
        }
        let mut waves = OutgoingWaves::new();
        self.split(here, there, branch, border.onward, border.coating, &mut waves);
        self.go_on(branch, &waves, border.event, |branch, side| match side {
            Side::Reflected => back(branch),
            Side::Transmitted => on(branch),
        })
    }

    /// Ends a branch, which does not go on.
    fn end(&mut self, branch: &Branch<N>, end: LeafEnd) -> bool {
        self.leaves.push(branch.leaf(end));
        self.recorder.stopped(&[]);
        false
    }

    /// Counts borders that a branch crosses without getting anywhere; whether it goes on.
    fn moves(&mut self, branch: &mut Branch<N>, distance: f64) -> bool {
        let stands = distance < slack_at(branch.position);
        branch.standstills = if stands { branch.standstills + 1 } else { 0 };
        if branch.standstills > MOST_STANDSTILLS {
            self.outcome.stats.endless += 1;
            self.prune(branch.power);
            return false;
        }
        true
    }

    /// The waves that metal sends back. Where it sends none, for a surface has no normal that numbers can hold, light is
    /// lost.
    fn reflect(&mut self, medium: &Medium, branch: &Branch<N>, into: DVec3) -> OutgoingWaves<N> {
        let waves = reflect_at_conductor(medium, &branch.incident(), into);
        if waves.is_empty() {
            self.lose(branch.power);
        }
        waves
    }

    /// Lets the one wave that leaves a surface go on as the branch itself, put into its place.
    fn go_on_alone(
        &mut self,
        branch: &mut Branch<N>,
        wave: &OutgoingWave<N>,
        event: u64,
        put: impl Fn(&mut Branch<N>),
    ) -> bool {
        if W::STOPS_AT_SURFACE {
            self.recorder.stopped(std::slice::from_ref(wave));
            return false;
        }
        branch.go_on_as(wave, event);
        put(branch);
        true
    }

    /// Lets the waves that leave a surface go on, each put into its place: the last one as the branch itself,
    /// the others waiting. Whether there is one.
    fn go_on(
        &mut self,
        branch: &mut Branch<N>,
        waves: &[OutgoingWave<N>],
        event: u64,
        put: impl Fn(&mut Branch<N>, Side),
    ) -> bool {
        if W::STOPS_AT_SURFACE {
            self.recorder.stopped(waves);
            return false;
        }
        let least_power = self.least_power();
        let mut last: Option<&OutgoingWave<N>> = None;
        for wave in waves {
            if !self.follows(wave.power) {
                continue;
            }
            if let Some(earlier) = last.replace(wave) {
                // Branches are large, and made where they wait.
                self.waiting.push(*branch);
                if let Some(other) = self.waiting.last_mut() {
                    other.go_on_as(earlier, event | side_code(earlier));
                    other.update_survival(least_power);
                    put(other, earlier.side);
                }
            }
        }
        let Some(wave) = last else { return false };
        branch.go_on_as(wave, event | side_code(wave));
        branch.update_survival(least_power);
        put(branch, wave.side);
        true
    }

    /// The surface that a ray in air meets before the screen; `departed` is what it has just left.
    #[inline(always)]
    fn surface_ahead(
        &self,
        position: DVec3,
        direction: DVec3,
        departed: Option<DepartedSurface>,
    ) -> Option<(u16, SurfaceHit)> {
        let hit = self.assembly.first_hit(position, direction, departed)?;
        let screen = self.screen.as_ref();
        let screen = screen.and_then(|screen| screen.hit(position, direction, 0.0));
        // Of two that touch, the screen is met.
        let slack = if self.screen_touches { slack_at(position) } else { 0.0 };
        screen.is_none_or(|distance| hit.1.distance + slack < distance).then_some(hit)
    }

    fn split(
        &mut self,
        from: &Medium,
        to: &Medium,
        branch: &Branch<N>,
        normal: DVec3,
        coating: Coating,
        waves: &mut OutgoingWaves<N>,
    ) {
        if branch.wave_vector.length_squared() > SHORTEST_WAVE {
            self.outcome.stats.endless += 1;
            self.prune(branch.power);
            return;
        }
        let wave = branch.incident();
        let mut weak = [0.0; N];
        match coating {
            Coating::None => {
                weak = split_down_to(from, to, &wave, normal, self.least_power(), waves);
            }
            Coating::Antireflection => {
                waves.extend(transmit_antireflection(from, to, &wave, normal));
            }
        }
        self.check_account(branch, waves, weak);
    }
}

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Met {
    Air,
    Screen,
    Device(Ahead),
    /// A surface within rounding, which it does not cross.
    Grazed(DepartedSurface),
}

/// Entering a device through a surface, for the fingerprint of a path.
fn event(device: u16, hit: &SurfaceHit) -> u64 {
    u64::from(device) << 32 | u64::from(hit.surface) << 2
}

/// Coming to a face of a region of a device, for the fingerprint of a path.
fn face_event((device, region): (u16, u16), face: u16) -> u64 {
    u64::from(device) << 32 | (u64::from(region) + 1) << 20 | u64::from(face) << 2
}

/// Tells the branches at one surface apart in the fingerprint of the path.
fn side_code<const N: usize>(wave: &OutgoingWave<N>) -> u64 {
    let side = match wave.side {
        Side::Reflected => 1,
        Side::Transmitted => 2,
    };
    side | (wave.mode as u64) << 56
}
