//! Media: what light meets, described by its permittivity and permeability tensors.
//!
//! A [`Medium`] is homogeneous. A graded medium is a local homogeneous one at every point; how
//! light runs through it is the business of [`crate::propagation`].
//!
//! Any symmetric tensors make a medium, of either sign and indefinite ones too; complex ones
//! absorb. What a medium is called (isotropic, impedance matched, uniaxial) is found when it is
//! made, and decides which closed form gives its [modes](Mode).

mod class;
mod error;
mod group_index;
mod modes;
mod principal_axes;
mod quadratic;
mod quartic;
mod ray_waves;
mod tensor;
mod wave_surface;

pub use error::MediumError;
pub(crate) use group_index::PrincipalMedium;
pub(crate) use modes::{BOTH_MODES, LocalMode, LocalModes, Tangential, mutual_flux};
pub use modes::{Heading, Mode, ModeKind};
pub use principal_axes::principal_axes;
pub(crate) use quadratic::{Roots, is_known_better};
pub use ray_waves::RayWave;
use tensor::MAGNITUDES;
pub use tensor::Tensor;
pub(crate) use tensor::largest;
pub(crate) use wave_surface::WaveSurface;

use crate::wave::{ComplexVector, poynting};
use class::{Class, Uniaxial};
use glam::{DMat3, DVec3};

/// A homogeneous medium.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Medium {
    real: Tensors,
    /// The imaginary parts, if it absorbs.
    absorption: Option<Tensors>,
    class: Class,
}

/// The real or the imaginary parts of a medium's tensors.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tensors {
    permittivity: DMat3,
    permeability: DMat3,
    inverse_permeability: DMat3,
}

impl Medium {
    /// Air, taken as vacuum.
    pub const AIR: Self = Self::lossless(
        [DMat3::IDENTITY; 3],
        Class::Isotropic(WaveSurface { form: DMat3::IDENTITY, constant: 1.0 }),
    );

    /// A medium of any relative permittivity and permeability tensors.
    ///
    /// Tensors that are uniaxial, or one of them a multiple of the other, but for 1e-9 of their
    /// size are taken to be so, and become so: the digits that people type. Anisotropy below 1e-6
    /// is left as it is, and an exactly uniaxial tensor is so however weak its birefringence.
    ///
    /// # Errors
    ///
    /// If a tensor is not symmetric, has principal values beyond 1e-12 to 1e12 or one a 1e12th of
    /// another, or would amplify light; or if the index of refraction could be above a million.
    ///
    /// # Example
    ///
    /// ```
    /// use glam::{DMat3, DVec3};
    /// use num_complex::Complex64;
    /// use optics::medium::Medium;
    ///
    /// let topaz = DMat3::from_diagonal(DVec3::new(2.609, 2.613, 2.641));
    /// let medium = Medium::new(topaz, 1.0)?;
    /// assert_eq!(medium.optic_axis(), None);
    /// let gold = Medium::new(Complex64::new(-5.8, 2.1), 1.0)?;
    /// assert!(gold.absorbs());
    /// # Ok::<(), optics::medium::MediumError>(())
    /// ```
    pub fn new(
        permittivity: impl Into<Tensor>,
        permeability: impl Into<Tensor>,
    ) -> Result<Self, MediumError> {
        let permittivity = permittivity.into().checked("permittivity")?;
        let permeability = permeability.into().checked("permeability")?;
        not_too_dense(permittivity.size(), permeability.size())?;
        let (class, [permittivity, permeability]) = Class::of(permittivity, permeability);
        Ok(Self::of_class(&permittivity, &permeability, class))
    }

    fn of_class(permittivity: &Tensor, permeability: &Tensor, class: Class) -> Self {
        let inverse = permeability.inverse();
        let absorbs = permittivity.im != DMat3::ZERO || permeability.im != DMat3::ZERO;
        let absorption = absorbs.then_some(Tensors {
            permittivity: permittivity.im,
            permeability: permeability.im,
            inverse_permeability: inverse.im,
        });
        let real = [permittivity.re, permeability.re, inverse.re];
        Self { absorption, ..Self::lossless(real, class) }
    }

    /// From ε, µ and µ⁻¹.
    const fn lossless(
        [permittivity, permeability, inverse_permeability]: [DMat3; 3],
        class: Class,
    ) -> Self {
        let real = Tensors { permittivity, permeability, inverse_permeability };
        Self { real, absorption: None, class }
    }

    /// A medium of scalar permittivity whose permeability is µ_o across and µ_e along `axis` (of
    /// any length).
    ///
    /// # Errors
    ///
    /// If a number's magnitude is not 1e-12 to 1e12, the index of refraction would be above a
    /// million, or the axis has no direction.
    pub fn uniaxial_magnetic(
        permittivity: f64,
        ordinary: f64,
        extraordinary: f64,
        axis: DVec3,
    ) -> Result<Self, MediumError> {
        Self::uniaxial(permittivity, ordinary, extraordinary, axis, false)
    }

    /// A medium of scalar permeability whose permittivity is ε_o across and ε_e along `axis` (of
    /// any length): with µ = 1, a uniaxial crystal.
    ///
    /// # Errors
    ///
    /// If a number's magnitude is not 1e-12 to 1e12, the index of refraction would be above a
    /// million, or the axis has no direction.
    pub fn uniaxial_electric(
        permeability: f64,
        ordinary: f64,
        extraordinary: f64,
        axis: DVec3,
    ) -> Result<Self, MediumError> {
        Self::uniaxial(permeability, ordinary, extraordinary, axis, true)
    }

    fn uniaxial(
        scalar: f64,
        ordinary: f64,
        extraordinary: f64,
        axis: DVec3,
        electric: bool,
    ) -> Result<Self, MediumError> {
        let names = if electric {
            ["permeability", "ordinary permittivity", "extraordinary permittivity"]
        } else {
            ["permittivity", "ordinary permeability", "extraordinary permeability"]
        };
        for (quantity, value) in names.into_iter().zip([scalar, ordinary, extraordinary]) {
            not_degenerate(quantity, value)?;
        }
        /// ε and µ.
        fn pair<T>(electric: bool, scalar: T, other: T) -> [T; 2] {
            if electric { [other, scalar] } else { [scalar, other] }
        }
        let largest = ordinary.abs().max(extraordinary.abs());
        let [permittivity, permeability] = pair(electric, scalar, largest);
        not_too_dense(permittivity, permeability)?;
        let axis = axis.try_normalize().ok_or(MediumError::NoAxis)?;
        if ordinary == extraordinary {
            let [permittivity, permeability] = pair(electric, scalar, ordinary);
            return Self::isotropic(permittivity, permeability);
        }
        let tensor = Tensor::uniaxial(ordinary.into(), extraordinary.into(), axis);
        let [permittivity, permeability] = pair(electric, scalar.into(), tensor);
        let class = Class::Uniaxial(Uniaxial { scalar, ordinary, extraordinary, axis, electric });
        Ok(Self::of_class(&permittivity, &permeability, class))
    }

    /// An isotropic medium of relative permittivity ε and permeability µ; both negative for a
    /// negative index.
    ///
    /// # Errors
    ///
    /// If a number's magnitude is not 1e-12 to 1e12, or the index of refraction would be above a
    /// million.
    pub fn isotropic(permittivity: f64, permeability: f64) -> Result<Self, MediumError> {
        not_degenerate("permittivity", permittivity)?;
        not_degenerate("permeability", permeability)?;
        not_too_dense(permittivity, permeability)?;
        Ok(Self::isotropic_unchecked(permittivity, permeability))
    }

    /// A dielectric of refractive index `index` (µ = 1), for indices known to be positive and
    /// finite: the local medium of a graded index.
    pub fn dielectric(index: f64) -> Self {
        debug_assert!(index.is_finite() && index > 0.0, "index {index}");
        Self::isotropic_unchecked(index * index, 1.0)
    }

    fn isotropic_unchecked(permittivity: f64, permeability: f64) -> Self {
        let tensors = [permittivity, permeability, 1.0 / permeability]
            .map(|value| DMat3::from_diagonal(DVec3::splat(value)));
        let surface = WaveSurface { form: tensors[2], constant: permittivity };
        Self::lossless(tensors, Class::Isotropic(surface))
    }

    /// An impedance-matched medium, ε = µ = `tensor`.
    ///
    /// # Errors
    ///
    /// If the tensor is not symmetric, or has principal values beyond 1e-12 to 1e6.
    pub fn impedance_matched(tensor: DMat3) -> Result<Self, MediumError> {
        Self::new(tensor, tensor)
    }

    /// The impedance-matched medium ε = µ = `tensor` of a coordinate map, given with its inverse
    /// and its determinant, for tensors known to be symmetric and positive definite: the local
    /// medium of a transformation. Near a singular point only its maker knows the latter two.
    pub fn transformed(tensor: DMat3, inverse: DMat3, determinant: f64) -> Self {
        debug_assert!(determinant.is_finite() && determinant > 0.0, "determinant {determinant}");
        let surface = WaveSurface { form: tensor, constant: determinant };
        Self::lossless([tensor, tensor, inverse], Class::Matched(surface))
    }

    /// The relative permittivity tensor ε, its real part if the medium absorbs.
    #[must_use]
    pub fn permittivity(&self) -> &DMat3 {
        &self.real.permittivity
    }

    /// The relative permeability tensor µ, its real part if the medium absorbs.
    #[must_use]
    pub fn permeability(&self) -> &DMat3 {
        &self.real.permeability
    }

    /// The permittivity and permeability tensors with their imaginary parts.
    #[must_use]
    pub fn tensors(&self) -> (Tensor, Tensor) {
        let [e, m] = self.absorption.map_or([DMat3::ZERO; 2], |a| [a.permittivity, a.permeability]);
        (Tensor { re: self.real.permittivity, im: e }, Tensor { re: self.real.permeability, im: m })
    }

    /// The same medium, its waves found as those of any medium instead of by its closed form:
    /// slower, and a check on the closed forms.
    pub fn without_closed_form(self) -> Self {
        Self { class: Class::General, ..self }
    }

    /// Whether the medium is the same however it is turned.
    #[must_use]
    pub fn is_isotropic(&self) -> bool {
        matches!(self.class, Class::Isotropic(_) | Class::AbsorbingIsotropic(..))
    }

    /// What the medium is, for reports: `isotropic`, `impedance matched` (ε a multiple of µ),
    /// `uniaxial`, `biaxial` (one tensor scalar, the other of three principal values) or `general`;
    /// of one that absorbs, `absorbing, isotropic`, `absorbing, uniaxial` or `absorbing, general`.
    ///
    /// # Example
    ///
    /// ```
    /// use glam::{DMat3, DVec3};
    /// use optics::medium::Medium;
    ///
    /// let topaz = DMat3::from_diagonal(DVec3::new(2.609, 2.613, 2.641));
    /// assert_eq!(Medium::new(topaz, 1.0)?.class_name(), "biaxial");
    /// assert_eq!(Medium::AIR.class_name(), "isotropic");
    /// # Ok::<(), optics::medium::MediumError>(())
    /// ```
    #[must_use]
    pub fn class_name(&self) -> &'static str {
        match self.class {
            Class::Isotropic(_) => "isotropic",
            Class::Matched(_) => "impedance matched",
            Class::Uniaxial(_) => "uniaxial",
            Class::AbsorbingIsotropic(..) => "absorbing, isotropic",
            Class::AbsorbingUniaxial(_) => "absorbing, uniaxial",
            Class::General if self.absorbs() => "absorbing, general",
            Class::General => {
                let (permittivity, permeability) = self.tensors();
                if class::is_biaxial(&permittivity, &permeability) { "biaxial" } else { "general" }
            }
        }
    }

    /// Whether the medium takes power from light.
    #[must_use]
    pub fn absorbs(&self) -> bool {
        self.absorption.is_some()
    }

    /// Which wave vectors the medium carries, if it is lossless and both polarizations share them:
    /// isotropic, or ε a multiple of µ.
    pub(crate) fn wave_surface(&self) -> Option<&WaveSurface> {
        match &self.class {
            Class::Isotropic(surface) | Class::Matched(surface) => Some(surface),
            _ => None,
        }
    }

    /// The refractive index of an isotropic medium, the geometric mean over the principal axes and
    /// polarizations of another: (det ε det µ)^(1/6), negative where both are. Of an absorbing
    /// medium, that of the real parts.
    #[must_use]
    pub fn mean_index(&self) -> f64 {
        let (e, m) = (self.real.permittivity.determinant(), self.real.permeability.determinant());
        let size = (e * m).abs().powf(1.0 / 6.0);
        if e < 0.0 && m < 0.0 { -size } else { size }
    }

    /// The difference of its largest and its least index over the principal axes, of the real
    /// parts; 0 if it is isotropic.
    #[must_use]
    pub fn birefringence(&self) -> f64 {
        if self.is_isotropic() {
            return 0.0;
        }
        let tensors = [self.real.permittivity, self.real.permeability];
        let [e, m] = tensors.map(|tensor| principal_axes(&tensor).0.abs());
        (e.max_element() * m.max_element()).sqrt() - (e.min_element() * m.min_element()).sqrt()
    }

    /// The optic axis of a uniaxial medium, a unit vector of either sense.
    #[must_use]
    pub fn optic_axis(&self) -> Option<DVec3> {
        match &self.class {
            Class::Uniaxial(uniaxial) => Some(uniaxial.axis),
            Class::AbsorbingUniaxial(uniaxial) => Some(uniaxial.axis),
            _ => None,
        }
    }

    /// The magnetic field H = µ⁻¹ (p × E) of a wave with wave vector `p` and electric field
    /// `electric`.
    pub fn magnetic_field(&self, wave_vector: DVec3, electric: ComplexVector) -> ComplexVector {
        self.magnetic_of_curl(electric.crossed_by(wave_vector))
    }

    /// The magnetic field of a wave with a complex wave vector.
    pub fn decaying_magnetic_field(
        &self,
        wave_vector: ComplexVector,
        electric: ComplexVector,
    ) -> ComplexVector {
        self.magnetic_of_curl(wave_vector.cross(electric))
    }

    fn magnetic_of_curl(&self, curl: ComplexVector) -> ComplexVector {
        let lossless = curl.transformed(&self.real.inverse_permeability);
        self.absorption.map_or(lossless, |absorption| {
            let lossy = curl.transformed(&absorption.inverse_permeability);
            lossless + ComplexVector::new(-lossy.im, lossy.re)
        })
    }

    /// The Poynting vector Re(E × H*) of a wave with wave vector `p` and electric field `electric`.
    #[must_use]
    pub fn poynting(&self, wave_vector: DVec3, electric: ComplexVector) -> DVec3 {
        poynting(electric, self.magnetic_field(wave_vector, electric))
    }

    /// ε and µ, if the medium is lossless and known to be isotropic.
    pub(crate) fn scalars(&self) -> Option<(f64, f64)> {
        matches!(self.class, Class::Isotropic(_))
            .then_some((self.real.permittivity.x_axis.x, self.real.permeability.x_axis.x))
    }

    /// µ⁻¹, its real part if the medium absorbs.
    pub(crate) fn inverse_permeability(&self) -> &DMat3 {
        &self.real.inverse_permeability
    }
}

fn not_degenerate(quantity: &'static str, value: f64) -> Result<(), MediumError> {
    if !MAGNITUDES.contains(&value.abs()) {
        return Err(MediumError::Degenerate { quantity, value });
    }
    Ok(())
}

/// The wave vector's part along a surface, that of light in air, is lost in rounding beside a wave
/// vector too large.
fn not_too_dense(permittivity: f64, permeability: f64) -> Result<(), MediumError> {
    let [permittivity, permeability] = [permittivity.abs(), permeability.abs()];
    if permittivity * permeability > *MAGNITUDES.end() {
        return Err(MediumError::TooDense { permittivity, permeability });
    }
    Ok(())
}
