//! The Runge-Kutta-Nyström method of order 8 by Dormand, El-Mikkawy and Prince.
//!
//! Nine stages, the last at the end of the step, with an embedded formula of order 6 for the error
//! (RKN8(6)9FM, IMA J. Numer. Anal. 7, 423 (1987), with the corrections of 11, 297 (1991)).

use pulp::Simd;

use super::{Field, Motion, Stage, Step, sum};
use crate::lanes::Lanes;

/// One over the largest errors allowed in a step, to weigh the estimates with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ErrorWeight<S: Simd, const Q: usize> {
    /// Of the position.
    pub position: Lanes<S>,
    /// Of the velocity.
    pub velocity: Lanes<S>,
    /// Of each quadrature; zero for those that do not count.
    pub quadrature: [Lanes<S>; Q],
}

/// The largest and the smallest change of the step size from one step to the next.
const FACTOR_RANGE: (f64, f64) = (0.2, 5.0);

/// By how much to stretch the step sizes after steps of the given relative errors.
#[must_use]
#[inline(always)]
pub(crate) fn step_factor<S: Simd>(error: Lanes<S>) -> Lanes<S> {
    let (least, most) = (error.all(FACTOR_RANGE.0), error.all(FACTOR_RANGE.1));
    // error^(-1/8); the safety factor keeps most of the next steps acceptable.
    let factor = error.all(0.9).divided_by(error.sqrt().sqrt().sqrt());
    let factor = factor.less_than(most).choose(factor, most);
    // An error that is not a number shortens the step.
    let known = error.less_than(error.all(f64::INFINITY));
    known.and(least.less_than(factor)).choose(factor, least)
}

/// Σ c_n g_n of the quadrature k.
#[inline(always)]
fn weighted<S: Simd, const Q: usize>(
    weights: &[f64; 7],
    rates: &[[Lanes<S>; Q]; 7],
    k: usize,
) -> Lanes<S> {
    let mut sum = rates[0][k] * weights[0];
    for n in 1..7 {
        sum = sum.plus(rates[n][k], sum.all(weights[n]));
    }
    sum
}

/// Steps of length `h` (negative: backwards) from `start`, where the force is known, and the
/// estimated errors over the allowed ones: take a step if this is at most 1.
#[inline(always)]
pub(crate) fn step<S: Simd, F: Field<S, Q>, const Q: usize>(
    field: &F,
    start: Motion<S>,
    first: Stage<S, F::Jet>,
    h: Lanes<S>,
    weight: &ErrorWeight<S, Q>,
) -> (Step<S, F::Jet, Q>, Lanes<S>) {
    let square = h * h;
    let f0 = first.force;
    let f1 = field.look(start.coasted(h, 0.05).plus_real(f0, square * A1)).force;
    let s2 = field.look(start.coasted(h, 0.1).plus_real(sum(&A2, [f0, f1]), square));
    let f2 = s2.force;
    let s3 = field.look(start.coasted(h, 0.3).plus_real(sum(&A3, [f0, f1, f2]), square));
    let f3 = s3.force;
    let s4 = field.look(start.coasted(h, 0.5).plus_real(sum(&A4, [f0, f1, f2, f3]), square));
    let f4 = s4.force;
    let s5 = field.look(start.coasted(h, 0.7).plus_real(sum(&A5, [f0, f1, f2, f3, f4]), square));
    let f5 = s5.force;
    let s6 =
        field.look(start.coasted(h, 0.9).plus_real(sum(&A6, [f0, f1, f2, f3, f4, f5]), square));
    let f6 = s6.force;
    let s7 =
        field.look(start.coasted(h, 1.0).plus_real(sum(&A7, [f0, f1, f2, f3, f4, f5, f6]), square));
    let places = [f0, f2, f3, f4, f5, f6];
    let position = start.coasted(h, 1.0).plus_real(sum(&B, places), square);
    let last = field.look(position);
    // The velocity formula is the quadrature that interpolates at its nodes, and so are those that
    // give the velocity there.
    let forces = [f0, f2, f3, f4, f5, f6, s7.force];
    let velocity = start.velocity.plus_real(sum(&DB, forces), h);
    let g = [
        field.rates(&first.jet, start.velocity),
        field.rates(&s2.jet, start.velocity.plus_real(sum(&V2, forces), h)),
        field.rates(&s3.jet, start.velocity.plus_real(sum(&V3, forces), h)),
        field.rates(&s4.jet, start.velocity.plus_real(sum(&V4, forces), h)),
        field.rates(&s5.jet, start.velocity.plus_real(sum(&V5, forces), h)),
        field.rates(&s6.jet, start.velocity.plus_real(sum(&V6, forces), h)),
        field.rates(&s7.jet, velocity),
    ];
    let mut quadrature = field.rates(&last.jet, velocity);
    let off = sum(&E, places) * (square * weight.position);
    let astray = (sum(&DE, forces) - last.force * LAST) * (h * weight.velocity);
    let mut error = off.norm_squared() + astray.norm_squared();
    for (k, growth) in quadrature.iter_mut().enumerate() {
        let off = (weighted(&DE, &g, k) - *growth * LAST) * (h * weight.quadrature[k]);
        error = error + off * off;
        *growth = weighted(&DB, &g, k) * h;
    }
    let end = Motion { position, velocity };
    (Step { end, stage: last, quadrature }, error.sqrt())
}

const A1: f64 = 1.0 / 800.0;
const A2: [f64; 2] = [1.0 / 600.0, 1.0 / 300.0];
const A3: [f64; 3] = [9.0 / 200.0, -9.0 / 100.0, 9.0 / 100.0];
const A4: [f64; 4] =
    [-66_701.0 / 197_352.0, 28_325.0 / 32_892.0, -2_665.0 / 5_482.0, 2_170.0 / 24_669.0];
const A5: [f64; 5] = [
    227_015_747.0 / 304_251_000.0,
    -54_897_451.0 / 30_425_100.0,
    12_942_349.0 / 10_141_700.0,
    -9_499.0 / 304_251.0,
    539.0 / 9_250.0,
];
const A6: [f64; 6] = [
    -1_131_891_597.0 / 901_789_000.0,
    41_964_921.0 / 12_882_700.0,
    -6_663_147.0 / 3_220_675.0,
    270_954.0 / 644_135.0,
    -108.0 / 5_875.0,
    114.0 / 1_645.0,
];
const A7: [f64; 7] = [
    13_836_959.0 / 3_667_458.0,
    -17_731_450.0 / 1_833_729.0,
    1_063_919_505.0 / 156_478_208.0,
    -33_213_845.0 / 39_119_552.0,
    13_335.0 / 28_544.0,
    -705.0 / 14_272.0,
    1_645.0 / 57_088.0,
];

/// Fractions of one denominator.
const fn over<const N: usize>(denominator: f64, mut numerators: [f64; N]) -> [f64; N] {
    let mut k = 0;
    while k < N {
        numerators[k] /= denominator;
        k += 1;
    }
    numerators
}

/// Weights of the position at the nodes 0, 0.1, 0.3, 0.5, 0.7, 0.9.
const B: [f64; 6] = over(508_032.0, [14_272.0, 74_025.0, 77_700.0, 46_494.0, 33_300.0, 8_225.0]);
/// Weights of the velocity at the nodes 0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.
const DB: [f64; 7] =
    over(254_016.0, [7_136.0, 41_125.0, 55_500.0, 46_494.0, 55_500.0, 41_125.0, 7_136.0]);
/// B less the weights of order 6.
const E: [f64; 6] = [
    B[0] - 7_987_313.0 / 109_941_300.0,
    B[1] - 1_610_737.0 / 44_674_560.0,
    B[2] - 10_023_263.0 / 33_505_920.0,
    B[3] + 497_221.0 / 12_409_600.0,
    B[4] - 10_023_263.0 / 78_180_480.0,
    B[5] - 1_610_737.0 / 402_071_040.0,
];
/// DB less the weights of order 6, which also has [`LAST`] at the end of the step.
const DE: [f64; 7] = [
    DB[0] - 7_987_313.0 / 109_941_300.0,
    DB[1] - 1_610_737.0 / 40_207_104.0,
    DB[2] - 10_023_263.0 / 23_454_144.0,
    DB[3] + 497_221.0 / 6_204_800.0,
    DB[4] - 10_023_263.0 / 23_454_144.0,
    DB[5] - 1_610_737.0 / 40_207_104.0,
    DB[6] + 4_251_941.0 / 54_970_650.0,
];
const LAST: f64 = 3.0 / 20.0;

/// Weights that integrate the polynomial through the seven nodes up to 0.1, 0.3, 0.5, 0.7, 0.9.
const V2: [f64; 7] = over(
    127_008_000.0,
    [4_757_728.0, 9_361_415.0, -2_496_210.0, 1_753_164.0, -965_310.0, 431_165.0, -141_152.0],
);
const V3: [f64; 7] =
    over(940_800.0, [23_584.0, 162_897.0, 115_842.0, -29_484.0, 12_942.0, -5_173.0, 1_632.0]);
const V4: [f64; 7] =
    over(1_016_064.0, [29_280.0, 161_875.0, 231_750.0, 92_988.0, -9_750.0, 2_625.0, -736.0]);
const V5: [f64; 7] =
    over(518_400.0, [13_664.0, 86_779.0, 106_134.0, 111_132.0, 49_434.0, -5_831.0, 1_568.0]);
const V6: [f64; 7] =
    over(1_568_000.0, [45_792.0, 248_535.0, 354_510.0, 265_356.0, 373_410.0, 138_285.0, -14_688.0]);

#[cfg(test)]
mod tests {
    use pulp::WithSimd;

    use super::*;
    use crate::lanes::{LANES, portably, side_by_side};
    use crate::propagation::nystrom::kepler::{
        OrbitState, Sun, apart, distance, revolution, start, together,
    };

    /// A step of length `h` of four Kepler orbits from `start`; the quadrature is the time integral
    /// of the speed squared.
    struct Orbits {
        start: [OrbitState; LANES],
        h: [f64; LANES],
    }

    impl WithSimd for Orbits {
        type Output = ([OrbitState; LANES], [f64; LANES], [f64; LANES]);

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let one = Lanes::splat(simd, 1.0);
            let weight = ErrorWeight { position: one, velocity: one, quadrature: [one] };
            let h = Lanes::new(simd, self.h);
            let start = together(simd, self.start);
            let (step, error) = step(&Sun, start, Sun.look(start.position), h, &weight);
            (apart(step.end), step.quadrature[0].values(), error.values())
        }
    }

    #[test]
    fn converges_with_order_eight_forwards_and_backwards() {
        let errors = |count| {
            revolution(count, |start, h| {
                let (ends, quadrature, _) =
                    side_by_side(Orbits { start, h }).unwrap_or_else(portably);
                (ends, quadrature)
            })
        };
        for (coarse, fine) in errors(60).into_iter().zip(errors(120)) {
            let order = (coarse.0 / fine.0).log2();
            assert!(order > 7.6 && order < 8.8, "{order} {coarse:?} {fine:?}");
            let order = (coarse.1 / fine.1).log2();
            assert!(order > 7.0, "{order} {coarse:?} {fine:?}");
            assert!(fine.0 < 1e-11, "{fine:?}");
        }
    }

    #[test]
    fn estimates_bound_the_error_and_scale_with_a_high_power() {
        let lengths = [0.4, 0.2, -0.4, -0.2];
        let whole =
            side_by_side(Orbits { start: [start(); LANES], h: lengths }).unwrap_or_else(portably);
        let mut fine = [start(); LANES];
        for _ in 0..8 {
            fine = side_by_side(Orbits { start: fine, h: lengths.map(|h| h / 8.0) })
                .unwrap_or_else(portably)
                .0;
        }
        for (fine, (end, error)) in fine.into_iter().zip(whole.0.into_iter().zip(whole.2)) {
            assert!(distance(fine, end) < error, "{:?}", whole.2);
        }
        assert!((whole.2[0] / whole.2[1]).log2() > 6.5, "{:?}", whole.2);
    }

    struct Factor(f64);

    impl WithSimd for Factor {
        type Output = f64;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> f64 {
            step_factor(Lanes::splat(simd, self.0)).values()[1]
        }
    }

    #[test]
    fn step_factor_stays_in_range_for_any_error() {
        let step_factor = |error| side_by_side(Factor(error)).unwrap_or_else(portably);
        assert_eq!(step_factor(0.0), FACTOR_RANGE.1);
        assert_eq!(step_factor(f64::NAN), FACTOR_RANGE.0);
        assert_eq!(step_factor(f64::INFINITY), FACTOR_RANGE.0);
        assert!((step_factor(1.0) - 0.9).abs() < 1e-15);
    }
}
