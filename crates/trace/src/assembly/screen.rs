//! The opaque rectangle in space on which the photograph is.

use super::{Assembly, Placed};
use glam::{DMat3, DVec2, DVec3};
use optics::geometry::{Extent, Outline, Pose, REACH, Solid, TOUCHING};

/// A rectangle where rays end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screen {
    /// Its middle, cm.
    pub middle: DVec3,
    /// The way one looks straight at its front, up, and to the right: unit vectors.
    axes: [DVec3; 3],
    /// Whether these are x, y and z, as in most scenes.
    straight: bool,
    half_width: f64,
    half_height: f64,
    /// How far up and across from its middle it ends rays.
    reach: [f64; 2],
}

impl Screen {
    /// A rectangle of twice that width and height (cm) whose middle is the origin of `pose`, x
    /// being the way one looks straight at its front, y up, and z to the right.
    #[must_use]
    pub fn new(pose: &Pose, half_width: f64, half_height: f64) -> Self {
        let axes = DVec3::AXES.map(|axis| pose.vector_to_world(axis));
        let straight = axes == DVec3::AXES;
        let reach = [half_height, half_width];
        Self { middle: pose.origin, axes, straight, half_width, half_height, reach }
    }

    /// The same, but rays end on its whole plane: beyond its edges, too, something is to be seen.
    #[must_use]
    pub fn endless(self) -> Self {
        Self { reach: [REACH; 2], ..self }
    }

    /// The parts of a vector along the axes.
    #[inline]
    fn parts(&self, vector: DVec3) -> DVec3 {
        if self.straight { vector } else { self.axes.map(|axis| axis.dot(vector)).into() }
    }

    /// Its width and its height, cm.
    #[must_use]
    pub fn size(&self) -> [f64; 2] {
        [2.0 * self.half_width, 2.0 * self.half_height]
    }

    /// How far its plane is ahead of a point as one looks straight at its front, cm.
    #[must_use]
    #[inline]
    pub fn ahead_of(&self, point: DVec3) -> f64 {
        self.parts(self.middle - point).x
    }

    /// The distance at which a ray meets the plane, from `least` (cm) on.
    #[must_use]
    #[inline]
    pub fn plane_distance(&self, origin: DVec3, direction: DVec3, least: f64) -> Option<f64> {
        let t = self.distance_along(origin, direction);
        (t >= least && t.is_finite()).then_some(t)
    }

    /// The distance at which a line meets the plane, negative behind its origin; not finite if it
    /// does not.
    #[must_use]
    #[inline]
    pub fn distance_along(&self, origin: DVec3, direction: DVec3) -> f64 {
        self.ahead_of(origin) / self.parts(direction).x
    }

    /// The distance at which a ray meets the rectangle, or its plane if it is endless, from `least`
    /// (cm) on.
    #[must_use]
    #[inline]
    pub fn hit(&self, origin: DVec3, direction: DVec3, least: f64) -> Option<f64> {
        let t = self.plane_distance(origin, direction, least)?;
        let DVec3 { y: up, z: across, .. } = self.parts(origin + direction * t - self.middle);
        (up.abs() <= self.reach[0] && across.abs() <= self.reach[1]).then_some(t)
    }

    /// The point of the plane that is nearest.
    #[must_use]
    pub fn foot(&self, point: DVec3) -> DVec3 {
        point + self.axes[0] * self.ahead_of(point)
    }

    /// Image coordinates (u, v) of points of the plane, in the rectangle from 0 to 1 to the right and down, for a
    /// ray that looks along `direction`: upright and unmirrored from either side.
    #[inline]
    pub fn image_position(&self, direction: DVec3) -> impl Fn(DVec3) -> [f64; 2] {
        let front = self.parts(direction).x.signum();
        let [width, height] = self.size();
        let [to_right, down] = [front / width, -1.0 / height];
        move |point| {
            let DVec3 { y: up, z: across, .. } = self.parts(point - self.middle);
            [0.5 + across * to_right, 0.5 + up * down]
        }
    }

    /// The point that is so many halves of its size above and to the right of its middle.
    #[must_use]
    pub fn point(&self, up: f64, across: f64) -> DVec3 {
        self.middle
            + self.axes[1] * (up * self.half_height)
            + self.axes[2] * (across * self.half_width)
    }

    /// Its middle line that is the longer one as seen along z: from below to above, or from left to
    /// right.
    #[must_use]
    pub fn middle_line(&self) -> [DVec3; 2] {
        let upright = [-1.0, 1.0].map(|up| self.point(up, 0.0));
        let level = [-1.0, 1.0].map(|across| self.point(0.0, across));
        let length = |[from, to]: [DVec3; 2]| (to - from).truncate().length();
        if length(upright) >= length(level) { upright } else { level }
    }

    /// Whether its plane comes within rounding of the bounds of a device.
    pub(crate) fn touches(&self, assembly: &Assembly) -> bool {
        let (origin, normal) = (self.middle, self.axes[0]);
        let near = |[low, high]: [DVec3; 2]| {
            // The least and the greatest distance of the bounds from the plane; parts along which
            // it runs do not matter.
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

    /// The first device but a body that the rectangle cuts, or its plane if it is endless.
    #[must_use]
    pub fn cut_by(&self, assembly: &Assembly) -> Option<usize> {
        let [height, width] = self.reach;
        let ends = [-height, height].map(|y| DVec2::new(0.0, y));
        let extent = Extent { min: -width, max: width };
        let sheet = Solid::Prism { outline: Outline { corners: ends.to_vec() }, extent };
        let [forward, up, across] = self.axes;
        let rotation = DMat3::from_cols(forward, up, across);
        let sheet = sheet.placed(&Pose::from_rotation(self.middle, rotation));
        assembly.devices().iter().position(|device| {
            let cuts = |solid: &Solid| {
                solid.overlaps(&sheet, TOUCHING) || solid.coincides(&sheet, TOUCHING)
            };
            device.body().is_none() && device.solids().iter().any(cuts)
        })
    }
}
