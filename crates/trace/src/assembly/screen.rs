//! The opaque rectangle in space on which the photograph is.

use super::{Assembly, Placed};
use glam::{DVec2, DVec3};
use optics::geometry::{Extent, Outline, Pose, Solid, TOUCHING};

/// A rectangle where rays end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screen {
    /// Where it is: its middle is the origin, x the way one looks straight at its front, y up, and z to the right.
    pub pose: Pose,
    /// Half its size along its z, cm.
    pub half_width: f64,
    /// Half its size along its y, cm.
    pub half_height: f64,
}

impl Screen {
    /// The distance at which a ray meets the plane, from zero on.
    #[must_use]
    #[inline]
    pub fn plane_distance(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let t = self.distance_along(origin, direction);
        (t >= 0.0 && t.is_finite()).then_some(t)
    }

    /// The distance at which a line meets the plane, negative behind its origin; not finite if it does not.
    #[must_use]
    #[inline]
    pub fn distance_along(&self, origin: DVec3, direction: DVec3) -> f64 {
        -self.pose.to_local(origin).x / self.pose.vector_to_local(direction).x
    }

    /// The distance at which a ray meets the rectangle, from `least` (cm) on.
    #[must_use]
    #[inline]
    pub fn hit(&self, origin: DVec3, direction: DVec3, least: f64) -> Option<f64> {
        let (origin, direction) =
            (self.pose.to_local(origin), self.pose.vector_to_local(direction));
        let t = -origin.x / direction.x;
        if !(t >= least && t.is_finite()) {
            return None;
        }
        let (y, z) = (origin.y + t * direction.y, origin.z + t * direction.z);
        (y.abs() <= self.half_height && z.abs() <= self.half_width).then_some(t)
    }

    /// The point of the plane that is nearest.
    #[must_use]
    pub fn foot(&self, point: DVec3) -> DVec3 {
        self.pose.to_world(self.pose.to_local(point).with_x(0.0))
    }

    /// Image coordinates (u, v) of a point of the plane, from 0 to 1 to the right and down, for a ray that looks
    /// along `direction`: upright and unmirrored from either side.
    #[must_use]
    #[inline]
    pub fn image_position(&self, point: DVec3, direction: DVec3) -> [f64; 2] {
        let point = self.pose.to_local(point);
        let z = point.z * self.pose.vector_to_local(direction).x.signum();
        [0.5 + z / (2.0 * self.half_width), 0.5 - point.y / (2.0 * self.half_height)]
    }

    /// The point that is so many halves of its size above and to the right of its middle.
    #[must_use]
    pub fn point(&self, up: f64, across: f64) -> DVec3 {
        self.pose.to_world(DVec3::new(0.0, up * self.half_height, across * self.half_width))
    }

    /// Its middle line that is the longer one as seen along z: from below to above, or from left to right.
    #[must_use]
    pub fn middle_line(&self) -> [DVec3; 2] {
        let upright = [-1.0, 1.0].map(|up| self.point(up, 0.0));
        let level = [-1.0, 1.0].map(|across| self.point(0.0, across));
        let length = |[from, to]: [DVec3; 2]| (to - from).truncate().length();
        if length(upright) >= length(level) { upright } else { level }
    }

    /// Whether its plane comes within rounding of the bounds of a device.
    pub(crate) fn touches(&self, assembly: &Assembly) -> bool {
        let (origin, normal) = (self.pose.origin(), self.pose.vector_to_world(DVec3::X));
        let near = |[low, high]: [DVec3; 2]| {
            // The least and the greatest distance of the bounds from the plane; parts along which it runs do not matter.
            let part = |i: usize| {
                let ends = [low[i], high[i]].map(|end| (end - origin[i]) * normal[i]);
                let [a, b] = if normal[i] == 0.0 { [0.0; 2] } else { ends };
                [a.min(b), a.max(b)]
            };
            let sum = |end: usize| (0..3).map(|i| part(i)[end]).sum::<f64>();
            sum(0) <= TOUCHING && sum(1) >= -TOUCHING
        };
        assembly.devices().iter().filter_map(Placed::bounds).any(near)
    }

    /// The first device but a body that the rectangle cuts.
    #[must_use]
    pub fn cut_by(&self, assembly: &Assembly) -> Option<usize> {
        let ends = [-self.half_height, self.half_height].map(|y| DVec2::new(0.0, y));
        let extent = Extent { min: -self.half_width, max: self.half_width };
        let sheet = Solid::Prism { outline: Outline::new(ends.to_vec()), extent };
        let sheet = sheet.placed(&self.pose);
        assembly.devices().iter().position(|device| {
            let cuts = |solid: &Solid| solid.overlaps(&sheet, TOUCHING);
            device.body().is_none() && device.solids().iter().any(cuts)
        })
    }
}
