//! The surfaces of a device that light in air can meet.

use super::{Beyond, Finish};
use glam::DVec3;
use optics::geometry::{Cap, Wall};

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
}

impl Skin {
    /// The distance at which a ray in air meets the surface and the unit normal there, against the
    /// ray. `again` says that the ray has just left this same surface.
    #[must_use]
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
        }
    }

    /// What lies behind the surface at a point of it.
    #[must_use]
    pub fn beyond(&self, _position: DVec3) -> Beyond {
        match self {
            Self::Wall { beyond, .. } | Self::Cap { beyond, .. } => *beyond,
            Self::Strip(_) => Beyond::Conductor,
        }
    }

    /// How the media meet at the surface.
    #[must_use]
    pub fn finish(&self) -> Finish {
        match self {
            Self::Wall { finish, .. } | Self::Cap { finish, .. } => *finish,
            Self::Strip(_) => Finish::Bare,
        }
    }
}
