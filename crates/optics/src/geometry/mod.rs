//! Surfaces, and where a ray meets them.
//!
//! Devices that extend along z are made of upright [`Wall`]s over a line in the xy-plane and of
//! flat [`Cap`]s at their ends, round ones of a [`Cylinder`] and of [`Disc`]s; a [`Sphere`] is
//! whole, a [`Lens`] has conic faces, and a [`Polyhedron`] flat ones. Inside a convex cell a ray leaves through the first [`Plane`] ahead. A [`Solid`] is the
//! space that something takes up.

mod convex;
mod cut_ball;
mod cylinder;
mod flat_or_round;
mod floor_curve;
mod hollow;
mod lens;
mod lens_overlap;
mod outline;
mod plane;
mod polygon;
mod polyhedron;
mod pose;
mod solid;
mod sphere;
mod wall;

pub use convex::REACH;
pub use cut_ball::CutBall;
pub use cylinder::{Border, Cylinder, Disc};
pub use flat_or_round::FlatOrRound;
pub use floor_curve::{CurvedSide, FloorCurve, FloorHit, MetalBack};
pub use hollow::Hole;
pub use lens::{ConicFace, Lens, LensPart};
pub use outline::{Cap, Outline};
pub use plane::Plane;
pub use polygon::{ConvexPart, Polygon, PolygonError, SAME_POINT};
pub use polyhedron::{
    FaceHit, MeshFault, PlanesFault, Polyhedron, Triangles, convex_hull, within_planes,
};
pub use pose::Pose;
pub use solid::{Solid, TOUCHING};
pub use sphere::Sphere;
pub use wall::Wall;

/// Of what a ray meets, each with its distance, the nearest; of several that are as near, the
/// first.
#[inline]
pub fn first_along<T>(met: impl Iterator<Item = (f64, T)>) -> Option<(f64, T)> {
    met.reduce(|nearest, next| if next.0 < nearest.0 { next } else { nearest })
}

/// From where to where something extends along z, cm; endless ends are infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Lower end.
    pub min: f64,
    /// Upper end.
    pub max: f64,
}

impl Extent {
    /// Without ends.
    pub const ENDLESS: Self = Self { min: f64::NEG_INFINITY, max: f64::INFINITY };

    /// Of the given whole length about the origin, or endless.
    #[must_use]
    pub fn centred(length: Option<f64>) -> Self {
        length.map_or(Self::ENDLESS, |length| Self { min: -length / 2.0, max: length / 2.0 })
    }

    /// The end coordinates, if there are ends.
    #[must_use]
    pub fn ends(self) -> Option<[f64; 2]> {
        (self.min.is_finite() && self.max.is_finite()).then_some([self.min, self.max])
    }

    /// Whether a coordinate lies within, ends included.
    #[must_use]
    pub fn contains(self, z: f64) -> bool {
        self.min <= z && z <= self.max
    }

    /// How far a coordinate lies outside, 0 within.
    #[must_use]
    pub fn distance(self, z: f64) -> f64 {
        (self.min - z).max(z - self.max).max(0.0)
    }

    /// Whether two extents share more than `slack` (cm).
    #[must_use]
    pub fn overlaps(self, other: Self, slack: f64) -> bool {
        self.min < other.max - slack && other.min < self.max - slack
    }

    /// The extent at a place whose axis is along z, one way or the other.
    fn placed(self, pose: &Pose) -> Self {
        let z = pose.origin.z;
        if pose.axis().z < 0.0 {
            Self { min: z - self.max, max: z - self.min }
        } else {
            Self { min: self.min + z, max: self.max + z }
        }
    }
}
