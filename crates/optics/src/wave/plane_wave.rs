//! A plane wave with its fields.

use super::ComplexVector;
use glam::{DMat3, DVec3};

/// The Poynting vector Re(E × H*) of a wave.
#[must_use]
pub fn poynting(electric: ComplexVector, magnetic: ComplexVector) -> DVec3 {
    electric.re.cross(magnetic.re) + electric.im.cross(magnetic.im)
}

/// A plane wave: its wave vector and both fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneWave {
    /// Wave vector p = k/k0.
    pub wave_vector: DVec3,
    /// Electric field E.
    pub electric: ComplexVector,
    /// Magnetic field H, times the vacuum impedance.
    pub magnetic: ComplexVector,
}

impl PlaneWave {
    /// The Poynting vector Re(E × H*).
    #[must_use]
    pub fn poynting(&self) -> DVec3 {
        poynting(self.electric, self.magnetic)
    }

    /// How far the wave is from solving Maxwell's equations in a medium: the larger of
    /// |p × E - µH| and |p × H + εE|, relative to the fields.
    #[must_use]
    pub fn maxwell_residual(&self, permittivity: &DMat3, permeability: &DMat3) -> f64 {
        let p = self.wave_vector;
        let faraday = self.electric.crossed_by(p) - self.magnetic.transformed(permeability);
        let ampere = self.magnetic.crossed_by(p) + self.electric.transformed(permittivity);
        let scale = self.electric.norm_squared() + self.magnetic.norm_squared();
        (faraday.norm_squared().max(ampere.norm_squared()) / scale).sqrt()
    }
}
