//! How late a pulse comes at least.

use super::principal_axes::principal_axes;
use super::{Medium, RayWave, Tensor};
use crate::wave::{ComplexVector, poynting};
use glam::{DMat3, DVec3};
use num_complex::Complex64;

impl Medium {
    /// The speed of light over that of a pulse along its ray, of a wave with the wave vector `p`
    /// and the electric field `electric` of any size, at the least dispersion that causality
    /// allows; NaN where the medium absorbs.
    ///
    /// A pulse runs at the velocity S/U of the energy, with S = Re(E × H*)/2 and U = (E·ε'E* +
    /// H·µ'H*)/4, ε' = d(ωε)/dω. In a passive transparent medium each principal value e has
    /// d(ωe)/dω ≥ max(e, 2 - e) (Landau & Lifshitz, Electrodynamics of Continuous Media, section
    /// 84): that is taken for the derivative.
    ///
    /// # Example
    ///
    /// ```
    /// use glam::DVec3;
    /// use optics::medium::Medium;
    ///
    /// let group = |permittivity: f64, permeability: f64, index: f64| {
    ///     let medium = Medium::isotropic(permittivity, permeability)?;
    ///     Ok::<_, optics::medium::MediumError>(
    ///         medium.causal_group_index(DVec3::X * index, DVec3::Y.into()),
    ///     )
    /// };
    /// // n above 1, below 1, and -1.
    /// assert!((group(2.25, 1.0, 1.5)? - 1.5).abs() < 1e-15);
    /// assert!((group(0.25, 1.0, 0.5)? - 2.0).abs() < 1e-15);
    /// assert!((group(-1.0, -1.0, -1.0)? - 3.0).abs() < 1e-15);
    /// # Ok::<(), optics::medium::MediumError>(())
    /// ```
    #[must_use]
    pub fn causal_group_index(&self, wave_vector: DVec3, electric: ComplexVector) -> f64 {
        self.least_dispersive().map_or(f64::NAN, |[permittivity, permeability]| {
            self.group_index(wave_vector, electric, [&permittivity, &permeability])
        })
    }

    /// d(ωε)/dω and d(ωµ)/dω at the least dispersion that causality allows, for [`Self::group_index`]; none where the
    /// medium absorbs.
    #[must_use]
    pub fn least_dispersive(&self) -> Option<[Tensor; 2]> {
        let tensors = [self.real.permittivity, self.real.permeability];
        (!self.absorbs()).then(|| tensors.map(|tensor| least_dispersive(&tensor).into()))
    }

    /// The same by the medium's own law, given as d(ωε)/dω and d(ωµ)/dω. Where it absorbs there is
    /// no velocity of energy: of isotropic media the group index is then d(ω Re N)/dω, by which the
    /// phase of a pulse changes; NaN of others.
    ///
    /// # Example
    ///
    /// ```
    /// use glam::DVec3;
    /// use optics::material::Material;
    /// use optics::medium::Medium;
    ///
    /// let glass = Material::named("bk7").expect("it comes with the program").ordinary.at(0.55)?;
    /// let medium = Medium::new(glass.permittivity(), 1.0)?;
    /// let law = [&glass.dispersive_permittivity().into(), &1.0.into()];
    /// let group = medium.group_index(DVec3::X * glass.index.re, DVec3::Y.into(), law);
    /// assert!((group - glass.group_index.re).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn group_index(
        &self,
        wave_vector: DVec3,
        electric: ComplexVector,
        [permittivity, permeability]: [&Tensor; 2],
    ) -> f64 {
        if self.absorbs() {
            return match (self.complex_scalars(), permittivity.scalar(), permeability.scalar()) {
                (Some([e, m]), Some(de), Some(dm)) => {
                    // N² = εµ, and d(ωN)/dω = ((d(ωε)/dω) µ + ε d(ωµ)/dω)/2N.
                    let root = (e * m).sqrt();
                    let index = if root.im < 0.0 { -root } else { root };
                    ((de * m + e * dm) / (2.0 * index)).re
                }
                _ => f64::NAN,
            };
        }
        let energy = |tensor: &DMat3, field: ComplexVector| {
            field.re.dot(*tensor * field.re) + field.im.dot(*tensor * field.im)
        };
        let magnetic = self.magnetic_field(wave_vector, electric);
        let energy = energy(&permittivity.re, electric) + energy(&permeability.re, magnetic);
        energy / (2.0 * poynting(electric, magnetic).length())
    }

    /// ε and µ, if they are scalars.
    fn complex_scalars(&self) -> Option<[Complex64; 2]> {
        let (permittivity, permeability) = self.tensors();
        Some([permittivity.scalar()?, permeability.scalar()?])
    }

    /// That of a wave whose ray is given, over what the phase takes along the ray.
    pub(crate) fn causal_group_over_phase(&self, wave: &RayWave, ray: DVec3) -> f64 {
        let electric = wave.electric.unwrap_or_else(|| ray.any_orthonormal_vector().into());
        self.causal_group_index(wave.wave_vector, electric) / wave.wave_vector.dot(ray)
    }
}

/// d(ωε)/dω at least, of the principal values of ε.
fn least_dispersive(tensor: &DMat3) -> DMat3 {
    let (values, axes) = principal_axes(tensor);
    axes * DMat3::from_diagonal(values.max(DVec3::splat(2.0) - values)) * axes.transpose()
}
