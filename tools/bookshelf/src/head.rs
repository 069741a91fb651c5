//! The person's head as a distance field, in head coordinates: life size, in
//! centimetres, with the eyes at `y = 0`, the face towards `+z`, and the
//! person's left at `+x`.

use glam::{Vec2, Vec3};

use crate::fields::{ball, carve, ellipsoid, join, limb};

/// The eyes' radius.
pub const EYE_RADIUS: f32 = 1.5;
/// The middle of the left eye; the right one mirrors it.
pub const EYE: Vec3 = Vec3::new(3.25, 0.0, 6.0);

/// Distances to the parts of the head.
#[derive(Debug, Clone, Copy)]
pub struct Head {
    /// Skin of the face and ears.
    pub skin: f32,
    /// The eyeballs.
    pub eye: f32,
    /// The body of the hair.
    pub hair: f32,
}

/// Height of the line between the lips, at `x`: a smile, fuller on one side.
pub fn mouth_line(x: f32) -> f32 {
    let curl = if x > 0.0 { 0.085 } else { 0.072 };
    -6.85 + curl * x * x - 0.06 * (-(x * x) * 2.0).exp()
}

/// How far forward the lips lie at `x`.
fn mouth_front(x: f32) -> f32 {
    7.95 - 0.115 * x * x
}

/// Distance to the upper and the lower lip.
pub fn lips(p: Vec3) -> (f32, f32) {
    let q = Vec3::new(p.x, p.y - mouth_line(p.x), p.z - mouth_front(p.x));
    let bow = 0.13 * (-(p.x * p.x) * 5.0).exp() - 0.10 * (-(p.x.abs() - 0.75).powi(2) * 4.0).exp();
    let upper =
        ellipsoid(q + Vec3::Y * bow, Vec3::new(0.0, 0.30, 0.0), Vec3::new(2.65, 0.42, 0.68));
    let lower = ellipsoid(q, Vec3::new(0.0, -0.46, 0.02), Vec3::new(2.2, 0.52, 0.76));
    (upper, lower)
}

/// Signed distance, in the plane of the face, from the opening between the
/// lids; `q` is measured from the eye's middle with `x` outwards.
pub fn opening(q: Vec2) -> f32 {
    // The outer corner is a little higher.
    let q = Vec2::new(q.x + 0.08 * q.y, q.y - 0.07 * q.x);
    let upper = (q - Vec2::new(0.0, -1.47)).length() - 2.19;
    let lower = (q - Vec2::new(0.0, 2.47)).length() - 2.97;
    upper.max(lower)
}

/// The ears, to be joined to the head.
fn ear(p: Vec3) -> f32 {
    // Ear coordinates: x outwards along the ear's plane normal.
    let q = p - Vec3::new(7.05, -1.3, -1.1);
    let (s, c) = 0.42_f32.sin_cos();
    let q = Vec3::new(c * q.x + s * q.z, q.y, -s * q.x + c * q.z);
    let (s, c) = 0.16_f32.sin_cos();
    let q = Vec3::new(q.x, c * q.y - s * q.z, s * q.y + c * q.z);
    let plate = ellipsoid(q, Vec3::new(0.35, 0.0, 0.0), Vec3::new(0.62, 3.0, 1.85));
    let bowl = ellipsoid(q, Vec3::new(1.0, -0.2, 0.35), Vec3::new(0.72, 1.75, 1.05));
    let groove = ellipsoid(q, Vec3::new(1.0, 1.2, -0.25), Vec3::new(0.55, 1.2, 0.8));
    let lobe = ball(q, Vec3::new(0.35, -2.5, 0.45), 0.75);
    let flap = ball(q, Vec3::new(0.55, -0.5, 1.55), 0.45);
    let whole = carve(carve(plate, bowl, 0.35), groove, 0.3);
    join(join(whole, lobe, 0.6), flap, 0.4)
}

/// The face and skull without eyes.
fn flesh(p: Vec3) -> f32 {
    let m = Vec3::new(p.x.abs(), p.y, p.z);
    let at = Vec3::new;
    let mut d = ellipsoid(p, at(0.0, 3.3, -1.4), at(7.25, 7.9, 9.0));
    d = join(d, ellipsoid(p, at(0.0, -3.6, 1.7), at(5.6, 7.1, 6.4)), 2.5);
    d = join(d, ball(p, at(0.0, -9.55, 5.9), 1.55), 2.2);
    d = join(d, limb(m, at(4.7, -5.2, -0.6), at(2.3, -8.6, 4.0), 1.4, 1.4), 2.8);
    d = join(d, ball(m, at(3.75, -3.1, 4.75), 2.6), 1.8);
    // Brow ridge, sockets and lids.
    d = join(d, limb(m, at(0.0, 1.8, 7.3), at(4.4, 2.1, 5.6), 0.7, 0.8), 1.2);
    d = carve(d, ball(m, at(3.15, 0.15, 9.4), 2.15), 1.2);
    let eye = m - EYE;
    let lid = eye.length() - (EYE_RADIUS + 0.15);
    d = join(d, lid, 0.38);
    // Nose.
    d = join(d, limb(p, at(0.0, 1.3, 7.1), at(0.0, -3.1, 9.15), 0.62, 0.82), 1.0);
    d = join(d, ball(p, at(0.0, -3.45, 9.35), 0.95), 0.6);
    d = join(d, ellipsoid(m, at(1.08, -3.75, 8.3), at(0.68, 0.64, 0.95)), 0.6);
    d = carve(d, ellipsoid(m, at(0.60, -4.36, 9.15), at(0.36, 0.30, 0.46)), 0.22);
    // Mouth: a soft mound, the lips, and the line between them.
    d = join(d, ellipsoid(p, at(0.0, -6.6, 5.4), at(3.2, 2.4, 2.65)), 2.2);
    let (upper, lower) = lips(p);
    d = join(d, upper, 0.28);
    d = join(d, lower, 0.3);
    let line = Vec2::new(p.y - mouth_line(p.x), p.z - mouth_front(p.x) - 0.68);
    let gap = line.length().max(p.x.abs() - 2.5) - 0.11;
    d = carve(d, gap, 0.2);
    let corner = at(2.75, mouth_line(2.75 * p.x.signum()), mouth_front(2.75) + 0.45);
    d = carve(d, ball(m, corner, 0.22), 0.55);
    d = carve(d, limb(p, at(0.0, -4.9, 9.15), at(0.0, -5.9, 9.1), 0.2, 0.25), 0.5);
    d = join(d, ear(m), 0.9);
    // The opening between the lids, only before the eyeball's middle.
    let slit = opening(Vec2::new(eye.x, eye.y)).max(0.3 - eye.z);
    carve(d, slit, 0.12)
}

/// The body of the hair: fuller on top, short at the sides.
pub fn hair(p: Vec3) -> f32 {
    let m = Vec3::new(p.x.abs(), p.y, p.z);
    let at = Vec3::new;
    let skull = ellipsoid(p, at(0.0, 3.3, -1.6), at(7.6, 8.3, 9.3));
    // The sweep is higher on the side the hair is combed to.
    let sweep = ellipsoid(p, at(-0.7, 7.3, 0.4), at(6.6, 5.9, 8.3));
    let mut d = join(skull, sweep, 2.2);
    d = join(d, ellipsoid(p, at(0.0, 0.8, -4.5), at(7.3, 8.3, 6.3)), 1.5);
    // The face and the forehead stay free, the sideburns run before the ears.
    d = carve(d, ellipsoid(p, at(0.5, -3.5, 10.5), at(7.6, 10.3, 8.3)), 0.8);
    d = carve(d, ellipsoid(m, at(7.4, -5.3, 0.4), at(3.9, 6.3, 4.6)), 0.5);
    // So does the skin about the ears.
    d = carve(d, ellipsoid(m, at(7.3, -2.2, -0.9), at(3.2, 3.3, 3.5)), 0.4);
    d.max(-7.5 - p.y)
}

/// Distances to the parts of the head at `p`.
pub fn head(p: Vec3) -> Head {
    let eye = (Vec3::new(p.x.abs(), p.y, p.z) - EYE).length() - EYE_RADIUS;
    Head { skin: flesh(p), eye, hair: hair(p) + 0.35 }
}
