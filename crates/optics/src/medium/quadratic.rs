//! The normal components of wave vectors as the roots of a quadratic equation.

use crate::wave::Number;
use num_complex::Complex64;

/// a q² + 2 b q + c = 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quadratic<T> {
    pub a: T,
    pub b: T,
    pub c: T,
}

/// The roots of a real quadratic equation; `root` is the square root of the magnitude of b² - ac.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Roots {
    /// (root - b)/a and (-root - b)/a: waves that carry power.
    Real { plus: f64, minus: f64, root: f64 },
    /// re ± i im, im > 0: waves that decay.
    Complex { re: f64, im: f64, root: f64 },
}

impl<T: Number> Quadratic<T> {
    /// The equation with its leading coefficient kept off zero, where one root would be infinite:
    /// the asymptotic cone of a hyperbolic medium.
    fn bounded(self) -> Self {
        let size = self.b.magnitude_squared() + self.c.magnitude_squared();
        if self.a.magnitude_squared() >= 1e-28 * size {
            return self;
        }
        let least = 1e-14 * size.sqrt();
        let a = if self.a.real() < 0.0 { -least } else { least };
        Self { a: T::from(a), ..self }
    }
}

impl Quadratic<f64> {
    /// The roots; where they coincide they are set apart by about 1e-15, which gives the limit.
    pub fn roots(self) -> Roots {
        let Self { a, b, c } = self.bounded();
        let product = a * c;
        let discriminant = b * b - product;
        let root = discriminant.abs().max(1e-30).sqrt();
        if discriminant < 0.0 {
            return Roots::Complex { re: -b / a, im: root / a.abs(), root };
        }
        // Where b² hides ac, one of the roots comes from their product.
        let (plus, minus) = if product.abs() >= 0.1 * b * b || discriminant <= 1e-30 {
            ((root - b) / a, (-root - b) / a)
        } else if b > 0.0 {
            (c / (-root - b), (-root - b) / a)
        } else {
            ((root - b) / a, c / (root - b))
        };
        Roots::Real { plus, minus, root }
    }

    /// The same where one of them is known, if anything is; see [`Self::refined`].
    pub fn roots_with(self, known: Option<f64>, terms: f64) -> Roots {
        let roots = self.roots();
        known.map_or(roots, |known| self.refined(roots, known, terms))
    }

    /// The roots of the equation where one of them is known; c is the sum of terms of the size `terms`. Near
    /// grazing incidence, where both are close to -b/a, what is known has the digits that the
    /// discriminant, a small difference, has lost.
    pub fn refined(self, roots: Roots, known: f64, terms: f64) -> Roots {
        let Self { a, b, c } = self.bounded();
        let root = (a * known + b).abs();
        if !is_known_better(root, b * b - a * c, b * b + a.abs() * terms) {
            return roots;
        }
        let root = root.max(1e-15);
        Roots::Real { plus: (root - b) / a, minus: (-root - b) / a, root }
    }
}

/// Whether a square root that is known from elsewhere has more digits than that of a small difference of
/// terms of some size, and agrees with it as far as that is known.
pub(crate) fn is_known_better(root: f64, difference: f64, size: f64) -> bool {
    const SMALL: f64 = 1e-2;
    const ROUNDING: f64 = 1e-14;
    difference < SMALL * size && (root * root - difference).abs() <= ROUNDING * size
}

impl Quadratic<Complex64> {
    /// Both roots.
    pub fn complex_roots(self) -> [Complex64; 2] {
        let Self { a, b, c } = self.bounded();
        let mut root = (b * b - a * c).sqrt();
        if root.norm_sqr() < 1e-30 {
            root = Complex64::from(1e-15);
        }
        let towards = (b.conj() * root).re;
        let larger = if towards > 0.0 { -b - root } else { root - b };
        let first = larger / a;
        // From the product of the roots, unless both are of one size and that buys nothing.
        let second =
            if (a * c).norm() >= 0.1 * b.norm_sqr() { (-b * 2.0 - larger) / a } else { c / larger };
        [first, second]
    }
}

impl Roots {
    /// The roots of q² = `square`; see [`Quadratic::roots`].
    pub fn of_square(square: f64) -> Self {
        let root = square.abs().max(1e-30).sqrt();
        if square < 0.0 {
            Self::Complex { re: 0.0, im: root, root }
        } else {
            Self::Real { plus: root, minus: -root, root }
        }
    }

    /// The roots of waves that are known to propagate, which by rounding at grazing incidence may
    /// seem evanescent: they then coincide, but for a hair.
    pub fn propagating(self) -> Self {
        let (Self::Real { root, .. } | Self::Complex { root, .. }) = self;
        let (plus, minus) = self.real_pair();
        Self::Real { plus, minus, root }
    }

    /// The two roots of [`Self::propagating`].
    pub fn real_pair(self) -> (f64, f64) {
        match self {
            Self::Real { plus, minus, .. } => (plus, minus),
            Self::Complex { re, im, .. } => (re + im, re - im),
        }
    }
}
