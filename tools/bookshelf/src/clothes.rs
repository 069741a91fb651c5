//! The person's body under a knitted sweater, a shirt collar and trousers, as
//! distance fields in body coordinates: life size, the eyes at `y = 0`.

use glam::Vec3;

use crate::fields::{ball, carve, ellipsoid, join, limb, ramp, ring, triangle};
use crate::random::noise;

/// The left shoulder, elbow and wrist; the right ones mirror them.
const SHOULDER: Vec3 = Vec3::new(14.9, -25.2, -4.2);
const ELBOW: Vec3 = Vec3::new(19.6, -49.5, -6.8);
const WRIST: Vec3 = Vec3::new(16.6, -70.5, 2.5);
/// Where the left sleeve ends, above the pocket.
const CUFF: Vec3 = Vec3::new(15.3, -76.0, 4.0);

/// Distances to the clothes.
#[derive(Debug, Clone, Copy)]
pub struct Clothes {
    /// The sweater.
    pub sweater: f32,
    /// The shirt's collar.
    pub collar: f32,
    /// The trousers.
    pub trousers: f32,
    /// The neck and the hands, without clothes.
    pub skin: f32,
}

/// Distance to the trunk under the sweater.
fn trunk(p: Vec3) -> f32 {
    let m = Vec3::new(p.x.abs(), p.y, p.z);
    let at = Vec3::new;
    let mut d = ellipsoid(p, at(0.0, -36.5, -3.2), at(14.0, 17.0, 9.4));
    d = join(d, limb(m, at(0.0, -24.0, -4.2), at(12.0, -24.4, -4.4), 4.8, 4.6), 4.0);
    d = join(d, limb(m, at(0.0, -16.0, -5.2), at(13.0, -23.4, -4.6), 4.4, 3.4), 3.0);
    d = join(d, ellipsoid(p, at(0.0, -57.0, -2.8), at(12.8, 20.0, 9.0)), 6.0);
    join(d, ball(m, at(5.8, -33.0, 0.5), 5.8), 4.0)
}

/// Distance to the left arm's sleeve, for `m` on that side.
fn sleeve(m: Vec3) -> f32 {
    let upper = limb(m, SHOULDER, ELBOW, 4.7, 3.9);
    let lower = join(limb(m, ELBOW, WRIST, 3.9, 2.7), limb(m, WRIST, CUFF, 2.7, 2.3), 0.8);
    join(upper, lower, 1.5).max(-75.0 - m.y)
}

/// The folds of the cloth: how far it stands out at `p`.
fn folds(p: Vec3) -> f32 {
    let side = p.x.signum();
    let m = Vec3::new(p.x.abs(), p.y, p.z);
    let wave = |q: f32, sharp: f32| (q.sin() * 0.5 + 0.5).powf(sharp);
    let warp = noise(p * 0.13) * 1.9 + 0.5 * noise(p * 0.33);
    // Pulls from the armpit over the chest, and sags above the hem.
    let armpit = (-(m - Vec3::new(12.5, -33.0, 3.0)).length_squared() / 90.0).exp();
    let pull = wave(m.x * 0.55 + m.y * 0.85 + 2.0 * warp, 2.0) * armpit;
    let low = ramp(-48.0, -62.0, p.y) * ramp(18.0, 13.0, m.x);
    let sag = wave(p.y * 0.62 + 0.14 * m.x * side + 2.2 * warp, 1.6) * low;
    // Creases inside the elbows and up the sleeves.
    let bend = (-(m - ELBOW).length_squared() / 70.0).exp();
    let crease = wave(m.y * 1.05 - m.x * 0.35 + 1.6 * warp, 1.5) * bend;
    let drape = 0.5 * noise(p * Vec3::new(0.16, 0.09, 0.16));
    0.85 * pull + 0.75 * sag + 0.75 * crease + drape
}

/// The hole for the neck: its distance, in the sweater.
fn neckline(p: Vec3) -> (f32, f32) {
    let q = p - Vec3::new(0.0, -19.0, -3.6);
    let (s, c) = 0.42_f32.sin_cos();
    let q = Vec3::new(q.x * 0.94, c * q.y + s * q.z, c * q.z - s * q.y);
    let hole = (q.x.hypot(q.z) - 6.6).max(-q.y - 4.0);
    (hole, ring(q + Vec3::Y * 0.5, 7.0, 0.75))
}

/// Distance to the shirt's collar: a band round the neck and two points.
fn collar(p: Vec3) -> f32 {
    let m = Vec3::new(p.x.abs(), p.y, p.z);
    let at = Vec3::new;
    let (front, side, back) = (at(0.35, -19.0, 3.1), at(6.0, -15.6, -3.4), at(3.0, -13.9, -9.3));
    let (tip, hem, nape) = (at(4.9, -23.4, 4.6), at(8.0, -18.9, -2.2), at(4.2, -17.0, -10.6));
    let mut d = triangle(m, front, side, tip);
    d = d.min(triangle(m, side, hem, tip));
    d = join(d, triangle(m, side, back, hem), 0.6);
    d = d.min(triangle(m, back, nape, hem));
    let band = triangle(m, front, side, at(5.4, -18.0, -3.4));
    d.min(band) - 0.24
}

/// Where the stitches are: the coordinate around the limb or trunk and the
/// coordinate along it, in centimetres.
pub fn thread(p: Vec3) -> (f32, f32) {
    let m = Vec3::new(p.x.abs(), p.y, p.z);
    if sleeve(m) < trunk(p) {
        let (from, to) = if m.y > ELBOW.y { (SHOULDER, ELBOW) } else { (ELBOW, WRIST) };
        let axis = (to - from).normalize();
        let q = m - from;
        let side = Vec3::Z.cross(axis).normalize();
        let around = q.dot(side).atan2(q.dot(axis.cross(side)));
        (around * 5.0, q.dot(axis) + if m.y > ELBOW.y { 0.0 } else { 24.6 })
    } else {
        let around = (p.x / 1.45).atan2(p.z + 4.0);
        (around * 12.0, p.y)
    }
}

/// Height of the knitting at the stitch coordinates: V-shaped stitches in
/// columns, and plain ribs where `ribbed`.
pub fn knit(around: f32, along: f32, ribbed: bool) -> f32 {
    let width = 0.86;
    let column = (around / width).rem_euclid(1.0) * 2.0 - 1.0;
    if ribbed {
        return (1.0 - column * column).max(0.0).sqrt();
    }
    let leg = 2.0 * column.abs() - 1.0;
    let row = (along / 0.66 + 0.75 * column.abs()).rem_euclid(1.0) * 2.0 - 1.0;
    ((1.0 - leg * leg).max(0.0) * (1.0 - row * row).max(0.0)).sqrt()
}

/// Whether the sweater is ribbed at `p`: at the neckline, cuffs and hem.
pub fn ribbed(p: Vec3) -> bool {
    neckline(p).1 < 0.35 || p.y < -68.0
}

/// Distances to the clothes at `p`; `neck` is where the neck meets the head.
pub fn clothes(p: Vec3, neck: Vec3) -> Clothes {
    let m = Vec3::new(p.x.abs(), p.y, p.z);
    let at = Vec3::new;
    let body = trunk(p);
    let mut sweater = join(body.max(-70.5 - p.y), sleeve(m), 1.6) - 0.45;
    if sweater < 3.0 {
        sweater -= 0.55 * folds(p);
    }
    // Each part is measured only near its heights; elsewhere the distance to
    // those heights will do.
    let (mut collared, mut skin) = (-28.0 - p.y, -26.0 - p.y);
    if p.y > -32.0 {
        let (hole, rib) = neckline(p);
        sweater = carve(sweater, hole, 0.5).min(rib);
        let shirt = (body + 0.1).max(hole - 1.0).max(-28.0 - p.y);
        collared = collar(p).min(shirt);
        skin = limb(p, at(0.0, -20.0, -4.2), neck, 5.0, 4.5);
        let cord = limb(m, at(4.6, -8.0, -3.4), at(1.2, -19.5, 0.7), 0.8, 0.7);
        skin = join(skin, cord, 1.6);
        skin = join(skin, ball(p, at(0.0, -14.8, 1.2), 0.6), 1.8);
    }
    let mut trousers = p.y + 61.0;
    if p.y < -58.0 {
        let hips = ellipsoid(p, at(0.0, -76.0, -3.0), at(14.0, 14.0, 9.2));
        let leg = limb(m, at(7.0, -80.0, -2.5), at(7.8, -120.0, -3.5), 8.2, 7.0);
        trousers = join(hips, leg, 3.0);
        // The hands are in the pockets.
        trousers = join(trousers, ellipsoid(m, at(12.6, -80.6, 3.9), at(3.3, 4.2, 3.4)), 2.0);
        skin = limb(m, WRIST, at(12.6, -79.5, 4.2), 2.0, 2.6);
    }
    Clothes { sweater, collar: collared, trousers, skin }
}
