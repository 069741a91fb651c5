//! The radial integrals of rays that turn back before a core.

/// Q with A > 0 and B <= 0, and the square root of its discriminant B² - 4AC.
///
/// Its radii have the parameter η of either sign, 2 A ρ + B = √D cosh η, √Q = √(D/4A) sinh η:
/// smooth along the ray, zero at the turning point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RadialQuadratic {
    pub a: f64,
    pub b: f64,
    pub c: f64,
    pub root: f64,
}

impl RadialQuadratic {
    /// The coefficients, and the discriminant, which the caller knows without cancellation.
    pub fn new(a: f64, b: f64, c: f64, discriminant: f64) -> Self {
        // Where it vanishes the turning point is the core itself; the integrals that diverge there
        // cancel.
        let least = f64::MIN_POSITIVE * 1e30;
        Self { a, b, c, root: discriminant.max(least).sqrt() }
    }

    /// The parameter of a radius on the way out.
    pub fn parameter(&self, rho: f64) -> f64 {
        let root = ((self.a * rho + self.b) * rho + self.c).max(0.0).sqrt();
        (2.0 * (self.a.sqrt() * root) / self.root).asinh()
    }

    /// The radius of a parameter, and √Q with its sign.
    pub fn radius(&self, eta: f64) -> (f64, f64) {
        let rho = (self.root * eta.cosh() - self.b) / (2.0 * self.a);
        (rho, self.root * eta.sinh() / (2.0 * self.a.sqrt()))
    }

    /// The integrals ∫ ρ dρ/√Q, ∫ dρ/√Q and ∫ dρ/(ρ √Q) from the turning point (the larger root of
    /// Q) up to a parameter. Negative on the way in.
    pub fn integrals(&self, eta: f64) -> [f64; 3] {
        let Self { a, b, c, root } = *self;
        let (rho, q) = self.radius(eta);
        let zeroth = eta / a.sqrt();
        let y = 2.0 * q;
        // ∫ dρ/(ρ√Q) = atan(√-C y/w)/√-C or its hyperbolic likeness, w = -(2C + Bρ) > 0 and
        // w² = D ρ² + C y².
        let s = c.abs().sqrt();
        let w = if c < 0.0 { -2.0 * c - b * rho } else { (root * rho).hypot(s * y) };
        let inverse = if s * y.abs() < 1e-4 * w {
            series(y / w, c)
        } else if c < 0.0 {
            (s * y).atan2(w) / s
        } else {
            (s * y / (root * rho)).asinh() / s
        };
        [(q - 0.5 * b * zeroth) / a, zeroth, inverse]
    }
}

/// atanh(√c t)/√c for small c t².
fn series(t: f64, c: f64) -> f64 {
    let x = c * t * t;
    t * (1.0 + x * (1.0 / 3.0 + x * (1.0 / 5.0 + x / 7.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integrals by Simpson's rule in η, in which the integrands are smooth.
    fn by_simpson(quadratic: &RadialQuadratic, eta: f64) -> [f64; 3] {
        let count = 2000;
        let h = eta / f64::from(count);
        let mut sums = [0.0; 3];
        for i in 0..=count {
            let weight = if i == 0 || i == count { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
            let (rho, _) = quadratic.radius(h * f64::from(i));
            for (sum, value) in sums.iter_mut().zip([rho, 1.0, 1.0 / rho]) {
                // dρ/√Q = dη/√A.
                *sum += weight * h / 3.0 * value / quadratic.a.sqrt();
            }
        }
        sums
    }

    #[test]
    fn the_integrals_are_those_of_their_integrands() {
        let cases = [
            (1.3, -0.4, -2.0),
            (0.7, 0.0, -1.0),
            (2.0, -5.0, 1.5),
            (2.0, -5.0, 1e-9),
            (2.0, -5.0, -1e-9),
        ];
        for (a, b, c) in cases {
            let quadratic = RadialQuadratic::new(a, b, c, b * b - 4.0 * a * c);
            for rho in [2.6, 4.0, 10.0] {
                let eta = quadratic.parameter(rho);
                assert!((quadratic.radius(eta).0 - rho).abs() < 1e-12 * rho);
                for eta in [eta, -eta] {
                    let found = quadratic.integrals(eta);
                    let expected = by_simpson(&quadratic, eta);
                    for (found, expected) in found.iter().zip(expected) {
                        let error = (found - expected).abs();
                        assert!(
                            error < 1e-10 * (1.0 + expected.abs()),
                            "{a} {b} {c} {rho} {error}"
                        );
                    }
                }
            }
        }
    }
}
