//! Where a device stands and how it is turned.

use crate::wave::ComplexVector;
use glam::{DMat3, DVec2, DVec3};

/// A rotation about the device's own z axis followed by a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    origin: DVec3,
    cos: f64,
    sin: f64,
}

impl Pose {
    /// A device whose origin is at `origin` (cm), turned counterclockwise seen from +z by
    /// `rotation` degrees. Quarter turns are exact.
    #[must_use]
    pub fn new(origin: DVec3, rotation: f64) -> Self {
        let turn = rotation.rem_euclid(360.0);
        let (sin, cos) = match turn {
            0.0 => (0.0, 1.0),
            90.0 => (1.0, 0.0),
            180.0 => (0.0, -1.0),
            270.0 => (-1.0, 0.0),
            _ => turn.to_radians().sin_cos(),
        };
        Self { origin, cos, sin }
    }

    /// The place of what is at `first` in the frame that is at this pose.
    pub(super) fn after(&self, first: &Self) -> Self {
        Self {
            origin: self.to_world(first.origin),
            cos: self.cos * first.cos - self.sin * first.sin,
            sin: self.sin * first.cos + self.cos * first.sin,
        }
    }

    /// The device's origin in the world.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The rotation that takes vectors of the device's frame to the world.
    #[must_use]
    pub fn rotation(&self) -> DMat3 {
        let [x, y, z] = DVec3::AXES.map(|axis| self.vector_to_world(axis));
        DMat3::from_cols(x, y, z)
    }

    /// A point of the world in the device's frame.
    #[must_use]
    pub fn to_local(&self, point: DVec3) -> DVec3 {
        self.vector_to_local(point - self.origin)
    }

    /// A point of the device's frame in the world.
    #[must_use]
    pub fn to_world(&self, point: DVec3) -> DVec3 {
        self.vector_to_world(point) + self.origin
    }

    /// A vector of the world in the device's frame.
    #[must_use]
    pub fn vector_to_local(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.cos * v.x + self.sin * v.y, self.cos * v.y - self.sin * v.x, v.z)
    }

    /// A vector of the device's frame in the world.
    #[must_use]
    pub fn vector_to_world(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.cos * v.x - self.sin * v.y, self.cos * v.y + self.sin * v.x, v.z)
    }

    /// A field of the world in the device's frame.
    #[must_use]
    pub fn field_to_local(&self, field: ComplexVector) -> ComplexVector {
        ComplexVector::new(self.vector_to_local(field.re), self.vector_to_local(field.im))
    }

    /// A field of the device's frame in the world.
    #[must_use]
    pub fn field_to_world(&self, field: ComplexVector) -> ComplexVector {
        ComplexVector::new(self.vector_to_world(field.re), self.vector_to_world(field.im))
    }

    /// A point of the device's cross-section in the world's xy-plane.
    #[must_use]
    pub fn point_to_world(&self, point: DVec2) -> DVec2 {
        self.to_world(point.extend(0.0)).truncate()
    }
}
