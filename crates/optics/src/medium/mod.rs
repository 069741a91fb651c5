//! Media: what light meets, described by its permittivity and permeability tensors.
//!
//! A [`Medium`] is homogeneous. A graded medium is a local homogeneous one at every point; how
//! light runs through it is the business of [`crate::propagation`].

mod wave_surface;

pub use wave_surface::{NormalComponent, WaveSurface};

use crate::wave::{ComplexVector, poynting};
use glam::{DMat3, DVec3};

/// Why a medium cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MediumError {
    /// A number is NaN, infinite, or zero where it must not be.
    #[error("{quantity} is {value}; it must be finite and not zero")]
    Degenerate {
        /// What the number is.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// The tensor is not symmetric; such media are not reciprocal and are not supported.
    #[error("the {quantity} tensor is not symmetric")]
    NotSymmetric {
        /// Which tensor.
        quantity: &'static str,
    },
}

/// A homogeneous, lossless medium in which both polarizations share one wave vector: isotropic, or
/// impedance matched (ε = µ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    permittivity: DMat3,
    permeability: DMat3,
    inverse_permeability: DMat3,
    surface: WaveSurface,
}

impl Medium {
    /// Air, taken as vacuum.
    pub const AIR: Self = Self {
        permittivity: DMat3::IDENTITY,
        permeability: DMat3::IDENTITY,
        inverse_permeability: DMat3::IDENTITY,
        surface: WaveSurface::AIR,
    };

    /// An isotropic medium of relative permittivity ε and permeability µ; both negative for a
    /// negative index.
    ///
    /// # Errors
    ///
    /// If a number is not finite or is zero.
    pub fn isotropic(permittivity: f64, permeability: f64) -> Result<Self, MediumError> {
        for (quantity, value) in [("permittivity", permittivity), ("permeability", permeability)] {
            if !value.is_finite() || value == 0.0 {
                return Err(MediumError::Degenerate { quantity, value });
            }
        }
        Ok(Self::isotropic_unchecked(permittivity, permeability))
    }

    /// A dielectric of refractive index `index` (µ = 1), for indices known to be positive and
    /// finite: the local medium of a graded index.
    #[must_use]
    pub fn dielectric(index: f64) -> Self {
        debug_assert!(index.is_finite() && index > 0.0, "index {index}");
        Self::isotropic_unchecked(index * index, 1.0)
    }

    fn isotropic_unchecked(permittivity: f64, permeability: f64) -> Self {
        Self {
            permittivity: DMat3::from_diagonal(DVec3::splat(permittivity)),
            permeability: DMat3::from_diagonal(DVec3::splat(permeability)),
            inverse_permeability: DMat3::from_diagonal(DVec3::splat(1.0 / permeability)),
            surface: WaveSurface::isotropic(permittivity, permeability),
        }
    }

    /// An impedance-matched medium, ε = µ = `tensor`.
    ///
    /// # Errors
    ///
    /// If the tensor is not symmetric, not finite, or singular.
    pub fn impedance_matched(tensor: DMat3) -> Result<Self, MediumError> {
        let determinant = tensor.determinant();
        if !determinant.is_finite() || determinant == 0.0 {
            return Err(MediumError::Degenerate {
                quantity: "the determinant of the tensor",
                value: determinant,
            });
        }
        if !tensor.transpose().abs_diff_eq(tensor, 1e-12 * tensor.x_axis.length()) {
            return Err(MediumError::NotSymmetric { quantity: "permittivity" });
        }
        Ok(Self {
            permittivity: tensor,
            permeability: tensor,
            inverse_permeability: tensor.inverse(),
            surface: WaveSurface::impedance_matched(tensor),
        })
    }

    /// The relative permittivity tensor ε.
    #[must_use]
    pub fn permittivity(&self) -> &DMat3 {
        &self.permittivity
    }

    /// The relative permeability tensor µ.
    #[must_use]
    pub fn permeability(&self) -> &DMat3 {
        &self.permeability
    }

    /// Which wave vectors the medium carries.
    #[must_use]
    pub fn wave_surface(&self) -> &WaveSurface {
        &self.surface
    }

    /// The magnetic field H = µ⁻¹ (p × E) of a wave with wave vector `p` and electric field `electric`.
    #[must_use]
    pub fn magnetic_field(&self, wave_vector: DVec3, electric: ComplexVector) -> ComplexVector {
        electric.crossed_by(wave_vector).transformed(&self.inverse_permeability)
    }

    /// The Poynting vector Re(E × H*) of a wave with wave vector `p` and electric field `electric`.
    #[must_use]
    pub fn poynting(&self, wave_vector: DVec3, electric: ComplexVector) -> DVec3 {
        poynting(electric, self.magnetic_field(wave_vector, electric))
    }

    /// µ⁻¹ applied to a real vector.
    pub(crate) fn magnetic_row(&self, row: DVec3) -> DVec3 {
        self.inverse_permeability * row
    }
}
