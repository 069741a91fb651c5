//! A vector of three complex numbers: an electric or magnetic field.

use glam::{DMat3, DVec3};
use num_complex::Complex64;
use std::ops::{Add, Mul, Neg, Sub};

/// A complex vector in three dimensions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[must_use]
pub struct ComplexVector {
    /// Real part.
    pub re: DVec3,
    /// Imaginary part.
    pub im: DVec3,
}

impl ComplexVector {
    /// The zero vector.
    pub const ZERO: Self = Self { re: DVec3::ZERO, im: DVec3::ZERO };

    /// A vector from its real and imaginary parts.
    pub const fn new(re: DVec3, im: DVec3) -> Self {
        Self { re, im }
    }

    /// The three components.
    #[must_use]
    pub fn components(self) -> [Complex64; 3] {
        std::array::from_fn(|i| Complex64::new(self.re[i], self.im[i]))
    }

    /// The sum of the squared magnitudes of the components, |v|².
    #[must_use]
    pub fn norm_squared(self) -> f64 {
        self.re.length_squared() + self.im.length_squared()
    }

    /// The bilinear product v·w with a real vector.
    #[must_use]
    pub fn dot_real(self, real: DVec3) -> Complex64 {
        Complex64::new(self.re.dot(real), self.im.dot(real))
    }

    /// The bilinear product v·w, without conjugation.
    #[must_use]
    pub fn dot(self, other: Self) -> Complex64 {
        Complex64::new(
            self.re.dot(other.re) - self.im.dot(other.im),
            self.re.dot(other.im) + self.im.dot(other.re),
        )
    }

    /// The cross product v × w.
    pub fn cross(self, other: Self) -> Self {
        Self {
            re: self.re.cross(other.re) - self.im.cross(other.im),
            im: self.re.cross(other.im) + self.im.cross(other.re),
        }
    }

    /// The cross product of a real vector with this one.
    pub fn crossed_by(self, left: DVec3) -> Self {
        Self { re: left.cross(self.re), im: left.cross(self.im) }
    }

    /// The complex conjugate.
    pub fn conj(self) -> Self {
        Self { re: self.re, im: -self.im }
    }

    /// A real matrix applied to the vector.
    pub fn transformed(self, matrix: &DMat3) -> Self {
        Self { re: *matrix * self.re, im: *matrix * self.im }
    }

    /// The vector times a complex number.
    pub fn scaled(self, factor: Complex64) -> Self {
        Self {
            re: self.re * factor.re - self.im * factor.im,
            im: self.re * factor.im + self.im * factor.re,
        }
    }
}

/// The Poynting vector Re(E × H*) of a wave.
#[must_use]
pub fn poynting(electric: ComplexVector, magnetic: ComplexVector) -> DVec3 {
    electric.re.cross(magnetic.re) + electric.im.cross(magnetic.im)
}

impl From<DVec3> for ComplexVector {
    fn from(re: DVec3) -> Self {
        Self { re, im: DVec3::ZERO }
    }
}

impl Add for ComplexVector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl Sub for ComplexVector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }
}

impl Neg for ComplexVector {
    type Output = Self;
    fn neg(self) -> Self {
        Self { re: -self.re, im: -self.im }
    }
}

impl Mul<f64> for ComplexVector {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
}
