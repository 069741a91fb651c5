//! How late a pulse comes at least.

use super::principal_axes::principal_axes;
use super::{Medium, ModeKind, Tensor};
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
}

/// A medium by its principal values, and which wave of it is meant: for what a pulse takes along a ray, over what its
/// phase takes, in closed form.
///
/// The ray index N, by which the phase runs along a ray of a given direction, is stationary in the wave vector (Fermat), so
/// a pulse takes d(ωN)/dω with the direction kept, which is as with the energy in [`Medium::group_index`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum PrincipalMedium {
    /// ε = µ of these values along the first axis, the second and the third.
    Matched([f64; 3]),
    /// A dielectric, µ = 1, whose third axis is the optic one.
    Uniaxial { ordinary: f64, extraordinary: f64, mode: ModeKind },
}

impl PrincipalMedium {
    /// d(ωN)/dω over N at the least dispersion that causality allows, for a ray whose unit vector has these squared
    /// components along the axes.
    pub fn group_over_phase(&self, parts: [f64; 3]) -> f64 {
        // d ln e/d ln ω.
        let growth = |value: f64| value.max(2.0 - value) / value - 1.0;
        let grown = match *self {
            // N² = det ε t·ε⁻¹t.
            Self::Matched(values) => {
                let terms = [0, 1, 2].map(|i| parts[i] / values[i]);
                let growths = values.map(growth);
                let shared = terms.iter().zip(growths).map(|(term, growth)| term * growth);
                growths.iter().sum::<f64>() - shared.sum::<f64>() / terms.iter().sum::<f64>()
            }
            // N² = ε_e sin²θ + ε_o cos²θ.
            Self::Uniaxial { ordinary, extraordinary, mode: ModeKind::Extraordinary } => {
                let terms = [extraordinary * (parts[0] + parts[1]), ordinary * parts[2]];
                let grown = terms[0] * growth(extraordinary) + terms[1] * growth(ordinary);
                grown / (terms[0] + terms[1])
            }
            Self::Uniaxial { ordinary, .. } => growth(ordinary),
        };
        1.0 + 0.5 * grown
    }

    /// Which of its principal values are above 1: where that changes, the group index has a kink.
    pub fn sides(&self) -> u8 {
        let side = |bit: usize, value: f64| u8::from(value > 1.0) << bit;
        match *self {
            Self::Matched([a, b, c]) => side(0, a) | side(1, b) | side(2, c),
            Self::Uniaxial { ordinary, extraordinary, .. } => {
                side(0, ordinary) | side(1, extraordinary)
            }
        }
    }
}

/// d(ωε)/dω at least, of the principal values of ε.
fn least_dispersive(tensor: &DMat3) -> DMat3 {
    let (values, axes) = principal_axes(tensor);
    axes * DMat3::from_diagonal(values.max(DVec3::splat(2.0) - values)) * axes.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the energy of the wave that runs along a ray, over its phase.
    fn by_energy(medium: &Medium, mode: ModeKind, ray: DVec3) -> f64 {
        let waves = medium.waves_along_ray(ray);
        let wave = waves.iter().find(|wave| wave.kind == mode).expect("a wave");
        let electric = wave.electric.unwrap_or_else(|| ray.any_orthonormal_vector().into());
        medium.causal_group_index(wave.wave_vector, electric) / wave.wave_vector.dot(ray)
    }

    #[test]
    fn principal_values_delay_pulses_as_their_energy_says() {
        for (x, y, z) in [(0.3, -0.5, 0.8), (-0.9, 0.1, 0.2), (0.0, 0.7, 0.1), (1.0, 0.0, 0.0)] {
            let ray = DVec3::new(x, y, z).normalize();
            let parts = (ray * ray).to_array();
            for values in [[0.3, 2.0, 1.5], [0.2, 5.0, 0.9], [2.0, 3.0, 3.0], [0.5, 0.5, 0.5]] {
                let tensor = DMat3::from_diagonal(DVec3::from_array(values));
                let medium = Medium::transformed(tensor, tensor.inverse(), tensor.determinant());
                let found = PrincipalMedium::Matched(values).group_over_phase(parts);
                let expected = by_energy(&medium, ModeKind::Shared, ray);
                assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected} {values:?}");
            }
            for [ordinary, extraordinary] in [[2.75, 2.21], [2.5, 0.31], [0.31, 2.5], [0.3, 0.4]] {
                let medium = Medium::uniaxial_electric(1.0, ordinary, extraordinary, DVec3::Z);
                let medium = medium.expect("a medium");
                for mode in [ModeKind::Ordinary, ModeKind::Extraordinary] {
                    let principal = PrincipalMedium::Uniaxial { ordinary, extraordinary, mode };
                    let found = principal.group_over_phase(parts);
                    let expected = by_energy(&medium, mode, ray);
                    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected} {mode:?}");
                }
            }
        }
    }
}
