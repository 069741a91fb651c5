//! Signed distance fields and the ways to join them. Lengths are centimetres.

use glam::{Vec2, Vec3};

/// Distance to a ball.
pub fn ball(p: Vec3, centre: Vec3, radius: f32) -> f32 {
    (p - centre).length() - radius
}

/// Nearly the distance to an ellipsoid with its axes along the coordinates.
pub fn ellipsoid(p: Vec3, centre: Vec3, radii: Vec3) -> f32 {
    let q = p - centre;
    let near = (q / radii).length();
    let slope = (q / (radii * radii)).length();
    if slope < 1e-9 { -radii.min_element() } else { near * (near - 1.0) / slope }
}

/// Distance to a capsule whose radius goes from `ra` at `a` to `rb` at `b`.
pub fn limb(p: Vec3, a: Vec3, b: Vec3, ra: f32, rb: f32) -> f32 {
    let (pa, ba) = (p - a, b - a);
    let h = (pa.dot(ba) / ba.length_squared()).clamp(0.0, 1.0);
    (pa - ba * h).length() - (ra + (rb - ra) * h)
}

/// Distance to a ring about the y axis.
pub fn ring(p: Vec3, radius: f32, tube: f32) -> f32 {
    Vec2::new(p.x.hypot(p.z) - radius, p.y).length() - tube
}

/// Distance to a triangle.
pub fn triangle(p: Vec3, a: Vec3, b: Vec3, c: Vec3) -> f32 {
    let (ba, cb, ac) = (b - a, c - b, a - c);
    let (pa, pb, pc) = (p - a, p - b, p - c);
    let normal = ba.cross(ac);
    let side = |edge: Vec3, from: Vec3| edge.cross(normal).dot(from).signum();
    if side(ba, pa) + side(cb, pb) + side(ac, pc) < 2.0 {
        let edge = |e: Vec3, q: Vec3| {
            (e * (e.dot(q) / e.length_squared()).clamp(0.0, 1.0) - q).length_squared()
        };
        edge(ba, pa).min(edge(cb, pb)).min(edge(ac, pc)).sqrt()
    } else {
        (normal.dot(pa).powi(2) / normal.length_squared()).sqrt()
    }
}

/// The union, its seam rounded over a width `k`.
pub fn join(a: f32, b: f32, k: f32) -> f32 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

/// `a` without `b`, the edge rounded over a width `k`.
pub fn carve(a: f32, b: f32, k: f32) -> f32 {
    -join(-a, b, k)
}

/// 0 below `low`, 1 above `high`, smooth between.
pub fn ramp(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
