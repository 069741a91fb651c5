//! One ray in virtual space: its equations of motion and the ways to move along it.

use glam::DMat3;
use num_complex::Complex64;

use super::frame::{Frame, transport};
use crate::propagation::nystrom::{self, ErrorScale, Motion, Stage};
use crate::transformation::{ConformalMap, MapJet};

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

/// A step that may be taken.
pub(super) struct Trial {
    pub end: Point,
    /// Estimated error over the allowed one.
    pub error: f64,
    pub evaluations: u32,
}

/// A ray's constants, and how accurately to follow it. `jet` is that of the map: which map it is was settled
/// before the first step, and the compiler sees through it.
pub(super) struct Course<'a, J> {
    map: &'a ConformalMap,
    jet: J,
    p_z: f64,
    strength: f64,
    scale: f64,
    allowed: ErrorScale<2>,
    longest: f64,
    nudge_reach: f64,
}

impl<'a, J: Fn(Complex64) -> MapJet> Course<'a, J> {
    /// `lever` is the length over which errors of direction grow into errors of position.
    pub fn new(
        map: &'a ConformalMap,
        jet: J,
        p_z: f64,
        strength: f64,
        tolerance: f64,
        lever: f64,
    ) -> Self {
        // Steep rays take long ways, on which errors have time to grow.
        let flatness = (1.0 - (p_z / strength).powi(2)).max(0.05);
        let local = flatness.powi(3) * tolerance.max(1e-12);
        let scale = map.scale();
        // What is estimated is the error of the embedded formula, which on a smooth map is much larger.
        let estimated = map.smoothness() * local;
        let allowed = ErrorScale {
            position: estimated,
            velocity: estimated / lever,
            // z is all there is to control for rays nearly across it, and estimates of a quadrature tend to
            // be low. The field's angle is wanted in radians, not in cm.
            quadrature: [0.6 * estimated, 10.0 * estimated],
        };
        // The error of `nudge` grows with the fifth power of its length; the fourth root is quicker.
        let nudge_reach = scale * 0.04 * (tolerance.max(1e-12) / 1e-6).sqrt().sqrt();
        // Where the estimate is low by chance, the order of the method still keeps a shorter step right.
        let longest = 1.5 * scale * (tolerance.max(1e-12) / 1e-6).min(1.0).sqrt().sqrt().sqrt();
        Self { map, jet, p_z, strength, scale, allowed, longest, nudge_reach }
    }

    pub fn p_z(&self) -> f64 {
        self.p_z
    }

    /// The length over which the map varies.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The start of the path, `p` the transverse wave vector.
    pub fn start(&self, zeta: Complex64, p: Complex64, z: f64) -> Point {
        let jet = (self.jet)(zeta);
        let momentum = self.on_shell(jet.f1.conj() * p, &jet);
        self.point_with(jet, 0.0, zeta, momentum, z, 0.0)
    }

    /// `momentum` with its length made to fit |P|² = c² - p_z² |f'|².
    pub fn on_shell(&self, momentum: Complex64, jet: &MapJet) -> Complex64 {
        let axial = self.p_z * self.p_z * jet.f1.norm_sqr();
        let square = (self.strength * self.strength - axial).max(0.0);
        let present = momentum.norm_sqr();
        if present > 0.0 { momentum * (square / present).sqrt() } else { momentum }
    }

    pub fn first_stride(&self) -> f64 {
        0.8 * self.longest
    }

    /// The longest step whose ends tell what happens in between.
    pub fn longest_stride(&self, here: &Point) -> f64 {
        self.map.longest_stride(here.zeta, self.longest) / self.strength
    }

    /// A step meant to end a little beyond the border, which is `time` away by extrapolation.
    pub fn overshoot(&self, time: f64) -> f64 {
        time + 0.3 * self.nudge_reach
    }

    pub fn step_factor(&self, error: f64) -> f64 {
        nystrom::step_factor(error)
    }

    fn is_straight(&self) -> bool {
        self.p_z == 0.0
    }

    /// One step of length `h`, of any sign.
    pub fn step(&self, from: &Point, h: f64) -> Trial {
        if self.is_straight() {
            return Trial { end: self.coast(from, h), error: 0.0, evaluations: 1 };
        }
        let step = nystrom::step(
            Motion { position: from.zeta, velocity: from.momentum },
            Stage { force: from.force, jet: from.jet },
            h,
            &self.allowed,
            |zeta| {
                let jet = (self.jet)(zeta);
                Stage { force: self.force(&jet), jet }
            },
            |jet, momentum| self.rates(jet, momentum),
        );
        let [z, theta] = step.quadrature;
        let Motion { position, velocity } = step.end;
        let end = self.point_with(
            step.stage.jet,
            from.tau + h,
            position,
            velocity,
            from.z + z,
            from.theta + theta,
        );
        Trial { end, error: step.error, evaluations: nystrom::EVALUATIONS }
    }

    /// A move by `h` with the cheapest method that is accurate enough for its length, and the number of
    /// evaluations.
    pub fn shift(&self, from: &Point, h: f64) -> (Point, u32) {
        if self.is_straight() || h.abs() <= 1e-4 * self.scale {
            (self.coast(from, h), 1)
        } else if h.abs() <= self.nudge_reach {
            (self.nudge(from, h), 3)
        } else {
            let trial = self.step(from, h);
            (trial.end, trial.evaluations)
        }
    }

    /// Taylor's formula of order two; exact for straight rays.
    fn coast(&self, from: &Point, h: f64) -> Point {
        if self.is_straight() {
            let zeta = from.zeta + h * from.momentum;
            return self.point(from.tau + h, zeta, from.momentum, from.z, from.theta);
        }
        let [z_rate, theta_rate] = self.rates(&from.jet, from.momentum);
        let gradient = 2.0 * self.p_z * (from.jet.f1.conj() * from.jet.f2 * from.momentum).re;
        self.point(
            from.tau + h,
            from.zeta + h * (from.momentum + 0.5 * h * from.force),
            from.momentum + h * from.force,
            from.z + h * (z_rate + 0.5 * h * gradient),
            from.theta + h * theta_rate,
        )
    }

    /// Nyström's method of order 4 (Hairer, Nørsett & Wanner, section II.14).
    fn nudge(&self, from: &Point, h: f64) -> Point {
        let first = self.rates(&from.jet, from.momentum);
        let zeta = from.zeta + 0.5 * h * (from.momentum + 0.25 * h * from.force);
        let jet = (self.jet)(zeta);
        let middle_force = self.force(&jet);
        let second = self.rates(&jet, from.momentum + 0.5 * h * from.force);
        let zeta = from.zeta + h * (from.momentum + 0.5 * h * middle_force);
        let jet = (self.jet)(zeta);
        let last_force = self.force(&jet);
        let third = self.rates(&jet, from.momentum + h * middle_force);
        let simpson = |k: usize| h / 6.0 * (first[k] + 4.0 * second[k] + third[k]);
        self.point(
            from.tau + h,
            from.zeta + h * (from.momentum + h / 6.0 * (from.force + 2.0 * middle_force)),
            from.momentum + h / 6.0 * (from.force + 4.0 * middle_force + last_force),
            from.z + simpson(0),
            from.theta + simpson(1),
        )
    }

    fn point(&self, tau: f64, zeta: Complex64, momentum: Complex64, z: f64, theta: f64) -> Point {
        self.point_with((self.jet)(zeta), tau, zeta, momentum, z, theta)
    }

    fn point_with(
        &self,
        jet: MapJet,
        tau: f64,
        zeta: Complex64,
        momentum: Complex64,
        z: f64,
        theta: f64,
    ) -> Point {
        let force = self.force(&jet);
        let velocity = jet.f1 * momentum;
        let bend = jet.f2 * momentum * momentum + jet.f1 * force;
        Point { tau, zeta, momentum, z, theta, jet, force, velocity, bend }
    }

    #[inline]
    fn force(&self, jet: &MapJet) -> Complex64 {
        -(self.p_z * self.p_z) * (jet.f1 * jet.f2.conj())
    }

    /// dz/dτ and dθ/dτ.
    #[inline]
    fn rates(&self, jet: &MapJet, momentum: Complex64) -> [f64; 2] {
        let square = jet.f1.norm_sqr();
        let stretch = square.sqrt();
        // With σ = p_z |f'|/c the sine of the ray's angle to the virtual plane,
        // dθ/dτ = -σ/(1 + |σ|) Im(P f''/f').
        let turn = (momentum * jet.f2 * jet.f1.conj()).im;
        let rate = -self.p_z * turn / (stretch * (self.strength + self.p_z.abs() * stretch));
        [self.p_z * square, rate]
    }

    /// The rotation of the transverse field between two points of the path.
    pub fn transport(&self, start: &Point, end: &Point) -> DMat3 {
        let frame = |point: &Point| Frame::new(point.momentum, self.p_z, &point.jet);
        transport(&frame(start), &frame(end), end.theta - start.theta)
    }
}
