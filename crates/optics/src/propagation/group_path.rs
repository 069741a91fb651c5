//! What a pulse takes along a bent way, from what its phase takes.

use super::PathPoint;
use glam::DVec3;
use std::array;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Points of a panel; every other one makes a coarser panel, by which the error is judged.
const NODES: usize = 17;

/// How often a panel is halved at most.
const MOST_HALVINGS: u32 = 20;

/// What rounding makes of a panel, relative to its largest values: halving mends nothing there.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Chebyshev's points on [-1, 1], the derivative there of the polynomial through values at them,
/// and the weights of its integral (Trefethen, Spectral Methods in MATLAB, chapters 6 and 12).
struct Panel<const N: usize> {
    derivative: [[f64; N]; N],
    weights: [f64; N],
}

static FINE: LazyLock<Panel<NODES>> = LazyLock::new(Panel::new);
static COARSE: LazyLock<Panel<9>> = LazyLock::new(Panel::new);

impl<const N: usize> Panel<N> {
    fn node(i: usize) -> f64 {
        -(PI * i as f64 / (N - 1) as f64).cos()
    }

    fn new() -> Self {
        let weight = |i: usize| {
            let end = if i == 0 || i == N - 1 { 0.5 } else { 1.0 };
            if i.is_multiple_of(2) { end } else { -end }
        };
        let mut derivative: [[f64; N]; N] = array::from_fn(|i| {
            array::from_fn(|j| {
                let apart = Self::node(i) - Self::node(j);
                if i == j { 0.0 } else { weight(j) / weight(i) / apart }
            })
        });
        for (i, row) in derivative.iter_mut().enumerate() {
            // Of a constant there is none.
            row[i] = -row.iter().sum::<f64>();
        }
        // Clenshaw and Curtis.
        let last = (N - 1) as f64;
        let weights = array::from_fn(|i| {
            let angle = PI * i as f64 / last;
            let half = N / 2;
            let term = |k: usize| {
                let (double, order) = (if k == half { 1.0 } else { 2.0 }, (4 * k * k - 1) as f64);
                double / order * (2.0 * k as f64 * angle).cos()
            };
            let end = if i == 0 || i == N - 1 { 1.0 } else { 2.0 };
            end / last * (1.0 - (1..=half).map(term).sum::<f64>())
        });
        Self { derivative, weights }
    }

    /// ∫ f dg.
    fn integral(&self, f: &[f64; N], g: &[f64; N]) -> f64 {
        let rate = |row: &[f64; N]| row.iter().zip(g).map(|(d, g)| d * g).sum::<f64>();
        (0..N).map(|i| self.weights[i] * f[i] * rate(&self.derivative[i])).sum()
    }
}

/// Halvings that find a kink between two points: twice the last is a difference of ratios that nobody sees.
const KINK_HALVINGS: u32 = 30;

/// Closer to the end of a piece of a way than this share of it, a kink is at the end.
const AT_END: f64 = 1e-6;

/// Where within a piece of a way, just behind it, a kink is that the side it is on tells, from one point and another
/// between which that changes; `None` if it is at an end of the piece.
pub(super) fn kink_inside<S: PartialEq>(
    [from, to]: [f64; 2],
    [mut low, mut high]: [f64; 2],
    side: impl Fn(f64) -> S,
) -> Option<f64> {
    let first = side(low);
    for _ in 0..KINK_HALVINGS {
        let middle = 0.5 * (low + high);
        *(if side(middle) == first { &mut low } else { &mut high }) = middle;
    }
    let margin = AT_END * (to - from);
    Some(high).filter(|kink| kink - from > margin && to - kink > margin)
}

/// What is integrated along a way, by shares of it between 0 and 1.
struct Integrand<'a> {
    /// The ratio and the optical path.
    panel: &'a dyn Fn([f64; NODES]) -> ([f64; NODES], [f64; NODES]),
    /// What changes where the ratio has a kink, as where the least dispersion of a medium sets in.
    sides: &'a dyn Fn(f64) -> u8,
}

impl Integrand<'_> {
    /// Where a panel has a kink inside, if it has one.
    fn kink(&self, ends: [f64; 2], shares: [f64; NODES]) -> Option<f64> {
        let sides = shares.map(|share| (share, (self.sides)(share)));
        let change = sides.windows(2).find(|two| two[0].1 != two[1].1)?;
        kink_inside(ends, [change[0].0, change[1].0], self.sides)
    }
}

/// ∫ ratio d(optical path) along a way, cm, to within about `tolerance` (cm).
fn integral_along(integrand: &Integrand<'_>, tolerance: f64) -> f64 {
    integral_between([0.0, 1.0], integrand, tolerance, MOST_HALVINGS)
}

fn integral_between(
    [from, to]: [f64; 2],
    integrand: &Integrand<'_>,
    tolerance: f64,
    halvings: u32,
) -> f64 {
    let middle = 0.5 * (from + to);
    let shares = array::from_fn(|i| middle + 0.5 * (to - from) * Panel::<NODES>::node(i));
    let (ratio, path) = (integrand.panel)(shares);
    let every_other = |values: &[f64; NODES]| array::from_fn(|i| values[2 * i]);
    let fine = FINE.integral(&ratio, &path);
    let coarse = COARSE.integral(&every_other(&ratio), &every_other(&path));
    let largest = |values: &[f64; NODES]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let rounding = ROUNDING * largest(&ratio) * largest(&path);
    let is_near = (fine - coarse).abs() <= tolerance.max(rounding);
    // Across a kink both may be off by as much.
    let kink = integrand.kink([from, to], shares);
    if is_near && kink.is_none() || halvings == 0 {
        return fine;
    }
    let cut = kink.unwrap_or(middle);
    let part = |ends: [f64; 2]| integral_between(ends, integrand, 0.5 * tolerance, halvings - 1);
    part([from, cut]) + part([cut, to])
}

/// The same, the ratio being a function of the point and of the unit vector of the ray there. It has kinks only where
/// `sides`, a function of the point, changes.
pub fn group_path_along(
    way: impl Fn(f64) -> PathPoint,
    ratio: impl Fn(DVec3, DVec3) -> f64,
    sides: impl Fn(DVec3) -> u8,
    tolerance: f64,
) -> f64 {
    let panel = |shares: [f64; NODES]| {
        let points = shares.map(&way);
        let ratio = array::from_fn(|i| {
            let rates = FINE.derivative[i].iter().zip(&points);
            let rate: DVec3 = rates.map(|(d, point)| point.position * *d).sum();
            // A way of no length takes no time.
            rate.try_normalize().map_or(1.0, |ray| ratio(points[i].position, ray))
        });
        (ratio, points.map(|point| point.optical_path))
    };
    let sides = |share: f64| sides(way(share).position);
    integral_along(&Integrand { panel: &panel, sides: &sides }, tolerance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn integrals_of_known_functions_come_out() {
        // ∫ cos d(sin) from 0 to 1, and a kink.
        let smooth = |x: [f64; NODES]| (x.map(f64::cos), x.map(f64::sin));
        let exact = 0.5 + 0.25 * 2f64.sin();
        let smooth = Integrand { panel: &smooth, sides: &|_| 0 };
        assert!((integral_along(&smooth, 1e-12) - exact).abs() < 1e-12);
        let panels = Cell::new(0);
        let kink = |x: [f64; NODES]| {
            panels.set(panels.get() + 1);
            (x.map(|x| x.max(0.3)), x.map(|x| x * x))
        };
        let exact = 0.3 * 0.09 + 2.0 / 3.0 * (1.0 - 0.027);
        let unknown = Integrand { panel: &kink, sides: &|_| 0 };
        assert!((integral_along(&unknown, 1e-9) - exact).abs() < 1e-9);
        // Where it is known to be, it costs two panels.
        panels.set(0);
        let known = Integrand { panel: &kink, sides: &|x| u8::from(x > 0.3) };
        assert!((integral_along(&known, 1e-9) - exact).abs() < 1e-9);
        assert_eq!(panels.get(), 3);
    }

    #[test]
    fn a_kink_is_never_overlooked() {
        let (tolerance, mut overlooked) = (1e-2, 0);
        for at in (1..1000).map(|i| f64::from(i) / 1000.0) {
            let kink = |x: [f64; NODES]| (x.map(|x| 100.0 * (x - at).max(0.0)), x);
            let exact = 50.0 * (1.0 - at).powi(2);
            let off = |sides: &dyn Fn(f64) -> u8| {
                (integral_along(&Integrand { panel: &kink, sides }, tolerance) - exact).abs()
            };
            assert!(off(&|x| u8::from(x > at)) < 1e-9, "{at}");
            overlooked += u32::from(off(&|_| 0) > tolerance);
        }
        assert!(overlooked > 0, "such as nobody knows of may be");
    }

    #[test]
    fn what_rounding_hides_is_not_looked_for() {
        // A kink far along a way: 1e-18 cm cannot be had of 1e3 cm.
        let panels = Cell::new(0);
        let kink = |x: [f64; NODES]| {
            panels.set(panels.get() + 1);
            (x.map(|x| x.max(0.3)), x.map(|x| 1e3 + x * x))
        };
        let exact = 0.3 * 0.09 + 2.0 / 3.0 * (1.0 - 0.027);
        let kink = Integrand { panel: &kink, sides: &|_| 0 };
        assert!((integral_along(&kink, 1e-18) - exact).abs() < 1e-9);
        assert!(panels.get() < 1000, "{} panels", panels.get());
    }
}
