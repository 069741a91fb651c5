//! Holes of bodies, in which other bodies may be.

use super::convex::Convex;
use super::{CutBall, Extent, FloorCurve, Outline, Pose, Solid, Sphere};
use glam::{DVec2, DVec3};

/// A hole in a convex body.
#[derive(Clone, Debug, PartialEq)]
pub enum Hole {
    /// A ball, or a round cylinder from end to end of the body.
    Round(Solid),
    /// Between the floor of a conformal map and its mirror image, from end to end of the body.
    Lens {
        /// Its cross-section in a frame of its own.
        curve: FloorCurve,
        /// Where that frame is.
        pose: Pose,
        /// From where to where the body reaches along z of that frame.
        extent: Extent,
    },
}

impl Hole {
    /// Whether a point lies inside, its border excluded.
    #[must_use]
    pub fn holds(&self, point: DVec3) -> bool {
        match self {
            Self::Round(solid) => solid.holds(point),
            Self::Lens { curve, pose, .. } => curve.contains(pose.to_local(point).truncate()),
        }
    }

    /// The hole of the body at its place in the world.
    #[must_use]
    pub fn placed(&self, place: &Pose) -> Self {
        match self {
            Self::Round(solid) => Self::Round(solid.placed(place)),
            Self::Lens { curve, pose, extent } => {
                Self::Lens { curve: curve.clone(), pose: place.after(pose), extent: *extent }
            }
        }
    }

    /// Whether all of a body that lies between the ends of the hole is inside of it; `slack` (cm)
    /// is how deep it may press into the border by rounding.
    pub(super) fn encloses(&self, body: &Solid, slack: f64) -> bool {
        match (self, body) {
            (_, Solid::Nothing) => true,
            (_, Solid::Hollow { whole, .. }) => self.encloses(whole, slack),
            // To other holes than a ball a lens is the cylinder around it.
            (Self::Round(Solid::Ball { centre, radius }), Solid::Lens { .. }) => {
                farthest(body, *centre) <= radius + slack
            }
            (_, Solid::Lens { lens, pose }) => {
                self.encloses(&lens.cylinder_around().placed(pose), slack)
            }
            (Self::Round(Solid::Tilted { solid, pose }), _) => {
                Self::Round(solid.as_ref().clone()).encloses(&body.placed(&pose.inverse()), slack)
            }
            (Self::Round(Solid::Cylinder { centre, radius, .. }), Solid::Polyhedron { .. }) => {
                let beside = |at: DVec3| at.truncate().distance(*centre);
                greatest(body, &beside) <= radius + slack
            }
            (Self::Lens { curve, pose, .. }, Solid::Polyhedron { .. }) => {
                curve.encloses(&body.placed(&pose.inverse()).shadow())
            }
            (Self::Round(Solid::Ball { centre, radius }), _) => {
                farthest(body, *centre) <= radius + slack
            }
            (Self::Round(Solid::Cylinder { centre, radius, extent }), _) => {
                let beside = |at: DVec2| at.distance(*centre);
                let reach = match section(body, *extent) {
                    WidestSection::Outline(outline) => {
                        outline.corners.iter().map(|corner| beside(*corner)).fold(0.0, f64::max)
                    }
                    WidestSection::Disc(middle, size) => beside(middle) + size,
                    WidestSection::Tilted(body) => {
                        body.greatest(*extent, |at| beside(at.truncate()))
                    }
                };
                reach <= radius + slack
            }
            (Self::Round(_), _) => false,
            (Self::Lens { curve, pose, extent }, _) => {
                let body = body.placed(&pose.inverse());
                match section(&body, *extent) {
                    WidestSection::Outline(outline) => curve.encloses(outline),
                    WidestSection::Disc(middle, size) => {
                        curve.contains(middle) && curve.depth(middle) >= size - slack
                    }
                    WidestSection::Tilted(body) => {
                        let points = body.extremes(*extent).into_iter();
                        curve.encloses(&Outline::hull(points.map(DVec3::truncate).collect()))
                    }
                }
            }
        }
    }
}

/// The widest cross-section of a body.
enum WidestSection<'s> {
    Outline(&'s Outline),
    /// Middle and radius.
    Disc(DVec2, f64),
    /// None is the widest.
    Tilted(Convex<'s>),
}

/// The widest cross-section of a body between two z.
fn section(body: &Solid, extent: Extent) -> WidestSection<'_> {
    match body {
        Solid::Prism { outline, .. } => WidestSection::Outline(outline),
        Solid::Cylinder { centre, radius, .. } => WidestSection::Disc(*centre, *radius),
        // To a round hole a cut ball is the whole one.
        Solid::Ball { centre, radius }
        | Solid::CutBall { centre, ball: CutBall { sphere: Sphere { radius }, .. } } => {
            let aside = extent.distance(centre.z);
            WidestSection::Disc(
                centre.truncate(),
                (radius * radius - aside * aside).max(0.0).sqrt(),
            )
        }
        Solid::Hollow { whole, .. } => section(whole, extent),
        // Lenses are asked for by the cylinder around them, polyhedra by their corners.
        Solid::Nothing | Solid::Lens { .. } | Solid::Polyhedron { .. } => {
            WidestSection::Disc(DVec2::ZERO, 0.0)
        }
        Solid::Tilted { .. } => {
            Convex::of(body).map_or(WidestSection::Disc(DVec2::ZERO, 0.0), WidestSection::Tilted)
        }
    }
}

/// The greatest value of a convex function over a polyhedron.
fn greatest(body: &Solid, value: &dyn Fn(DVec3) -> f64) -> f64 {
    match body {
        Solid::Polyhedron { solid, pose } => solid.greatest(|at| value(pose.to_world(at))),
        _ => f64::INFINITY,
    }
}

/// How far the farthest point of a body is from a point.
pub(super) fn farthest(body: &Solid, point: DVec3) -> f64 {
    let along = |extent: &Extent| (extent.max - point.z).max(point.z - extent.min);
    match body {
        Solid::Nothing => 0.0,
        Solid::Prism { outline, extent } => {
            let corners = outline.corners.iter();
            let beside = corners.map(|corner| corner.distance(point.truncate()));
            beside.fold(0.0, f64::max).hypot(along(extent))
        }
        Solid::Cylinder { centre, radius, extent } => {
            (centre.distance(point.truncate()) + radius).hypot(along(extent))
        }
        Solid::Ball { centre, radius } => centre.distance(point) + radius,
        Solid::CutBall { centre, ball } => ball.farthest_from(point - centre),
        Solid::Lens { lens, pose } => lens.farthest_from(pose.to_local(point)),
        Solid::Polyhedron { .. } => greatest(body, &|at| at.distance(point)),
        Solid::Hollow { whole, .. } => farthest(whole, point),
        Solid::Tilted { solid, pose } => farthest(solid, pose.to_local(point)),
    }
}
