//! What a pulse takes more than its phase, step by step.

use num_complex::Complex64;
use pulp::{Simd, WithSimd};

use super::points::Point;
use super::{ConformalFlow, IndexPerturbation};
use crate::lanes::{ComplexLanes, LANES, Lanes, side_by_side};
use crate::transformation::{LaneMap, of_each};

/// |f'|² is looked at so often, as a share of the map's scale, for what is wanted to within [`ROUGH`] cm; between, it
/// is a cubic, whose error is of the fourth order.
const SPACING: f64 = 0.2;
const ROUGH: f64 = 1e-4;

/// A step that is shorter than this share of the map's scale, or in an uneven medium than two looks, is one cubic, if
/// that keeps clear of n = 1: the place of it does not count.
const SHORT: f64 = 1.2;

/// How far from n = 1 such a cubic must keep, in |f'|² relative to c².
const CLEAR: f64 = 0.1;

/// What a cubic over two pieces may differ from what is between them, times their length in τ, as a share of what is
/// wanted. That over one is nearer by sixteen times, and its integral by more.
const ALLOWED: f64 = 0.2;

/// How often two pieces are halved at most where they differ by more.
const MOST_HALVINGS: u32 = 16;

/// How often a cubic is halved where n = 1, until it is taken for straight.
const HALVINGS: u32 = 3;

/// What is wanted of the pulses of a packet of rays.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Accuracy {
    /// To within how much it is worked out what they take, cm.
    to: f64,
    /// How often |f'|² is looked at, cm.
    spacing: f64,
    /// Up to which length a step may be one cubic, cm.
    short: f64,
    /// From which wave vector along z on z tells the integral of |f'|².
    steep: f64,
}

impl Accuracy {
    /// To within `to`, cm, of rays that are followed to within `tolerance`, cm.
    pub fn new(flow: &ConformalFlow, tolerance: f64, to: f64) -> Self {
        let finer = (to / ROUGH).min(1.0).sqrt().sqrt();
        let steep = 2.0 * tolerance / to * flow.index_scale;
        let short = if flow.is_uneven() { 2.0 * SPACING } else { SHORT } * flow.scale();
        Self { to, spacing: SPACING * flow.scale() * finer, short, steep }
    }
}

/// A step from a point of a ray to another, either way.
pub(super) struct Step<'s> {
    pub flow: &'s ConformalFlow,
    pub from: &'s Point,
    pub to: &'s Point,
    /// By how much the parameter of the ray grows, of which τ is one in media that are not uneven.
    pub time: f64,
    /// The wave vector along z.
    pub p_z: f64,
}

impl Step<'_> {
    /// By how much what a pulse takes on the step is more than what its phase takes, cm, at the least dispersion that
    /// causality allows: the group index is n or 1/n, whichever is larger, and n = c ρ/|f'|, so it is the integral of
    /// |f'|² - c² ρ² over the parameter where that is positive. It is negative for a step backwards.
    pub fn lateness(&self, wanted: &Accuracy) -> f64 {
        let Self { flow, from, to, time, p_z } = *self;
        let square = flow.index_scale * flow.index_scale;
        let [virtually, really] = [to.zeta - from.zeta, to.jet.f - from.jet.f];
        let length = virtually.norm_sqr().max(really.norm_sqr()).sqrt();
        let pairs = (0.5 * length / wanted.spacing).ceil().clamp(1.0, 10_000.0);
        let [start, end] = [(0.0, from), (1.0, to)].map(|(share, point)| self.node(share, point));
        if length < wanted.short {
            let Cubic(bounds) = Cubic::between(&start, &end);
            if bounds.iter().all(|surplus| *surplus < -CLEAR * square) {
                return 0.0;
            }
            if p_z.abs() >= wanted.steep && bounds.iter().all(|surplus| *surplus > CLEAR * square) {
                // dz/dτ = p_z |f'|².
                return (to.z - from.z) / p_z - square * (to.tau - from.tau);
            }
        }
        let way =
            Way { flow, powers: self.way(), square, allowed: ALLOWED * wanted.to / time.abs() };
        let (mut sum, mut here) = (0.0, start);
        let share = |number: usize| (0.5 * number as f64 / pairs).min(1.0);
        for first in (1..2 * pairs as usize).step_by(LANES) {
            // Middle, end, middle, end.
            let shares = std::array::from_fn(|i| share(first + i));
            let nodes = way.nodes(shares);
            for two in nodes.chunks_exact(2).filter(|two| two[0].share < 1.0) {
                let next = if two[1].share < 1.0 { two[1] } else { end };
                sum += way.pieces([&here, &two[0], &next], MOST_HALVINGS);
                here = next;
            }
        }
        sum * time
    }

    fn node(&self, share: f64, point: &Point) -> Node {
        let square = self.flow.index_scale * self.flow.index_scale;
        let perturbation = self.flow.index_perturbation.as_deref();
        let (uneven, gradient) =
            perturbation.map_or((1.0, Complex64::ZERO), |uneven| uneven.look(point.jet.f));
        let stretched = 2.0 * (point.jet.f1.conj() * point.jet.f2 * point.momentum).re;
        let climbed = square * (point.velocity.conj() * gradient).re;
        let surplus = point.jet.f1.norm_sqr() - square * uneven;
        Node { share, surplus, slope: (stretched - climbed) * self.time }
    }

    /// ζ by the powers of the share of the step: Hermite's polynomial of the fifth degree.
    fn way(&self) -> [Complex64; 6] {
        let (a, b, time) = (self.from, self.to, self.time);
        let [start, slope, bend] = [a.zeta, a.momentum * time, a.force * (0.5 * time * time)];
        let place = b.zeta - start - slope - bend;
        let speed = b.momentum * time - slope - bend * 2.0;
        let turn = b.force * (0.5 * time * time) - bend;
        let fifth = place * 6.0 - speed * 3.0 + turn;
        let fourth = place * -15.0 + speed * 7.0 - turn * 2.0;
        [start, slope, bend, place * 10.0 - speed * 4.0 + turn, fourth, fifth]
    }
}

/// The surplus |f'|² - c² ρ² at a share of a step, and its derivative by the share.
#[derive(Clone, Copy)]
struct Node {
    share: f64,
    surplus: f64,
    slope: f64,
}

/// The way of a step.
struct Way<'s> {
    flow: &'s ConformalFlow,
    powers: [Complex64; 6],
    square: f64,
    /// By how much a cubic over two pieces may differ in between, times what share of the step they are.
    allowed: f64,
}

impl Way<'_> {
    #[inline(never)]
    fn nodes(&self, shares: [f64; LANES]) -> [Node; LANES] {
        let map = &self.flow.map;
        // Portable code is one for all maps.
        let with_instructions = of_each!(map, map => side_by_side(self.between(map, shares)).ok());
        let [surplus, slope] = with_instructions
            .unwrap_or_else(|| self.between(map, shares).with_simd(pulp::Scalar256b));
        std::array::from_fn(|i| Node { share: shares[i], surplus: surplus[i], slope: slope[i] })
    }

    fn between<'m, M>(&'m self, map: &'m M, shares: [f64; LANES]) -> Between<'m, M> {
        let Self { flow, powers, square, .. } = self;
        let perturbation = flow.index_perturbation.as_deref();
        Between { map, perturbation, powers, shares, square: *square }
    }

    /// The integral of what is positive of the surplus over two pieces: by two cubics if one is nearly as good, or by
    /// more.
    fn pieces(&self, [from, middle, to]: [&Node; 3], halvings: u32) -> f64 {
        let width = to.share - from.share;
        let off = Cubic::between(from, to).middle() - middle.surplus;
        let halves = [(from, middle), (middle, to)];
        if halvings == 0 || off.is_nan() || off.abs() * width <= self.allowed {
            let part = |(a, b)| Cubic::between(a, b).positive_part(HALVINGS);
            return 0.5 * width * halves.map(part).iter().sum::<f64>();
        }
        let [a, b, c, d] = [0.25, 0.75, 1.0, 1.0].map(|part| from.share + width * part);
        let nodes = self.nodes([a, b, c, d]);
        self.pieces([from, &nodes[0], middle], halvings - 1)
            + self.pieces([middle, &nodes[1], to], halvings - 1)
    }
}

/// The surplus and its derivative at four shares of a step.
struct Between<'s, M> {
    map: &'s M,
    perturbation: Option<&'s IndexPerturbation>,
    powers: &'s [Complex64; 6],
    shares: [f64; LANES],
    square: f64,
}

impl<M: LaneMap> WithSimd for Between<'_, M> {
    type Output = [[f64; LANES]; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let shares = Lanes::new(simd, self.shares);
        let all = |c: Complex64| ComplexLanes { re: shares.all(c.re), im: shares.all(c.im) };
        let (mut zeta, mut slope) = (all(self.powers[5]), all(Complex64::ZERO));
        for power in self.powers[..5].iter().rev() {
            slope = zeta.plus_real(slope, shares);
            zeta = all(*power).plus_real(zeta, shares);
        }
        let jet = self.map.jets(zeta);
        let (stretched, rise) = (jet.f1.norm_squared(), (jet.f1.conj() * jet.f2 * slope).re * 2.0);
        let Some(perturbation) = self.perturbation else {
            return [(stretched - shares.all(self.square)).values(), rise.values()];
        };
        let seen = jet.f.values().map(|z| perturbation.look(z));
        let (uneven, gradient) =
            (shares.with(seen.map(|(square, _)| square)), jet.f.with(seen.map(|(_, g)| g)));
        let climb = ((jet.f1 * slope).conj() * gradient).re;
        let [surplus, rise] = [stretched - uneven * self.square, rise - climb * self.square];
        [surplus.values(), rise.values()]
    }
}

/// A cubic on [0, 1] by Bernstein's coefficients, between the least and the largest of which it lies.
#[derive(Clone, Copy)]
struct Cubic([f64; 4]);

impl Cubic {
    fn between(from: &Node, to: &Node) -> Self {
        let third = (to.share - from.share) / 3.0;
        let [b, c] = [from.surplus + from.slope * third, to.surplus - to.slope * third];
        Self([from.surplus, b, c, to.surplus])
    }

    fn middle(self) -> f64 {
        let Self([a, b, c, d]) = self;
        0.125 * (a + 3.0 * (b + c) + d)
    }

    /// The integral of what is positive of it, halved so often where it changes its sign and then taken for straight.
    fn positive_part(self, halvings: u32) -> f64 {
        let Self([a, b, c, d]) = self;
        if a >= 0.0 && b >= 0.0 && c >= 0.0 && d >= 0.0 {
            return 0.25 * (a + b + c + d);
        }
        if a <= 0.0 && b <= 0.0 && c <= 0.0 && d <= 0.0 {
            return 0.0;
        }
        if halvings == 0 {
            let (high, low) = (a.max(d).max(0.0), a.min(d));
            return if low >= 0.0 {
                0.5 * (high + low)
            } else {
                0.5 * high * (high / (high - low))
            };
        }
        let middle = |x: f64, y: f64| 0.5 * (x + y);
        let [ab, bc, cd] = [middle(a, b), middle(b, c), middle(c, d)];
        let [abc, bcd] = [middle(ab, bc), middle(bc, cd)];
        let half = middle(abc, bcd);
        let halves = [Self([a, ab, abc, half]), Self([half, bcd, cd, d])];
        0.5 * halves.map(|half| half.positive_part(halvings - 1)).iter().sum::<f64>()
    }
}
