//! The panorama: all directions from the place before the photograph where cloakroom's devices
//! stand, as an equirectangular picture. Its middle looks at the photograph.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use crate::fields::ramp;
use crate::shapes::Ray;
use crate::tracer::{DISTANCE, HEIGHT, WIDTH};

/// How far before the photograph's plane the panorama is seen from.
pub const PLACE: f32 = 50.0;
/// How far from the photograph's edge, in its plane, its camera's rays go on, and where those from
/// the panorama's own place begin.
const PASSAGE: [f32; 2] = [4.0, 130.0];
/// The same below the photograph, where the desk begins.
const PASSAGE_BELOW: [f32; 2] = [4.0, 44.0];

/// The direction to a point of the picture: 0 to 1 from its left and from its top.
fn direction(u: f32, v: f32) -> Vec3 {
    let (azimuth, polar) = (TAU * (u - 0.5), PI * v);
    Vec3::new(polar.sin() * azimuth.sin(), polar.cos(), -polar.sin() * azimuth.cos())
}

/// The ray that a point of the picture shows.
///
/// In the photograph and near its edge it is that of the photograph's camera through the same point
/// of its plane, so that lines go on over the edge; further away the camera comes nearer, up to the
/// place itself. It starts level with that place.
pub fn ray(u: f32, v: f32) -> Ray {
    let toward = direction(u, v);
    let place = Vec3::new(0.0, 0.0, PLACE);
    if toward.z > -1e-3 {
        return Ray { origin: place, direction: toward };
    }
    let met = place - toward * (PLACE / toward.z);
    let passed = |[start, end]: [f32; 2], outside| ramp(start, end, outside);
    let own = passed(PASSAGE, (met.x.abs() - 0.5 * WIDTH).max(met.y - 0.5 * HEIGHT))
        .max(passed(PASSAGE_BELOW, -met.y - 0.5 * HEIGHT));
    let nearness = (1.0 - own) / DISTANCE + own / PLACE;
    let eye = Vec3::new(0.0, 0.0, 1.0 / nearness);
    let direction = (met - eye).normalize();
    Ray { origin: eye + direction * ((PLACE - eye.z) / direction.z), direction }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracer::camera;

    /// Where on the picture a direction is: what cloakroom looks up.
    fn position(d: Vec3) -> (f32, f32) {
        (0.5 + d.x.atan2(-d.z) / TAU, d.x.hypot(d.z).atan2(d.y) / PI)
    }

    #[test]
    fn at_the_photographs_edge_it_shows_what_the_photograph_shows() {
        for (x, y) in [(55.0, 0.0), (-55.0, 40.0), (10.0, 68.75), (-54.9, -68.7), (3.0, 4.0)] {
            let (u, v) = position((Vec3::new(x, y, 0.0) - Vec3::new(0.0, 0.0, PLACE)).normalize());
            let (seen, expected) = (ray(u, v), camera(x, y));
            assert!((seen.direction - expected.direction).length() < 1e-5, "{x}, {y}");
            let met = seen.at(-seen.origin.z / seen.direction.z);
            assert!((met - Vec3::new(x, y, 0.0)).length() < 1e-2, "{x}, {y}: {met}");
            assert!((seen.origin.z - PLACE).abs() < 1e-3);
        }
    }

    #[test]
    fn far_from_it_rays_start_at_the_place_in_the_direction_they_stand_for() {
        for (u, v) in [(0.0, 0.5), (0.25, 0.5), (0.75, 0.3), (0.9, 0.8), (0.5, 0.01), (0.3, 0.4)] {
            let seen = ray(u, v);
            assert!((seen.origin - Vec3::new(0.0, 0.0, PLACE)).length() < 1e-2, "{u}, {v}");
            assert!((seen.direction - direction(u, v)).length() < 1e-4, "{u}, {v}");
            let (u_again, v_again) = position(seen.direction);
            let around = (u_again - u).abs();
            assert!(around.min(1.0 - around) < 1e-4 && (v_again - v).abs() < 1e-4, "{u}, {v}");
        }
    }

    #[test]
    fn what_is_seen_moves_outwards_all_the_way() {
        // Where rays meet the plane of the books: never back, or a book would be seen twice.
        for v in [0.5, 0.35, 0.7] {
            let mut last = f32::NEG_INFINITY;
            for k in 0..480 {
                let seen = ray(0.5 + 0.0005 * k as f32, v);
                let x = seen.at((-28.0 - seen.origin.z) / seen.direction.z).x;
                assert!(x > last, "{v}, {k}: {x} after {last}");
                last = x;
            }
        }
    }
}
