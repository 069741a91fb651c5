//! Convex bodies, and whether they are in each other's way.

use super::{Extent, Outline, Pose};
use glam::{DVec2, DVec3};

/// A convex body.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// Nothing at all.
    Nothing,
    /// An outline in the xy-plane, extended along z; an outline of two corners makes a sheet.
    Prism {
        /// Its cross-section.
        outline: Outline,
        /// From where to where it reaches along z.
        extent: Extent,
    },
    /// A round cylinder along z.
    Cylinder {
        /// Where its axis is.
        centre: DVec2,
        /// Its radius, cm.
        radius: f64,
        /// From where to where it reaches along z.
        extent: Extent,
    },
    /// A ball.
    Ball {
        /// Its centre.
        centre: DVec3,
        /// Its radius, cm.
        radius: f64,
    },
}

impl Solid {
    /// A round cylinder about the z axis.
    #[must_use]
    pub fn cylinder(radius: f64, extent: Extent) -> Self {
        Self::Cylinder { centre: DVec2::ZERO, radius, extent }
    }

    /// A ball about the origin.
    #[must_use]
    pub fn ball(radius: f64) -> Self {
        Self::Ball { centre: DVec3::ZERO, radius }
    }

    /// Whether a point lies inside, border excluded.
    #[must_use]
    pub fn holds(&self, point: DVec3) -> bool {
        let between = |extent: &Extent| extent.min < point.z && point.z < extent.max;
        match self {
            Self::Nothing => false,
            Self::Prism { outline, extent } => {
                let p = point.truncate();
                between(extent)
                    && !outline.corners().is_empty()
                    && outline.sides().all(|(a, b)| (b - a).perp_dot(p - a) > 0.0)
            }
            Self::Cylinder { centre, radius, extent } => {
                between(extent) && point.truncate().distance_squared(*centre) < radius * radius
            }
            Self::Ball { centre, radius } => point.distance_squared(*centre) < radius * radius,
        }
    }

    /// The body at its place in the world.
    #[must_use]
    pub fn placed(&self, pose: &Pose) -> Self {
        let z = pose.origin().z;
        let moved = |extent: &Extent| Extent { min: extent.min + z, max: extent.max + z };
        match self {
            Self::Nothing => Self::Nothing,
            Self::Prism { outline, extent } => {
                let corners = outline.corners().iter().map(|c| pose.point_to_world(*c)).collect();
                Self::Prism { outline: Outline::new(corners), extent: moved(extent) }
            }
            Self::Cylinder { centre, radius, extent } => Self::Cylinder {
                centre: pose.point_to_world(*centre),
                radius: *radius,
                extent: moved(extent),
            },
            Self::Ball { centre, radius } => {
                Self::Ball { centre: pose.to_world(*centre), radius: *radius }
            }
        }
    }

    /// Whether the insides of two bodies meet; `slack` (cm) is how deep they may press into each
    /// other by rounding.
    #[must_use]
    pub fn overlaps(&self, other: &Self, slack: f64) -> bool {
        use Solid::{Ball, Cylinder, Nothing, Prism};
        match (self, other) {
            (Nothing, _) | (_, Nothing) => false,
            (Prism { outline, extent }, Prism { outline: second, extent: beyond }) => {
                extent.overlaps(*beyond) && outline.overlaps(second, slack)
            }
            (
                Cylinder { centre, radius, extent },
                Cylinder { centre: second, radius: size, extent: beyond },
            ) => extent.overlaps(*beyond) && centre.distance(*second) < radius + size - slack,
            (Ball { centre, radius }, Ball { centre: second, radius: size }) => {
                centre.distance(*second) < radius + size - slack
            }
            (Prism { outline, extent }, Cylinder { centre, radius, extent: beyond })
            | (Cylinder { centre, radius, extent: beyond }, Prism { outline, extent }) => {
                extent.overlaps(*beyond) && outline.distance(*centre) < radius - slack
            }
            (Ball { centre, radius }, Prism { outline, extent })
            | (Prism { outline, extent }, Ball { centre, radius }) => {
                let beside = outline.distance(centre.truncate());
                beside.hypot(extent.distance(centre.z)) < radius - slack
            }
            (Ball { centre, radius }, Cylinder { centre: axis, radius: size, extent })
            | (Cylinder { centre: axis, radius: size, extent }, Ball { centre, radius }) => {
                let beside = (centre.truncate().distance(*axis) - size).max(0.0);
                beside.hypot(extent.distance(centre.z)) < radius - slack
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLACK: f64 = 1e-9;

    fn box_of(half: f64) -> Solid {
        Solid::Prism {
            outline: Outline::rectangle(half, half),
            extent: Extent::centred(Some(2.0 * half)),
        }
    }

    fn moved(solid: &Solid, by: DVec3) -> Solid {
        solid.placed(&Pose::new(by, 0.0))
    }

    #[test]
    fn bodies_that_touch_do_not_overlap() {
        let cylinder = Solid::cylinder(1.0, Extent::centred(Some(2.0)));
        let bodies = [box_of(1.0), cylinder, Solid::ball(1.0)];
        for a in &bodies {
            for b in &bodies {
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    assert!(!a.overlaps(&moved(b, axis * 2.0), SLACK), "{a:?} {b:?} {axis}");
                    assert!(a.overlaps(&moved(b, axis * 1.99), SLACK), "{a:?} {b:?} {axis}");
                }
            }
        }
    }

    #[test]
    fn corners_and_rims_are_where_they_are() {
        let corner = DVec3::ONE + DVec3::ONE / 3f64.sqrt();
        let ball = Solid::ball(1.0);
        assert!(!box_of(1.0).overlaps(&moved(&ball, corner * 1.0001), SLACK));
        assert!(box_of(1.0).overlaps(&moved(&ball, corner * 0.9999), SLACK));
        let rim = DVec3::new(1.0 + 0.5f64.sqrt(), 0.0, 1.0 + 0.5f64.sqrt());
        let cylinder = Solid::cylinder(1.0, Extent::centred(Some(2.0)));
        assert!(!cylinder.overlaps(&moved(&ball, rim * 1.0001), SLACK));
        assert!(ball.overlaps(&moved(&cylinder, -rim * 0.9999), SLACK));
        let sheet = Solid::Prism {
            outline: Outline::new(vec![DVec2::new(0.0, -5.0), DVec2::new(0.0, 5.0)]),
            extent: Extent::centred(Some(4.0)),
        };
        assert!(sheet.overlaps(&moved(&ball, DVec3::new(0.99, 3.0, 1.0)), SLACK));
        assert!(!sheet.overlaps(&moved(&ball, DVec3::new(1.01, 3.0, 1.0)), SLACK));
        assert!(!sheet.overlaps(&moved(&cylinder, DVec3::new(0.5, 0.0, 3.5)), SLACK));
        assert!(!Solid::Nothing.overlaps(&ball, SLACK) && !Solid::Nothing.holds(DVec3::ZERO));
    }

    #[test]
    fn the_border_is_not_inside() {
        for solid in [box_of(1.0), Solid::cylinder(1.0, Extent::ENDLESS), Solid::ball(1.0)] {
            assert!(solid.holds(DVec3::ZERO) && solid.holds(DVec3::X * 0.999));
            assert!(!solid.holds(DVec3::X) && !solid.holds(DVec3::new(0.0, 1.001, 0.0)));
        }
    }
}
