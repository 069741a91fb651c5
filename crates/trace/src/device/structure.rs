//! What every device is made of: regions filled with media, and the surfaces that light outside of
//! it meets.

use super::{Convex, Region, Shape, Surface};
use glam::DVec3;
use optics::geometry::{Extent, FloorCurve, Hole, Outline, Pose, Solid};
use optics::interface::FilmLayer;
use optics::medium::Medium;
use std::collections::BTreeMap;

/// What lies on the other side of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FarSide {
    /// What is around the device there.
    Outside,
    /// The device's region of that number.
    Region(u16),
    /// The device's region of that number, of the same medium: the surface is a cut, and no
    /// interface.
    Seam(u16),
    /// A perfect conductor.
    Conductor,
    /// The device's metal of that number, which keeps what it does not reflect.
    Metal(u16),
    /// An opaque body: rays end on it.
    Opaque,
    /// A polarizer: what its surface passes goes on through what is around the device.
    Polarizer,
}

impl FarSide {
    /// Whether it is metal.
    #[must_use]
    pub fn is_metal(self) -> bool {
        matches!(self, Self::Conductor | Self::Metal(_))
    }
}

/// How two media meet at a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coating {
    /// Refraction and reflection as the media ask for.
    None,
    /// Refraction alone: a perfect antireflection coating.
    Antireflection,
    /// Layers between them: the device's film of that number.
    Film(u16),
}

/// A device in its own frame.
#[derive(Clone, Debug)]
pub struct Structure {
    /// The regions filled with media.
    pub regions: Vec<Region>,
    /// The surfaces that light outside can meet.
    pub surfaces: Vec<Surface>,
    /// The space the device takes up.
    pub hull: Hull,
    /// The layers on its surfaces, in the order in which light meets them that comes to the
    /// surface.
    pub films: Vec<Vec<FilmLayer>>,
    /// Its metals that are no perfect conductors.
    pub metals: Vec<Medium>,
}

/// What makes a device a body: other bodies may stand in it, and other devices if it is filled with
/// a medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Its shape, about the origin of its frame.
    pub shape: Convex,
    /// Where bodies overlap, the one of the larger priority is there.
    pub priority: i64,
}

/// The space a device takes up.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    /// The solids that it fills.
    pub solids: Vec<Solid>,
    pub(super) reach: Reach,
    /// The sheet of its thin mirror, if it has one.
    pub thin_mirror: Option<Solid>,
    /// Bare metal below a floor: it holds only that part of the solids.
    pub metal: Option<FloorCurve>,
    /// The body that it is the hull of, which may overlap other bodies.
    pub body: Option<Body>,
    /// The device together with its hidden region, where that is air, and free.
    pub filled: Option<Solid>,
}

/// What holds a hull, about the origin or the z axis of the device's frame: rays that miss it miss
/// the device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reach {
    Nothing,
    Cylinder(f64),
    Ball(f64),
}

impl Reach {
    fn of(solid: &Solid) -> Self {
        let (shape, radius): (fn(f64) -> Self, f64) = match solid {
            Solid::Nothing => return Self::Nothing,
            Solid::Prism { outline, .. } => (Self::Cylinder, outline.radius()),
            Solid::Cylinder { centre, radius, .. } => (Self::Cylinder, centre.length() + radius),
            Solid::Ball { centre, radius } => (Self::Ball, centre.length() + radius),
            Solid::CutBall { centre, ball } => (Self::Ball, centre.length() + ball.sphere.radius),
            Solid::Hollow { whole, .. } => return Self::of(whole),
            Solid::Lens { lens, pose } => {
                (Self::Ball, lens.farthest_from(pose.to_local(DVec3::ZERO)))
            }
            Solid::Tilted { .. } | Solid::Polyhedron { .. } => {
                let Some([low, high]) = solid.bounds() else { return Self::Nothing };
                (Self::Ball, low.abs().max(high.abs()).length())
            }
        };
        shape(radius * GRAZING)
    }

    /// What holds both.
    fn joined(self, other: Self) -> Self {
        match (self, other) {
            (Self::Nothing, reach) | (reach, Self::Nothing) => reach,
            (Self::Ball(a), Self::Ball(b)) => Self::Ball(a.max(b)),
            (Self::Ball(a) | Self::Cylinder(a), Self::Ball(b) | Self::Cylinder(b)) => {
                Self::Cylinder(a.max(b))
            }
        }
    }
}

/// Rays that graze a hull by rounding still count as near it.
const GRAZING: f64 = 1.0 + 1e-12;

impl Hull {
    /// The hull of a device that fills a body.
    #[must_use]
    pub fn new(solid: Solid) -> Self {
        Self::of_parts(vec![solid])
    }

    /// The hull of a device of several parts, which leaves the space between them free.
    #[must_use]
    pub fn of_parts(solids: Vec<Solid>) -> Self {
        let reach = solids.iter().map(Reach::of).fold(Reach::Nothing, Reach::joined);
        Self { solids, reach, thin_mirror: None, metal: None, body: None, filled: None }
    }

    /// The hull with a thin mirror as well, such as a floor, on a line of two corners: it holds
    /// nothing, and the photograph may stand across it.
    #[must_use]
    pub fn with_thin_mirror(self, line: Outline, extent: Extent) -> Self {
        let sheet = Solid::Prism { outline: line, extent };
        let reach = self.reach.joined(Reach::of(&sheet));
        Self { thin_mirror: Some(sheet), reach, ..self }
    }

    /// The hull of a cloak around a hidden region that is air, and free: `filled` without `hole`.
    #[must_use]
    pub fn around(hole: Hole, filled: Solid) -> Self {
        Self { filled: Some(filled.clone()), ..Self::new(filled.with_hole(hole)) }
    }

    /// Whether it is one convex body: light that has left it does not come back by itself.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        let convex = |solid: &Solid| match solid {
            Solid::Hollow { .. } => false,
            Solid::Lens { lens, .. } => lens.is_convex(),
            Solid::Polyhedron { solid, .. } => solid.is_convex(),
            _ => true,
        };
        matches!(&self.solids[..], [solid] if convex(solid))
            && self.thin_mirror.is_none()
            && self.metal.is_none()
            && self.filled.is_none()
    }

    /// Whether a ray (in the device's frame) comes near enough that it may meet the device.
    #[must_use]
    pub fn may_be_met(&self, origin: DVec3, direction: DVec3) -> bool {
        // The closest approach to the axis or the centre, if it lies ahead; else the origin itself.
        match self.reach {
            Reach::Nothing => false,
            Reach::Cylinder(radius) => {
                let (o, d) = (origin.truncate(), direction.truncate());
                let beside = d.perp_dot(o);
                let reach = radius * radius;
                beside * beside <= reach * d.length_squared()
                    && (o.dot(d) <= 0.0 || o.length_squared() <= reach)
            }
            Reach::Ball(radius) => {
                let beside = direction.cross(origin);
                let reach = radius * radius;
                beside.length_squared() <= reach * direction.length_squared()
                    && (origin.dot(direction) <= 0.0 || origin.length_squared() <= reach)
            }
        }
    }

    /// Whether a point (in the device's frame) lies inside, border excluded.
    #[must_use]
    pub fn holds(&self, point: DVec3) -> bool {
        let inside = self.solids.iter().any(|solid| solid.holds(point));
        inside && self.metal.as_ref().is_none_or(|metal| metal.contains(point.truncate()))
    }

    /// The solids with an open core filled.
    fn filled_solids(&self) -> impl Iterator<Item = &Solid> {
        self.filled.iter().chain(self.solids.iter().filter(|_| self.filled.is_none()))
    }

    /// Whether a point (in the device's frame) is of the device or of its hidden region, border
    /// included.
    #[must_use]
    pub fn spans(&self, point: DVec3) -> bool {
        self.filled_solids().any(|solid| solid.contains(point))
            && self.metal.as_ref().is_none_or(|metal| metal.contains(point.truncate()))
    }

    /// The axes of the device's frame along which it has no end and never changes, as ones among zeros.
    #[must_use]
    pub fn endless_axes(&self) -> DVec3 {
        if let Some(Body { shape: Convex::Box { half }, .. }) = self.body {
            return DVec3::select(half.is_finite_mask(), DVec3::ZERO, DVec3::ONE);
        }
        let parts = self.solids.iter().chain(&self.filled).chain(&self.thin_mirror);
        parts.filter_map(Solid::bounds).fold(DVec3::ONE, |axes, [low, high]| {
            let has_an_end = low.is_finite_mask() | high.is_finite_mask();
            DVec3::select(has_an_end, DVec3::ZERO, axes)
        })
    }

    /// The least and the greatest coordinates of what it spans when it is at a place, infinite (or
    /// very large) where it has no end; `None` if it spans nothing.
    #[must_use]
    pub fn bounds(&self, pose: &Pose) -> Option<[DVec3; 2]> {
        let bounds = self.filled_solids().filter_map(|solid| solid.placed(pose).bounds());
        bounds.reduce(|[low, high], [from, to]| [low.min(from), high.max(to)])
    }
}

impl Structure {
    /// A structure without coatings, its metal being a perfect conductor.
    #[must_use]
    pub fn new(regions: Vec<Region>, surfaces: Vec<Surface>, hull: Hull) -> Self {
        Self { regions, surfaces, hull, films: Vec::new(), metals: Vec::new() }
    }

    /// A structure without anything: a cloak whose "mirror" view is empty space.
    #[must_use]
    pub fn empty() -> Self {
        Self::new(Vec::new(), Vec::new(), Hull::of_parts(Vec::new()))
    }

    /// How many of its segments are of which class of media: see [`Region::medium_class`].
    #[must_use]
    pub fn media(&self) -> BTreeMap<&'static str, usize> {
        let mut media = BTreeMap::new();
        for (number, first) in segments(&self.regions).into_iter().enumerate() {
            if number == first {
                *media.entry(self.regions[number].medium_class()).or_default() += 1;
            }
        }
        media
    }

    /// Its homogeneous media: those of regions, of films and of metals.
    pub fn homogeneous_media(&self) -> impl Iterator<Item = &Medium> {
        let films = self.films.iter().flatten().map(|layer| &layer.medium);
        let regions = self.regions.iter().filter_map(|region| match region {
            Region::Homogeneous(region) => Some(&region.medium),
            _ => None,
        });
        regions.chain(films).chain(&self.metals)
    }

    /// Whether it is an opaque body.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.surfaces.iter().any(|surface| surface.far == FarSide::Opaque)
    }

    /// Whether it is nothing but metal.
    #[must_use]
    pub fn is_metal(&self) -> bool {
        self.regions.is_empty() && self.surfaces.iter().any(|surface| surface.far.is_metal())
    }

    /// Whether it is a polarizer, which stands in air.
    #[must_use]
    pub fn polarizes(&self) -> bool {
        self.surfaces.iter().any(|surface| surface.far == FarSide::Polarizer)
    }

    /// The medium of a metal; `None` for a perfect conductor.
    #[must_use]
    pub fn metal(&self, far: FarSide) -> Option<&Medium> {
        if let FarSide::Metal(metal) = far { self.metals.get(usize::from(metal)) } else { None }
    }

    /// Where the surface of that number lies, if there is one.
    #[must_use]
    pub fn shape(&self, surface: u16) -> Option<&Shape> {
        self.surfaces.get(usize::from(surface)).map(|surface| &surface.shape)
    }

    /// The nearest surface that a ray outside meets, from zero on, `departed` being the one it has
    /// just left.
    #[must_use]
    pub fn first_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        departed: Option<u16>,
    ) -> Option<SurfaceHit> {
        if !self.hull.may_be_met(origin, direction) {
            return None;
        }
        // A loop: here it takes fewer instructions than `first_along`.
        let mut nearest: Option<(u16, &Surface, f64, DVec3)> = None;
        for (index, surface) in (0u16..).zip(&self.surfaces) {
            if let Some((distance, outward)) =
                surface.hit(origin, direction, departed == Some(index))
                && nearest.is_none_or(|(_, _, least, _)| distance < least)
            {
                nearest = Some((index, surface, distance, outward));
            }
        }
        let (surface, &Surface { far, coating, .. }, distance, outward) = nearest?;
        Some(SurfaceHit { surface, distance, outward, far, coating })
    }
}

/// Where a ray outside meets a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// Which of the device's surfaces.
    pub surface: u16,
    /// How far along the ray, cm.
    pub distance: f64,
    /// Unit normal of the surface, against the ray.
    pub outward: DVec3,
    /// What lies behind it.
    pub far: FarSide,
    /// How the media meet.
    pub coating: Coating,
}

/// For each region the number of the first of those that are one segment, cut into convex pieces.
pub(super) fn segments(regions: &[Region]) -> Vec<usize> {
    let mut segment: Vec<usize> = (0..regions.len()).collect();
    let seams: Vec<(usize, usize)> = (regions.iter().enumerate())
        .flat_map(|(index, region)| {
            let faces = if let Region::Homogeneous(region) = region { region.faces() } else { &[] };
            faces.iter().filter_map(move |face| match face.far {
                FarSide::Seam(next) => Some((index, usize::from(next))),
                _ => None,
            })
        })
        .collect();
    loop {
        let before = segment.clone();
        for &(a, b) in &seams {
            let least = segment[a].min(segment[b]);
            (segment[a], segment[b]) = (least, least);
        }
        if segment == before {
            return segment;
        }
    }
}
