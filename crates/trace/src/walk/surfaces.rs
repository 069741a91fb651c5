//! From surface to surface: how a branch runs on, and what becomes of it where media meet.

use super::borders::Met;
use super::branch::{Branch, Place, largest};
use super::event::Event;
use super::{LeafEnd, PathRecorder, PathSegment, Tracer};
use crate::assembly::{Ahead, DepartedSurface, Placed, slack_at};
use crate::device::{Coating, FarSide, NoPassage, Passage, Region, Shape, SurfaceHit};
use glam::DVec3;
use optics::interface::{
    Backing, Film, FilmLayer, OutgoingWave, OutgoingWaves, Reflectionless, Side,
    reflect_at_conductor, split_coated, split_down_to, transmit_antireflection,
};
use optics::medium::Medium;
use optics::propagation::PathPoint;
use optics::wave::ComplexVector;

/// The square of the largest wave vector that is followed, a billion times the largest index of
/// refraction. Light that runs into a corner of a hyperbolic medium gets there: each face makes it
/// shorter, and it never comes out.
const SHORTEST_WAVE: f64 = 1e30;

/// Light that crosses more borders than this in a row within rounding of one point has spiralled
/// into an edge of a negative-index body, and never comes out.
const MOST_STANDSTILLS: u8 = 16;

/// What is between two media, in the frame of the branch that comes there.
#[derive(Clone, Copy)]
pub(super) enum Between<'a> {
    Nothing,
    PerfectCoating,
    /// The layers of a film in the order in which light meets them: of what it leaves, then of what
    /// it enters.
    Films([&'a [FilmLayer]; 2]),
}

impl Between<'_> {
    fn absorbs(&self) -> bool {
        match self {
            Self::Films(films) => {
                films.iter().copied().flatten().any(|layer| layer.medium.absorbs())
            }
            Self::Nothing | Self::PerfectCoating => false,
        }
    }
}

/// Where media meet, in the frame of the branch that comes there.
#[derive(Clone, Copy)]
pub(super) struct Interface<'a> {
    /// The unit normal, along the ray.
    pub onward: DVec3,
    pub between: Between<'a>,
    pub event: Event,
}

impl Placed {
    /// What a coating of the device puts between two media, in its frame.
    fn between(&self, coating: Coating) -> Between<'_> {
        match coating {
            Coating::None => Between::Nothing,
            Coating::Antireflection => Between::PerfectCoating,
            Coating::Film(film) => Between::Films([&self.structure.films[usize::from(film)], &[]]),
        }
    }
}

impl<'a, const N: usize, W: PathRecorder<N>> Tracer<'a, N, W> {
    /// Whether a ray in air runs on through air to the screen, or for ever.
    #[must_use]
    pub fn meets_nothing(&self, origin: DVec3, direction: DVec3) -> bool {
        self.first_surface(origin, direction).is_none()
    }

    /// The device and its surface that a ray in air meets first, before the screen.
    #[must_use]
    pub fn first_surface(&self, origin: DVec3, direction: DVec3) -> Option<(u16, u16)> {
        let (device, surface, distance) = self.assembly.first_surface(origin, direction)?;
        self.comes_before_screen(origin, direction, distance).then_some((device, surface))
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
            branch: branch.path,
            power: branch.power,
            optical_path: branch.optical_path,
            inside: None,
            path: vec![
                PathPoint { position: from, optical_path: 0.0 },
                PathPoint { position: branch.position, optical_path: hit.distance },
            ],
            times: vec![branch.time(), branch.time().after(hit.distance)],
        });
        branch.optical_path += hit.distance;
        branch.met_device = true;
        let device = self.assembly.device(number);
        self.recorder.meets(branch.path, || device.is_plane(hit.surface));
        if self.assembly.simple {
            return self.enter(branch, number, &hit);
        }
        if !self.moves(branch, hit.distance) {
            return false;
        }
        let departed = branch.departed.and_then(|departed| departed.unless_met(number, &hit));
        match self.assembly.ahead(branch.position, branch.direction, departed) {
            Ahead::Surface(number, hit) => self.enter(branch, number, &hit),
            Ahead::Body(body) if body == number => self.enter(branch, number, &hit),
            ahead @ Ahead::Body(_) => {
                let outward = self.assembly.device(number).pose.vector_to_world(hit.outward);
                let event = Event::Surface { device: number, surface: hit.surface }.shared();
                self.cross(branch, &Medium::AIR, Coating::None, ahead, (-outward, event))
            }
            // Only grazed.
            Ahead::Air => {
                branch.departed = Some(DepartedSurface::met(number, &hit));
                true
            }
        }
    }

    /// Whether a surface of a device lies in a plane.
    #[must_use]
    pub fn is_plane(&self, (device, surface): (u16, u16)) -> bool {
        self.assembly.device(device).is_plane(surface)
    }

    /// Where a branch in air meets the plane of a surface.
    pub(super) fn plane_surface_ahead(
        &self,
        branch: &Branch<N>,
        (device, number): (u16, u16),
    ) -> Option<SurfaceHit> {
        let device = self.assembly.device(device);
        let surface = device.structure.surfaces.get(usize::from(number))?;
        let position = device.pose.to_local(branch.position);
        let direction = device.pose.vector_to_local(branch.direction);
        let plane = surface.plane()?;
        Some(SurfaceHit {
            surface: number,
            distance: plane.distance(position, direction)?,
            outward: -plane.normal,
            far: surface.far,
            coating: surface.coating,
        })
    }

    /// Takes a branch in air to where it meets a surface of a device, and into that.
    pub(super) fn come_to(
        &mut self,
        branch: &mut Branch<N>,
        device: u16,
        hit: &SurfaceHit,
    ) -> bool {
        branch.position += branch.direction * hit.distance;
        branch.optical_path += hit.distance;
        branch.met_device = true;
        self.enter(branch, device, hit)
    }

    /// Takes a branch in air that has come to a surface of a device into it.
    fn enter(&mut self, branch: &mut Branch<N>, number: u16, hit: &SurfaceHit) -> bool {
        let device = self.assembly.device(number);
        let event = Event::Surface { device: number, surface: hit.surface };
        let interface =
            || Interface { onward: -hit.outward, between: device.between(hit.coating), event };
        let back = |branch: &mut Branch<N>| {
            branch.leave_frame(&device.pose);
            branch.departed = device.departed(number, Some(hit.surface));
        };
        match hit.far {
            FarSide::Region(region) | FarSide::Seam(region) => {
                branch.enter_frame(&device.pose);
                if let Some(known) = self.assembly.interfaces(number).entrance(hit.surface) {
                    return self.go_on_alone(branch, known, event, |branch| {
                        branch.enter_region(number, region, None);
                    });
                }
                self.refract(branch, &Medium::AIR, (number, region), &interface(), back)
            }
            FarSide::Conductor | FarSide::Metal(_) => {
                branch.enter_frame(&device.pose);
                let metal = device.structure.metal(hit.far);
                self.reflect(branch, &Medium::AIR, metal, &interface(), back)
            }
            FarSide::Opaque => self.end(branch, LeafEnd::Body(number)),
            FarSide::Outside => {
                branch.departed = Some(DepartedSurface::met(number, hit));
                true
            }
            FarSide::Polarizer => self.polarize(branch, number, hit),
        }
    }

    /// Takes a branch in air through a polarizer, which absorbs the rest.
    fn polarize(&mut self, branch: &mut Branch<N>, number: u16, hit: &SurfaceHit) -> bool {
        let device = self.assembly.device(number);
        let Some(Shape::Polarizer { axis, .. }) = device.structure.shape(hit.surface) else {
            return self.lose(branch.power);
        };
        let axis = device.pose.vector_to_world(*axis);
        let across = axis - branch.direction * axis.dot(branch.direction);
        // Light that runs along the axis has no field along it.
        let field = across.normalize_or_zero();
        let amplitudes = branch.electric.map(|electric| electric.dot_real(field));
        let wave = OutgoingWave {
            side: Side::Transmitted,
            mode: branch.mode,
            wave_vector: branch.wave_vector,
            attenuation: branch.attenuation,
            direction: branch.direction,
            electric: amplitudes.map(|amplitude| ComplexVector::from(field).scaled(amplitude)),
            power: amplitudes.map(|amplitude| amplitude.norm_sqr()),
        };
        for (i, absorbed) in self.outcome.absorbed.iter_mut().enumerate() {
            *absorbed += branch.power[i] - wave.power[i];
        }
        let event = Event::Surface { device: number, surface: hit.surface };
        self.go_on(branch, &[wave], event, |branch, _| {
            branch.departed = Some(DepartedSurface::met(number, hit));
        })
    }

    /// Whether a branch in a region starts as several waves that then part: each goes on alone.
    pub(super) fn parts(&mut self, branch: &Branch<N>, region: &Region) -> bool {
        let parted = region.parted(&branch.inner_ray());
        let Some([(a, in_a), (b, in_b)]) = parted else { return false };
        for part in [branch.part(a, in_a, in_b), branch.part(b, in_b, in_a)] {
            if self.recorder.went_on(branch.path, part.path, largest(&part.power)) {
                self.await_turn(part);
            }
        }
        true
    }

    /// Takes a branch to the surface to which it has passed through a region, or to what stands in
    /// a body before it; whether it goes on from there.
    pub(super) fn pass(
        &mut self,
        branch: &mut Branch<N>,
        place: (u16, u16),
        passage: Result<&Passage, &NoPassage>,
    ) -> bool {
        let device = self.assembly.device(place.0);
        let is_body = device.body().is_some();
        let guest = if is_body {
            let ray = (&branch.inner_ray(), branch.departed);
            self.assembly.guest_ahead(ray, place.0, passage.ok(), self.screen)
        } else {
            None
        };
        let passage = match (&guest, passage) {
            (Some((_, passage)), _) | (None, Ok(passage)) => passage,
            // It is lost in rounding, or runs along an endless body for ever.
            (None, Err(NoPassage::Lost)) => return self.lose(branch.power),
            (None, Err(NoPassage::Endless)) => return self.cut(branch.power),
        };
        if is_body {
            if !self.moves(branch, (passage.position - branch.position).length()) {
                return false;
            }
            // From here on it may come again to what it has left.
            branch.departed = None;
        }
        let mut graded = None;
        let Some(medium) = self.travel(branch, place, passage, &mut graded) else {
            return false;
        };
        match guest {
            Some((met, _)) => self.leave(branch, medium, met, place, passage),
            None => self.arrive(branch, place, medium, passage),
        }
    }

    /// Takes a branch along a passage through a region; the medium at its end, or `None` if the
    /// branch does not come there.
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
        let pulses = self.pulses(number);
        let is_back =
            || self.recorder.planes(branch.path).is_some() && way.dot(branch.direction) < 0.0;
        let group = if self.wants_group_path(passage.optical_path) && !is_back() {
            let (ray, field) = (branch.inner_ray(), branch.strongest_field());
            Some(region.group_path(&ray, field, passage, pulses))
        } else {
            None
        };
        self.recorder.record(|| {
            let ray = branch.inner_ray();
            let path = region.path(&ray, passage, self.limits.tolerance);
            let pulse =
                group.map(|group| region.group_paths(&path, ray.mode, group, pulses.is_some()));
            PathSegment {
                branch: branch.path,
                power: branch.power,
                optical_path: branch.optical_path,
                inside: Some((number, region_number)),
                times: branch.times(&path, passage, pulse.as_deref()),
                path,
            }
        });
        if let Some(group) = group {
            branch.delay(passage, group);
        }
        branch.position = passage.position;
        branch.met_device = true;
        let medium = region.medium(passage.position, passage.virtual_point.as_ref(), graded);
        let Some(medium) = medium else {
            self.lose(branch.power);
            return None;
        };
        if medium.absorbs() && !self.extinguish(branch, branch.attenuation.dot(way)) {
            return None;
        }
        if passage.extinction > 0.0 && !self.extinguish(branch, passage.extinction) {
            return None;
        }
        branch.wave_vector = passage.wave_vector;
        branch.direction = passage.direction;
        branch.optical_path += passage.optical_path;
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
        let event = Event::Face { device: number, region, face: passage.face };
        let interface = || Interface {
            onward: passage.outward,
            between: device.between(passage.coating),
            event,
        };
        let known = self.assembly.interfaces(number).exit(region, passage.face);
        match passage.far {
            FarSide::Conductor | FarSide::Metal(_) => {
                let metal = device.structure.metal(passage.far);
                self.reflect(branch, medium, metal, &interface(), |_| ())
            }
            FarSide::Seam(next) => {
                branch.place = Place::Region { device: number, region: next };
                true
            }
            FarSide::Region(next) => match known {
                Some(known) => self.go_on_alone(branch, known, event, |branch| {
                    branch.enter_region(number, next, None);
                }),
                None => self.refract(branch, medium, (number, next), &interface(), |_| ()),
            },
            FarSide::Opaque => self.end(branch, LeafEnd::Body(number)),
            // Polarizers have no region that could end there.
            FarSide::Polarizer => self.lose(branch.power),
            FarSide::Outside => {
                // It has met no surface from outside, which it may meet next unless the device is
                // convex.
                let departed = device.departed(number, None);
                if !self.stands_alone {
                    let position = device.pose.to_world(branch.position);
                    let direction = device.pose.vector_to_world(branch.direction);
                    let met = self.met_at(position, direction, departed);
                    if met != Met::Device(Ahead::Air) {
                        return self.leave(branch, medium, met, (number, region), passage);
                    }
                }
                let leave = |branch: &mut Branch<N>| {
                    branch.come_out(departed);
                    branch.leave_frame(&device.pose);
                };
                if let Some(known) = known {
                    return self.go_on_alone(branch, known, event, leave);
                }
                let mut waves = OutgoingWaves::new();
                self.split(medium, &Medium::AIR, branch, &interface(), &mut waves);
                self.go_on(branch, &waves, event, |branch, side| {
                    if side == Side::Transmitted {
                        leave(branch);
                    }
                })
            }
        }
    }

    /// Splits a branch, in the frame of a device, where it comes to a region of it. What is sent
    /// back is put into its place by `back`.
    fn refract(
        &mut self,
        branch: &mut Branch<N>,
        from: &Medium,
        (number, region): (u16, u16),
        interface: &Interface<'_>,
        back: impl Fn(&mut Branch<N>),
    ) -> bool {
        let mut graded = None;
        let found = self.assembly.device(number).region(region).enter(branch.position, &mut graded);
        let Some((virtual_point, medium)) = found else {
            return self.lose(branch.power);
        };
        let mut waves = OutgoingWaves::new();
        self.split(from, medium, branch, interface, &mut waves);
        self.go_on(branch, &waves, interface.event, |branch, side| match side {
            Side::Reflected => back(branch),
            Side::Transmitted => branch.enter_region(number, region, virtual_point),
        })
    }

    /// Sends a branch back from metal, a perfect conductor if it is of no medium, into the place
    /// where `back` puts it. Where a conductor sends nothing back, for a surface has no normal that
    /// numbers can hold, light is lost.
    pub(super) fn reflect(
        &mut self,
        branch: &mut Branch<N>,
        medium: &Medium,
        metal: Option<&Medium>,
        interface: &Interface<'_>,
        back: impl Fn(&mut Branch<N>),
    ) -> bool {
        if metal.is_some() || matches!(interface.between, Between::Films(_)) {
            let waves = self.reflected(branch, medium, metal, interface);
            return self.go_on(branch, &waves, interface.event, |branch, _| back(branch));
        }
        let mut waves = reflect_at_conductor(medium, &branch.incident(), interface.onward);
        if waves.is_empty() {
            return self.lose(branch.power);
        }
        // A wave that has come from a medium that absorbs may hardly be one here either.
        if medium.absorbs() || branch.attenuation != DVec3::ZERO {
            self.check_account(branch, &mut waves, [0.0; N], true);
        }
        self.go_on(branch, &waves, interface.event, |branch, _| back(branch))
    }

    /// What metal with an index or with films sends back; the rest is absorbed.
    #[cold]
    fn reflected(
        &mut self,
        branch: &Branch<N>,
        medium: &Medium,
        metal: Option<&Medium>,
        interface: &Interface<'_>,
    ) -> OutgoingWaves<N> {
        let mut waves = OutgoingWaves::new();
        let backing = metal.map_or(Backing::Conductor, Backing::Absorber);
        let beyond = (self.film(interface.between), backing);
        split_coated(medium, beyond, &branch.incident(), interface.onward, 0.0, &mut waves);
        let absorbing = metal.is_some() || interface.between.absorbs() || medium.absorbs();
        self.check_account(branch, &mut waves, [0.0; N], absorbing);
        waves
    }

    /// Ends a branch, which does not go on.
    pub(super) fn end(&mut self, branch: &Branch<N>, end: LeafEnd) -> bool {
        self.leaves.push(branch.leaf(end));
        self.recorder.stopped(&[]);
        false
    }

    /// Counts borders that a branch crosses without getting anywhere; whether it goes on.
    pub(super) fn moves(&mut self, branch: &mut Branch<N>, distance: f64) -> bool {
        let stands = distance < slack_at(branch.position);
        branch.standstills = if stands { branch.standstills + 1 } else { 0 };
        if branch.standstills > MOST_STANDSTILLS {
            return self.cut(branch.power);
        }
        true
    }

    /// Takes a branch through an interface that reflects nothing: the one wave that leaves it goes
    /// on as the branch itself, put into its place.
    #[inline]
    fn go_on_alone(
        &mut self,
        branch: &mut Branch<N>,
        known: &Reflectionless,
        event: Event,
        put: impl Fn(&mut Branch<N>),
    ) -> bool {
        let wave = known.transmit(&branch.incident());
        if W::STOPS_AT_SURFACE {
            self.recorder.stopped(std::slice::from_ref(&wave));
            return false;
        }
        let from = branch.path;
        branch.go_on_as(&wave, event);
        put(branch);
        self.recorder.went_on(from, branch.path, largest(&branch.power))
    }

    /// Lets the waves that leave a surface go on, each put into its place: the last one as the
    /// branch itself, the others waiting. Whether there is one.
    pub(super) fn go_on(
        &mut self,
        branch: &mut Branch<N>,
        waves: &[OutgoingWave<N>],
        event: Event,
        put: impl Fn(&mut Branch<N>, Side),
    ) -> bool {
        if W::STOPS_AT_SURFACE {
            self.recorder.stopped(waves);
            return false;
        }
        let least_power = self.limits.min_power;
        let joining = self.joins();
        let told = |mode| joining.map_or(mode, |joining| joining.told(mode));
        let mut last: Option<&OutgoingWave<N>> = None;
        for wave in waves {
            if !self.follows(wave.power) {
                continue;
            }
            if let Some(earlier) = last.replace(wave) {
                // Branches are large, and made where they wait.
                self.waiting.push(*branch);
                if let Some(other) = self.waiting.last_mut() {
                    other.go_on_as(earlier, (event, earlier.side, told(earlier.mode)));
                    other.update_survival(least_power);
                    put(other, earlier.side);
                    let power = largest(&other.power);
                    if !self.recorder.went_on(branch.path, other.path, power) {
                        self.waiting.truncate(self.waiting.len() - 1);
                    }
                }
            }
        }
        let Some(wave) = last else { return false };
        let from = branch.path;
        branch.go_on_as(wave, (event, wave.side, told(wave.mode)));
        branch.update_survival(least_power);
        put(branch, wave.side);
        self.recorder.went_on(from, branch.path, largest(&branch.power))
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
        self.comes_before_screen(position, direction, hit.1.distance).then_some(hit)
    }

    /// Whether a ray comes so far before it meets the screen: of two that touch, that is met.
    fn comes_before_screen(&self, position: DVec3, direction: DVec3, distance: f64) -> bool {
        let screen = self.screen.as_ref();
        let screen = screen.and_then(|screen| screen.hit(position, direction, 0.0));
        let slack = if self.screen_touches { slack_at(position) } else { 0.0 };
        screen.is_none_or(|to_screen| distance + slack < to_screen)
    }

    fn film<'f>(&self, between: Between<'f>) -> Film<'f> {
        let layers = match between {
            Between::Films(layers) => layers,
            Between::Nothing | Between::PerfectCoating => [&[][..]; 2],
        };
        Film { layers, wave_number: self.assembly.vacuum_wave_number }
    }

    pub(super) fn split(
        &mut self,
        from: &Medium,
        to: &Medium,
        branch: &Branch<N>,
        interface: &Interface<'_>,
        waves: &mut OutgoingWaves<N>,
    ) {
        if branch.wave_vector.length_squared() > SHORTEST_WAVE {
            self.cut(branch.power);
            return;
        }
        let wave = branch.incident();
        let mut weak = [0.0; N];
        let normal = interface.onward;
        match interface.between {
            Between::Nothing => {
                weak = split_down_to(from, to, &wave, normal, self.limits.min_power, waves);
            }
            Between::PerfectCoating => {
                waves.extend(transmit_antireflection(from, to, &wave, normal));
            }
            Between::Films(_) => return self.split_coated(from, to, branch, interface, waves),
        }
        self.check_account(branch, waves, weak, from.absorbs() || to.absorbs());
    }

    /// Splits a branch where films are between the media.
    #[cold]
    fn split_coated(
        &mut self,
        from: &Medium,
        to: &Medium,
        branch: &Branch<N>,
        interface: &Interface<'_>,
        waves: &mut OutgoingWaves<N>,
    ) {
        let beyond = (self.film(interface.between), Backing::Medium(to));
        let (wave, normal) = (branch.incident(), interface.onward);
        let weak = split_coated(from, beyond, &wave, normal, self.limits.min_power, waves);
        let absorbing = from.absorbs() || to.absorbs() || interface.between.absorbs();
        self.check_account(branch, waves, weak, absorbing);
    }
}
