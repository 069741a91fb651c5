//! Planes that bound a convex cell.

use glam::DVec3;

/// A plane n·r = offset with the unit normal n pointing out of the cell it bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Outward unit normal.
    pub normal: DVec3,
    /// Distance from the origin along the normal, cm.
    pub offset: f64,
}

/// Rays closer than this to running along a plane (sine of the angle) run along it: they get the
/// limit of rays that never reach it.
const ALONG: f64 = 1e-13;

impl Plane {
    /// How far a ray inside the cell runs to reach the plane; `None` if it runs along or away.
    /// Never negative: rounding may have put the origin a hair beyond.
    #[must_use]
    pub fn distance(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let approach = direction.dot(self.normal);
        (approach > ALONG).then(|| ((self.offset - self.normal.dot(origin)) / approach).max(0.0))
    }

    /// The point of the plane closest to `point`.
    #[must_use]
    pub fn project(&self, point: DVec3) -> DVec3 {
        point + self.normal * (self.offset - self.normal.dot(point))
    }
}
