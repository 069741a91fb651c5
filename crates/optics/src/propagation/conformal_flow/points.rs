//! Four rays in virtual space, in memory and in the processor.

use num_complex::Complex64;
use pulp::Simd;

use crate::lanes::{ComplexLanes, Complexes, LANES, Lanes};
use crate::propagation::nystrom::Motion;
use crate::transformation::{JetLanes, MapJet};

/// Where a ray is, with the map there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Optical path since the start over c².
    pub tau: f64,
    /// Virtual position.
    pub zeta: Complex64,
    /// P = dζ/dτ.
    pub momentum: Complex64,
    /// Position along z.
    pub z: f64,
    /// Angle about the ray by which the field has turned against the frame of
    /// [`Frame`](super::frame::Frame).
    pub theta: f64,
    /// The map at ζ.
    pub jet: MapJet,
    /// dP/dτ.
    pub force: Complex64,
    /// d(x + iy)/dτ.
    pub velocity: Complex64,
    /// d²(x + iy)/dτ².
    pub bend: Complex64,
}

/// Where four rays are: see [`Point`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Points {
    pub tau: [f64; LANES],
    pub zeta: Complexes,
    pub momentum: Complexes,
    pub z: [f64; LANES],
    pub theta: [f64; LANES],
    pub f: Complexes,
    pub f1: Complexes,
    pub f2: Complexes,
    pub force: Complexes,
    pub velocity: Complexes,
    pub bend: Complexes,
}

impl Points {
    /// One of them.
    pub fn at(&self, i: usize) -> Point {
        Point {
            tau: self.tau[i],
            zeta: self.zeta.at(i),
            momentum: self.momentum.at(i),
            z: self.z[i],
            theta: self.theta[i],
            jet: MapJet { f: self.f.at(i), f1: self.f1.at(i), f2: self.f2.at(i) },
            force: self.force.at(i),
            velocity: self.velocity.at(i),
            bend: self.bend.at(i),
        }
    }

    /// Moves one of them to where it is in `other`.
    pub fn take(&mut self, i: usize, other: &Self) {
        self.tau[i] = other.tau[i];
        self.z[i] = other.z[i];
        self.theta[i] = other.theta[i];
        self.zeta.put(i, other.zeta.at(i));
        self.momentum.put(i, other.momentum.at(i));
        self.f.put(i, other.f.at(i));
        self.f1.put(i, other.f1.at(i));
        self.f2.put(i, other.f2.at(i));
        self.force.put(i, other.force.at(i));
        self.velocity.put(i, other.velocity.at(i));
        self.bend.put(i, other.bend.at(i));
    }

    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S) -> PointLanes<S> {
        PointLanes {
            tau: Lanes::new(simd, self.tau),
            zeta: self.zeta.load(simd),
            momentum: self.momentum.load(simd),
            z: Lanes::new(simd, self.z),
            theta: Lanes::new(simd, self.theta),
            jet: JetLanes { f: self.f.load(simd), f1: self.f1.load(simd), f2: self.f2.load(simd) },
            force: self.force.load(simd),
            velocity: self.velocity.load(simd),
            bend: self.bend.load(simd),
        }
    }

    #[inline(always)]
    pub fn store<S: Simd>(&mut self, lanes: &PointLanes<S>) {
        self.tau = lanes.tau.values();
        self.zeta.store(lanes.zeta);
        self.momentum.store(lanes.momentum);
        self.z = lanes.z.values();
        self.theta = lanes.theta.values();
        self.f.store(lanes.jet.f);
        self.f1.store(lanes.jet.f1);
        self.f2.store(lanes.jet.f2);
        self.force.store(lanes.force);
        self.velocity.store(lanes.velocity);
        self.bend.store(lanes.bend);
    }
}

/// Where four rays are: see [`Point`].
#[derive(Clone, Copy, Debug)]
pub(super) struct PointLanes<S: Simd> {
    pub tau: Lanes<S>,
    pub zeta: ComplexLanes<S>,
    pub momentum: ComplexLanes<S>,
    pub z: Lanes<S>,
    pub theta: Lanes<S>,
    pub jet: JetLanes<S>,
    pub force: ComplexLanes<S>,
    pub velocity: ComplexLanes<S>,
    pub bend: ComplexLanes<S>,
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

    /// d²z/dτ².
    #[inline(always)]
    pub fn axial_bend(&self, p_z: Lanes<S>) -> Lanes<S> {
        (self.jet.f1.conj() * self.jet.f2 * self.momentum).re * p_z * 2.0
    }
}
