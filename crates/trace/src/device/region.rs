//! Regions of a device, each filled with one medium.

use super::{
    ClosedFormRegion, Coating, Convex, DispersiveMedium, DispersiveTensors, FarSide, SpatialRegion,
};
use glam::{DMat3, DVec2, DVec3};
use optics::geometry::{Lens, Plane, Polyhedron};
use optics::medium::{Medium, ModeKind};
use optics::propagation::{
    Border, Boundary, ConformalEnd, ConformalFlow, FlowError, Half, PathEnd, PathPoint, RadialFlow,
    VirtualPoint,
};
use optics::wave::ComplexVector;
use std::sync::Arc;

/// Rays whose sine of the angle with a plane is less do not come to it: so far away they would.
const LEAST_APPROACH: f64 = 1e-3;

/// Straight pieces that a closed form's path is drawn with.
const PIECES: u32 = 96;

/// A region filled with one medium.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "a device has few cells, and they are met often")]
pub enum Region {
    /// A convex region or a lens of a homogeneous medium, in which rays are straight.
    Homogeneous(HomogeneousRegion),
    /// One half of a cut conformal map, of graded index.
    Conformal(ConformalRegion),
    /// A ball or a round cylinder of a radially symmetric medium, whole or hollow.
    Radial(RadialRegion),
    /// A convex region of a graded medium whose rays are known in closed form.
    ClosedForm(ClosedFormRegion),
    /// A convex region of a medium that is given on a grid in space.
    Spatial(SpatialRegion),
}

/// A radially symmetric medium about the origin or the z axis.
#[derive(Clone, Copy, Debug)]
pub struct RadialRegion {
    /// How rays run in it.
    pub flow: RadialFlow,
    /// What lies beyond its inner border, if it has one.
    pub inner: FarSide,
    /// How the medium meets what is outside.
    pub coating: Coating,
}

/// One half of a cut conformal map above its mirror.
#[derive(Clone, Debug)]
pub struct ConformalRegion {
    /// How rays run in it.
    pub flow: ConformalFlow,
    /// Which half it is.
    pub half: Half,
    /// What lies beyond its floor.
    pub floor: FarSide,
    /// What lies in its round core, if it has one.
    pub core: FarSide,
    /// How the medium meets the air.
    pub coating: Coating,
    /// Imaginary over real part of its permittivity.
    pub loss_tangent: f64,
}

/// A convex region or a lens filled with a homogeneous medium.
#[derive(Clone, Debug)]
pub struct HomogeneousRegion {
    /// What fills it.
    pub medium: Medium,
    /// How the medium depends on the frequency; `None`: as the dispersion of the device says.
    pub law: Option<DispersiveTensors>,
    /// How it does at the least dispersion that causality allows; `None` where it absorbs.
    pub least_dispersive: Option<DispersiveTensors>,
    /// The speed of light over that of a pulse, which comes before all these; absent: as they say.
    pub group_index: Option<f64>,
    /// Where it ends.
    pub border: RegionBorder,
    /// How the medium meets what is outside of a convex shape or a lens; faces say it each for itself.
    pub coating: Coating,
}

/// Where a homogeneous region ends.
#[derive(Clone, Debug)]
pub enum RegionBorder {
    /// At planes.
    Faces(Vec<Face>),
    /// At the border of a convex shape, with what is outside beyond it.
    Convex(Convex),
    /// At the border of a lens, with what is outside beyond it.
    Lens(Lens),
    /// At the faces of a solid, with what is outside beyond them.
    Polyhedron(Arc<Polyhedron>),
}

/// One bounding plane of a region.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// The plane, its normal pointing out of the region.
    pub plane: Plane,
    /// What lies beyond it.
    pub far: FarSide,
    /// Where the face ends, if the next one goes on in its plane: the coordinate (cm) along z ×
    /// normal. Infinite for the last face in its plane.
    pub until: f64,
    /// How the media meet there.
    pub coating: Coating,
    /// From where to where it runs in the plane z = 0, counterclockwise around the region, for
    /// drawings.
    pub side: Option<[DVec2; 2]>,
}

impl Face {
    /// A whole plane face.
    #[must_use]
    pub fn new(plane: Plane, far: FarSide) -> Self {
        Self { plane, far, until: f64::INFINITY, coating: Coating::None, side: None }
    }
}

/// A ray in a region, at a point of it or of its border.
#[derive(Clone, Copy, Debug)]
pub struct InnerRay {
    /// Where it is.
    pub position: DVec3,
    /// Its wave vector.
    pub wave_vector: DVec3,
    /// Its unit vector, that of the Poynting vector.
    pub direction: DVec3,
    /// Which of the medium's waves it is.
    pub mode: ModeKind,
    /// What [`Region::enter`] or the last passage has said of the point.
    pub virtual_point: Option<VirtualPoint>,
}

/// A ray's way through a region to the surface where it ends.
#[derive(Clone, Copy, Debug)]
pub struct Passage {
    /// The point on the surface.
    pub position: DVec3,
    /// The wave vector there.
    pub wave_vector: DVec3,
    /// The unit vector of the ray there.
    pub direction: DVec3,
    /// What has taken the electric field along, |Re(E × H*)| being kept; `None` in homogeneous
    /// media, where the field stays as it is.
    pub transport: Option<DMat3>,
    /// Optical path length, cm.
    pub optical_path: f64,
    /// The speed of light times what a pulse takes at the least dispersion that causality allows, cm,
    /// where it was asked for and is known from the way itself.
    pub group_path: Option<f64>,
    /// ∫ Im n ds along a bent way through a medium that absorbs, cm.
    pub extinction: f64,
    /// The point in the virtual space of a conformal region, to go on from after a reflection.
    pub virtual_point: Option<VirtualPoint>,
    /// Which surface.
    pub face: u16,
    /// The unit normal of the surface, out of the region.
    pub outward: DVec3,
    /// What lies beyond.
    pub far: FarSide,
    /// How the media meet there.
    pub coating: Coating,
}

/// Why a ray does not get to the next surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoPassage {
    /// It has been lost in rounding at an edge, or an integration failed.
    Lost,
    /// A graded medium keeps it for longer than it can be followed.
    Endless,
}

impl Region {
    /// What a ray finds that enters the region at a point of its border: the point in the virtual
    /// space of a conformal region, and the medium, see [`Region::medium`]. `None` if a conformal
    /// map has no such point: it has been lost in rounding at an edge.
    #[must_use]
    #[inline]
    pub fn enter<'m>(
        &'m self,
        position: DVec3,
        local: &'m mut Option<Medium>,
    ) -> Option<(Option<VirtualPoint>, &'m Medium)> {
        let virtual_point = match self {
            Self::Homogeneous(_) | Self::Radial(_) | Self::ClosedForm(_) | Self::Spatial(_) => None,
            Self::Conformal(region) => Some(region.flow.virtual_point(region.half, position).ok()?),
        };
        Some((virtual_point, self.medium(position, virtual_point.as_ref(), local)?))
    }

    /// The medium at a point of the region or its border, `virtual_point` being what
    /// [`Region::enter`] or the last passage has said of it; `None` if there is none by rounding.
    /// That of a graded region is put into `local`: media are large, and those of homogeneous
    /// regions are not copied.
    #[must_use]
    #[inline]
    pub fn medium<'m>(
        &'m self,
        position: DVec3,
        virtual_point: Option<&VirtualPoint>,
        local: &'m mut Option<Medium>,
    ) -> Option<&'m Medium> {
        *local = match self {
            Self::Homogeneous(region) => return Some(&region.medium),
            Self::Conformal(_) => {
                virtual_point.map(|virtual_point| Medium::dielectric(virtual_point.index))
            }
            Self::Radial(region) => region.flow.medium(position),
            Self::ClosedForm(region) => Some(region.medium(position)),
            Self::Spatial(region) => region.flow.medium().at(position),
        };
        local.as_ref()
    }

    /// The speed of light times the time that a pulse takes on the way of a ray to `end`, cm;
    /// `electric` is a field of the ray, of any size. `pulses` is as for [`Region::advance`], but that media of one
    /// group index or of a law of their own have that without it. NaN in media that absorb, if `pulses` is given.
    #[must_use]
    pub fn group_path(
        &self,
        ray: &InnerRay,
        electric: ComplexVector,
        end: &Passage,
        pulses: Option<f64>,
    ) -> f64 {
        let straight = (end.position - ray.position).length();
        if let Self::Homogeneous(HomogeneousRegion { group_index: Some(index), .. }) = self {
            return index * straight;
        }
        let by_law = |medium: &Medium, law: &DispersiveTensors| {
            let derivatives = [&law.permittivity, &law.permeability];
            straight * medium.group_index(ray.wave_vector, electric, derivatives)
        };
        if let Self::Homogeneous(HomogeneousRegion { law: Some(law), medium, .. }) = self {
            return by_law(medium, law);
        }
        let Some(tolerance) = pulses else {
            // Where the phase runs backwards a pulse does not.
            let backwards = straight.max(-end.optical_path);
            return if end.optical_path < 0.0 { backwards } else { end.optical_path };
        };
        match self {
            Self::Homogeneous(HomogeneousRegion { least_dispersive, medium, .. }) => {
                least_dispersive.as_ref().map_or(f64::NAN, |law| by_law(medium, law))
            }
            Self::Conformal(_) => end.group_path.unwrap_or(f64::NAN),
            Self::Radial(region) if region.inner == FarSide::Outside && region.turns_back(ray) => {
                0.0
            }
            Self::Radial(region) => {
                let InnerRay { position, wave_vector, mode, .. } = *ray;
                region.flow.causal_group_path(position, wave_vector, mode, tolerance)
            }
            Self::ClosedForm(region) => region.causal_group_path(ray, tolerance),
            Self::Spatial(region) => region.causal_group_path(ray, tolerance),
        }
    }

    /// The same at points of the way ([`Region::path`]) of a ray in one of the waves, all of which takes a pulse
    /// `whole`: for drawings. Piece by piece it is as long as the group index in the middle of each has it, in
    /// proportion.
    #[must_use]
    pub fn group_paths(
        &self,
        path: &[PathPoint],
        mode: ModeKind,
        whole: f64,
        disperses: bool,
    ) -> Vec<f64> {
        let piece = |pair: &[PathPoint]| {
            let way = pair[1].position - pair[0].position;
            let optical = (pair[1].optical_path - pair[0].optical_path).abs();
            let (length, middle) = (way.length(), pair[0].position.midpoint(pair[1].position));
            if self.is_homogeneous() || length == 0.0 {
                return length;
            }
            if !disperses {
                return optical;
            }
            let ray = way / length;
            let mut local = None;
            let waves = self.medium(middle, None, &mut local).map(|medium| {
                let waves = medium.waves_along_ray(ray);
                let own = waves.iter().find(|wave| wave.kind == mode).or(waves.first())?;
                let electric = own.electric.unwrap_or_else(|| ray.any_orthonormal_vector().into());
                Some(medium.causal_group_index(own.wave_vector, electric))
            });
            // Of an isotropic medium it is n or 1/n, whichever is larger.
            let isotropic = (optical / length).max(length / optical);
            length * waves.flatten().filter(|index| index.is_finite()).unwrap_or(isotropic)
        };
        let mut sum = 0.0;
        let mut paths: Vec<f64> = [0.0]
            .into_iter()
            .chain(path.windows(2).map(|pair| {
                sum += piece(pair);
                sum
            }))
            .collect();
        for path in &mut paths {
            // On no way at all it takes no time.
            *path = if sum > 0.0 { whole * (*path / sum) } else { 0.0 };
        }
        paths
    }

    /// Where the waves of the medium start as one and then part: their electric fields, of unit
    /// power. None where the ray is one of them already.
    #[must_use]
    pub fn parted(&self, ray: &InnerRay) -> Option<[(ModeKind, DVec3); 2]> {
        let InnerRay { position, wave_vector, mode, .. } = *ray;
        match self {
            Self::Homogeneous(_) | Self::Conformal(_) | Self::ClosedForm(_) => None,
            Self::Radial(region) => {
                (mode == ModeKind::Shared).then(|| region.flow.parted(position, wave_vector))?
            }
            Self::Spatial(region) => {
                let one_of_two = matches!(mode, ModeKind::Ordinary | ModeKind::Extraordinary);
                (!one_of_two).then(|| region.flow.parted(position, wave_vector))?
            }
        }
    }

    /// Follows a ray from a point of the region or its border to the next surface.
    ///
    /// `tolerance` (cm) bounds the error of position and optical path where the way is integrated. `pulses` is to
    /// within how much (cm) it is to be known what a pulse takes, `None` if that is as the phase or not asked for; the
    /// passage says it where the way tells it.
    ///
    /// # Errors
    ///
    /// [`NoPassage`].
    pub fn advance(
        &self,
        ray: &InnerRay,
        tolerance: f64,
        pulses: Option<f64>,
    ) -> Result<Passage, NoPassage> {
        let passage = match self {
            Self::Homogeneous(region) => region.advance(ray),
            Self::Conformal(region) => {
                let [passage, ..] =
                    region.advance_four(&[Some(*ray), None, None, None], tolerance, pulses);
                return passage.unwrap_or(Err(NoPassage::Lost));
            }
            Self::Radial(region) => region.advance(ray),
            Self::ClosedForm(region) => region.advance(ray),
            Self::Spatial(region) => return region.advance(ray, tolerance),
        };
        passage.ok_or(NoPassage::Lost)
    }

    /// The planes that bound it, if it is homogeneous and between planes; else none.
    #[must_use]
    pub fn faces(&self) -> &[Face] {
        match self {
            Self::Homogeneous(region) => region.faces(),
            _ => &[],
        }
    }

    /// As [`Region::advance`], but in a homogeneous medium between planes, to that one of them as if
    /// there were no others: further on than the border of the region, or back. Nothing where the
    /// ray does not come to it.
    #[must_use]
    pub(crate) fn passage_to_plane(&self, ray: &InnerRay, index: u16) -> Option<Passage> {
        let face = self.faces().get(usize::from(index))?;
        let InnerRay { position, direction, .. } = *ray;
        let approach = direction.dot(face.plane.normal);
        let distance = (face.plane.offset - face.plane.normal.dot(position)) / approach;
        (approach > LEAST_APPROACH).then(|| {
            let end = face.plane.project(position + direction * distance);
            let passage = Passage::straight(ray, end, index, face.plane.normal, face.far);
            Passage { coating: face.coating, ..passage }
        })
    }

    /// Which of the planes around a homogeneous medium a ray meets, if it would be the same one from
    /// wherever within `slack` (cm) of where it is. It may start beyond planes: the distances to those
    /// are negative, and the least counts. So parallel rays that meet one plane and those that meet
    /// another are on two sides of one straight line, however far they are from the region.
    #[must_use]
    pub(crate) fn plane_met(&self, ray: &InnerRay, slack: f64) -> Option<u16> {
        let mut nearest: Option<(u16, &Face, [f64; 2])> = None;
        let mut others = f64::INFINITY;
        for (index, face) in (0u16..).zip(self.faces()) {
            let Face { plane, .. } = face;
            let approach = ray.direction.dot(plane.normal);
            // Faces of one plane come one after the other.
            let is_known = nearest.is_some_and(|(_, before, _)| before.plane == *plane);
            if is_known || approach <= f64::EPSILON {
                continue;
            }
            let distance = (plane.offset - plane.normal.dot(ray.position)) / approach;
            let doubt = slack / approach;
            if nearest.is_none_or(|(.., [least, _])| distance < least) {
                if let Some((.., [distance, doubt])) = nearest {
                    others = others.min(distance - doubt);
                }
                nearest = Some((index, face, [distance, doubt]));
            } else {
                others = others.min(distance - doubt);
            }
        }
        let (mut index, mut face, [distance, doubt]) = nearest?;
        let end = ray.position + ray.direction * distance;
        let along = DVec3::Z.cross(face.plane.normal).dot(end);
        let mut is_clear = distance + doubt <= others;
        while face.until < along {
            is_clear &= along - face.until >= doubt;
            index += 1;
            face = self.faces().get(usize::from(index))?;
        }
        (is_clear && face.until - along >= doubt).then_some(index)
    }

    /// As [`Region::advance`], up to four rays at once: see [`Region::takes_four`]. Each gets what
    /// it would get alone.
    #[must_use]
    pub fn advance_four(
        &self,
        rays: &[Option<InnerRay>; 4],
        tolerance: f64,
        pulses: Option<f64>,
    ) -> [Option<Result<Passage, NoPassage>>; 4] {
        match self {
            Self::Homogeneous(_) | Self::Radial(_) | Self::ClosedForm(_) | Self::Spatial(_) => {
                rays.map(|ray| ray.map(|ray| self.advance(&ray, tolerance, pulses)))
            }
            Self::Conformal(region) => region.advance_four(rays, tolerance, pulses),
        }
    }

    /// Whether four rays go through the region at once hardly slower than one.
    #[must_use]
    pub fn takes_four(&self) -> bool {
        matches!(self, Self::Conformal(_))
    }

    /// Whether rays are followed step by step through it.
    #[must_use]
    pub fn is_integrated(&self) -> bool {
        matches!(self, Self::Conformal(_) | Self::Spatial(_))
    }

    /// Whether rays run straight through it.
    #[must_use]
    pub fn is_homogeneous(&self) -> bool {
        matches!(self, Self::Homogeneous(_))
    }

    /// Which closed form gives the waves of its medium ([`Medium::class_name`]), or `graded`.
    #[must_use]
    pub fn medium_class(&self) -> &'static str {
        match self {
            Self::Homogeneous(region) => region.medium.class_name(),
            Self::Conformal(_) | Self::Radial(_) | Self::ClosedForm(_) | Self::Spatial(_) => {
                "graded"
            }
        }
    }

    /// Points along the way that [`Region::advance`] takes to `end`, with the optical path from its
    /// start: for drawings. Without those between where they cannot be had.
    #[must_use]
    pub fn path(&self, ray: &InnerRay, end: &Passage, tolerance: f64) -> Vec<PathPoint> {
        let ends = || {
            let start = PathPoint { position: ray.position, optical_path: 0.0 };
            vec![start, PathPoint { position: end.position, optical_path: end.optical_path }]
        };
        match self {
            Self::Homogeneous(_) => ends(),
            Self::Conformal(region) => {
                let path = |start| region.flow.path(&start, ray.wave_vector, tolerance).ok();
                region.start(ray).and_then(path).unwrap_or_else(ends)
            }
            Self::Radial(region) if region.inner == FarSide::Outside && region.turns_back(ray) => {
                ends()
            }
            Self::Radial(region) => {
                region.flow.path(ray.position, ray.wave_vector, ray.mode, PIECES)
            }
            Self::ClosedForm(region) => region.path(ray, PIECES),
            Self::Spatial(region) => region.path(ray, tolerance).unwrap_or_else(ends),
        }
    }
}

impl HomogeneousRegion {
    /// A region of a medium, without films.
    #[must_use]
    pub fn new(DispersiveMedium { medium, law }: DispersiveMedium, border: RegionBorder) -> Self {
        let least_dispersive = medium
            .least_dispersive()
            .map(|[permittivity, permeability]| DispersiveTensors { permittivity, permeability });
        Self { medium, law, least_dispersive, group_index: None, border, coating: Coating::None }
    }

    /// A region between bare planes.
    #[must_use]
    pub fn between(medium: Medium, faces: Vec<Face>) -> Self {
        Self::new(medium.into(), RegionBorder::Faces(faces))
    }

    /// The planes that bound it; none where it is bounded otherwise.
    #[must_use]
    pub fn faces(&self) -> &[Face] {
        match &self.border {
            RegionBorder::Faces(faces) => faces,
            RegionBorder::Convex(_) | RegionBorder::Lens(_) | RegionBorder::Polyhedron(_) => &[],
        }
    }

    /// The way of a ray out of the region, which ends at that distance.
    #[inline]
    fn out(&self, ray: &InnerRay, distance: f64, face: u16, outward: DVec3) -> Passage {
        let end = ray.position + ray.direction * distance;
        let passage = Passage::straight(ray, end, face, outward, FarSide::Outside);
        Passage { coating: self.coating, ..passage }
    }

    fn advance(&self, ray: &InnerRay) -> Option<Passage> {
        let InnerRay { position, direction, .. } = *ray;
        let faces = match &self.border {
            RegionBorder::Faces(faces) => faces,
            RegionBorder::Convex(shape) => {
                let (distance, outward) = shape.exit(position, direction)?;
                return Some(self.out(ray, distance, 0, outward));
            }
            RegionBorder::Lens(lens) => {
                let (distance, part, outward) = lens.exit(position, direction)?;
                return Some(self.out(ray, distance, part as u16, outward));
            }
            RegionBorder::Polyhedron(solid) => {
                let hit = solid.exit(position, direction)?;
                // Faces 65536 apart in number are no neighbours.
                return Some(self.out(ray, hit.distance, hit.face as u16, hit.outward));
            }
        };
        // A loop: here it takes fewer instructions than `first_along`.
        let mut nearest: Option<(u16, &Face, f64)> = None;
        for (index, face) in (0u16..).zip(faces) {
            if let Some(distance) = face.plane.distance(position, direction)
                && nearest.is_none_or(|(_, _, least)| distance < least)
            {
                nearest = Some((index, face, distance));
            }
        }
        let (mut index, mut face, distance) = nearest?;
        // On the plane to the last bit: what is off along the normal would show in the optical
        // path.
        let end = face.plane.project(position + direction * distance);
        while face.until < DVec3::Z.cross(face.plane.normal).dot(end) {
            index += 1;
            face = faces.get(usize::from(index))?;
        }
        let passage = Passage::straight(ray, end, index, face.plane.normal, face.far);
        Some(Passage { coating: face.coating, ..passage })
    }
}

impl Passage {
    /// A straight way through a homogeneous medium to a point `end` of a bare surface.
    #[must_use]
    pub fn straight(ray: &InnerRay, end: DVec3, face: u16, outward: DVec3, far: FarSide) -> Self {
        Self {
            position: end,
            wave_vector: ray.wave_vector,
            direction: ray.direction,
            transport: None,
            optical_path: ray.wave_vector.dot(end - ray.position),
            group_path: None,
            extinction: 0.0,
            virtual_point: None,
            face,
            outward,
            far,
            coating: Coating::None,
        }
    }

    /// A way through a graded medium to a bare surface.
    #[must_use]
    #[inline]
    pub fn graded<S, V>(ray: &InnerRay, end: &PathEnd<S, V>, face: u16, far: FarSide) -> Self {
        Self {
            wave_vector: end.wave_vector,
            direction: end.direction,
            transport: Some(end.transport),
            optical_path: end.optical_path,
            group_path: end.group_path,
            ..Self::straight(ray, end.position, face, end.outward, far)
        }
    }
}

impl ConformalRegion {
    /// One half of a bare map of an ideal medium, without a round core.
    #[must_use]
    pub fn new(flow: ConformalFlow, half: Half, floor: FarSide) -> Self {
        let (core, coating) = (FarSide::Outside, Coating::None);
        Self { flow, half, floor, core, coating, loss_tangent: 0.0 }
    }

    /// Where a ray is in virtual space.
    fn start(&self, ray: &InnerRay) -> Option<VirtualPoint> {
        let here = || self.flow.virtual_point(self.half, ray.position).ok();
        ray.virtual_point.or_else(here)
    }

    fn advance_four(
        &self,
        rays: &[Option<InnerRay>; 4],
        tolerance: f64,
        pulses: Option<f64>,
    ) -> [Option<Result<Passage, NoPassage>>; 4] {
        let starts = rays.map(|ray| Some((self.start(&ray?)?, ray?.wave_vector)));
        // Where light is absorbed there is no such time.
        let pulses = pulses.filter(|_| self.loss_tangent == 0.0);
        let ends = self.flow.advance_four(&starts, tolerance, pulses);
        std::array::from_fn(|i| {
            let ray = rays[i].as_ref()?;
            Some(match ends[i].as_ref() {
                Some(Ok(end)) => Ok(self.passage(ray, end)),
                Some(Err(FlowError::StepLimit)) => Err(NoPassage::Endless),
                Some(Err(_)) | None => Err(NoPassage::Lost),
            })
        })
    }

    fn passage(&self, ray: &InnerRay, end: &ConformalEnd) -> Passage {
        let far = match end.surface {
            Boundary::Floor => self.floor,
            Boundary::Core => self.core,
            // Below the floor's level, in the troughs of a grating, the ends are metal.
            Boundary::XMin | Boundary::XMax
                if self.half.mirrored(end.position).y < self.flow.map().level() =>
            {
                if self.floor.is_metal() { self.floor } else { FarSide::Conductor }
            }
            _ => FarSide::Outside,
        };
        Passage {
            // Im n = n tan δ/2 to first order.
            extinction: 0.5 * self.loss_tangent * end.optical_path,
            virtual_point: Some(end.virtual_point),
            coating: if far.is_metal() { Coating::None } else { self.coating },
            ..Passage::graded(ray, end, end.surface as u16, far)
        }
    }
}

/// How far from the core, relative to its radius, rounding may put a ray that comes out of it.
const AT_CORE: f64 = 1e-12;

impl RadialRegion {
    fn advance(&self, ray: &InnerRay) -> Option<Passage> {
        if self.inner == FarSide::Outside && self.turns_back(ray) {
            return Some(self.back_into_core(ray));
        }
        let end = self.flow.advance(ray.position, ray.wave_vector, ray.mode);
        let sound = end.position.is_finite() && end.wave_vector.is_finite();
        let far = if end.surface == Border::Inner { self.inner } else { FarSide::Outside };
        let coating = if far == FarSide::Outside { self.coating } else { Coating::None };
        sound.then(|| Passage { coating, ..Passage::graded(ray, &end, end.surface as u16, far) })
    }

    /// Whether a ray has come out of an open core into a wave that no ray of the core can be in but
    /// those in a plane through the axis, or aimed at the centre, to the last digits: the medium is
    /// singular there.
    fn turns_back(&self, ray: &InnerRay) -> bool {
        let [core, _] = self.flow.radii();
        let outward = self.flow.outward(ray.position);
        self.flow.closes_core(ray.mode)
            && ray.position.dot(outward) <= core * (1.0 + AT_CORE)
            && ray.direction.dot(outward) > 0.0
    }

    /// The way of such a ray, which gets the limit: all its neighbours are reflected.
    fn back_into_core(&self, ray: &InnerRay) -> Passage {
        let outward = self.flow.outward(ray.position);
        let turned = |v: DVec3| v - outward * (2.0 * v.dot(outward));
        Passage {
            wave_vector: turned(ray.wave_vector),
            direction: turned(ray.direction),
            transport: Some(DMat3::from_cols(turned(DVec3::X), turned(DVec3::Y), turned(DVec3::Z))),
            optical_path: 0.0,
            // It has met the border already.
            coating: Coating::Antireflection,
            ..Passage::straight(ray, ray.position, Border::Inner as u16, -outward, self.inner)
        }
    }
}
