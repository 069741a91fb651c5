//! The conformal map of the grating carpet.

use std::f64::consts::TAU;

use num_complex::Complex64;
use pulp::Simd;

use super::conformal::{ConformalMapError, JetLanes, LaneMap, MapJet};
use super::monotone_root::root_between;
use crate::lanes::ComplexLanes;

/// The map f(ζ) = ζ + i h exp(ikζ), k = 2π/Λ, of the upper half plane, capital = virtual: x + iy =
/// f(X + iY).
///
/// The line Y = 0 becomes a grating of period Λ that swings between y = -h and y = h (a trochoid,
/// its crests narrower than its troughs); far above it the map is the identity. The index 1/|f'|
/// goes from 1/(1 + hk) in the troughs to 1/(1 - hk) on the crests. (Schmied, Halimeh & Wegener,
/// Opt. Express 18, 24361 (2010).)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GratingMap {
    /// How far the floor swings up and down, h, cm.
    pub height: f64,
    pub(super) wave_number: f64,
}

impl GratingMap {
    /// The map of the given `period` Λ that swings by `h` up and down, both in cm. It is one to one
    /// for hk < 1.
    ///
    /// # Errors
    ///
    /// If a length is not finite and positive, or the grating too steep.
    pub fn new(period: f64, h: f64) -> Result<Self, ConformalMapError> {
        ConformalMapError::unless_lengths("grating", &[("period", period), ("height h", h)])?;
        let wave_number = TAU / period;
        let ratio = h * wave_number;
        if ratio < 1.0 && wave_number.is_normal() {
            Ok(Self { height: h, wave_number })
        } else {
            Err(ConformalMapError::Folds { map: "grating", limit: "2 pi h/period < 1", ratio })
        }
    }

    /// Λ, cm.
    #[must_use]
    pub fn period(&self) -> f64 {
        TAU / self.wave_number
    }

    /// Value and derivatives at a virtual point (cm).
    #[inline]
    pub fn jet(&self, zeta: Complex64) -> MapJet {
        let wave = self.wave(zeta);
        let (k, slope) = (self.wave_number, self.height * self.wave_number);
        MapJet {
            f: zeta + self.height * Complex64::new(-wave.im, wave.re),
            f1: 1.0 - slope * wave,
            f2: slope * k * Complex64::new(wave.im, -wave.re),
        }
    }

    /// exp(ikζ).
    #[inline]
    fn wave(&self, zeta: Complex64) -> Complex64 {
        let (sin, cos) = (self.wave_number * zeta.re).sin_cos();
        (-self.wave_number * zeta.im).exp() * Complex64::new(cos, sin)
    }

    /// A virtual point to start the inversion of `z` from: two rounds of ζ -> z - i h exp(ikζ),
    /// which converges above Y = 0.
    pub(super) fn first_guess(&self, z: Complex64) -> Complex64 {
        let above = |zeta: Complex64| Complex64::new(zeta.re, zeta.im.max(0.0));
        let round = |zeta: Complex64| above(z - Complex64::i() * self.height * self.wave(zeta));
        round(round(above(z)))
    }

    /// The virtual X of the floor point at physical `x` (cm).
    pub(super) fn floor_parameter(&self, x: f64) -> f64 {
        let k = self.wave_number;
        root_between(x - self.height, x + self.height, |virtual_x| {
            let (sin, cos) = (k * virtual_x).sin_cos();
            (virtual_x - self.height * sin - x, 1.0 - self.height * k * cos)
        })
    }

    /// The height of the floor above y = 0 at physical `x` (cm).
    pub(super) fn floor_height_at(&self, x: f64) -> f64 {
        self.height * (self.wave_number * self.floor_parameter(x)).cos()
    }

    /// Where the floor has no curvature between two virtual X: cos kX = hk.
    pub(super) fn inflections(&self, start: f64, end: f64) -> Vec<f64> {
        let period = self.period();
        let off = (self.height * self.wave_number).acos() / self.wave_number;
        let (first, last) = ((start / period).floor() as i64 - 1, (end / period).ceil() as i64 + 1);
        (first..=last)
            .flat_map(|n| [-off, off].map(|x| n as f64 * period + x))
            .filter(|x| *x > start && *x < end)
            .collect()
    }

    /// The area between y = 0 and the floor from x = 0 to physical `x`, cm²; odd in x. It is
    /// ∫ h cos kX (1 - hk cos kX) dX.
    pub(super) fn area_from_middle_to(&self, x: f64) -> f64 {
        let (h, k) = (self.height, self.wave_number);
        let virtual_x = self.floor_parameter(x);
        let (sin, cos) = (k * virtual_x).sin_cos();
        h / k * sin - 0.5 * h * h * (k * virtual_x + sin * cos)
    }

    /// The area between the floor and the line y = -h through its troughs over one period, cm².
    #[must_use]
    pub fn area_of_a_period(&self) -> f64 {
        self.height * (self.period() - 0.5 * TAU * self.height)
    }
}

impl LaneMap for GratingMap {
    #[inline(always)]
    fn jets<S: Simd>(&self, zeta: ComplexLanes<S>) -> JetLanes<S> {
        let wave = zeta.with(zeta.values().map(|zeta| self.wave(zeta)));
        let (k, slope) = (self.wave_number, self.height * self.wave_number);
        let f1 = -(wave * slope);
        JetLanes {
            f: zeta + wave.times_i() * self.height,
            f1: ComplexLanes { re: f1.re + f1.re.all(1.0), im: f1.im },
            f2: f1.times_i() * k,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::transformation::{ConformalMap, Truncation};

    fn map(period: f64, slope: f64) -> GratingMap {
        GratingMap::new(period, slope * period / TAU).expect("a valid map")
    }

    /// W_0(s), the point not on the cut, by Halley's method (Corless et al., Adv. Comput. Math. 5,
    /// 329 (1996)).
    fn lambert_w(s: Complex64) -> Complex64 {
        let root = (2.0 * (std::f64::consts::E * s + 1.0)).sqrt();
        // Elsewhere the series about the branch point may lead to another branch.
        let near = root.norm() < 1.2;
        let mut w = if near { -1.0 + root - root * root / 3.0 } else { (1.0 + s).ln() };
        for _ in 0..60 {
            let e = w.exp();
            let excess = w * e - s;
            w -= excess / (e * (w + 1.0) - (w + 2.0) * excess / (2.0 * w + 2.0));
        }
        w
    }

    #[test]
    fn closed_inverse_takes_the_right_branch_far_from_the_branch_point() {
        let (grating, zeta) =
            (map(0.1, 0.894_727_185_894_614_8), Complex64::new(-0.163_756_7, 0.001_894_1));
        let z = grating.jet(zeta).f;
        let k = TAU / grating.period();
        let v = lambert_w(-0.894_727_185_894_614_8 * (Complex64::i() * k * z).exp());
        assert!((z + Complex64::i() * v / k - zeta).norm() < 1e-13);
    }

    #[test]
    fn index_goes_from_trough_to_crest() {
        let grating = map(20.0, 0.47);
        let cut = Truncation::centred(60.0, 28.57);
        let (least, largest) = ConformalMap::Grating(grating).index_range(&cut);
        assert!((least - 1.0 / 1.47).abs() < 1e-12 && (largest - 1.0 / 0.53).abs() < 1e-12);
        // Hundreds of periods miss neither.
        let (least, largest) = ConformalMap::Grating(map(0.2, 0.47)).index_range(&cut);
        assert!((least - 1.0 / 1.47).abs() < 1e-9 && (largest - 1.0 / 0.53).abs() < 1e-9);
    }

    #[test]
    fn area_is_the_integral_of_the_height() {
        let grating = map(20.0, 0.8);
        let count = 20_000;
        let sum: f64 = (0..count)
            .map(|k| grating.floor_height_at((f64::from(k) + 0.5) * 20.0 / f64::from(count)))
            .sum();
        let area = sum * 20.0 / f64::from(count);
        assert!((area - grating.area_from_middle_to(20.0)).abs() < 1e-6);
        assert!((area + 20.0 * grating.height - grating.area_of_a_period()).abs() < 1e-6);
    }

    #[test]
    fn refuses_what_is_not_a_map() {
        for (period, h) in [(0.0, 1.0), (1.0, 0.0), (-1.0, 0.1), (f64::NAN, 1.0), (1.0, f64::NAN)] {
            assert!(matches!(GratingMap::new(period, h), Err(ConformalMapError::Length { .. })));
        }
        assert!(matches!(GratingMap::new(TAU, 1.0), Err(ConformalMapError::Folds { .. })));
        assert!(GratingMap::new(TAU, 0.999).is_ok());
    }

    proptest! {
        #[test]
        fn inverse_is_that_of_lambert(
            period in 0.1_f64..50.0, slope in 0.01_f64..0.99, x in -2.0_f64..2.0, y in 0.0_f64..2.0,
        ) {
            let grating = map(period, slope);
            let zeta = period * Complex64::new(x, y);
            let z = grating.jet(zeta).f;
            let back = ConformalMap::Grating(grating).invert(z).expect("above the floor");
            // With v = -hk exp(ikζ): v exp(v) = -hk exp(ikz), and ζ = z + iv/k.
            let v = lambert_w(-slope * (Complex64::i() * z * TAU / period).exp());
            let closed = z + Complex64::i() * v * period / TAU;
            let slack = 1e-13 * period * (1.0 + x.abs()) / (1.0 - slope).powi(2);
            prop_assert!((back - zeta).norm() < slack, "{back} {zeta}");
            prop_assert!((closed - zeta).norm() < 1e-12 * period / (1.0 - slope).powi(2));
        }

        #[test]
        fn derivatives_agree_with_differences(x in -2.0_f64..2.0, y in -0.1_f64..2.0) {
            let (grating, step) = (map(TAU, 0.7), 1e-4);
            let zeta = Complex64::new(x, y);
            let i = Complex64::i();
            for along in [Complex64::ONE, i] {
                let [a, at, b] = [-step, 0.0, step].map(|d| grating.jet(zeta + d * along));
                prop_assert!(((b.f - a.f) / (2.0 * step * along) - at.f1).norm() < 1e-7);
                prop_assert!(((b.f1 - a.f1) / (2.0 * step * along) - at.f2).norm() < 1e-7);
            }
        }

        #[test]
        fn floor_is_where_virtual_y_is_zero(slope in 0.01_f64..0.999, x in -3.0_f64..3.0) {
            let grating = map(5.0, slope);
            let parameter = grating.floor_parameter(5.0 * x);
            let point = grating.jet(parameter.into()).f;
            prop_assert!((point.re - 5.0 * x).abs() < 1e-13);
            prop_assert!((point.im - grating.floor_height_at(5.0 * x)).abs() < 1e-13);
            for inflection in grating.inflections(-7.0, 7.0) {
                let jet = grating.jet(inflection.into());
                prop_assert!((jet.f1.conj() * jet.f2).im.abs() < 1e-13);
            }
        }
    }
}
