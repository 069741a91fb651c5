//! The opaque rectangle in space on which the photograph is.

use super::Bench;
use super::bench::TOUCHING;
use glam::{DVec2, DVec3};
use optics::geometry::{Extent, Outline, Solid};

/// A rectangle in a plane of constant x, centred on the x axis, where rays end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screen {
    /// Where the plane is, cm.
    pub x: f64,
    /// Half its size along z, cm.
    pub half_width: f64,
    /// Half its size along y, cm.
    pub half_height: f64,
}

impl Screen {
    /// The distance at which a ray meets the plane, from zero on.
    #[must_use]
    pub fn plane_distance(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let t = (self.x - origin.x) / direction.x;
        (t >= 0.0 && t.is_finite()).then_some(t)
    }

    /// The distance at which a ray meets the rectangle.
    #[must_use]
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let t = self.plane_distance(origin, direction)?;
        let (y, z) = (origin.y + t * direction.y, origin.z + t * direction.z);
        (y.abs() <= self.half_height && z.abs() <= self.half_width).then_some(t)
    }

    /// The first device that the rectangle cuts.
    #[must_use]
    pub fn cut_by(&self, bench: &Bench) -> Option<usize> {
        let ends = [-self.half_height, self.half_height].map(|y| DVec2::new(self.x, y));
        let extent = Extent { min: -self.half_width, max: self.half_width };
        let sheet = Solid::Prism { outline: Outline::new(ends.to_vec()), extent };
        bench
            .devices()
            .iter()
            .position(|device| device.solids().iter().any(|solid| solid.overlaps(&sheet, TOUCHING)))
    }
}
