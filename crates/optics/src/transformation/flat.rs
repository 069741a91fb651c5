//! The conformal map that changes nothing.

use num_complex::Complex64;
use pulp::Simd;

use super::conformal::{JetLanes, LaneMap, MapJet};
use crate::lanes::{ComplexLanes, Lanes};

/// The map f(ζ) = ζ + i y0 of the upper half plane: a flat floor at the height y0.
///
/// Virtual space is physical space, where an index that comes from no map can be followed: see
/// [`IndexPerturbation`](crate::propagation::IndexPerturbation).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatMap {
    level: f64,
    scale: f64,
}

impl FlatMap {
    /// The floor at the height `level`, and the length (positive) over which a medium above it varies, both in cm.
    #[must_use]
    pub fn new(level: f64, scale: f64) -> Self {
        Self { level, scale }
    }

    /// The height y of the floor, cm.
    #[must_use]
    pub fn level(&self) -> f64 {
        self.level
    }

    pub(super) fn scale(&self) -> f64 {
        self.scale
    }

    /// The virtual point of a physical one (cm).
    pub(super) fn inverse(&self, z: Complex64) -> Complex64 {
        z - Complex64::new(0.0, self.level)
    }

    /// Value and derivatives at a virtual point (cm).
    #[inline]
    #[must_use]
    pub fn jet(&self, zeta: Complex64) -> MapJet {
        let f = zeta + Complex64::new(0.0, self.level);
        MapJet { f, f1: Complex64::ONE, f2: Complex64::ZERO }
    }
}

impl LaneMap for FlatMap {
    #[inline(always)]
    fn jets<S: Simd>(&self, zeta: ComplexLanes<S>) -> JetLanes<S> {
        let real = |value: f64| ComplexLanes { re: zeta.re.all(value), im: zeta.re.all(0.0) };
        let raised: Lanes<S> = zeta.im + zeta.im.all(self.level);
        JetLanes { f: ComplexLanes { im: raised, ..zeta }, f1: real(1.0), f2: real(0.0) }
    }
}
