//! Directions that are given by vectors of any length.

use glam::DVec3;

/// The unit vector along a vector of any length, however large or small; `None` for zero.
#[must_use]
pub fn unit(vector: DVec3) -> Option<DVec3> {
    // In two steps: the inverse of a denormal number is infinite.
    (vector / vector.abs().max_element()).try_normalize()
}
