//! The conformal map that changes nothing.

use num_complex::Complex64;
use pulp::Simd;

use super::conformal::{JetLanes, LaneMap, MapJet};
use crate::lanes::ComplexLanes;

/// The map f(ζ) = ζ + i y0 of the upper half plane: a flat floor at the height y0.
///
/// Virtual space is physical space, where an index that comes from no map can be followed: see
/// [`IndexPerturbation`](crate::propagation::IndexPerturbation).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatMap {
    /// y0, cm.
    pub(super) level: f64,
    /// The length over which the medium varies, cm.
    pub(super) scale: f64,
}

impl FlatMap {
    /// The floor at the height `level`, and the length (positive) over which a medium above it
    /// varies, both in cm.
    #[must_use]
    pub fn new(level: f64, scale: f64) -> Self {
        Self { level, scale }
    }

    /// Value and derivatives at a virtual point (cm).
    #[inline]
    pub fn jet(&self, zeta: Complex64) -> MapJet {
        let f = zeta + Complex64::new(0.0, self.level);
        MapJet { f, f1: Complex64::ONE, f2: Complex64::ZERO }
    }
}

impl LaneMap for FlatMap {
    #[inline(always)]
    fn jets<S: Simd>(&self, zeta: ComplexLanes<S>) -> JetLanes<S> {
        let im = zeta.im + zeta.im.all(self.level);
        JetLanes { f: ComplexLanes { im, ..zeta }, f1: zeta.real(1.0), f2: zeta.real(0.0) }
    }
}
