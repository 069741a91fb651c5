//! Bodies, whole or with a hole, and whether they are in each other's way.

use super::convex::{Convex, REACH, SAME_AXIS, press};
use super::hollow::farthest;
use super::{CutBall, Extent, Hole, Lens, Outline, Plane, Polyhedron, Pose, lens_overlap};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// How deep two things may press into each other by rounding before they count as overlapping, cm.
pub const TOUCHING: f64 = 1e-9;

/// A convex body, a lens, a polyhedron, or a convex body with a hole.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
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
    /// A ball of which a plane has cut something off.
    CutBall {
        /// The centre of the ball.
        centre: DVec3,
        /// What is left of it, about that centre.
        ball: CutBall,
    },
    /// A convex body but for a hole, in which others may be.
    Hollow {
        /// The body with its hole filled.
        whole: Box<Solid>,
        /// The hole.
        hole: Box<Hole>,
    },
    /// A lens.
    Lens {
        /// The lens about the x axis of its own frame.
        lens: Lens,
        /// Where that frame is.
        pose: Pose,
    },
    /// A solid with flat faces.
    Polyhedron {
        /// The solid in its own frame.
        solid: Arc<Polyhedron>,
        /// Where that frame is.
        pose: Pose,
    },
    /// A prism or a cylinder whose axis is not along z.
    Tilted {
        /// The body in its own frame.
        solid: Box<Solid>,
        /// Where that frame is.
        pose: Pose,
    },
}

impl Solid {
    /// A round cylinder about the z axis.
    pub fn cylinder(radius: f64, extent: Extent) -> Self {
        Self::Cylinder { centre: DVec2::ZERO, radius, extent }
    }

    /// A ball about the origin.
    pub fn ball(radius: f64) -> Self {
        Self::Ball { centre: DVec3::ZERO, radius }
    }

    /// The body with a hole in it.
    pub fn with_hole(self, hole: Hole) -> Self {
        Self::Hollow { whole: Box::new(self), hole: Box::new(hole) }
    }

    /// Whether a point lies inside, border excluded.
    #[must_use]
    pub fn holds(&self, point: DVec3) -> bool {
        self.has(point, |less, more| less < more)
    }

    /// Whether a point lies inside or on the border; never in a sheet.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.has(point, |less, more| less <= more)
    }

    /// Whether a point lies inside, `below` telling of two numbers that are alike whether it is.
    fn has(&self, point: DVec3, below: impl Fn(f64, f64) -> bool + Copy) -> bool {
        let between = |extent: &Extent| below(extent.min, point.z) && below(point.z, extent.max);
        let at = point.truncate();
        match self {
            Self::Nothing => false,
            Self::Prism { outline, extent } => {
                between(extent)
                    && outline.corners.len() > 2
                    && outline.sides().all(|(a, b)| below(0.0, (b - a).perp_dot(at - a)))
            }
            Self::Cylinder { centre, radius, extent } => {
                between(extent) && below(at.distance_squared(*centre), radius * radius)
            }
            Self::CutBall { centre, ball } => below(ball.height(point - centre), 0.0),
            Self::Ball { centre, radius } => {
                below(point.distance_squared(*centre), radius * radius)
            }
            Self::Hollow { whole, hole } => whole.has(point, below) && !hole.holds(point),
            Self::Lens { lens, pose } => lens.has(pose.to_local(point), below),
            Self::Polyhedron { solid, pose } => solid.holds(pose.to_local(point)),
            Self::Tilted { solid, pose } => solid.has(pose.to_local(point), below),
        }
    }

    /// The least and the greatest coordinates, infinite where it has no end; `None` for nothing.
    #[must_use]
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let boxed = |[low, high]: [DVec2; 2], extent: &Extent| {
            [low.extend(extent.min), high.extend(extent.max)]
        };
        match self {
            Self::Nothing => None,
            Self::Prism { outline, extent } => {
                let corners = || outline.corners.iter().copied();
                Some(boxed([corners().reduce(DVec2::min)?, corners().reduce(DVec2::max)?], extent))
            }
            Self::Cylinder { centre, radius, extent } => {
                Some(boxed([*centre - *radius, *centre + *radius], extent))
            }
            Self::Ball { centre, radius } => Some([*centre - *radius, *centre + *radius]),
            Self::CutBall { centre, ball } => {
                let end =
                    |sign: f64, axis: usize| ball.farthest_along(sign * DVec3::AXES[axis])[axis];
                let ends = |sign: f64| DVec3::from_array([0, 1, 2].map(|axis| end(sign, axis)));
                Some([*centre + ends(-1.0), *centre + ends(1.0)])
            }
            Self::Hollow { whole, .. } => whole.bounds(),
            Self::Lens { lens, pose } => {
                let end = |axis: DVec3| lens.support(pose.vector_to_local(axis));
                let ends = |sign: f64| DVec3::AXES.map(|axis| sign * end(sign * axis));
                Some([-1.0, 1.0].map(|sign| pose.origin + DVec3::from_array(ends(sign))))
            }
            Self::Polyhedron { solid, pose } => {
                let end = |axis: DVec3| solid.support(pose.vector_to_local(axis));
                let ends = |sign: f64| DVec3::AXES.map(|axis| sign * end(sign * axis));
                Some([-1.0, 1.0].map(|sign| pose.origin + DVec3::from_array(ends(sign))))
            }
            Self::Tilted { .. } => {
                let convex = Convex::of(self)?;
                let ends = |sign: f64| DVec3::AXES.map(|axis| sign * convex.support(sign * axis));
                Some([ends(-1.0), ends(1.0)].map(DVec3::from_array))
            }
        }
    }

    /// The body at its place in the world.
    pub fn placed(&self, pose: &Pose) -> Self {
        let axis = pose.axis();
        let aside = axis.truncate().abs().max_element();
        match self {
            Self::Nothing => Self::Nothing,
            Self::Ball { centre, radius } => {
                Self::Ball { centre: pose.to_world(*centre), radius: *radius }
            }
            Self::CutBall { centre, ball } => {
                let normal = pose.vector_to_world(ball.plane.normal);
                let plane = Plane { normal, ..ball.plane };
                Self::CutBall { centre: pose.to_world(*centre), ball: CutBall { plane, ..*ball } }
            }
            Self::Hollow { whole, hole } => Self::Hollow {
                whole: Box::new(whole.placed(pose)),
                hole: Box::new(hole.placed(pose)),
            },
            Self::Lens { lens, pose: own } => Self::Lens { lens: *lens, pose: pose.after(own) },
            Self::Polyhedron { solid, pose: own } => {
                Self::Polyhedron { solid: Arc::clone(solid), pose: pose.after(own) }
            }
            Self::Tilted { solid, pose: own } => solid.placed(&pose.after(own)),
            Self::Prism { .. } | Self::Cylinder { .. } if aside > SAME_AXIS => {
                Self::Tilted { solid: Box::new(self.clone()), pose: *pose }
            }
            Self::Prism { outline, extent } => {
                let mut corners: Vec<DVec2> =
                    outline.corners.iter().map(|c| pose.point_to_world(*c)).collect();
                if axis.z < 0.0 {
                    corners.reverse();
                }
                Self::Prism { outline: Outline { corners }, extent: extent.placed(pose) }
            }
            Self::Cylinder { centre, radius, extent } => Self::Cylinder {
                centre: pose.point_to_world(*centre),
                radius: *radius,
                extent: extent.placed(pose),
            },
        }
    }

    /// Whether the insides of two bodies meet; `slack` (cm) is how deep they may press into each
    /// other by rounding.
    #[must_use]
    pub fn overlaps(&self, other: &Self, slack: f64) -> bool {
        use Solid::{Ball, CutBall, Cylinder, Hollow, Lens, Nothing, Prism, Tilted};
        match (self, other) {
            (Nothing, _) | (_, Nothing) => false,
            (Hollow { whole, hole }, other) | (other, Hollow { whole, hole }) => {
                whole.overlaps(other, slack) && !hole.encloses(other, slack)
            }
            (Self::Polyhedron { solid, pose }, other)
            | (other, Self::Polyhedron { solid, pose }) => {
                solid.overlaps(&other.placed(&pose.inverse()), slack)
            }
            (Lens { lens, pose }, other) | (other, Lens { lens, pose }) => {
                lens_overlap::overlaps(lens, pose, other, slack)
            }
            (CutBall { .. }, _) | (_, CutBall { .. }) => press(self, other, slack),
            (Tilted { solid, pose }, other) | (other, Tilted { solid, pose }) => {
                // Where both have the same axis it is as if they were upright.
                let other = other.placed(&pose.inverse());
                match (Convex::of(solid), Convex::of(&other)) {
                    (Some(solid), Some(other)) if other.is_tilted() => {
                        solid.overlaps(&other, slack)
                    }
                    _ => solid.overlaps(&other, slack),
                }
            }
            (Prism { outline, extent }, Prism { outline: second, extent: beyond }) => {
                extent.overlaps(*beyond, slack) && outline.overlaps(second, slack)
            }
            (
                Cylinder { centre, radius, extent },
                Cylinder { centre: second, radius: size, extent: beyond },
            ) => {
                extent.overlaps(*beyond, slack) && centre.distance(*second) < radius + size - slack
            }
            (Ball { centre, radius }, Ball { centre: second, radius: size }) => {
                centre.distance(*second) < radius + size - slack
            }
            (Prism { outline, extent }, Cylinder { centre, radius, extent: beyond })
            | (Cylinder { centre, radius, extent: beyond }, Prism { outline, extent }) => {
                extent.overlaps(*beyond, slack) && outline.distance(*centre) < radius - slack
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

    /// Whether every point of this body is one of the other, a convex one, or no more than
    /// [`TOUCHING`] outside.
    #[must_use]
    pub fn is_within(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Nothing, _) => true,
            // No body is one of these: nothing is asked to be within one.
            (
                _,
                Self::Nothing
                | Self::Hollow { .. }
                | Self::CutBall { .. }
                | Self::Lens { .. }
                | Self::Polyhedron { .. },
            ) => false,
            (Self::Hollow { whole, .. }, _) => whole.is_within(other),
            (_, Self::Ball { centre, radius }) => farthest(self, *centre) <= radius + TOUCHING,
            _ => Convex::of(other).is_some_and(|around| match (self, Convex::of(self)) {
                // To a round side it is the whole ball.
                (Self::CutBall { centre, ball }, _) => around.holds(
                    TOUCHING,
                    |direction| direction.dot(*centre + ball.farthest_along(direction)),
                    |distance| distance(*centre) + ball.sphere.radius,
                ),
                (Self::Lens { lens, pose }, _) => around.holds(
                    TOUCHING,
                    |direction| {
                        direction.dot(pose.origin) + lens.support(pose.vector_to_local(direction))
                    },
                    |distance| lens.greatest(|at| distance(pose.to_world(at))),
                ),
                (Self::Polyhedron { solid, pose }, _) => around.holds(
                    TOUCHING,
                    |direction| {
                        direction.dot(pose.origin) + solid.support(pose.vector_to_local(direction))
                    },
                    |distance| solid.greatest(|at| distance(pose.to_world(at))),
                ),
                (Self::Ball { centre, radius }, _) => around.holds(
                    TOUCHING,
                    |direction| direction.dot(*centre) + radius * direction.length(),
                    |distance| distance(*centre) + radius,
                ),
                (_, Some(inner)) => around.holds(
                    TOUCHING,
                    |direction| inner.support(direction),
                    |distance| inner.greatest(Extent::ENDLESS, distance),
                ),
                // An outline without corners.
                _ => true,
            }),
        }
    }

    /// The least distance between two parallel planes that it fits between, cm; a hole does not
    /// count.
    #[must_use]
    pub fn thickness(&self) -> f64 {
        match self {
            Self::Nothing => 0.0,
            Self::Prism { outline, extent } => {
                let width = |(a, b): (DVec2, DVec2)| {
                    let along = (b - a).normalize_or_zero();
                    let beside = outline.corners.iter().map(|at| along.perp_dot(*at - a).abs());
                    beside.fold(0.0, f64::max)
                };
                outline.sides().map(width).fold(extent.max - extent.min, f64::min)
            }
            Self::Cylinder { radius, extent, .. } => (2.0 * radius).min(extent.max - extent.min),
            Self::Ball { radius, .. } => 2.0 * radius,
            Self::CutBall { ball, .. } => {
                (ball.sphere.radius + ball.plane.offset).min(2.0 * ball.sphere.radius)
            }
            Self::Hollow { whole, .. } => whole.thickness(),
            Self::Lens { lens, .. } => {
                let [low, high] = lens.ends();
                (high - low).min(2.0 * lens.radius)
            }
            Self::Polyhedron { solid, .. } => solid.thickness(),
            Self::Tilted { solid, .. } => solid.thickness(),
        }
    }

    /// Whether two thin sheets lie on each other.
    #[must_use]
    pub fn coincides(&self, other: &Self, slack: f64) -> bool {
        let (Some(sheet), Some(other)) = (self.sheet(), other.sheet()) else { return false };
        let [a, _, b, _] = sheet;
        let along = (sheet[1] - a).normalize_or_zero();
        let up = (b - sheet[1]).normalize_or_zero();
        let across = along.cross(up);
        let in_plane = |corners: [DVec3; 4]| {
            let corners = corners.map(|at| DVec2::new(along.dot(at - a), up.dot(at - a)));
            Outline::hull(corners.to_vec())
        };
        other.iter().all(|at| across.dot(*at - a).abs() < slack)
            && in_plane(sheet).overlaps(&in_plane(other), slack)
    }

    /// The corners of a sheet, around it; those of an endless one are far away.
    pub(super) fn sheet(&self) -> Option<[DVec3; 4]> {
        match self {
            Self::Prism { outline, extent } => {
                let [a, b] = &outline.corners[..] else { return None };
                let [low, high] = [extent.min.max(-REACH), extent.max.min(REACH)];
                Some([a.extend(low), b.extend(low), b.extend(high), a.extend(high)])
            }
            Self::Tilted { solid, pose } => {
                solid.sheet().map(|corners| corners.map(|corner| pose.to_world(corner)))
            }
            _ => None,
        }
    }

    /// The outline of what it hides of the xy-plane, seen along z; round ones with corners. What
    /// has no end is cut at [`REACH`].
    pub fn shadow(&self) -> Outline {
        match self {
            Self::Nothing => Outline { corners: Vec::new() },
            Self::Prism { outline, .. } => outline.clone(),
            Self::Cylinder { centre, radius, .. } => Outline::circle(*centre, *radius),
            Self::Ball { centre, radius } => Outline::circle(centre.truncate(), *radius),
            Self::CutBall { centre, ball } => {
                let around = Outline::circle(DVec2::ZERO, 1.0);
                let tips = around.corners.iter().map(|at| ball.farthest_along(at.extend(0.0)));
                Outline::hull(tips.map(|tip| (*centre + tip).truncate()).collect())
            }
            Self::Hollow { whole, .. } => whole.shadow(),
            Self::Lens { lens, pose } => {
                let points = lens.rings().into_iter();
                Outline::hull(points.map(|at| pose.to_world(at).truncate()).collect())
            }
            Self::Polyhedron { solid, pose } => solid.shadow(|at| pose.to_world(at)),
            Self::Tilted { .. } => {
                let points = Convex::of(self).map(|convex| convex.extremes(Extent::ENDLESS));
                Outline::hull(points.iter().flatten().map(|at| at.truncate()).collect())
            }
        }
    }
}

#[cfg(test)]
mod tests;
