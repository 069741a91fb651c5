//! Moves of four rays at once.

use pulp::{Simd, WithSimd};

use super::ConformalFlow;
use super::forces::{EvenForce, Force, PerturbedForce};
use super::points::{PointLanes, Points};
use crate::lanes::{ComplexLanes, LANES, Lanes, side_by_side};
use crate::propagation::nystrom::order_eight::ErrorWeight;
use crate::propagation::nystrom::{Motion, Stage, order_eight, order_four};
use crate::transformation::{LaneMap, of_each};

/// How a ray moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StepKind {
    /// Not at all: it is at its start, where the momentum is still conj(f') and the length of P
    /// short of P itself.
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

/// A momentum with its length made to fit |P|² = `square`, or 0 where that is negative.
#[inline(always)]
fn of_square<S: Simd>(momentum: ComplexLanes<S>, square: Lanes<S>) -> ComplexLanes<S> {
    let (zero, one) = (square.all(0.0), square.all(1.0));
    let square = zero.less_than(square).choose(square, zero);
    let present = momentum.norm_squared();
    let moving = zero.less_than(present);
    momentum * moving.choose(square, zero).divided_by(moving.choose(present, one)).sqrt()
}

/// A move of four rays by the lengths (of any sign).
pub(super) struct Move<'w> {
    pub flow: &'w ConformalFlow,
    pub rays: &'w Rays,
    pub kind: StepKind,
    pub from: &'w Points,
    pub length: &'w [f64; LANES],
    /// What comes of it.
    pub to: &'w mut StepResult,
}

impl Move<'_> {
    pub fn take(self) {
        // Which map it is is settled once for a step, not at every evaluation; portable code is one
        // for all maps.
        let map = &self.flow.map;
        let with_instructions =
            of_each!(map, map => side_by_side(Through(map, self)).map_err(|Through(_, this)| this));
        with_instructions.unwrap_or_else(|this| Through(map, this).with_simd(pulp::Scalar256b));
    }

    #[inline(always)]
    fn under<S: Simd, F: Force<S, Q>, const Q: usize>(self, simd: S, force: &F) {
        let from = self.from.load(simd);
        let (p_z, h) = (Lanes::new(simd, self.rays.p_z), Lanes::new(simd, *self.length));
        let start = Motion { position: from.zeta, velocity: from.momentum };
        let mut error = p_z.all(0.0);
        let ((motion, stage), growth) = match self.kind {
            StepKind::Departure => {
                let stage = force.look(from.zeta);
                let momentum = F::map(&stage.jet).f1.conj() * from.momentum;
                let velocity = of_square(momentum, force.momentum_squared(&stage.jet));
                // Added to a number, -0 leaves it as it is.
                ((Motion { velocity, ..start }, stage), [p_z.all(-0.0); Q])
            }
            StepKind::Coast => {
                let (jet, half) = (force.found(from.jet), h * 0.5);
                let mut growth = force.rates(&jet, from.momentum);
                growth[0] = growth[0] + from.axial_bend(p_z) * half;
                force.bend_path(&from, &jet, half, &mut growth);
                for growth in &mut growth {
                    *growth = *growth * h;
                }
                let position = from.zeta.plus_real(from.momentum.plus_real(from.force, half), h);
                let velocity = from.momentum.plus_real(from.force, h);
                ((Motion { position, velocity }, force.look(position)), growth)
            }
            StepKind::Short => {
                let first = Stage { force: from.force, jet: force.found(from.jet) };
                let step = order_four::step(force, start, first, h);
                // By the values and slopes at both ends, which are at hand.
                let z0 = force.rates(&first.jet, from.momentum)[0];
                let z1 = force.rates(&step.stage.jet, step.end.velocity)[0];
                let jet = F::map(&step.stage.jet);
                let end = PointLanes { jet, momentum: step.end.velocity, ..from };
                let slopes = from.axial_bend(p_z) - end.axial_bend(p_z);
                let mut growth = step.quadrature;
                growth[0] = ((z0 + z1) * 0.5 + slopes * h * (1.0 / 12.0)) * h;
                ((step.end, step.stage), growth)
            }
            StepKind::Full => {
                let weight = Lanes::new(simd, self.rays.weight);
                // z is all there is to control for rays nearly across it, and estimates of a
                // quadrature tend to be low; so for the optical path. The field's angle is wanted
                // in radians, not in cm.
                let mut quadrature = [weight * (1.0 / 0.6); Q];
                quadrature[1] = weight * 0.1;
                let velocity = weight * self.rays.lever;
                let weight = ErrorWeight { position: weight, velocity, quadrature };
                let first = Stage { force: from.force, jet: force.found(from.jet) };
                let (step, estimate) = order_eight::step(force, start, first, h, &weight);
                error = estimate;
                ((step.end, step.stage), step.quadrature)
            }
        };
        // Where the index is that of the map, the optical path grows with τ.
        let path = if Q > 2 { growth[Q - 1] } else { h };
        let along = [from.tau + path, from.z + growth[0], from.theta + growth[1]];
        let end = PointLanes::new(motion, along, F::map(&stage.jet), stage.force);
        self.to.end = end.store();
        self.to.error = error.values();
        self.to.factor = order_eight::step_factor(error).values();
        let [ahead, crossed] = self.flow.events.outlook(&from, &end, p_z);
        (self.to.ahead, self.to.crossed) = (ahead.values(), crossed.values());
    }
}

/// A move through the medium of a map.
struct Through<'w, M>(&'w M, Move<'w>);

impl<M: LaneMap> WithSimd for Through<'_, M> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(map, step) = self;
        let p_z = Lanes::new(simd, step.rays.p_z);
        let even = EvenForce { map, p_z, index_scale: Lanes::splat(simd, step.flow.index_scale) };
        match &step.flow.index_perturbation {
            None => step.under(simd, &even),
            Some(index_perturbation) => {
                step.under(simd, &PerturbedForce { even, index_perturbation })
            }
        }
    }
}
