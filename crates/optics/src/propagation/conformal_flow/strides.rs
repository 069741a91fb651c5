//! Moves of four rays at once.

use pulp::{Simd, WithSimd};

use super::crossing::Gauges;
use super::points::{PointLanes, Points};
use crate::lanes::{ComplexLanes, LANES, Lanes, side_by_side};
use crate::propagation::nystrom::order_eight::ErrorWeight;
use crate::propagation::nystrom::{Field, Motion, Stage, order_eight, order_four};
use crate::transformation::{ConformalMap, JetLanes, LaneMap};

/// How a ray moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StepKind {
    /// Not at all: it is at its start, where the momentum is still conj(f') and the length of P short of P itself.
    Departure,
    /// By Taylor's formula of order two, but for the map at the new place; exact for straight rays.
    Coast,
    /// By the method of order four.
    Short,
    /// By the method of order eight.
    Full,
}

/// What four rays keep on their way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rays {
    pub p_z: [f64; LANES],
    /// One over the error allowed in a step.
    pub weight: [f64; LANES],
    /// c.
    pub strength: f64,
    /// The length over which errors of direction grow into errors of position.
    pub lever: f64,
}

/// What has come of a move.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StepResult {
    pub end: Points,
    /// Estimated error over the allowed one.
    pub error: [f64; LANES],
    /// By how much to stretch the next step.
    pub factor: [f64; LANES],
    /// When the ray next meets the border, by extrapolation from the end; infinity for never.
    pub ahead: [f64; LANES],
    /// Not zero if the ray may have crossed the border on the way.
    pub crossed: [f64; LANES],
}

impl StepResult {
    /// Takes down what has come of a move.
    #[inline(always)]
    pub fn arrive<S: Simd>(
        &mut self,
        from: &PointLanes<S>,
        end: &PointLanes<S>,
        p_z: Lanes<S>,
        error: Lanes<S>,
        gauges: &Gauges,
    ) {
        self.end.store(end);
        self.error = error.values();
        self.factor = order_eight::step_factor(error).values();
        let outlook = gauges.outlook(from, end, p_z);
        self.ahead = outlook.ahead.values();
        self.crossed = outlook.crossed.values();
    }
}

/// A momentum with its length made to fit |P|² = `square`, or 0 where that is negative.
#[inline(always)]
pub(super) fn of_square<S: Simd>(momentum: ComplexLanes<S>, square: Lanes<S>) -> ComplexLanes<S> {
    let (zero, one) = (square.all(0.0), square.all(1.0));
    let square = zero.less_than(square).choose(square, zero);
    let present = momentum.norm_squared();
    let moving = zero.less_than(present);
    momentum * moving.choose(square, zero).divided_by(moving.choose(present, one)).sqrt()
}

/// Moves four rays by the lengths (of any sign) into `to`.
pub(super) fn stride(
    map: &ConformalMap,
    gauges: &Gauges,
    rays: &Rays,
    pace: StepKind,
    from: &Points,
    length: &[f64; LANES],
    to: &mut StepResult,
) {
    // Which map it is is settled once for a step, not at every evaluation.
    match map {
        ConformalMap::Gaussian(map) => {
            side_by_side(Strides { map, gauges, rays, pace, from, length, to });
        }
        ConformalMap::Grating(map) => {
            side_by_side(Strides { map, gauges, rays, pace, from, length, to });
        }
        ConformalMap::QuasiConformal(map) => {
            side_by_side(Strides { map, gauges, rays, pace, from, length, to });
        }
        ConformalMap::Flat(map) => {
            side_by_side(Strides { map, gauges, rays, pace, from, length, to });
        }
    }
}

struct Strides<'w, M> {
    map: &'w M,
    gauges: &'w Gauges,
    rays: &'w Rays,
    pace: StepKind,
    from: &'w Points,
    length: &'w [f64; LANES],
    to: &'w mut StepResult,
}

/// The force on rays in virtual space.
#[derive(Clone, Copy)]
struct Force<'w, S: Simd, M> {
    map: &'w M,
    p_z: Lanes<S>,
    strength: Lanes<S>,
}

impl<S: Simd, M: LaneMap> Field<S, 2> for Force<'_, S, M> {
    type Jet = JetLanes<S>;

    #[inline(always)]
    fn look(&self, zeta: ComplexLanes<S>) -> Stage<S, JetLanes<S>> {
        let jet = self.map.jets(zeta);
        Stage { force: jet.f1 * jet.f2.conj() * -(self.p_z * self.p_z), jet }
    }

    /// dz/dτ = p_z |f'|², and dθ/dτ: with σ = p_z |f'|/c the sine of the ray's angle to the virtual plane,
    /// -σ/(1 + |σ|) Im(P f''/f').
    #[inline(always)]
    fn rates(&self, jet: &JetLanes<S>, momentum: ComplexLanes<S>) -> [Lanes<S>; 2] {
        let square = jet.f1.norm_squared();
        let stretch = square.sqrt();
        let turn = (momentum * (jet.f2 * jet.f1.conj())).im;
        let slowness = stretch * (self.strength + self.p_z.abs() * stretch);
        [self.p_z * square, (-self.p_z * turn).divided_by(slowness)]
    }
}

impl<S: Simd, M: LaneMap> Force<'_, S, M> {
    /// A momentum with its length made to fit |P|² = c² - p_z² |f'|².
    #[inline(always)]
    fn on_shell(&self, momentum: ComplexLanes<S>, jet: &JetLanes<S>) -> ComplexLanes<S> {
        let axial = self.p_z * self.p_z * jet.f1.norm_squared();
        of_square(momentum, self.strength * self.strength - axial)
    }
}

impl<M: LaneMap> WithSimd for Strides<'_, M> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let p_z = Lanes::new(simd, self.rays.p_z);
        let strength = Lanes::splat(simd, self.rays.strength);
        let field = Force { map: self.map, p_z, strength };
        let from = self.from.load(simd);
        let h = Lanes::new(simd, *self.length);
        let start = Motion { position: from.zeta, velocity: from.momentum };
        let first = Stage { force: from.force, jet: from.jet };
        let mut error = p_z.all(0.0);
        let (motion, stage, z, theta) = match self.pace {
            StepKind::Departure => {
                let stage = field.look(from.zeta);
                let velocity = field.on_shell(stage.jet.f1.conj() * from.momentum, &stage.jet);
                (Motion { velocity, ..start }, stage, from.z, from.theta)
            }
            StepKind::Coast => {
                let [z_rate, theta_rate] = field.rates(&from.jet, from.momentum);
                let half = h * 0.5;
                let position = from.zeta.plus_real(from.momentum.plus_real(from.force, half), h);
                let velocity = from.momentum.plus_real(from.force, h);
                let z = from.z + (z_rate + from.axial_bend(p_z) * half) * h;
                let stage = field.look(position);
                (Motion { position, velocity }, stage, z, from.theta + theta_rate * h)
            }
            StepKind::Short => {
                let step = order_four::step(&field, start, first, h);
                // By the values and slopes at both ends, which are at hand.
                let [[z0, _], [z1, _]] = [
                    field.rates(&from.jet, from.momentum),
                    field.rates(&step.stage.jet, step.end.velocity),
                ];
                let end = PointLanes { jet: step.stage.jet, momentum: step.end.velocity, ..from };
                let slopes = from.axial_bend(p_z) - end.axial_bend(p_z);
                let z = from.z + ((z0 + z1) * 0.5 + slopes * h * (1.0 / 12.0)) * h;
                (step.end, step.stage, z, from.theta + step.quadrature[1])
            }
            StepKind::Full => {
                let weight = Lanes::new(simd, self.rays.weight);
                let weight = ErrorWeight {
                    position: weight,
                    velocity: weight * self.rays.lever,
                    // z is all there is to control for rays nearly across it, and estimates of a quadrature
                    // tend to be low. The field's angle is wanted in radians, not in cm.
                    quadrature: [weight * (1.0 / 0.6), weight * 0.1],
                };
                let step = order_eight::step(&field, start, first, h, &weight);
                error = step.error;
                let [z, theta] = step.quadrature;
                (step.end, step.stage, from.z + z, from.theta + theta)
            }
        };
        let end = PointLanes::new(motion, [from.tau + h, z, theta], stage.jet, stage.force);
        self.to.arrive(&from, &end, p_z, error, self.gauges);
    }
}
