//! Surfaces, and where a ray meets them.
//!
//! Devices that extend along z are made of upright [`Wall`]s over a line in the xy-plane and of
//! flat [`Cap`]s at their ends. Inside a convex cell a ray leaves through the first [`Plane`] ahead.

mod cap;
mod floor_curve;
mod outline;
mod plane;
mod pose;
mod wall;

pub use cap::Cap;
pub use floor_curve::FloorCurve;
pub use outline::Outline;
pub use plane::Plane;
pub use pose::Pose;
pub use wall::Wall;

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

    /// Whether two extents share more than a point.
    #[must_use]
    pub fn overlaps(self, other: Self) -> bool {
        self.min < other.max && other.min < self.max
    }
}
