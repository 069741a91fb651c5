//! The surfaces of a device that light in air can meet.

use super::{Beyond, Finish};
use glam::DVec3;
use optics::geometry::{
    Cap, CurvedSide, Cylinder, CylinderPart, Disc, Extent, FloorCurve, Sphere, Wall,
};
use optics::transformation::ConformalMap;

/// A surface between air and a device, with what lies behind it.
#[derive(Clone, Debug)]
pub enum Skin {
    /// A flat wall met from its outside.
    Wall {
        /// Its shape.
        wall: Wall,
        /// What lies behind it.
        beyond: Beyond,
        /// How the media meet.
        finish: Finish,
    },
    /// A thin metal wall with air on both sides.
    Strip(Wall),
    /// A flat end of a device of finite length.
    Cap {
        /// Its shape.
        cap: Cap,
        /// What lies behind it.
        beyond: Beyond,
        /// How the media meet.
        finish: Finish,
    },
    /// A flat end of a device with a round core.
    PiercedCap {
        /// Its shape.
        cap: Cap,
        /// What lies behind it.
        beyond: Beyond,
        /// Radius of the core about the z axis, cm; 0 without one.
        core: f64,
        /// What lies behind it there: metal, or air where there is nothing.
        beyond_core: Beyond,
    },
    /// A flat end of a conformal device: one half or two, and what is below the floor.
    ConformalCap {
        /// Its shape.
        cap: Cap,
        /// The map whose floor is meant.
        map: ConformalMap,
        /// What lies behind it below the floor: metal, or air where there is nothing.
        below: Beyond,
        /// The cell of the upper half.
        upper: u16,
        /// The cell of its mirror image under y -> -y, if there is one.
        lower: Option<u16>,
        /// How the media meet.
        finish: Finish,
    },
    /// A sphere about the origin, met from outside.
    Sphere {
        /// Its shape.
        sphere: Sphere,
        /// What lies behind it.
        beyond: Beyond,
    },
    /// The round side of a cylinder about the z axis, met from outside.
    Side {
        /// Its shape.
        cylinder: Cylinder,
        /// What lies behind it.
        beyond: Beyond,
    },
    /// A flat end of a round cylinder with a core.
    Disc {
        /// Its shape.
        disc: Disc,
        /// What lies behind it.
        beyond: Beyond,
        /// Radius of the core, cm; 0 without one.
        core: f64,
        /// What lies behind it there: metal, or air where there is nothing.
        beyond_core: Beyond,
    },
    /// A spherical hole about the origin, met from within.
    InnerSphere {
        /// Its shape.
        sphere: Sphere,
        /// What lies behind it.
        beyond: Beyond,
    },
    /// A round hole about the z axis, met from within.
    InnerSide {
        /// Its shape.
        cylinder: Cylinder,
        /// What lies behind it.
        beyond: Beyond,
    },
    /// A hole between the floor of a conformal map and its mirror image, one of which is met from within.
    InnerFloor {
        /// Its cross-section.
        curve: FloorCurve,
        /// Which of the two.
        side: CurvedSide,
        /// Its extent along z.
        extent: Extent,
        /// What lies behind it.
        beyond: Beyond,
        /// How the media meet.
        finish: Finish,
    },
    /// The metal below the curved floor of a conformal map, in air.
    Floor {
        /// Its cross-section.
        curve: FloorCurve,
        /// Its extent along z.
        extent: Extent,
    },
    /// A flat end of the metal below a floor.
    FloorCap {
        /// A shape around it.
        cap: Cap,
        /// The metal's cross-section.
        curve: FloorCurve,
    },
}

impl Skin {
    /// The distance at which a ray in air meets the surface and the unit normal there, against the
    /// ray. `again` says that the ray has just left this same surface.
    #[must_use]
    #[inline]
    pub fn hit(&self, origin: DVec3, direction: DVec3, again: bool) -> Option<(f64, DVec3)> {
        match self {
            Self::Wall { wall, .. } => {
                if again || direction.dot(wall.normal()) >= 0.0 {
                    return None;
                }
                Some((wall.hit(origin, direction)?, wall.normal()))
            }
            Self::Strip(wall) => {
                if again {
                    return None;
                }
                let facing = -direction.dot(wall.normal()).signum();
                Some((wall.hit(origin, direction)?, wall.normal() * facing))
            }
            Self::Cap { cap, .. } => {
                if again || direction.dot(cap.normal) >= 0.0 {
                    return None;
                }
                Some((cap.hit(origin, direction)?, cap.normal))
            }
            Self::ConformalCap { cap, below, .. }
            | Self::PiercedCap { cap, beyond_core: below, .. } => {
                if again || direction.dot(cap.normal) >= 0.0 {
                    return None;
                }
                let distance = cap.hit(origin, direction)?;
                // There is nothing before an open core.
                let nothing = *below == Beyond::Air
                    && self.beyond(origin + direction * distance) == Beyond::Air;
                (!nothing).then_some((distance, cap.normal))
            }
            Self::Sphere { sphere, .. } => {
                let distance = sphere.hit(origin, direction).filter(|_| !again)?;
                Some((distance, sphere.outward(origin + direction * distance)))
            }
            Self::Side { cylinder, .. } => {
                let distance = cylinder.hit_side(origin, direction).filter(|_| !again)?;
                let point = origin + direction * distance;
                Some((distance, cylinder.outward(CylinderPart::Side, point)))
            }
            Self::Disc { disc, beyond_core, .. } => {
                let distance = disc.hit(origin, direction).filter(|_| !again)?;
                let nothing = *beyond_core == Beyond::Air
                    && self.beyond(origin + direction * distance) == Beyond::Air;
                (!nothing).then_some((distance, disc.normal))
            }
            Self::InnerSphere { sphere, .. } => {
                let distance = sphere.hit_within(origin, direction)?;
                Some((distance, -sphere.outward(origin + direction * distance)))
            }
            Self::InnerSide { cylinder, .. } => {
                let distance = cylinder.hit_side_within(origin, direction)?;
                let point = origin + direction * distance;
                Some((distance, -cylinder.outward(CylinderPart::Side, point)))
            }
            Self::InnerFloor { curve, side, extent, .. } => {
                let least = if again { AGAIN } else { 0.0 };
                let (o, d) = (origin.truncate(), direction.truncate());
                let hit = curve.first_way_out(*side, o, d, least)?;
                let within = extent.contains(origin.z + hit.t * direction.z);
                within.then_some((hit.t, -hit.normal.extend(0.0)))
            }
            Self::Floor { curve, extent } => floor_hit(curve, *extent, origin, direction, again),
            Self::FloorCap { cap, curve } => {
                if again || direction.dot(cap.normal) >= 0.0 {
                    return None;
                }
                let distance = cap.hit(origin, direction)?;
                let point = origin + direction * distance;
                curve.contains(point.truncate()).then_some((distance, cap.normal))
            }
        }
    }

    /// What lies behind the surface at a point of it.
    #[must_use]
    pub fn beyond(&self, position: DVec3) -> Beyond {
        match self {
            Self::ConformalCap { map, below, upper, lower, .. } => {
                let (cell, y) = match lower {
                    Some(lower) if position.y < 0.0 => (*lower, -position.y),
                    _ => (*upper, position.y),
                };
                let is_below = y < map.peak() && y < map.floor_height_at(position.x);
                if is_below { *below } else { Beyond::Cell(cell) }
            }
            Self::Disc { core, beyond_core, .. } | Self::PiercedCap { core, beyond_core, .. }
                if position.truncate().length_squared() < core * core =>
            {
                *beyond_core
            }
            Self::Wall { beyond, .. }
            | Self::Cap { beyond, .. }
            | Self::Sphere { beyond, .. }
            | Self::Side { beyond, .. }
            | Self::Disc { beyond, .. }
            | Self::PiercedCap { beyond, .. }
            | Self::InnerSphere { beyond, .. }
            | Self::InnerSide { beyond, .. }
            | Self::InnerFloor { beyond, .. } => *beyond,
            Self::Strip(_) | Self::Floor { .. } | Self::FloorCap { .. } => Beyond::Conductor,
        }
    }

    /// How the media meet at the surface.
    #[must_use]
    pub fn finish(&self) -> Finish {
        match self {
            Self::Wall { finish, .. }
            | Self::Cap { finish, .. }
            | Self::ConformalCap { finish, .. }
            | Self::InnerFloor { finish, .. } => *finish,
            Self::Strip(_)
            | Self::Sphere { .. }
            | Self::Side { .. }
            | Self::Disc { .. }
            | Self::PiercedCap { .. }
            | Self::InnerSphere { .. }
            | Self::InnerSide { .. }
            | Self::Floor { .. }
            | Self::FloorCap { .. } => Finish::Bare,
        }
    }
}

/// A surface that a ray has just left is not met again closer than this, cm.
const AGAIN: f64 = 1e-7;

/// Where a ray meets the metal below a floor, within an extent along z.
fn floor_hit(
    curve: &FloorCurve,
    extent: Extent,
    origin: DVec3,
    direction: DVec3,
    again: bool,
) -> Option<(f64, DVec3)> {
    let mut least = if again { AGAIN } else { 0.0 };
    loop {
        let hit = curve.first_hit(origin.truncate(), direction.truncate(), least)?;
        if extent.contains(origin.z + hit.t * direction.z) {
            return Some((hit.t, hit.normal.extend(0.0)));
        }
        // Past an end: the metal may be met once more, for it is not convex.
        least = hit.t + AGAIN;
    }
}
