//! Numbers with their derivatives: differentiation without differences.

use std::ops::{Add, Div, Mul, Sub};

/// The value of a function, and its derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sloped {
    pub value: f64,
    pub slope: f64,
}

impl Sloped {
    /// The variable itself.
    pub fn variable(value: f64) -> Self {
        Self { value, slope: 1.0 }
    }

    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self { value: root, slope: 0.5 * self.slope / root }
    }

    pub fn powf(self, power: f64) -> Self {
        let slope = if power == 0.0 { 0.0 } else { power * self.value.powf(power - 1.0) };
        Self { value: self.value.powf(power), slope: slope * self.slope }
    }
}

impl From<f64> for Sloped {
    fn from(value: f64) -> Self {
        Self { value, slope: 0.0 }
    }
}

impl<T: Into<Self>> Add<T> for Sloped {
    type Output = Self;

    fn add(self, other: T) -> Self {
        let other = other.into();
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl<T: Into<Self>> Sub<T> for Sloped {
    type Output = Self;

    fn sub(self, other: T) -> Self {
        let other = other.into();
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl<T: Into<Self>> Mul<T> for Sloped {
    type Output = Self;

    fn mul(self, other: T) -> Self {
        let other = other.into();
        let slope = self.slope * other.value + self.value * other.slope;
        Self { value: self.value * other.value, slope }
    }
}

impl<T: Into<Self>> Div<T> for Sloped {
    type Output = Self;

    fn div(self, other: T) -> Self {
        let other = other.into();
        let value = self.value / other.value;
        Self { value, slope: (self.slope - value * other.slope) / other.value }
    }
}
