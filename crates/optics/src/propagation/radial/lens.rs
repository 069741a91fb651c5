//! Balls of graded index with closed-form transfers: Eaton's family, Luneburg's lens and Maxwell's
//! fish-eye.

use super::{Border, PathPoint, RadialEnd, plane_normal, turn_in_plane};
use crate::medium::Medium;
use glam::{DMat3, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// A ball of graded index n(r) that is 1 at its surface, so that light enters it unbent and without
/// reflection.
///
/// Central forces: a ray stays in its plane, n r sin(angle to the radius) is kept, and the
/// electric field turns with the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CentralLens {
    profile: Profile,
    radius: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Profile {
    /// Turns each ray by this angle, radians.
    Eaton(f64),
    Luneburg,
    Fisheye,
}

impl CentralLens {
    /// The ball of radius `radius` (cm) that turns every ray by `angle` radians towards its centre:
    /// π is the lens of Eaton (Trans. IRE Antennas Propag. 4, 66 (1952)), 2π the invisible sphere,
    /// π/2 the right-angle bender (Hannay & Haeusser, J. Mod. Opt. 40, 1437 (1993)). With m = π/angle and
    /// v = n^m, r/radius = 2 v^(1 - 1/m)/(1 + v²); the index is infinite at the centre.
    #[must_use]
    pub fn eaton(radius: f64, angle: f64) -> Self {
        debug_assert!(radius > 0.0 && angle >= 0.0);
        Self { profile: Profile::Eaton(angle), radius }
    }

    /// The lens of Luneburg, n² = 2 - (r/radius)²: parallel rays meet at a point of the far side.
    #[must_use]
    pub fn luneburg(radius: f64) -> Self {
        Self { profile: Profile::Luneburg, radius }
    }

    /// Maxwell's fish-eye, n = 2/(1 + (r/radius)²), cut where n = 1: a point of the surface is imaged
    /// to its antipode.
    #[must_use]
    pub fn fisheye(radius: f64) -> Self {
        Self { profile: Profile::Fisheye, radius }
    }

    /// Its radius, cm.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The index at a distance `r` (cm) from the centre, up to the radius.
    #[must_use]
    pub fn index(&self, r: f64) -> f64 {
        let x = r / self.radius;
        match self.profile {
            Profile::Eaton(angle) => eaton_index(angle / PI, x),
            Profile::Luneburg => (2.0 - x * x).sqrt(),
            Profile::Fisheye => 2.0 / (1.0 + x * x),
        }
    }

    /// The local medium.
    #[must_use]
    pub fn medium(&self, position: DVec3) -> Medium {
        let r = position.length();
        // On the surface it is that of air to the last bit.
        if (r - self.radius).abs() < 1e-9 * self.radius {
            Medium::AIR
        } else {
            // Eaton's family has a pole at the centre.
            Medium::dielectric(self.index(r.clamp(NEAREST * self.radius, self.radius)))
        }
    }

    /// The point at a share of the way that [`Self::advance`] takes.
    pub(super) fn way_point(&self, position: DVec3, wave_vector: DVec3, share: f64) -> PathPoint {
        let (x, d) = (position.normalize(), wave_vector.normalize());
        let normal = plane_normal(x, d);
        let cosine = x.dot(d);
        let (place, path) = match self.profile {
            Profile::Eaton(angle) => {
                let way = EatonWay::new(x, d, angle / PI, share);
                (x.rotate_axis(normal, way.swept) * eaton_radius(angle / PI, way.c), way.path)
            }
            Profile::Luneburg => {
                // An ellipse about the centre.
                let (sin, cos) = (FRAC_PI_2 * share).sin_cos();
                (x * cos + d * sin, FRAC_PI_2 * share - cosine * sin * sin)
            }
            Profile::Fisheye => {
                // The stereographic image of a great circle.
                let (sin, cos) = (PI * share).sin_cos();
                let across = x * cos + (d - x * cosine) * sin;
                (across / (1.0 - cosine * sin), PI * share)
            }
        };
        PathPoint { position: place * self.radius, optical_path: path * self.radius }
    }

    /// Follows a ray from a point of the surface to where it comes out.
    #[must_use]
    pub fn advance(&self, position: DVec3, wave_vector: DVec3) -> RadialEnd {
        let x = position.normalize();
        let d = wave_vector.normalize();
        let normal = plane_normal(x, d);
        // Half the chord, and S of the closed forms.
        let half = (-x.dot(d)).max(0.0);
        let (end, direction, path, transport) = match self.profile {
            Profile::Eaton(angle) => {
                let turn = DMat3::from_axis_angle(normal, angle);
                (turn * (x + d * (2.0 * half)), turn * d, 2.0 * half + angle, turn)
            }
            Profile::Luneburg => (d, -x, FRAC_PI_2 + half, turn_in_plane(normal, d, -x)),
            Profile::Fisheye => {
                let direction = x * (-2.0 * half) - d;
                (-x, direction, PI, turn_in_plane(normal, d, direction))
            }
        };
        let outward = end.normalize();
        let direction = direction.normalize();
        RadialEnd {
            border: Border::Outer,
            position: outward * self.radius,
            wave_vector: direction,
            direction,
            optical_path: path * self.radius,
            transport,
            outward,
        }
    }
}

/// A point of a way through a ball of Eaton's family, of radius 1.
pub(super) struct EatonWay {
    /// (v² - 1)/(v² + 1): 0 at the surface, 1 at the centre.
    pub c: f64,
    /// The polar angle swept, about the normal of [`plane_normal`].
    pub swept: f64,
    /// The optical path.
    pub path: f64,
}

impl EatonWay {
    /// The point at a share of the way of a ray from `x` along `d`, `turn` being 1/m. With L and S the sine and
    /// cosine of the angle to the radius, c = S sin ψ, ψ from 0 to the turning point at π/2.
    pub fn new(x: DVec3, d: DVec3, turn: f64, share: f64) -> Self {
        let (s, l) = ((-x.dot(d)).max(0.0), x.cross(d).length());
        let half = |psi: f64| {
            let (sin, cos) = psi.sin_cos();
            let swept = (l * sin).atan2(cos) * turn + s.atan2(l) - (s * cos).atan2(l);
            (turn * psi + s * (1.0 - cos), swept, s * sin)
        };
        let (path, swept, c) = half(FRAC_PI_2 * (1.0 - (2.0 * share - 1.0).abs()));
        if share <= 0.5 {
            return Self { c, swept, path };
        }
        let (most, around, _) = half(FRAC_PI_2);
        Self { c, swept: 2.0 * around - swept, path: 2.0 * most - path }
    }
}

/// r/R of Eaton's family at c, see [`EatonWay::c`]: 2 v^(1 - 1/m)/(1 + v²).
fn eaton_radius(turn: f64, c: f64) -> f64 {
    let v = ((1.0 + c) / (1.0 - c).max(f64::MIN_POSITIVE)).sqrt();
    (1.0 - c) * v.powf(1.0 - turn)
}

/// Closer to the centre than this share of the radius the local medium is that of here.
const NEAREST: f64 = 1e-6;

/// The index of Eaton's family at x = r/R, `turn` being 1/m. With v = e^w, n = e^(w/m) and
/// w/m + ln cosh w + ln x = 0.
fn eaton_index(turn: f64, x: f64) -> f64 {
    if x >= 1.0 {
        return 1.0;
    }
    let log = x.ln();
    // ln cosh w >= w - ln 2: from above, Newton's method on this convex function stays above.
    let mut w = (std::f64::consts::LN_2 - log) / (1.0 + turn);
    for _ in 0..60 {
        let log_cosh = w + (0.5 + 0.5 * (-2.0 * w).exp()).ln();
        let step = (turn * w + log_cosh + log) / (turn + w.tanh());
        w = (w - step).max(0.0);
        if step.abs() <= 1e-15 * (1.0 + w) {
            break;
        }
    }
    (turn * w).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_indices_come_out() {
        let eaton = CentralLens::eaton(2.0, PI);
        let invisible = CentralLens::eaton(2.0, 2.0 * PI);
        for step in 1..=40 {
            let r = 0.05 * f64::from(step);
            // The lens of Eaton: n² = 2/r - 1.
            assert!((eaton.index(r) / (4.0 / r - 1.0).sqrt() - 1.0).abs() < 1e-14, "{r}");
            // The invisible sphere (Minano 2006): n = (Q - 1/(3Q))², Q³ = 1/x + (1/x² + 1/27)^½.
            let x = r / 2.0;
            let q = (1.0 / x + (1.0 / (x * x) + 1.0 / 27.0).sqrt()).cbrt();
            let n = (q - 1.0 / (3.0 * q)).powi(2);
            assert!((invisible.index(r) / n - 1.0).abs() < 1e-13, "{r}: {n}");
        }
        assert_eq!(CentralLens::eaton(1.0, 0.0).index(0.3), 1.0);
    }
}
