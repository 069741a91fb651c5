//! Four rays in virtual space, in memory and in the processor.

use num_complex::Complex64;
use pulp::Simd;

use crate::lanes::{ComplexLanes, Complexes, LANES, Lanes};
use crate::propagation::nystrom::Motion;
use crate::transformation::{JetLanes, MapJet};

/// Where a ray is, with the map there; of real and of complex numbers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RayPoint<R, C> {
    /// Optical path since the start over c².
    pub tau: R,
    /// Virtual position.
    pub zeta: C,
    /// P = dζ/dτ.
    pub momentum: C,
    /// Position along z.
    pub z: R,
    /// Angle about the ray by which the field has turned against the frame of the module `frame`.
    pub theta: R,
    /// The map at ζ.
    pub jet: MapJet<C>,
    /// dP/dτ.
    pub force: C,
    /// d(x + iy)/dτ.
    pub velocity: C,
    /// d²(x + iy)/dτ².
    pub bend: C,
}

/// Where one ray is.
pub(super) type Point = RayPoint<f64, Complex64>;

/// Where four rays are, in memory.
pub(super) type Points = RayPoint<[f64; LANES], Complexes>;

/// Where four rays are, in the processor.
pub(super) type PointLanes<S> = RayPoint<Lanes<S>, ComplexLanes<S>>;

impl<R, C> RayPoint<R, C> {
    /// The same of other numbers.
    #[inline(always)]
    fn map<Q, D>(&self, real: impl Fn(&R) -> Q, complex: impl Fn(&C) -> D) -> RayPoint<Q, D> {
        let MapJet { f, f1, f2 } = &self.jet;
        RayPoint {
            tau: real(&self.tau),
            zeta: complex(&self.zeta),
            momentum: complex(&self.momentum),
            z: real(&self.z),
            theta: real(&self.theta),
            jet: MapJet { f: complex(f), f1: complex(f1), f2: complex(f2) },
            force: complex(&self.force),
            velocity: complex(&self.velocity),
            bend: complex(&self.bend),
        }
    }
}

impl Points {
    /// One of them.
    pub fn at(&self, i: usize) -> Point {
        self.map(|numbers| numbers[i], |numbers| numbers.at(i))
    }

    /// Moves one of them to where it is in `other`.
    pub fn take(&mut self, i: usize, other: &Self) {
        self.tau[i] = other.tau[i];
        self.z[i] = other.z[i];
        self.theta[i] = other.theta[i];
        self.zeta.put(i, other.zeta.at(i));
        self.momentum.put(i, other.momentum.at(i));
        self.jet.f.put(i, other.jet.f.at(i));
        self.jet.f1.put(i, other.jet.f1.at(i));
        self.jet.f2.put(i, other.jet.f2.at(i));
        self.force.put(i, other.force.at(i));
        self.velocity.put(i, other.velocity.at(i));
        self.bend.put(i, other.bend.at(i));
    }

    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S) -> PointLanes<S> {
        self.map(|numbers| Lanes::new(simd, *numbers), |numbers| numbers.load(simd))
    }
}

impl<S: Simd> PointLanes<S> {
    /// Where rays are that have moved so, the map and the force there being known.
    #[inline(always)]
    pub fn new(
        motion: Motion<S>,
        [tau, z, theta]: [Lanes<S>; 3],
        jet: JetLanes<S>,
        force: ComplexLanes<S>,
    ) -> Self {
        let (zeta, momentum) = (motion.position, motion.velocity);
        let velocity = jet.f1 * momentum;
        let bend = (jet.f2 * momentum * momentum).plus(jet.f1, force);
        Self { tau, zeta, momentum, z, theta, jet, force, velocity, bend }
    }

    #[inline(always)]
    pub fn store(&self) -> Points {
        self.map(|lanes| lanes.values(), |lanes| Complexes::of(*lanes))
    }

    /// d²z/dτ².
    #[inline(always)]
    pub fn axial_bend(&self, p_z: Lanes<S>) -> Lanes<S> {
        (self.jet.f1.conj() * self.jet.f2 * self.momentum).re * p_z * 2.0
    }
}
