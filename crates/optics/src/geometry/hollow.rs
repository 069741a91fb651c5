//! Holes of bodies, in which other bodies may be.

use super::{Extent, FloorCurve, Outline, Pose, Solid};
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
        /// From where to where the body reaches along z.
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
                let z = place.origin().z;
                let extent = Extent { min: extent.min + z, max: extent.max + z };
                Self::Lens { curve: curve.clone(), pose: place.after(pose), extent }
            }
        }
    }

    /// Whether all of a body that lies between the ends of the hole is inside of it; `slack` (cm) is how deep it
    /// may press into the border by rounding.
    pub(super) fn encloses(&self, body: &Solid, slack: f64) -> bool {
        match (self, body) {
            (_, Solid::Nothing) => true,
            (_, Solid::Hollow { whole, .. }) => self.encloses(whole, slack),
            (Self::Round(Solid::Ball { centre, radius }), _) => {
                farthest(body, *centre) <= radius + slack
            }
            (Self::Round(Solid::Cylinder { centre, radius, extent }), _) => {
                let reach = match section(body, *extent) {
                    Section::Outline(outline) => {
                        let corners = outline.corners().iter();
                        corners.map(|corner| corner.distance(*centre)).fold(0.0, f64::max)
                    }
                    Section::Disc(middle, size) => middle.distance(*centre) + size,
                };
                reach <= radius + slack
            }
            (Self::Round(_), _) => false,
            (Self::Lens { curve, pose, extent }, _) => {
                let local = |point: DVec2| pose.to_local(point.extend(0.0)).truncate();
                match section(body, *extent) {
                    Section::Outline(outline) => {
                        let corners = outline.corners().iter().map(|corner| local(*corner));
                        curve.encloses(&Outline::new(corners.collect()))
                    }
                    Section::Disc(middle, size) => {
                        let middle = local(middle);
                        curve.contains(middle) && curve.depth(middle) >= size - slack
                    }
                }
            }
        }
    }
}

/// The widest cross-section of a body.
enum Section<'s> {
    Outline(&'s Outline),
    /// Middle and radius.
    Disc(DVec2, f64),
}

/// The widest cross-section of a body between two z.
fn section(body: &Solid, extent: Extent) -> Section<'_> {
    match body {
        Solid::Prism { outline, .. } => Section::Outline(outline),
        Solid::Cylinder { centre, radius, .. } => Section::Disc(*centre, *radius),
        Solid::Ball { centre, radius } => {
            let aside = extent.distance(centre.z);
            Section::Disc(centre.truncate(), (radius * radius - aside * aside).max(0.0).sqrt())
        }
        Solid::Hollow { whole, .. } => section(whole, extent),
        Solid::Nothing => Section::Disc(DVec2::ZERO, 0.0),
    }
}

/// How far the farthest point of a body is from a point.
fn farthest(body: &Solid, point: DVec3) -> f64 {
    let along = |extent: &Extent| (extent.max - point.z).max(point.z - extent.min);
    match body {
        Solid::Nothing => 0.0,
        Solid::Prism { outline, extent } => {
            let corners = outline.corners().iter();
            let beside = corners.map(|corner| corner.distance(point.truncate()));
            beside.fold(0.0, f64::max).hypot(along(extent))
        }
        Solid::Cylinder { centre, radius, extent } => {
            (centre.distance(point.truncate()) + radius).hypot(along(extent))
        }
        Solid::Ball { centre, radius } => centre.distance(point) + radius,
        Solid::Hollow { whole, .. } => farthest(whole, point),
    }
}
