//! Steps of four rays at once where the index is ρ(x, y) c/|f'|.
//!
//! H = (|P|² + p_z² |f'|² - c² ρ²)/2, with the gradient g of ρ² in physical space as a complex number:
//!
//! dP/dτ = -p_z² f' conj(f'') + c² conj(f') g/2,  d(optical path)/dτ = c² ρ².
//!
//! The field turns about the ray as [`super::frame`] says, now with ∇ln n = -conj(f''/f') + γ, γ = conj(f') g/(2ρ²), in
//! virtual space. Besides the turn p_z |f'| z × ∇ln n about an axis across z, of the turn about z there remains Im(conj(P) γ), as
//! the map turns its frame by Im(P f''/f') alone. Against the frame bound to the ray, with σ = p_z |f'|/(c ρ),
//!
//! dθ/dτ = (sign(p_z) Im(conj(P) γ) - σ Im(P f''/f'))/(1 + |σ|).

use pulp::{Simd, WithSimd};

use super::ConformalFlow;
use super::crossing::Gauges;
use super::points::{PointLanes, Points};
use super::strides::{Rays, StepKind, StepResult, of_square};
use super::unevenness::{Factor, IndexPerturbation};
use crate::lanes::{ComplexLanes, LANES, Lanes, side_by_side};
use crate::propagation::nystrom::order_eight::ErrorWeight;
use crate::propagation::nystrom::{Field, Motion, Stage, order_eight};
use crate::transformation::{ConformalMap, JetLanes, LaneMap};

/// Moves four rays by the lengths (of any sign) into `to`: coasting, else by the method of order eight.
pub(super) fn uneven_stride(
    flow: &ConformalFlow,
    unevenness: &IndexPerturbation,
    rays: &Rays,
    pace: StepKind,
    from: &Points,
    length: &[f64; LANES],
    to: &mut StepResult,
) {
    let gauges = &flow.gauges;
    match flow.map() {
        ConformalMap::Gaussian(map) => {
            side_by_side(Strides { map, unevenness, gauges, rays, pace, from, length, to });
        }
        ConformalMap::Grating(map) => {
            side_by_side(Strides { map, unevenness, gauges, rays, pace, from, length, to });
        }
        ConformalMap::QuasiConformal(map) => {
            side_by_side(Strides { map, unevenness, gauges, rays, pace, from, length, to });
        }
        ConformalMap::Flat(map) => {
            side_by_side(Strides { map, unevenness, gauges, rays, pace, from, length, to });
        }
    }
}

struct Strides<'w, M> {
    map: &'w M,
    unevenness: &'w IndexPerturbation,
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
    unevenness: &'w IndexPerturbation,
    p_z: Lanes<S>,
    strength: Lanes<S>,
}

/// What is found at virtual points.
#[derive(Clone, Copy)]
struct Jet<S: Simd> {
    map: JetLanes<S>,
    /// ρ² and g.
    square: Lanes<S>,
    gradient: ComplexLanes<S>,
}

impl<S: Simd, M: LaneMap> Force<'_, S, M> {
    /// What is found where the map is known.
    #[inline(always)]
    fn jet(&self, map: JetLanes<S>) -> Jet<S> {
        let factors = map.f.values().map(|z| self.unevenness.look(z));
        let lanes = |value: fn(&Factor) -> f64| map.f.re.with(factors.each_ref().map(value));
        let gradient = ComplexLanes { re: lanes(|f| f.gradient.re), im: lanes(|f| f.gradient.im) };
        Jet { map, square: lanes(|f| f.square), gradient }
    }

    /// A momentum with its length made to fit |P|² = c² ρ² - p_z² |f'|².
    #[inline(always)]
    fn on_shell(&self, momentum: ComplexLanes<S>, jet: &Jet<S>) -> ComplexLanes<S> {
        let axial = self.p_z * self.p_z * jet.map.f1.norm_squared();
        of_square(momentum, self.strength * self.strength * jet.square - axial)
    }
}

impl<S: Simd, M: LaneMap> Field<S, 3> for Force<'_, S, M> {
    type Jet = Jet<S>;

    #[inline(always)]
    fn look(&self, zeta: ComplexLanes<S>) -> Stage<S, Jet<S>> {
        let jet = self.jet(self.map.jets(zeta));
        let JetLanes { f1, f2, .. } = jet.map;
        let uphill = f1.conj() * jet.gradient * (self.strength * self.strength * 0.5);
        Stage { force: f1 * f2.conj() * -(self.p_z * self.p_z) + uphill, jet }
    }

    /// dz/dτ, dθ/dτ and the growth of the optical path over c².
    #[inline(always)]
    fn rates(&self, jet: &Jet<S>, momentum: ComplexLanes<S>) -> [Lanes<S>; 3] {
        let JetLanes { f1, f2, .. } = jet.map;
        let square = f1.norm_squared();
        let stretch = square.sqrt();
        let turn = (momentum * (f2 * f1.conj())).im;
        let root = self.strength * jet.square.sqrt();
        let across = ((momentum * f1).conj() * jet.gradient).im;
        let about_z = (self.p_z.signs() * root * across).divided_by(jet.square * 2.0);
        let bent = about_z - (self.p_z * turn).divided_by(stretch);
        let theta = bent.divided_by(root + self.p_z.abs() * stretch);
        [self.p_z * square, theta, jet.square]
    }
}

impl<M: LaneMap> WithSimd for Strides<'_, M> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let p_z = Lanes::new(simd, self.rays.p_z);
        let strength = Lanes::splat(simd, self.rays.strength);
        let field = Force { map: self.map, unevenness: self.unevenness, p_z, strength };
        let from = self.from.load(simd);
        let h = Lanes::new(simd, *self.length);
        let start = Motion { position: from.zeta, velocity: from.momentum };
        let zero = p_z.all(0.0);
        let (motion, stage, [z, theta, path], error) = match self.pace {
            StepKind::Departure => {
                let stage = field.look(from.zeta);
                let velocity = stage.jet.map.f1.conj() * from.momentum;
                let velocity = field.on_shell(velocity, &stage.jet);
                (Motion { velocity, ..start }, stage, [zero; 3], zero)
            }
            StepKind::Coast => {
                let jet = field.jet(from.jet);
                let [z_rate, theta_rate, path_rate] = field.rates(&jet, from.momentum);
                let half = h * 0.5;
                let position = from.zeta.plus_real(from.momentum.plus_real(from.force, half), h);
                let velocity = from.momentum.plus_real(from.force, h);
                let path_bend = (from.velocity.conj() * jet.gradient).re;
                let growth = [
                    (z_rate + from.axial_bend(p_z) * half) * h,
                    theta_rate * h,
                    (path_rate + path_bend * half) * h,
                ];
                (Motion { position, velocity }, field.look(position), growth, zero)
            }
            StepKind::Short | StepKind::Full => {
                let weight = Lanes::new(simd, self.rays.weight);
                let weight = ErrorWeight {
                    position: weight,
                    velocity: weight * self.rays.lever,
                    // As in an even medium, and the optical path as the other lengths.
                    quadrature: [weight * (1.0 / 0.6), weight * 0.1, weight * (1.0 / 0.6)],
                };
                let first = Stage { force: from.force, jet: field.jet(from.jet) };
                let step = order_eight::step(&field, start, first, h, &weight);
                (step.end, step.stage, step.quadrature, step.error)
            }
        };
        let along = [from.tau + path, from.z + z, from.theta + theta];
        let end = PointLanes::new(motion, along, stage.jet.map, stage.force);
        self.to.arrive(&from, &end, p_z, error, self.gauges);
    }
}
