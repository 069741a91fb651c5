//! The normal components of wave vectors as the roots of a quartic equation.

use super::quadratic::{Quadratic, Roots};

/// c₀ + c₁ q + c₂ q² + c₃ q³ + c₄ q⁴ = 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quartic(pub [f64; 5]);

const THIRD: f64 = 1.0 / 3.0;

/// Steps to the root of the resolvent; where it is double, each gains a factor 2.
const MOST_STEPS: usize = 40;

/// A step this small, relative to the root, leaves its square.
const EXACT: f64 = 1e-8;

impl Quartic {
    /// The derivative.
    pub fn slope(&self, q: f64) -> f64 {
        let [_, c1, c2, c3, c4] = self.0;
        c1 + q * (2.0 * c2 + q * (3.0 * c3 + q * (4.0 * c4)))
    }

    /// The roots in two pairs, each real or conjugate, by Ferrari's method: close to those of the
    /// equation where no two are close to one another. Of four real ones the larger two are a pair.
    /// `None` where there are fewer than four, or their sizes are beyond double precision.
    pub fn roots(&self) -> Option<[Roots; 2]> {
        let [c0, c1, c2, c3, c4] = self.0;
        let inverse = c4.recip();
        let [a, b, c, d] = [c3, c2, c1, c0].map(|coefficient| coefficient * inverse);
        // x⁴ + p x² + r x + s of x = q + shift.
        let shift = 0.25 * a;
        let square = shift * shift;
        let p = b - 6.0 * square;
        let r = c - 2.0 * shift * (b - 4.0 * square);
        let s = d - shift * (c - shift * (b - 3.0 * square));
        // (x² + α x + β)(x² - α x + γ), of the largest root α² of the resolvent.
        let u = largest_root(2.0 * p, p * p - 4.0 * s, -r * r).max(0.0);
        let alpha = u.sqrt();
        let sum = p + u;
        let difference = if u > 1e-8 * (p.abs() + s.abs().sqrt()) {
            r / alpha
        } else {
            (sum * sum - 4.0 * s).max(0.0).sqrt().copysign(r)
        };
        let (beta, gamma) = if (sum < 0.0) == (difference < 0.0) {
            let gamma = 0.5 * (sum + difference);
            (if gamma == 0.0 { 0.0 } else { s / gamma }, gamma)
        } else {
            let beta = 0.5 * (sum - difference);
            (beta, if beta == 0.0 { 0.0 } else { s / beta })
        };
        let pair = |half: f64, c: f64| match (Quadratic { a: 1.0, b: half, c }).roots() {
            Roots::Real { plus, minus, root } => {
                Roots::Real { plus: plus - shift, minus: minus - shift, root }
            }
            Roots::Complex { re, im, root } => Roots::Complex { re: re - shift, im, root },
        };
        let is_sound = alpha.is_finite() && beta.is_finite() && gamma.is_finite();
        is_sound.then(|| [pair(0.5 * alpha, beta), pair(-0.5 * alpha, gamma)])
    }
}

/// The largest real root of u³ + a u² + b u + c = 0.
fn largest_root(a: f64, b: f64, c: f64) -> f64 {
    let third = a * THIRD;
    let q = third * third - b * THIRD;
    let r = third * third * third - 0.5 * third * b + 0.5 * c;
    let (r2, q3) = (r * r, q * q * q);
    let mut u = if r2 < q3 {
        // Of three real roots none is larger than if the other two were one.
        2.0 * q.sqrt() - third
    } else {
        // Cardano.
        let size = (r.abs() + (r2 - q3).sqrt()).cbrt().copysign(-r);
        let other = if size == 0.0 { 0.0 } else { q / size };
        size + other - third
    };
    // Newton's method, from above.
    for _ in 0..MOST_STEPS {
        let value = ((u + a) * u + b) * u + c;
        let slope = (3.0 * u + 2.0 * a) * u + b;
        let step = value / slope;
        u -= step;
        if step.is_nan() || step.abs() <= EXACT * u.abs() {
            break;
        }
    }
    u
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of the product of two quadratics q² + a q + b.
    fn product([a, b]: [f64; 2], [c, d]: [f64; 2], scale: f64) -> Quartic {
        Quartic([b * d, a * d + b * c, b + d + a * c, a + c, 1.0].map(|value| value * scale))
    }

    fn values(quartic: Quartic) -> Vec<[f64; 2]> {
        let mut values = Vec::new();
        for pair in quartic.roots().expect("four roots") {
            values.extend(match pair {
                Roots::Real { plus, minus, .. } => [[plus, 0.0], [minus, 0.0]],
                Roots::Complex { re, im, .. } => [[re + 0.0, im], [re + 0.0, -im]],
            });
        }
        values.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        values
    }

    fn assert_near(quartic: Quartic, expected: [[f64; 2]; 4], tolerance: f64) {
        for (found, expected) in values(quartic).into_iter().zip(expected) {
            let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
            assert!(off < tolerance, "{found:?} {expected:?} {off:e}");
        }
    }

    #[test]
    fn roots_of_every_kind() {
        // -2, -1, 1, 3; a pair of conjugates beside -1 and 2; two pairs; two on the imaginary axis.
        let real = product([-4.0, 3.0], [3.0, 2.0], 7.0);
        assert_near(real, [[-2.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [3.0, 0.0]], 1e-14);
        let mixed = product([-1.0, -2.0], [0.6, 1.09], -0.3);
        assert_near(mixed, [[-1.0, 0.0], [-0.3, -1.0], [-0.3, 1.0], [2.0, 0.0]], 1e-14);
        let pairs = product([-1.0, 1.25], [0.6, 1.09], 1e3);
        assert_near(pairs, [[-0.3, -1.0], [-0.3, 1.0], [0.5, -1.0], [0.5, 1.0]], 1e-14);
        let imaginary = product([0.0, 4.0], [0.0, 1.0], 1.0);
        assert_near(imaginary, [[0.0, -2.0], [0.0, -1.0], [0.0, 1.0], [0.0, 2.0]], 1e-14);
        let even = product([0.0, -4.0], [0.0, -1.0], 1.0);
        assert_near(even, [[-2.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [2.0, 0.0]], 1e-14);
    }

    #[test]
    fn close_roots_are_known_to_fewer_digits() {
        let (gap, tolerance) = (1e-4, 1e-11);
        let close = product([-2.0 - gap, 1.0 + gap], [2.0 + gap, 1.0 + gap], 1.0);
        let expected = [[-1.0 - gap, 0.0], [-1.0, 0.0], [1.0, 0.0], [1.0 + gap, 0.0]];
        assert_near(close, expected, tolerance);
    }

    #[test]
    fn fewer_than_four_roots_are_none() {
        assert!(Quartic([1.0, 2.0, -3.0, 1.0, 0.0]).roots().is_none());
        assert!(Quartic([f64::NAN; 5]).roots().is_none());
    }
}
