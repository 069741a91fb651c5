//! The Runge-Kutta-Nyström method of order 8 by Dormand, El-Mikkawy and Prince.
//!
//! For y'' = F(y), a force that does not depend on the velocity: nine stages, the last at the end of the
//! step, with an embedded formula of order 6 for the error (RKN8(6)9FM, IMA J. Numer. Anal. 7, 423 (1987),
//! with the corrections of 11, 297 (1991)).

use num_complex::Complex64;

/// A place in the plane and its velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// y.
    pub position: Complex64,
    /// y'.
    pub velocity: Complex64,
}

/// What is known of the field of force at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage<J> {
    /// F.
    pub force: Complex64,
    /// What else was found there, for the quadratures.
    pub jet: J,
}

/// Largest errors allowed in one step, to weigh the estimates with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorScale<const Q: usize> {
    /// Of the position.
    pub position: f64,
    /// Of the velocity.
    pub velocity: f64,
    /// Of each quadrature; infinity for those that do not count.
    pub quadrature: [f64; Q],
}

/// The end of a step that may be taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<J, const Q: usize> {
    /// Where the step ends, of order 8.
    pub end: Motion,
    /// The field of force there.
    pub stage: Stage<J>,
    /// The growth of the quadratures ∫ g(y, y') over the step.
    pub quadrature: [f64; Q],
    /// The estimated error over the allowed one: take the step if this is at most 1.
    pub error: f64,
}

/// Evaluations of the force in a step, in addition to the one at its start.
pub const EVALUATIONS: u32 = 8;

/// The largest and the smallest change of the step size from one step to the next.
const FACTOR_RANGE: (f64, f64) = (0.2, 5.0);

/// By how much to stretch the step size after a step of the given relative error.
#[must_use]
pub fn step_factor(error: f64) -> f64 {
    // error^(-1/8); the safety factor keeps most of the next steps acceptable.
    let factor = 0.9 / error.sqrt().sqrt().sqrt();
    // A NaN shortens the step.
    if factor > FACTOR_RANGE.0 { factor.min(FACTOR_RANGE.1) } else { FACTOR_RANGE.0 }
}

/// A step of length `h` (negative: backwards) from `start`, where the force is known.
///
/// `look` finds the force at a place, `rates` the integrands g of the quadratures there.
#[inline]
pub fn step<J: Copy, const Q: usize>(
    start: Motion,
    first: Stage<J>,
    h: f64,
    scale: &ErrorScale<Q>,
    look: impl Fn(Complex64) -> Stage<J>,
    rates: impl Fn(&J, Complex64) -> [f64; Q],
) -> Step<J, Q> {
    let square = h * h;
    let coast = |share: f64| start.position + (share * h) * start.velocity;
    let f0 = first.force;
    let f1 = look(coast(0.05) + square * A1 * f0).force;
    let s2 = look(coast(0.1) + square * (A2[0] * f0 + A2[1] * f1));
    let f2 = s2.force;
    let s3 = look(coast(0.3) + square * (A3[0] * f0 + A3[1] * f1 + A3[2] * f2));
    let f3 = s3.force;
    let s4 = look(coast(0.5) + square * (A4[0] * f0 + A4[1] * f1 + A4[2] * f2 + A4[3] * f3));
    let f4 = s4.force;
    let s5 = look(
        coast(0.7) + square * (A5[0] * f0 + A5[1] * f1 + A5[2] * f2 + A5[3] * f3 + A5[4] * f4),
    );
    let f5 = s5.force;
    let s6 = look(
        coast(0.9)
            + square
                * (A6[0] * f0 + A6[1] * f1 + A6[2] * f2 + A6[3] * f3 + A6[4] * f4 + A6[5] * f5),
    );
    let f6 = s6.force;
    let s7 = look(
        coast(1.0)
            + square
                * (A7[0] * f0
                    + A7[1] * f1
                    + A7[2] * f2
                    + A7[3] * f3
                    + A7[4] * f4
                    + A7[5] * f5
                    + A7[6] * f6),
    );
    let f7 = s7.force;
    let place =
        |b: &[f64; 6]| b[0] * f0 + b[1] * f2 + b[2] * f3 + b[3] * f4 + b[4] * f5 + b[5] * f6;
    let position = coast(1.0) + square * place(&B);
    let last = look(position);
    // The velocity formula is the quadrature that interpolates at its nodes, and so are those that give
    // the velocity there.
    let forces = [f0, f2, f3, f4, f5, f6, f7];
    let sum = |row: &[f64; 7]| row.iter().zip(forces).map(|(c, f)| c * f).sum::<Complex64>();
    let velocity_after = |row: &[f64; 7]| start.velocity + h * sum(row);
    let velocity = velocity_after(&DB);
    let g = [
        rates(&first.jet, start.velocity),
        rates(&s2.jet, velocity_after(&V2)),
        rates(&s3.jet, velocity_after(&V3)),
        rates(&s4.jet, velocity_after(&V4)),
        rates(&s5.jet, velocity_after(&V5)),
        rates(&s6.jet, velocity_after(&V6)),
        rates(&s7.jet, velocity),
    ];
    let end_rates = rates(&last.jet, velocity);
    let quadrature =
        std::array::from_fn(|k| h * DB.iter().zip(&g).map(|(b, g)| b * g[k]).sum::<f64>());
    let mut error = (square * place(&E)).norm_sqr() / (scale.position * scale.position)
        + (h * (sum(&DE) - LAST * last.force)).norm_sqr() / (scale.velocity * scale.velocity);
    for k in 0..Q {
        let estimate = DE.iter().zip(&g).map(|(e, g)| e * g[k]).sum::<f64>() - LAST * end_rates[k];
        error += (h * estimate / scale.quadrature[k]).powi(2);
    }
    Step { end: Motion { position, velocity }, stage: last, quadrature, error: error.sqrt() }
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

/// Weights of the position at the nodes 0, 0.1, 0.3, 0.5, 0.7, 0.9.
const B: [f64; 6] = [
    223.0 / 7_938.0,
    1_175.0 / 8_064.0,
    925.0 / 6_048.0,
    41.0 / 448.0,
    925.0 / 14_112.0,
    1_175.0 / 72_576.0,
];
/// Weights of the velocity at the nodes 0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.
const DB: [f64; 7] = [
    223.0 / 7_938.0,
    5_875.0 / 36_288.0,
    4_625.0 / 21_168.0,
    41.0 / 224.0,
    4_625.0 / 21_168.0,
    5_875.0 / 36_288.0,
    223.0 / 7_938.0,
];
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
const V2: [f64; 7] = [
    148_679.0 / 3_969_000.0,
    267_469.0 / 3_628_800.0,
    -83_207.0 / 4_233_600.0,
    773.0 / 56_000.0,
    -32_177.0 / 4_233_600.0,
    12_319.0 / 3_628_800.0,
    -4_411.0 / 3_969_000.0,
];
const V3: [f64; 7] = [
    737.0 / 29_400.0,
    7_757.0 / 44_800.0,
    19_307.0 / 156_800.0,
    -351.0 / 11_200.0,
    2_157.0 / 156_800.0,
    -739.0 / 134_400.0,
    17.0 / 9_800.0,
];
const V4: [f64; 7] = [
    305.0 / 10_584.0,
    23_125.0 / 145_152.0,
    12_875.0 / 56_448.0,
    41.0 / 448.0,
    -1_625.0 / 169_344.0,
    125.0 / 48_384.0,
    -23.0 / 31_752.0,
];
const V5: [f64; 7] = [
    427.0 / 16_200.0,
    86_779.0 / 518_400.0,
    17_689.0 / 86_400.0,
    343.0 / 1_600.0,
    8_239.0 / 86_400.0,
    -5_831.0 / 518_400.0,
    49.0 / 16_200.0,
];
const V6: [f64; 7] = [
    1_431.0 / 49_000.0,
    7_101.0 / 44_800.0,
    35_451.0 / 156_800.0,
    9_477.0 / 56_000.0,
    37_341.0 / 156_800.0,
    3_951.0 / 44_800.0,
    -459.0 / 49_000.0,
];

#[cfg(test)]
mod tests {
    use super::*;

    const LOOSE: ErrorScale<1> = ErrorScale { position: 1.0, velocity: 1.0, quadrature: [1.0] };

    /// A Kepler orbit of eccentricity 0.3; the quadrature is the time integral of the speed squared.
    fn pull(y: Complex64) -> Stage<()> {
        Stage { force: -y / y.norm().powi(3), jet: () }
    }

    fn action_rate((): &(), velocity: Complex64) -> [f64; 1] {
        [velocity.norm_sqr()]
    }

    fn start() -> Motion {
        Motion { position: 0.7.into(), velocity: Complex64::new(0.0, (1.3_f64 / 0.7).sqrt()) }
    }

    fn distance(a: Motion, b: Motion) -> f64 {
        (a.position - b.position).norm().hypot((a.velocity - b.velocity).norm())
    }

    fn stepped(start: Motion, h: f64) -> Step<(), 1> {
        step(start, pull(start.position), h, &LOOSE, pull, action_rate)
    }

    /// One revolution in `count` steps: errors of state and of quadrature.
    fn revolution(count: u32, direction: f64) -> (f64, f64) {
        let h = direction * std::f64::consts::TAU / f64::from(count);
        let (mut motion, mut action) = (start(), 0.0);
        for _ in 0..count {
            let step = stepped(motion, h);
            motion = step.end;
            action += step.quadrature[0];
        }
        // Virial theorem: the mean of v² is 1 for the unit period orbit.
        (distance(motion, start()), (action - direction * std::f64::consts::TAU).abs())
    }

    #[test]
    fn converges_with_order_eight_forwards_and_backwards() {
        for direction in [1.0, -1.0] {
            let (coarse, fine) = (revolution(60, direction), revolution(120, direction));
            let order = (coarse.0 / fine.0).log2();
            assert!(order > 7.6 && order < 8.8, "{order} {coarse:?} {fine:?}");
            let order = (coarse.1 / fine.1).log2();
            assert!(order > 7.0, "{order} {coarse:?} {fine:?}");
            assert!(fine.0 < 1e-11, "{fine:?}");
        }
    }

    #[test]
    fn estimates_bound_the_error_and_scale_with_a_high_power() {
        let single = |h: f64| {
            let whole = stepped(start(), h);
            let fine = (0..8).fold(start(), |motion, _| stepped(motion, h / 8.0).end);
            (distance(fine, whole.end), whole.error)
        };
        let (coarse, fine) = (single(0.4), single(0.2));
        assert!(coarse.0 < coarse.1 && fine.0 < fine.1, "{coarse:?} {fine:?}");
        assert!((coarse.1 / fine.1).log2() > 6.5, "{coarse:?} {fine:?}");
    }

    #[test]
    fn step_factor_stays_in_range_for_any_error() {
        assert_eq!(step_factor(0.0), FACTOR_RANGE.1);
        assert_eq!(step_factor(f64::NAN), FACTOR_RANGE.0);
        assert_eq!(step_factor(f64::INFINITY), FACTOR_RANGE.0);
        assert!((step_factor(1.0) - 0.9).abs() < 1e-15);
    }
}
