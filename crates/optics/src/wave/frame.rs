//! The frame in which an interface is worked out.

use super::{ComplexVector, number::Number};
use glam::{DMat3, DVec3};

/// A right-handed frame on an interface: two tangents and the normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub first: DVec3,
    pub second: DVec3,
    pub normal: DVec3,
}

impl Frame {
    /// The frame with the given unit normal whose first tangent lies along `tangential`, or
    /// anywhere in the plane if that vanishes.
    pub fn new(normal: DVec3, tangential: DVec3) -> Self {
        let length = tangential.length();
        if length > 0.1 {
            let first = tangential / length;
            return Self { first, second: normal.cross(first), normal };
        }
        let first =
            if length > 1e-9 { tangential / length } else { normal.any_orthonormal_vector() };
        // Once more across the normal: the tangential part is short and its direction rough.
        let first = (first - normal * normal.dot(first)).normalize();
        Self { first, second: normal.cross(first), normal }
    }

    /// The components of a vector in the frame.
    pub fn components(&self, vector: DVec3) -> [f64; 3] {
        [vector.dot(self.first), vector.dot(self.second), vector.dot(self.normal)]
    }

    /// The vector that has the given components in the frame.
    pub fn vector(&self, [a, b, c]: [f64; 3]) -> DVec3 {
        self.first * a + self.second * b + self.normal * c
    }

    /// The complex vector that has the given components in the frame.
    pub fn complex_vector<T: Number>(&self, components: [T; 3]) -> ComplexVector {
        let components = components.map(Into::into);
        ComplexVector::new(
            self.vector(components.map(|c| c.re)),
            self.vector(components.map(|c| c.im)),
        )
    }

    /// The matrix, by rows, of a symmetric tensor in the frame.
    pub fn tensor(&self, tensor: &DMat3) -> [[f64; 3]; 3] {
        [self.first, self.second, self.normal].map(|axis| self.components(*tensor * axis))
    }
}
