//! Balls of graded index with closed-form transfers: Eaton's family, Luneburg's lens and Maxwell's
//! fish-eye.

use super::{Border, PathEnd, PathPoint, first_way_out, plane_normal, turn_in_plane};
use crate::medium::Medium;
use glam::{DMat3, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// A ball of graded index n(r) that is 1 at its surface, so that light enters it unbent and without
/// reflection.
///
/// Central forces: a ray stays in its plane, n r sin(angle to the radius) is kept, and the
/// electric field turns with the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct CentralLens {
    profile: Profile,
    /// Its radius, cm.
    pub radius: f64,
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
    /// π/2 the right-angle bender (Hannay & Haeusser, J. Mod. Opt. 40, 1437 (1993)). With m =
    /// π/angle and v = n^m, r/radius = 2 v^(1 - 1/m)/(1 + v²); the index is infinite at the centre.
    pub fn eaton(radius: f64, angle: f64) -> Self {
        debug_assert!(radius > 0.0 && angle >= 0.0);
        Self { profile: Profile::Eaton(angle), radius }
    }

    /// The lens of Luneburg, n² = 2 - (r/radius)²: parallel rays meet at a point of the far side.
    pub fn luneburg(radius: f64) -> Self {
        Self { profile: Profile::Luneburg, radius }
    }

    /// Maxwell's fish-eye, n = 2/(1 + (r/radius)²), cut where n = 1: a point of the surface is
    /// imaged to its antipode.
    pub fn fisheye(radius: f64) -> Self {
        Self { profile: Profile::Fisheye, radius }
    }

    /// The index at a distance `r` (cm) from the centre, up to the radius.
    #[must_use]
    pub fn index(&self, r: f64) -> f64 {
        let x = r / self.radius;
        match self.profile {
            Profile::Eaton(angle) => (angle / PI * eaton_parameter(angle / PI, x)).exp(),
            Profile::Luneburg => (2.0 - x * x).sqrt(),
            Profile::Fisheye => 2.0 / (1.0 + x * x),
        }
    }

    /// The local medium.
    pub fn medium(&self, position: DVec3) -> Medium {
        let index = self.index_at(position);
        if index == 1.0 { Medium::AIR } else { Medium::dielectric(index) }
    }

    /// The index at a point inside or on the surface.
    pub(super) fn index_at(&self, position: DVec3) -> f64 {
        let r = position.length();
        // On the surface it is that of air to the last bit.
        if (r - self.radius).abs() < 1e-9 * self.radius {
            return 1.0;
        }
        // Eaton's family has a pole at the centre.
        self.index(r.clamp(NEAREST * self.radius, self.radius))
    }

    /// The point at a share of the way that [`Self::advance`] takes.
    pub(super) fn way_point(&self, position: DVec3, wave_vector: DVec3, share: f64) -> PathPoint {
        let way = self.way_to(position, wave_vector, share);
        PathPoint { position: way.position, optical_path: way.optical_path }
    }

    /// A share of the way to the surface, from there or from within.
    fn way_to(&self, position: DVec3, wave_vector: DVec3, share: f64) -> PathEnd<Border> {
        let (x, d) = (position / self.radius, wave_vector.normalize());
        let normal = plane_normal(x, d);
        let (at, onward, path) = match self.profile {
            Profile::Eaton(angle) => {
                let turn = angle / PI;
                let radial = x.try_normalize().unwrap_or(d);
                let c = eaton_parameter(turn, x.length().max(NEAREST)).tanh();
                // r n = √(1 - c²), of which these are the components across the radius and along
                // it.
                let size = (1.0 - c * c).sqrt();
                let (l, inward) = (size * radial.cross(d).length(), size * -radial.dot(d));
                let way = EatonWayOut::new(turn, c, l, inward);
                let here = way.at(share);
                let outward = radial.rotate_axis(normal, here.swept);
                let onward = outward * way.cosine() + normal.cross(outward) * l;
                (outward * eaton_radius(turn, here.c), onward, here.path)
            }
            Profile::Luneburg => {
                // r² = 1 + (x² - 1) cos 2σ + x·p sin 2σ
                let p = d * (2.0 - x.length_squared()).sqrt();
                let sigma = share * 0.5 * first_rise(x.length_squared() - 1.0, x.dot(p));
                let (sin, cos) = sigma.sin_cos();
                let inside = (1.0 - x.length_squared()) * cos - x.dot(p) * sin;
                (x * cos + p * sin, p * cos - x * sin, sigma + inside * sin)
            }
            Profile::Fisheye => {
                // On the sphere of which it is the stereographic projection: height 1 - shrunk,
                // climbing.
                let shrunk = 2.0 / (1.0 + x.length_squared());
                let climb = shrunk * x.dot(d);
                let (point, along) = (x * shrunk, d - x * climb);
                let angle = share * first_rise(1.0 - shrunk, climb);
                let (sin, cos) = angle.sin_cos();
                let below = 1.0 - (1.0 - shrunk) * cos - climb * sin;
                let at = (point * cos + along * sin) / below;
                (at, along * cos - point * sin + at * (climb * cos - (1.0 - shrunk) * sin), angle)
            }
        };
        let onward = onward.normalize();
        let index_at = |share: f64| self.index(share.clamp(NEAREST, 1.0) * self.radius);
        let index = index_at(at.length());
        // |Re(E × H*)| = n |E|².
        let kept = (index_at(x.length()) / index).sqrt();
        PathEnd {
            virtual_point: (),
            surface: Border::Outer,
            position: at * self.radius,
            wave_vector: onward * index,
            direction: onward,
            optical_path: path * self.radius,
            group_path: None,
            transport: turn_in_plane(normal, d, onward) * kept,
            outward: at.try_normalize().unwrap_or(onward),
        }
    }

    /// Follows a ray from a point of the ball or its surface to where it comes out.
    pub fn advance(&self, position: DVec3, wave_vector: DVec3) -> PathEnd<Border> {
        if position.length() < (1.0 - AT_SURFACE) * self.radius {
            let end = self.way_to(position, wave_vector, 1.0);
            // On the surface, where the index is 1, to the last bit.
            let position = end.outward * self.radius;
            return PathEnd { position, wave_vector: end.direction, ..end };
        }
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
        PathEnd {
            virtual_point: (),
            surface: Border::Outer,
            position: outward * self.radius,
            wave_vector: direction,
            direction,
            optical_path: path * self.radius,
            group_path: None,
            transport,
            outward,
        }
    }
}

/// Closer to the surface than this share of the radius a ray starts on it.
pub(super) const AT_SURFACE: f64 = 1e-9;

/// The first angle, from 0 to 2π, at which a cos φ + b sin φ, which is negative at 0, grows through
/// zero.
fn first_rise(a: f64, b: f64) -> f64 {
    // tan φ/2 makes a quadratic of it.
    let [over, under] = first_way_out([a, 2.0 * b, -a]).unwrap_or([0.0, 1.0]);
    2.0 * over.atan2(under)
}

/// The way to the surface of a ray from a point of a ball of Eaton's family of radius 1, `turn`
/// being 1/m: with L and S the sine and cosine of the angle to the radius at the surface, c = S sin
/// ψ, ψ from 0 to the turning point at π/2 to π.
pub(super) struct EatonWayOut {
    turn: f64,
    l: f64,
    s: f64,
    /// The ψ at which it starts.
    start: f64,
}

impl EatonWayOut {
    /// From c, see [`EatonWay::c`], with L and the part of r n along the radius, inwards.
    pub fn new(turn: f64, c: f64, l: f64, inward: f64) -> Self {
        Self { turn, l, s: c.hypot(inward), start: c.atan2(inward) }
    }

    /// The cosine of the angle to the radius at the surface.
    pub fn cosine(&self) -> f64 {
        self.s
    }

    /// The point at a share of the way.
    pub fn at(&self, share: f64) -> EatonWay {
        let Self { turn, l, s, start } = *self;
        let done = |phase: f64| {
            // From where the whole ray comes in, around the turning point at π/2.
            let psi = phase.min(PI - phase);
            let (sin, cos) = psi.sin_cos();
            let swept = (l * sin).atan2(cos) * turn + s.atan2(l) - (s * cos).atan2(l);
            let path = turn * psi + s * (1.0 - cos);
            if phase <= FRAC_PI_2 {
                return (path, swept);
            }
            (turn * PI + 2.0 * s - path, turn * PI + 2.0 * s.atan2(l) - swept)
        };
        let phase = start + share * (PI - start);
        let [(from, before), (to, after)] = [start, phase].map(done);
        EatonWay { c: s * phase.sin(), swept: after - before, path: to - from }
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

/// r/R of Eaton's family at c, see [`EatonWay::c`]: 2 v^(1 - 1/m)/(1 + v²).
fn eaton_radius(turn: f64, c: f64) -> f64 {
    let v = ((1.0 + c) / (1.0 - c).max(f64::MIN_POSITIVE)).sqrt();
    (1.0 - c) * v.powf(1.0 - turn)
}

/// Closer to the centre than this share of the radius the local medium is that of here.
const NEAREST: f64 = 1e-6;

/// w of Eaton's family at x = r/R, `turn` being 1/m: with v = e^w, the index is n = e^(w/m), and
/// w/m + ln cosh w + ln x = 0.
fn eaton_parameter(turn: f64, x: f64) -> f64 {
    if x >= 1.0 {
        return 0.0;
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
    w
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

    #[test]
    fn a_ray_that_starts_within_goes_on_as_one_that_comes_by() {
        let lenses = [
            CentralLens::luneburg(2.0),
            CentralLens::fisheye(2.0),
            CentralLens::eaton(2.0, PI),
            CentralLens::eaton(2.0, 2.0 * PI),
            CentralLens::eaton(2.0, 0.4),
            CentralLens::eaton(2.0, 0.0),
        ];
        for (lens, step) in lenses.into_iter().flat_map(|lens| (1..20).map(move |n| (lens, n))) {
            let entry = DVec3::new(-2.0, 0.0, 0.0);
            let inwards = DVec3::new(1.0, 0.1 * f64::from(step % 7), 0.3).normalize();
            let end = lens.advance(entry, inwards);
            let share = f64::from(step) / 20.0;
            let at = |share: f64| lens.way_point(entry, inwards, share);
            let (here, near) = (at(share), [share - 1e-6, share + 1e-6].map(at));
            let index = lens.index(here.position.length());
            let onward = (near[1].position - near[0].position).normalize() * index;
            let found = lens.advance(here.position, onward);
            // The direction is that of a short chord.
            assert!(found.position.distance(end.position) < 1e-7, "{lens:?} {step} {found:?}");
            assert!(found.direction.distance(end.direction) < 1e-7, "{lens:?} {step}");
            let path = here.optical_path + found.optical_path;
            assert!((path - end.optical_path).abs() < 1e-7, "{lens:?} {step}");
            // In its plane the field turns with the ray; the power is kept.
            let field = found.transport * onward.normalize();
            assert!(field.distance(found.direction * index.sqrt()) < 1e-9);
            let middle = lens.way_point(here.position, onward, 0.5);
            let last = lens.way_point(here.position, onward, 1.0);
            assert!(last.position.distance(found.position) < 1e-9);
            assert!(middle.optical_path < found.optical_path);
            assert!(middle.position.length() < lens.radius);
            // Out along the radius, from near the centre too.
            for r in [1.2, 1e-3] {
                let out = lens.advance(DVec3::X * r, DVec3::X);
                assert!(out.position.distance(DVec3::X * 2.0) < 1e-9 && out.optical_path > 0.0);
            }
        }
    }
}
