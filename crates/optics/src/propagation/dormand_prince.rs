//! The explicit Runge-Kutta method of order 8 by Dormand and Prince.
//!
//! Twelve stages, with embedded formulas of order 5 and 3 for the error: Hairer, Nørsett & Wanner, Solving
//! Ordinary Differential Equations I, section II.10 (DOP853, whose coefficients these are).

/// One row of the tableau: coefficients and the stages they belong to.
type Row<const K: usize> = [(f64, usize); K];

/// Slopes of an autonomous system y' = f(y), Q' = g(y), whose quadratures Q do not act back on y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope<const N: usize, const Q: usize> {
    /// f(y).
    pub state: [f64; N],
    /// g(y).
    pub quadrature: [f64; Q],
}

/// Largest errors allowed in one step, to weigh the estimates with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorScale<const N: usize, const Q: usize> {
    /// Of each component of y.
    pub state: [f64; N],
    /// Of each quadrature; infinity for those that do not count.
    pub quadrature: [f64; Q],
}

/// The end of a step that may be taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<const N: usize, const Q: usize> {
    /// y at the end, of order 8.
    pub state: [f64; N],
    /// The growth of Q over the step, of order 8.
    pub quadrature: [f64; Q],
    /// The estimated error over the allowed one: take the step if this is at most 1.
    pub error: f64,
}

/// Slopes evaluated in a step, in addition to the one at its start.
pub const EVALUATIONS: u32 = 11;

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

/// A step of length `h` (negative: backwards) from `state`, where the slope is `first`.
///
/// `slope` gives f alone, `full_slope` f and g: the early stages need no g.
#[inline]
pub fn step<const N: usize, const Q: usize>(
    state: &[f64; N],
    first: Slope<N, Q>,
    h: f64,
    scale: &ErrorScale<N, Q>,
    slope: impl Fn(&[f64; N]) -> [f64; N],
    full_slope: impl Fn(&[f64; N]) -> Slope<N, Q>,
) -> Step<N, Q> {
    let mut k = [first.state; STAGES];
    let mut q = [first.quadrature; STAGES];
    macro_rules! stage {
        ($index:literal, $row:expr) => {
            let here = full_slope(&advanced(state, h, &k, &$row));
            k[$index] = here.state;
            q[$index] = here.quadrature;
        };
    }
    k[1] = slope(&advanced(state, h, &k, &A1));
    k[2] = slope(&advanced(state, h, &k, &A2));
    k[3] = slope(&advanced(state, h, &k, &A3));
    k[4] = slope(&advanced(state, h, &k, &A4));
    stage!(5, A5);
    stage!(6, A6);
    stage!(7, A7);
    stage!(8, A8);
    stage!(9, A9);
    stage!(10, A10);
    stage!(11, A11);
    let squared = |row: &Row<8>| {
        weighted_square(&sum(&k, row), &scale.state)
            + weighted_square(&sum(&q, row), &scale.quadrature)
    };
    let (fifth, third) = (squared(&E5), squared(&E3));
    let norm = (fifth + 0.01 * third).sqrt();
    let error = if norm > 0.0 { h.abs() * fifth / norm } else { norm };
    Step {
        state: advanced(state, h, &k, &B),
        quadrature: sum(&q, &B).map(|growth| h * growth),
        error,
    }
}

#[inline(always)]
fn sum<const N: usize, const K: usize>(k: &[[f64; N]; STAGES], row: &Row<K>) -> [f64; N] {
    let mut total = [0.0; N];
    for &(coefficient, stage) in row {
        for (total, slope) in total.iter_mut().zip(&k[stage]) {
            *total += coefficient * slope;
        }
    }
    total
}

#[inline(always)]
fn advanced<const N: usize, const K: usize>(
    state: &[f64; N],
    h: f64,
    k: &[[f64; N]; STAGES],
    row: &Row<K>,
) -> [f64; N] {
    let mut total = sum(k, row);
    for (total, state) in total.iter_mut().zip(state) {
        *total = state + h * *total;
    }
    total
}

#[inline(always)]
fn weighted_square<const N: usize>(error: &[f64; N], scale: &[f64; N]) -> f64 {
    error.iter().zip(scale).map(|(error, scale)| (error / scale).powi(2)).sum()
}

const STAGES: usize = 12;

const A1: Row<1> = [(0.05260015195876773, 0)];
const A2: Row<2> = [(0.0197250569845379, 0), (0.0591751709536137, 1)];
const A3: Row<2> = [(0.02958758547680685, 0), (0.08876275643042054, 2)];
const A4: Row<3> = [(0.2413651341592667, 0), (-0.8845494793282861, 2), (0.924834003261792, 3)];
const A5: Row<3> = [(0.037037037037037035, 0), (0.17082860872947386, 3), (0.12546768756682242, 4)];
const A6: Row<4> =
    [(0.037109375, 0), (0.17025221101954405, 3), (0.06021653898045596, 4), (-0.017578125, 5)];
const A7: Row<5> = [
    (0.03709200011850479, 0),
    (0.17038392571223998, 3),
    (0.10726203044637328, 4),
    (-0.015319437748624402, 5),
    (0.008273789163814023, 6),
];
const A8: Row<6> = [
    (0.6241109587160757, 0),
    (-3.3608926294469414, 3),
    (-0.868219346841726, 4),
    (27.59209969944671, 5),
    (20.154067550477894, 6),
    (-43.48988418106996, 7),
];
const A9: Row<7> = [
    (0.47766253643826434, 0),
    (-2.4881146199716677, 3),
    (-0.590290826836843, 4),
    (21.230051448181193, 5),
    (15.279233632882423, 6),
    (-33.28821096898486, 7),
    (-0.020331201708508627, 8),
];
const A10: Row<8> = [
    (-0.9371424300859873, 0),
    (5.186372428844064, 3),
    (1.0914373489967295, 4),
    (-8.149787010746927, 5),
    (-18.52006565999696, 6),
    (22.739487099350505, 7),
    (2.4936055526796523, 8),
    (-3.0467644718982196, 9),
];
const A11: Row<9> = [
    (2.273310147516538, 0),
    (-10.53449546673725, 3),
    (-2.0008720582248625, 4),
    (-17.9589318631188, 5),
    (27.94888452941996, 6),
    (-2.8589982771350235, 7),
    (-8.87285693353063, 8),
    (12.360567175794303, 9),
    (0.6433927460157636, 10),
];
const B: Row<8> = [
    (0.054293734116568765, 0),
    (4.450312892752409, 5),
    (1.8915178993145003, 6),
    (-5.801203960010585, 7),
    (0.3111643669578199, 8),
    (-0.1521609496625161, 9),
    (0.20136540080403034, 10),
    (0.04471061572777259, 11),
];
const E5: Row<8> = [
    (0.01312004499419488, 0),
    (-1.2251564463762044, 5),
    (-0.4957589496572502, 6),
    (1.6643771824549864, 7),
    (-0.35032884874997366, 8),
    (0.3341791187130175, 9),
    (0.08192320648511571, 10),
    (-0.022355307863886294, 11),
];
const E3: Row<8> = [
    (-0.18980075407240762, 0),
    (4.450312892752409, 5),
    (1.8915178993145003, 6),
    (-5.801203960010585, 7),
    (-0.4226823213237919, 8),
    (-0.1521609496625161, 9),
    (0.20136540080403034, 10),
    (0.02265179219836082, 11),
];

#[cfg(test)]
mod tests {
    use super::*;

    const LOOSE: ErrorScale<4, 1> = ErrorScale { state: [1.0; 4], quadrature: [1.0; 1] };

    /// A Kepler orbit of eccentricity 0.3; the quadrature is the time integral of the speed squared.
    fn kepler(y: &[f64; 4]) -> Slope<4, 1> {
        let r3 = (y[0] * y[0] + y[1] * y[1]).powf(1.5);
        Slope {
            state: [y[2], y[3], -y[0] / r3, -y[1] / r3],
            quadrature: [y[2] * y[2] + y[3] * y[3]],
        }
    }

    fn pull(y: &[f64; 4]) -> [f64; 4] {
        kepler(y).state
    }

    fn start() -> [f64; 4] {
        [0.7, 0.0, 0.0, (1.3_f64 / 0.7).sqrt()]
    }

    /// One revolution in `count` steps: errors of state and of quadrature.
    fn revolution(count: u32, direction: f64) -> (f64, f64) {
        let h = direction * std::f64::consts::TAU / f64::from(count);
        let (mut y, mut action) = (start(), 0.0);
        for _ in 0..count {
            let step = step(&y, kepler(&y), h, &LOOSE, pull, kepler);
            y = step.state;
            action += step.quadrature[0];
        }
        let state = y.iter().zip(start()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Virial theorem: the mean of v² is 1 for the unit period orbit.
        (state, (action - direction * std::f64::consts::TAU).abs())
    }

    #[test]
    fn converges_with_order_eight_forwards_and_backwards() {
        for direction in [1.0, -1.0] {
            let (coarse, fine) = (revolution(60, direction), revolution(120, direction));
            let order = (coarse.0 / fine.0).log2();
            assert!(order > 7.6 && order < 8.5, "{order}");
            let order = (coarse.1 / fine.1).log2();
            assert!(order > 7.6, "{order}");
            assert!(fine.0 < 1e-11);
        }
    }

    #[test]
    fn estimates_bound_the_error_and_scale_with_a_high_power() {
        let single = |h: f64| {
            let whole = step(&start(), kepler(&start()), h, &LOOSE, pull, kepler);
            let mut y = start();
            for _ in 0..8 {
                y = step(&y, kepler(&y), h / 8.0, &LOOSE, pull, kepler).state;
            }
            let error = y.iter().zip(whole.state).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            (error, whole.error)
        };
        let (coarse, fine) = (single(0.4), single(0.2));
        assert!(coarse.0 < coarse.1 && fine.0 < fine.1, "{coarse:?} {fine:?}");
        assert!((coarse.1 / fine.1).log2() > 6.5);
    }

    #[test]
    fn step_factor_stays_in_range_for_any_error() {
        assert_eq!(step_factor(0.0), FACTOR_RANGE.1);
        assert_eq!(step_factor(f64::NAN), FACTOR_RANGE.0);
        assert_eq!(step_factor(f64::INFINITY), FACTOR_RANGE.0);
        assert!((step_factor(1.0) - 0.9).abs() < 1e-15);
    }
}
