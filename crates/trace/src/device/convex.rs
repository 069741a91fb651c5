//! Convex shapes that are met, left and looked into as a whole.

use glam::DVec3;
use optics::geometry::{
    Border, CutBall, Cylinder, Disc, Extent, Outline, REACH, Solid, Sphere, first_along,
};

/// A convex shape about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Convex {
    /// A box; an endless one has infinite sides.
    Box {
        /// Half its size along x, y and z, cm.
        half: DVec3,
    },
    /// A ball.
    Ball(Sphere),
    /// A ball of which a plane has cut something off.
    CutBall(CutBall),
    /// A round cylinder about the z axis.
    Cylinder(Cylinder),
}

impl Convex {
    /// The space that it takes up; what has no end reaches to [`REACH`].
    pub fn solid(&self) -> Solid {
        match *self {
            Self::Ball(sphere) => Solid::ball(sphere.radius),
            Self::CutBall(ball) => Solid::CutBall { centre: DVec3::ZERO, ball },
            Self::Cylinder(cylinder) => Solid::cylinder(cylinder.radius, cylinder.extent),
            Self::Box { half } => {
                let near = half.min(DVec3::splat(REACH));
                let outline = Outline::rectangle(near.x, near.y);
                Solid::Prism { outline, extent: Extent { min: -half.z, max: half.z } }
            }
        }
    }

    /// Where a ray that is outside enters: the distance, from zero on, and the outward unit normal.
    #[must_use]
    pub fn entry(&self, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
        match self {
            Self::Ball(sphere) => {
                let distance = sphere.hit(origin, direction)?;
                Some((distance, sphere.outward(origin + direction * distance)))
            }
            Self::CutBall(ball) => ball.entry(origin, direction),
            Self::Cylinder(cylinder) => {
                if let Some(distance) = cylinder.hit_side(origin, direction) {
                    let point = origin + direction * distance;
                    return Some((distance, cylinder.outward(Border::Outer, point)));
                }
                let hit = |end: &Disc| Some((end.hit(origin, direction)?, end.normal));
                cylinder.ends()?.iter().find_map(hit)
            }
            Self::Box { half } => {
                let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
                let mut outward = DVec3::ZERO;
                for axis in 0..3 {
                    let (h, o, d) = (half[axis], origin[axis], direction[axis]);
                    if d == 0.0 {
                        if o.abs() >= h {
                            return None;
                        }
                        continue;
                    }
                    let (near, far) = ((-h * d.signum() - o) / d, (h * d.signum() - o) / d);
                    if near > enter {
                        enter = near;
                        outward = -DVec3::AXES[axis] * d.signum();
                    }
                    leave = leave.min(far);
                }
                (enter >= 0.0 && enter < leave).then_some((enter, outward))
            }
        }
    }

    /// Where a ray that is inside or on the border leaves: the distance, from zero on, and the
    /// outward unit normal; `None` if it never does.
    #[must_use]
    pub fn exit(&self, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
        let (distance, outward) = match self {
            Self::Ball(sphere) => {
                let distance = sphere.time_to_leave(origin, direction);
                (distance, sphere.outward(origin + direction * distance))
            }
            Self::CutBall(ball) => ball.exit(origin, direction),
            Self::Cylinder(cylinder) => {
                let (distance, part) = cylinder.time_to_leave(origin, direction);
                (distance, cylinder.outward(part, origin + direction * distance))
            }
            Self::Box { half } => {
                let far = |axis: usize| {
                    let d = direction[axis];
                    let distance = (half[axis] * d.signum() - origin[axis]) / d;
                    let distance = if d == 0.0 { f64::INFINITY } else { distance.max(0.0) };
                    (distance, DVec3::AXES[axis] * d.signum())
                };
                first_along((0..3).map(far))?
            }
        };
        distance.is_finite().then_some((distance, outward))
    }

    /// Whether a ray that goes on from a point is inside: within `slack` (cm) of the border its
    /// direction decides.
    #[must_use]
    pub fn holds_ahead(&self, point: DVec3, direction: DVec3, slack: f64) -> bool {
        // How far outside of a part of the border the point is, and the outward component of the
        // direction there.
        let inside = |off: f64, outward: f64| off < -slack || (off <= slack && outward < 0.0);
        match self {
            Self::Ball(sphere) => inside(point.length() - sphere.radius, direction.dot(point)),
            Self::CutBall(CutBall { sphere, plane }) => {
                inside(point.length() - sphere.radius, direction.dot(point))
                    && inside(plane.normal.dot(point) - plane.offset, direction.dot(plane.normal))
            }
            Self::Cylinder(cylinder) => {
                let (p, d) = (point.truncate(), direction.truncate());
                let extent = cylinder.extent;
                inside(p.length() - cylinder.radius, d.dot(p))
                    && inside(point.z - extent.max, direction.z)
                    && inside(extent.min - point.z, -direction.z)
            }
            Self::Box { half } => (0..3).all(|axis| {
                let (p, d) = (point[axis], direction[axis]);
                inside(p.abs() - half[axis], d * p.signum())
            }),
        }
    }
}

#[cfg(test)]
mod tests;
