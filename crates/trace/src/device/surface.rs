//! The surfaces of a device that light outside of it can meet.

use super::{Coating, Convex, FarSide};
use glam::DVec3;
use optics::geometry::{
    Border, Cap, CurvedSide, Cylinder, Disc, Extent, FloorCurve, Lens, LensPart, Plane, Polyhedron,
    Sphere, Wall,
};
use optics::propagation::Half;
use optics::transformation::ConformalMap;
use std::sync::Arc;

/// A surface, and what lies behind it.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Where it lies, and from where it is met.
    pub shape: Shape,
    /// Which part of the shape it is.
    pub part: Part,
    /// What lies behind it.
    pub far: FarSide,
    /// How the media meet there.
    pub coating: Coating,
}

/// A piece of a surface about the origin or the z axis.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A plane piece that extends along z, met from its front.
    Wall(Wall),
    /// A plane piece that extends along z, met from both sides.
    Sheet(Wall),
    /// A polarizing plane piece that extends along z, met from both sides.
    Polarizer {
        /// The piece.
        wall: Wall,
        /// The unit vector in its plane along which light passes.
        axis: DVec3,
    },
    /// A flat end of a polygonal prism.
    Cap(Cap),
    /// A flat end of a round cylinder.
    Disc(Disc),
    /// The whole border of a convex shape, met from outside.
    Convex(Convex),
    /// The border of a hole that is a ball, met from within.
    BallHole(Sphere),
    /// The round side of a cylinder, met from outside.
    Round(Cylinder),
    /// The round side of a hole that is a cylinder, met from within.
    RoundHole(Cylinder),
    /// A piece of the border of a lens, met from outside.
    OfLens {
        /// The lens.
        lens: Lens,
        /// Which piece.
        part: LensPart,
    },
    /// The whole border of a solid with flat faces, met from outside.
    OfPolyhedron(Arc<Polyhedron>),
    /// The outline of the metal below the curved floor of a conformal map, met from outside, or one
    /// curved side of it, met from within; extended along z.
    Curve {
        /// Its cross-section.
        curve: FloorCurve,
        /// Which of its sides; all of it if absent.
        side: Option<CurvedSide>,
        /// Its extent along z.
        extent: Extent,
    },
}

/// A part of a flat end.
#[derive(Clone, Debug)]
pub enum Part {
    /// All of it.
    Whole,
    /// Within a circle about the z axis of this radius, cm.
    Within(f64),
    /// Without a circle about the z axis of this radius, cm.
    Without(f64),
    /// Above the floor of a conformal map, of its upper half or of its mirror image under y -> -y.
    AboveFloor(ConformalMap, Half),
    /// Below the floor of a conformal map, and above that of its mirror image if there is one.
    BelowFloor {
        /// The map.
        map: ConformalMap,
        /// Whether the map has a mirror image.
        mirrored: bool,
    },
    /// The metal below a floor.
    Metal(FloorCurve),
}

impl Part {
    #[inline]
    fn holds(&self, point: DVec3) -> bool {
        let height = |map: &ConformalMap, y: f64| {
            if y < map.peak() { y - map.floor_height_at(point.x) } else { y }
        };
        match self {
            Self::Whole => true,
            Self::Within(radius) => point.truncate().length_squared() < radius * radius,
            Self::Without(radius) => point.truncate().length_squared() >= radius * radius,
            Self::AboveFloor(map, Half::Upper) => height(map, point.y) >= 0.0,
            Self::AboveFloor(map, Half::Lower) => point.y < 0.0 && height(map, -point.y) >= 0.0,
            Self::BelowFloor { map, mirrored } => {
                let y = if *mirrored { point.y.abs() } else { point.y };
                height(map, y) < 0.0
            }
            Self::Metal(curve) => curve.contains(point.truncate()),
        }
    }
}

impl Surface {
    /// A whole bare surface.
    #[must_use]
    pub fn new(shape: Shape, far: FarSide) -> Self {
        Self { shape, part: Part::Whole, far, coating: Coating::None }
    }

    /// A plane piece that extends along z, met from its front.
    #[must_use]
    pub fn wall(wall: Wall, far: FarSide) -> Self {
        Self::new(Shape::Wall(wall), far)
    }

    /// A thin two-sided mirror that extends along z.
    #[must_use]
    pub fn mirror(wall: Wall) -> Self {
        Self::new(Shape::Sheet(wall), FarSide::Conductor)
    }

    /// The plane in which it lies, its normal pointing to behind it, if it is one that is met from
    /// its front.
    #[must_use]
    pub fn plane(&self) -> Option<Plane> {
        let (normal, point) = match &self.shape {
            Shape::Wall(wall) => (-wall.normal, wall.ends()[0].extend(0.0)),
            Shape::Cap(cap) => (-cap.normal, DVec3::Z * cap.z),
            Shape::Disc(disc) => (-disc.normal, DVec3::Z * disc.z),
            _ => return None,
        };
        Some(Plane { normal, offset: normal.dot(point) })
    }

    /// The distance, from zero on, at which a ray meets the surface and the unit normal there,
    /// against the ray. A ray that has just `departed` from this same surface does not meet it
    /// again at once.
    #[must_use]
    #[inline]
    pub fn hit(&self, origin: DVec3, direction: DVec3, departed: bool) -> Option<(f64, DVec3)> {
        let at = |distance: f64| origin + direction * distance;
        let (distance, normal) = match &self.shape {
            Shape::Curve { curve, side, extent } => {
                let least = if departed { AGAIN } else { 0.0 };
                return curve_hit(curve, *side, *extent, origin, direction, least);
            }
            // The border of a hole is curved inwards: a ray meets it again.
            Shape::BallHole(sphere) => {
                let distance = sphere.hit_within(origin, direction)?;
                (distance, -sphere.outward(at(distance)))
            }
            Shape::RoundHole(cylinder) => {
                let distance = cylinder.hit_side_within(origin, direction)?;
                (distance, -cylinder.outward(Border::Outer, at(distance)))
            }
            Shape::OfLens { lens, part } if departed && !lens.is_hollow(*part) => return None,
            Shape::OfLens { lens, part } => lens.entry(*part, origin, direction)?,
            // Only faces that a ray comes to from in front are met, the one that it has left not.
            Shape::OfPolyhedron(solid) => {
                let hit = solid.entry(origin, direction)?;
                (hit.distance, hit.outward)
            }
            _ if departed => return None,
            Shape::Wall(wall) if direction.dot(wall.normal) >= 0.0 => return None,
            Shape::Wall(wall) => (wall.hit(origin, direction)?, wall.normal),
            Shape::Sheet(wall) | Shape::Polarizer { wall, .. } => {
                let facing = -direction.dot(wall.normal);
                (wall.hit(origin, direction)?, wall.normal * facing.signum())
            }
            Shape::Cap(cap) => (cap.hit(origin, direction)?, cap.normal),
            Shape::Disc(disc) => (disc.hit(origin, direction)?, disc.normal),
            Shape::Convex(shape) => shape.entry(origin, direction)?,
            Shape::Round(cylinder) => {
                let distance = cylinder.hit_side(origin, direction)?;
                (distance, cylinder.outward(Border::Outer, at(distance)))
            }
        };
        let whole = matches!(self.part, Part::Whole);
        (whole || self.part.holds(at(distance))).then_some((distance, normal))
    }
}

/// A curved surface that a ray has just departed from is not met again closer than this, cm.
const AGAIN: f64 = 1e-7;

/// Where a ray meets the outline of metal below a floor from outside, or one of its sides from
/// within, within an extent along z.
fn curve_hit(
    curve: &FloorCurve,
    side: Option<CurvedSide>,
    extent: Extent,
    origin: DVec3,
    direction: DVec3,
    least: f64,
) -> Option<(f64, DVec3)> {
    let (o, d) = (origin.truncate(), direction.truncate());
    let within = |t: f64| extent.contains(origin.z + t * direction.z);
    if let Some(side) = side {
        let hit = curve.first_way_out(side, o, d, least)?;
        return within(hit.t).then_some((hit.t, -hit.normal.extend(0.0)));
    }
    let mut least = least;
    loop {
        let hit = curve.first_hit(o, d, least)?;
        if within(hit.t) {
            return Some((hit.t, hit.normal.extend(0.0)));
        }
        // Past an end: the metal may be met once more, for it is not convex.
        least = hit.t + AGAIN;
    }
}
