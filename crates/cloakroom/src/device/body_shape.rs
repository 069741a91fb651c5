//! What a body is: its shape, what fills it, and whether it gives way to others.

use crate::photograph::ImageSource;
use glam::DVec3;
use optics::geometry::{Cylinder, CylinderPart, Sphere};
use optics::medium::Medium;

/// A convex body, which may overlap other bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its shape, about the origin of its frame.
    pub shape: BodyShape,
    /// What fills it.
    pub filling: Filling,
    /// Where bodies overlap, the one of the larger priority is there.
    pub priority: i64,
}

impl Body {
    /// The image on it, if it is opaque and has one.
    #[must_use]
    pub fn image(&self) -> Option<&ImageSource> {
        match &self.filling {
            Filling::Opaque(Surface::Image(source)) => Some(source),
            _ => None,
        }
    }
}

/// What fills a body.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a scene has few bodies, and they are met often")]
pub enum Filling {
    /// A homogeneous medium.
    Medium {
        /// The medium, in the body's frame.
        medium: Medium,
        /// The speed of light over that of a pulse; absent: the size of the index along the ray, 1 at
        /// least.
        group_index: Option<f64>,
    },
    /// Nothing that light could enter: rays end on it.
    Opaque(Surface),
}

/// What an opaque body shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// Linear red, green and blue that it sends out everywhere.
    Color([f64; 3]),
    /// An image, laid on its shape.
    Image(ImageSource),
}

/// A convex shape about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BodyShape {
    /// A box; an endless one has infinite sides.
    Box {
        /// Half its size along x, y and z, cm.
        half: DVec3,
    },
    /// A ball.
    Ball(Sphere),
    /// A round cylinder about the z axis.
    Cylinder(Cylinder),
}

impl BodyShape {
    /// Whether it has no end somewhere.
    #[must_use]
    pub fn is_endless(&self) -> bool {
        match self {
            Self::Ball(_) => false,
            Self::Cylinder(cylinder) => cylinder.extent.ends().is_none(),
            Self::Box { half } => !half.is_finite(),
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
            Self::Cylinder(cylinder) => {
                if let Some(distance) = cylinder.hit_side(origin, direction) {
                    let point = origin + direction * distance;
                    return Some((distance, cylinder.outward(CylinderPart::Side, point)));
                }
                let ends = cylinder.ends()?;
                let hit =
                    |end: &optics::geometry::Disc| Some((end.hit(origin, direction)?, end.normal));
                ends.iter().find_map(hit)
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

    /// Where a ray that is inside or on the border leaves: the distance, from zero on, and the outward unit
    /// normal; `None` if it never does.
    #[must_use]
    pub fn exit(&self, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
        let (distance, outward) = match self {
            Self::Ball(sphere) => {
                let distance = sphere.time_to_leave(origin, direction);
                (distance, sphere.outward(origin + direction * distance))
            }
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
                (0..3).map(far).fold((f64::INFINITY, DVec3::ZERO), |least, exit| {
                    if exit.0 < least.0 { exit } else { least }
                })
            }
        };
        distance.is_finite().then_some((distance, outward))
    }
}
