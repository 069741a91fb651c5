//! One ray's constants, and how accurately it is followed.

use num_complex::Complex64;

use crate::transformation::MapJet;

/// A ray's constants, and how accurately to follow it.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepControl {
    /// The wave vector along z.
    pub p_z: f64,
    /// The error that the estimate of a step may show, cm.
    pub allowed: f64,
    /// The longest step where the map varies most.
    pub longest: f64,
    /// Whether it is the longest anywhere.
    pub even: bool,
    /// Moves up to this length are exact enough by the method of order four.
    pub short: f64,
}

impl StepControl {
    /// For rays across z in a medium that varies over `scale` (cm), whose `smoothness` is that of
    /// [`ConformalMap::smoothness`], and a largest error at the end of `tolerance`, cm.
    ///
    /// [`ConformalMap::smoothness`]: crate::transformation::ConformalMap::smoothness
    pub fn new(scale: f64, smoothness: f64, tolerance: f64, even: bool) -> Self {
        let tolerance = tolerance.max(1e-12);
        Self {
            p_z: 0.0,
            even,
            allowed: smoothness * tolerance,
            // Where the estimate is low by chance, the order of the method still keeps a shorter
            // step right.
            longest: 1.5 * scale * (tolerance / 1e-6).min(1.0).sqrt().sqrt().sqrt(),
            // A step of order four is off by less than 2/smoothness times the fifth power of its
            // length, both in units of the scale; it may be off by a thousandth of the tolerance.
            // (The fourth root is cheaper than the fifth, and stricter for small tolerances.)
            short: 0.69 * scale * (0.1 * smoothness * tolerance / scale).sqrt().sqrt(),
        }
    }

    /// The same for a ray with a wave vector along z.
    pub fn along_z(self, p_z: f64, index_scale: f64) -> Self {
        // Steep rays take long ways, on which errors have time to grow.
        let flatness = (1.0 - (p_z / index_scale).powi(2)).max(0.05);
        Self { p_z, allowed: flatness.powi(3) * self.allowed, ..self }
    }

    /// `momentum` with its length made to fit |P|² = c² - p_z² |f'|².
    pub fn on_shell(&self, index_scale: f64, momentum: Complex64, jet: &MapJet) -> Complex64 {
        let axial = self.p_z * self.p_z * jet.f1.norm_sqr();
        let square = (index_scale * index_scale - axial).max(0.0);
        let present = momentum.norm_sqr();
        if present > 0.0 { momentum * (square / present).sqrt() } else { momentum }
    }
}
