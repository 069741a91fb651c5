//! The sine series of the map, and its coefficients.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::Bump;
use super::chirp::ChirpTransform;

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

/// Rounds of the fixed point; a slope of 1.5 takes about 50, one of 4 about 170.
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
        let grid: Vec<f64> =
            (0..points).map(|m| (m as f64 + 0.5) * half_width / points as f64).collect();
        let wave_number = |j: usize| PI * j as f64 / half_width;
        // What x moves by δ moves y by slope δ, and that x again, a quarter of a wave further on:
        // steps from the last place but one are those under which such a rotation shrinks fastest
        // (Concus & Golub 1976, Widlund 1978). In a low box coth makes more of it than the slope,
        // so √2 of that is reckoned with.
        let slope = PI * bump.height / bump.width;
        let momentum = 2.0 / (1.0 + (1.0 + 2.0 * slope * slope).sqrt());
        let rounds = if slope > STEEPEST { 0 } else { MOST_ROUNDS };
        // At the points X = (m + 1/2) A/points a term has the phase π (j/2 + jm)/points.
        let phase = |n: u64| {
            let circle = 4 * points as u64;
            Complex64::cis(2.0 * PI * (n % circle) as f64 / circle as f64)
        };
        let mut transform = ChirpTransform::new(points, points, phase);
        let half_steps: Vec<_> = (1..=count as u64).map(phase).collect();
        let (mut x, mut last) = (grid.clone(), grid.clone());
        let mut b = vec![0.0; count];
        for _ in 0..rounds {
            let y: Vec<f64> = x.iter().map(|x| bump.height_at(*x)).collect();
            let mean = y.iter().sum::<f64>() / points as f64;
            let virtual_height = height - mean;
            // b_j is a sum of cosines over the points, x one of sines over the terms.
            let mut along = vec![Complex64::ZERO; count];
            let sums = transform.sums(y.iter().map(|y| y.into())).skip(1);
            for ((j, sum), ((b, along), half)) in
                (1..).zip(sums).zip(b.iter_mut().zip(&mut along).zip(&half_steps))
            {
                *b = 2.0 / points as f64 * (sum * half).re;
                *along = *b / (wave_number(j) * virtual_height).tanh() * half;
            }
            let shift = transform.sums(std::iter::once(Complex64::ZERO).chain(along));
            let mut residual = 0.0_f64;
            for (((x, last), grid), shift) in x.iter_mut().zip(&mut last).zip(&grid).zip(shift) {
                let moved = grid - shift.im;
                residual = residual.max((moved - *x).abs());
                let next = *last + momentum * (moved - *last);
                (*last, *x) = (*x, next);
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

    /// What [`Self::taylor_along`] needs for so many points that are `step` inverse highest wave
    /// numbers apart, on rows at `bottom` or higher.
    pub fn transform_along(&self, columns: usize, step: u64, bottom: f64) -> ChirpTransform {
        // What has faded there is left out.
        let rate = PI / self.half_width;
        let last = -0.5 * NEGLIGIBLE.ln() / (rate * bottom.max(0.0));
        let terms = self.terms.len().min(last.ceil() as usize);
        // Whole radians are told apart from the rest, or large ones would be inexact.
        let circle = 2 * self.terms.len() as u128;
        ChirpTransform::new(terms + 1, columns, |square| {
            let n = u128::from(square) * u128::from(step);
            let (whole, rest) = ((n / circle) as f64, (n % circle) as f64 / circle as f64);
            Complex64::cis(whole) * Complex64::cis(rest)
        })
    }

    /// [`Self::taylor`] at points of one height, from X = 0 on, `spacing` apart.
    pub fn taylor_along<const N: usize>(
        &self,
        transform: &mut ChirpTransform,
        columns: usize,
        spacing: f64,
        y: f64,
    ) -> Vec<[Complex64; N]> {
        let rate = PI / self.half_width;
        let wave_numbers = || (1..=self.terms.len()).map(|j| rate * j as f64);
        let terms = || wave_numbers().zip(&self.terms);
        let mut rising: Vec<f64> = terms().map(|(k, c)| c * (-k * y).exp()).collect();
        let below_image = y - 2.0 * self.virtual_height;
        let mut falling: Vec<f64> = terms().map(|(k, c)| -c * (k * below_image).exp()).collect();
        let place = |m: usize| Complex64::new(m as f64 * spacing, y + self.mean);
        let mut taylor = vec![[Complex64::ZERO; N]; columns];
        let mut factor = Complex64::i();
        let mut conjugate_factor = Complex64::i();
        for n in 0..N {
            let mut add = |amplitudes: &[f64], term: &dyn Fn(Complex64) -> Complex64| {
                let inputs = std::iter::once(0.0).chain(amplitudes.iter().copied());
                for (taylor, sum) in taylor.iter_mut().zip(transform.sums(inputs.map(Into::into))) {
                    taylor[n] += term(sum);
                }
            };
            add(&rising, &|sum| factor * sum);
            add(&falling, &|sum| conjugate_factor * sum.conj());
            // (i k)^n/n! of both exponentials: in the second the sign alternates.
            factor *= Complex64::i();
            conjugate_factor *= -Complex64::i();
            for (k, (rising, falling)) in wave_numbers().zip(rising.iter_mut().zip(&mut falling)) {
                *rising *= k / (n + 1) as f64;
                *falling *= k / (n + 1) as f64;
            }
        }
        for (m, taylor) in taylor.iter_mut().enumerate() {
            taylor[0] += place(m);
            taylor[1] += Complex64::ONE;
        }
        taylor
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
