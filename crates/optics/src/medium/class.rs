//! Which closed form serves a medium.

use super::WaveSurface;
use super::principal_axes::principal_axes;
use super::tensor::{Shape, Tensor};
use glam::DVec3;
use num_complex::Complex64;

/// How far, relative to its size, a tensor may be from a special form and still be taken for it:
/// the rounding of a tensor that was turned or printed.
const TOLERANCE: f64 = 1e-14;

/// Scalar in one tensor, uniaxial in the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Uniaxial<T> {
    /// The permittivity of a magnetic medium, the permeability of an electric one.
    pub scalar: T,
    /// The other tensor across the axis.
    pub ordinary: T,
    /// The other tensor along the axis.
    pub extraordinary: T,
    /// The optic axis, a unit vector.
    pub axis: DVec3,
    /// Whether the permittivity is the uniaxial one.
    pub electric: bool,
}

/// The kinds of media, by how their waves are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Class {
    /// Scalars, lossless.
    Isotropic(WaveSurface),
    /// Lossless with ε a multiple of µ, and both polarizations on one wave vector.
    Matched(WaveSurface),
    /// Lossless uniaxial.
    Uniaxial(Uniaxial<f64>),
    /// Scalars ε, µ with absorption.
    AbsorbingIsotropic(Complex64, Complex64),
    /// Uniaxial with absorption.
    AbsorbingUniaxial(Uniaxial<Complex64>),
    /// Anything else.
    General,
}

impl Class {
    pub fn of(permittivity: &Tensor, permeability: &Tensor) -> Self {
        let shapes = (permittivity.shape(TOLERANCE), permeability.shape(TOLERANCE));
        let (scalar, across, along, axis, electric) = match shapes {
            (Shape::Scalar(e), Shape::Scalar(m)) => {
                return if e.im == 0.0 && m.im == 0.0 {
                    Self::Isotropic(WaveSurface::isotropic(e.re, m.re))
                } else {
                    Self::AbsorbingIsotropic(e, m)
                };
            }
            (Shape::Scalar(e), Shape::Uniaxial { across, along, axis }) => {
                (e, across, along, axis, false)
            }
            (Shape::Uniaxial { across, along, axis }, Shape::Scalar(m)) => {
                (m, across, along, axis, true)
            }
            _ => return Self::matched(permittivity, permeability).unwrap_or(Self::General),
        };
        let absorbing = Uniaxial { scalar, ordinary: across, extraordinary: along, axis, electric };
        if [scalar, across, along].iter().all(|value| value.im == 0.0) {
            Self::Uniaxial(absorbing.map(|value| value.re))
        } else {
            Self::AbsorbingUniaxial(absorbing)
        }
    }

    /// ε = z µ, unless the two polarizations would carry power opposite ways.
    fn matched(permittivity: &Tensor, permeability: &Tensor) -> Option<Self> {
        let inner = |a: &Tensor| {
            let (a, m) = (a.re.to_cols_array(), permeability.re.to_cols_array());
            a.iter().zip(m).map(|(a, m)| a * m).sum::<f64>()
        };
        let ratio = inner(permittivity) / inner(permeability);
        let difference = Tensor {
            re: permittivity.re - permeability.re * ratio,
            im: permittivity.im.abs() + permeability.im.abs(),
        };
        if difference.size() > TOLERANCE * permittivity.size() {
            return None;
        }
        let values = principal_axes(&permeability.re).0;
        let definite = values.min_element() > 0.0 || values.max_element() < 0.0;
        // S = M p (E·M E)/det M with E·M p = 0 and p·M p = z det M: for a definite M along M p,
        // for an indefinite one and z > 0 against it, else of either sign.
        let sign = match (definite, ratio > 0.0) {
            (true, _) => 1.0,
            (false, true) => -1.0,
            (false, false) => return None,
        };
        let constant = ratio * permeability.re.determinant() * sign;
        Some(Self::Matched(WaveSurface { form: permeability.re * sign, constant }))
    }
}

impl<T: Copy> Uniaxial<T> {
    /// The same of other numbers.
    pub fn map<U>(&self, number: impl Fn(T) -> U) -> Uniaxial<U> {
        let Self { scalar, ordinary, extraordinary, axis, electric } = *self;
        let [scalar, ordinary, extraordinary] = [scalar, ordinary, extraordinary].map(number);
        Uniaxial { scalar, ordinary, extraordinary, axis, electric }
    }
}
