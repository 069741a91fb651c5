//! The numbers that plane waves are made of.

use super::{ComplexVector, Frame};
use glam::DVec3;
use num_complex::Complex64;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Real numbers for waves that propagate, complex ones for those that decay: the same formulas, at
/// the price each deserves.
pub(crate) trait Number:
    Copy
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Mul<Complex64, Output = Complex64>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + From<f64>
    + Into<Complex64>
{
    /// The squared magnitude.
    fn magnitude_squared(self) -> f64 {
        (self * self.conjugate()).real()
    }

    /// The complex conjugate.
    fn conjugate(self) -> Self;

    /// The real part.
    fn real(self) -> f64 {
        Into::<Complex64>::into(self).re
    }

    /// A vector of such numbers in the world.
    type Vector: Copy;

    /// The vector that has the given components in a frame.
    fn vector(frame: &Frame, components: [Self; 3]) -> Self::Vector;

    /// A vector times a complex number: the field of a wave.
    fn wave(vector: Self::Vector, amplitude: Complex64) -> ComplexVector;
}

impl Number for f64 {
    fn conjugate(self) -> Self {
        self
    }

    type Vector = DVec3;

    fn vector(frame: &Frame, components: [Self; 3]) -> DVec3 {
        frame.vector(components)
    }

    fn wave(vector: DVec3, amplitude: Complex64) -> ComplexVector {
        ComplexVector::new(vector * amplitude.re, vector * amplitude.im)
    }
}

impl Number for Complex64 {
    fn conjugate(self) -> Self {
        self.conj()
    }

    type Vector = ComplexVector;

    fn vector(frame: &Frame, components: [Self; 3]) -> ComplexVector {
        frame.complex_vector(components)
    }

    fn wave(vector: ComplexVector, amplitude: Complex64) -> ComplexVector {
        vector.scaled(amplitude)
    }
}

/// The cross product of two triples.
pub(crate) fn cross<T: Number>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The bilinear product of two triples.
pub(crate) fn dot<T: Number>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
