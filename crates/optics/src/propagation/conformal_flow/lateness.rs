//! What a pulse takes more than its phase, step by step.

use super::ConformalFlow;
use super::points::Point;
use num_complex::Complex64;

/// Panels are no longer than this share of the map's scale.
const LONGEST: f64 = 0.3;

/// Nearer to n = 1 than this, in |f'|² relative to c², it is looked in between.
const NEAR: f64 = 0.1;

/// The place where n = 1 is found to this share of a panel, the square of which counts.
const FOUND: f64 = 1e-5;

/// On steps of no more panels than this, values and slopes at both ends tell that n = 1 is nowhere.
const SHORT: f64 = 4.0;

/// Gauss and Legendre's points on [0, 1], and their weights.
const NODES: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// A step from a point of a ray to another, either way.
pub(super) struct Step<'s> {
    pub flow: &'s ConformalFlow,
    pub from: &'s Point,
    pub to: &'s Point,
    /// The wave vector along z, if z is known so well that it tells the integral of |f'|².
    pub p_z: Option<f64>,
}

/// Where n is less than 1, or more.
enum Side {
    Rarer,
    Denser,
}

impl Step<'_> {
    /// By how much what a pulse takes on the step is more than what its phase takes, cm, at the least dispersion that
    /// causality allows: the group index is n or 1/n, whichever is larger, and n = c/|f'|, so it is the integral of
    /// |f'|² - c² over τ where that is positive. It is negative for a step backwards.
    pub fn lateness(&self) -> f64 {
        let Self { flow, from, to, p_z } = self;
        let time = to.tau - from.tau;
        let square = flow.index_scale * flow.index_scale;
        let length = (to.zeta - from.zeta).norm().max((to.jet.f - from.jet.f).norm());
        let panels = (length / (LONGEST * flow.scale())).ceil().clamp(1.0, 1000.0);
        let side = if panels <= SHORT { self.side(square) } else { None };
        match (side, p_z) {
            (Some(Side::Denser), _) => return 0.0,
            // dz/dτ = p_z |f'|².
            (Some(Side::Rarer), Some(p_z)) => return (to.z - from.z) / p_z - square * time,
            _ => {}
        }
        let mut sum = 0.0;
        let mut before = (0.0, self.surplus(from.jet.f1));
        for number in 1..=panels as u32 {
            let share = f64::from(number) / panels;
            let here = if share < 1.0 { self.at(share) } else { self.surplus(to.jet.f1) };
            sum += self.panel(before, (share, here));
            before = (share, here);
        }
        sum * time
    }

    /// On which side of n = 1 all of the step is, if it clearly is: by Hermite's cubic of |f'|².
    fn side(&self, square: f64) -> Option<Side> {
        let time = self.to.tau - self.from.tau;
        let known = |point: &Point| {
            let bend = point.jet.f1.conj() * point.jet.f2 * point.momentum;
            (point.jet.f1.norm_sqr() / square - 1.0, 2.0 * bend.re * time / square)
        };
        let ((a, rise), (b, fall)) = (known(self.from), known(self.to));
        let between = |s: f64| {
            let left = 1.0 - s;
            let over = s * s * (3.0 - 2.0 * s);
            a + (b - a) * over + s * left * (left * rise - s * fall)
        };
        let all = [a, between(0.25), between(0.5), between(0.75), b];
        if all.iter().all(|surplus| *surplus > NEAR) {
            Some(Side::Rarer)
        } else if all.iter().all(|surplus| *surplus < -NEAR) {
            Some(Side::Denser)
        } else {
            None
        }
    }

    /// |f'|² - c².
    fn surplus(&self, slope: Complex64) -> f64 {
        slope.norm_sqr() - self.flow.index_scale * self.flow.index_scale
    }

    /// The same at a share of the step: the way is Hermite's polynomial of the fifth degree.
    fn at(&self, s: f64) -> f64 {
        let (a, b, time) = (self.from, self.to, self.to.tau - self.from.tau);
        let (left, cube) = (1.0 - s, s * s * s);
        let over = cube * (10.0 + s * (6.0 * s - 15.0));
        let cube_left = left * left * left;
        let slopes = a.momentum * (s * cube_left * (1.0 + 3.0 * s))
            - b.momentum * (left * cube * (1.0 + 3.0 * left));
        let bends = a.force * (s * s * cube_left) + b.force * (left * left * cube);
        let zeta = a.zeta + (b.zeta - a.zeta) * over + slopes * time + bends * (0.5 * time * time);
        self.surplus(self.flow.map.jet(zeta).f1)
    }

    /// The integral between two shares with what there is at them.
    fn panel(&self, a: (f64, f64), b: (f64, f64)) -> f64 {
        if a.1 > 0.0 && b.1 > 0.0 {
            return self.integral(a.0, b.0);
        }
        if a.1 <= 0.0 && b.1 <= 0.0 {
            let least = -NEAR * self.flow.index_scale * self.flow.index_scale;
            if a.1.max(b.1) < least {
                return 0.0;
            }
            let middle = 0.5 * (a.0 + b.0);
            let between = self.at(middle);
            if between <= 0.0 {
                return 0.0;
            }
            return self.panel(a, (middle, between)) + self.panel((middle, between), b);
        }
        let border = self.border(a, b);
        if a.1 > 0.0 { self.integral(a.0, border) } else { self.integral(border, b.0) }
    }

    fn integral(&self, a: f64, b: f64) -> f64 {
        let of = |(node, weight): &(f64, f64)| weight * self.at(a + (b - a) * node).max(0.0);
        (b - a) * NODES.iter().map(of).sum::<f64>()
    }

    /// Where it changes its sign (the Illinois method).
    fn border(&self, mut a: (f64, f64), mut b: (f64, f64)) -> f64 {
        let allowed = FOUND * (b.0 - a.0).abs();
        for _ in 0..40 {
            let next = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
            let here = self.at(next);
            if (here > 0.0) == (b.1 > 0.0) {
                a.1 *= 0.5;
            } else {
                a = b;
            }
            let moved = (next - b.0).abs();
            b = (next, here);
            if moved <= allowed || here == 0.0 {
                break;
            }
        }
        b.0
    }
}
