//! Permittivity and permeability tensors.

use super::MediumError;
use super::principal_axes::principal_axes;
use crate::wave::{cross, dot};
use glam::{DMat3, DVec3};
use num_complex::Complex64;

/// How large and how small principal values may be, and how large beside one another: beyond,
/// squares of fields that differ by as much are lost, and so is a small value in a tensor that is
/// turned.
pub(super) const MAGNITUDES: std::ops::RangeInclusive<f64> = 1e-12..=1e12;

/// A relative permittivity or permeability: a symmetric tensor, complex if the medium absorbs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tensor {
    /// Real part.
    pub re: DMat3,
    /// Imaginary part; positive for absorption.
    pub im: DMat3,
}

impl Tensor {
    /// across (1 - a aᵀ) + along a aᵀ: `along` in the direction of the unit vector a, `across`
    /// perpendicular to it.
    #[must_use]
    pub fn uniaxial(across: Complex64, along: Complex64, axis: DVec3) -> Self {
        let dyad = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
        let rest = DMat3::IDENTITY - dyad;
        Self { re: dyad * along.re + rest * across.re, im: dyad * along.im + rest * across.im }
    }

    /// The tensor of a medium that has been turned by a rotation.
    #[must_use]
    pub fn turned(&self, rotation: &DMat3) -> Self {
        let [re, im] = [self.re, self.im].map(|m| *rotation * m * rotation.transpose());
        Self { re, im }.symmetric()
    }

    /// Made symmetric to the last bit.
    fn symmetric(self) -> Self {
        let [re, im] = [self.re, self.im].map(|m| (m + m.transpose()) * 0.5);
        Self { re, im }
    }

    /// The tensor, made symmetric to the last bit, if it can be that of a medium.
    pub(super) fn checked(self, quantity: &'static str) -> Result<Self, MediumError> {
        let size = self.size();
        if !self.is_finite() || !MAGNITUDES.contains(&size) {
            return Err(MediumError::Singular { quantity });
        }
        let skew = largest(&(self.re - self.re.transpose()))
            .max(largest(&(self.im - self.im.transpose())));
        if skew > 1e-12 * size {
            return Err(MediumError::NotSymmetric { quantity });
        }
        let tensor = self.symmetric();
        // The largest entry of the inverse is that of its largest principal value, but for rounding
        // and a small factor.
        let inverse = tensor.inverse();
        let largest_inverse = 2.0 * MAGNITUDES.end() / size.max(1.0);
        if !inverse.is_finite() || inverse.size() > largest_inverse {
            return Err(MediumError::Singular { quantity });
        }
        if tensor.im != DMat3::ZERO {
            let value = principal_axes(&tensor.im).0.min_element();
            if value < -1e-12 * size {
                return Err(MediumError::Gain { quantity, value });
            }
        }
        Ok(tensor)
    }

    fn is_finite(&self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }

    /// The largest magnitude of an entry.
    pub(super) fn size(&self) -> f64 {
        largest(&self.re).max(largest(&self.im))
    }

    /// The inverse of a tensor that passed [`Self::checked`].
    pub(super) fn inverse(&self) -> Self {
        let [a, b, c] = self.rows();
        let scale = Complex64::ONE / dot(a, cross(b, c));
        // The rows of a symmetric matrix are its columns, and so are those of its inverse.
        let columns =
            [(b, c), (c, a), (a, b)].map(|(x, y)| cross(x, y).map(|component| component * scale));
        let part = |of: fn(Complex64) -> f64| {
            let [x, y, z] = columns.map(|column| DVec3::from_array(column.map(of)));
            DMat3::from_cols(x, y, z)
        };
        Self { re: part(|c| c.re), im: part(|c| c.im) }
    }

    /// The entries by rows.
    pub(super) fn rows(&self) -> [[Complex64; 3]; 3] {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| Complex64::new(self.re.col(j)[i], self.im.col(j)[i]))
        })
    }

    /// The number that it is a multiple of unity by, if it is one.
    pub(super) fn scalar(&self) -> Option<Complex64> {
        let value = Complex64::new(self.re.x_axis.x, self.im.x_axis.x);
        (*self == value.into()).then_some(value)
    }

    fn trace(&self) -> Complex64 {
        let trace = |m: &DMat3| m.x_axis.x + m.y_axis.y + m.z_axis.z;
        Complex64::new(trace(&self.re), trace(&self.im))
    }

    /// The tensor less another one.
    pub(super) fn difference(&self, other: &Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }

    /// The largest entry of what makes it differ from a scalar.
    pub(super) fn anisotropy(&self) -> f64 {
        self.difference(&(self.trace() / 3.0).into()).size()
    }

    /// What the tensor is up to `tolerance`, relative to its size.
    pub(super) fn shape(&self, tolerance: f64) -> Shape {
        let near = |other: &Self| self.difference(other).size() <= tolerance * self.size();
        let mean = self.trace() / 3.0;
        if near(&mean.into()) {
            return Shape::Scalar(mean);
        }
        // The axis shows in the part that has one, the odd one out of three principal values.
        let spread = |m: &DMat3| largest(&(*m - DMat3::from_diagonal(DVec3::splat(m.x_axis.x))));
        let part = if spread(&self.re) >= spread(&self.im) { &self.re } else { &self.im };
        let (values, axes) = principal_axes(part);
        let [x, y, z] = values.to_array();
        let gaps = [(y - z).abs(), (z - x).abs(), (x - y).abs()];
        let odd = (0..3).min_by(|&i, &j| gaps[i].total_cmp(&gaps[j])).unwrap_or(0);
        let axis = axes.col(odd);
        let along = Complex64::new(axis.dot(self.re * axis), axis.dot(self.im * axis));
        let across = (self.trace() - along) * 0.5;
        if near(&Self::uniaxial(across, along, axis)) {
            Shape::Uniaxial { across, along, axis }
        } else {
            Shape::Other
        }
    }
}

/// What kind of tensor a tensor is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    Scalar(Complex64),
    Uniaxial { across: Complex64, along: Complex64, axis: DVec3 },
    Other,
}

/// The largest magnitude of an entry.
pub(crate) fn largest(m: &DMat3) -> f64 {
    m.to_cols_array().iter().fold(0.0, |largest, entry| entry.abs().max(largest))
}

impl From<f64> for Tensor {
    fn from(value: f64) -> Self {
        Complex64::from(value).into()
    }
}

impl From<Complex64> for Tensor {
    fn from(value: Complex64) -> Self {
        let scalar = |value| DMat3::from_diagonal(DVec3::splat(value));
        Self { re: scalar(value.re), im: scalar(value.im) }
    }
}

impl From<DMat3> for Tensor {
    fn from(re: DMat3) -> Self {
        Self { re, im: DMat3::ZERO }
    }
}
