//! Steps of four rays at once.

use std::array;

use num_complex::Complex64;
use pulp::{Simd, WithSimd};

use super::course::{Course, Point};
use crate::lanes::{ComplexLanes, LANES, Lanes, side_by_side};
use crate::propagation::nystrom::{self, ErrorWeight, Field, Motion, Stage};
use crate::transformation::{ConformalMap, JetLanes, LaneMap, MapJet};

/// A step that a ray wants to take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wish<'w> {
    pub course: &'w Course,
    pub from: &'w Point,
    /// Of any sign.
    pub length: f64,
}

/// A step that may be taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    pub end: Point,
    /// Estimated error over the allowed one.
    pub error: f64,
}

/// Steps of up to four rays; in the places of those that want none there is anything. None if none does.
pub(super) fn strides(
    map: &ConformalMap,
    wishes: [Option<Wish<'_>>; LANES],
) -> Option<[Trial; LANES]> {
    let any = *wishes.iter().flatten().next()?;
    let wishes = wishes.map(|wish| wish.unwrap_or(any));
    // Which map it is is settled once for a step, not at every evaluation.
    Some(match map {
        ConformalMap::Gaussian(map) => side_by_side(Strides { map, wishes }),
        ConformalMap::Grating(map) => side_by_side(Strides { map, wishes }),
        ConformalMap::QuasiConformal(map) => side_by_side(Strides { map, wishes }),
    })
}

struct Strides<'w, M> {
    map: &'w M,
    wishes: [Wish<'w>; LANES],
}

/// The force on rays in virtual space.
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

    /// dz/dτ and dθ/dτ: see [`Course::coasted`].
    #[inline(always)]
    fn rates(&self, jet: &JetLanes<S>, momentum: ComplexLanes<S>) -> [Lanes<S>; 2] {
        let square = jet.f1.norm_squared();
        let stretch = square.sqrt();
        let turn = (momentum * (jet.f2 * jet.f1.conj())).im;
        let slowness = stretch * (self.strength + self.p_z.abs() * stretch);
        [self.p_z * square, (-self.p_z * turn).divided_by(slowness)]
    }
}

impl<M: LaneMap> WithSimd for Strides<'_, M> {
    type Output = [Trial; LANES];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let real = |value: fn(&Wish<'_>) -> f64| self.wishes.each_ref().map(value);
        let complex = |value: fn(&Point) -> Complex64| self.wishes.map(|wish| value(wish.from));
        let p_z = Lanes::new(simd, real(|w| w.course.p_z));
        let field =
            Force { map: self.map, p_z, strength: Lanes::new(simd, real(|w| w.course.strength)) };
        let one = Lanes::splat(simd, 1.0);
        let weight = one.divided_by(Lanes::new(simd, real(|w| w.course.allowed)));
        let weight = ErrorWeight {
            position: weight,
            velocity: weight * Lanes::new(simd, real(|w| w.course.lever)),
            // z is all there is to control for rays nearly across it, and estimates of a quadrature tend to
            // be low. The field's angle is wanted in radians, not in cm.
            quadrature: [weight * (1.0 / 0.6), weight * 0.1],
        };
        let start = Motion {
            position: ComplexLanes::new(simd, complex(|p| p.zeta)),
            velocity: ComplexLanes::new(simd, complex(|p| p.momentum)),
        };
        let jet = JetLanes {
            f: ComplexLanes::new(simd, complex(|p| p.jet.f)),
            f1: ComplexLanes::new(simd, complex(|p| p.jet.f1)),
            f2: ComplexLanes::new(simd, complex(|p| p.jet.f2)),
        };
        let first = Stage { force: ComplexLanes::new(simd, complex(|p| p.force)), jet };
        let length = Lanes::new(simd, real(|w| w.length));
        let step = nystrom::step(&field, start, first, length, &weight);

        let (zeta, momentum) = (step.end.position.values(), step.end.velocity.values());
        let force = step.stage.force.values();
        let jet = step.stage.jet;
        let velocity = jet.f1 * step.end.velocity;
        let bend = jet.f2 * step.end.velocity * step.end.velocity + jet.f1 * step.stage.force;
        let (f, f1, f2) = (jet.f.values(), jet.f1.values(), jet.f2.values());
        let (velocity, bend) = (velocity.values(), bend.values());
        let (z, theta) = (step.quadrature[0].values(), step.quadrature[1].values());
        let error = step.error.values();
        array::from_fn(|i| {
            let Wish { from, length, .. } = self.wishes[i];
            let end = Point {
                tau: from.tau + length,
                zeta: zeta[i],
                momentum: momentum[i],
                z: from.z + z[i],
                theta: from.theta + theta[i],
                jet: MapJet { f: f[i], f1: f1[i], f2: f2[i] },
                force: force[i],
                velocity: velocity[i],
                bend: bend[i],
            };
            Trial { end, error: error[i] }
        })
    }
}
