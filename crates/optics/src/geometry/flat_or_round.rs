//! Planes and spheres anywhere, alike.

use super::{Plane, Sphere};
use glam::DVec3;

/// A plane or a sphere with its inside: where `constant` + `linear`·r + `square` r² is negative.
///
/// At the surface the gradient of that, which points outwards, is of length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatOrRound {
    /// The value at the origin, cm.
    pub constant: f64,
    /// What the value grows by along each axis.
    pub linear: DVec3,
    /// What it grows by with r², 1/cm; 0 for a plane.
    pub square: f64,
}

impl From<Plane> for FlatOrRound {
    fn from(plane: Plane) -> Self {
        Self { constant: -plane.offset, linear: plane.normal, square: 0.0 }
    }
}

impl From<Sphere> for FlatOrRound {
    fn from(sphere: Sphere) -> Self {
        let square = 0.5 / sphere.radius;
        Self { constant: -0.5 * sphere.radius, linear: DVec3::ZERO, square }
    }
}

impl FlatOrRound {
    /// How far outside a point is that is near the surface, cm; negative inside.
    #[must_use]
    pub fn height(&self, at: DVec3) -> f64 {
        self.constant + self.linear.dot(at) + self.square * at.length_squared()
    }

    /// The outward unit normal at a point near the surface.
    #[must_use]
    pub fn outward(&self, at: DVec3) -> DVec3 {
        (self.linear + at * (2.0 * self.square)).try_normalize().unwrap_or(DVec3::X)
    }

    /// A point within rounding of the surface, put on it.
    #[must_use]
    pub fn project(&self, at: DVec3) -> DVec3 {
        at - self.outward(at) * self.height(at)
    }
}
