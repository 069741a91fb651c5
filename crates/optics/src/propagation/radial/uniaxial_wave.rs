//! Rays and fields of the waves of a uniaxial dielectric (µ = 1).

use crate::medium::ModeKind;
use glam::{DMat3, DVec3};

/// A uniaxial dielectric at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::propagation) struct UniaxialPoint {
    pub ordinary: f64,
    pub extraordinary: f64,
    pub axis: DVec3,
}

impl UniaxialPoint {
    /// The vector along the ray of the extraordinary wave, εp.
    pub fn extraordinary_ray(&self, wave_vector: DVec3) -> DVec3 {
        let along = self.axis * wave_vector.dot(self.axis);
        wave_vector * self.ordinary + along * (self.extraordinary - self.ordinary)
    }

    /// The electric field of a wave of unit power. Along the axis, where both waves are one, the
    /// ordinary field and the extraordinary magnetic field lie along z.
    pub fn field(&self, wave_vector: DVec3, mode: ModeKind) -> DVec3 {
        let across = wave_vector.cross(self.axis);
        let u = if across.length_squared() < 1e-28 * wave_vector.length_squared() {
            DVec3::Z
        } else {
            across.normalize()
        };
        self.field_across(wave_vector, u, mode)
    }

    /// The same, given the unit vector along which the ordinary electric or the extraordinary
    /// magnetic field lies.
    pub fn field_across(&self, wave_vector: DVec3, u: DVec3, mode: ModeKind) -> DVec3 {
        let curl = wave_vector.cross(u);
        let (electric, magnetic) = if mode == ModeKind::Extraordinary {
            let along = self.axis * curl.dot(self.axis);
            let excess = 1.0 / self.extraordinary - 1.0 / self.ordinary;
            (-(curl / self.ordinary + along * excess), u)
        } else {
            (u, curl)
        };
        electric / electric.cross(magnetic).length().sqrt()
    }
}

/// What takes the field of a wave along its path, given its fields of unit power at both ends.
pub(in crate::propagation) fn transport(before: DVec3, after: DVec3) -> DMat3 {
    let dual = before / before.length_squared();
    DMat3::from_cols(after * dual.x, after * dual.y, after * dual.z)
}
