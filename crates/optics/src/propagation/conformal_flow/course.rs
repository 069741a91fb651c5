//! One ray in virtual space: its equations of motion.

use glam::DMat3;
use num_complex::Complex64;

use super::frame::{Frame, transport};
use crate::transformation::MapJet;

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
    /// Angle about the ray by which the field has turned against the frame of [`Frame`].
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

/// A ray's constants, and how accurately to follow it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    /// The wave vector along z.
    pub p_z: f64,
    /// c of the index c/|f'|.
    pub strength: f64,
    /// The length over which the map varies.
    pub scale: f64,
    /// The error that the estimate of a step may show, cm.
    pub allowed: f64,
    /// The length over which errors of direction grow into errors of position.
    pub lever: f64,
    /// The longest step where the map varies most.
    pub longest: f64,
    /// Whether it is the longest anywhere.
    pub even: bool,
}

/// How a map is followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Demands {
    /// The largest error at the end, cm.
    pub tolerance: f64,
    /// By how much the estimates of a step's error exceed the error.
    pub smoothness: f64,
    /// See [`Course::scale`].
    pub scale: f64,
    /// See [`Course::lever`].
    pub lever: f64,
}

/// Moves below this share of the map's scale are exact to rounding by Taylor's formula of order two.
const COASTING: f64 = 1e-4;

impl Course {
    pub fn new(p_z: f64, strength: f64, demands: &Demands) -> Self {
        let tolerance = demands.tolerance.max(1e-12);
        // Steep rays take long ways, on which errors have time to grow.
        let flatness = (1.0 - (p_z / strength).powi(2)).max(0.05);
        let allowed = demands.smoothness * flatness.powi(3) * tolerance;
        // Where the estimate is low by chance, the order of the method still keeps a shorter step right.
        let longest = 1.5 * demands.scale * (tolerance / 1e-6).min(1.0).sqrt().sqrt().sqrt();
        let Demands { scale, lever, .. } = *demands;
        Self { p_z, strength, scale, allowed, lever, longest, even: false }
    }

    /// The start of the path, `p` the transverse wave vector.
    pub fn start(&self, jet: MapJet, zeta: Complex64, p: Complex64, z: f64) -> Point {
        let momentum = self.on_shell(jet.f1.conj() * p, &jet);
        let base = Point {
            tau: 0.0,
            zeta,
            momentum,
            z,
            theta: 0.0,
            jet,
            force: Complex64::ZERO,
            velocity: Complex64::ZERO,
            bend: Complex64::ZERO,
        };
        self.with_rates(base)
    }

    /// `momentum` with its length made to fit |P|² = c² - p_z² |f'|².
    pub fn on_shell(&self, momentum: Complex64, jet: &MapJet) -> Complex64 {
        let axial = self.p_z * self.p_z * jet.f1.norm_sqr();
        let square = (self.strength * self.strength - axial).max(0.0);
        let present = momentum.norm_sqr();
        if present > 0.0 { momentum * (square / present).sqrt() } else { momentum }
    }

    /// Whether Taylor's formula does for a move of length `h`.
    pub fn may_coast(&self, h: f64) -> bool {
        self.p_z == 0.0 || h.abs() <= COASTING * self.scale
    }

    /// Taylor's formula of order two, but for the map at the new place; exact for straight rays.
    pub fn coasted(&self, from: &Point, h: f64) -> Point {
        let (tau, jet) = (from.tau + h, from.jet);
        if self.p_z == 0.0 {
            return Point { tau, zeta: from.zeta + h * from.momentum, ..*from };
        }
        let square = jet.f1.norm_sqr();
        let stretch = square.sqrt();
        // With σ = p_z |f'|/c the sine of the ray's angle to the virtual plane,
        // dθ/dτ = -σ/(1 + |σ|) Im(P f''/f').
        let turn = (from.momentum * jet.f2 * jet.f1.conj()).im;
        let theta_rate = -self.p_z * turn / (stretch * (self.strength + self.p_z.abs() * stretch));
        let gradient = 2.0 * self.p_z * (jet.f1.conj() * jet.f2 * from.momentum).re;
        Point {
            tau,
            zeta: from.zeta + h * (from.momentum + 0.5 * h * from.force),
            momentum: from.momentum + h * from.force,
            z: from.z + h * (self.p_z * square + 0.5 * h * gradient),
            theta: from.theta + h * theta_rate,
            ..*from
        }
    }

    /// A point with the rates that follow from the map there.
    pub fn with_rates(&self, point: Point) -> Point {
        let Point { momentum, jet, .. } = point;
        let force = -(self.p_z * self.p_z) * (jet.f1 * jet.f2.conj());
        let velocity = jet.f1 * momentum;
        let bend = jet.f2 * momentum * momentum + jet.f1 * force;
        Point { force, velocity, bend, ..point }
    }

    /// The rotation of the transverse field between two points of the path.
    pub fn transport(&self, start: &Point, end: &Point) -> DMat3 {
        let frame = |point: &Point| Frame::new(point.momentum, self.p_z, &point.jet);
        transport(&frame(start), &frame(end), end.theta - start.theta)
    }
}
