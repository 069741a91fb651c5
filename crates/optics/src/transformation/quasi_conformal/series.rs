//! The sine series of the map, and its coefficients.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::Bump;

/// The highest wave number, in units of 1/w: the floor's curvature jumps at the feet of the bump,
/// so the coefficients fall like 1/k³, and what fades of them moves the floor by less than 1e-4 h.
const FINENESS: f64 = 620.0;

/// The last terms fade like exp(-a (j/J)^p): broken off sharply, they leave ripples all along the
/// floor, with a curvature like that of the map itself, and a ray near it would have to follow
/// each.
const FADING: (f64, i32) = (36.0, 8);

/// The square of an exponential that no derivative brings back into a sum.
const NEGLIGIBLE: f64 = 1e-60;

/// Collocation points for each term.
const OVERSAMPLING: usize = 2;

/// Rounds of the fixed point; a slope of 1.5 takes about 200, and they are not enough for one of 4:
/// each leaves slope/√(1 + slope²) of the error.
const MOST_ROUNDS: u32 = 1000;
const STEEPEST: f64 = 4.0;

/// f(ζ) = ζ + i y0 + i Σ c_j (q^j - r^j), q = exp(iπζ/A), r = exp(-2πH_c/A)/q, with
/// c_j = b_j/(1 - exp(-2 k_j H_c)): the sine series without anything that overflows.
#[derive(Debug)]
pub(super) struct Series {
    /// A.
    pub half_width: f64,
    /// H_c.
    pub virtual_height: f64,
    /// y0, the mean of the floor over X.
    mean: f64,
    /// c_1, c_2, ...
    terms: Vec<f64>,
}

impl Series {
    /// The series of a bump in the box |x| <= A, y <= H. On the floor the map must be x(X) = X - Σ
    /// b_j coth(k_j H_c) sin(k_j X), y(x(X)) = y0 + Σ b_j cos(k_j X): a fixed point. None if it is
    /// not found.
    pub fn solve(bump: Bump, half_width: f64, height: f64) -> Option<Self> {
        let count = (FINENESS * half_width / (PI * bump.width)).ceil() as usize;
        let points = OVERSAMPLING * count;
        // cos(π i/(2 points)): all cosines and sines at the points X = (m + 1/2) A/points.
        let circle = 4 * points;
        let cosines: Vec<f64> =
            (0..circle).map(|i| (2.0 * PI * i as f64 / circle as f64).cos()).collect();
        let cosine = |index: usize| cosines[index % circle];
        let sine = |index: usize| cosines[(index + circle - points) % circle];
        let grid: Vec<f64> =
            (0..points).map(|m| (m as f64 + 0.5) * half_width / points as f64).collect();
        let wave_number = |j: usize| PI * j as f64 / half_width;
        // What moves x by δ moves y by slope δ, and that x again, a quarter of a wave further on:
        // the damping under which such a rotation shrinks fastest.
        let slope = PI * bump.height / bump.width;
        let damping = 1.0 / (1.0 + slope * slope);
        let rounds = if slope > STEEPEST { 0 } else { MOST_ROUNDS };
        let mut x = grid.clone();
        let mut b = vec![0.0; count];
        for _ in 0..rounds {
            let y: Vec<f64> = x.iter().map(|x| bump.height_at(*x)).collect();
            let mean = y.iter().sum::<f64>() / points as f64;
            let virtual_height = height - mean;
            let mut shift = vec![0.0; points];
            for (j, b) in (1..).zip(&mut b) {
                let sum: f64 = (0..points).map(|m| y[m] * cosine(j * (2 * m + 1))).sum();
                *b = 2.0 / points as f64 * sum;
                let along = *b / (wave_number(j) * virtual_height).tanh();
                for (m, shift) in shift.iter_mut().enumerate() {
                    *shift += along * sine(j * (2 * m + 1));
                }
            }
            let mut residual = 0.0_f64;
            for ((x, grid), shift) in x.iter_mut().zip(&grid).zip(&shift) {
                let change = grid - shift - *x;
                residual = residual.max(change.abs());
                *x += damping * change;
            }
            if residual < 1e-13 * half_width {
                let rising = x.windows(2).all(|pair| pair[0] < pair[1]);
                let decay = |j: usize| (-2.0 * wave_number(j) * virtual_height).exp();
                let faded = |j: usize| (-FADING.0 * (j as f64 / count as f64).powi(FADING.1)).exp();
                let terms = (1..).zip(&b).map(|(j, b)| faded(j) * b / (1.0 - decay(j))).collect();
                return rising.then_some(Self { half_width, virtual_height, mean, terms });
            }
            if residual.is_nan() {
                break;
            }
        }
        None
    }

    /// The highest wave number, 1/cm.
    pub fn highest_wave_number(&self) -> f64 {
        self.terms.len() as f64 * PI / self.half_width
    }

    /// The first Taylor coefficients of f about a point, two or more.
    pub fn taylor<const N: usize>(&self, zeta: Complex64) -> [Complex64; N] {
        let rate = Complex64::new(0.0, PI / self.half_width);
        let q = (rate * zeta).exp();
        let r = (-rate * (zeta - Complex64::new(0.0, 2.0 * self.virtual_height))).exp();
        let mut sums = [Complex64::ZERO; N];
        let (mut up, mut down) = (Complex64::ONE, Complex64::ONE);
        for (j, c) in (1..).zip(&self.terms) {
            up *= q;
            down *= r;
            // Both fall from the floor and from the image of the top: nothing more is added.
            if up.norm_sqr().max(down.norm_sqr()) < NEGLIGIBLE {
                break;
            }
            // (i k_j)^n/n! of both exponentials: in the second the sign alternates.
            let (mut rising, mut falling) = (*c * up, -*c * down);
            let step = rate * f64::from(j);
            for (n, sum) in (1..).zip(&mut sums) {
                *sum += rising + falling;
                rising *= step / f64::from(n);
                falling *= -step / f64::from(n);
            }
        }
        let mut taylor = sums.map(|sum| Complex64::i() * sum);
        taylor[0] += zeta + Complex64::new(0.0, self.mean);
        taylor[1] += Complex64::ONE;
        taylor
    }
}
