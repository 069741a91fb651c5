//! The colours of the person's skin, lips and eyes, in head coordinates.

use glam::{Vec2, Vec3};

use crate::fields::ramp;
use crate::head::{EYE, EYE_RADIUS, lips, mouth_line, opening};
use crate::random::{cloudy, noise};

/// Bare skin, light brown with a warm tinge.
const SKIN: Vec3 = Vec3::new(0.580, 0.345, 0.232);
/// What blood adds: cheeks, nose, ears.
const FLUSH: Vec3 = Vec3::new(0.600, 0.225, 0.150);
/// The lips.
const LIPS: Vec3 = Vec3::new(0.480, 0.190, 0.155);

/// Reflectance of the skin at `p`.
pub fn skin(p: Vec3) -> Vec3 {
    let m = Vec3::new(p.x.abs(), p.y, p.z);
    let about = |c: Vec3, r: f32| (-(m - c).length_squared() / (r * r)).exp();
    let mut blood = 0.5 * about(Vec3::new(4.4, -3.2, 6.6), 2.3);
    blood += 0.7 * about(Vec3::new(0.0, -3.7, 10.0), 1.3);
    blood += 0.6 * about(Vec3::new(8.0, -1.5, -1.0), 2.5);
    blood += 0.15 * about(Vec3::new(0.0, -9.5, 7.0), 2.0);
    let mut tone = SKIN.lerp(FLUSH, blood.min(0.9));
    tone *= 1.0 + 0.018 * cloudy(p * 1.1) + 0.02 * noise(p * 7.0);
    // Lips, fading into the skin around.
    let (upper, lower) = lips(p);
    let lip = 1.0 - ramp(-0.02, 0.14, upper.min(lower));
    if p.z > 5.0 {
        tone = tone.lerp(LIPS * (1.0 + 0.05 * noise(p * Vec3::new(9.0, 1.5, 1.5))), 0.75 * lip);
    }
    // The line between the lips is in their shade.
    let line = (p.y - mouth_line(p.x)).abs();
    let inner = (1.0 - ramp(0.02, 0.16, line)) * (1.0 - ramp(2.3, 2.8, m.x));
    if p.z > 6.0 {
        tone *= Vec3::ONE - inner * Vec3::new(0.55, 0.68, 0.68);
    }
    if p.z > EYE.z {
        // The lash line darkens the rim of the upper lid, the crease its top.
        let q = Vec2::new(m.x - EYE.x, m.y - EYE.y);
        let edge = opening(q);
        let upper = ramp(-0.25, 0.25, q.y + 0.1);
        let lash = (1.0 - ramp(0.0, 0.16, edge)) * (0.25 + 0.65 * upper);
        tone *= 1.0 - 0.85 * lash;
        let shade = about(EYE + Vec3::new(0.0, 0.6, 1.2), 1.5);
        tone *= Vec3::ONE - shade * Vec3::new(0.10, 0.14, 0.14);
    }
    tone
}

/// Reflectance of the eyeball at `p`, looking along `gaze` (a unit vector).
pub fn eye(p: Vec3, gaze: Vec3) -> Vec3 {
    let centre = Vec3::new(EYE.x * p.x.signum(), EYE.y, EYE.z);
    let n = (p - centre) / EYE_RADIUS;
    let off = n - gaze * n.dot(gaze);
    let r = off.length() * EYE_RADIUS / 0.82;
    let white = Vec3::new(0.68, 0.65, 0.62) * (1.0 + 0.03 * noise(p * 6.0));
    if n.dot(gaze) < 0.0 {
        return white;
    }
    let around = off.y.atan2(off.x);
    let rays = noise(Vec3::new(around.cos() * 9.0, around.sin() * 9.0, r * 1.6));
    let inner = Vec3::new(0.190, 0.092, 0.036);
    let outer = Vec3::new(0.085, 0.050, 0.028);
    let mut iris = inner.lerp(outer, ramp(0.42, 0.95, r)) * (1.0 + 0.35 * rays);
    // Light pools opposite the lamp.
    iris *= 1.0 + 0.9 * (off.x * 0.6 - off.y).max(0.0);
    iris *= 1.0 - 0.65 * ramp(0.80, 0.98, r);
    let mut tone = iris.lerp(white, ramp(0.95, 1.08, r));
    tone = tone.lerp(Vec3::splat(0.008), 1.0 - ramp(0.38, 0.46, r));
    tone
}
