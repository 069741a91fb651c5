//! The conformal map of the Gaussian carpet and of the double-Gaussian cloak.

use std::f64::consts::{FRAC_2_SQRT_PI, PI};

use num_complex::Complex64;
use pulp::Simd;

use super::conformal::{ConformalMapError, JetLanes, LaneMap, MapJet};
use super::faddeeva::{faddeeva, faddeeva_jet, faddeeva_lanes};
use super::monotone_root::root_between;
use crate::lanes::ComplexLanes;

/// The map f(ζ) = ζ + i h w_F(ζ/w) of the upper half plane, capital = virtual: x + iy = f(X + iY).
///
/// w_F is the Faddeeva function. The line Y = 0 becomes a bump of height h whose sides are steeper
/// than a Gaussian's; far away the map is the identity. (Schmied, Halimeh & Wegener, Opt. Express
/// 18, 24361 (2010); design (iv) of Halimeh & Wegener, Opt. Express 21, 9457 (2013).)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianMap {
    /// w, cm.
    pub(super) width: f64,
    /// The height h of the metal above Y = 0 in the middle, cm.
    pub height: f64,
    inverse_width: f64,
}

impl GaussianMap {
    /// The map of width `w` and height `h`, both in cm. It is one to one for h/w < √π/2.
    ///
    /// # Errors
    ///
    /// If a length is not finite and positive, or the bump too steep.
    pub fn new(w: f64, h: f64) -> Result<Self, ConformalMapError> {
        ConformalMapError::unless_lengths("Gaussian map", &[("width w", w), ("height h", h)])?;
        let inverse_width = w.recip();
        let ratio = h / w;
        if ratio < PI.sqrt() / 2.0 && inverse_width.is_normal() {
            Ok(Self { width: w, height: h, inverse_width })
        } else {
            Err(ConformalMapError::Folds {
                map: "Gaussian map",
                limit: "h/w < sqrt(pi)/2 = 0.886",
                ratio,
            })
        }
    }

    /// Value and derivatives at a virtual point (cm).
    #[inline]
    pub fn jet(&self, zeta: Complex64) -> MapJet {
        let [w, w1, w2] = faddeeva_jet(zeta * self.inverse_width);
        let times_i = |c: Complex64, factor: f64| Complex64::new(-factor * c.im, factor * c.re);
        let slope = self.height * self.inverse_width;
        MapJet {
            f: zeta + times_i(w, self.height),
            f1: 1.0 + times_i(w1, slope),
            f2: times_i(w2, slope * self.inverse_width),
        }
    }

    /// A virtual point to start the inversion of `z` from: exact far away, tame near the bump.
    pub(super) fn first_guess(&self, z: Complex64) -> Complex64 {
        let pull = self.height * self.width * FRAC_2_SQRT_PI / 2.0;
        let softening = 0.25 * self.height * self.height;
        let guess = z + z.conj() * (pull / (z.norm_sqr() + softening));
        Complex64::new(guess.re, guess.im.max(0.0))
    }

    /// The virtual X of the floor point at physical `x` (cm).
    pub(super) fn floor_parameter(&self, x: f64) -> f64 {
        // x = X - h (2/√π) D(X/w) with Dawson's function 0 <= D < 0.542 for X >= 0.
        let (sign, x) = (1.0_f64.copysign(x), x.abs());
        let far = x + 0.542 * FRAC_2_SQRT_PI * self.height;
        sign * root_between(x, far, |virtual_x| {
            let jet = self.jet(Complex64::new(virtual_x, 0.0));
            (jet.f.re - x, jet.f1.re)
        })
    }

    /// The height of the floor above Y = 0 at physical `x` (cm).
    pub(super) fn floor_height_at(&self, x: f64) -> f64 {
        let t = self.floor_parameter(x) * self.inverse_width;
        self.height * (-t * t).exp()
    }

    /// The area between Y = 0 and the floor from the middle to physical `x`, cm²; odd in x.
    ///
    /// With t = X/w, ∫ h exp(-t²) dx = h w [S - (h/(√π w)) (S + exp(-t²) D(t))], where S = ∫
    /// exp(-t²) dt and D is Dawson's function.
    pub(super) fn area_from_middle_to(&self, x: f64) -> f64 {
        let t = self.floor_parameter(x.abs()) * self.inverse_width;
        let gaussian = (-t * t).exp();
        let root_pi_half = FRAC_2_SQRT_PI.recip();
        let integral = root_pi_half * (1.0 - gaussian * faddeeva(Complex64::new(0.0, t)).re);
        let dawson = root_pi_half * faddeeva(Complex64::new(t, 0.0)).im;
        let bend = self.height * self.inverse_width / PI.sqrt();
        let area = self.height * self.width * (integral - bend * (integral + gaussian * dawson));
        area.copysign(x)
    }

    /// The area between Y = 0 and the whole floor, cm².
    #[must_use]
    pub fn area(&self) -> f64 {
        self.height * (PI.sqrt() * self.width - self.height)
    }
}

impl LaneMap for GaussianMap {
    #[inline(always)]
    fn jets<S: Simd>(&self, zeta: ComplexLanes<S>) -> JetLanes<S> {
        // As in `jet`, with w_F' and w_F'' multiplied by i throughout.
        let t = zeta * self.inverse_width;
        let w = faddeeva_lanes(t);
        let twice = t * 2.0;
        let i_w = w.times_i();
        let i_w1 = -(twice * i_w);
        let i_w1 = ComplexLanes { re: i_w1.re - i_w1.re.all(FRAC_2_SQRT_PI), im: i_w1.im };
        let i_w2 = -(i_w * 2.0).plus(twice, i_w1);
        let slope = self.height * self.inverse_width;
        let f1 = i_w1 * slope;
        JetLanes {
            f: zeta.plus_real(i_w, i_w.re.all(self.height)),
            f1: ComplexLanes { re: f1.re + f1.re.all(1.0), im: f1.im },
            f2: i_w2 * (slope * self.inverse_width),
        }
    }
}
