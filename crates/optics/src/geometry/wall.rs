//! An upright wall: a straight line in the xy-plane, extended along z.

use super::Extent;
use glam::{DVec2, DVec3};

/// A flat wall over the line from `from` to `to`. Its outward normal lies to the right of that
/// line, so that the walls of a convex body run counterclockwise around it.
///
/// Walls that share an end point leave no gap: whether a ray passes left or right of a point is
/// decided by one expression that is the same for both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    from: DVec2,
    to: DVec2,
    extent: Extent,
    /// The outward unit normal.
    pub normal: DVec3,
    length: f64,
}

impl Wall {
    /// A wall between two distinct points of the xy-plane.
    #[must_use]
    pub fn new(from: DVec2, to: DVec2, extent: Extent) -> Self {
        let along = (to - from).normalize();
        let length = (to - from).length();
        Self { from, to, extent, normal: DVec3::new(along.y, -along.x, 0.0), length }
    }

    /// The line it stands on.
    #[must_use]
    pub fn ends(&self) -> [DVec2; 2] {
        [self.from, self.to]
    }

    /// The distance at which a ray meets the wall, from zero on, ends and edges included.
    /// Rays that run along the wall do not meet it.
    #[must_use]
    #[inline]
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let (o, d) = (origin.truncate(), direction.truncate());
        let side_from = d.perp_dot(self.from - o);
        let side_to = d.perp_dot(self.to - o);
        if (side_from < 0.0) == (side_to < 0.0) && side_from != 0.0 && side_to != 0.0 {
            return None;
        }
        let line = self.to - self.from;
        let crossing = d.perp_dot(line);
        if crossing.abs() <= 1e-13 * self.length {
            return None;
        }
        let t = (self.from - o).perp_dot(line) / crossing;
        (t >= 0.0 && self.extent.contains(origin.z + t * direction.z)).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_walls_leave_no_gap() {
        // Rays at the corner of a square, from all sides and just beside it.
        let points = [(1.0, 0.1), (0.1, 1.0), (-0.9, 0.1), (0.1, -0.9)].map(DVec2::from);
        let walls: Vec<Wall> =
            (0..4).map(|i| Wall::new(points[i], points[(i + 1) % 4], Extent::ENDLESS)).collect();
        for step in 0..2000 {
            let angle = std::f64::consts::FRAC_PI_2 * (f64::from(step) / 2000.0 - 0.5) * 0.99;
            let direction = DVec3::new(-angle.cos(), angle.sin(), 0.0);
            let target = DVec3::new(1.0, 0.1, 0.3);
            let origin = target - direction * 7.3;
            let entering = walls
                .iter()
                .filter(|wall| direction.dot(wall.normal) < 0.0)
                .filter_map(|wall| wall.hit(origin, direction))
                .count();
            // At a corner both walls, or one: never none, unless the ray only grazes the corner.
            let grazes = direction.x.abs() < direction.y.abs();
            assert!(entering >= 1 || grazes, "angle {angle}");
        }
    }
}
