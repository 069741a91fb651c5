//! The Faddeeva function w_F(t) = exp(-t²) erfc(-i t), fast and everywhere.
//!
//! Where cloaks live, a table of Taylor polynomials on a square grid answers in one look-up;
//! outside it a convergent of Laplace's continued fraction is exact to rounding. The table is
//! filled once, from the trapezoidal rule.

use std::array;
use std::f64::consts::{FRAC_2_SQRT_PI, PI};
use std::sync::LazyLock;

use num_complex::Complex64;
use pulp::Simd;

use crate::lanes::{ComplexLanes, LANES};

/// Grid points per unit length.
const DENSITY: f64 = 8.0;
/// Grid columns: 0 <= Re t <= 6.6 (the other half follows by symmetry).
const COLUMNS: usize = 54;
/// Grid rows: `LOWEST_ROW` .. `LOWEST_ROW + ROWS`, that is -0.6 <= Im t <= 6.1. (Further down w_F
/// grows like a Gaussian and the patches would need more terms.)
const ROWS: usize = 55;
const LOWEST_ROW: i64 = -5;
/// Taylor terms of a patch: with a spacing of 1/8 the first one left out is below 1e-15 of w_F.
const TERMS: usize = 12;

/// Taylor coefficients c_n about a grid point, in the order in which they are summed.
struct TaylorTerms {
    re: [f64; TERMS],
    im: [f64; TERMS],
}

/// Which coefficient is where in a patch: those in the second half are multiplied by d and added to
/// the first half; what comes of it, halved again, by d².
const ORDER: [usize; TERMS] = [0, 4, 8, 2, 6, 10, 1, 5, 9, 3, 7, 11];

static TABLE: LazyLock<Vec<TaylorTerms>> = LazyLock::new(|| {
    (0..COLUMNS * ROWS)
        .map(|index| {
            let (column, row) = (index / ROWS, index % ROWS);
            patch(Complex64::new(column as f64, (row as i64 + LOWEST_ROW) as f64) / DENSITY)
        })
        .collect()
});

/// w_F, w_F' = 2i/√π - 2 t w_F and w_F'' = -2 w_F - 2 t w_F' at one point; see [`faddeeva`].
#[inline]
pub(super) fn faddeeva_jet(t: Complex64) -> [Complex64; 3] {
    let w = faddeeva(t);
    let w1 = Complex64::new(0.0, FRAC_2_SQRT_PI) - 2.0 * t * w;
    [w, w1, -2.0 * (w + t * w1)]
}

/// The Faddeeva function w_F(t) = exp(-t²) erfc(-i t) (Abramowitz & Stegun, 7.1.3) for any complex
/// t.
///
/// Relative accuracy 1e-13, near the zeros of w_F (below Im t = -1.35) relative to its
/// surroundings. Far below the real axis it grows like exp((Im t)²) and may overflow.
#[inline]
pub(super) fn faddeeva(t: Complex64) -> Complex64 {
    if is_tabulated(t) {
        let w = tabulated(Complex64::new(t.re.abs(), t.im));
        // w_F(-conj t) = conj w_F(t)
        return Complex64::new(w.re, w.im * 1.0_f64.copysign(t.re));
    }
    // In the lower half plane w_F(t) = 2 exp(-t²) - w_F(-t).
    if t.im <= -0.6 { 2.0 * (-t * t).exp() - faddeeva(-t) } else { continued_fraction(t) }
}

/// The Faddeeva function of four arguments.
#[inline(always)]
pub(super) fn faddeeva_lanes<S: Simd>(t: ComplexLanes<S>) -> ComplexLanes<S> {
    let table = TABLE.as_slice();
    let (x, round) = (t.re.abs(), t.re.all(ROUND));
    let (column, row) = (x * DENSITY + round, t.im * DENSITY + round);
    let d = ComplexLanes {
        re: x - (column - round) * (1.0 / DENSITY),
        im: t.im - (row - round) * (1.0 / DENSITY),
    };
    let (arguments, columns, rows) = (t.values(), column.values(), row.values());
    let mut patches = [&table[0]; LANES];
    let mut inside = true;
    for i in 0..LANES {
        inside &= is_tabulated(arguments[i]);
        // Where it is not, any patch does.
        patches[i] = table.get(index(columns[i], rows[i])).unwrap_or(&table[0]);
    }
    let first = patches[0];
    let w = if patches.iter().all(|patch| std::ptr::eq(*patch, first)) {
        // As a rule: rays that go side by side are near each other.
        taylor(d, |k| ComplexLanes { re: d.re.all(first.re[k]), im: d.re.all(first.im[k]) })
    } else {
        let [p, q, r, s] = patches;
        taylor(d, |k| ComplexLanes {
            re: d.re.with([p.re[k], q.re[k], r.re[k], s.re[k]]),
            im: d.re.with([p.im[k], q.im[k], r.im[k], s.im[k]]),
        })
    };
    // w_F(-conj t) = conj w_F(t)
    let w = ComplexLanes { re: w.re, im: w.im * t.re.signs() };
    if inside { w } else { w.elsewhere(arguments, is_tabulated, faddeeva) }
}

/// Σ c_n d^n by Estrin's scheme, as in [`tabulated`]; the coefficients `c` in the order in which
/// they are summed.
#[inline(always)]
fn taylor<S: Simd>(d: ComplexLanes<S>, c: impl Fn(usize) -> ComplexLanes<S>) -> ComplexLanes<S> {
    let (mut pairs, mut fours) = ([d; 6], [d; 3]);
    for (k, pair) in pairs.iter_mut().enumerate() {
        *pair = c(k).plus(c(k + 6), d);
    }
    let d2 = d * d;
    for (k, four) in fours.iter_mut().enumerate() {
        *four = pairs[k].plus(pairs[k + 3], d2);
    }
    let d4 = d2 * d2;
    fours[0].plus(d4, fours[1]).plus(d4 * d4, fours[2])
}

/// Whether the table holds an argument.
#[inline(always)]
fn is_tabulated(t: Complex64) -> bool {
    t.re.abs() < 6.6 && t.im > -0.6 && t.im < 6.1
}

/// Adding this rounds to an integer and leaves that integer in the low bits: 1.5 * 2^52.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Which patch has the column and the row, both with [`ROUND`] added.
#[inline(always)]
fn index(column: f64, row: f64) -> usize {
    let row = (row.to_bits() as u32).wrapping_sub(LOWEST_ROW as u32);
    (column.to_bits() as u32).wrapping_mul(ROWS as u32).wrapping_add(row) as usize
}

/// w_F from the patch nearest to t; t inside the table.
#[inline]
fn tabulated(t: Complex64) -> Complex64 {
    let (column, row) = (t.re * DENSITY + ROUND, t.im * DENSITY + ROUND);
    let d = Complex64::new(t.re - (column - ROUND) / DENSITY, t.im - (row - ROUND) / DENSITY);
    let Some(c) = TABLE.get(index(column, row)) else { return continued_fraction(t) };
    // Estrin's scheme: short dependency chains, and sums of the same form side by side.
    let d2 = d * d;
    let d4 = d2 * d2;
    let pairs: ([f64; 6], [f64; 6]) = folded(&c.re, &c.im, d);
    let (re, im): ([f64; 3], [f64; 3]) = folded(&pairs.0, &pairs.1, d2);
    let fours: [Complex64; 3] = array::from_fn(|k| Complex64::new(re[k], im[k]));
    (fours[0] + d4 * fours[1]) + (d4 * d4) * fours[2]
}

/// Adds the second half of the terms, times `d`, to the first.
#[inline(always)]
fn folded<const N: usize, const M: usize>(
    re: &[f64; N],
    im: &[f64; N],
    d: Complex64,
) -> ([f64; M], [f64; M]) {
    (
        array::from_fn(|k| re[k] + (re[k + M] * d.re - im[k + M] * d.im)),
        array::from_fn(|k| im[k] + (re[k + M] * d.im + im[k + M] * d.re)),
    )
}

/// The twelfth convergent of w_F(t) = (i/√π) / (t - (1/2)/(t - 1/(t - (3/2)/(t - ...)))), as a
/// ratio of polynomials in 1/t².
fn continued_fraction(t: Complex64) -> Complex64 {
    const NUMERATOR: [f64; 6] = [1.0, -32.5, 355.5, -1_569.75, 2_605.312_5, -1_115.156_25];
    const DENOMINATOR: [f64; 7] =
        [1.0, -33.0, 371.25, -1_732.5, 3_248.437_5, -1_949.062_5, 162.421_875];
    let inverse = t.inv();
    let v = inverse * inverse;
    let polynomial = |c: &[f64]| c.iter().rev().fold(Complex64::ZERO, |sum, c| sum * v + c);
    let ratio = polynomial(&NUMERATOR) / polynomial(&DENOMINATOR);
    Complex64::new(0.0, 0.5 * FRAC_2_SQRT_PI) * inverse * ratio
}

/// c_n of w_F(t0 + d) = Σ c_n d^n; from w_F'' = -2 t w_F' - 2 w_F follows the recurrence
/// c_{n+2} = -2 (t0 c_{n+1} + c_n)/(n + 2).
fn patch(t0: Complex64) -> TaylorTerms {
    let mut c = [Complex64::ZERO; TERMS];
    c[0] = by_quadrature(t0);
    c[1] = Complex64::new(0.0, FRAC_2_SQRT_PI) - 2.0 * t0 * c[0];
    for n in 0..TERMS - 2 {
        c[n + 2] = -2.0 * (t0 * c[n + 1] + c[n]) / (n + 2) as f64;
    }
    TaylorTerms { re: ORDER.map(|n| c[n].re), im: ORDER.map(|n| c[n].im) }
}

/// w_F to 1e-15 for Re t >= 0 by the trapezoidal or midpoint rule with the residue of the pole at t
/// (Al Azah & Chandler-Wilde, SIAM J. Numer. Anal. 59, 2346 (2021)): slow, for filling the table.
fn by_quadrature(t: Complex64) -> Complex64 {
    const NODES: u32 = 11;
    if t.im < 0.0 {
        // -t lies in the wrong half: w_F(-t) = conj w_F(conj t).
        return 2.0 * (-t * t).exp() - by_quadrature(t.conj()).conj();
    }
    let step = (PI / f64::from(NODES + 1)).sqrt();
    let phase = (t.re / step).fract();
    let trapezoidal = t.im < t.re && (0.25..=0.75).contains(&phase);
    let offset = if trapezoidal { 1.0 } else { 0.5 };
    let nodes: Complex64 = (0..=NODES)
        .map(|k| {
            let s = (f64::from(k) + offset) * step;
            (-s * s).exp() / (t * t - s * s)
        })
        .sum();
    let i = Complex64::I;
    let rule = 2.0 * i * step * t / PI * nodes;
    let phase_factor = (-2.0 * PI * i * t / step).exp();
    let pole = 2.0 * (-t * t).exp();
    if t.im >= t.re.max(PI / step) {
        rule
    } else if trapezoidal {
        rule + i * step / (PI * t) + pole / (1.0 - phase_factor)
    } else {
        rule + pole / (1.0 + phase_factor)
    }
}

#[cfg(test)]
mod tests {
    use errorfunctions::ComplexErrorFunctions;
    use proptest::prelude::*;
    use pulp::WithSimd;

    use super::*;
    use crate::lanes::{portably, side_by_side};

    /// Error relative to the function, or to its neighbourhood where it has zeros.
    fn error(t: Complex64) -> f64 {
        let (ours, exact) = (faddeeva(t), t.w());
        (ours - exact).norm() / exact.norm().max(if t.im < -1.0 { 0.3 } else { 0.0 })
    }

    #[test]
    fn agrees_with_an_independent_implementation_on_a_dense_grid() {
        let mut worst = (0.0, Complex64::ZERO);
        for row in -150..=900 {
            for column in -900..=900 {
                let t = Complex64::new(f64::from(column), f64::from(row)) / 100.03;
                let error = error(t);
                if error > worst.0 {
                    worst = (error, t);
                }
            }
        }
        assert!(worst.0 < 1e-13, "{worst:?}");
    }

    struct Four([Complex64; LANES]);

    impl WithSimd for Four {
        type Output = [Complex64; LANES];

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            faddeeva_lanes(ComplexLanes::new(simd, self.0)).values()
        }
    }

    #[test]
    fn four_at_once_are_four_alone_inside_the_table_and_out() {
        for k in 0..40_000 {
            let t = array::from_fn(|i| {
                let x = f64::from(k) + 0.37 * i as f64;
                Complex64::new(8.0 * (1.3 * x).sin(), 3.0 + 4.5 * (0.7 * x).cos())
            });
            // Alone, products are rounded before they are added.
            for (four, alone) in
                side_by_side(Four(t)).unwrap_or_else(portably).into_iter().zip(t.map(faddeeva))
            {
                assert!((four - alone).norm() < 1e-14 * alone.norm().max(0.3), "{t:?}");
            }
        }
    }

    #[test]
    fn is_right_at_extreme_arguments() {
        for r in [1e2, 1e5, 1e8, 1e12, 1e100] {
            for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.6, 0.8), (-0.6, 0.8)] {
                assert!(error(Complex64::new(x * r, y * r)) < 1e-13, "{r} {x} {y}");
            }
        }
        assert!(faddeeva(Complex64::new(1e200, 0.0)).is_finite());
        assert!((faddeeva(Complex64::ZERO) - 1.0).norm() < 1e-15);
        for (re, im) in [(f64::NAN, 0.0), (0.0, f64::NAN)] {
            assert!(faddeeva(Complex64::new(re, im)).is_nan());
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let step = 1e-4;
        for (x, y) in [(0.3, 0.2), (-2.5, 1.5), (4.0, 0.0), (1.0, -0.7), (9.0, 3.0), (0.1, 7.0)] {
            let t = Complex64::new(x, y);
            let [before, at, after] = [t - step, t, t + step].map(faddeeva_jet);
            assert!(((after[0] - before[0]) / (2.0 * step) - at[1]).norm() < 1e-6);
            assert!(((after[1] - before[1]) / (2.0 * step) - at[2]).norm() < 1e-6);
        }
    }

    proptest! {
        #[test]
        fn agrees_at_random_points(x in -30.0..30.0, y in -1.5..30.0) {
            prop_assert!(error(Complex64::new(x, y)) < 1e-13);
        }

        #[test]
        fn is_symmetric(x in 0.0..30.0, y in -1.5..30.0) {
            let t = Complex64::new(x, y);
            prop_assert_eq!(faddeeva(-t.conj()), faddeeva(t).conj());
        }

        #[test]
        fn follows_the_reflection_below_the_strip(x in -4.0..4.0, y in -4.0..-1.5) {
            let t = Complex64::new(x, y);
            prop_assert!((faddeeva(t) - t.w()).norm() < 1e-13 * (1.0 + t.w().norm()));
        }
    }
}
