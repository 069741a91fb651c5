//! Which closed form serves a medium.

use super::WaveSurface;
use super::principal_axes::principal_axes;
use super::tensor::{Shape, Tensor, largest};
use glam::{DMat3, DVec3};
use num_complex::Complex64;

/// How far, relative to its size, a tensor may be from a special form and still have it: the
/// rounding of a tensor that was turned.
const TOLERANCE: f64 = 1e-14;

/// How far a tensor without a special form may be from one and be given it: the digits that people
/// type.
const TYPED: f64 = 1e-9;

/// The anisotropy that digits may be taken from, relative to the size of the tensor: what is taken
/// is a thousandth of it, and weak birefringence stays as it is.
const ANISOTROPY: f64 = 1e-6;

/// How much of the anisotropy, and of the absorption, may be taken for digits.
const SMALL_PART: f64 = TYPED / ANISOTROPY;

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
    /// The class of a medium, and the tensors as that class has them.
    pub fn of(permittivity: Tensor, permeability: Tensor) -> (Self, [Tensor; 2]) {
        let given = [permittivity, permeability];
        let shapes = given.map(|tensor| tensor.shape(TOLERANCE));
        let class = Self::of_shapes(shapes).or_else(|| Self::matched(&permittivity, &permeability));
        if let Some(class) = class {
            return (class, given);
        }
        let typed: [(Tensor, Shape); 2] = std::array::from_fn(|i| typed(given[i], shapes[i]));
        if let Some(class) = Self::of_shapes(typed.map(|(_, shape)| shape)) {
            return (class, typed.map(|(tensor, _)| tensor));
        }
        let lossless = given.iter().all(|tensor| tensor.im == DMat3::ZERO);
        if lossless && permeability.anisotropy() >= ANISOTROPY * permeability.size() {
            let multiple = Tensor::from(permeability.re * ratio(&permittivity, &permeability));
            if permittivity.difference(&multiple).size() <= TYPED * permittivity.size()
                && let Some(class) = Self::matched(&multiple, &permeability)
            {
                return (class, [multiple, permeability]);
            }
        }
        (Self::General, given)
    }

    /// The class of a medium one of whose tensors is scalar, the other at most uniaxial.
    fn of_shapes(shapes: [Shape; 2]) -> Option<Self> {
        let (scalar, across, along, axis, electric) = match shapes {
            [Shape::Scalar(e), Shape::Scalar(m)] => {
                return Some(if e.im == 0.0 && m.im == 0.0 {
                    Self::Isotropic(WaveSurface::isotropic(e.re, m.re))
                } else {
                    Self::AbsorbingIsotropic(e, m)
                });
            }
            [Shape::Scalar(e), Shape::Uniaxial { across, along, axis }] => {
                (e, across, along, axis, false)
            }
            [Shape::Uniaxial { across, along, axis }, Shape::Scalar(m)] => {
                (m, across, along, axis, true)
            }
            _ => return None,
        };
        let absorbing = Uniaxial { scalar, ordinary: across, extraordinary: along, axis, electric };
        Some(if [scalar, across, along].iter().all(|value| value.im == 0.0) {
            Self::Uniaxial(absorbing.map(|value| value.re))
        } else {
            Self::AbsorbingUniaxial(absorbing)
        })
    }

    /// ε = z µ, unless the two polarizations would carry power opposite ways.
    fn matched(permittivity: &Tensor, permeability: &Tensor) -> Option<Self> {
        let ratio = ratio(permittivity, permeability);
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

/// Whether one tensor is scalar and the other has three principal values.
pub(super) fn is_biaxial(permittivity: &Tensor, permeability: &Tensor) -> bool {
    let shapes = [permittivity, permeability].map(|tensor| tensor.shape(TOLERANCE));
    matches!(shapes, [Shape::Scalar(_), Shape::Other] | [Shape::Other, Shape::Scalar(_)])
}

/// The multiple of µ that is closest to ε, of the real parts.
fn ratio(permittivity: &Tensor, permeability: &Tensor) -> f64 {
    let inner = |a: &Tensor| {
        let (a, m) = (a.re.to_cols_array(), permeability.re.to_cols_array());
        a.iter().zip(m).map(|(a, m)| a * m).sum::<f64>()
    };
    inner(permittivity) / inner(permeability)
}

/// A tensor without a special form, if it was typed, as the uniaxial one that was meant. Never as a
/// scalar: what is close to one may be weakly birefringent, which a long way shows.
fn typed(tensor: Tensor, shape: Shape) -> (Tensor, Shape) {
    let Shape::Other = shape else { return (tensor, shape) };
    let shape = tensor.shape(TYPED);
    let Shape::Uniaxial { across, along, axis } = shape else { return (tensor, Shape::Other) };
    let meant = Tensor::uniaxial(across, along, axis);
    let taken = largest(&tensor.difference(&meant).im);
    let enough = (along - across).norm() >= ANISOTROPY * tensor.size()
        && taken <= SMALL_PART * largest(&tensor.im);
    if enough { (meant, shape) } else { (tensor, Shape::Other) }
}

impl<T: Copy> Uniaxial<T> {
    /// The same of other numbers.
    pub fn map<U>(&self, number: impl Fn(T) -> U) -> Uniaxial<U> {
        let Self { scalar, ordinary, extraordinary, axis, electric } = *self;
        let [scalar, ordinary, extraordinary] = [scalar, ordinary, extraordinary].map(number);
        Uniaxial { scalar, ordinary, extraordinary, axis, electric }
    }
}
