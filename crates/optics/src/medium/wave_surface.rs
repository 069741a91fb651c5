//! The wave vectors a medium carries where both polarizations share them.

use super::quadratic::{Quadratic, Roots};
use crate::wave::ComplexVector;
use glam::{DMat3, DVec3};

/// The wave surface p·Ap = c of an isotropic or impedance-matched medium.
///
/// The form is scaled such that the Poynting vector lies along Ap: A = 1/µ and c = ε for an
/// isotropic medium, A = M and c = z det M for µ = M, ε = z M (both times -1 for an indefinite M).
/// The signs of negative-index media follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WaveSurface {
    /// A.
    pub(super) form: DMat3,
    /// c.
    pub(super) constant: f64,
}

impl WaveSurface {
    pub(super) fn isotropic(permittivity: f64, permeability: f64) -> Self {
        let form = DMat3::from_diagonal(DVec3::splat(1.0 / permeability));
        Self { form, constant: permittivity }
    }

    /// The unit vector of the Poynting vector of a wave with wave vector `p`.
    pub fn ray_direction(&self, wave_vector: DVec3) -> DVec3 {
        self.ray(wave_vector).normalize()
    }

    /// |Re(E × H*)| of a wave with wave vector `p` and the electric field E: |Ap| (E·AE)/det A, for an
    /// isotropic medium |Ap| |E|².
    pub fn poynting(&self, wave_vector: DVec3, electric: ComplexVector) -> f64 {
        let of = |form: &DMat3| {
            electric.re.dot(*form * electric.re) + electric.im.dot(*form * electric.im)
        };
        let is_isotropic = self.form == DMat3::from_diagonal(DVec3::splat(self.form.x_axis.x));
        let size = if is_isotropic {
            electric.norm_squared()
        } else {
            of(&self.form) / self.form.determinant()
        };
        self.ray(wave_vector).length() * size.abs()
    }

    /// Ap, along the ray of a wave with wave vector `p`.
    pub fn ray(&self, wave_vector: DVec3) -> DVec3 {
        self.form * wave_vector
    }

    /// The normal components of the waves with the tangential part `tangential` (perpendicular to
    /// the unit vector `normal`). S·n is proportional to a q + b, hence positive for the root of
    /// the positive sign.
    ///
    /// At exact grazing, where the two coincide, they are set apart by about 1e-15, which gives the
    /// limit.
    pub fn roots(&self, tangential: DVec3, normal: DVec3) -> Roots {
        self.roots_with(None, tangential, normal)
    }

    /// The same where one of them is known, which near grazing incidence has more digits.
    pub fn roots_with(&self, known: Option<f64>, tangential: DVec3, normal: DVec3) -> Roots {
        let form_normal = self.form * normal;
        let along = tangential.dot(self.form * tangential);
        let (a, b) = (normal.dot(form_normal), tangential.dot(form_normal));
        let terms = along.abs() + self.constant.abs();
        Quadratic { a, b, c: along - self.constant }.roots_with(known, terms)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_index_sends_power_against_the_wave_vector() {
        let surface = WaveSurface::isotropic(-1.0, -1.0);
        let Roots::Real { plus: forward, minus: backward, .. } =
            surface.roots(DVec3::new(0.0, 0.6, 0.0), DVec3::X)
        else {
            panic!("propagating expected");
        };
        assert!((forward + 0.8).abs() < 1e-15 && (backward - 0.8).abs() < 1e-15);
        assert_eq!(surface.ray_direction(DVec3::new(-1.0, 0.0, 0.0)), DVec3::X);
    }
}
