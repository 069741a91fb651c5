//! A slow integration of the paper's own equation of motion in physical space through the index of
//! a conformal map, with Snell's law at the border and the law of reflection at the metal: nothing
//! of it knows virtual space, the program's interfaces or its surfaces.

use errorfunctions::ComplexErrorFunctions;
use glam::DVec3;
use num_complex::Complex64;
use optics::propagation::reference::{ReferenceRay, SquaredIndex, follow};
use std::cell::Cell;
use std::f64::consts::PI;

/// f, f' and f'' of a map.
pub type Jet = Box<dyn Fn(Complex64) -> [Complex64; 3]>;

/// The space above the floor of a map, filled with the index c/|f'|, |x| <= half_width and y <=
/// height.
pub struct GradedHalf {
    /// The map.
    pub jet: Jet,
    /// c.
    pub index_scale: f64,
    /// Half its size along x, cm.
    pub half_width: f64,
    /// Its size along y from the floor's level, cm.
    pub height: f64,
    /// The step of the coarser of two integrations, cm.
    pub step: f64,
    /// The index around it.
    pub outside: f64,
    nearby: Cell<Complex64>,
}

/// Where and how a ray leaves.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    pub position: DVec3,
    pub direction: DVec3,
    /// From where the ray was given, cm.
    pub optical_path: f64,
    /// Whether it has met the metal.
    pub mirrored: bool,
    /// Power that the last border lets through, for either polarization across it.
    pub transmitted: [f64; 2],
}

/// The map of the Gaussian carpet, from an independent Faddeeva function.
pub fn gaussian(w: f64, h: f64) -> Jet {
    let i = Complex64::I;
    Box::new(move |zeta: Complex64| {
        let t = zeta / w;
        let w0 = t.w();
        let w1 = -2.0 * t * w0 + 2.0 * i / PI.sqrt();
        let w2 = -2.0 * w0 - 2.0 * t * w1;
        [zeta + i * h * w0, 1.0 + i * h / w * w1, i * h / (w * w) * w2]
    })
}

impl GradedHalf {
    /// The medium of a map cut at half a width and a height, followed in steps of a length.
    pub fn new(jet: Jet, index_scale: f64, [half_width, height]: [f64; 2], step: f64) -> Self {
        let nearby = Cell::new(Complex64::I * height);
        Self { jet, index_scale, half_width, height, step, outside: 1.0, nearby }
    }

    /// The virtual point of a physical one by Newton's method, from the last one found.
    pub fn invert(&self, r: DVec3) -> Complex64 {
        let z = Complex64::new(r.x, r.y);
        let near = self.nearby.get();
        let far = ((self.jet)(near)[0] - z).norm() > 3.0;
        let mut zeta = if far { Complex64::new(z.re, z.im.max(0.5)) } else { near };
        for _ in 0..200 {
            let [f, f1, _] = (self.jet)(zeta);
            let step = (f - z) / f1;
            zeta -= step / (1.0 + 0.5 * step.norm());
            zeta.im = zeta.im.max(-0.3);
            if step.norm() < 1e-13 {
                break;
            }
        }
        self.nearby.set(zeta);
        zeta
    }

    /// n² = c²/|f'|² and its gradient.
    pub fn squared_index(&self, r: DVec3) -> SquaredIndex {
        let [_, f1, f2] = (self.jet)(self.invert(r));
        let value = self.index_scale.powi(2) / f1.norm_sqr();
        // The gradient of ln n in virtual space is -conj(f''/f'); one more conj(f') takes it to
        // physical space.
        let slope = -2.0 * value * (f2 / (f1 * f1)).conj();
        SquaredIndex { value, gradient: DVec3::new(slope.re, slope.im, 0.0) }
    }

    /// How far a point is inside.
    fn inside(&self, r: DVec3) -> f64 {
        (self.half_width - r.x.abs()).min(self.height - r.y).min(self.invert(r).im)
    }

    /// The normal of the floor at a point of it, out of the metal.
    pub fn floor_normal(&self, at: DVec3) -> DVec3 {
        let [_, f1, _] = (self.jet)(self.invert(at));
        DVec3::new(-f1.im, f1.re, 0.0).normalize()
    }

    /// Follows a ray of the medium with wave vector p until it leaves; None for rays that come too
    /// near to grazing incidence, to a critical angle, or to an edge.
    pub fn out(&self, mut at: DVec3, mut p: DVec3, mut optical_path: f64) -> Option<Expected> {
        let mut mirrored = false;
        for _ in 0..12 {
            let start = ReferenceRay {
                position: at,
                wave_vector: p,
                electric_field: p.any_orthonormal_vector(),
                optical_path: 0.0,
            };
            let run = |step: f64| {
                follow(start, step, 200_000, |r| self.squared_index(r), |r| self.inside(r))
            };
            let [coarse, fine] = [run(self.step)?, run(self.step / 2.0)?];
            // Richardson: the method is of order 4.
            let better = |coarse: DVec3, fine: DVec3| fine + (fine - coarse) / 15.0;
            at = better(coarse.position, fine.position);
            p = better(coarse.wave_vector, fine.wave_vector);
            optical_path += fine.optical_path + (fine.optical_path - coarse.optical_path) / 15.0;
            let [gap_x, gap_y] = [self.half_width - at.x.abs(), self.height - at.y];
            if gap_x.abs().min(gap_y.abs()) > 1e-6 {
                let up = self.floor_normal(at);
                if gap_x < 0.5 || p.normalize().dot(up).abs() < 5e-3 {
                    return None;
                }
                p -= 2.0 * p.dot(up) * up;
                mirrored = true;
                continue;
            }
            if gap_x + gap_y < 0.05 || at.y < 0.1 {
                return None;
            }
            let out = if gap_x < gap_y { DVec3::X * at.x.signum() } else { DVec3::Y };
            if p.normalize().dot(out) < 0.02 {
                return None;
            }
            let across = p - out * p.dot(out);
            let slack = self.outside.powi(2) - across.length_squared();
            if slack.abs() < 0.02 {
                return None;
            }
            if slack > 0.0 {
                let direction = (across + out * slack.sqrt()) / self.outside;
                let transmitted = fresnel(p.dot(out), slack.sqrt(), p.length(), self.outside);
                return Some(Expected {
                    position: at,
                    direction,
                    optical_path,
                    mirrored,
                    transmitted,
                });
            }
            p = across - out * p.dot(out);
        }
        None
    }
}

/// Snell's law into a medium of squared index `square`; None near grazing.
pub fn refract(p: DVec3, inward: DVec3, square: f64) -> Option<DVec3> {
    let across = p - inward * p.dot(inward);
    let normal = square - across.length_squared();
    (normal > 0.02 && p.dot(inward) > 0.02).then(|| across + inward * normal.sqrt())
}

/// The power that passes between two indices by Fresnel's equations, from the normal parts of the
/// wave vectors: for s and p.
pub fn fresnel(before: f64, beyond: f64, n_before: f64, n_beyond: f64) -> [f64; 2] {
    let s = (before - beyond) / (before + beyond);
    let (a, b) = (before / n_before.powi(2), beyond / n_beyond.powi(2));
    let p = (a - b) / (a + b);
    [1.0 - s * s, 1.0 - p * p]
}
