//! A Runge-Kutta method for any system of first order.
//!
//! Twelve stages of order 8 with embedded formulas of orders 5 and 3 for the error, by Dormand and
//! Prince (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, section II.5 and
//! II.10).

/// The largest and the smallest change of the step size from one step to the next.
const FACTOR_RANGE: [f64; 2] = [0.2, 5.0];

/// By how much to stretch the step size after a step of that relative error.
pub(super) fn step_factor(error: f64) -> f64 {
    let [least, most] = FACTOR_RANGE;
    let factor = 0.9 * error.powf(-0.125);
    // An error that is not a number shortens the step.
    if factor.is_nan() { least } else { factor.clamp(least, most) }
}

/// A step of length `h` from `start`, where the rates are `first`: its end, and the estimated error
/// over the allowed one, `weight` being one over what is allowed in each component. Take the step
/// if that is at most 1.
pub(super) fn step<const N: usize>(
    rates: &impl Fn(&[f64; N]) -> [f64; N],
    (start, first): (&[f64; N], &[f64; N]),
    h: f64,
    weight: &[f64; N],
) -> ([f64; N], f64) {
    let mut k = [[0.0; N]; 12];
    k[0] = *first;
    for (stage, weights) in NODES.iter().enumerate() {
        k[stage + 1] = rates(&moved(start, h, weights, &k));
    }
    let end = moved(start, h, &B, &k);
    let (mut fifth, mut third) = (0.0, 0.0);
    for i in 0..N {
        let sum = |weights: &[f64; 12]| -> f64 {
            weights.iter().zip(&k).map(|(w, k)| w * k[i]).sum::<f64>() * weight[i]
        };
        let of_fifth = sum(&E5);
        let of_third = sum(&B) - (B3[0] * k[0][i] + B3[1] * k[8][i] + B3[2] * k[11][i]) * weight[i];
        fifth += of_fifth * of_fifth;
        third += of_third * of_third;
    }
    let error = if fifth == 0.0 { 0.0 } else { fifth / (fifth + 0.01 * third).sqrt() };
    (end, (h * error).abs())
}

/// The end of a step of the classical method of order 4: for predictions.
pub(super) fn predict<const N: usize>(
    rates: &impl Fn(&[f64; N]) -> [f64; N],
    (start, first): (&[f64; N], &[f64; N]),
    h: f64,
) -> [f64; N] {
    let moved = |k: &[f64; N], h: f64| std::array::from_fn(|i| start[i] + h * k[i]);
    let second = rates(&moved(first, 0.5 * h));
    let third = rates(&moved(&second, 0.5 * h));
    let fourth = rates(&moved(&third, h));
    let mean = std::array::from_fn(|i| first[i] + 2.0 * (second[i] + third[i]) + fourth[i]);
    moved(&mean, h / 6.0)
}

/// The start, moved by h Σ w k.
fn moved<const N: usize>(
    start: &[f64; N],
    h: f64,
    weights: &[f64],
    k: &[[f64; N]; 12],
) -> [f64; N] {
    let mut sum = [0.0; N];
    for (weight, k) in weights.iter().zip(k).filter(|(weight, _)| **weight != 0.0) {
        for (sum, k) in sum.iter_mut().zip(k) {
            *sum += weight * k;
        }
    }
    std::array::from_fn(|i| start[i] + h * sum[i])
}

/// What each stage but the first has of those before it.
const NODES: [&[f64]; 11] = [
    &[0.052_600_151_958_767_73],
    &[0.019_725_056_984_537_9, 0.059_175_170_953_613_7],
    &[0.029_587_585_476_806_85, 0.0, 0.088_762_756_430_420_54],
    &[0.241_365_134_159_266_7, 0.0, -0.884_549_479_328_286_1, 0.924_834_003_261_792],
    &[0.037_037_037_037_037_035, 0.0, 0.0, 0.170_828_608_729_473_86, 0.125_467_687_566_822_42],
    &[0.037_109_375, 0.0, 0.0, 0.170_252_211_019_544_05, 0.060_216_538_980_455_96, -0.017_578_125],
    &[
        0.037_092_000_118_504_79,
        0.0,
        0.0,
        0.170_383_925_712_239_98,
        0.107_262_030_446_373_28,
        -0.015_319_437_748_624_402,
        0.008_273_789_163_814_023,
    ],
    &[
        0.624_110_958_716_075_7,
        0.0,
        0.0,
        -3.360_892_629_446_941_4,
        -0.868_219_346_841_726,
        27.592_099_699_446_71,
        20.154_067_550_477_894,
        -43.489_884_181_069_96,
    ],
    &[
        0.477_662_536_438_264_34,
        0.0,
        0.0,
        -2.488_114_619_971_667_7,
        -0.590_290_826_836_843,
        21.230_051_448_181_193,
        15.279_233_632_882_423,
        -33.288_210_968_984_86,
        -0.020_331_201_708_508_627,
    ],
    &[
        -0.937_142_430_085_987_3,
        0.0,
        0.0,
        5.186_372_428_844_064,
        1.091_437_348_996_729_5,
        -8.149_787_010_746_927,
        -18.520_065_659_996_96,
        22.739_487_099_350_505,
        2.493_605_552_679_652_3,
        -3.046_764_471_898_219_6,
    ],
    &[
        2.273_310_147_516_538,
        0.0,
        0.0,
        -10.534_495_466_737_25,
        -2.000_872_058_224_862_5,
        -17.958_931_863_118_8,
        27.948_884_529_419_96,
        -2.858_998_277_135_023_5,
        -8.872_856_933_530_63,
        12.360_567_175_794_303,
        0.643_392_746_015_763_6,
    ],
];

/// Weights of order 8.
const B: [f64; 12] = [
    0.054_293_734_116_568_765,
    0.0,
    0.0,
    0.0,
    0.0,
    4.450_312_892_752_409,
    1.891_517_899_314_500_3,
    -5.801_203_960_010_585,
    0.311_164_366_957_819_9,
    -0.152_160_949_662_516_1,
    0.201_365_400_804_030_34,
    0.044_710_615_727_772_59,
];

/// Weights of order 3, of the first, the ninth and the last stage.
const B3: [f64; 3] = [0.244_094_488_188_976_4, 0.733_846_688_281_611_9, 0.022_058_823_529_411_766];

/// Those of order 8 less weights of order 5.
const E5: [f64; 12] = [
    0.013_120_044_994_194_88,
    0.0,
    0.0,
    0.0,
    0.0,
    -1.225_156_446_376_204_4,
    -0.495_758_949_657_250_2,
    1.664_377_182_454_986_4,
    -0.350_328_848_749_973_66,
    0.334_179_118_713_017_5,
    0.081_923_206_485_115_71,
    -0.022_355_307_863_886_294,
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A planet of eccentricity 0.3: place and velocity.
    fn pull(y: &[f64; 4]) -> [f64; 4] {
        let cube = y[0].hypot(y[1]).powi(3);
        [y[2], y[3], -y[0] / cube, -y[1] / cube]
    }

    const START: [f64; 4] = [0.7, 0.0, 0.0, 1.362_770_287_738_494];

    fn off(a: &[f64; 4], b: &[f64; 4]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn converges_with_order_eight_forwards_and_backwards() {
        for sign in [1.0, -1.0] {
            let [coarse, fine] = [60, 120].map(|count| {
                let mut y = START;
                for _ in 0..count {
                    y = step(&pull, (&y, &pull(&y)), sign * TAU / f64::from(count), &[1.0; 4]).0;
                }
                off(&y, &START)
            });
            let order = (coarse / fine).log2();
            assert!(order > 7.5 && fine < 1e-10, "{coarse} {fine} {order}");
        }
    }

    #[test]
    fn predictions_are_of_order_four() {
        let [coarse, fine] = [0.2, 0.1].map(|h| {
            let exact = step(&pull, (&START, &pull(&START)), h, &[1.0; 4]).0;
            off(&predict(&pull, (&START, &pull(&START)), h), &exact)
        });
        let order = (coarse / fine).log2();
        assert!(order > 4.5 && order < 5.5, "{order}");
    }

    #[test]
    fn estimates_bound_the_error_and_scale_with_a_high_power() {
        let whole = [0.4, 0.2].map(|h| {
            let (end, error) = step(&pull, (&START, &pull(&START)), h, &[1.0; 4]);
            let mut fine = START;
            for _ in 0..8 {
                fine = step(&pull, (&fine, &pull(&fine)), h / 8.0, &[1.0; 4]).0;
            }
            assert!(off(&fine, &end) < error, "{error}");
            error
        });
        assert!((whole[0] / whole[1]).log2() > 6.5, "{whole:?}");
    }

    #[test]
    fn the_step_factor_stays_in_range_for_any_error() {
        let factors = [0.0, f64::NAN, f64::INFINITY, 1.0].map(step_factor);
        assert_eq!(factors, [FACTOR_RANGE[1], FACTOR_RANGE[0], FACTOR_RANGE[0], 0.9]);
    }
}
